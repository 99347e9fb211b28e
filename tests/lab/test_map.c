/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The map of extremes: what is drawn, cases that were wrong once, and how errors are measured. */
#include <math.h>
#include <string.h>

#include "solver/linear/linear_solver.h"
#include "study/estimate/warnings.h"
#include "tests/lab/map.h"
#include "tests/lab/track.h"
#include "tests/support.h"

/* A case depends on seed and index alone, and every row of a registry occurs. */
TEST(test_draws)
{
    size_t solver[8] = {0}, scheme[16] = {0};
    for (size_t i = 0; i < 120; i++) {
        static struct br_extreme_case one, again, other;
        char text[3][BR_EXTREME_TEXT];
        br_extreme_draw(7, i, &one);
        br_extreme_draw(7, i + 1, &other);
        br_extreme_draw(7, i, &again);
        br_extreme_scene(&one, text[0]);
        br_extreme_scene(&again, text[1]);
        br_extreme_scene(&other, text[2]);
        assert_string_equal(text[0], text[1]);
        assert_string_not_equal(text[0], text[2]);
        assert_true(one.n >= 1 && one.steps >= 1);
        for (size_t s = 0; br_linear_solvers[s]; s++)
            solver[s] += br_linear_solvers[s] == one.method.solver;
        for (size_t s = 0; br_time_schemes[s]; s++)
            scheme[s] += br_time_schemes[s] == one.method.scheme;
    }
    for (size_t s = 0; br_linear_solvers[s]; s++)
        assert_true(solver[s] > 0);
    for (size_t s = 0; br_time_schemes[s]; s++)
        assert_true(scheme[s] > 0);
}

struct named {
    uint64_t seed;
    size_t index;
};

static struct br_extreme_verdict find_verdict(struct named which,
                                              const struct br_extreme_options *options)
{
    struct br_extreme_case one;
    struct br_extreme_verdict verdict;
    br_extreme_draw(which.seed, which.index, &one);
    assert_int_equal(br_extreme_check(&one, options, &verdict, &err), BR_OK);
    return verdict;
}

static void check_sound(const struct named *sound, size_t count, bool quick)
{
    for (size_t i = 0; i < count; i++) {
        const struct br_extreme_verdict verdict =
            find_verdict(sound[i], &(struct br_extreme_options){.quick = quick});
        if (verdict.which == BR_EXTREME_WRONG)
            fail_msg("case %zu of seed %zu: %s", sound[i].index, (size_t)sound[i].seed,
                     verdict.why);
    }
}

/* Each of these was called wrong once. Seed 1: by a balance without the terms that a step starts
 * from (246, 351, 741, 751, 866), where all load goes into the tip (1277, 1304), by velocities that
 * an earlier one was rounded to (240, 503, 681), by the bound of a contact that is a million times
 * stiffer than the rod (690, 1136), by what elimination leaves (502, 852), by a scheme that began
 * anew where a contact without stiffness opened (102). Seed 7: by a
 * reference whose iterations add up (91). Seed 4: by a residual
 * where load and velocity cross zero at once (94), by steps that add many velocities (1851). By a
 * friction force that obeys the march's bound, which is that of the nodes to round-off (3, 512; 5,
 * 241; 10, 151); by what a light beam's velocities are rounded to (8, 811). By a
 * short step over a switch, each of whose stages obeys the law (3, 802). */
TEST(test_sound_cases)
{
    static const struct named sound[] = {
        {1, 240}, {1, 246},  {1, 351}, {1, 502},  {1, 503},  {1, 681},  {1, 690}, {1, 741},
        {1, 751}, {1, 852},  {1, 866}, {1, 1136}, {1, 1277}, {1, 1304}, {7, 91},  {1, 102},
        {4, 94},  {4, 1851}, {3, 512}, {5, 241},  {10, 151}, {8, 811},  {3, 802}};
    check_sound(sound, sizeof sound / sizeof *sound, true);
}

/* The same with the exact solution, where a layer dies away within a step (3, 186; 4, 175) or is
 * narrower than elements (5, 45), where steps are longer than a vibration's period (3, 20), where a
 * coarse mesh sways more than a fine one (5, 229), and where Coulomb's bound begins at a gap
 * without contact stiffness, which the exact solution missed, too (3, 101; 1, 212), where two
 * tolerances choose the same steps (2, 284; 4, 71), where chosen steps have few levels (4, 145);
 * where a contact throws a pressed tip back within a step (7, 430), a layer lies between the
 * reference's places (7, 813), and a beam follows its load at once (6, 459); where a velocity dies
 * away within a step of every march (20261123, 613), and a light beam swings as fast as it is
 * marched (73, 534); where equal steps of R miss what a tolerance sees (20261215, 36), and those of
 * the reference do (20270207, 33). Those that take long are for long tests.
 */
TEST(test_hard_cases)
{
    static const struct named hard[] = {
        {20261123, 613}, {73, 534}, {20261215, 36}, {20270207, 33}, {1, 1012}, {1, 1248}, {3, 20},
        {3, 101},        {1, 212},  {2, 284},       {4, 71},        {4, 145},  {5, 229},  {7, 430},
        {7, 813},        {6, 459},  {4, 175},       {5, 45},        {3, 186}};
    check_sound(hard, br_test_long() ? sizeof hard / sizeof *hard : 16, false);
}

/* Who states less than is true is silently wrong: right ones that boast are, and one that says that
 * it does not know is not. */
TEST(test_boast)
{
    const struct br_extreme_options honest = {.quick = true},
                                    boast = {.quick = true, .stated_divisor = 1e4};
    int known = 0, wrong = 0;
    for (size_t i = 1; i < 16 && (known < 4 || br_test_long()); i++) {
        const struct named one = {1, i};
        const struct br_extreme_verdict truth = find_verdict(one, &honest);
        assert_true(truth.which != BR_EXTREME_WRONG);
        if (truth.which == BR_EXTREME_RIGHT && truth.known && truth.error > truth.stated / 1e3) {
            known++;
            wrong += find_verdict(one, &boast).which == BR_EXTREME_WRONG;
        } else if (!truth.known)
            assert_int_equal(find_verdict(one, &boast).which, truth.which);
    }
    assert_true(known >= 3);
    AT_MOST(0.5 * known, wrong);
}

/* Classes by hand: who states less than is true is wrong, whoever checks; 5 % where nothing is
 * stated. */
TEST(test_classes_by_hand)
{
    enum { TIME = 1u << BR_WARN_LOAD_TIME, UNSTABLE = 1u << BR_WARN_UNSTABLE };
    enum { OTHER = 1u << BR_WARN_ROUND_OFF | 1u << BR_WARN_INACCURATE | 1u << BR_WARN_UNKNOWN };
    static const struct {
        enum br_extreme_by by;
        bool known;
        double error, slack, stated;
        unsigned warned;
        enum br_extreme_class which;
    } rows[] = {
        {BR_BY_NOBODY, true, 0, 0, 1, 0, BR_EXTREME_UNCHECKED},
        {BR_BY_NOBODY, true, NAN, NAN, NAN, TIME, BR_EXTREME_UNCHECKED},
        {BR_BY_EXACT, true, 0, 0, 0, 0, BR_EXTREME_RIGHT},
        {BR_BY_EXACT, true, 0.01, 0, 0.01, 0, BR_EXTREME_RIGHT},
        {BR_BY_EXACT, true, 0.05, 0, 0.05, 0, BR_EXTREME_RIGHT},
        {BR_BY_EXACT, true, 0.0101, 0, 0.01, 0, BR_EXTREME_WRONG},
        {BR_BY_REFINEMENT, true, 0.0101, 0, 0.01, OTHER, BR_EXTREME_WRONG},
        {BR_BY_EXACT, true, 0.0101, 0.0002, 0.01, 0, BR_EXTREME_RIGHT},
        {BR_BY_EXACT, true, 1e-9, 0, 0, 0, BR_EXTREME_WRONG},
        {BR_BY_EXACT, true, 0.0101, 0, 0.01, TIME, BR_EXTREME_WARNED},
        {BR_BY_EXACT, true, 0.0101, 0, 0.01, 1u << BR_WARN_LOAD_SPACE, BR_EXTREME_WARNED},
        {BR_BY_EXACT, true, 0.0101, 0, 0.01, 1u << BR_WARN_INITIAL, BR_EXTREME_WARNED},
        {BR_BY_EXACT, true, 0.0101, 0, 0.01, 1u << BR_WARN_BOUNCE, BR_EXTREME_WARNED},
        {BR_BY_EXACT, true, 0.06, 0, 0.06, 0, BR_EXTREME_WARNED},
        {BR_BY_EXACT, true, 0.06, 0, INFINITY, 0, BR_EXTREME_WARNED},
        {BR_BY_EXACT, true, 0.06, 0, 0.06, UNSTABLE, BR_EXTREME_UNSTABLE},
        {BR_BY_EXACT, true, 1e30, 0, 0.06, UNSTABLE, BR_EXTREME_UNSTABLE},
        {BR_BY_EXACT, false, 0.04, 0, INFINITY, UNSTABLE, BR_EXTREME_RIGHT},
        {BR_BY_EXACT, false, 0.05, 0, INFINITY, 0, BR_EXTREME_RIGHT},
        {BR_BY_EXACT, false, 0.0501, 0, INFINITY, 0, BR_EXTREME_UNKNOWN},
        {BR_BY_EXACT, false, 0.04, 0, 0.03, 0, BR_EXTREME_WRONG},
        {BR_BY_EXACT, false, NAN, 0, INFINITY, 0, BR_EXTREME_UNKNOWN},
        {BR_BY_EXACT, true, NAN, 0, 0.01, 0, BR_EXTREME_WRONG},
        {BR_BY_EXACT, true, NAN, 0, INFINITY, 0, BR_EXTREME_WRONG},
        {BR_BY_EXACT, true, 0.01, NAN, 0.01, 0, BR_EXTREME_WRONG},
        {BR_BY_EXACT, true, 0.01, 0, NAN, 0, BR_EXTREME_WRONG},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const struct br_extreme_verdict v = {.by = rows[i].by,
                                             .known = rows[i].known,
                                             .error = rows[i].error,
                                             .warned = rows[i].warned};
        const double beyond = br_extreme_beyond(rows[i].error, rows[i].slack, rows[i].stated);
        const enum br_extreme_class which = br_extreme_class_of(&v, beyond);
        if (which != rows[i].which)
            fail_msg("row %zu: %s, expected %s", i, br_extreme_words[which],
                     br_extreme_words[rows[i].which]);
    }
    CLOSE(br_extreme_beyond(0.5, 0.1, 0.01), 40, 1e-13);
}

/* ---- how far marches are from each other ---- */

/* Nodes alone would be far better, or worse, than what is between them. */
TEST(test_places)
{
    const size_t meshes[] = {1, 7, 112, 1000};
    for (size_t i = 0; i < sizeof meshes / sizeof *meshes; i++) {
        const struct br_track_samples p = br_track_samples(meshes[i], 10);
        size_t inside = 0;
        for (size_t j = 0; j + 1 < p.points; j++) {
            assert_true(p.point[j] > 0 && p.point[j] < p.point[j + 1]);
            inside += p.point[j] % p.parts != 0;
        }
        assert_int_equal(p.point[p.points - 1], meshes[i] * p.parts);
        assert_true(p.parts == 1 || inside >= BR_TRACK_EVEN / 2);
    }
}

/* A rod that is `rest` everywhere, and `tip` at its end. */
static struct br_track *made_track(double rest, double tip)
{
    struct br_track *t = br_allocate(1, sizeof *t);
    assert_non_null(t);
    t->samples = br_track_samples(3, 10);
    t->sampled = t->samples.levels;
    t->largest[BR_AXIAL] = fmax(fabs(rest), fabs(tip));
    for (size_t i = 0; i < t->samples.levels; i++)
        for (size_t p = 0; p < t->samples.points; p++)
            t->value[BR_AXIAL][i][p] = p + 1 < t->samples.points ? rest : tip;
    return t;
}

/* What is far narrower than the last interval weighs nothing in the mean; squares that are lost to
 * underflow are not; what is no number is not right. */
TEST(test_errors)
{
    static const struct {
        double own[2], reference[2], least, most;
    } rows[] = {
        {{1, 1}, {2, 2}, 0.5, 0.5},
        {{1, 5}, {1, 1}, 0, 0},
        {{1, 1}, {1, 5}, 0, 0},
        {{1, 1}, {0.5, 5}, 0.9, 1.1},
        {{1e-170, 1e-170}, {2e-170, 2e-170}, 0.5, 0.5},
        {{0, 0}, {0, 0}, 0, 0},
        {{1, NAN}, {1, 1}, NAN, NAN},
        {{NAN, 1}, {1, 1}, NAN, NAN},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        FREED struct br_track *own = made_track(rows[i].own[0], rows[i].own[1]);
        FREED struct br_track *reference = made_track(rows[i].reference[0], rows[i].reference[1]);
        double sure;
        const double e = br_track_error(own, reference, BR_AXIAL, &sure);
        if (isnan(rows[i].least) ? !isnan(e)
                                 : !(e >= rows[i].least - 1e-12 && e <= rows[i].most + 1e-12))
            fail_msg("row %zu: %g", i, e);
    }
}
