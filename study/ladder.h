/* SPDX-License-Identifier: GPL-3.0-or-later */
/* L2 distances between functions on nested meshes, exactly.
 *
 * On each element a function is given by its orthonormal Legendre modes (modes.h).
 * The reference is projected from its own meshes down a ladder of coarser ones; what each rung
 * loses is kept as a sum of squares. For a function v of rung n,
 *     |v - ref|^2 = |v - P_n ref|^2 + |ref - P_n ref|^2    (Pythagoras),
 * and both terms are sums of squares of small numbers: no sampling, no
 * quadrature, and no cancellation as in |ref|^2 - 2(ref, v) + |v|^2. */
#ifndef BR_LADDER_H
#define BR_LADDER_H

#include <stdbool.h>
#include <stddef.h>

#include "solver/status.h"

struct br_ladder;

/* Numbers of elements; borrowed. */
struct br_mesh_list {
    size_t count;
    const size_t *n;
};

/* A ladder for functions with 1, 2 or 4 modes an element, from one or more
 * root meshes down to the rungs, every one of which divides a root (it may be one).
 * Fails with BR_BAD_INPUT (not nested) or BR_NO_MEMORY. */
enum br_status br_ladder_create(struct br_ladder **ladder, size_t modes,
                                const struct br_mesh_list *roots, const struct br_mesh_list *rungs,
                                struct br_error *err);
void br_ladder_free(struct br_ladder *ladder); /* accepts NULL */

/* Doubles in a projection of one function onto all rungs. */
size_t br_ladder_size(const struct br_ladder *ladder);

/* A function on a root mesh: the modes of its projection there (in, root * modes
 * values), and the square of the L2 norm of what that leaves out. */
struct br_root_value {
    double *modes;
    double rest;
};

/* Projects a function given on every root mesh onto all rungs; `projection`: out,
 * br_ladder_size values. */
void br_ladder_project(const struct br_ladder *ladder, const struct br_root_value *root,
                       double *projection);

/* L2 distance of a function with the given modes (in) on the
 * mesh n[rung] from the projected one. */
double br_ladder_distance(const struct br_ladder *ladder, size_t rung, const double *modes,
                          const double *projection);

#endif
