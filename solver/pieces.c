/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solver/pieces.h"

#include <string.h>

#include "solver/pieces_state.h"

/* Steps after which the tip is read off the field: seldom enough to cost nothing, often enough that
 * round-off of its increments stays that of a few. */
static const size_t look_every = 16;

static void pieces_free(void *self)
{
    struct br_pieces *s = self;
    if (!s)
        return;
    free(s->arena);
    free(s->loads);
    free(s);
}

/* The increments and costates at the ends of all spans, for the tip's costate h; the tip's
 * increment goes into y (out). */
static void join(struct br_pieces *s, double *h, double *y)
{
    for (int i = BR_STRANDS; i-- > 0;) {
        struct br_strand *t = &s->strand[i];
        s->kernel->join_left(&t->strip, t->q, t->z, h, t->right);
    }
    y[0] = y[1] = 0;
    for (int i = 0; i < BR_STRANDS; i++) {
        struct br_strand *t = &s->strand[i];
        s->kernel->join_right(&t->strip, t->z, y, t->left, t->right);
    }
}

/* What a unit force at the tip does, while q and z are zero. */
static void find_influence(struct br_pieces *s)
{
    double unit[BR_LQ_MOST] = {1 / s->r, 0};
    join(s, unit, s->force_increment);
    s->compliance = -s->force_increment[0];
    const size_t bytes = (size_t)s->d * BR_LANES * sizeof(double);
    for (int i = 0; i < BR_STRANDS; i++) {
        memcpy(s->strand[i].force_right, s->strand[i].right, bytes);
        memcpy(s->strand[i].force_left, s->strand[i].left, bytes);
    }
}

static enum br_status pieces_create(const struct br_field *field,
                                    const struct br_linear_options *options, void **self,
                                    struct br_error *err)
{
    (void)options;
    struct br_pieces *s = br_allocate(1, sizeof *s);
    *self = s;
    if (!s)
        return br_no_memory(err, "a solver");
    s->field = *field;
    s->kernel = br_kernel_best();
    s->d = field->kind == BR_AXIAL ? 1 : 2;
    s->k = field->k;
    enum br_status status = br_pieces_lay_out(s, err);
    if (!status)
        status = br_pieces_tables(s, err);
    if (status)
        return status;
    find_influence(s);
    return BR_OK;
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
        drive->changed ? br_pieces_set_load(s, drive->vector, err) : BR_OK;
    if (status)
        return status;
    s->drive.factor = drive->factor;
    for (int i = 0; i < BR_STRANDS; i++)
        if (s->strand[i].strip.lanes)
            s->kernel->gather(&s->strand[i].strip, drive->factor, s->strand[i].q, s->strand[i].z);
    double costate[BR_LQ_MOST] = {0};
    for (int c = 0; c < s->d; c++)
        costate[c] = -(drive->factor * s->tip_load[c] + drive->tip[c] / s->r);
    join(s, costate, s->tip_increment);
    s->tip_increment[0] += s->tip_bias;
    *velocity = s->tip_velocity + s->tip_increment[0];
    return BR_OK;
}

/* What a force that resists the tip adds at the ends of the spans. */
static void add_force(struct br_pieces *s, double force)
{
    for (int i = 0; i < BR_STRANDS; i++) {
        struct br_strand *t = &s->strand[i];
        for (size_t j = 0; t->strip.lanes && j < (size_t)s->d * BR_LANES; j++) {
            t->right[j] += force * t->force_right[j];
            t->left[j] += force * t->force_left[j];
        }
    }
}

/* Reads the tip off the field. The round-off of an increment hardly changes from step to step: what
 * it was on average since the last look is taken off the next ones, or a tip that sticks would
 * creep by it. */
static void look(struct br_pieces *s)
{
    double velocity;
    br_pieces_read_tip(s, &s->tip_displacement, &velocity);
    s->tip_bias += (velocity - s->tip_velocity) / (double)look_every;
    s->tip_velocity = velocity;
}

static double pieces_finish(void *self, double force)
{
    struct br_pieces *s = self;
    add_force(s, force);
    for (int i = 0; i < BR_STRANDS; i++)
        if (s->strand[i].strip.lanes)
            s->kernel->advance(&s->strand[i].strip, &s->drive, s->strand[i].right,
                               s->strand[i].left);
    s->tip_velocity += s->tip_increment[0] + force * s->force_increment[0];
    s->tip_displacement += s->k * s->tip_velocity;
    if (++s->steps % look_every == 0)
        look(s);
    return s->tip_velocity;
}

static double pieces_tip_displacement(const void *self)
{
    return ((const struct br_pieces *)self)->tip_displacement;
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
};
