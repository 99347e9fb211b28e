/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Named methods, trials and trades: choosing on made-up trials, and errors that are a study's. */
#include <malloc.h>
#include <math.h>
#include <string.h>

#include "base/clock.h"
#include "solver/linear/linear_solver.h"
#include "solver/scene.h"
#include "study/grid/sweep.h"
#include "study/trade/trade.h"
#include "support.h"

/* ---- choosing, on made-up trials ---- */

static struct br_named_method pair[2];

/* Trials of a relative error and cost; nothing of them was marched. The reference's own error is
 * added: what it cannot tell is no success. */
static const struct {
    int named;
    double error, seconds, own;
    size_t solves;
    enum br_trial_end end;
    bool front;
} made[] = {
    {0, 1e-2, 1, NAN, 9, BR_TRIAL_DONE, true},
    {0, 1e-3, 2, NAN, 9, BR_TRIAL_DONE, true},
    {0, 1e-3, 3, NAN, 7, BR_TRIAL_DONE, false}, /* slower */
    {1, 1e-2, 1, NAN, 9, BR_TRIAL_DONE, false}, /* equal to the first */
    {1, 2e-3, 2, NAN, 7, BR_TRIAL_DONE, false}, /* worse */
    {1, NAN, 0.1, NAN, 9, BR_TRIAL_DONE, false},
    {1, 1e-9, NAN, NAN, 9, BR_TRIAL_DONE, false},
    {1, 1e-4, 9, NAN, 9, BR_TRIAL_DONE, true},
    {0, 1e-20, 1e-9, NAN, 1, BR_TRIAL_OVER, false},
    {1, 1e-4 * (1 - 1e-9), 20, NAN, 9, BR_TRIAL_DONE, false}, /* round-off */
    {0, 1e-3, 2, NAN, 7, BR_TRIAL_DONE, false},               /* fewer solves */
    {0, 0.9e-4, 7, 0.2e-4, 9, BR_TRIAL_DOUBTFUL, true},       /* at most 1.1e-4 */
    {1, 1e-12, 0.01, NAN, 9, BR_TRIAL_FAILED, false},
    {1, 1e-12, 0.01, NAN, 9, BR_TRIAL_UNSTABLE, false},
};
enum { MADE = sizeof made / sizeof *made, NOBODY = MADE };

static const struct {
    double target;
    int only; /* a named method; 2: any */
    size_t cheapest;
} choices[] = {
    {2e-2, 2, 0},      {2e-2, 1, 3},      {1e-3, 2, 10}, {1e-3, 1, 7},
    {1.2e-4, 0, 11},   {1e-4, 0, NOBODY}, {1e-4, 2, 7},  {1e-4 * (1 - 1e-10), 2, 9},
    {9e-5, 2, NOBODY},
};

TEST(test_choices)
{
    struct br_trial t[MADE];
    struct br_point point[MADE];
    for (size_t i = 0; i < MADE; i++)
        t[i] = (struct br_trial){
            .named = &pair[made[i].named],
            .at = {10, 10},
            .cost = {.march = made[i].seconds, .counts = {.stages = made[i].solves}},
            .error = {2 * made[i].error, made[i].error, made[i].error},
            .scale = 2,
            .own = 2 * made[i].own,
            .end = made[i].end,
        };
    br_trials_points(t, MADE, pair, point);
    br_work_front(point, MADE);
    for (size_t i = 0; i < MADE; i++)
        if (point[i].front != made[i].front)
            fail_msg("trial %zu: found %d, expected %d", i, point[i].front, made[i].front);
    for (size_t i = 0; i < sizeof choices / sizeof *choices; i++) {
        const size_t found =
            br_work_cheapest(point, MADE, choices[i].target,
                             choices[i].only < 2 ? (size_t)choices[i].only : SIZE_MAX, SIZE_MAX);
        if (found != choices[i].cheapest)
            fail_msg("to %g: found %zu, expected %zu", choices[i].target, found,
                     choices[i].cheapest);
    }
    assert_int_equal(br_work_cheapest(point, 0, 1, SIZE_MAX, SIZE_MAX), 0);
    CLOSE(br_trade_digits_per_second(&t[7]), 4.0 / 9, 1e-9);
    assert_true(isnan(br_trade_digits_per_second(&t[8])));
    t[0].scale = 0; /* no relative error of a solution that is zero */
    br_trials_points(t, 1, pair, point);
    assert_int_equal(br_work_cheapest(point, 1, 1, SIZE_MAX, SIZE_MAX), 1);
    CLOSE(br_trade_target(0), 1e-2, 1e-14);
    CLOSE(br_trade_target(BR_TRADE_DIGITS - 1), 1e-10, 1e-22);
}

/* ---- names ---- */

TEST(test_names)
{
    static const struct {
        const char *name, *refusal;
    } wrong[] = {
        {"bdf9", "--methods: 'bdf9': found 'bdf9'"},
        {"bdf2+", "found ''"},
        {"bdf2,", "found ''"},
        {"bdf2+euler", "given already"},
        {"bdf2+lagged", "lagged"},
        {"bdf2,bdf2+implicit", "--methods: bdf2+implicit is given twice"},
    };
    struct br_named_methods all;
    MUST(br_named_methods_read("euler,regularised+bdf2+umfpack+p2", &all, &err));
    assert_int_equal(all.count, 2);
    assert_false(all.list[0].method.contact->at_new_step);
    assert_true(br_trade_is_printed_method(&all.list[0]));
    const struct br_method *m = &all.list[1].method;
    assert_true(m->contact->at_new_step);
    assert_string_equal(m->scheme->name, "bdf2");
    assert_string_equal(m->friction->name, "regularised");
    assert_string_equal(m->solver->name, "umfpack");
    assert_int_equal(m->axial_degree, 2);
    assert_false(br_trade_is_printed_method(&all.list[1]));
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        REFUSED(br_named_methods_read(wrong[i].name, &all, &err), BR_BAD_INPUT, wrong[i].refusal);
}

/* All schemes are there, and none twice that is the same in this scene. */
TEST(test_default_named_methods)
{
    const char *const scenes[] = {"example2", "example3"};
    for (size_t s = 0; s < 2; s++) {
        OWNED(br_scene) scene = br_test_bundled(scenes[s]);
        struct br_named_methods all;
        size_t schemes[32] = {0};
        br_named_methods_default(&scene, &all);
        for (size_t i = 0; i < all.count; i++)
            for (size_t j = 0; br_time_schemes[j]; j++)
                schemes[j] += all.list[i].method.scheme == br_time_schemes[j];
        for (size_t j = 0; br_time_schemes[j]; j++)
            assert_true(schemes[j] > 0);
        assert_int_equal(schemes[0], s == 0 ? 2 : 1); /* lagged and implicit, where it matters */
    }
}

/* ---- trials ---- */

/* Errors are those of a study's cells, in each norm; counts are the march's. */
TEST(test_errors_are_a_study_s)
{
    OWNED(br_scene) scene = br_test_bundled("example2");
    struct br_named_methods all;
    MUST(br_named_methods_read("euler+lagged,bdf2,bdf2+p2", &all, &err));
    struct br_trial trial[] = {
        {.named = &all.list[0], .at = {8, 20}},
        {.named = &all.list[1], .at = {8, 20}},
        {.named = &all.list[0], .at = {16, 10}},
        {.named = &all.list[2], .at = {8, 20}},
    };
    enum { COUNT = sizeof trial / sizeof *trial };
    const struct br_norm *const norm[] = {&br_norm_tip, &br_norm_l2};
    struct br_trial_request request = br_trial_request_default(&scene);
    request.repeats = 1;
    for (size_t m = 0; m < 2; m++) {
        request.norm = norm[m];
        MUST(br_trials_run(trial, COUNT, &request, &err));
        for (size_t i = 0; i < COUNT; i++) {
            OWNED(br_study)
            study = br_test_study(&scene, &br_reference_exact, 1, &trial[i].at.n, 1,
                                  &trial[i].at.steps);
            study.norm = norm[m];
            study.method = br_trial_method(&trial[i]);
            MUST(br_study_run(&study, 1, 1, NULL, &err));
            for (enum br_part part = 0; part < BR_PARTS; part++)
                CLOSE(trial[i].error[part], study.cell[0].error[part],
                      1e-13 * study.cell[0].error[BR_PART_TOTAL]);
            CLOSE(trial[i].scale, study.reference_scale, 1e-12 * study.reference_scale);
        }
    }
    for (size_t i = 0; i < COUNT; i++) {
        assert_int_equal(trial[i].end, BR_TRIAL_DONE);
        assert_int_equal(trial[i].cost.counts.steps, trial[i].at.steps);
        assert_true(br_trial_seconds(&trial[i]) > 0);
        assert_int_equal(trial[i].cost.repeats, 1);
        AT_MOST(trial[i].own, 1e-9 * trial[i].scale);
    }
}

/* Also where no number of levels has the levels of all trials on a mesh. */
TEST(test_steps_without_common_levels)
{
    static const size_t steps[] = {947, 1259, 1687, 2251, 3001, 4001};
    enum { COUNT = sizeof steps / sizeof *steps };
    OWNED(br_scene) scene = br_test_bundled("example3");
    struct br_named_methods all;
    struct br_trial trial[COUNT], alone;
    MUST(br_named_methods_read("bdf2", &all, &err));
    struct br_trial_request request = br_trial_request_default(&scene);
    request.repeats = 1;
    for (size_t i = 0; i < COUNT; i++)
        trial[i] = br_trial_at(all.list, 8, steps[i], 0);
    MUST(br_trials_run(trial, COUNT, &request, &err));
    for (size_t i = 0; i < COUNT; i++) {
        assert_int_equal(trial[i].end, BR_TRIAL_DONE);
        alone = br_trial_at(all.list, 8, steps[i], 0);
        MUST(br_trials_run(&alone, 1, &request, &err));
        CLOSE(br_trial_relative(&trial[i]), br_trial_relative(&alone), 1e-15);
    }
}

static bool stop_at_once(void *self)
{
    (void)self;
    return true;
}

/* What fails, or takes too long, stays in the list with its reason; an interruption ends all. */
TEST(test_ends)
{
    OWNED(br_scene) scene = br_test_bundled("example2");
    struct br_named_methods all;
    MUST(br_named_methods_read("euler+regularised,euler,euler+implicit", &all, &err));
    scene.friction.regularisation = 0; /* so that the first has no mu */
    struct br_trial trial[] = {
        {.named = &all.list[0], .at = {8, 10}},
        {.named = &all.list[1], .at = {100, 100000000}},
        {.named = &all.list[2], .at = {8, 10}},
    };
    struct br_trial_request request = br_trial_request_default(&scene);
    request.time_limit = 0.02;
    MUST(br_trials_run(trial, 3, &request, &err));
    assert_int_equal(trial[0].end, BR_TRIAL_FAILED);
    assert_non_null(strstr(trial[0].failure.message, "mu > 0"));
    assert_int_equal(trial[1].end, BR_TRIAL_OVER);
    assert_non_null(strstr(trial[1].failure.message, "time limit"));
    assert_int_equal(trial[2].end, BR_TRIAL_DONE);
    for (size_t i = 0; i < 2; i++) {
        assert_true(isnan(br_trial_seconds(&trial[i])));
        assert_true(isnan(br_trial_bound(&trial[i])));
    }
    assert_true(br_trial_bound(&trial[2]) > 0);
    request.observer = &(const struct br_observer){.stop = stop_at_once};
    REFUSED(br_trials_run(trial, 3, &request, &err), BR_INTERRUPTED, "interrupted");
}

/* ---- grids ---- */

static struct br_trade *laid_out(const struct br_scene *scene, const char *methods,
                                 const struct br_trade_grid *grid)
{
    struct br_trade *t = calloc(1, sizeof *t);
    assert_non_null(t);
    MUST(br_named_methods_read(methods, &t->methods, &err));
    t->request = br_trial_request_default(scene);
    MUST(br_trade_lay_out(t, grid, &err));
    return t;
}

static void drop(struct br_trade *t)
{
    br_trade_clear(t);
    free(t);
}

/* The printed cells are the paper's method's, each once. */
TEST(test_printed)
{
    OWNED(br_scene) scene = br_test_bundled("example2");
    struct br_printed_cell cells[] = {{100, 0.01, 1}, {200, 0.0005, 1}, {3200, 1e-4, 1}};
    const struct br_printed printed = {cells, 3};
    struct br_trade *t = laid_out(&scene, "euler+lagged,euler+implicit",
                                  &(struct br_trade_grid){.printed = &printed});
    size_t marked = 0;
    for (size_t i = 0; i < t->count; i++) {
        marked += t->trial[i].printed;
        assert_true(!t->trial[i].printed || t->trial[i].named == &t->methods.list[0]);
        for (size_t j = 0; j < i; j++)
            assert_false(t->trial[i].named == t->trial[j].named &&
                         t->trial[i].at.n == t->trial[j].at.n &&
                         t->trial[i].at.steps == t->trial[j].at.steps);
    }
    assert_int_equal(marked, 3);
    drop(t);
}

/* More tolerances than steps; their trials have room. */
TEST(test_many_tolerances)
{
    struct br_scene scene = br_test_bundled("example2");
    const size_t one[] = {10};
    double tolerance[40];
    for (size_t i = 0; i < 40; i++)
        tolerance[i] = pow(2, -(double)i - 3);
    struct br_trade *t = laid_out(&scene, "adaptive",
                                  &(struct br_trade_grid){.n = one,
                                                          .steps = one,
                                                          .tolerance = tolerance,
                                                          .n_count = 1,
                                                          .step_count = 1,
                                                          .tolerances = 40});
    assert_int_equal(t->count, 40);
    assert_true(malloc_usable_size(t->trial) >= t->count * sizeof *t->trial);
    drop(t);
    br_scene_clear(&scene);
}

/* Lists that are given are tried whole. */
TEST(test_lists_are_tried)
{
    OWNED(br_scene) scene = br_test_bundled("example2");
    const size_t n[] = {100000}, steps[] = {10, 1000000};
    const double tolerance[] = {1e-3, 1e-5, 1e-7};
    struct br_trade *t = laid_out(&scene, "bdf2,adaptive",
                                  &(struct br_trade_grid){.n = n,
                                                          .steps = steps,
                                                          .tolerance = tolerance,
                                                          .n_count = 1,
                                                          .step_count = 2,
                                                          .tolerances = 3});
    assert_int_equal(t->count, 5);
    assert_int_equal(t->trial[1].at.steps, 1000000);
    CLOSE(br_trial_method(&t->trial[4]).tolerance, 1e-7, 1e-20);
    CLOSE(br_time_step(&scene, t->trial[0].at.steps), 0.1, 1e-15);
    drop(t);
    t = laid_out(
        &scene, "adaptive", /* beside steps that are not given */
        &(struct br_trade_grid){.n = n, .tolerance = tolerance, .n_count = 1, .tolerances = 3});
    assert_int_equal(t->count, 3);
    drop(t);
}

/* ---- what they take ---- */

/* By the steps of each: whether the seconds are right as well is a question for a quiet machine.
 * The dearest are left out, and have no result. */
TEST(test_forecast)
{
    static const size_t n[] = {40, 160}, steps[] = {10, 100, 10000};
    static const double tolerance[] = {1e-2, 1e-4};
    OWNED(br_scene) scene = br_test_bundled("example2");
    struct br_trade *t = laid_out(&scene, "euler+implicit,bdf2+plain,adaptive",
                                  &(struct br_trade_grid){.n = n,
                                                          .steps = steps,
                                                          .tolerance = tolerance,
                                                          .n_count = 2,
                                                          .step_count = 3,
                                                          .tolerances = 2});
    double held = 0, dearest = 0;
    t->request.threads = 1;
    t->request.pace = 1; /* of this machine, it may change from one forecast to the next */
    MUST(br_trade_estimate(t, &err));
    assert_int_equal(t->forecast.planned, t->count);
    assert_int_equal(t->forecast.left, 0);
    for (size_t i = 0; i + 2 < 4 * 3; i += 3) { /* two methods on two meshes */
        assert_true(t->trial[i + 2].estimated > 2 * t->trial[i].estimated);
        CLOSE(br_trial_work(&scene, &t->trial[i + 2]), 1000 * br_trial_work(&scene, &t->trial[i]),
              1e-12);
    }
    t->request.seconds = 0.3 * t->forecast.seconds;
    MUST(br_trade_estimate(t, &err));
    assert_true(t->forecast.left > 0 && t->forecast.planned > 1);
    assert_int_equal(t->forecast.left + t->forecast.planned, t->count);
    for (size_t i = 0; i < t->count; i++)
        if (t->trial[i].end != BR_TRIAL_LEFT) {
            held += t->trial[i].estimated;
            dearest = fmax(dearest, t->trial[i].estimated);
        }
    assert_true(held <= t->request.seconds);
    MUST(br_trade_run(t, &err));
    assert_int_equal(br_trade_tally(t, BR_TRIAL_LEFT), t->forecast.left);
    for (size_t i = 0; i < t->count; i++) {
        const bool left = t->trial[i].end == BR_TRIAL_LEFT;
        assert_true(!left || t->trial[i].estimated >= dearest);
        assert_true(isnan(br_trial_bound(&t->trial[i])) == left);
    }
    drop(t);
}

/* The marches whose pace was asked for. */
enum { MOST_PACES = 16 };
static struct {
    size_t n, steps;
    const char *scheme;
} paced[MOST_PACES];
static size_t paces;
static bool counts_paces;

enum br_status __real_br_march_pace(const struct br_planned_march *march, double *pace,
                                    struct br_error *err);
enum br_status __wrap_br_march_pace(const struct br_planned_march *march, double *pace,
                                    struct br_error *err);
enum br_status __wrap_br_march_pace(const struct br_planned_march *march, double *pace,
                                    struct br_error *why)
{
    if (!counts_paces)
        return __real_br_march_pace(march, pace, why);
    assert_true(paces < MOST_PACES);
    paced[paces].n = march->n;
    paced[paces].steps = march->steps;
    paced[paces++].scheme = march->method->scheme->name;
    *pace = 1;
    return BR_OK;
}

/* The dearest of all marches of equal steps shows their pace; that of steps by a tolerance is the
 * method's own, at that tolerance. */
TEST(test_paces)
{
    static const size_t n[] = {40, 160}, steps[] = {10, 1000};
    static const double tolerance[] = {1e-2, 1e-4};
    OWNED(br_scene) scene = br_test_bundled("example2");
    struct br_trade *t = laid_out(&scene, "euler+implicit,esdirk4+plain,adaptive,adaptive+plain",
                                  &(struct br_trade_grid){.n = n,
                                                          .steps = steps,
                                                          .tolerance = tolerance,
                                                          .n_count = 2,
                                                          .step_count = 2,
                                                          .tolerances = 2});
    paces = 0;
    counts_paces = true;
    MUST(br_trade_estimate(t, &err));
    counts_paces = false;
    assert_int_equal(paces, 5);
    assert_int_equal(paced[0].steps, 1000);
    assert_string_equal(paced[0].scheme, "esdirk4");
    for (size_t i = 0; i < 5; i++)
        assert_int_equal(paced[i].n, 160);
    drop(t);
}

/* A reference's work is forecast with the first trial that needs it, and passes to the next one
 * when that trial is left out. */
TEST(test_reference_is_forecast)
{
    OWNED(br_scene) scene = br_test_bundled("example2");
    struct br_trial trial[] = {{.named = &pair[0], .at = {10, 100000}},
                               {.named = &pair[1], .at = {10, 100000}}};
    struct br_trial_request request = br_trial_request_default(&scene);
    struct br_trial_forecast forecast;
    request.pace = 1;
    MUST(br_trials_estimate(trial, 2, &request, &forecast, &err));
    const double beside = trial[1].estimated;
    assert_true(trial[0].estimated > 1.01 * beside);
    request.seconds = 0.5 * forecast.seconds;
    MUST(br_trials_estimate(trial, 2, &request, &forecast, &err));
    assert_int_equal(trial[0].end, BR_TRIAL_LEFT);
    CLOSE(trial[1].estimated, trial[0].estimated, 1e-12 * beside);
    CLOSE(forecast.seconds, trial[1].estimated, 1e-12 * forecast.seconds);
}

static int make_pair(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++)
        pair[i] = (struct br_named_method){.method = br_method_default()};
    return 0;
}

AROUND_TESTS(make_pair, NULL)
