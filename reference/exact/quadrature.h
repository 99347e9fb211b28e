/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Integrals of functions of x against the polynomials of elements, by Gauss's rule on each. */
#ifndef BR_REFERENCE_EXACT_QUADRATURE_H
#define BR_REFERENCE_EXACT_QUADRATURE_H

#include "reference/exact/combine.h"
#include "reference/exact/pieces.h"
#include "solver/function.h"

struct br_quadrature {
    const struct br_pieces *pieces; /* borrowed */
    size_t extra;                   /* of the series */
    br_combine *combine;
    size_t *points; /* elements: of its rule */
    size_t count;   /* all points */
    double *x;      /* count, m: inside of the elements, never at their ends */
    double *weight; /* count: of the rule on [0, 1] */
    double **table; /* elements: points x (terms + extra), p_k at the points */
    double *value;  /* count, workspace */
};

/* Clear it even after a failure, which is BR_NO_MEMORY. */
enum br_status br_quadrature_init(struct br_quadrature *q, const struct br_pieces *pieces,
                                  size_t extra, struct br_error *err);
void br_quadrature_clear(struct br_quadrature *q);

/* Places where a function jumps or bends at one time: count of them, ascending, m. */
struct br_places {
    size_t count;
    const double *x;
};

/* c (out, with extra): coefficients of the function f(x, t)'s projection: its integrals over x / L
 * against the polynomials. Elements that hold some of `fronts` are cut there. Fails with
 * BR_NO_MEMORY. */
enum br_status br_quadrature_project(struct br_quadrature *q, const struct br_function *f, double t,
                                     struct br_places fronts, double *c, struct br_error *err);

/* c (out, extra 0): the same of the derivative in x / L of a continuous f(x, 0). */
enum br_status br_quadrature_project_slope(struct br_quadrature *q, const struct br_function *f,
                                           double *c, struct br_error *err);

#endif
