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

static bool loads_tip(const struct br_step_load *load)
{
    return !br_function_is_zero(&load->tip_force) || !br_function_is_zero(&load->tip_moment);
}

enum br_status br_step_load_init(struct br_step_load *load, const struct br_forces *forces,
                                 const struct br_field *field, struct br_error *err)
{
    *load = (struct br_step_load){.factor = 1};
    const enum br_status status = clone_functions(load, forces, err);
    if (status)
        return status;
    if (!is_absent(forces->load))
        load->space = br_allocate(br_field_size(field), sizeof *load->space);
    if (loads_tip(load))
        load->whole = br_allocate(br_field_size(field), sizeof *load->whole);
    if ((!is_absent(forces->load) && !load->space) || (loads_tip(load) && !load->whole))
        return br_no_memory(err, "a load vector");
    load->vector = load->whole ? load->whole : load->space;
    if (load->space && !load->functions.space.uses_t)
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
    free(load->whole);
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

/* whole = factor * space + the tip's force on its displacement and moment on its slope */
static enum br_status add_tip(struct br_step_load *load, const struct br_field *field, double t,
                              struct br_error *err)
{
    double force, moment;
    enum br_status status = evaluate(&load->tip_force, "tip force", t, &force, err);
    if (!status)
        status = evaluate(&load->tip_moment, "tip moment", t, &moment, err);
    if (status)
        return status;
    const size_t size = br_field_size(field);
    for (size_t i = 0; i < size; i++)
        load->whole[i] = load->space ? load->factor * load->space[i] : 0;
    load->factor = 1;
    load->whole[size - br_field_unknowns(field->kind)] += force;
    if (field->kind == BR_BENDING)
        load->whole[size - 1] += moment / field->h; /* the slope is scaled, s = h w_x */
    return BR_OK;
}

enum br_status br_step_load_update(struct br_step_load *load, const struct br_field *field,
                                   double t, struct br_error *err)
{
    enum br_status status = BR_OK;
    if (load->space)
        status = evaluate(&load->functions.time, "load's time factor", t, &load->factor, err);
    if (!status && load->space && load->functions.space.uses_t)
        status = br_assemble_load(field, &load->functions.space, t, load->space, err);
    if (!status && load->whole)
        status = add_tip(load, field, t, err);
    return status;
}
