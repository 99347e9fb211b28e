/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Time schemes, laws and element matrices as the literature prints them. Checks of the solver use
 * them; the solver does not. */
#ifndef BR_REFERENCE_TEXTBOOK_H
#define BR_REFERENCE_TEXTBOOK_H

#include "solver/march.h"

enum { BR_TEXTBOOK_ROWS = 6 };

/* One step. Runge-Kutta: Y_i = Y_{n-1} + k sum_j a_ij Y'_j at t_{n-1} + c_i k, the last row being
 * the step's end; where c_0 = 0, row 0 is Y_{n-1} itself. Backward differences, rows = 0:
 * Y_n = sum_j past_j Y_{n-1-j} + beta k Y'_n. */
struct br_textbook {
    int rows;
    long double a[BR_TEXTBOOK_ROWS][BR_TEXTBOOK_ROWS], c[BR_TEXTBOOK_ROWS];
    int back; /* of backward differences: how many steps */
    long double past[3], beta;
};

/* The step of a scheme by its name, `since` steps after t = 0 or after the last switch. NULL: a
 * scheme that is not known here. */
const struct br_textbook *br_textbook_step(const char *scheme, size_t since);

/* The branch of the law at the tip, for the given force, N, of contact or friction, and the given
 * friction bound. */
enum br_regime br_textbook_regime(const struct br_scene *scene, enum br_field_kind kind,
                                  long double force, long double bound);

/* ---- elements ---- */

enum br_element_matrix { BR_MASS, BR_STIFFNESS };

/* An element's matrices in the unknowns of solver/field.h: u at both nodes of a rod, (u, b) of a
 * quadratic one, (w, h w_x) of a beam. */
struct br_element {
    size_t unknowns;       /* of a node */
    int power;             /* of h */
    double entry[2][4][4]; /* by br_element_matrix; entry / over times rho h or a / h^power */
    int over[2];
};

const struct br_element *br_element_of(enum br_field_kind kind, int axial_degree);

/* out (2 * unknowns values) = factor times the entries, not divided by `over`, times nodal values:
 * forces on the element's nodes. */
void br_element_forces(const struct br_element *element, enum br_element_matrix matrix,
                       long double factor, const double *nodal, long double out[4]);

/* a'M b over rho h, or a'K b over a / h^power. */
long double br_element_product(const struct br_element *element, enum br_element_matrix matrix,
                               const double *a, const double *b);

#endif
