/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The recursion over the pieces, once a step; see pieces.c. */
#include <string.h>

#include "solver/pieces_state.h"

#define INLINE static inline __attribute__((always_inline)) /* d is then a constant */

INLINE void add_times(int d, const double a[BR_LQ_MOST][BR_LQ_MOST], const double *x, double *sum)
{
    for (int i = 0; i < d; i++)
        for (int j = 0; j < d; j++)
            sum[i] += a[i][j] * x[j];
}

INLINE void add_transposed_times(int d, const double a[BR_LQ_MOST][BR_LQ_MOST], const double *x,
                                 double *sum)
{
    for (int i = 0; i < d; i++)
        for (int j = 0; j < d; j++)
            sum[i] += a[j][i] * x[j];
}

/* z or q of a piece, its load included: *value = state's + factor * load's */
INLINE void read_end(int d, const struct br_pieces *s, const double *end, int state, int load,
                     double *value)
{
    for (int c = 0; c < d; c++)
        value[c] = end[(state * d + c) * BR_LANES] + s->factor * end[(load * d + c) * BR_LANES];
}

/* h from the tip to the clamped end; what each piece has at its right end stays in BR_END_RIGHT. */
INLINE void join_left(int d, const struct br_pieces *s, bool influence, double *h)
{
    const int right = influence ? BR_END_FORCE_RIGHT : BR_END_RIGHT;
    const struct br_join *join = s->join + s->pieces;
    for (size_t i = s->groups; i-- > 0;)
        for (size_t lane = s->group[i].lanes; lane-- > 0;) {
            double *end = s->group[i].end + lane;
            double next[BR_LQ_MOST] = {0}, z[BR_LQ_MOST] = {0};
            join--;
            if (!influence) {
                read_end(d, s, end, BR_END_Z, BR_END_LOAD_Z, z);
                read_end(d, s, end, BR_END_Q, BR_END_LOAD_Q, next);
            }
            add_times(d, join->transfer, z, next);
            add_transposed_times(d, join->pass, h, next);
            for (int c = 0; c < d; c++) {
                end[(right * d + c) * BR_LANES] = h[c];
                h[c] = next[c];
            }
        }
}

/* The increments from the clamped end to the tip, and the costates. */
INLINE void join_right(int d, const struct br_pieces *s, bool influence, double *y)
{
    const int right = influence ? BR_END_FORCE_RIGHT : BR_END_RIGHT,
              left = influence ? BR_END_FORCE_LEFT : BR_END_LEFT;
    const struct br_join *join = s->join;
    for (size_t i = 0; i < s->groups; i++)
        for (size_t lane = 0; lane < s->group[i].lanes; lane++, join++) {
            double *end = s->group[i].end + lane;
            double next[BR_LQ_MOST] = {0}, z[BR_LQ_MOST] = {0}, h[BR_LQ_MOST];
            if (!influence)
                read_end(d, s, end, BR_END_Z, BR_END_LOAD_Z, z);
            for (int c = 0; c < d; c++) {
                h[c] = -end[(right * d + c) * BR_LANES];
                end[(left * d + c) * BR_LANES] = y[c];
            }
            add_times(d, join->gain, z, next);
            add_times(d, join->yield, h, next);
            add_times(d, join->pass, y, next);
            double costate[BR_LQ_MOST] = {0};
            add_times(d, join->costate, next, costate);
            for (int c = 0; c < d; c++) {
                y[c] = next[c];
                end[(right * d + c) * BR_LANES] = costate[c] - h[c];
            }
        }
}

void br_pieces_join(const struct br_pieces *s, bool influence, const double *tip_costate,
                    double *tip)
{
    double h[BR_LQ_MOST], y[BR_LQ_MOST] = {0};
    memcpy(h, tip_costate, sizeof h);
    if (s->d == 1) {
        join_left(1, s, influence, h);
        join_right(1, s, influence, y);
    } else {
        join_left(2, s, influence, h);
        join_right(2, s, influence, y);
    }
    memcpy(tip, y, sizeof y);
}
