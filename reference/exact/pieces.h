/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Elements of a beam, and functions that are a Legendre series on each of them.
 *
 * On element e, of width h in units of L, a function is the sum over k of c_k p_k(xi) / sqrt(h),
 * xi in [0, 1]: these are orthonormal in x / L. A series has terms[e] + extra coefficients there,
 * where `extra` counts how often functions of terms[e] coefficients were integrated. */
#ifndef BR_REFERENCE_EXACT_PIECES_H
#define BR_REFERENCE_EXACT_PIECES_H

#include "reference/exact/exact.h"
#include "reference/exact/legendre.h"
#include "solver/proof.h"

struct br_pieces {
    double length; /* L, m */
    size_t count;  /* elements, 1 or more */
    double *end;   /* count + 1, m: 0 = end[0] < ... < end[count] = L */
    size_t *terms; /* count, each 1 or more */
    size_t *first; /* count + 1: sum of the terms before */
};

/* Copies end and terms. After a failure, which the store keeps, the pieces are of no use. */
void br_pieces_init(struct br_pieces *pieces, double length, size_t count, const double *end,
                    const size_t *terms, struct br_store *store);

/* Where element e's coefficients begin; with e = count, their number. */
static inline size_t br_pieces_at(const struct br_pieces *p, size_t e, size_t extra)
{
    return p->first[e] + e * extra;
}

/* h of element e, in units of L. */
static inline double br_pieces_width(const struct br_pieces *p, size_t e)
{
    return (p->end[e + 1] - p->end[e]) / p->length;
}

/* The element that holds x, m; where two meet the left one. */
size_t br_pieces_find(const struct br_pieces *pieces, double x);

/* Integral over all x / L of a series. */
double br_pieces_integral(const struct br_pieces *pieces, size_t extra, const double *c);

/* c: in, a series with `extra`; out, its integral from x = 0 in x / L, with extra + 1. */
void br_pieces_integrate(const struct br_pieces *pieces, size_t extra, double *c);

/* ---- quadrature ---- */

struct br_quadrature {
    const struct br_pieces *pieces; /* borrowed */
    size_t extra;                   /* of the series */
    size_t *points;                 /* elements: of its rule */
    size_t count;                   /* all points */
    double *x;                      /* count, m: inside of the elements, never at their ends */
    double *weight;                 /* count: of the rule on [0, 1] */
    double **table;                 /* elements: points x (terms + extra), p_k at the points */
    double *value;                  /* count, workspace */
};

/* After a failure, which the store keeps, the quadrature is of no use. */
void br_quadrature_init(struct br_quadrature *q, const struct br_pieces *pieces, size_t extra,
                        struct br_store *store);

/* c (out, with extra): coefficients of the function f(x, t)'s projection: its integrals over x / L
 * against the polynomials. Elements that hold some of `fronts`, places in m where f jumps or bends
 * at t (NULL: none), are cut there. Fails with BR_NO_MEMORY. */
enum br_status br_quadrature_project(const struct br_quadrature *q, const struct br_function *f,
                                     double t, const struct br_breaks *fronts, double *c,
                                     struct br_error *err);

/* c (out, extra 0): the same of the derivative in x / L of a continuous f(x, 0). */
enum br_status br_quadrature_project_slope(const struct br_quadrature *q,
                                           const struct br_function *f, double *c,
                                           struct br_error *err);

/* ---- the L2 projection of a series on polynomials on equal elements (projection.c) ---- */

struct br_piecewise;

/* *out (owned by the store). Series have `extra` more terms. Fails with BR_NO_MEMORY or
 * BR_SINGULAR. */
enum br_status br_piecewise_create(struct br_piecewise **out, const struct br_pieces *pieces,
                                   size_t extra, const struct br_exact_mesh *mesh,
                                   struct br_store *store, struct br_error *err);

/* c and rest as br_exact_projection_apply has them. For one thread at a time. */
void br_piecewise_apply(struct br_piecewise *piecewise, const double *series, double *c,
                        double *rest);

#endif
