/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How good the forecasts of time are: for thirty pieces of work, such as commands consist of, the
 * seconds that the model of costs forecasts and those of the processor in one thread. Prints a row
 * for each and how many are within a factor of two. Run it with `meson test --benchmark costs`. */
#include <stdio.h>
#include <string.h>

#include "base/clock.h"
#include "solver/scene.h"
#include "study/grid/costs.h"
#include "study/grid/sweep.h"
#include "study/trade/trade.h"
#include "tests/support.h"

enum { MOST = 4 };

/* run: one n and one number of steps. study: all of them. trade: all of them by several methods. */
static const struct row {
    const char *command, *scene, *method;
    size_t n[MOST], steps[MOST];
} rows[] = {
    {"run", "example2", "euler", {12800}, {4000}},
    {"run", "example2", "euler", {100000}, {400}},
    {"run", "example2", "euler", {3200}, {16000}},
    {"run", "example2", "euler", {400}, {100000}},
    {"run", "example2", "euler", {25}, {400000}},
    {"run", "example1", "euler", {1600}, {30000}},
    {"run", "example3", "euler", {6400}, {10000}},
    {"run", "example4", "euler", {6400}, {10000}},
    {"run", "example1", "bdf2", {3200}, {10000}},
    {"run", "example2", "bdf2+p2", {1600}, {10000}},
    {"run", "example2", "esdirk3", {3200}, {4000}},
    {"run", "example2", "esdirk4", {1600}, {4000}},
    {"run", "example2", "sdirk2", {1600}, {10000}},
    {"run", "example2", "trbdf2", {400}, {30000}},
    {"run", "example2", "euler+plain", {400}, {60000}},
    {"run", "example2", "euler+umfpack", {400}, {10000}},
    {"run", "example2", "euler+uzawa", {1600}, {20000}},
    {"run", "reversal", "euler+implicit", {1600}, {20000}},
    {"study", "example1", "euler", {25, 50, 100}, {1000, 2000, 4000}},
    {"study", "example2", "euler", {100, 200, 400}, {1000, 2000, 4000}},
    {"study", "example3", "euler", {100, 200, 400}, {1000, 2000, 4000}},
    {"study", "example4", "euler", {100, 200, 400}, {1000, 2000, 4000}},
    {"study", "example2", "esdirk3", {100, 200, 400}, {500, 1000, 2000}},
    {"study", "example2", "bdf2", {400, 800, 1600}, {200, 400, 800}},
    {"study", "mms_slip", "euler", {100, 200, 400}, {1000, 2000, 4000}},
    {"trade", "example1", "euler+implicit,bdf2,adaptive", {25, 100, 400}, {100, 1000, 4000}},
    {"trade", "example2", "euler+implicit,bdf2,adaptive", {25, 100, 400}, {100, 1000, 4000}},
    {"trade", "example3", "euler+implicit,bdf2,adaptive", {25, 100, 400}, {100, 1000, 4000}},
    {"trade", "example4", "euler,esdirk3,adaptive+p2", {25, 100, 400}, {100, 1000, 4000}},
    {"trade", "example2", "euler,euler+umfpack,euler+uzawa", {25, 100, 400}, {100, 1000, 4000}},
};

static size_t count_of(const size_t list[MOST])
{
    size_t count = 0;
    while (count < MOST && list[count])
        count++;
    return count;
}

static double run(const struct row *r, const struct br_scene *scene, const struct br_method *m,
                  double *took)
{
    const struct br_planned_march planned = {
        .scene = scene, .method = m, .n = r->n[0], .steps = r->steps[0]};
    struct br_costs work = {.alone = true};
    br_costs_add_march(&work, &planned);
    br_costs_measure(&work);
    const double begun = br_thread_seconds();
    struct br_march *march = br_test_march(scene, r->n[0], r->steps[0], m);
    br_test_advance(march, r->steps[0]);
    *took = br_thread_seconds() - begun;
    br_march_free(march);
    return br_costs_seconds(&work, 1);
}

static double study(const struct row *r, const struct br_scene *scene, const struct br_method *m,
                    double *took)
{
    struct br_costs work = {0};
    struct br_study s = br_test_study(scene, br_reference_best(scene), count_of(r->n), r->n,
                                      count_of(r->steps), r->steps);
    s.method = *m;
    br_costs_add_study(&work, &s);
    br_costs_measure(&work);
    const double begun = br_thread_seconds();
    MUST(br_study_run(&s, 1, 1, NULL, &err));
    *took = br_thread_seconds() - begun;
    br_study_clear(&s);
    return br_costs_seconds(&work, 1);
}

static double trade(const struct row *r, const struct br_scene *scene, double *took)
{
    static const double tolerance[] = {1e-2, 1e-4, 1e-6};
    static struct br_trade t;
    t = (struct br_trade){.request = br_trial_request_default(scene)};
    t.request.threads = 1;
    MUST(br_named_methods_read(r->method, &t.methods, &err));
    MUST(br_trade_lay_out(&t,
                          &(struct br_trade_grid){.n = r->n,
                                                  .n_count = count_of(r->n),
                                                  .steps = r->steps,
                                                  .step_count = count_of(r->steps),
                                                  .tolerance = tolerance,
                                                  .tolerances = 3},
                          &err));
    const double begun = br_thread_seconds();
    MUST(br_trade_estimate(&t, &err));
    MUST(br_trade_run(&t, &err));
    *took = br_thread_seconds() - begun;
    const double forecast = t.forecast.seconds;
    br_trade_clear(&t);
    return forecast;
}

static void print_list(const size_t list[MOST])
{
    for (size_t i = 0; i < count_of(list); i++)
        printf("%s%zu", i ? "," : " ", list[i]);
    printf(";");
}

int main(void)
{
    size_t good = 0;
    const size_t count = sizeof rows / sizeof *rows;
    printf("%8s %8s %6s  work: scene, method, n, steps\n", "forecast", "CPU s", "ratio");
    for (const struct row *r = rows; r < rows + count; r++) {
        struct br_named_method c;
        struct br_scene scene = br_test_bundled(r->scene);
        double took;
        if (r->command[0] != 't')
            MUST(br_named_method_read(r->method, &c, &err));
        const double forecast = r->command[0] == 'r'   ? run(r, &scene, &c.method, &took)
                                : r->command[0] == 's' ? study(r, &scene, &c.method, &took)
                                                       : trade(r, &scene, &took);
        good += forecast >= took / 2 && forecast <= 2 * took;
        printf("%8.3f %8.3f %6.2f  %s %s %s;", forecast, took, forecast / took, r->command,
               r->scene, r->method);
        print_list(r->n);
        print_list(r->steps);
        printf("\n");
        fflush(stdout);
        br_scene_clear(&scene);
    }
    printf("%zu of %zu within a factor of two\n", good, count);
    return 0;
}
