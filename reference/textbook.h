/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Time schemes and element matrices as the literature prints them, written down apart from the
 * solver, for all who judge it. */
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

/* The branch of its law that a tip is on: force, N, of the contact or of friction, whose bound is
 * told. */
enum br_regime br_textbook_regime(const struct br_scene *scene, enum br_field_kind kind,
                                  long double force, long double bound);

/* Element matrices. The unknowns are u at the nodes of a rod, from begin to end, and (w, h w_x) at
 * both of a beam. */
extern const int br_rod_mass[2][2];       /* over rho h / 6 */
extern const int br_rod3_mass[3][3];      /* of three nodes, over rho h / 30 */
extern const int br_beam_mass[4][4];      /* over rho h / 420 */
extern const int br_rod_stiffness[2][2];  /* over 1 / h */
extern const int br_rod3_stiffness[3][3]; /* over 1 / (3 h) */
extern const int br_beam_stiffness[4][4]; /* over 1 / h^3 */

#endif
