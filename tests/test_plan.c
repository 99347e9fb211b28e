/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Plans: the promise on bundled scenes. Costs are counted work, so that nothing depends on a clock. */
#include <math.h>
#include <string.h>

#include "solver/scene.h"
#include "study/trade/plan.h"
#include "support.h"

/* ---- the promise ---- */

/* As measured on a machine of today, once for all: set-up, and solves as if each had 700 elements
 * more; a change of the step costs six of them. */
static double counted(const struct br_trial *t)
{
    if (!(br_trial_seconds(t) > 0))
        return NAN;
    const struct br_counts *c = &t->cost.counts;
    return 4e-5 + 1.8e-9 * ((double)t->at.n + 700) * (double)(c->stages + 6 * c->set_ups);
}

#define METHODS "euler+implicit,bdf2,esdirk3,adaptive"
enum { ALL = 4 };

/* Made, or with the failure; methods: of these the first so many. */
static struct br_plan *make(const struct br_scene *scene, struct br_plan_goal goal, size_t methods,
                            enum br_status *status, struct br_error *failure)
{
    struct br_error err = {0};
    struct br_plan *plan = calloc(1, sizeof *plan);
    assert_non_null(plan);
    br_plan_default(plan, scene);
    MUST(br_named_methods_read("--methods", METHODS, &plan->methods, &err));
    plan->methods.count = methods;
    plan->goal = goal;
    plan->seconds = counted;
    plan->request.repeats = 1;
    plan->request.time_limit = 0;
    *status = br_plan_make(plan, failure);
    return plan;
}

static void drop(struct br_plan *plan)
{
    br_plan_clear(plan);
    free(plan);
}

/* The cheapest way of a fine grid, in counted work; only what is cheaper than `most` is tried. */
static double exhaustive(const struct br_plan *plan, double most)
{
    static const size_t n[] = {4, 8, 12, 16, 32, 64, 128, 192, 256, 512, 1024};
    static const size_t k[] = {10, 12, 15, 20, 30, 40, 60, 80, 120, 240};
    enum { N = sizeof n / sizeof *n, K = sizeof k / sizeof *k };
    struct br_trial *trial = calloc(4 * N * K, sizeof *trial);
    struct br_error err = {0};
    size_t count = 0;
    assert_non_null(trial);
    for (size_t c = 0; c < plan->methods.count; c++)
        for (size_t i = 0; i < N; i++)
            for (size_t j = 0; j < K; j++) {
                const struct br_named_method *one = &plan->methods.list[c];
                const bool adaptive = one->method.scheme->adaptive;
                const double solves =
                    adaptive ? 150 : (double)k[j] * br_time_scheme_stages(one->method.scheme);
                if (4e-5 + 1.8e-9 * ((double)n[i] + 700) * solves > most)
                    continue;
                trial[count++] = adaptive
                                     ? (struct br_trial){.named = one,
                                                         .at = {n[i], BR_TRIAL_LEVELS},
                                                         .tolerance = pow(0.1, 0.5 + (double)j)}
                                     : (struct br_trial){.named = one, .at = {n[i], k[j]}};
            }
    MUST(br_trials_run(trial, count, &plan->request, &err));
    double least = INFINITY;
    for (size_t i = 0; i < count; i++)
        if (br_trial_bound(&trial[i]) <= plan->goal.error)
            least = fmin(least, counted(&trial[i]));
    free(trial);
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
            if ((s + e) % 2 && !br_test_long())
                continue;
            struct br_error err = {0};
            enum br_status status;
            struct br_scene scene = br_test_bundled(scenes[s]);
            struct br_plan *plan =
                make(&scene, (struct br_plan_goal){errors[e], NAN}, ALL, &status, &err);
            MUST(status);
            assert_true(plan->chosen < plan->count);
            const struct br_trial *t = &plan->trial[plan->chosen];
            const double achieved = br_trial_bound(t), cost = counted(t);
            const double best = exhaustive(plan, cost);
            if (!(achieved <= errors[e]))
                fail_msg("%s to %g: achieved %g", scenes[s], errors[e], achieved);
            if (!(cost <= 2 * best))
                fail_msg("%s to %g: %s, n = %zu costs %g, the best %g", scenes[s], errors[e],
                         t->named->name, t->at.n, cost, best);
            drop(plan);
            br_scene_clear(&scene);
        }
}

/* The least error within some work: more work never is worse. The coarsest mesh may do. A judge whose own error depends on the mesh is asked where it is best. What makes no sense is
 * refused. */
TEST(test_goals)
{
    static const struct {
        const char *scene;
        struct br_plan_goal goal;
        double error;        /* at most */
        const char *refusal; /* NULL: none */
    } rows[] = {
        {"example2", {NAN, 1e-4}, 1e-4, NULL},
        {"example2", {NAN, 2e-3}, 1e-6, NULL},
        {"example3", {0.9, NAN}, 0.9, NULL},
        {"mms_slip", {1e-5, NAN}, 1e-5, NULL},
        {"example3", {NAN, NAN}, 0, "needs an error or seconds"},
        {"example3", {1e-3, 1}, 0, "and not both"},
        {"example3", {0, NAN}, 0, "between 0 and 1"},
        {"example3", {1, NAN}, 0, "between 0 and 1"},
        {"example3", {-1, NAN}, 0, "between 0 and 1"},
        {"example3", {NAN, 0}, 0, "seconds > 0"},
        {"example3", {NAN, INFINITY}, 0, "seconds > 0"},
        {"example3", {1e-16, NAN}, 0, "an error of"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        struct br_error err = {0};
        enum br_status status;
        struct br_scene scene = br_test_bundled(rows[i].scene);
        struct br_plan *plan = make(&scene, rows[i].goal, rows[i].refusal ? 1 : ALL, &status, &err);
        if (rows[i].refusal) {
            REFUSED(status, BR_BAD_INPUT, rows[i].refusal);
        } else {
            MUST(status);
            const struct br_trial *t = &plan->trial[plan->chosen];
            assert_true(plan->chosen < plan->count);
            AT_MOST(br_trial_bound(t), rows[i].error);
            assert_false(counted(t) > rows[i].goal.seconds);
            assert_true(rows[i].goal.error < 0.9 || isnan(rows[i].goal.error) || t->at.n == 1);
        }
        drop(plan);
        br_scene_clear(&scene);
    }
}
