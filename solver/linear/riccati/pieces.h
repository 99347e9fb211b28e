/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The recursions of plain.h on pieces of the beam, exactly, and side by side in the lanes of
 * vectors: what pieces.c and tables.c share. solver/README.md derives it and gives its cost.
 *
 * The beam is an odd rest at the clamped end and BR_LANES equal spans, one a lane; a span is a
 * number of equal pieces. A step is a pass over the joins (predict), which gives the tip's
 * velocity, and one over the elements (finish), which also sums z and q for the next step. */
#ifndef BR_SOLVER_PIECES_H
#define BR_SOLVER_PIECES_H

#include "solver/linear/linear_solver.h"
#include "solver/linear/states.h"

/* The second curvature of bending is the one of br_curvature over this. */
#define BR_PIECES_ROOT3 1.732050807568877293527446341505872367L

/* Spans side by side, and their end values in a step. */
struct br_strand {
    struct br_strip strip;
    size_t first; /* element */
    struct br_strip_ends ends;
    double *q, *z, *force_right, *force_left; /* d * BR_LANES each */
};

enum { BR_MOST_STRANDS = 2 };

struct br_pieces {
    struct br_states states; /* the strips use the first one */
    struct br_field field;
    const struct br_loops *loops;
    int d;                                    /* unknowns a node: 1 or 2 */
    double r;                                 /* R, see tables.c */
    struct br_strand strand[BR_MOST_STRANDS]; /* from the clamped end: the odd rest and the equal
                                                 spans, if the cut has them */
    int strands;
    double *loads; /* of the strips; NULL until a load is not uniform */
    struct br_strip_drive drive;
    double tip_load[2]; /* of the last node over R, for a factor of 1 */
    double tip_increment[2], force_increment[2];
    double *tip; /* of state 0 */
    double compliance;
    bool stale_load; /* loads are those of another step */
    bool stale_ends; /* the ends' q and z are those of another step or state */
    bool advanced;   /* the strands' ends contain the velocities across the spans */
};

/* How a beam is cut: pieces of a length in each span, and the odd rest, in elements. */
struct br_cut {
    size_t pieces, length, odd;
};
struct br_cut br_choose_cut(size_t n);

/* The functions of the solver, for linear elements. */
extern const struct br_field_solver br_pieces;

/* Fills all tables and joins for the field's step. Fails with BR_SINGULAR or BR_NO_MEMORY. */
enum br_status br_pieces_tables(struct br_pieces *s, struct br_error *err);

#endif
