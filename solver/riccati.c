/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solver/riccati.h"

#include <float.h>

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
