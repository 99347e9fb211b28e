/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The map of extremes: what is drawn, kept, counted and shrunk, by a judge that is planted. */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "study/extreme_count.h"
#include "study/rescale.h"
#include "study/scene_file.h"
#include "study/shrink.h"
#include "tests/support.h"

/* Wrong wherever a stiff contact is in a scene with friction; right elsewhere. */
static enum br_status planted(const struct br_extreme_case *one,
                              const struct br_extreme_court *court,
                              struct br_extreme_verdict *verdict, struct br_error *err)
{
    (void)court;
    (void)err;
    *verdict = (struct br_extreme_verdict){.error = 0.25, .units = NAN, .round_off = 1e-12};
    if (one->contact && one->contact_stiffness > 1e3 && one->law == BR_TRESCA) {
        verdict->which = BR_EXTREME_WRONG;
        snprintf(verdict->why, sizeof verdict->why, "planted at %g", one->contact_stiffness);
    }
    return BR_OK;
}

static void draw_all(size_t cases, size_t solver[8], size_t scheme[16])
{
    struct br_extreme_case one;
    for (size_t i = 0; i < cases; i++) {
        br_extreme_draw(7, i, &one);
        for (size_t s = 0; br_linear_solvers[s]; s++)
            solver[s] += br_linear_solvers[s] == one.method.solver;
        for (size_t s = 0; br_time_schemes[s]; s++)
            scheme[s] += br_time_schemes[s] == one.method.scheme;
        assert_true(one.n >= 1 && one.steps >= 1);
    }
}

/* A case depends on seed and index alone, and every row of a registry occurs. */
static void test_draws(void **state)
{
    (void)state;
    size_t solver[8] = {0}, scheme[16] = {0};
    static struct br_extreme_case a, b, other;
    char first[BR_EXTREME_TEXT], second[BR_EXTREME_TEXT];
    br_extreme_draw(3, 5, &a);
    br_extreme_draw(3, 6, &other);
    br_extreme_draw(3, 5, &b);
    br_extreme_scene(&a, first);
    br_extreme_scene(&b, second);
    assert_string_equal(first, second);
    br_extreme_scene(&other, second);
    assert_string_not_equal(first, second);
    draw_all(120, solver, scheme);
    for (size_t s = 0; br_linear_solvers[s]; s++)
        assert_true(solver[s] > 0);
    for (size_t s = 0; br_time_schemes[s]; s++)
        assert_true(scheme[s] > 0);
}

static struct br_extreme_map run(size_t cases, int threads, const char *kept)
{
    struct br_error err = {0};
    struct br_extreme_map map;
    const struct br_extreme_wish wish = {.seed = 11,
                                         .cases = cases,
                                         .threads = threads,
                                         .kept = kept,
                                         .program = "test",
                                         .judge = planted};
    MUST(br_extreme_map_run(&wish, &map, &err));
    return map;
}

/* What was kept is not done again, a torn last line is; the result is the same. */
static void test_resumes(void **state)
{
    (void)state;
    char kept[] = "/tmp/beamrate-map-XXXXXX";
    assert_true(close(mkstemp(kept)) == 0);
    struct br_extreme_map part = run(20, 2, kept);
    assert_int_equal(part.resumed, 0);
    FILE *file = fopen(kept, "a");
    fputs("20 right 0 0.25 n", file);
    fclose(file);
    struct br_extreme_map whole = run(60, 3, kept), fresh = run(60, 1, NULL);
    assert_int_equal(whole.resumed, 20);
    assert_memory_equal(whole.count, fresh.count, sizeof fresh.count);
    assert_true(fresh.count[BR_EXTREME_WRONG] > 0 && fresh.count[BR_EXTREME_RIGHT] > 0);
    assert_int_equal(whole.shrunks, fresh.shrunks);
    for (size_t i = 0; i < fresh.shrunks; i++)
        assert_string_equal(whole.shrunk[i].command, fresh.shrunk[i].command);
    br_extreme_map_clear(&part);
    br_extreme_map_clear(&whole);
    br_extreme_map_clear(&fresh);
    unlink(kept);
}

/* The cases of other options are neither taken for one's own nor thrown away. */
static void test_other_kept(void **state)
{
    (void)state;
    char kept[] = "/tmp/beamrate-map-XXXXXX", line[200] = "";
    assert_true(close(mkstemp(kept)) == 0);
    FILE *file = fopen(kept, "w");
    fputs("beamrate extremes map 1, test, seed 99, rounding 0\n0 right 0 0.25 0 0 0;\n", file);
    fclose(file);
    struct br_error err = {0};
    struct br_extreme_map map;
    const struct br_extreme_wish wish = {
        .seed = 98, .cases = 4, .kept = kept, .program = "test", .judge = planted};
    REFUSED(br_extreme_map_run(&wish, &map, &err), BR_BAD_INPUT, "seed 99, rounding 0', expected");
    assert_non_null(strstr(err.message, "seed 98, rounding 0'"));
    br_extreme_map_clear(&map);
    file = fopen(kept, "r");
    assert_non_null(fgets(line, sizeof line, file));
    assert_non_null(fgets(line, sizeof line, file));
    fclose(file);
    assert_string_equal(line, "0 right 0 0.25 0 0 0;\n");
    unlink(kept);
}

/* What is left of a planted error is what was planted. */
static void test_shrinks(void **state)
{
    (void)state;
    struct br_extreme_map map = run(60, 2, NULL);
    for (size_t i = 0; i < map.shrunks; i++) {
        const struct br_extreme_case *c = &map.shrunk[i].one;
        assert_int_equal(map.shrunk[i].verdict.which, BR_EXTREME_WRONG);
        assert_true(c->n == 1 && c->steps == 1 && c->length == 1 && c->duration == 1);
        assert_true(c->density == 0 && c->gap == 0 && c->friction == 0);
        assert_true(c->method.scheme == br_time_schemes[0]);
        assert_true(c->contact && c->law == BR_TRESCA && c->contact_stiffness > 1e3);
    }
    br_extreme_map_clear(&map);
}

/* The tallies of an axis sum up to no more than all cases; reasons are alike but for numbers. */
static void test_counts(void **state)
{
    (void)state;
    struct br_error err = {0};
    struct br_extreme_map map = run(60, 2, NULL);
    struct br_extreme_counts counts;
    MUST(br_extreme_count(&map, &counts, &err));
    assert_int_equal(counts.tally[0].cases, 60);
    size_t schemes = 0;
    for (size_t i = 0; i < counts.tallies; i++)
        if (counts.tally[i].axis == br_extreme_axes[0])
            schemes += counts.tally[i].cases;
    assert_int_equal(schemes, 60);
    assert_int_equal(counts.reasons, 1);
    assert_string_equal(counts.reason[0].text, "planted at #");
    assert_int_equal(counts.reason[0].cases, map.count[BR_EXTREME_WRONG]);
    br_extreme_counts_clear(&counts);
    br_extreme_map_clear(&map);
}

/* A bundled scene is right; in other units it is the same scene. */
static void test_other_units(void **state)
{
    (void)state;
    struct br_error err = {0};
    struct br_scene scene = br_test_bundled("example2"), other;
    const struct br_units_change units = {3, 7, 11};
    const struct br_method method = br_test_method(NULL, "implicit", NULL);
    MUST(br_rescale(&scene, &units, &other, &err));
    const struct br_test_end a = br_test_run(&scene, 20, 50, &method);
    const struct br_test_end b = br_test_run(&other, 20, 50, &method);
    CLOSE(b.u_tip / 3, a.u_tip, 1e-12 * fabs(a.u_tip));
    CLOSE(b.w_tip / 3, a.w_tip, 1e-12 * fabs(a.w_tip));
    br_scene_clear(&other);
    br_scene_clear(&scene);
}

/* Each of these was called wrong once: by a balance without the terms that a step starts from (246,
 * 351, 741, 751, 866), where all load goes into the tip (1277, 1304), by velocities that an earlier
 * one was rounded to (240, 503, 681), by the bound of a contact that is a million times stiffer
 * than the rod (690, 1136), by what elimination leaves (502, 852). */
static void test_sound_cases(void **state)
{
    (void)state;
    static const size_t sound[] = {240, 246, 351, 502, 503,  681,  690,
                                   741, 751, 852, 866, 1136, 1277, 1304};
    const struct br_extreme_court court = {.quick = true};
    for (size_t i = 0; i < sizeof sound / sizeof *sound; i++) {
        struct br_extreme_case one;
        struct br_extreme_verdict verdict;
        struct br_error err = {0};
        br_extreme_draw(1, sound[i], &one);
        assert_int_equal(br_extreme_judge(&one, &court, &verdict, &err), BR_OK);
        if (verdict.which == BR_EXTREME_WRONG)
            fail_msg("case %zu: %s", sound[i], verdict.why);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_draws),       cmocka_unit_test(test_resumes),
        cmocka_unit_test(test_other_kept),  cmocka_unit_test(test_shrinks),
        cmocka_unit_test(test_counts),      cmocka_unit_test(test_other_units),
        cmocka_unit_test(test_sound_cases),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
