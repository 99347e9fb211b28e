/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/run/step_cost.h"

#include "solver/clock.h"

/* A field solver's state with the one that it wraps. */
struct wrapped {
    const struct br_field_solver *solver;
    enum br_field_kind kind;
    void *state;
};

/* The march that is measured in this thread, and the solver that it is made with. */
static _Thread_local struct br_step_cost *current;
static _Thread_local const struct br_linear_solver *inner;

const char *br_cost_part_text(enum br_cost_part part)
{
    static const char *const texts[] = {
#define X(name, text) [name] = text,
        BR_COST_LIST(X)
#undef X
    };
    return texts[part];
}

void br_step_cost_lap(struct br_step_cost *cost, enum br_cost_part part)
{
    if (!cost)
        return;
    const double now = br_seconds();
    cost->seconds[part] += now - cost->last;
    cost->laps[part]++;
    cost->last = now;
}

/* ---- the wrapping solver ---- */

static enum br_status create(const struct br_linear_solver *row, const struct br_field *field,
                             const struct br_linear_options *options, void **self,
                             struct br_error *err)
{
    (void)row;
    struct wrapped *w = br_allocate(1, sizeof *w);
    *self = w;
    if (!w)
        return br_no_memory(err, "a solver");
    w->kind = field->kind;
    w->solver = br_linear_solver_for(inner, field);
    return w->solver->create(inner, field, options, &w->state, err);
}

static void release(void *self)
{
    struct wrapped *w = self;
    if (!w)
        return;
    w->solver->free(w->state);
    free(w);
}

static double tip_compliance(const void *self)
{
    const struct wrapped *w = self;
    return w->solver->tip_compliance(w->state);
}

static void set(void *self, const double *displacement, const double *velocity)
{
    struct wrapped *w = self;
    w->solver->set(w->state, displacement, velocity);
}

static void get(const void *self, double *displacement, double *velocity)
{
    const struct wrapped *w = self;
    w->solver->get(w->state, displacement, velocity);
}

static void strain_rate(const void *self, double *rate)
{
    const struct wrapped *w = self;
    w->solver->strain_rate(w->state, rate);
}

static double tip_displacement(const void *self)
{
    const struct wrapped *w = self;
    return w->solver->tip_displacement(w->state);
}

static enum br_status set_step(void *self, double k, struct br_error *err)
{
    struct wrapped *w = self;
    return w->solver->set_step(w->state, k, err);
}

static enum br_status keep(void *self, size_t count, struct br_error *err)
{
    struct wrapped *w = self;
    return w->solver->keep(w->state, count, err);
}

static void exchange(void *self, size_t a, size_t b)
{
    struct wrapped *w = self;
    w->solver->exchange(w->state, a, b);
}

static void combine(void *self, size_t into, size_t count, const double *weight)
{
    struct wrapped *w = self;
    w->solver->combine(w->state, into, count, weight);
}

static void size(void *self, size_t state, double sizes[2])
{
    struct wrapped *w = self;
    w->solver->size(w->state, state, sizes);
}

static enum br_status predict(void *self, const struct br_drive *drive, double *velocity,
                              struct br_error *err)
{
    struct wrapped *w = self;
    const bool axial = w->kind == BR_AXIAL;
    br_step_cost_lap(current, axial ? BR_COST_LOAD_AXIAL : BR_COST_LOAD_BENDING);
    const enum br_status status = w->solver->predict(w->state, drive, velocity, err);
    br_step_cost_lap(current, axial ? BR_COST_FIELD_AXIAL : BR_COST_FIELD_BENDING);
    return status;
}

static double finish(void *self, double force)
{
    struct wrapped *w = self;
    const bool axial = w->kind == BR_AXIAL;
    br_step_cost_lap(current, axial ? BR_COST_CONTACT : BR_COST_FRICTION);
    const double velocity = w->solver->finish(w->state, force);
    br_step_cost_lap(current, axial ? BR_COST_FIELD_AXIAL : BR_COST_FIELD_BENDING);
    return velocity;
}

static const struct br_field_solver measuring = {
    .create = create,
    .free = release,
    .tip_compliance = tip_compliance,
    .set = set,
    .get = get,
    .strain_rate = strain_rate,
    .predict = predict,
    .finish = finish,
    .tip_displacement = tip_displacement,
    .set_step = set_step,
    .keep = keep,
    .exchange = exchange,
    .combine = combine,
    .size = size,
};

/* What one lap adds to itself: the least of some trials, so that a pause does not count. */
static double measure_lap(void)
{
    double least = 1;
    for (int trial = 0; trial < 20; trial++) {
        struct br_step_cost c = {.last = br_seconds()};
        for (int i = 0; i < 200; i++)
            br_step_cost_lap(&c, BR_COST_RECORD);
        least = c.seconds[BR_COST_RECORD] < least ? c.seconds[BR_COST_RECORD] : least;
    }
    return least / 200;
}

void br_step_cost_begin(struct br_step_cost *cost, struct br_method *method)
{
    *cost = (struct br_step_cost){.lap_seconds = measure_lap(), .wrapped = *method->solver};
    cost->wrapped.axial = cost->wrapped.bending = &measuring;
    cost->wrapped.axial_quadratic = method->solver->axial_quadratic ? &measuring : NULL;
    inner = method->solver;
    current = cost;
    method->solver = &cost->wrapped;
}

void br_step_cost_end(struct br_step_cost *cost)
{
    current = NULL;
    for (int part = 0; part < BR_COST_PARTS; part++) {
        const double own = cost->lap_seconds * (double)cost->laps[part];
        cost->seconds[part] = cost->seconds[part] > own ? cost->seconds[part] - own : 0;
    }
}

/* ---- observers ---- */

static enum br_status mark_step(void *self, const struct br_march *march,
                                const struct br_history_row *row, struct br_error *err)
{
    (void)march, (void)err;
    const struct br_cost_mark *mark = self;
    if (row->step == 0)
        mark->cost->last = br_seconds(); /* what was before is setting up */
    else
        br_step_cost_lap(mark->cost, mark->part);
    return BR_OK;
}

static enum br_status mark_row(void *self, const struct br_history_row *row, struct br_error *err)
{
    return mark_step(self, NULL, row, err);
}

struct br_history_observer br_cost_mark_step(struct br_cost_mark *mark)
{
    return (struct br_history_observer){.self = mark, .step = mark_step};
}

struct br_history_observer br_cost_mark_output(struct br_cost_mark *mark)
{
    return (struct br_history_observer){.self = mark, .row = mark_row, .look = mark_step};
}
