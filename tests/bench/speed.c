/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Time of an element-step by solver, kernel, fields and n. Nothing is asserted about it. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "study/scene/expression.h"
#include "tests/bench/bench.h"

static const size_t sizes[] = {8, 32, 100, 400, 3200, 12800, 100000, 1000000};
enum { SIZES = sizeof sizes / sizeof *sizes };

static const double most_seconds = 3; /* a row that would take more is left out */

/* Rows of one solver, kernel and scene, over n. */
struct series {
    struct bench *bench;
    struct br_method method;
    enum bench_fields fields;
    struct br_scene scene;
    const char *kernel; /* "-": the solver has none */
};

static void print_fractions(const struct series *s, size_t n, double ns)
{
    const struct bench_least least = bench_least_time(s->bench->limits, s->kernel, s->fields, n);
    if (least.instructions > 0)
        printf(" %10.0f %% %10.0f %% %s", 100 * least.instructions / ns, 100 * least.memory / ns,
               least.level);
    else if (*s->kernel != '-')
        printf("   no limit was measured for this kernel");
    printf("\n");
}

/* One row; returns what it took. */
static struct bench_march_time run_row(const struct series *s, size_t n, double guess)
{
    const struct bench_march march = {&s->scene, &s->method, n, guess};
    const struct bench_march_time t = bench_march(&march);
    printf("%-8s %-9s %-8s %8zu %9.2f %9.2f %9.2f", s->method.solver->name, s->kernel,
           bench_field_names[s->fields], n, t.step.median, t.step.least, t.step.most);
    print_fractions(s, n, t.step.least);
    fflush(stdout);
    bench_record(s->bench, "ns/element-step", &t.step, "%s %s %s n=%zu", s->method.solver->name,
                 s->kernel, bench_field_names[s->fields], n);
    return t;
}

static void skip_row(const struct series *s, size_t n, const char *reason)
{
    printf("%-8s %-9s %-8s %8zu   skipped: %s\n", s->method.solver->name, s->kernel,
           bench_field_names[s->fields], n, reason);
    bench_record_skipped(s->bench, reason, "%s %s %s n=%zu", s->method.solver->name, s->kernel,
                         bench_field_names[s->fields], n);
}

static void skip_long_row(const struct series *s, size_t n, double seconds)
{
    char reason[64];
    snprintf(reason, sizeof reason, "would take about %.0f s", seconds);
    skip_row(s, n, reason);
}

static bool can_run_row(const struct series *s, size_t n)
{
    const struct bench_march march = {&s->scene, &s->method, n, 0};
    struct br_error err = {0};
    const bool can = bench_can_march(&march, &err);
    if (!can)
        skip_row(s, n, err.message);
    return can;
}

/* What a row will take, s, by the one before. */
static double cost_of(const struct series *s, size_t i, const struct bench_march_time *before)
{
    const struct bench_march march = {&s->scene, &s->method, sizes[i], before->step.least};
    const double growth = i > 0 ? (double)sizes[i] / (double)sizes[i - 1] : 1;
    return bench_march_cost(&march, before->set_up * growth);
}

static void run_series(const struct series *s)
{
    double least = INFINITY, most = 0;
    size_t fastest = 0, slowest = 0;
    const struct bench_march pilot = {&s->scene, &s->method, sizes[0], 0};
    struct bench_march_time t = bench_march(&pilot);
    for (size_t i = 0; i < SIZES; i++) {
        const double cost = cost_of(s, i, &t);
        if (!(cost <= most_seconds)) {
            skip_long_row(s, sizes[i], cost);
            t.set_up = cost; /* the next would not take less */
            continue;
        }
        if (!can_run_row(s, sizes[i]))
            continue;
        t = run_row(s, sizes[i], t.step.least);
        const double ns = t.step.least;
        if (ns < least)
            least = ns, fastest = sizes[i];
        if (ns > most)
            most = ns, slowest = sizes[i];
    }
    printf("%-8s %-9s %-8s  n = %zu takes %.2f times what n = %zu does\n", s->method.solver->name,
           s->kernel, bench_field_names[s->fields], slowest, most / least, fastest);
    bench_record_value(s->bench, "slowest/fastest", most / least, "%s %s %s over n",
                       s->method.solver->name, s->kernel, bench_field_names[s->fields]);
}

/* All kernels of a solver that has some; a choice of solvers takes the best. */
static void run_solver(struct series *s)
{
    s->kernel = "-";
    if (!s->method.solver->cost || !br_linear_solver_heeds(s->method.solver, "--kernel")) {
        run_series(s);
        return;
    }
    for (const struct br_kernel *const *k = br_kernels; *k; k++) {
        s->kernel = (*k)->name;
        s->method.linear.kernel = *k;
        if ((*k)->available())
            run_series(s);
        else
            printf("%-8s %-9s is not available on this machine\n", s->method.solver->name,
                   s->kernel);
    }
}

void bench_speed(void **state)
{
    printf("\nTime of an element-step, ns (median, least, most of the repeats); the least against "
           "what the multiply-adds\nand reading and writing the state would take at this machine's "
           "limits. Element-steps count once for both fields.\n");
    printf("%-8s %-9s %-8s %8s %9s %9s %9s %12s %12s\n", "solver", "kernel", "fields", "n",
           "median", "least", "most", "of arithm.", "of memory");
    for (int fields = 0; fields < BENCH_FIELDS; fields++)
        for (const struct br_linear_solver *const *solver = br_linear_solvers; *solver; solver++) {
            struct series s = {.bench = *state,
                               .method = br_method_default(),
                               .fields = (enum bench_fields)fields,
                               .scene = bench_scene((enum bench_fields)fields)};
            s.method.solver = *solver;
            run_solver(&s);
            br_scene_clear(&s.scene);
        }
}

/* f(x, t) is assembled every step, F(x) G(t) once. */
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
    printf("\nKinds of loads: %s, both fields, n = %zu, ns an element-step\n", method.solver->name,
           n);
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        struct br_scene scene = br_test_bare();
        scene.axial.load.term[0].space = br_test_function(kinds[i].space);
        scene.axial.load.term[0].time = br_test_function(kinds[i].time);
        scene.bending.load.term[0].space = br_test_function(kinds[i].space);
        scene.bending.load.term[0].time = br_test_function(kinds[i].time);
        const struct bench_march march = {&scene, &method, n, 0};
        const struct bench_time t = bench_march(&march).step;
        printf("  %-12s %9.2f %9.2f %9.2f\n", kinds[i].name, t.median, t.least, t.most);
        bench_record(*state, "ns/element-step", &t, "load %s n=%zu", kinds[i].name, n);
        br_scene_clear(&scene);
    }
}

/* ---- expressions ---- */

enum { PLACES = 16000 };

struct evaluated {
    struct br_function function;
    double (*library)(double); /* the C library's, in a loop */
    double x[PLACES], value[PLACES];
};

static void evaluate(void *self)
{
    struct evaluated *e = self;
    br_function_evaluate(&e->function, PLACES, e->x, 0.7, e->value);
}

static void loop(void *self)
{
    struct evaluated *e = self;
    for (size_t i = 0; i < PLACES; i++)
        e->value[i] = e->library(e->x[i]);
}

/* Many places at a time, beside the C library's function one by one. */
void bench_expressions(void **state)
{
    static const struct {
        const char *text;
        double (*library)(double);
    } rows[] = {
        {"sin(x)", sin},        {"exp(x)", exp},
        {"tanh(x)", tanh},      {"log(x)", log},
        {"x^1.5", NULL},        {"sin(x*t)", NULL},
        {"x*x+t", NULL},        {"exp(-((x-t)/0.1)^2)", NULL},
        {"asinh(x)", asinh},    {"step(x-t)", NULL},
        {"x<t?1:exp(x)", NULL},
    };
    struct evaluated e;
    for (size_t i = 0; i < PLACES; i++)
        e.x[i] = 1e-3 * ((double)i + 0.5);
    printf("\nExpressions, ns a place, %d places; the C library in a loop\n", PLACES);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        e.function = br_test_function(rows[i].text);
        e.library = rows[i].library;
        const struct bench_time t = bench_time(evaluate, &e, PLACES);
        const double one = e.library ? bench_time(loop, &e, PLACES).median : NAN;
        printf("  %-22s %9.2f %9.2f %9.2f %9.2f\n", rows[i].text, t.median, t.least, t.most, one);
        bench_record(*state, "ns/place", &t, "expression %s", rows[i].text);
        br_function_free(&e.function);
    }
}
