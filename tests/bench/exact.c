/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Measures the time of the exact reference for hard scenes: impacts, reversals, little damping,
 * moving loads. The unit is a march by `plain` in the same run, so that the machine and its load
 * matter little. Run it with `meson test --benchmark exact`. It fails on wrong results only:
 * another number of switches, or an own error above the limit. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/clock.h"
#include "reference/exact/exact.h"
#include "solver/method.h"
#include "study/scene/file.h"
#include "tests/support.h"

/* The march that is the unit: Example 2. */
enum { N = 1000, STEPS = 10000 };

static const struct row {
    const char *scene;
    size_t switches;
} rows[] = {
    {"hammer", 20}, {"ringing", 20},     {"saw", 41},   {"shuttle", 67},
    {"rattle", 24}, {"rattle_long", 66}, {"wheel", 10}, {"front", 1},
};

static double unit_seconds(void)
{
    struct br_scene scene = br_test_bundled("example2");
    const struct br_method method = br_test_method("plain", NULL, NULL);
    struct br_march *march = br_test_march(&scene, N, STEPS, &method);
    const double start = br_thread_seconds();
    br_test_advance(march, STEPS);
    const double seconds = br_thread_seconds() - start;
    br_march_free(march);
    br_scene_clear(&scene);
    return seconds;
}

static struct br_scene read_scene(const char *name)
{
    struct br_scene scene = {0};
    char path[1024];
    snprintf(path, sizeof path, "%s/tests/bench/exact/%s.yaml", getenv("BEAMRATE_DATA"), name);
    MUST(br_scene_read(path, &scene, &err));
    return scene;
}

static size_t count_switches(const struct br_exact *exact)
{
    size_t count, switches = 0;
    const struct br_exact_event *event = br_exact_events(exact, &count);
    for (size_t i = 0; i < count; i++)
        switches += event[i].time > 0;
    return switches;
}

/* The larger relative error of the two fields' displacements. */
static double own_error(const struct br_exact *exact)
{
    double most = 0;
    for (int i = 0; i < BR_FIELDS; i++) {
        const struct br_exact_report r = br_exact_report(exact, (enum br_field_kind)i);
        if (r.modes)
            most = fmax(most, r.error.displacement / r.largest.displacement);
    }
    return most;
}

static void time_row(const struct row *row, double unit)
{
    struct br_scene scene = read_scene(row->scene);
    struct br_exact *exact = NULL;
    const struct br_exact_options options = {.acceptable = 1e-5}; /* as a study does */
    const double start = br_thread_seconds();
    MUST(br_exact_create(&exact, &scene, &options, &err));
    const double seconds = br_thread_seconds() - start;
    printf("%-12s %8zu %10.1e %10.1f %8.2f\n", row->scene, count_switches(exact), own_error(exact),
           seconds / unit, seconds);
    fflush(stdout);
    assert_int_equal(count_switches(exact), row->switches);
    AT_MOST(own_error(exact), 1e-10);
    br_exact_free(exact);
    br_scene_clear(&scene);
}

static void test_hard_scenes(void **state)
{
    (void)state;
    const double unit = unit_seconds();
    printf("\nThe exact reference of hard scenes; a unit is a march of Example 2 by plain, n = %d, "
           "%d steps: %.3f s\n",
           N, STEPS, unit);
    printf("%-12s %8s %10s %10s %8s\n", "scene", "switches", "own error", "units", "s");
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        time_row(&rows[i], unit);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_hard_scenes)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
