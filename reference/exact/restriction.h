/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The L2 projection of a Legendre series on [0, 1] on piecewise polynomials on equal elements that
 * fill a part of it. */
#ifndef BR_REFERENCE_EXACT_RESTRICTION_H
#define BR_REFERENCE_EXACT_RESTRICTION_H

#include <stddef.h>

#include "solver/status.h"

struct br_restriction;

struct br_restriction_shape {
    size_t length;   /* coefficients of the series, in p_0 ... p_{length - 1} of legendre.h */
    size_t elements; /* 1 or more */
    size_t degree;   /* on each of them */
    double scale;    /* all results are times this; for a beam of length L, sqrt(L) */
    long double first, width; /* the part: [first, first + width]; 0 and 1 for all */
};

/* *out (owned by the caller). Fails with BR_NO_MEMORY or BR_SINGULAR. */
enum br_status br_restriction_create(struct br_restriction **out,
                                     const struct br_restriction_shape *shape,
                                     struct br_error *err);
void br_restriction_free(struct br_restriction *restriction);

/* c (out, elements x (degree + 1)): coefficients of the Legendre polynomials that are
 * orthonormal on each element. *rest (out): the square of the L2 norm of what these leave out of
 * the part, found without a difference. series: length, in. For one thread at a time. */
void br_restriction_apply(struct br_restriction *restriction, const double *series, double *c,
                          double *rest);

#endif
