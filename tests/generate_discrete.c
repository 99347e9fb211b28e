/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Regenerates tests/data/discrete.csv: what the scheme itself gives, by dense_march.h.
 *
 *     meson compile -C build/release regenerate-discrete
 *
 * writes the file anew, in some minutes. */
#include <stdio.h>
#include <stdlib.h>

#include "solver/laws.h"
#include "solver/method.h"
#include "study/scene/file.h"
#include "tests/dense_march.h"

static const char *const scenes[] = {"example1", "example2"};
static const size_t meshes[] = {400, 3200, 12800};
enum { SCENES = 2, MESHES = 3, STEPS = 1000 };

/* u and w at the tip, w in the middle, m. */
static enum br_status run(const char *name, size_t n, long double value[3], struct br_error *err)
{
    char path[1024];
    struct br_scene scene = {0};
    struct br_march *march = NULL;
    struct br_method method = br_method_default();
    method.contact = br_contact_rule_find("lagged");
    enum br_status status = br_scene_find(name, path, sizeof path, err);
    if (!status)
        status = br_scene_read(path, &scene, err);
    if (!status)
        status = br_march_create(&march, &scene, n, STEPS, &method, err);
    struct dense_march *dense = status ? NULL : dense_follow(march, &scene, &method);
    if (!status && !dense)
        status = br_fail(err, BR_NO_MEMORY, "no memory, or no quadruple precision");
    while (!status && br_march_steps_done(march) < STEPS)
        status = br_march_step(march, err);
    for (int i = 0; i < 3 && !status; i++)
        value[i] = dense_displacement(dense, i ? BR_BENDING : BR_AXIAL, i < 2 ? n : n / 2);
    dense_free(dense);
    br_march_free(march);
    br_scene_clear(&scene);
    return status;
}

int main(void)
{
    printf("# Values at t = 1 of the scheme as printed (contact at u_{n-1}, exact friction law),\n"
           "# by tests/generate_discrete.c in quadruple precision.\n"
           "scene,n,k,u_tip,w_tip,w_middle\n");
    for (int i = 0; i < SCENES * MESHES; i++) {
        struct br_error err = {0};
        long double value[3];
        if (run(scenes[i / MESHES], meshes[i % MESHES], value, &err)) {
            fprintf(stderr, "%s\n", err.message);
            return EXIT_FAILURE;
        }
        printf("%s,%zu,1e-3,%.18Le,%.18Le,%.18Le\n", scenes[i / MESHES], meshes[i % MESHES],
               value[0], value[1], value[2]);
    }
    return fflush(stdout) || ferror(stdout) ? EXIT_FAILURE : EXIT_SUCCESS;
}
