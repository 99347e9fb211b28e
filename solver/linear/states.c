/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solver/linear/states.h"

#include "solver/instruction_set.h"

enum { BLOCK = 256 }; /* numbers that stay in the first-level cache while they are summed */

enum br_status br_states_add(struct br_states *states, size_t size, size_t count,
                             struct br_error *err)
{
    states->size = size;
    for (size_t i = 0; i < count; i++) {
        real *fresh = br_store_take(&states->store, size, sizeof *fresh);
        if (!fresh)
            return br_no_memory(err, "the states of a time scheme");
        states->of[states->count++] = fresh;
    }
    return BR_OK;
}

BR_SWEEP
static void add_block(real *restrict sum, size_t size, double weight, const real *from)
{
    for (size_t i = 0; i < size; i++)
        sum[i] += weight * from[i];
}

/* add_block for four states at once, in the same order: the sum stays in registers. */
BR_SWEEP
static void add_four(real *restrict sum, size_t size, const double *weight, real *const *from,
                     size_t first)
{
    const real *a = from[0] + first, *b = from[1] + first, *c = from[2] + first,
               *d = from[3] + first;
    for (size_t i = 0; i < size; i++)
        sum[i] = (((sum[i] + weight[0] * a[i]) + weight[1] * b[i]) + weight[2] * c[i]) +
                 weight[3] * d[i];
}

void br_add_states(real *to, size_t size, size_t count, real *const *from, const double *weight)
{
    for (size_t first = 0; first < size; first += BLOCK) {
        const size_t width = size - first < BLOCK ? size - first : BLOCK;
        real sum[BLOCK] = {0};
        for (size_t j = 0; j < count; j++) {
            const bool four = j + 4 <= count && weight[j] != 0 && weight[j + 1] != 0 &&
                              weight[j + 2] != 0 && weight[j + 3] != 0;
            if (four)
                add_four(sum, width, weight + j, from + j, first);
            else if (weight[j] != 0)
                add_block(sum, width, weight[j], from[j] + first);
            j += four ? 3 : 0;
        }
        for (size_t i = 0; i < width; i++)
            to[first + i] = sum[i];
    }
}

void br_free_states(void *self)
{
    if (self)
        br_store_clear(&((struct br_states *)self)->store);
    free(self);
}

enum br_status br_keep_states(void *self, size_t count, struct br_error *err)
{
    struct br_states *states = self;
    return br_states_add(states, states->size, count, err);
}

void br_exchange_states(void *self, size_t a, size_t b)
{
    struct br_states *states = self;
    real *of_a = states->of[a];
    states->of[a] = states->of[b];
    states->of[b] = of_a;
}

void br_combine_states(void *self, size_t into, size_t count, const double *weight)
{
    struct br_states *states = self;
    br_add_states(states->of[into], states->size, count, states->of, weight);
}
