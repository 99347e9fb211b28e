/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The recursions of plain.h on pieces of the beam, exactly, and side by side in the lanes of
 * vectors. README.md in this folder derives it and tells what it costs.
 *
 * The beam is an odd rest at the clamped end and BR_LANES equal spans, one a lane; a span is a
 * number of equal pieces. Each piece has a recursion of its own that begins with P = 0 at its right
 * end, so all share one small table. With the increment y_l at its left end and the costate c at
 * its right one, a step gives y_r = Phi y_l - Z c + z,      c_l = P y_l + Phi'c + q, where z and q
 * are sums over the piece's elements of tabled weights times the state g: the responses of kappa to
 * unit c and unit y_l. The joins are a recursion of the same kind: with c = C y_r + h from the
 * right, M = (1 + Z C)^-1,    y_r = M (Phi y_l + z - Z h), C_l = P + Phi'C M Phi,    h_l = q +
 * Phi'C M z + (M Phi)'h, first over the pieces of a span, which again begins with C = 0 at its
 * right end, so that all lanes share one table here, too; then over the spans.
 *
 * A step is a pass over the joins (predict), which tells the tip's velocity, and one over the
 * elements (finish), which also sums z and q for the next step. What the tip gathers from
 * increments drifts; it is read off the field every few steps. */
#ifndef BR_SOLVER_PIECES_H
#define BR_SOLVER_PIECES_H

#include "solver/linear_solver.h"

/* For both fields. */
extern const struct br_field_solver br_pieces;

#endif
