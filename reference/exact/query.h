/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Inside of the exact reference: parts of a state as Legendre series. */
#ifndef BR_REFERENCE_EXACT_QUERY_H
#define BR_REFERENCE_EXACT_QUERY_H

#include "reference/exact/solution.h"

/* Refuses (BR_BAD_INPUT) fields that are not modelled, and orders above the
 * field's (1 axial, 2 bending) plus extra. */
enum br_status br_exact_check_part(const struct br_exact *exact, const struct br_exact_part *part,
                                   size_t extra, struct br_error *err);

/* c (out, br_modes_length(0)): coefficients of the part's series (pieces.h); for an order above the
 * field's, of the series that is yet to be derived once, by x / L. */
void br_exact_series(const struct br_exact *exact, const struct br_exact_state *state,
                     const struct br_exact_part *part, double *c);

#endif
