/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Trades with a goal: the promise on bundled scenes. The clock is counted work: no other work of
 * the machine changes a choice. */
#include <math.h>
#include <string.h>
#include <time.h>

#include "solver/march.h"
#include "solver/scene.h"
#include "study/trade/trade.h"
#include "support.h"

/* ---- a clock that counts ---- */

/* As measured on a machine of today, once for all: set-up, and solves as if each had 700 elements
 * more; a change of the step costs six of them. */
static const double set_up = 8e-6;
static double work(size_t n, double solves)
{
    return 1.8e-9 * ((double)n + 700) * solves;
}

/* Of this thread; elements: of the march that it has begun last. */
static _Thread_local double now;
static _Thread_local size_t elements;

enum br_status __real_br_march_create(struct br_march **march, const struct br_scene *scene,
                                      size_t n, size_t steps, const struct br_method *method,
                                      struct br_error *err);
enum br_status __wrap_br_march_create(struct br_march **march, const struct br_scene *scene,
                                      size_t n, size_t steps, const struct br_method *method,
                                      struct br_error *err);
enum br_status __wrap_br_march_create(struct br_march **march, const struct br_scene *scene,
                                      size_t n, size_t steps, const struct br_method *method,
                                      struct br_error *why)
{
    elements = n;
    now += set_up;
    return __real_br_march_create(march, scene, n, steps, method, why);
}

enum br_status __real_br_march_step(struct br_march *march, struct br_error *err);
enum br_status __wrap_br_march_step(struct br_march *march, struct br_error *err);
enum br_status __wrap_br_march_step(struct br_march *march, struct br_error *why)
{
    const struct br_counts before = br_march_counts(march);
    const enum br_status status = __real_br_march_step(march, why);
    const struct br_counts after = br_march_counts(march);
    now += work(elements, (double)(after.stages - before.stages) +
                              6 * (double)(after.set_ups - before.set_ups));
    return status;
}

/* The clock of a thread is the one that counts. */
int __real_clock_gettime(clockid_t clock, struct timespec *t);
int __wrap_clock_gettime(clockid_t clock, struct timespec *t);
int __wrap_clock_gettime(clockid_t clock, struct timespec *t)
{
    if (clock != CLOCK_THREAD_CPUTIME_ID)
        return __real_clock_gettime(clock, t);
    const double whole = floor(now);
    *t = (struct timespec){.tv_sec = (time_t)whole, .tv_nsec = lround(1e9 * (now - whole))};
    return 0;
}

/* ---- the promise ---- */

#define METHODS "euler+implicit,bdf2,esdirk3,adaptive"
enum { ALL = 4 };

/* Run, or with the failure; methods: of these the first so many. */
static struct br_trade *make(const struct br_scene *scene, struct br_trade_goal goal,
                             const struct br_trade_grid *grid, size_t methods,
                             enum br_status *status, struct br_error *failure)
{
    struct br_trade *t = calloc(1, sizeof *t);
    assert_non_null(t);
    t->request = br_trial_request_default(scene);
    MUST(br_named_methods_read(METHODS, &t->methods, &err));
    t->methods.count = methods;
    t->goal = goal;
    t->request.repeats = 1;
    t->request.seconds = 4;
    MUST(br_trade_lay_out(t, grid, &err));
    MUST(br_trade_estimate(t, &err));
    *status = br_trade_run(t, failure);
    return t;
}

static void drop(struct br_trade *t)
{
    br_trade_clear(t);
    free(t);
}

/* The cheapest way of a fine grid; only what is cheaper than `most` is tried. */
static double exhaustive(const struct br_trade *t, double most)
{
    static const size_t n[] = {4, 8, 12, 16, 32, 64, 128, 192, 256, 512, 1024};
    static const size_t k[] = {10, 12, 15, 20, 30, 40, 60, 80, 120, 240};
    enum { N = sizeof n / sizeof *n, K = sizeof k / sizeof *k };
    FREED struct br_trial *trial = calloc(ALL * N * K, sizeof *trial);
    size_t count = 0;
    assert_non_null(trial);
    for (size_t c = 0; c < t->methods.count; c++)
        for (size_t i = 0; i < N; i++)
            for (size_t j = 0; j < K; j++) {
                const struct br_named_method *one = &t->methods.list[c];
                const double solves =
                    one->method.scheme->adaptive
                        ? 150
                        : (double)k[j] * br_time_scheme_stages(one->method.scheme);
                if (set_up + work(n[i], solves) <= most)
                    trial[count++] = br_trial_at(one, n[i], k[j], pow(0.1, 0.5 + (double)j));
            }
    MUST(br_trials_run(trial, count, &t->request, &err));
    double least = INFINITY;
    for (size_t i = 0; i < count; i++)
        if (br_trial_bound(&trial[i]) <= t->goal.error)
            least = fmin(least, br_trial_seconds(&trial[i]));
    return least;
}

/* At most E, and at most twice the work of the best of a fine grid. By default each scene to one of
 * the errors. */
TEST(test_promise)
{
    static const char *const scenes[] = {"example1", "example2", "example3", "example4"};
    static const double errors[] = {1e-3, 1e-5};
    for (size_t s = 0; s < sizeof scenes / sizeof *scenes; s++)
        for (size_t e = 0; e < sizeof errors / sizeof *errors; e++) {
            if ((s + e) % 2 == 0 && !br_test_long())
                continue;
            enum br_status status;
            OWNED(br_scene) scene = br_test_bundled(scenes[s]);
            struct br_trade *t = make(&scene, (struct br_trade_goal){.error = errors[e]},
                                      &(struct br_trade_grid){0}, ALL, &status, &err);
            MUST(status);
            assert_true(t->chosen < t->count);
            const struct br_trial *best = &t->trial[t->chosen];
            const double achieved = br_trial_bound(best), cost = br_trial_seconds(best);
            const double least = exhaustive(t, cost);
            if (!(achieved <= errors[e]))
                fail_msg("%s to %g: achieved %g", scenes[s], errors[e], achieved);
            if (!(cost <= 2 * least))
                fail_msg("%s to %g: %s, n = %zu costs %g, the best %g", scenes[s], errors[e],
                         best->named->name, best->at.n, cost, least);
            drop(t);
        }
}

/* How many methods were tried on meshes between those of the list. */
static size_t refined(const struct br_trade *t)
{
    static const size_t listed[] = {1, 2, 6, 25, 100, 400, 1600, 6400, 25600, 102400};
    size_t methods = 0;
    for (const struct br_named_method *m = t->methods.list; m < t->methods.list + t->methods.count;
         m++) {
        bool any = false;
        for (const struct br_trial *o = t->trial; o < t->trial + t->count; o++) {
            bool between = o->named == m;
            for (size_t i = 0; i < sizeof listed / sizeof *listed; i++)
                between = between && o->at.n != listed[i];
            any = any || between;
        }
        methods += any;
    }
    return methods;
}

/* The least error within some seconds. The coarsest mesh may do. A reference whose own error
 * depends on the mesh is asked where it is best. What the reference cannot resolve is refused. */
TEST(test_goals)
{
    static const struct {
        const char *scene;
        struct br_trade_goal goal;
        double error;        /* at most */
        const char *refusal; /* NULL: none */
    } rows[] = {
        {"example2", {.seconds = 1e-4}, 1e-4, NULL},
        {"example2", {.seconds = 2e-3}, 1e-6, NULL},
        {"example3", {.error = 0.9}, 0.9, NULL},
        {"mms_slip", {.error = 1e-5}, 1e-5, NULL},
        {"example3", {.error = 1e-16}, 0, "an error of"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        enum br_status status;
        OWNED(br_scene) scene = br_test_bundled(rows[i].scene);
        struct br_trade *t = make(&scene, rows[i].goal, &(struct br_trade_grid){0},
                                  rows[i].refusal ? 1 : ALL, &status, &err);
        if (rows[i].refusal) {
            REFUSED(status, BR_BAD_INPUT, rows[i].refusal);
        } else {
            MUST(status);
            assert_true(t->chosen < t->count);
            const struct br_trial *best = &t->trial[t->chosen];
            AT_MOST(br_trial_bound(best), rows[i].error);
            assert_true(rows[i].error > 0.5 || refined(t) == 2); /* the best one and another */
            assert_true(!(rows[i].goal.seconds > 0) ||
                        br_trial_seconds(best) <= rows[i].goal.seconds);
        }
        drop(t);
    }
}

/* Meshes, steps and tolerances that are given are tried as they are, also those that are coarse. */
TEST(test_lists_are_kept)
{
    static const size_t n[] = {40, 20}, steps[] = {5, 7};
    static const double tolerance[] = {2e-3, 3e-7};
    enum br_status status;
    OWNED(br_scene) scene = br_test_bundled("example2");
    for (int kind = 0; kind < 4; kind++) {
        const bool of_tolerances = kind == 3;
        const struct br_trade_grid grid = {.n = n,
                                           .steps = steps,
                                           .tolerance = tolerance,
                                           .n_count = kind == 0 || kind == 2 ? 2 : 0,
                                           .step_count = kind == 1 || kind == 2 ? 2 : 0,
                                           .tolerances = of_tolerances ? 2 : 0};
        struct br_trade *t =
            make(&scene, (struct br_trade_goal){.error = of_tolerances ? 1e-6 : 1e-3}, &grid,
                 of_tolerances ? ALL : 2, &status, &err);
        MUST(status);
        assert_true(t->chosen < t->count);
        for (const struct br_trial *o = t->trial; o < t->trial + t->count; o++) {
            assert_true(kind == 1 || of_tolerances || o->at.n == n[0] || o->at.n == n[1]);
            assert_true(kind == 0 || of_tolerances || o->at.steps == steps[0] ||
                        o->at.steps == steps[1]);
            assert_true(kind != 0 || o->at.steps >= 10);
            assert_true(!of_tolerances || o->tolerance == 0 || o->tolerance == tolerance[0] ||
                        o->tolerance == tolerance[1]);
        }
        drop(t);
    }
}

/* Of trials whose seconds are equal but for the clock's scatter the one with the smallest error is
 * taken, whatever their order; of many seconds the least error. */
TEST(test_ties)
{
    static const struct {
        double error, seconds;
    } made[] = {{9e-4, 1.0}, {2e-4, 1.05}, {3e-4, 1.02}, {1e-5, 1.3}, {2e-3, 0.5}, {1e-6, 0}};
    enum { MADE = sizeof made / sizeof *made };
    const struct {
        struct br_trade_goal goal;
        double error; /* of the choice; NAN: none */
    } rows[] = {{{.error = 1e-3}, 2e-4}, {{.error = 1e-2}, 2e-3},   {{.error = 1e-4}, 1e-5},
                {{.error = 1e-7}, NAN},  {{.seconds = 1.03}, 3e-4}, {{.seconds = 0.4}, NAN}};
    for (size_t turn = 0; turn < MADE; turn++) {
        struct br_trial trial[MADE];
        for (size_t i = 0; i < MADE; i++) {
            const size_t from = (i + turn) % MADE;
            trial[i] = (struct br_trial){
                .cost = {.march = made[from].seconds > 0 ? made[from].seconds : NAN},
                .error = {made[from].error},
                .scale = 1,
                .own = NAN};
        }
        for (size_t r = 0; r < sizeof rows / sizeof *rows; r++) {
            const size_t i = br_trials_for_goal(trial, MADE, &rows[r].goal, NULL);
            const double found = i < MADE ? br_trial_bound(&trial[i]) : (double)NAN;
            if (!(found == rows[r].error || (isnan(found) && isnan(rows[r].error))))
                fail_msg("goal %zu, turn %zu: found %g, expected %g", r, turn, found,
                         rows[r].error);
        }
    }
}
