/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>

#include "base/clock.h"
#include "solver/linear/linear_solver.h"
#include "solver/scene.h"
#include "tests/bench/bench.h"

enum { REPEATS = 7 };

static const double repeat_seconds = 0.015;

static int by_value(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

struct bench_time bench_time(void (*work)(void *self), void *self, double amount)
{
    double ns[REPEATS];
    work(self); /* fills the caches */
    for (int i = 0; i < REPEATS; i++) {
        const double start = br_seconds();
        work(self);
        ns[i] = 1e9 * (br_seconds() - start) / amount;
    }
    qsort(ns, REPEATS, sizeof *ns, by_value);
    return (struct bench_time){ns[REPEATS / 2], ns[0], ns[REPEATS - 1]};
}

struct br_method bench_fast_method(void)
{
    struct br_method method = br_method_default();
    const struct br_linear_solver *const *s = br_linear_solvers;
    while (*s && (br_linear_solver_chooses(*s) || !(*s)->takes_kernel))
        s++;
    assert_non_null(*s);
    method.solver = *s;
    return method;
}

struct running {
    struct br_march *march;
    size_t steps;
};

static void advance(void *self)
{
    const struct running *r = self;
    br_test_advance(r->march, br_march_steps_done(r->march) + r->steps);
}

/* The number of steps of each repeat. */
static size_t steps_of(const struct bench_march *b)
{
    const double guess = b->guess > 0 ? b->guess : 100;
    const double wanted = 1e9 * repeat_seconds / (guess * (double)b->n);
    return wanted > 2 ? (size_t)wanted : 2;
}

double bench_march_cost(const struct bench_march *b, double set_up)
{
    return set_up + 1e-9 * b->guess * (double)(b->n * steps_of(b) * (REPEATS + 1));
}

enum br_status bench_march(const struct bench_march *b, struct bench_march_time *time,
                           struct br_error *why)
{
    const double start = br_seconds();
    struct running r = {.steps = steps_of(b)};
    const size_t total = (REPEATS + 1) * r.steps;
    struct br_scene scene = *b->scene;
    scene.duration = total < 1000 ? 1e-3 * (double)total : 1;
    if (br_march_create(&r.march, &scene, b->n, total, b->method, why))
        return why->status;
    time->set_up = br_seconds() - start;
    time->step = bench_time(advance, &r, (double)(b->n * r.steps));
    br_march_free(r.march);
    return BR_OK;
}
