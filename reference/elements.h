/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Element matrices as textbooks print them, for all who judge and apart from the solver's. The
 * unknowns are u at the nodes of a rod, from begin to end, and (w, h w_x) at both of a beam. */
#ifndef BR_REFERENCE_ELEMENTS_H
#define BR_REFERENCE_ELEMENTS_H

extern const int br_rod_mass[2][2];       /* over rho h / 6 */
extern const int br_rod3_mass[3][3];      /* of three nodes, over rho h / 30 */
extern const int br_beam_mass[4][4];      /* over rho h / 420 */
extern const int br_rod_stiffness[2][2];  /* over 1 / h */
extern const int br_rod3_stiffness[3][3]; /* over 1 / (3 h) */
extern const int br_beam_stiffness[4][4]; /* over 1 / h^3 */

#endif
