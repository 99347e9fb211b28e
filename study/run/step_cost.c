/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/run/history.h"

#include "solver/clock.h"

/* The march that is measured in this thread, and the solvers of its fields. */
static _Thread_local struct br_step_cost *current;
static _Thread_local const struct br_field_solver *inner[2]; /* by br_field_kind */

const char *br_cost_part_text(enum br_cost_part part)
{
    static const char *const texts[] = {
#define X(name, text) [name] = text,
        BR_COST_LIST(X)
#undef X
    };
    return texts[part];
}

static void lap(struct br_step_cost *cost, enum br_cost_part part)
{
    const double now = br_seconds();
    cost->seconds[part] += now - cost->last;
    cost->laps[part]++;
    cost->last = now;
}

void br_step_cost_mark(const struct br_cost_mark *mark, size_t step)
{
    if (mark->cost && step > 0)
        lap(mark->cost, mark->part);
    else if (mark->cost)
        mark->cost->last = br_seconds();
}

/* ---- the measuring solver ---- */

static enum br_status predict(enum br_field_kind kind, void *self, const struct br_drive *drive,
                              double *velocity, struct br_error *err)
{
    const bool axial = kind == BR_AXIAL;
    lap(current, axial ? BR_COST_LOAD_AXIAL : BR_COST_LOAD_BENDING);
    const enum br_status status = inner[kind]->predict(self, drive, velocity, err);
    lap(current, axial ? BR_COST_FIELD_AXIAL : BR_COST_FIELD_BENDING);
    return status;
}

static enum br_status predict_axial(void *self, const struct br_drive *drive, double *velocity,
                                    struct br_error *err)
{
    return predict(BR_AXIAL, self, drive, velocity, err);
}

static enum br_status predict_bending(void *self, const struct br_drive *drive, double *velocity,
                                      struct br_error *err)
{
    return predict(BR_BENDING, self, drive, velocity, err);
}

static double finish(enum br_field_kind kind, void *self, double force)
{
    const bool axial = kind == BR_AXIAL;
    lap(current, axial ? BR_COST_CONTACT : BR_COST_FRICTION);
    const double velocity = inner[kind]->finish(self, force);
    lap(current, axial ? BR_COST_FIELD_AXIAL : BR_COST_FIELD_BENDING);
    return velocity;
}

static double finish_axial(void *self, double force)
{
    return finish(BR_AXIAL, self, force);
}

static double finish_bending(void *self, double force)
{
    return finish(BR_BENDING, self, force);
}

/* The solver of a field, but for the two functions of a step. */
static const struct br_field_solver *measuring(struct br_step_cost *cost, enum br_field_kind kind)
{
    struct br_field_solver *own = &cost->measuring[kind];
    if (!inner[kind])
        return NULL;
    *own = *inner[kind];
    own->predict = kind == BR_AXIAL ? predict_axial : predict_bending;
    own->finish = kind == BR_AXIAL ? finish_axial : finish_bending;
    return own;
}

/* What one lap adds to itself: the least of some trials, so that a pause does not count. */
static double measure_lap(void)
{
    double least = 1;
    for (int trial = 0; trial < 20; trial++) {
        struct br_step_cost c = {.last = br_seconds()};
        for (int i = 0; i < 200; i++)
            lap(&c, BR_COST_RECORD);
        least = c.seconds[BR_COST_RECORD] < least ? c.seconds[BR_COST_RECORD] : least;
    }
    return least / 200;
}

/* Of solvers that stand for others, each field has its own. */
void br_step_cost_begin(struct br_step_cost *cost, const struct br_scene *scene, size_t n,
                        struct br_method *method)
{
    *cost = (struct br_step_cost){.lap_seconds = measure_lap()};
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        struct br_field field = br_field_of_scene(scene, (enum br_field_kind)kind, n, 1);
        field.degree = method->axial_degree;
        cost->wrapped = *br_method_solver(method, &field);
        inner[kind] = br_linear_solver_for(&cost->wrapped, &field);
    }
    cost->wrapped.axial = cost->wrapped.axial_quadratic = measuring(cost, BR_AXIAL);
    cost->wrapped.bending = measuring(cost, BR_BENDING);
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
