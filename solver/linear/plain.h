/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The flexibility form of one Euler step, as two recursions.
 *
 * The unknown of an element is its strain (its scaled curvature, or its elongation): the "control"
 * kappa. The node's (w, h w_x), or u, is the "state"
 *     y_{i+1} = T y_i + G kappa_i,    y_0 = 0,
 * and the step in increments, delta = v_n - v_{n-1},
 *     (M/k + C + kK) delta = F_n - K w_{n-1} - (C + kK) v_{n-1},
 * minimises
 *     1/2 delta'(M/k) delta + sum_i 1/2 kappa_i'R kappa_i + (R g_i)'kappa_i - F'delta
 * with R = (c + ka)/h^3 diag(1, 1/3) (axial: (c + ka)/h) and
 *     g = alpha kappa_w + kappa_v,    alpha = a / (c + ka).
 * That is a discrete linear-quadratic problem. Its value function
 * 1/2 y'P_i y + p_i'y obeys, from the free end (P_n = 0) to the clamped one,
 *     Q = Mbb + P_{i+1},  S = R + G'QG,  H = G'(QT + Mab'),
 *     K = S^-1 H  (feedback),  A = T - GK  (closed loop),
 *     P_i = Maa + Mab A + (Mab A)' + A'QA + K'RK,
 * computed once, in long double (the Joseph form of P_i subtracts nothing). A step is
 *     backward:  s_i = R g_i + G'p_{i+1},   p_i = A'p_{i+1} - K'R g_i - F_i
 *     forward:   kappa_i = -(K y_i + S^-1 s_i),  y_{i+1} = A y_i - G S^-1 s_i.
 * The state is stored as curvature, and no differences are formed: round-off grows like 1/h, in the
 * assembled stiffness form like 1/h^4.
 *
 * A force r that resists the tip adds r e_tip to p_n. Its influence on element
 * i's control is r zeta_i, zeta_i = S^-1 G'pi_{i+1}, pi_i = A'pi_{i+1}, pi_n =
 * e_tip, so that
 *     delta*_tip = -sum_i zeta_i's_i      and      z_tip = sum_i zeta_i'S zeta_i:
 * the tip's free velocity is known after the backward sweep, the laws find r, and the forward sweep
 * includes it.
 *
 * recursion.c implements this for all kinds of elements, and plain.c the solver, with numbers of
 * the type `real` (states.h): compiled as double for the solver `plain`, and with BR_LONG as long
 * double for what round-off is measured by (br_long_plain), where the names begin with br_long. The
 * state y has d numbers, the control kappa m.
 *
 *     rod             d = 1, m = 1    y = u             kappa = the elongation h u_x
 *     quadratic rod   d = 1, m = 2    y = u             kappa = the elongation, and the bubble
 *     beam            d = 2, m = 2    y = (w, h w_x)    kappa = the coefficients of h^2 w_xx
 *
 * A bubble (field.h) does not reach the nodes, but it has mass and bears load: with f its load,
 *     s_i = R g_i - (0 f)' + G'p_{i+1},    p_i = A'p_{i+1} - K'(R g_i - (0 f)') - F_i. */
#ifndef BR_SOLVER_PLAIN_H
#define BR_SOLVER_PLAIN_H

#ifdef BR_LONG
#define br_recursion_take br_long_recursion_take
#define br_recursion_fill br_long_recursion_fill
#define br_recursion_predict br_long_recursion_predict
#define br_recursion_finish br_long_recursion_finish
#define br_recursion_tip br_long_recursion_tip
#define br_recursion_set br_long_recursion_set
#define br_recursion_get br_long_recursion_get
#define br_plain_form br_long_plain_form
#endif

#include "solver/linear/linear_solver.h"
#include "solver/linear/states.h"

/* A field and its tables. */
struct br_recursion {
    size_t n; /* elements */
    int d, m;
    real h, density, stiffness, viscosity, k; /* as in struct br_field */
    real alpha, r[2];                         /* a / (c + ka); R, diagonal */
    real compliance;                          /* z_tip */
    real *gain;                               /* for each element, by rows: A, K, S^-1, zeta */
    real *drive;                              /* m n, workspace: S^-1 s, m/s */
};

/* The number of numbers in a state: for each element the controls of the displacement, m, and of
 * the velocity, m/s, which do not depend on the step; then the tip's displacement (but see
 * br_recursion_tip) and its velocity, with a stride of m. */
static inline size_t br_recursion_size(const struct br_recursion *s)
{
    return 2 * (size_t)s->m * (s->n + 1);
}

/* The index of the tip's velocity in a state. */
static inline size_t br_recursion_tip_rate(const struct br_recursion *s)
{
    return br_recursion_size(s) - (size_t)s->m;
}

/* Takes memory for tables; if there is none, the store's `failed` is set. */
void br_recursion_take(struct br_recursion *s, struct br_store *store);

/* Computes all tables from the numbers n to k; who: for a message. Fails with BR_SINGULAR. */
enum br_status br_recursion_fill(struct br_recursion *s, const char *who, struct br_error *err);

/* predict, the backward sweep, returns the tip's velocity without contact and friction. finish, the
 * forward sweep, computes the state after the step and returns the tip's velocity; the force, N,
 * resists the tip. */
real br_recursion_predict(struct br_recursion *s, const real *state, const struct br_drive *by);
real br_recursion_finish(struct br_recursion *s, real *state, real force);

/* The tip's displacement, m: of a beam the sum over its elements. */
real br_recursion_tip(const struct br_recursion *s, const real *state);

/* Displacement and velocity by nodes, laid out as in field.h; get: either may be NULL. */
void br_recursion_set(const struct br_recursion *s, const double *displacement,
                      const double *velocity, real *state);
void br_recursion_get(const struct br_recursion *s, const real *state, double *displacement,
                      double *velocity);

#endif
