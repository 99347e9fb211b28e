/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Other steps and sums of states, for schemes of several stages; see pieces.h. */
#include <math.h>

#include "solver/pieces_state.h"

/* Numbers of a piece's state in all lanes, and of a strand's. */
static size_t piece_size(const struct br_pieces *s, const struct br_strand *t)
{
    return t->strip.length * 2 * (size_t)s->d * BR_LANES;
}

static size_t strand_size(const struct br_pieces *s, const struct br_strand *t)
{
    return t->strip.pieces * piece_size(s, t);
}

static size_t all_strands(const struct br_pieces *s)
{
    size_t size = 0;
    for (int i = 0; i < s->strands; i++)
        size += strand_size(s, &s->strand[i]);
    return size;
}

/* z and q of all pieces, whose state or whose tables are new. */
static void weigh_all(struct br_pieces *s)
{
    for (int i = 0; i < s->strands; i++)
        for (size_t j = 0; j < s->strand[i].strip.pieces; j++)
            s->kernel->weigh(&s->strand[i].strip, j);
}

enum br_status br_pieces_set_step(void *self, double k, struct br_error *err)
{
    struct br_pieces *s = self;
    s->field.k = k;
    const enum br_status status = br_pieces_prepare(s, err);
    weigh_all(s);
    s->stale_load = true;
    return status;
}

enum br_status br_pieces_keep(void *self, size_t count, struct br_error *err)
{
    struct br_pieces *s = self;
    for (size_t i = 0; i < count; i++) {
        double *fresh = br_allocate_aligned(all_strands(s) + 2, sizeof *fresh);
        if (!fresh)
            return br_no_memory(err, "the states of a time scheme");
        s->kept[s->states++] = fresh;
    }
    return BR_OK;
}

/* Piece by piece: what it adds to its ends is found while its state is in the nearest cache. */
static void combine_strand(struct br_pieces *s, int strand, double *const *of, size_t count,
                           const double *weight, double *into)
{
    const struct br_strand *t = &s->strand[strand];
    const size_t size = piece_size(s, t);
    for (size_t j = 0; j < t->strip.pieces; j++) {
        double *from[BR_MOST_STATES];
        for (size_t i = 0; i < count; i++)
            from[i] = of[i] ? of[i] + j * size : NULL;
        br_add_states(into + j * size, size, count, from, weight);
        if (into == t->strip.state)
            s->kernel->weigh(&t->strip, j);
    }
}

/* The tip's motion in a state. */
static void combine_tip(struct br_pieces *s, size_t into, size_t count, const double *weight)
{
    const size_t at = all_strands(s);
    double own[2] = {s->tip_velocity, s->tip_displacement}, sum[2], *from[BR_MOST_STATES];
    for (size_t i = 0; i < count; i++)
        from[i] = i == 0 ? own : s->kept[i] + at;
    br_add_states(sum, 2, count, from, weight);
    double *velocity = into == 0 ? &s->tip_velocity : s->kept[into] + at;
    double *displacement = into == 0 ? &s->tip_displacement : s->kept[into] + at + 1;
    *velocity = sum[0];
    *displacement = sum[1];
}

void br_pieces_combine(void *self, size_t into, size_t count, const double *weight)
{
    struct br_pieces *s = self;
    size_t at = 0;
    for (int i = 0; i < s->strands; i++) {
        double *of[BR_MOST_STATES] = {s->strand[i].strip.state};
        for (size_t j = 1; j < count; j++)
            of[j] = s->kept[j] + at;
        combine_strand(s, i, of, count, weight,
                       into == 0 ? s->strand[i].strip.state : s->kept[into] + at);
        at += strand_size(s, &s->strand[i]);
    }
    combine_tip(s, into, count, weight);
    if (into == 0)
        s->advanced = false;
}

/* Sums of squares of a strand's curvatures and their rates, in the lanes that are in use. */
static void add_squares(const struct br_pieces *s, const struct br_strand *t, const double *state,
                        double sum[2])
{
    const size_t d = (size_t)s->d;
    for (size_t row = 0; row < br_span_length(t) * 2 * d; row++)
        sum[row / d % 2] += br_sum_of_squares(state + row * BR_LANES, t->strip.lanes);
}

/* The square of u_x over an element is kappa^2 / h, of w_xx in the units of lq.h (kappa_0^2 +
 * kappa_1^2) / h^3. */
void br_pieces_size(void *self, size_t state, double size[2])
{
    const struct br_pieces *s = self;
    double sum[2] = {0};
    size_t at = 0;
    for (int i = 0; i < s->strands; i++) {
        const struct br_strand *t = &s->strand[i];
        add_squares(s, t, state == 0 ? t->strip.state : s->kept[state] + at, sum);
        at += strand_size(s, t);
    }
    const double h = s->field.h, unit = s->d == 1 ? h : h * h * h;
    for (int rate = 0; rate < 2; rate++)
        size[rate] = sqrt(sum[rate] / unit);
}
