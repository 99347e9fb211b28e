/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A reproducible generator of random numbers: SplitMix64 (Steele, Lea and Flood 2014). */
#ifndef BR_TESTS_LAB_RANDOM_H
#define BR_TESTS_LAB_RANDOM_H

#include <math.h>
#include <stddef.h>
#include <stdint.h>

struct br_random {
    uint64_t state;
};

static inline uint64_t br_random_bits(struct br_random *r)
{
    uint64_t z = (r->state += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

/* A generator for item `index` of a seed, independent of the draws for other items. */
static inline struct br_random br_random_of(uint64_t seed, size_t index)
{
    struct br_random r = {seed};
    r.state = br_random_bits(&r) ^ ((uint64_t)index * 0xd1342543de82ef95u);
    br_random_bits(&r);
    return r;
}

/* In [low, high). */
static inline double br_random_uniform(struct br_random *r, double low, double high)
{
    return low + (high - low) * ((double)(br_random_bits(r) >> 11) * 0x1p-53);
}

/* 10^x, x uniform in [low, high). */
static inline double br_random_decades(struct br_random *r, double low, double high)
{
    return pow(10, br_random_uniform(r, low, high));
}

/* 0 .. count - 1. */
static inline size_t br_random_index(struct br_random *r, size_t count)
{
    return (size_t)(br_random_bits(r) % count);
}

/* True with probability 1/times. */
static inline int br_random_once_in(struct br_random *r, size_t times)
{
    return br_random_index(r, times) == 0;
}

#endif
