/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The flexibility form, fast. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "solver/linear/plain.h"
#include "solver/linear/riccati/kernel.h"
#include "solver/linear/riccati/pieces.h"

/* Where a wave does not cross an element in a step, the step is the mass's alone, whose condition
 * in strains is n for a rod and n^2 for a beam: no more than that is lost. Measured for n = 40 to
 * 3200 and rho / (c k) up to 1e25. */
static double most_excess(const struct br_field *f)
{
    const double n = (double)f->n;
    return f->kind == BR_AXIAL ? 1e4 + 64 * n : 1e5 + 4 * n * n;
}

/* The strain g is larger than the increment that it leads to by br_field_inertia, in the lowest
 * mode of free vibration. The joins add the round-off of their sums: where inertia rules, pieces
 * that are free at one end answer by far more than what is left when they are joined. Short beams
 * are one piece. */
static double riccati_round_off(const struct br_field *field,
                                const struct br_linear_options *options)
{
    (void)options;
    const double joined = field->n <= 20 ? 0 : field->kind == BR_AXIAL ? 0.25 : 4;
    const double excess = fmin(br_field_inertia(field), most_excess(field));
    return DBL_EPSILON * (8 * ((double)field->n + 1024) + joined * excess);
}

static double riccati_cost(const struct br_field *field, double sums)
{
    return br_field_is_quadratic(field) ? br_plain.cost(field, sums) : br_pieces_cost(field, sums);
}

const struct br_linear_solver br_riccati = {
    .name = "riccati",
    .title = "flexibility form: Riccati recursions on pieces of the beam, side by side in vectors",
    .citation =
        "discrete linear-quadratic problem in substructures, see solver/linear/riccati/pieces.h",
    .options = "--kernel",
    .axial = &br_pieces,
    .axial_quadratic = &br_plain_form,
    .bending = &br_pieces,
    .round_off = riccati_round_off,
    .bytes = {40, 62, 140},
    .state_bytes = {28, 44, 32},
    .cost = riccati_cost,
};

/* ---- kernels ---- */

#define ROW(set) &br_kernel_##set,
const struct br_kernel *const br_kernels[] = {BR_INSTRUCTION_SETS(ROW) NULL};

const struct br_kernel *br_kernel_best(void)
{
    return br_kernels[br_instruction_set_best()];
}

const struct br_kernel *br_kernel_find(const char *name)
{
    return br_kernels[br_instruction_set_find(name)];
}
