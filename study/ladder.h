/* SPDX-License-Identifier: GPL-3.0-or-later */
/* L2 distances between functions on nested meshes, exactly.
 *
 * On each element a finite element function is written in orthonormal Legendre
 * polynomials ("modes": 2 for axial, 4 for bending, each times sqrt(h), so that
 * the squared L2 norm is the sum of the squared modes). The reference is
 * projected from its own mesh down a ladder of coarser ones; what each rung
 * loses is kept as a sum of squares. For a function v of rung n,
 *     |v - ref|^2 = |v - P_n ref|^2 + |ref - P_n ref|^2    (Pythagoras),
 * and both terms are sums of squares of small numbers: no sampling, no
 * quadrature, and no cancellation as in |ref|^2 - 2(ref, v) + |v|^2. */
#ifndef BR_LADDER_H
#define BR_LADDER_H

#include "solver/field.h"

struct br_ladder;

/* A ladder from a mesh of `finest` elements down to each of n[0..count), every
 * one of which divides `finest` (duplicates and `finest` itself are fine). Fails
 * with BR_BAD_INPUT (not nested) or BR_NO_MEMORY. */
enum br_status br_ladder_create(struct br_ladder **ladder, enum br_field_kind kind, size_t finest,
                                size_t count, const size_t *n, struct br_error *err);
void br_ladder_free(struct br_ladder *ladder); /* accepts NULL */

/* Doubles in a projection of one function onto all rungs. */
size_t br_ladder_size(const struct br_ladder *ladder);

/* Projects a function given by its modes on the finest mesh (in, finest * modes
 * values) onto all rungs; `projection`: out, br_ladder_size values. */
void br_ladder_project(const struct br_ladder *ladder, const double *modes, double *projection);

/* L2 distance, m times sqrt(m), of a function with the given modes (in) on the
 * mesh n[rung] from the projected one. */
double br_ladder_distance(const struct br_ladder *ladder, size_t rung, const double *modes,
                          const double *projection);

/* Modes of an element: 2 axial, 4 bending. */
size_t br_mode_count(enum br_field_kind kind);

/* Modes of a finite element function (out, n * br_mode_count values) from its
 * nodal values (in, laid out as in solver/field.h). */
void br_modes(const struct br_field *field, const double *nodal, double *modes);

#endif
