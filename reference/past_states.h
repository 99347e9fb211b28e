/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a witness has seen, and where the literature lets a stage start from it. */
#ifndef BR_REFERENCE_PAST_STATES_H
#define BR_REFERENCE_PAST_STATES_H

#include "reference/textbook.h"

enum { BR_MOST_BACK = 3 };

/* Y = (displacement, velocity), and the rate of change of the velocity; br_past_states' size values
 * each, m, m/s, m/s^2. */
struct br_nodal {
    double *displacement, *velocity, *acceleration;
};

/* Of one field. The arrays are borrowed. */
struct br_past_states {
    size_t size;
    struct br_nodal past[BR_MOST_BACK];    /* Y_{n-1}, Y_{n-2}, Y_{n-3} */
    struct br_nodal row[BR_TEXTBOOK_ROWS]; /* of the textbook, in this step */
    struct br_nodal start;                 /* Z; without acceleration */
};

/* Fills Z of a row of a step of length k, s; returns tau, s. */
long double br_start_of_row(struct br_past_states *states, const struct br_textbook *textbook,
                            int row, long double k);

/* The axial tip over one step, for the bound of friction. */
struct br_tip_path {
    int count;
    double time[BR_TEXTBOOK_ROWS], u[BR_TEXTBOOK_ROWS]; /* of its stages, s and m */
    double from, k;                                     /* s */
    double u_from, v_from, u_to, v_to;                  /* at both ends, m and m/s */
};

/* u(L), m, at the time of a stage, s; where the axial field had none then, by the cubic that the
 * ends of its step determine. */
double br_tip_path_at(const struct br_tip_path *path, double time);

#endif
