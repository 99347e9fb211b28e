/* SPDX-License-Identifier: GPL-3.0-or-later */
/* L2 projections of Legendre series on piecewise polynomials on equal elements. */
#ifndef BR_REFERENCE_EXACT_PROJECTION_H
#define BR_REFERENCE_EXACT_PROJECTION_H

#include "reference/exact/exact.h"
#include "reference/exact/pieces.h"

/* Of a series on [0, 1], on elements that fill a part of it. */
struct br_restriction;

struct br_restriction_shape {
    size_t length;   /* coefficients of the series, in p_0 ... p_{length - 1} of legendre.h */
    size_t elements; /* 1 or more */
    size_t degree;   /* on each of them */
    double scale;    /* all results are times this; for a beam of length L, sqrt(L) */
    long double first, width; /* the part: [first, first + width]; 0 and 1 for all */
};

/* *out (owned by the store). Fails with BR_NO_MEMORY or BR_SINGULAR. */
enum br_status br_restriction_create(struct br_restriction **out,
                                     const struct br_restriction_shape *shape,
                                     struct br_store *store, struct br_error *err);

/* c (out, elements x (degree + 1)): coefficients of the Legendre polynomials that are
 * orthonormal on each element. *rest (out): the square of the L2 norm of what these leave out of
 * the part, found without a difference. series: length, in. For one thread at a time. */
void br_restriction_apply(struct br_restriction *restriction, const double *series, double *c,
                          double *rest);

/* The L2 projection of a series on the elements of pieces.h on polynomials on equal elements. */
struct br_piecewise;

/* *out (owned by the store). Series have `extra` more terms. Fails as br_restriction_create. */
enum br_status br_piecewise_create(struct br_piecewise **out, const struct br_pieces *pieces,
                                   size_t extra, const struct br_exact_mesh *mesh,
                                   struct br_store *store, struct br_error *err);

/* c and rest as br_exact_projection_apply has them. For one thread at a time. */
void br_piecewise_apply(struct br_piecewise *piecewise, const double *series, double *c,
                        double *rest);

#endif
