/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parts of the oracle, in long double: the loads in space, and the responses in time. */
#ifndef BR_TESTS_MODAL_ORACLE_PARTS_H
#define BR_TESTS_MODAL_ORACLE_PARTS_H

#include "tests/modal_oracle.h"

typedef long double real;

/* ---- space: modal_oracle_space.c ---- */

enum { ORACLE_NODES = 20, ORACLE_EDGES = 15 };

/* Gauss-Legendre on [0, 1]. */
struct oracle_gauss {
    real node[ORACLE_NODES], weight[ORACLE_NODES];
    real legendre[ORACLE_NODES][ORACLE_NODES]; /* [k][j]: P_k at node j */
    /* Of the interpolant at 1, by values at the nodes: its value, and half its slope. */
    real end_value[ORACLE_NODES], end_slope[ORACLE_NODES];
};
const struct oracle_gauss *oracle_gauss(void);

/* p[k] (out) = P_k(2 u - 1), k = 0 to ORACLE_NODES. */
void oracle_legendre(real u, real p[ORACLE_NODES + 1]);

/* sqrt(2) sin(b x), or start e^{-b x} + end e^{-b (1 - x)} - cos(b x) + sine sin(b x), which is
 * cosh - cos - sine (sinh - sin) without its cancellation. */
struct oracle_mode {
    bool bending;
    real b, start, end, sine;
};
struct oracle_mode oracle_mode(bool bending, size_t i);
real oracle_mode_value(const struct oracle_mode *m, real x);

/* A mode, or the static deflection under a unit force at the tip (power 1), or the deflection under
 * that deflection as a load (power 2): the sums of phi_i(1) phi_i(x) / lambda_i^power. */
struct oracle_weight {
    const struct oracle_mode *mode; /* NULL: a deflection */
    bool bending;
    int power;
};
real oracle_weight_value(const struct oracle_weight *w, real x);
real oracle_weight_slope(const struct oracle_weight *w); /* at 1 */

/* The mean over the beam of f(x - shift) times the weight. */
real oracle_spread(const struct oracle_weight *w, const struct oracle_factor *f, real shift,
                   real length);

/* edge (out): places between which a factor that is no sum of steps is smooth and wide. */
size_t oracle_edges(const struct oracle_factor *f, real edge[ORACLE_EDGES]);

/* ---- time: modal_oracle_time.c ---- */

struct oracle_panels {
    size_t count, classes, *class_of, *reached; /* reached[k]: panels before the k-th time */
    real *start, *length;                       /* of a panel; of a class */
};

/* Panels (out, to be freed) from 0 to the last of the times, none longer than `longest`: they end
 * where the term jumps or changes fast, and at the times. */
void oracle_panels(struct oracle_panels *p, const struct oracle_term *term, real length,
                   real longest, size_t times, const double *t);
void oracle_panels_free(struct oracle_panels *p);

/* value (out): the states a time s after a unit impulse. carry (out): what they become of given
 * ones after a time s. rate, 1/s: of the fastest decay or oscillation. */
struct oracle_equation {
    void (*impulse)(const struct oracle_equation *e, real s, real value[2]);
    void (*carry)(const struct oracle_equation *e, real s, real carry[2][2]);
    real rate, mass, damping, stiffness;
};
struct oracle_equation oracle_mode_equation(const struct oracle_problem *p, real b);
struct oracle_equation oracle_slow_equation(const struct oracle_problem *p);

/* state[k] (out) at the times, from rest, under a drive that is given at the panels' nodes. */
void oracle_respond(const struct oracle_equation *e, const struct oracle_panels *p,
                    const real *drive, size_t times, real state[][2]);

#endif
