/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solver/scheme.h"

#include <string.h>

/* ---- Runge-Kutta methods with one gamma on the diagonal, the last stage being the end ---- */

/* As they are tabulated: Y_i = Y_0 + k sum_j a_ij Y'_j, at t_{n-1} + c_i k. */
struct tableau {
    int count;
    double a[BR_MOST_STAGES][BR_MOST_STAGES], c[BR_MOST_STAGES];
    double embedded[BR_MOST_STAGES]; /* weights of a second end; all 0: none */
};

/* sum += factor tau Y'_j = factor (Y_j - Z_j) */
static void add_rate(double factor, const struct br_stages *s, int j, double *sum)
{
    sum[BR_STAGE + j] += factor;
    for (int i = 0; i < BR_KNOWN; i++)
        sum[i] -= factor * s->stage[j].weight[i];
}

static void of_tableau(const struct tableau *t, struct br_stages *s)
{
    const double gamma = t->a[0][0];
    bool estimates = false;
    *s = (struct br_stages){.count = t->count};
    for (int i = 0; i < t->count; i++) {
        struct br_stage *stage = &s->stage[i];
        *stage = (struct br_stage){.time = t->c[i], .gamma = gamma, .weight = {[BR_NOW] = 1}};
        for (int j = 0; j < i; j++)
            add_rate(t->a[i][j] / gamma, s, j, stage->weight);
        estimates |= t->embedded[i] != 0;
    }
    for (int j = 0; j < t->count && estimates; j++)
        add_rate((t->a[t->count - 1][j] - t->embedded[j]) / gamma, s, j, s->error);
}

/* 1 - 1/sqrt(2) */
#define GAMMA2 0.29289321881345247560

static const struct tableau sdirk2_tableau = {
    .count = 2,
    .a = {{GAMMA2}, {1 - GAMMA2, GAMMA2}},
    .c = {GAMMA2, 1},
};

/* The root of x^3 - 3x^2 + 3x/2 - 1/6 in (1/6, 1/2) */
#define GAMMA3 0.43586652150845899942

static const struct tableau sdirk3_tableau = {
    .count = 3,
    .a = {{GAMMA3},
          {(1 - GAMMA3) / 2, GAMMA3},
          {(-6 * GAMMA3 * GAMMA3 + 16 * GAMMA3 - 1) / 4,
           (6 * GAMMA3 * GAMMA3 - 20 * GAMMA3 + 5) / 4, GAMMA3}},
    .c = {GAMMA3, (1 + GAMMA3) / 2, 1},
};

static const struct tableau sdirk4_tableau = {
    .count = 5,
    .a = {{1.0 / 4},
          {1.0 / 2, 1.0 / 4},
          {17.0 / 50, -1.0 / 25, 1.0 / 4},
          {371.0 / 1360, -137.0 / 2720, 15.0 / 544, 1.0 / 4},
          {25.0 / 24, -49.0 / 48, 125.0 / 16, -85.0 / 12, 1.0 / 4}},
    .c = {1.0 / 4, 3.0 / 4, 11.0 / 20, 1.0 / 2, 1},
    .embedded = {59.0 / 48, -17.0 / 96, 225.0 / 32, -85.0 / 12, 0},
};

static void euler_stages(size_t since, struct br_stages *s)
{
    (void)since;
    *s = (struct br_stages){.count = 1, .stage = {{1, 1, {[BR_NOW] = 1}}}};
}

static void sdirk2_stages(size_t since, struct br_stages *s)
{
    (void)since;
    of_tableau(&sdirk2_tableau, s);
}

static void sdirk3_stages(size_t since, struct br_stages *s)
{
    (void)since;
    of_tableau(&sdirk3_tableau, s);
}

static void sdirk4_stages(size_t since, struct br_stages *s)
{
    (void)since;
    of_tableau(&sdirk4_tableau, s);
}

/* ---- methods that look back; SDIRK2 starts them ---- */

/* Y_n = 4/3 Y_{n-1} - 1/3 Y_{n-2} + 2/3 k Y'_n */
static void bdf2_stages(size_t since, struct br_stages *s)
{
    static const struct br_stages bdf2 = {
        .count = 1,
        .stage = {{1, 2.0 / 3, {[BR_NOW] = 4.0 / 3, [BR_BEFORE] = -1.0 / 3}}},
    };
    if (since == 0)
        of_tableau(&sdirk2_tableau, s);
    else
        *s = bdf2;
}

/* The trapezoidal rule over 2 gamma k, then a BDF2 of unequal steps. What the first of them needs
 * at t_{n-1}, gamma k Y'_{n-1} = Y_{n-1} - Z, is known from the last stage of the step before. */
static void trbdf2_stages(size_t since, struct br_stages *s)
{
    const double gamma = GAMMA2, half = (1 - gamma) / (2 * gamma); /* w / gamma, w = sqrt(2)/4 */
    const double slope = since == 1 ? (1 - gamma) / gamma : half;
    if (since == 0) {
        of_tableau(&sdirk2_tableau, s);
        return;
    }
    *s = (struct br_stages){
        .count = 2,
        .stage =
            {
                /* Y_{n-1} + gamma k Y'_{n-1} */
                {2 * gamma,
                 gamma,
                 {[BR_NOW] = 2, [BR_BEFORE] = slope - 1, [BR_STAGE_BEFORE] = -slope}},
                /* Y_{n-1} + w k (Y'_{n-1} + Y'_1) = Y_{n-1} + half (Y_1 - Y_{n-1}) */
                {1, gamma, {[BR_NOW] = 1 - half, [BR_STAGE] = half}},
            },
    };
}

static const struct br_time_scheme euler = {
    .name = "euler",
    .title = "implicit Euler, the paper's; contact lagged as printed, or implicit",
    .citation = "Campo et al. 2006, (16)-(17)",
    .order = 1,
    .may_lag = true,
    .stages = euler_stages,
};

static const struct br_time_scheme bdf2 = {
    .name = "bdf2",
    .title = "two-step backward differences; one solve a step",
    .citation = "Hairer and Wanner, Solving Ordinary Differential Equations II, V.1; started by "
                "sdirk2",
    .order = 2,
    .stages = bdf2_stages,
};

static const struct br_time_scheme trbdf2 = {
    .name = "trbdf2",
    .title = "trapezoidal rule and backward differences; two solves a step",
    .citation = "Bank et al., IEEE Trans. Electron Devices 32 (1985) 1992-2007; Hosea and "
                "Shampine, Appl. Numer. Math. 20 (1996) 21-37; started by sdirk2",
    .order = 2,
    .stages = trbdf2_stages,
};

static const struct br_time_scheme sdirk2 = {
    .name = "sdirk2",
    .title = "singly diagonally implicit Runge-Kutta, L-stable; two solves a step",
    .citation = "Alexander, SIAM J. Numer. Anal. 14 (1977) 1006-1021, Theorem 5",
    .order = 2,
    .stages = sdirk2_stages,
};

static const struct br_time_scheme sdirk3 = {
    .name = "sdirk3",
    .title = "the same, third order; three solves a step",
    .citation = "Alexander, SIAM J. Numer. Anal. 14 (1977) 1006-1021, Theorem 5",
    .order = 3,
    .stages = sdirk3_stages,
};

static const struct br_time_scheme sdirk4 = {
    .name = "sdirk4",
    .title = "the same, fourth order; five solves a step",
    .citation = "Hairer and Wanner, Solving Ordinary Differential Equations II, Table IV.6.5",
    .order = 4,
    .stages = sdirk4_stages,
};

static const struct br_time_scheme adaptive = {
    .name = "adaptive",
    .title = "sdirk4 with steps chosen by --tolerance, which finds the times of switching",
    .citation = "Hairer and Wanner, Solving Ordinary Differential Equations II, IV.6 and IV.8",
    .order = 4,
    .estimate_order = 4,
    .adaptive = true,
    .stages = sdirk4_stages,
};

const struct br_time_scheme *const br_time_schemes[] = {&euler,  &bdf2,   &trbdf2,   &sdirk2,
                                                        &sdirk3, &sdirk4, &adaptive,
#ifdef BR_IDA
                                                        &br_ida,
#endif
                                                        NULL};

const struct br_time_scheme *br_time_scheme_find(const char *name)
{
    for (const struct br_time_scheme *const *s = br_time_schemes; *s; s++)
        if (strcmp((*s)->name, name) == 0)
            return *s;
    return NULL;
}

int br_time_scheme_stages(const struct br_time_scheme *scheme)
{
    struct br_stages s;
    if (!scheme->stages)
        return 1;
    scheme->stages(2, &s);
    return s.count;
}
