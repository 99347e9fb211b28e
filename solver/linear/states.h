/* SPDX-License-Identifier: GPL-3.0-or-later */
/* States of a field as arrays of numbers, for schemes that keep several (scheme.h), and the memory
 * of their solver. The numbers are doubles; with BR_LONG, for br_long_plain, long doubles. */
#ifndef BR_SOLVER_STATES_H
#define BR_SOLVER_STATES_H

#include "base/status.h"

#ifdef BR_LONG
typedef long double real;
#define br_states_add br_long_states_add
#define br_add_states br_long_add_states
#define br_free_states br_long_free_states
#define br_keep_states br_long_keep_states
#define br_exchange_states br_long_exchange_states
#define br_combine_states br_long_combine_states
#else
typedef double real;
#endif

enum { BR_MOST_STATES = 16 };

struct br_states {
    size_t size, count;       /* numbers of a state; states */
    real *of[BR_MOST_STATES]; /* the first is the one that marches */
    struct br_store store;    /* memory of the states and of the solver's other arrays */
};

/* `count` more states of `size` numbers, all zero. Fails with BR_NO_MEMORY; free them even then. */
enum br_status br_states_add(struct br_states *states, size_t size, size_t count,
                             struct br_error *err);

/* to[i] = sum over j of weight[j] from[j][i], i < size; from[j] may be `to`. Weights of 0 are
 * skipped. */
void br_add_states(real *to, size_t size, size_t count, real *const *from, const double *weight);

/* free, keep, exchange and combine of a br_field_solver (linear_solver.h) whose struct begins with
 * its states, and has no memory outside their store. */
void br_free_states(void *self);
enum br_status br_keep_states(void *self, size_t count, struct br_error *err);
void br_exchange_states(void *self, size_t a, size_t b);
void br_combine_states(void *self, size_t into, size_t count, const double *weight);

#endif
