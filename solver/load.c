/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solver/load.h"

#include <math.h>

struct br_forces br_forces_of_scene(const struct br_scene *s, enum br_field_kind kind)
{
    if (kind == BR_AXIAL)
        return (struct br_forces){&s->axial.load, &s->axial.tip_force, NULL};
    return (struct br_forces){&s->bending.load, &s->bending.tip_force, &s->bending.tip_moment};
}

static bool is_absent(const struct br_load *load)
{
    return br_function_is_zero(&load->space) || br_function_is_zero(&load->time);
}

static enum br_status clone_functions(struct br_step_load *load, const struct br_forces *forces,
                                      struct br_error *err)
{
    enum br_status status = BR_OK;
    if (!is_absent(forces->load)) {
        status = br_function_clone(&forces->load->space, &load->functions.space, err);
        if (!status)
            status = br_function_clone(&forces->load->time, &load->functions.time, err);
    }
    if (!status)
        status = br_function_clone(forces->tip_force, &load->tip_force, err);
    if (!status && forces->tip_moment)
        status = br_function_clone(forces->tip_moment, &load->tip_moment, err);
    return status;
}

enum br_status br_step_load_init(struct br_step_load *load, const struct br_forces *forces,
                                 const struct br_field *field, struct br_error *err)
{
    *load = (struct br_step_load){.drive = {.factor = 1, .changed = true}};
    const enum br_status status = clone_functions(load, forces, err);
    if (status || is_absent(forces->load))
        return status;
    load->space = br_allocate(br_field_size(field), sizeof *load->space);
    if (!load->space)
        return br_no_memory(err, "a load vector");
    load->drive.vector = load->space;
    if (!load->functions.space.uses_t)
        return br_assemble_load(field, &load->functions.space, 0, load->space, err);
    return BR_OK;
}

void br_step_load_clear(struct br_step_load *load)
{
    br_function_free(&load->functions.space);
    br_function_free(&load->functions.time);
    br_function_free(&load->tip_force);
    br_function_free(&load->tip_moment);
    free(load->space);
    *load = (struct br_step_load){0};
}

/* A function of t alone, checked. */
static enum br_status evaluate(const struct br_function *f, const char *name, double t,
                               double *value, struct br_error *err)
{
    const double x = 0;
    br_function_evaluate(f, 1, &x, t, value);
    if (!isfinite(*value))
        return br_fail(err, BR_NOT_FINITE, "the %s is %g at t = %.17g s", name, *value, t);
    return BR_OK;
}

/* The tip's force on its displacement and moment on its slope. */
static enum br_status update_tip(struct br_step_load *load, const struct br_field *field, double t,
                                 struct br_error *err)
{
    double moment;
    enum br_status status = evaluate(&load->tip_force, "tip force", t, &load->drive.tip[0], err);
    if (!status)
        status = evaluate(&load->tip_moment, "tip moment", t, &moment, err);
    if (!status)
        load->drive.tip[1] = moment / field->h; /* the slope is scaled, s = h w_x */
    return status;
}

static enum br_status update(struct br_step_load *load, const struct br_field *field, double t,
                             struct br_error *err)
{
    struct br_drive *drive = &load->drive;
    enum br_status status = BR_OK;
    if (load->space)
        status = evaluate(&load->functions.time, "load's time factor", t, &drive->factor, err);
    if (!status && load->space && load->functions.space.uses_t) {
        status = br_assemble_load(field, &load->functions.space, t, load->space, err);
        drive->changed = true;
    }
    if (!status &&
        !(br_function_is_zero(&load->tip_force) && br_function_is_zero(&load->tip_moment)))
        status = update_tip(load, field, t, err);
    return status;
}

enum br_status br_step_load_update(struct br_step_load *load, const struct br_field *field,
                                   double t, struct br_error *err)
{
    struct br_error inner; /* not cleared: this is every step */
    const enum br_status status = update(load, field, t, &inner);
    if (!status)
        return BR_OK;
    return br_fail(err, status, "%s load: %.900s", field->kind == BR_AXIAL ? "axial" : "bending",
                   inner.message);
}
