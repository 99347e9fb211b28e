/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The recursions of plain.h on panels of the beam, exactly, and side by side in the lanes of
 * vectors: what panels.c and tables.c share. solver/README.md derives it and gives its cost.
 *
 * The beam is an odd rest at the clamped end and BR_LANES equal segments, one a lane; a segment is
 * a number of equal panels. A step is a pass over the joins (predict), which gives the tip's
 * velocity, and one over the elements (finish), which also sums z and q for the next step. */
#ifndef BR_SOLVER_PANELS_H
#define BR_SOLVER_PANELS_H

#include "solver/linear/linear_solver.h"
#include "solver/linear/states.h"

/* The second curvature of bending is the one of br_curvature over this. */
#define BR_PANELS_ROOT3 1.732050807568877293527446341505872367L

/* Spans side by side, and their end values in a step. */
struct br_segment_group {
    struct br_segments segments;
    size_t first; /* element */
    struct br_segment_ends ends;
    double *q, *z, *force_right, *force_left; /* d * BR_LANES each */
};

enum { BR_MOST_GROUPS = 2 };

struct br_panels {
    struct br_states states; /* the groups use the first one */
    struct br_field field;
    const struct br_loops *loops;
    int d;                                         /* unknowns a node: 1 or 2 */
    double r;                                      /* R, see tables.c */
    struct br_segment_group group[BR_MOST_GROUPS]; /* from the clamped end: the odd rest and the
                                                 equal segments, if the cut has them */
    int groups;
    double *loads; /* of the groups; NULL until a load is not uniform */
    struct br_segment_drive drive;
    double tip_load[2]; /* of the last node over R, for a factor of 1 */
    double tip_increment[2], force_increment[2];
    double *tip; /* of state 0 */
    double compliance;
    bool stale_load; /* loads are those of another step */
    bool stale_ends; /* the ends' q and z are those of another step or state */
    bool advanced;   /* the groups' ends contain the velocities across the segments */
};

/* How a beam is cut: panels of a length in each segment, and the odd rest, in elements. */
struct br_cut {
    size_t panels, length, odd;
};
struct br_cut br_choose_cut(size_t n);

/* The functions of the solver, for linear elements. */
extern const struct br_field_solver br_panels;

/* Fills all tables and joins for the field's step. Fails with BR_SINGULAR or BR_NO_MEMORY. */
enum br_status br_panels_tables(struct br_panels *s, struct br_error *err);

#endif
