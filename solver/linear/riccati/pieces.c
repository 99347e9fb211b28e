/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <fenv.h>
#include <math.h>
#include <string.h>

#include "solver/linear/riccati/pieces.h"

/* Round-off of the tip's increment is small beside the velocity that it leads to. */
static const double most_bias = 1e-8;

static void pieces_free(void *self)
{
    struct br_pieces *s = self;
    if (!s)
        return;
    free(s->arena);
    free(s->loads);
    br_states_clear(&s->states);
    free(s);
}

/* The increments and costates at the ends of all spans, for the tip's costate h; the tip's
 * increment goes into y (out). */
static void join(struct br_pieces *s, double *h, double *y)
{
    for (int i = s->strands; i-- > 0;) {
        struct br_strand *t = &s->strand[i];
        s->kernel->join_left(&t->strip, t->q, t->z, h, t->ends.right);
    }
    y[0] = y[1] = 0;
    for (int i = 0; i < s->strands; i++) {
        struct br_strand *t = &s->strand[i];
        s->kernel->join_right(&t->strip, t->z, y, t->ends.left, t->ends.right);
    }
}

/* What a unit force at the tip does. */
static void find_influence(struct br_pieces *s)
{
    double unit[BR_LQ_MOST] = {1 / s->r, 0};
    const size_t bytes = (size_t)s->d * BR_LANES * sizeof(double);
    for (int i = 0; i < s->strands; i++) {
        memset(s->strand[i].q, 0, bytes);
        memset(s->strand[i].z, 0, bytes);
    }
    join(s, unit, s->force_increment);
    s->compliance = -s->force_increment[0];
    for (int i = 0; i < s->strands; i++) {
        memcpy(s->strand[i].force_right, s->strand[i].ends.right, bytes);
        memcpy(s->strand[i].force_left, s->strand[i].ends.left, bytes);
    }
}

/* Tables for the field's step, and what a unit force at the tip does with them. */
static enum br_status prepare(struct br_pieces *s, struct br_error *err)
{
    s->k = s->field.k;
    const enum br_status status = br_pieces_tables(s, err);
    if (!status)
        find_influence(s);
    return status;
}

static enum br_status pieces_create(const struct br_linear_solver *row,
                                    const struct br_field *field,
                                    const struct br_linear_options *options, void **self,
                                    struct br_error *err)
{
    (void)row;
    struct br_pieces *s = br_allocate(1, sizeof *s);
    *self = s;
    if (!s)
        return br_no_memory(err, "a solver");
    s->field = *field;
    s->kernel = options->kernel ? options->kernel : br_kernel_best();
    if (!s->kernel->available())
        return br_fail(err, BR_BAD_INPUT, "kernel %s is not available on this machine",
                       s->kernel->name);
    s->d = field->kind == BR_AXIAL ? 1 : 2;
    const enum br_status status = br_pieces_lay_out(s, err);
    return status ? status : prepare(s, err);
}

static double pieces_compliance(const void *self)
{
    return ((const struct br_pieces *)self)->compliance;
}

static enum br_status pieces_predict(void *self, const struct br_drive *drive, double *velocity,
                                     struct br_error *err)
{
    struct br_pieces *s = self;
    const enum br_status status =
        drive->changed || s->stale_load ? br_pieces_set_load(s, drive->vector, err) : BR_OK;
    if (status)
        return status;
    s->stale_load = false;
    for (int i = 0; i < s->strands && s->stale_ends; i++)
        s->kernel->weigh(&s->strand[i].strip);
    s->stale_ends = false;
    s->drive.factor = drive->factor;
    for (int i = 0; i < s->strands; i++)
        s->kernel->gather(&s->strand[i].strip, drive->factor, s->strand[i].q, s->strand[i].z);
    double costate[BR_LQ_MOST] = {0};
    for (int c = 0; c < s->d; c++)
        costate[c] = -(drive->factor * s->tip_load[c] + drive->tip[c] / s->r);
    join(s, costate, s->tip_increment);
    *velocity = s->tip_velocity + s->tip_increment[0];
    if (!(fabs(s->tip_bias) <= most_bias * fabs(*velocity)))
        s->tip_bias = 0; /* that of a motion which has died away since */
    s->tip_increment[0] += s->tip_bias;
    *velocity += s->tip_bias;
    return BR_OK;
}

/* What a force that resists the tip adds at the ends of the spans. */
static void add_force(struct br_pieces *s, double force)
{
    for (int i = 0; i < s->strands; i++) {
        struct br_strand *t = &s->strand[i];
        for (size_t j = 0; j < (size_t)s->d * BR_LANES; j++) {
            t->ends.right[j] += force * t->force_right[j];
            t->ends.left[j] += force * t->force_left[j];
        }
    }
}

/* Reads the tip off the field: what is only incremented drifts. The round-off of the joins'
 * increment hardly changes from step to step; what it was is taken off the next one, or a tip that
 * sticks would creep by it. */
static void look_at_tip(struct br_pieces *s, double told)
{
    const double *velocity[BR_MOST_STRANDS], *displacement[BR_MOST_STRANDS];
    for (int i = 0; i < s->strands; i++) {
        velocity[i] = s->strand[i].ends.velocity;
        displacement[i] = s->strand[i].ends.displacement;
    }
    s->tip_velocity = br_pieces_at_tip(s, velocity);
    s->tip_bias += s->tip_velocity - told;
    if (s->d == 1)
        s->tip_displacement = br_pieces_at_tip(s, displacement);
}

static double pieces_finish(void *self, double force)
{
    struct br_pieces *s = self;
    add_force(s, force);
    for (int i = 0; i < s->strands; i++)
        s->kernel->advance(&s->strand[i].strip, &s->drive, &s->strand[i].ends);
    s->advanced = true;
    look_at_tip(s, s->tip_velocity + s->tip_increment[0] + force * s->force_increment[0]);
    return s->tip_velocity;
}

static double pieces_tip_displacement(const void *self)
{
    const struct br_pieces *s = self;
    return s->d == 1 ? s->tip_displacement : br_pieces_tip_displacement(s); /* the laws need u */
}

/* ---- more states ---- */

/* Other steps and sums of states, for schemes of several stages. */

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

static enum br_status pieces_set_step(void *self, double k, struct br_error *err)
{
    struct br_pieces *s = self;
    s->field.k = k;
    s->stale_load = s->stale_ends = true;
    return prepare(s, err);
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

static void pieces_exchange(void *self, size_t a, size_t b)
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

/* br_add_states of the odd rest, whose other lanes stay 0. */
static void add_one_lane(double *to, size_t size, size_t count, double *const *from,
                         const double *weight)
{
    for (size_t i = 0; i < size; i += BR_LANES) {
        double sum = 0;
        for (size_t j = 0; j < count; j++)
            sum += weight[j] * from[j][i];
        to[i] = sum;
    }
}

static void pieces_combine(void *self, size_t into, size_t count, const double *weight)
{
    struct br_pieces *s = self;
    double *of[BR_MOST_STATES], by[BR_MOST_STATES], *to = s->states.of[into];
    const size_t picked = pick(s, count, weight, of, by);
    const bool blends = into == 0 && picked > 0;
    put_tip(s);
    for (int i = 0; i < s->strands; i++) {
        const struct br_strip *strip = &s->strand[i].strip;
        const size_t size = strand_size(s, &s->strand[i]);
        if (blends)
            s->kernel->blend(strip, picked, (const double *const *)of, by);
        else
            (strip->lanes == 1 ? add_one_lane : br_add_states)(to, size, picked, of, by);
        to += size;
        for (size_t j = 0; j < picked; j++)
            of[j] += size;
    }
    br_add_states(to, TIP, picked, of, by);
    if (into == 0) {
        s->stale_ends = !blends;
        take_tip(s);
    }
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
static void pieces_size(void *self, size_t state, double size[2])
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

const struct br_field_solver br_pieces = {
    .create = pieces_create,
    .free = pieces_free,
    .tip_compliance = pieces_compliance,
    .set = br_pieces_set,
    .get = br_pieces_get,
    .strain_rate = br_pieces_strain_rate,
    .predict = pieces_predict,
    .finish = pieces_finish,
    .tip_displacement = pieces_tip_displacement,
    .set_step = pieces_set_step,
    .keep = br_pieces_keep,
    .exchange = pieces_exchange,
    .combine = pieces_combine,
    .size = pieces_size,
};
