/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solver/riccati.h"

#include <float.h>

#include "solver/pieces.h"

/* An upper estimate; the benchmark and tests/ measure far less. */
static double riccati_round_off(const struct br_field *field,
                                const struct br_linear_options *options)
{
    (void)options;
    return 4 * DBL_EPSILON * (double)field->n;
}

const struct br_linear_solver br_riccati = {
    .name = "riccati",
    .title = "flexibility form: element curvatures by a backward and a forward recursion",
    .citation = "discrete linear-quadratic problem; Riccati recursion, see solver/riccati.h",
    .options = "",
    .axial = &br_riccati_axial,
    .bending = &br_riccati_bending,
    .round_off = riccati_round_off,
};

/* The joins add the round-off of their own sums, whatever the mesh. */
static double lanes_round_off(const struct br_field *field, const struct br_linear_options *options)
{
    (void)options;
    return 8 * DBL_EPSILON * ((double)field->n + 1024);
}

const struct br_linear_solver br_lanes = {
    .name = "lanes",
    .title = "the same form on pieces of the beam, side by side in the lanes of vectors",
    .citation = "Riccati recursions of substructures, see solver/pieces.c",
    .options = "--kernel",
    .axial = &br_pieces,
    .bending = &br_pieces,
    .round_off = lanes_round_off,
};
