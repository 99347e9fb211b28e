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

/* The rows so far; all of the benchmark's memory. */
struct bench {
    json_t *rows;
    struct bench_limits *limits; /* of rates.c and levels.c */
};

/* Adds a row to the file; the name is what --compare matches by. */
__attribute__((format(printf, 4, 5))) void bench_record(struct bench *bench, const char *unit,
                                                        const struct bench_time *time,
                                                        const char *name, ...);
/* The same of one value. */
__attribute__((format(printf, 4, 5))) void bench_record_value(struct bench *bench, const char *unit,
                                                              double value, const char *name, ...);
/* A row that was left out, and why. */
__attribute__((format(printf, 3, 4))) void bench_record_skipped(struct bench *bench,
                                                                const char *reason,
                                                                const char *name, ...);

/* Writes machine, compiler, commit and rows to a file. */
enum br_status bench_write(const struct bench *bench, const char *path, struct br_error *err);

/* Prints the rows of two files beside each other. */
enum br_status bench_compare(const char *old_path, const char *new_path, struct br_error *err);

/* ---- scenes and solvers ---- */

enum bench_fields { BENCH_BOTH, BENCH_BENDING, BENCH_AXIAL, BENCH_FIELDS };
extern const char *const bench_field_names[BENCH_FIELDS];

/* Examples 2 and 3, and Example 2 without bending and friction; to be cleared. */
struct br_scene bench_scene(enum bench_fields fields);

/* The solver of the registry that has kernels, by its best one. */
struct br_method bench_fast_method(void);

/* One march to be timed. */
struct bench_march {
    const struct br_scene *scene;
    const struct br_method *method;
    size_t n;
    double guess; /* ns an element-step; 0: unknown */
};

/* Whether it can be set up with k = 1e-3 s; else err says why not: a library that cannot factorise
 * so fine a mesh. Coarse ones must not fail. */
bool bench_can_march(const struct bench_march *march, struct br_error *err);

/* What it took. */
struct bench_march_time {
    struct bench_time step; /* ns an element-step, both fields being one */
    double set_up;          /* s */
};

/* What a march will take, s, if setting it up does. */
double bench_march_cost(const struct bench_march *march, double set_up);

/* Marches with k = 1e-3 s, or less where that makes more than a second. */
struct bench_march_time bench_march(const struct bench_march *march);

/* ---- the machine ---- */

/* The rate of independent fused multiply-adds of one instruction set, or of pairs of a multiply and
 * an add where it has no fused ones. */
struct bench_rate {
    const char *name; /* of the kernel that uses it, or another one */
    int bits;
    bool fused;
    double per_ns; /* instructions */
};

/* Read and write of a working set that stays in one level of the memory. */
struct bench_level {
    const char *name;
    size_t bytes;       /* what it holds; the last: SIZE_MAX */
    size_t working_set; /* bytes */
    double rate;        /* bytes read and written a ns */
};

enum { BENCH_MOST_RATES = 8, BENCH_LEVELS = 4 };

struct bench_limits {
    struct bench_rate rate[BENCH_MOST_RATES];
    size_t rates;
    struct bench_level level[BENCH_LEVELS];
};

/* Measures all of them. */
void bench_measure_rates(struct bench_limits *limits);
void bench_measure_levels(struct bench_limits *limits);

/* Least time of an element-step on the fast solver's kernel, ns: by the instructions, and by
 * reading and writing the state from the level where it fits (out). Negative: not known. */
struct bench_least {
    double instructions, memory;
    const char *level;
};
struct bench_least bench_least_time(const struct bench_limits *limits, const char *kernel,
                                    enum bench_fields fields, size_t n);

/* ---- sections: cmocka tests with a struct bench * as state ---- */

void bench_accuracy(void **state);
void bench_machine(void **state);
void bench_speed(void **state);
void bench_loads(void **state);
void bench_expressions(void **state);
void bench_models(void **state);
void bench_peers(void **state);
void bench_errors(void **state);

#endif
