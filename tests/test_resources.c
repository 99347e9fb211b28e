/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The memory that a march is said to take against what it has allocated; what does not fit, or
 * would never end, is refused. */
#include "solver/function.h"
#include "solver/scene.h"
#include "study/grid/costs.h"

#include <malloc.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "solver/linear/linear_solver.h"
#include "solver/march_state.h"
#include "support.h"

/* Valgrind's and the sanitizers' allocators tell nothing. */
static double allocated(void)
{
    const struct mallinfo2 info = mallinfo2();
    return (double)info.uordblks + (double)info.hblkhd;
}

static double held(const struct br_scene *scene, const struct br_method *method, size_t n)
{
    OWNED(br_march) * march;
    const double before = allocated();
    MUST(br_march_create(&march, scene, n, 1000, method, &err));
    MUST(br_march_step(march, &err));
    const double bytes = allocated() - before;
    return bytes;
}

static void compare(const struct br_scene *scene, const struct br_method *method, size_t n)
{
    const struct br_planned_march o = {.scene = scene, .method = method, .n = n, .steps = 1000};
    const double bytes = held(scene, method, n);
    if (bytes <= 0)
        return;
    /* Without what watchers take; arrays have a header each, whatever n is. */
    AT_MOST(bytes, br_march_bytes(&o) - 80.0 * (double)n + 4096);
    AT_MOST(br_march_bytes(&o), 5 * bytes);
}

TEST(test_memory)
{
    enum { N = 8000 };
    static const char *const schemes[] = {"euler", "bdf2", "esdirk4", "adaptive"};
    struct br_scene scene = br_test_bare();
    scene.bending.stiffness = scene.bending.viscosity = 1e-9; /* well-conditioned */
    scene.axial.load = br_test_load("t");
    scene.bending.load = br_test_load("t");
    for (int fields = 1; fields <= 3; fields++)
        for (const struct br_linear_solver *const *l = br_linear_solvers; *l; l++)
            for (size_t s = 0; s < (br_test_quick() ? 1 : sizeof schemes / sizeof *schemes); s++)
                for (int degree = 1; degree <= ((*l)->axial_quadratic ? 2 : 1); degree++) {
                    struct br_method method = br_method_default();
                    scene.axial.modelled = fields & 1;
                    scene.bending.modelled = fields & 2;
                    method.solver = *l;
                    method.scheme = br_time_scheme_find(schemes[s]);
                    method.contact = br_contact_rule_of(method.scheme);
                    method.axial_degree = scene.axial.modelled ? degree : 1;
                    compare(&scene, &method, N);
                }
    br_function_free(&scene.axial.load.term[0].time);
    br_function_free(&scene.bending.load.term[0].time);
    br_function_free(&scene.axial.load.term[0].space);
    br_function_free(&scene.bending.load.term[0].space);
}

/* ---- made control groups ---- */

/* The files of the system that are made here; others, as /proc/meminfo, are the real ones. */
static const struct made {
    const char *name, *text;
} * made;

/* The second one by glibc's name for it. */
FILE *__real_fopen(const char *path, const char *mode);
FILE *__wrap_fopen(const char *path, const char *mode);
FILE *__wrap_fopen64(const char *path, const char *mode);
FILE *__wrap_fopen(const char *path, const char *mode)
{
    for (const struct made *m = made; m && m->name; m++)
        if (strcmp(m->name, path) == 0)
            return fmemopen((void *)(uintptr_t)m->text, strlen(m->text), mode);
    return made && strstr(path, "cgroup") ? NULL : __real_fopen(path, mode);
}

FILE *__wrap_fopen64(const char *path, const char *mode)
{
    return __wrap_fopen(path, mode);
}

/* What the process's own group, and those around it, leave of their limits. */
TEST(test_control_groups)
{
#define TOP "/sys/fs/cgroup"
    static const struct {
        struct made file[8];
        double left;
    } rows[] = {
        {{{"/proc/self/cgroup", "0::/\n"},
          {TOP "//memory.max", "5000000\n"},
          {TOP "//memory.current", "2000000\n"}},
         3e6},
        {{{"/proc/self/cgroup", "0::/user/me\n"}, /* its own */
          {TOP "/user/me/memory.max", "5000000\n"},
          {TOP "/user/me/memory.current", "2000000\n"},
          {TOP "/user/memory.max", "9000000\n"},
          {TOP "/user/memory.current", "2500000\n"}},
         3e6},
        {{{"/proc/self/cgroup", "0::/user/me\n"}, /* one around it */
          {TOP "/user/me/memory.max", "max\n"},
          {TOP "/user/me/memory.current", "2000000\n"},
          {TOP "/user/memory.max", "9000000\n"},
          {TOP "/user/memory.current", "8500000\n"}},
         5e5},
        {{{"/proc/self/cgroup", "0::/\n"}, /* files that are only cached give way */
          {TOP "/memory.max", "5000000\n"},
          {TOP "/memory.current", "4900000\n"},
          {TOP "/memory.stat", "anon 100\nfile 4800000\ninactive_file 4000000\n"}},
         4.1e6},
        {{{"/proc/self/cgroup", "0::/\n"}, /* more than all */
          {TOP "/memory.max", "5000000\n"},
          {TOP "/memory.current", "5100000\n"}},
         0},
        {{{"/proc/self/cgroup", "9:name=systemd:/\n4:memory:/me\n0::/other\n"}, /* version 1 */
          {TOP "/memory/me/memory.limit_in_bytes", "7000000\n"},
          {TOP "/memory/me/memory.usage_in_bytes", "6000000\n"},
          {TOP "/memory/me/memory.stat", "inactive_file 9\ntotal_inactive_file 500000\n"}},
         1.5e6},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        made = rows[i].file;
        const double left = br_memory_available();
        made = NULL;
        if (left != rows[i].left)
            fail_msg("row %zu: %.17g bytes are left, expected %g", i, left, rows[i].left);
    }
}

TEST(test_refused)
{
    struct br_scene scene = br_test_bare();
    const struct br_method method = br_method_default();
    struct br_planned_march o = {.scene = &scene, .method = &method, .n = 1000, .steps = 10};
    MUST(br_fits_memory(&o, br_march_bytes(&o), &err));
    REFUSED(br_fits_memory(&o, 0.9 * br_march_bytes(&o), &err), BR_NO_MEMORY,
            "are available: expected at most 900 elements");
    REFUSED(br_fits_memory(&o, NAN, &err), BR_NO_MEMORY, "n = 1000 elements take about");
    assert_true(br_memory_available() > 0);

    const size_t n[] = {100, 900}, steps[] = {10, 20};
    const struct br_study study = {.scene = &scene,
                                   .method = method,
                                   .reference_method = method,
                                   .reference_kind = &br_reference_fine,
                                   .reference = {1000, 20},
                                   .n = n,
                                   .steps = steps,
                                   .n_count = 2,
                                   .k_count = 2};
    const double levels = 30 * sizeof(size_t); /* the list of time levels of both k */
    MUST(br_fit_together(&study, 1, 3 * br_march_bytes(&o) + levels, &err));
    REFUSED(br_fit_together(&study, 1, 3 * br_march_bytes(&o) + levels / 2, &err), BR_NO_MEMORY,
            "5 marches at once take about");
    REFUSED(br_fit_together(&study, 1, NAN, &err), BR_NO_MEMORY, "5 marches");
    struct br_study finer = study; /* its axial field may be ahead, by a path a step */
    finer.reference.steps = 20000000;
    const double paths = 4e6 * sizeof(struct br_tip_path);
    MUST(br_fit_together(&finer, 1, 3 * br_march_bytes(&o) + levels + paths, &err));
    REFUSED(br_fit_together(&finer, 1, 3 * br_march_bytes(&o) + levels + 0.99 * paths, &err),
            BR_NO_MEMORY, "5 marches");

    struct br_warnings w = {0};
    o.n = 100000000000000;
    REFUSED(br_check_ahead(&o, &w, &err), BR_NO_MEMORY, "elements take about");
    o.n = 3000000;
    o.steps = 1000000000000;
    REFUSED(br_check_ahead(&o, &w, &err), BR_BAD_INPUT, "years, expected at most a hundred");
    const char *about = strstr(err.message, "about ");
    CLOSE(strtod(about + strlen("about "), NULL) / (br_march_seconds(&o) / 31557600), 1, 0.051);
    o.n = 10000;
    o.steps = 10000000000;
    MUST(br_check_ahead(&o, &w, &err));
    assert_non_null(br_test_warning(&w, BR_WARN_LONG));
    const double days = br_march_seconds(&o) / 86400, of_a_day = (double)o.steps / days;
    for (int longer = 0; longer < 2; longer++) { /* than a day: 22 hours, 26 hours */
        w = (struct br_warnings){0};
        o.steps = (size_t)(of_a_day * (longer ? 26 : 22) / 24);
        MUST(br_check_ahead(&o, &w, &err));
        assert_int_equal(br_test_warning(&w, BR_WARN_LONG) != NULL, longer);
    }
}

/* Two marches, a study by a fine run: what is added up, and which march is the dearest. */
TEST(test_work)
{
    struct br_scene scene = br_test_bare();
    const struct br_method method = br_method_default();
    struct br_method chooses = method;
    chooses.scheme = br_time_scheme_find("adaptive");
    const struct br_planned_march march[] = {
        {.scene = &scene, .method = &method, .n = 100, .steps = 1000},
        {.scene = &scene, .method = &method, .n = 400, .steps = 2000},
        {.scene = &scene, .method = &method, .n = 200, .steps = 100},
        {.scene = &scene, .method = &chooses, .n = 800, .steps = 10},
    };
    struct br_costs alone = {.alone = true}, together = {.together = true};
    double seconds = 0, bytes = 0;
    for (size_t i = 0; i < 4; i++) {
        br_costs_add_march(&alone, &march[i]);
        br_costs_add_march(&together, &march[i]);
        seconds += i < 3 ? br_march_seconds(&march[i]) : 0;
        bytes += br_march_bytes(&march[i]);
    }
    assert_int_equal(alone.marches, 4);
    assert_int_equal(alone.untimed, 1); /* it chooses its steps */
    assert_int_equal(alone.dearest.n, 400);
    CLOSE(alone.seconds, seconds, 1e-14 * seconds);
    assert_true(alone.steps == alone.seconds && alone.longest == br_march_seconds(&march[1]));
    assert_true(alone.bytes == br_march_bytes(&march[3]));
    CLOSE(together.bytes, bytes, 1e-14 * bytes);
    assert_true(br_costs_seconds(&alone, 8) == alone.seconds);
    assert_true(br_costs_seconds(&together, 2) == together.longest); /* no shorter than one */
    together.longest = 0;
    CLOSE(br_costs_seconds(&together, 2), seconds / 2, 1e-14 * seconds);

    const size_t n[] = {100, 400}, steps[] = {10, 20};
    const struct br_study study = {.scene = &scene,
                                   .method = method,
                                   .reference_method = method,
                                   .reference_kind = &br_reference_fine,
                                   .reference = {1600, 40},
                                   .n = n,
                                   .steps = steps,
                                   .n_count = 2,
                                   .k_count = 2};
    struct br_costs work = {0};
    br_costs_add_study(&work, &study);
    seconds = br_reference_seconds(&study);
    for (size_t c = 0; c < 4; c++)
        seconds += br_cell_seconds(&study, c);
    assert_int_equal(work.marches, 5);
    assert_int_equal(work.dearest.n, 1600);
    CLOSE(work.seconds, seconds, 1e-14 * seconds);
    assert_true(work.steps > 0 && work.steps < work.seconds); /* errors are found, too */
    assert_true(work.longest == br_reference_seconds(&study));
}
