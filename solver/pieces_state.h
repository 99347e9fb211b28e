/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What pieces.c marches, pieces_layout.c lays out, pieces_tables.c tabulates
 * and pieces_load.c loads; for these alone. The mathematics is in pieces.h. */
#ifndef BR_SOLVER_PIECES_STATE_H
#define BR_SOLVER_PIECES_STATE_H

#include "solver/lq.h"
#include "solver/pieces.h"
#include "solver/states.h"
#include "solver/sweep_kernel.h"

/* Spans side by side, and what a step hands them. */
struct br_strand {
    struct br_strip strip;
    size_t first; /* element */
    struct br_strip_ends ends;
    double *q, *z, *force_right, *force_left; /* d * BR_LANES each */
};

enum { BR_MOST_STRANDS = 2 };

struct br_pieces {
    struct br_field field;
    const struct br_kernel *kernel;
    int d;
    double k, r;                              /* s; R, see lq.h */
    struct br_strand strand[BR_MOST_STRANDS]; /* from the clamped end: the odd rest, and the equal
                                                 spans; what the cut has of them */
    int strands;
    double *arena; /* all arrays but the loads */
    double *loads; /* of the strips, where they differ from node to node; NULL so far */
    struct br_strip_drive drive;
    double tip_load[BR_LQ_MOST]; /* of the last node over R, for a factor of 1 */
    double tip_increment[BR_LQ_MOST], force_increment[BR_LQ_MOST];
    double tip_velocity, tip_displacement, compliance;
    bool stale_load;         /* loads are those of another step */
    bool stale_ends;         /* the ends' q and z are those of another step or state */
    struct br_states states; /* see pieces_kept.c; the strips have the first */
    bool advanced;           /* the strands' ends have the velocities across the spans */
    double tip_bias;         /* mean of what the joins' increment lacks of the field's, m/s */
};

/* Elements of a span. */
static inline size_t br_span_length(const struct br_strand *t)
{
    return t->strip.pieces * t->strip.length;
}

/* Cuts the beam and allocates all arrays. Fails with BR_NO_MEMORY. */
enum br_status br_pieces_lay_out(struct br_pieces *s, struct br_error *err);

/* Fills all tables and joins. Fails with BR_SINGULAR or BR_NO_MEMORY. */
enum br_status br_pieces_tables(struct br_pieces *s, struct br_error *err);

/* Another load vector, N; NULL: none. Fails with BR_NO_MEMORY. */
enum br_status br_pieces_set_load(struct br_pieces *s, const double *vector, struct br_error *err);

/* What schemes of several stages need; see linear_solver.h. */
enum br_status br_pieces_set_step(void *self, double k, struct br_error *err);
enum br_status br_pieces_keep(void *self, size_t count, struct br_error *err);
void br_pieces_exchange(void *self, size_t a, size_t b);
void br_pieces_combine(void *self, size_t into, size_t count, const double *weight);
void br_pieces_size(void *self, size_t state, double size[2]);

/* The strips' states are in the first of the states. */
void br_pieces_point_at_first(struct br_pieces *s);

/* Tables for the field's step, and what a unit force at the tip does with them. Fails as
 * br_pieces_tables. */
enum br_status br_pieces_prepare(struct br_pieces *s, struct br_error *err);

/* State from and to nodal values; see linear_solver.h. */
void br_pieces_set(void *self, const double *displacement, const double *velocity);
void br_pieces_get(const void *self, double *displacement, double *velocity);
void br_pieces_strain_rate(const void *self, double *rate);

/* The tip's value, given what it is across each span: its right end relative to its left one. */
double br_pieces_at_tip(const struct br_pieces *s, const double *const across[BR_MOST_STRANDS]);

/* The tip's displacement, read off the field, m. */
double br_pieces_tip_displacement(const void *self);

#endif
