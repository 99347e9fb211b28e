/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The recursion over the spans, once a step; see pieces.h. */
#include <string.h>

#include "solver/pieces_state.h"

#define INLINE static inline __attribute__((always_inline)) /* d is then a constant */

INLINE void add_times(int d, const br_matrix a, const double *x, double *sum)
{
    for (int i = 0; i < d; i++)
        for (int j = 0; j < d; j++)
            sum[i] += a[i][j] * x[j];
}

INLINE void add_transposed_times(int d, const br_matrix a, const double *x, double *sum)
{
    for (int i = 0; i < d; i++)
        for (int j = 0; j < d; j++)
            sum[i] += a[j][i] * x[j];
}

INLINE void read_end(int d, const double *end, double *value)
{
    for (int c = 0; c < d; c++)
        value[c] = end[c * BR_LANES];
}

INLINE void write_end(int d, const double *value, double *end)
{
    for (int c = 0; c < d; c++)
        end[c * BR_LANES] = value[c];
}

/* h from the tip to the clamped end; what each span has at its right end stays in `right`. */
INLINE void join_left(int d, struct br_pieces *s, bool influence, double *h)
{
    const struct br_span_join *join = s->join + s->strand[BR_ODD].lanes + s->strand[BR_EVEN].lanes;
    for (int i = BR_STRANDS; i-- > 0;) {
        struct br_strand *t = &s->strand[i];
        double *right = influence ? t->force_right : t->right;
        for (size_t lane = t->lanes; lane-- > 0;) {
            double next[BR_LQ_MOST] = {0}, z[BR_LQ_MOST] = {0};
            join--;
            if (!influence) {
                read_end(d, t->z + lane, z);
                read_end(d, t->q + lane, next);
            }
            add_times(d, join->transfer, z, next);
            add_transposed_times(d, join->pass, h, next);
            write_end(d, h, right + lane);
            memcpy(h, next, sizeof next);
        }
    }
}

/* The increments from the clamped end to the tip, and the costates. */
INLINE void join_right(int d, struct br_pieces *s, bool influence, double *y)
{
    const struct br_span_join *join = s->join;
    for (int i = 0; i < BR_STRANDS; i++) {
        struct br_strand *t = &s->strand[i];
        double *right = influence ? t->force_right : t->right;
        double *left = influence ? t->force_left : t->left;
        for (size_t lane = 0; lane < t->lanes; lane++, join++) {
            double next[BR_LQ_MOST] = {0}, z[BR_LQ_MOST] = {0}, h[BR_LQ_MOST], away[BR_LQ_MOST];
            if (!influence)
                read_end(d, t->z + lane, z);
            read_end(d, right + lane, h);
            write_end(d, y, left + lane);
            for (int c = 0; c < d; c++)
                away[c] = -h[c];
            add_times(d, join->gain, z, next);
            add_times(d, join->yield, away, next);
            add_times(d, join->pass, y, next);
            add_times(d, join->costate, next, h);
            write_end(d, h, right + lane);
            memcpy(y, next, sizeof next);
        }
    }
}

void br_pieces_join(struct br_pieces *s, bool influence, const double *tip_costate, double *tip)
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
