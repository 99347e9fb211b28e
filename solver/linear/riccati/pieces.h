/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The recursions of plain.h on pieces of the beam, exactly, and side by side in the lanes of
 * vectors. README.md in this folder derives it and gives its cost.
 *
 * The beam is an odd rest at the clamped end and BR_LANES equal spans, one a lane; a span is a
 * number of equal pieces. Each piece has a recursion of its own that begins with P = 0 at its right
 * end, so all share one small table. With the increment y_l at its left end and the costate c at
 * its right one, a step gives y_r = Phi y_l - Z c + z,      c_l = P y_l + Phi'c + q, where z and q
 * are sums over the piece's elements of tabled weights times the state g: the responses of kappa to
 * unit c and unit y_l. The joins are a recursion of the same kind: with c = C y_r + h from the
 * right, M = (1 + Z C)^-1,    y_r = M (Phi y_l + z - Z h), C_l = P + Phi'C M Phi,    h_l = q +
 * Phi'C M z + (M Phi)'h, first over the pieces of a span, which again begins with C = 0 at its
 * right end, so that all lanes share one table here, too; then over the spans.
 *
 * A step is a pass over the joins (predict), which gives the tip's velocity, and one over the
 * elements (finish), which also sums z and q for the next step. The tip's value is a sum of
 * increments, which drifts; so it is read off the field every few steps. */
#ifndef BR_SOLVER_PIECES_H
#define BR_SOLVER_PIECES_H

#include "solver/linear/linear_solver.h"
#include "solver/linear/riccati/kernel.h"
#include "solver/linear/riccati/lq.h"
#include "solver/linear/states.h"

/* For both fields. */
extern const struct br_field_solver br_pieces;

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
    struct br_states states; /* the strips have the first */
    bool advanced;           /* the strands' ends have the velocities across the spans */
    double tip_bias;         /* mean of what the joins' increment lacks of the field's, m/s */
};

/* Elements of a span. */
static inline size_t br_span_length(const struct br_strand *t)
{
    return t->strip.pieces * t->strip.length;
}

/* The cost of a solve, see linear_solver.h. */
double br_pieces_cost(const struct br_field *field, double sums);

/* Cuts the beam and allocates all arrays. Fails with BR_NO_MEMORY. */
enum br_status br_pieces_lay_out(struct br_pieces *s, struct br_error *err);

/* Fills all tables and joins. Fails with BR_SINGULAR or BR_NO_MEMORY. */
enum br_status br_pieces_tables(struct br_pieces *s, struct br_error *err);

/* Another load vector, N; NULL: none. Fails with BR_NO_MEMORY. */
enum br_status br_pieces_set_load(struct br_pieces *s, const double *vector, struct br_error *err);

/* Room for more states; see linear_solver.h. */
enum br_status br_pieces_keep(void *self, size_t count, struct br_error *err);

/* The strips' states are in the first of the states. */
void br_pieces_point_at_first(struct br_pieces *s);

/* State from and to nodal values; see linear_solver.h. */
void br_pieces_set(void *self, const double *displacement, const double *velocity);
void br_pieces_get(const void *self, double *displacement, double *velocity);
void br_pieces_strain_rate(const void *self, double *rate);

/* The tip's value, given what it is across each span: its right end relative to its left one. */
double br_pieces_at_tip(const struct br_pieces *s, const double *const across[BR_MOST_STRANDS]);

/* The tip's displacement, read off the field, m. */
double br_pieces_tip_displacement(const void *self);

#endif
