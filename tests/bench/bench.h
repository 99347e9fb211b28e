/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Shared by the sections of the benchmark: times, and rows for a file. */
#ifndef BENCH_H
#define BENCH_H

#include <jansson.h>

#include "tests/support.h"

/* Times of some repeats, per unit of work. */
struct bench_time {
    double median, least, most;
};

/* Times some repeats of work(self), after one that does not count; each does `amount` units. The
 * result is in ns per unit. */
struct bench_time bench_time(void (*work)(void *self), void *self, double amount);

/* ---- rows for the file ---- */

/* Adds a row. */
__attribute__((format(printf, 1, 2))) json_t *bench_row(const char *name, ...);

/* These put into a row: a value, the times of repeats, or why it was left out. */
void bench_put(json_t *row, const char *unit, double value);
void bench_put_time(json_t *row, const char *unit, const struct bench_time *time);
void bench_put_skipped(json_t *row, const char *reason);

/* ---- scenes, solvers and marches ---- */

enum bench_fields { BENCH_BOTH, BENCH_BENDING, BENCH_AXIAL, BENCH_FIELDS };

/* The method of the registry's solver that has kernels, with the best kernel. */
struct br_method bench_fast_method(void);

/* One march to be timed. */
struct bench_march {
    const struct br_scene *scene;
    const struct br_method *method;
    size_t n;
    double guess; /* ns an element-step; 0: unknown */
};

/* Its times. */
struct bench_march_time {
    struct bench_time step; /* ns an element-step, both fields being one */
    double set_up;          /* s */
};

/* The estimated time of a march, s, if its set-up takes set_up. */
double bench_march_cost(const struct bench_march *march, double set_up);

/* Marches with k = 1e-3 s, or less, so that the duration is at most 1 s. Fails if the march cannot
 * be set up: a library that cannot factorise so fine a mesh. */
enum br_status bench_march(const struct bench_march *march, struct bench_march_time *time,
                           struct br_error *err);

/* ---- sections: cmocka tests ---- */

void bench_speed(void **state);
void bench_loads(void **state);

#endif
