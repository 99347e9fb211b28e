/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a load adds to the recursions of the pieces; see pieces.c. */
#include <string.h>

#include "solver/pieces_state.h"

/* sigma and what it adds to q and z, of one piece; node: the load at the left node of element e,
 * counted from the right, is node[-(e + 1) * d] ... of its right end. Strides in doubles. */
static void load_piece(const struct br_pieces *s, size_t length, const double *right_node,
                       double *sigma, size_t stride, double *q, double *z)
{
    const int d = s->d;
    const double g[2][2] = {{d == 1 ? 1 : 0.5, -1.0 / 6}, {1, 0}};
    double p[BR_LQ_MOST] = {0}, y[BR_LQ_MOST] = {0};
    for (size_t e = 0; e < length; e++) {
        const double *gain = s->gain + e * (size_t)(4 * d * d);
        const double *node = right_node - (e + 1) * (size_t)d;
        double next[BR_LQ_MOST];
        for (int i = 0; i < d; i++) {
            double sum = 0;
            for (int j = 0; j < d; j++)
                sum += g[j][i] * p[j];
            sigma[(e * (size_t)d + (size_t)i) * stride] = sum;
            next[i] = -node[i];
            for (int j = 0; j < d; j++)
                next[i] += gain[i * d + j] * p[j];
        }
        memcpy(p, next, sizeof p);
    }
    memcpy(q, p, (size_t)d * sizeof *q);
    for (size_t e = length; e-- > 0;) {
        const double *gain = s->gain + e * (size_t)(4 * d * d) + 2 * d * d;
        double kappa[BR_LQ_MOST] = {0};
        for (int i = 0; i < d; i++)
            for (int j = 0; j < d; j++)
                kappa[i] += gain[i * d + j] * sigma[(e * (size_t)d + (size_t)j) * stride] +
                            gain[d * d + i * d + j] * y[j];
        y[0] += d == 1 ? kappa[0] : y[1] + (g[0][0] * kappa[0] + g[0][1] * kappa[1]);
        if (d == 2)
            y[1] += kappa[0];
    }
    memcpy(z, y, (size_t)d * sizeof *z);
}

/* Whether all nodes but the clamped and the last one have one load. */
static bool is_uniform(const struct br_pieces *s, const double *vector)
{
    const size_t d = (size_t)s->d;
    for (size_t i = 2; i < s->field.n; i++)
        if (memcmp(vector + i * d, vector + d, d * sizeof *vector) != 0)
            return false;
    return true;
}

void br_pieces_set_load(struct br_pieces *s, const double *vector)
{
    const size_t d = (size_t)s->d;
    s->loaded = vector != NULL;
    s->lanewise = vector && !is_uniform(s, vector);
    memset(s->tip_load, 0, sizeof s->tip_load);
    if (vector)
        memcpy(s->tip_load, vector + s->field.n * d, d * sizeof *vector);
    for (size_t i = 0; i < s->groups; i++)
        for (size_t lane = 0; lane < s->group[i].lanes; lane++) {
            const struct br_group *g = &s->group[i];
            double q[BR_LQ_MOST] = {0}, z[BR_LQ_MOST] = {0};
            if (vector)
                load_piece(s, g->length, vector + br_piece_right_node(s, g->first + lane) * d,
                           s->lanewise
                               ? g->load + lane
                               : s->shared_load, /* that of a shorter piece is its beginning */
                           s->lanewise ? BR_LANES : 1, q, z);
            for (int c = 0; c < s->d; c++) {
                *br_piece_end(s, g->first + lane, BR_END_LOAD_Q, c) = q[c];
                *br_piece_end(s, g->first + lane, BR_END_LOAD_Z, c) = z[c];
            }
        }
}
