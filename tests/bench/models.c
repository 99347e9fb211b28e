/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What it saves not to model what a scene does not need: Example 3 is bending alone, under Tresca's
 * law; the same scene with an axial field and a contact that nothing of it depends on. */
#include <stdio.h>

#include "tests/bench/bench.h"

/* Example 3 with the axial part and the contact of Example 2 beside it. */
static struct br_scene with_axial(const struct br_scene *example2)
{
    struct br_scene scene = br_test_bundled("example3");
    scene.axial = example2->axial;
    scene.contact = example2->contact;
    return scene;
}

void bench_models(void **state)
{
    static const size_t sizes[] = {100, 3200, 100000};
    struct br_scene example2 = br_test_bundled("example2");
    struct br_scene alone = br_test_bundled("example3"), forced = with_axial(&example2);
    const struct br_method method = bench_fast_method();
    printf("\nExample 3 (bending alone, Tresca) and the same with an axial field and a contact "
           "forced on: %s, ns an element-step\n%8s %12s %12s %10s\n",
           method.solver->name, "n", "alone", "forced on", "saved");
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        const struct bench_march marches[] = {{&alone, &method, sizes[i], 0},
                                              {&forced, &method, sizes[i], 0}};
        const struct bench_time less = bench_march(&marches[0]).step;
        const struct bench_time more = bench_march(&marches[1]).step;
        printf("%8zu %12.2f %12.2f %8.0f %%\n", sizes[i], less.least, more.least,
               100 * (1 - less.least / more.least));
        bench_record(*state, "ns/element-step", &less, "example3 alone n=%zu", sizes[i]);
        bench_record(*state, "ns/element-step", &more, "example3 axial forced on n=%zu", sizes[i]);
    }
    const struct br_test_end ends[] = {br_test_run(&alone, 100, 100, &method),
                                       br_test_run(&forced, 100, 100, &method)};
    assert_true(ends[0].w_tip == ends[1].w_tip && ends[0].w_middle == ends[1].w_middle);
    forced.axial = (struct br_axial){0}; /* Example 2 owns it */
    br_scene_clear(&forced);
    br_scene_clear(&alone);
    br_scene_clear(&example2);
}
