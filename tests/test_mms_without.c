/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Built without GNU libmatheval: a scene with a solution is refused, others are read. */
#include "reference/judge.h"
#include "study/scene_file.h"
#include "support.h"

static void test_refusal(void **state)
{
    (void)state;
    struct br_error err = {0};
    struct br_scene scene;
    char path[1024];
    MUST(br_scene_find("mms_smooth", path, sizeof path, &err));
    REFUSED(br_scene_read(path, &scene, &err), BR_BAD_INPUT, "built without libmatheval");
    br_scene_clear(&scene);
    assert_null(br_judge_find("mms"));
    scene = br_test_bundled("example1");
    br_scene_clear(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_refusal)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
