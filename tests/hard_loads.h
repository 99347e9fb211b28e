/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Random scenes under loads that sampling does not see, with the oracle's description of them. */
#ifndef BR_TESTS_HARD_LOADS_H
#define BR_TESTS_HARD_LOADS_H

#include "tests/modal_oracle.h"
#include "tests/support.h"

/* Kinds of hard loads, and what share of them may be refused. */
#define HARD_KIND_LIST(X)                        \
    X(HARD_BLOW, "blow in t", 0.05)              \
    X(HARD_STRONG, "dominant blow in t", 0.05)   \
    X(HARD_PATCH, "patch in x", 0.05)            \
    X(HARD_BOTH, "blow on a patch", 0.05)        \
    X(HARD_JUMPS_T, "1 to 100 jumps in t", 0.05) \
    X(HARD_JUMPS_X, "1 to 100 jumps in x", 0.05) \
    X(HARD_SUM, "sum of all these", 0.05)        \
    X(HARD_FRONT, "moving front", 1)             \
    X(HARD_PULSE, "moving pulse", 1)

enum hard_kind {
#define X(name, text, share) name,
    HARD_KIND_LIST(X)
#undef X
        HARD_KINDS
};
enum { HARD_TERMS = 6, HARD_STEPS = 104, HARD_TIMES = 6, HARD_TEXT = 16000 };

struct hard_load {
    enum hard_kind kind;
    size_t number;
    double duration; /* T, s */
    double unit;     /* a smooth load of this size, N/m, or at the tip N or N m, by place */
    struct oracle_problem problem;
    struct oracle_term term[HARD_TERMS];
    struct oracle_step step[HARD_TERMS][2][HARD_STEPS]; /* of a term's space and time */
    double sharp[HARD_TERMS]; /* a term's narrowest feature, relative to L or T */
    size_t terms, times;
    double t[HARD_TIMES];     /* ascending */
    double quick[HARD_TERMS]; /* s, a blow's middle; 0: none */
    char text[HARD_TEXT];
    struct br_test_random random;
};

extern const struct hard_kind_row {
    const char *text;
    double refused_at_most;
} hard_kinds[HARD_KINDS];

/* The scene of a number: always the same. */
void hard_load_draw(struct hard_load *c, size_t number);

/* The same of a beam under a patch within a few of its widths, 1e-8 to 1e-2 L, from the clamp. What
 * a mode is there is a difference of what is larger by up to 1e16. */
void hard_load_draw_at_clamp(struct hard_load *c, size_t number);

#endif
