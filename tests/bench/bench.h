/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the sections of the benchmark share: times, rows for a file, and the machine's limits. */
#ifndef BENCH_H
#define BENCH_H

#include <jansson.h>

#include "tests/support.h"

/* Of some repeats; per whatever the unit is. */
struct bench_time {
    double median, least, most;
};

/* Times work(self), some repeats of it, after one that does not count; each does `amount` units.
 * The result is in ns a unit. */
struct bench_time bench_time(void (*work)(void *self), void *self, double amount);

/* ---- rows for the file ---- */

/* Adds a row; the name is what --compare matches by. */
__attribute__((format(printf, 1, 2))) json_t *bench_row(const char *name, ...);

/* What it says: a value, the times of repeats, or why it was left out. */
void bench_put(json_t *row, const char *unit, double value);
void bench_put_time(json_t *row, const char *unit, const struct bench_time *time);
void bench_put_skipped(json_t *row, const char *reason);

/* Prints the rows of two files beside each other. */
enum br_status bench_compare(const char *old_path, const char *new_path, struct br_error *err);

/* ---- scenes, solvers and marches ---- */

enum bench_fields { BENCH_BOTH, BENCH_BENDING, BENCH_AXIAL, BENCH_FIELDS };

/* The solver of the registry that has kernels, by its best one. */
struct br_method bench_fast_method(void);

/* One march to be timed. */
struct bench_march {
    const struct br_scene *scene;
    const struct br_method *method;
    size_t n;
    double guess; /* ns an element-step; 0: unknown */
};

/* What it took. */
struct bench_march_time {
    struct bench_time step; /* ns an element-step, both fields being one */
    double set_up;          /* s */
};

/* What a march will take, s, if setting it up does. */
double bench_march_cost(const struct bench_march *march, double set_up);

/* Marches with k = 1e-3 s, or less where that makes more than a second. Fails where it cannot be
 * set up: a library that cannot factorise so fine a mesh. */
enum br_status bench_march(const struct bench_march *march, struct bench_march_time *time,
                           struct br_error *err);

/* ---- the machine ---- */

/* Least time of an element-step on the fast solver's kernel, ns: by the instructions, and by
 * reading and writing the state from the level where it fits (out). Negative: not known. */
struct bench_least {
    double instructions, memory;
    const char *level;
};
struct bench_least bench_least_time(const char *kernel, enum bench_fields fields, size_t n);

/* ---- sections: cmocka tests ---- */

void bench_accuracy(void **state);
void bench_machine(void **state);
void bench_speed(void **state);
void bench_loads(void **state);
void bench_errors(void **state);

#endif
