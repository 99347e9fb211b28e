/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Prints the time of an element-step by solver, kernel, fields and n. It checks only that all
 * solvers take the same steps: they must end at the same tip. */
#include <float.h>
#include <math.h>
#include <stdio.h>

#include "solver/function.h"
#include "solver/linear/linear_solver.h"
#include "solver/scene.h"
#include "tests/bench/bench.h"

static const size_t sizes[] = {100, 400, 3200, 12800, 100000, 1000000};
enum { SIZES = sizeof sizes / sizeof *sizes, FINE = 400, FINEST = 12800, STEPS = 200 };

static const char *const field_names[BENCH_FIELDS] = {"both", "bending", "axial"};

static const double most_seconds = 3; /* a row that would take longer is left out */

/* Rows of one solver, kernel and scene, over n. */
struct series {
    struct br_method method;
    enum bench_fields fields;
    struct br_scene scene;
    const char *kernel; /* "-": the solver has none */
};

/* Examples 2 and 3, and Example 2 without bending and friction; to be cleared. */
static struct br_scene scene_with(enum bench_fields fields)
{
    struct br_scene s = br_test_bundled(fields == BENCH_BENDING ? "example3" : "example2");
    if (fields == BENCH_AXIAL) {
        s.bending.modelled = false;
        s.friction.law = BR_FRICTIONLESS;
    }
    return s;
}

/* The relative distance of the tip from that of the fast solver after some steps of 1e-3 s. The
 * condition number of the assembled form is about n^4 for bending: coarse meshes show a wrong
 * system; on the finest the tip may be wrong. */
static double check_tip(const struct series *s, size_t n)
{
    struct br_scene scene = s->scene;
    const struct br_method fast = bench_fast_method();
    scene.duration = 1e-3 * STEPS;
    const struct br_test_end a = br_test_run(&scene, n, STEPS, &fast);
    const struct br_test_end b = br_test_run(&scene, n, STEPS, &s->method);
    const double deviation = br_test_deviation(&b, &a), limit = DBL_EPSILON * pow((double)n, 4);
    if (!(deviation <= limit))
        fail_msg("n = %zu: the tips of %s and %s differ by %g, expected at most %g: another system",
                 n, fast.solver->name, s->method.solver->name, deviation, limit);
    return deviation;
}

static void print_row(const struct series *s, size_t n, const struct bench_time *t)
{
    printf(" %9.2f %9.2f %9.2f", t->median, t->least, t->most);
    if (s->fields == BENCH_BOTH && n <= FINEST)
        printf(" %10.1e", check_tip(s, n));
    printf("\n");
    fflush(stdout);
}

/* t (in/out): the time of the row before, then that of this one. */
static void run_row(const struct series *s, size_t i, struct bench_march_time *t)
{
    const size_t n = sizes[i];
    const struct bench_march march = {&s->scene, &s->method, n, t->step.least};
    const double growth = i > 0 ? (double)n / (double)sizes[i - 1] : 1;
    const double cost = bench_march_cost(&march, t->set_up * growth);
    const char *name = s->method.solver->name, *fields = field_names[s->fields];
    json_t *row = bench_row("%s %s %s n=%zu", name, s->kernel, fields, n);
    printf("%-8s %-9s %-8s %8zu", name, s->kernel, fields, n);
    if (!(cost <= most_seconds)) {
        br_fail(&err, BR_BAD_INPUT, "would take about %.0f s", cost);
        t->set_up = cost; /* the next row would take at least as long */
    } else if (!bench_march(&march, t, &err)) {
        bench_put_time(row, "ns/element-step", &t->step);
        print_row(s, n, &t->step);
    } else if (n <= FINE)
        fail_msg("%s failed at n = %zu: %s", name, n, err.message);
    if (err.status) {
        bench_put_skipped(row, err.message);
        printf("   skipped: %s\n", err.message);
    }
}

static void run_series(const struct series *s)
{
    struct bench_march_time t;
    MUST(bench_march(&(struct bench_march){&s->scene, &s->method, sizes[0], 0}, &t, &err));
    for (size_t i = 0; i < SIZES; i++)
        run_row(s, i, &t);
}

/* Runs all kernels of a solver that has kernels; `auto` takes the best one. */
static void run_solver(struct series *s)
{
    s->kernel = "-";
    if (br_linear_solver_chooses(s->method.solver) || !s->method.solver->takes_kernel) {
        run_series(s);
        return;
    }
    for (const struct br_kernel *const *k = br_kernels; *k; k++) {
        s->kernel = (*k)->name;
        s->method.kernel = *k;
        if ((*k)->available())
            run_series(s);
        else
            printf("%-8s %-9s is not available on this machine\n", s->method.solver->name,
                   s->kernel);
    }
}

void bench_speed(void **state)
{
    (void)state;
    printf("\nTime of an element-step, ns (median, least, most of the repeats); how far the tip is "
           "from the fast solver's\nafter %d steps. Element-steps count once for both fields.\n",
           STEPS);
    printf("%-8s %-9s %-8s %8s %9s %9s %9s %10s\n", "solver", "kernel", "fields", "n", "median",
           "least", "most", "tip off by");
    for (int fields = 0; fields < BENCH_FIELDS; fields++)
        for (const struct br_linear_solver *const *solver = br_linear_solvers; *solver; solver++) {
            struct series s = {.method = br_method_default(),
                               .fields = (enum bench_fields)fields,
                               .scene = scene_with((enum bench_fields)fields)};
            s.method.solver = *solver;
            run_solver(&s);
            br_scene_clear(&s.scene);
        }
}

/* f(x, t) is assembled in every step, F(x) G(t) once. */
void bench_loads(void **state)
{
    static const struct {
        const char *name, *space, *time;
    } kinds[] = {
        {"G(t)", "100", "exp(t) - 1"},
        {"F(x) G(t)", "100*x^2", "exp(t) - 1"},
        {"f(x, t)", "100*sin(x*t)", "1"},
    };
    const size_t n = 3200;
    const struct br_method method = bench_fast_method();
    (void)state;
    printf("\nKinds of loads: %s, both fields, n = %zu, ns an element-step\n", method.solver->name,
           n);
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        struct br_scene scene = br_test_bare();
        struct br_load *load[] = {&scene.axial.load, &scene.bending.load};
        for (int kind = 0; kind < 2; kind++) {
            load[kind]->term[0].space = br_test_function(kinds[i].space);
            load[kind]->term[0].time = br_test_function(kinds[i].time);
        }
        struct bench_march_time t;
        MUST(bench_march(&(struct bench_march){&scene, &method, n, 0}, &t, &err));
        printf("  %-12s %9.2f %9.2f %9.2f\n", kinds[i].name, t.step.median, t.step.least,
               t.step.most);
        bench_put_time(bench_row("load %s n=%zu", kinds[i].name, n), "ns/element-step", &t.step);
        br_scene_clear(&scene);
    }
}
