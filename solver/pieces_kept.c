/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Other steps and sums of states, for schemes of several stages; see pieces.h. */
#include <fenv.h>
#include <math.h>

#include "solver/pieces_state.h"

/* Numbers of a strand's state in all lanes. */
static size_t strand_size(const struct br_pieces *s, const struct br_strand *t)
{
    return br_span_length(t) * 2 * (size_t)s->d * BR_LANES;
}

static size_t all_strands(const struct br_pieces *s)
{
    size_t size = 0;
    for (int i = 0; i < s->strands; i++)
        size += strand_size(s, &s->strand[i]);
    return size;
}

void br_pieces_point_at_first(struct br_pieces *s)
{
    double *at = s->states.of[0];
    for (int i = 0; i < s->strands; i++) {
        s->strand[i].strip.state = at;
        at += strand_size(s, &s->strand[i]);
    }
}

enum { TIP = 3 }; /* numbers of the tip, which are kept behind those of the strands */

enum br_status br_pieces_keep(void *self, size_t count, struct br_error *err)
{
    struct br_pieces *s = self;
    return br_states_add(&s->states, all_strands(s) + TIP, count, err);
}

enum br_status br_pieces_set_step(void *self, double k, struct br_error *err)
{
    struct br_pieces *s = self;
    s->field.k = k;
    s->stale_load = s->stale_ends = true;
    return br_pieces_prepare(s, err);
}

static void put_tip(struct br_pieces *s)
{
    double *tip = s->states.of[0] + all_strands(s);
    tip[0] = s->tip_velocity;
    tip[1] = s->tip_displacement;
    tip[2] = s->tip_bias;
}

static void take_tip(struct br_pieces *s)
{
    const double *tip = s->states.of[0] + all_strands(s);
    s->tip_velocity = tip[0];
    s->tip_displacement = tip[1];
    s->tip_bias = tip[2];
    s->advanced = false;
}

void br_pieces_exchange(void *self, size_t a, size_t b)
{
    struct br_pieces *s = self;
    put_tip(s);
    br_states_exchange(&s->states, a, b);
    br_pieces_point_at_first(s);
    take_tip(s);
    s->stale_ends = true;
}

/* Those that have a weight, first; returns how many. */
static size_t pick(const struct br_pieces *s, size_t count, const double *weight,
                   double *of[BR_MOST_STATES], double by[BR_MOST_STATES])
{
    size_t picked = 0;
    for (size_t j = 0; j < count; j++)
        if (weight[j] != 0) {
            of[picked] = s->states.of[j];
            by[picked++] = weight[j];
        }
    return picked;
}

void br_pieces_combine(void *self, size_t into, size_t count, const double *weight)
{
    struct br_pieces *s = self;
    double *of[BR_MOST_STATES], by[BR_MOST_STATES], *to = s->states.of[into];
    const size_t picked = pick(s, count, weight, of, by), tip = all_strands(s);
    put_tip(s);
    if (into != 0 || picked == 0) {
        br_add_states(to, s->states.size, picked, of, by);
        s->stale_ends |= into == 0;
    } else {
        const double *from[BR_MOST_STATES];
        size_t at = 0;
        for (int i = 0; i < s->strands; i++) {
            for (size_t j = 0; j < picked; j++)
                from[j] = of[j] + at;
            s->kernel->blend(&s->strand[i].strip, picked, from, by);
            at += strand_size(s, &s->strand[i]);
        }
        double *tips[BR_MOST_STATES];
        for (size_t j = 0; j < picked; j++)
            tips[j] = of[j] + tip;
        br_add_states(to + tip, TIP, picked, tips, by);
        s->stale_ends = false;
    }
    if (into == 0)
        take_tip(s);
}

/* The same of numbers whose squares are no doubles. */
static void add_squares(const struct br_strip *strip, size_t numbers, const double *state,
                        long double sum[2])
{
    for (size_t i = 0; i < numbers; i++)
        if (i % BR_LANES < strip->lanes) {
            const size_t rate = i / ((size_t)strip->d * BR_LANES) % 2;
            sum[rate] += (long double)state[i] * state[i];
        }
}

/* What overflows here is summed again, and no reason to stop. */
static void sum_squares(const struct br_pieces *s, size_t state, double sum[2])
{
    const double *at = s->states.of[state];
    fenv_t environment;
    feholdexcept(&environment);
    sum[0] = sum[1] = 0;
    for (int i = 0; i < s->strands; i++) {
        s->kernel->square(&s->strand[i].strip, at, sum);
        at += strand_size(s, &s->strand[i]);
    }
    fesetenv(&environment);
}

/* The square of u_x over an element is kappa^2 / h, of w_xx in the units of lq.h (kappa_0^2 +
 * kappa_1^2) / h^3. */
void br_pieces_size(void *self, size_t state, double size[2])
{
    const struct br_pieces *s = self;
    const double least = 1e-280, most = 1e280; /* of squares that have lost nothing */
    double sum[2];
    long double wide[2] = {0};
    sum_squares(s, state, sum);
    const double *at = s->states.of[state];
    const bool told = isgreater(fmin(sum[0], sum[1]), least) && isless(fmax(sum[0], sum[1]), most);
    for (int i = 0; i < s->strands && !told; i++) {
        const size_t numbers = strand_size(s, &s->strand[i]);
        add_squares(&s->strand[i].strip, numbers, at, wide);
        at += numbers;
    }
    const long double h = s->field.h, unit = s->d == 1 ? h : h * h * h;
    for (int rate = 0; rate < 2; rate++)
        size[rate] = (double)sqrtl((told ? sum[rate] : wide[rate]) / unit);
}
