/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One element of the exact discrete solution: its matrices and what deforms it; for
 * discrete_field.c and discrete_gain.c alone. */
#ifndef BR_REFERENCE_DISCRETE_ELEMENT_H
#define BR_REFERENCE_DISCRETE_ELEMENT_H

#include "reference/discrete_field.h"

/* Entry (a, b) of the element's mass over rho h; of the beam for (w, h w_x). */
long double br_discrete_mass(size_t d, size_t a, size_t b);

/* right = T left + G q: the node at an element's right end. Rod: u + q. Beam, with the curvature
 * q0 + q1 (2 xi - 1) integrated twice over xi: w + s + q0/2 - q1/6, s + q0. */
static inline void br_discrete_cross(size_t d, const long double *left, const long double *q,
                                     long double *right)
{
    if (d == 1) {
        right[0] = left[0] + q[0];
        return;
    }
    right[0] = left[0] + left[1] + q[0] / 2 - q[1] / 6;
    right[1] = left[1] + q[0];
}

/* D of strain c, which the stiffness multiplies, 1/m or 1/m^3. */
long double br_discrete_rigidity(const struct br_discrete_field *f, size_t c);

/* What stands right of an element (in/out): the value 1/2 y'P y of all that lies there. */
struct br_discrete_value {
    long double p[BR_DISCRETE_MOST][BR_DISCRETE_MOST]; /* N s/m */
};

/* The gains (out) of an element for steps of tau, s, and the value with it. false: the step is not
 * positive definite. */
bool br_discrete_add_element(const struct br_discrete_field *f, long double tau,
                             struct br_discrete_value *value, struct br_discrete_gain *gain);

#endif
