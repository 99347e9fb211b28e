/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The map of extremes: are random scenes, drawn to break the program, right or refused? As a test,
 * the first cases of seeds 1 to 10: prints each seed's tally, and what is silently wrong.
 * usage: map [SEED CASES]   the first cases of one seed: of each its class and, of an answer, the
 *                           error and the stated bound of the field that is nearest to its bound */
#include <gsl/gsl_cdf.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/each.h"
#include "tests/lab/map.h"
#include "tests/support.h"

enum { SEEDS = 10, SAMPLE = 6, MANY = 100 };

struct map {
    uint64_t seed;
    struct br_extreme_verdict *verdict;
};

static enum br_status find_verdict(void *self, size_t i, struct br_error *why)
{
    const struct map *m = self;
    struct br_extreme_case one;
    br_extreme_draw(m->seed, i, &one);
    return br_extreme_check(&one, &(struct br_extreme_options){0}, &m->verdict[i], why);
}

/* Prints the tally and an upper bound of the rate of what is silently wrong: 95 %, of Clopper and
 * Pearson 1934. */
static void print_tally(size_t cases, const size_t count[BR_EXTREME_CLASSES])
{
    const size_t wrong = count[BR_EXTREME_WRONG];
    const size_t right = cases - wrong - count[BR_EXTREME_REFUSED] - count[BR_EXTREME_UNCHECKED];
    for (size_t i = 0; i < BR_EXTREME_CLASSES; i++)
        printf("%s%s %zu", i ? ", " : "", br_extreme_words[i], count[i]);
    printf("; a rate of at most %.3g\n",
           right > 0 ? gsl_cdf_beta_Pinv(0.975, (double)wrong + 1, (double)right) : 1);
}

/* How many of the first cases of a seed are silently wrong. all: prints the class of each. */
static size_t try_seed(uint64_t seed, size_t cases, bool all)
{
    struct map m = {seed, br_allocate(cases, sizeof *m.verdict)};
    size_t count[BR_EXTREME_CLASSES] = {0};
    if (!m.verdict ||
        br_each(&(struct br_each){.count = cases, .turn = find_verdict, .self = &m}, &err)) {
        printf("Bail out! %s\n", err.message);
        exit(99);
    }
    for (size_t i = 0; i < cases; i++) {
        const struct br_extreme_verdict *v = &m.verdict[i];
        count[v->which]++;
        if (all || v->which == BR_EXTREME_WRONG)
            printf("# %llu %zu %s %.3g %.3g %s %s\n", (unsigned long long)seed, i,
                   br_extreme_words[v->which], v->nearest, v->stated, v->known ? "known" : "-",
                   v->why);
    }
    free(m.verdict);
    printf("%sok - seed %llu: ", count[BR_EXTREME_WRONG] ? "not " : "", (unsigned long long)seed);
    print_tally(cases, count);
    return count[BR_EXTREME_WRONG];
}

int main(int arguments, char **argument)
{
    const bool one = arguments == 3;
    const uint64_t first = one ? strtoull(argument[1], NULL, 10) : 1;
    const uint64_t last = one ? first : SEEDS;
    const size_t cases = one ? strtoul(argument[2], NULL, 10) : br_test_long() ? MANY : SAMPLE;
    if (!(cases > 0) || (arguments != 1 && !one)) {
        fputs("usage: map [SEED CASES]\n", stderr);
        return 2;
    }
    size_t wrong = 0;
    printf("TAP version 13\n1..%llu\n", (unsigned long long)(last - first + 1));
    for (uint64_t seed = first; seed <= last; seed++)
        wrong += try_seed(seed, cases, one);
    return wrong > 0;
}
