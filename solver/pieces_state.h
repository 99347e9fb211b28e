/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What pieces.c marches, pieces_tables.c tabulates, pieces_joins.c joins and pieces_load.c
 * loads; for these alone. The mathematics is in pieces.c. */
#ifndef BR_PIECES_STATE_H
#define BR_PIECES_STATE_H

#include "solver/lq.h"
#include "solver/pieces.h"
#include "solver/sweep_kernel.h"

/* One join, by rows, d by d. */
struct br_join {
    double pass[BR_LQ_MOST][BR_LQ_MOST];     /* M Phi */
    double gain[BR_LQ_MOST][BR_LQ_MOST];     /* M */
    double yield[BR_LQ_MOST][BR_LQ_MOST];    /* M Z */
    double costate[BR_LQ_MOST][BR_LQ_MOST];  /* C */
    double transfer[BR_LQ_MOST][BR_LQ_MOST]; /* Phi'C M */
};

/* BR_LANES pieces of one length. */
struct br_group {
    size_t first, lanes; /* its pieces */
    size_t length;
    struct br_sweep_table table;
    double *state; /* length * 2 d * BR_LANES */
    double *load;  /* lanewise sigma, length * d * BR_LANES */
    double *end;   /* d * BR_LANES each of: right, left, q, z, load's q, load's z, then the
                      influence of a unit force on right and left, and the velocity and the
                      displacement across the pieces */
};
enum {
    BR_END_RIGHT,
    BR_END_LEFT,
    BR_END_Q,
    BR_END_Z,
    BR_END_LOAD_Q,
    BR_END_LOAD_Z,
    BR_END_FORCE_RIGHT,
    BR_END_FORCE_LEFT,
    BR_END_VELOCITY,
    BR_END_DISPLACEMENT,
    BR_ENDS
};

struct br_pieces {
    struct br_field field;
    const struct br_kernel *kernel;
    int d;
    double k, alpha, r[BR_LQ_MOST];
    size_t pieces, groups;
    size_t length, odd, longest; /* elements: of a piece, of the first one if that is another, and
                                    of the longer of the two */
    struct br_group *group;
    struct br_join *join;               /* pieces */
    double *gain, *weight, *odd_weight; /* tables */
    double *shared_load;                /* sigma, where it is the same in all pieces; length * d */
    double *scratch, *arena;
    bool loaded, lanewise;
    double factor, tip_load[BR_LQ_MOST]; /* of the last node, for a factor of 1 */
    double tip_increment[BR_LQ_MOST], force_increment[BR_LQ_MOST];
    double tip_velocity, compliance;
};

/* One value of a piece: BR_END_..., component c. */
static inline double *br_piece_end(const struct br_pieces *s, size_t piece, int which, int c)
{
    const size_t odd = s->odd > 0;
    const size_t i = odd && piece == 0 ? 0 : odd + (piece - odd) / BR_LANES;
    const struct br_group *g = &s->group[i];
    return &g->end[((size_t)(which * s->d + c)) * BR_LANES + (piece - g->first)];
}

/* The node at the right end of a piece. */
static inline size_t br_piece_right_node(const struct br_pieces *s, size_t piece)
{
    return s->odd ? s->odd + piece * s->length : (piece + 1) * s->length;
}

/* Fills all tables and joins. Fails with BR_SINGULAR or BR_NO_MEMORY. */
enum br_status br_pieces_tables(struct br_pieces *s, struct br_error *err);

/* Solves for the ends of all pieces, given z and q (influence: zeros) and the tip's costate; the
 * tip's increment goes into tip. */
void br_pieces_join(const struct br_pieces *s, bool influence, const double *tip_costate,
                    double *tip);

/* Another load vector, N; NULL: none. */
void br_pieces_set_load(struct br_pieces *s, const double *vector);

#endif
