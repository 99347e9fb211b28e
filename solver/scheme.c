/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solver/scheme.h"

#include <math.h>
#include <string.h>

/* ---- Runge-Kutta methods with one gamma on the diagonal, the last stage being the end ---- */

/* Butcher tableaus: Y_i = Y_{n-1} + k sum_j a_ij Y'_j at t_{n-1} + c_i k. With c_0 = 0 the first
 * row is no stage, but Y_{n-1} itself. With rows = 0 the form gives the stages directly. */
struct br_step_form {
    int rows;
    double gamma;
    double a[BR_MOST_STAGES + 1][BR_MOST_STAGES + 1], c[BR_MOST_STAGES + 1];
    double embedded[BR_MOST_STAGES + 1]; /* weights of a second end; all 0: none */
    struct br_stages stages;
};

/* The weights of states (without that of tau Y') sum to 1. The sum of rounded weights may be off by
 * 1e-16, and a march of N steps would add that up N times with the same sign. So the smallest
 * weight, which has the most digits after the point, is corrected. */
static void balance(struct br_stage *stage)
{
    const double round_off = 1e-14;
    long double excess = -1;
    int smallest = -1;
    for (int i = 0; i < BR_KNOWN; i++) {
        const double size = fabs(stage->weight[i]);
        if (i == BR_RATE || size == 0)
            continue;
        excess += stage->weight[i];
        if (smallest < 0 || size < fabs(stage->weight[smallest]))
            smallest = i;
    }
    if (smallest >= 0 && fabsl(excess) < round_off)
        stage->weight[smallest] -= (double)excess;
}

/* sum += factor tau Y' of a row: of a stage, tau Y' = Y - Z. */
static void add_rate(double factor, const struct br_stages *s, int stage, double *sum)
{
    if (stage < 0) {
        sum[BR_RATE] += factor;
        return;
    }
    sum[BR_STAGE + stage] += factor;
    for (int i = 0; i < BR_KNOWN; i++)
        sum[i] -= factor * s->stage[stage].weight[i];
}

static void of_tableau(const struct br_step_form *t, struct br_stages *s)
{
    const int skipped = t->c[0] == 0;
    bool estimates = false;
    *s = (struct br_stages){.count = t->rows - skipped};
    for (int i = skipped; i < t->rows; i++) {
        struct br_stage *stage = &s->stage[i - skipped];
        *stage = (struct br_stage){.time = t->c[i], .gamma = t->gamma, .weight = {[BR_NOW] = 1}};
        for (int j = 0; j < i; j++)
            add_rate(t->a[i][j] / t->gamma, s, j - skipped, stage->weight);
        balance(stage);
        estimates |= t->embedded[i] != 0;
    }
    for (int j = 0; j < t->rows && estimates; j++)
        add_rate((t->a[t->rows - 1][j] - t->embedded[j]) / t->gamma, s, j - skipped, s->error);
}

/* 1 - 1/sqrt(2) */
#define GAMMA2 0.29289321881345247560

static const struct br_step_form sdirk2_form = {
    .rows = 2,
    .gamma = GAMMA2,
    .a = {{GAMMA2}, {1 - GAMMA2, GAMMA2}},
    .c = {GAMMA2, 1},
};

/* The root of x^3 - 3x^2 + 3x/2 - 1/6 in (1/6, 1/2) */
#define GAMMA3 0.43586652150845899942

static const struct br_step_form sdirk3_form = {
    .rows = 3,
    .gamma = GAMMA3,
    .a = {{GAMMA3},
          {(1 - GAMMA3) / 2, GAMMA3},
          {(-6 * GAMMA3 * GAMMA3 + 16 * GAMMA3 - 1) / 4,
           (6 * GAMMA3 * GAMMA3 - 20 * GAMMA3 + 5) / 4, GAMMA3}},
    .c = {GAMMA3, (1 + GAMMA3) / 2, 1},
};

static const struct br_step_form sdirk4_form = {
    .rows = 5,
    .gamma = 0.25,
    .a = {{1.0 / 4},
          {1.0 / 2, 1.0 / 4},
          {17.0 / 50, -1.0 / 25, 1.0 / 4},
          {371.0 / 1360, -137.0 / 2720, 15.0 / 544, 1.0 / 4},
          {25.0 / 24, -49.0 / 48, 125.0 / 16, -85.0 / 12, 1.0 / 4}},
    .c = {1.0 / 4, 3.0 / 4, 11.0 / 20, 1.0 / 2, 1},
    .embedded = {59.0 / 48, -17.0 / 96, 225.0 / 32, -85.0 / 12, 0},
};

/* A third-order and a fourth-order one whose stages are of second order each: stiffness does not
 * lower their order as it lowers that of the methods above, which start them. */
#define C1 (2 * GAMMA3)
#define C2 (3.0 / 5)
/* 1/2 and 1/3 without the last stage's share of sum b c and of sum b c^2. */
#define HALF (1.0 / 2 - GAMMA3)
#define THIRD (1.0 / 3 - GAMMA3)
#define A21 (C2 * (C2 - C1) / (2 * C1)) /* sum a_2j c_j = c_2^2 / 2 */
#define B1 ((THIRD - C2 * HALF) / (C1 * (C1 - C2)))
#define B2 ((THIRD - C1 * HALF) / (C2 * (C2 - C1)))

static const struct br_step_form esdirk3_form = {
    .rows = 4,
    .gamma = GAMMA3,
    .a = {{0},
          {GAMMA3, GAMMA3},
          {C2 - A21 - GAMMA3, A21, GAMMA3},
          {1 - B1 - B2 - GAMMA3, B1, B2, GAMMA3}},
    .c = {0, C1, C2, 1},
};

static const struct br_step_form esdirk4_form = {
    .rows = 6,
    .gamma = 0.25,
    .a = {{0},
          {1.0 / 4, 1.0 / 4},
          {8611.0 / 62500, -1743.0 / 31250, 1.0 / 4},
          {5012029.0 / 34652500, -654441.0 / 2922500, 174375.0 / 388108, 1.0 / 4},
          {15267082809.0 / 155376265600, -71443401.0 / 120774400, 730878875.0 / 902184768,
           2285395.0 / 8070912, 1.0 / 4},
          {82889.0 / 524892, 0, 15625.0 / 83664, 69875.0 / 102672, -2260.0 / 8211, 1.0 / 4}},
    .c = {0, 1.0 / 2, 83.0 / 250, 31.0 / 50, 17.0 / 20, 1},
    .embedded = {4586570599.0 / 29645900160, 0, 178811875.0 / 945068544, 814220225.0 / 1159782912,
                 -3700637.0 / 11593932, 61727.0 / 225920},
};

/* ---- stages that are given ---- */

/* Their smallest weight is 1 minus the others, see balance. */

static const struct br_step_form euler_form = {
    .stages = {.count = 1, .stage = {{1, 1, {[BR_NOW] = 1}}}},
};

/* Y_n = 4/3 Y_{n-1} - 1/3 Y_{n-2} + 2/3 k Y'_n */
static const struct br_step_form bdf2_form = {
    .stages = {.count = 1,
               .stage = {{1, 2.0 / 3, {[BR_NOW] = 4.0 / 3, [BR_BEFORE] = 1 - 4.0 / 3}}}},
};

/* Y_n = 18/11 Y_{n-1} - 9/11 Y_{n-2} + 2/11 Y_{n-3} + 6/11 k Y'_n */
static const struct br_step_form bdf3_form = {
    .stages = {.count = 1,
               .stage = {{1,
                          6.0 / 11,
                          {[BR_NOW] = 18.0 / 11,
                           [BR_BEFORE] = -9.0 / 11,
                           [BR_BEFORE_THAT] = 1 - 18.0 / 11 + 9.0 / 11}}}},
};

/* The trapezoidal rule over 2 gamma k, Y_1 = Y_{n-1} + gamma k (Y'_{n-1} + Y'_1), then a BDF2 of
 * unequal steps, Y_2 = Y_{n-1} + w k (Y'_{n-1} + Y'_1) + gamma k Y'_2 with w = (1 - gamma)/2. */
#define RATIO ((1 - GAMMA2) / (2 * GAMMA2))
static const struct br_step_form trbdf2_form = {
    .stages = {.count = 2,
               .stage = {{2 * GAMMA2, GAMMA2, {[BR_NOW] = 1, [BR_RATE] = 1}},
                         {1, GAMMA2, {[BR_NOW] = 1 - RATIO, [BR_STAGE] = RATIO}}}},
};

/* ---- the registry ---- */

static const struct br_time_scheme euler = {
    .name = "euler",
    .title = "implicit Euler, the paper's; contact lagged as printed, or implicit",
    .citation = "Campo et al. 2006, (16)-(17)",
    .order = 1,
    .may_lag = true,
    .form = {&euler_form, &euler_form, &euler_form},
};

static const struct br_time_scheme bdf2 = {
    .name = "bdf2",
    .title = "two-step backward differences; one solve a step",
    .citation = "Hairer and Wanner, Solving Ordinary Differential Equations II, V.1; started by "
                "sdirk2",
    .order = 2,
    .form = {&sdirk2_form, &bdf2_form, &bdf2_form},
};

static const struct br_time_scheme bdf3 = {
    .name = "bdf3",
    .title = "three-step backward differences; one solve a step; not for undamped vibration",
    .citation = "Hairer and Wanner, Solving Ordinary Differential Equations II, V.1; started by "
                "sdirk2 and bdf2",
    .order = 3,
    .needs_damping = true, /* A(86 degrees)-stable */
    .form = {&sdirk2_form, &bdf2_form, &bdf3_form},
};

static const struct br_time_scheme trbdf2 = {
    .name = "trbdf2",
    .title = "trapezoidal rule and backward differences, L-stable; two solves a step",
    .citation = "Bank et al., IEEE Trans. Electron Devices 32 (1985) 1992-2007; Hosea and "
                "Shampine, Appl. Numer. Math. 20 (1996) 21-37; started by sdirk2",
    .order = 2,
    .form = {&sdirk2_form, &trbdf2_form, &trbdf2_form},
};

static const struct br_time_scheme sdirk2 = {
    .name = "sdirk2",
    .title = "diagonally implicit Runge-Kutta, L-stable, uses no earlier step; two solves a step",
    .citation = "Alexander, SIAM J. Numer. Anal. 14 (1977) 1006-1021, Theorem 5",
    .order = 2,
    .form = {&sdirk2_form, &sdirk2_form, &sdirk2_form},
};

static const struct br_time_scheme esdirk3 = {
    .name = "esdirk3",
    .title = "diagonally implicit Runge-Kutta, L-stable; three solves a step",
    .citation = "Kennedy and Carpenter, Appl. Numer. Math. 44 (2003) 139-181, ARK3(2)4L[2]SA; "
                "started by Alexander's method of that order",
    .order = 3,
    .form = {&sdirk3_form, &esdirk3_form, &esdirk3_form},
};

static const struct br_time_scheme esdirk4 = {
    .name = "esdirk4",
    .title = "diagonally implicit Runge-Kutta, L-stable; five solves a step",
    .citation = "Kennedy and Carpenter, Appl. Numer. Math. 44 (2003) 139-181, ARK4(3)6L[2]SA; "
                "started by Hairer and Wanner, Solving Ordinary Differential Equations II, Table "
                "IV.6.5",
    .order = 4,
    .form = {&sdirk4_form, &esdirk4_form, &esdirk4_form},
};

static const struct br_time_scheme adaptive = {
    .name = "adaptive",
    .title = "esdirk4 with steps chosen by --tolerance, which finds the times of switching",
    .citation = "Kennedy and Carpenter, Appl. Numer. Math. 44 (2003) 139-181; solver/adaptive.c",
    .order = 4,
    .estimate_order = 4,
    .adaptive = true,
    .form = {&sdirk4_form, &esdirk4_form, &esdirk4_form},
};

const struct br_time_scheme *const br_time_schemes[] = {
    &euler, &bdf2, &bdf3, &trbdf2, &sdirk2, &esdirk3, &esdirk4, &adaptive, NULL};

const struct br_time_scheme *br_time_scheme_find(const char *name)
{
    for (const struct br_time_scheme *const *s = br_time_schemes; *s; s++)
        if (strcmp((*s)->name, name) == 0)
            return *s;
    return NULL;
}

void br_time_scheme_step(const struct br_time_scheme *scheme, size_t since, struct br_stages *s)
{
    const struct br_step_form *form = scheme->form[since < 2 ? since : 2];
    if (form->rows)
        of_tableau(form, s);
    else
        *s = form->stages;
}

int br_time_scheme_stages(const struct br_time_scheme *scheme)
{
    struct br_stages s;
    if (!scheme->form[2])
        return 1;
    br_time_scheme_step(scheme, 2, &s);
    return s.count;
}
