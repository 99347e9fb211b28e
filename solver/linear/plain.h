/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The flexibility form of one Euler step, as two recursions.
 *
 * The unknown of an element is what deforms it (its scaled curvature, or its
 * elongation): the "control" kappa. The node's (w, h w_x), or u, is the "state"
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
 * The state is stored as curvature; nothing is ever differenced, so round-off
 * grows like 1/h where the assembled stiffness form loses 1/h^4.
 *
 * A force r that resists the tip adds r e_tip to p_n. Its influence on element
 * i's control is r zeta_i, zeta_i = S^-1 G'pi_{i+1}, pi_i = A'pi_{i+1}, pi_n =
 * e_tip, so that
 *     delta*_tip = -sum_i zeta_i's_i      and      z_tip = sum_i zeta_i'S zeta_i:
 * the tip's free velocity is known when the backward sweep ends, the laws find
 * r, and the forward sweep already carries it. */
#ifndef BR_SOLVER_PLAIN_H
#define BR_SOLVER_PLAIN_H

#include "solver/linear/linear_solver.h"

/* For both fields, and both degrees of the axial one. */
extern const struct br_field_solver br_plain_form;

#endif
