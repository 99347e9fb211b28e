/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solver/load.h"

#include <math.h>

double br_load_peak(const struct br_field *field, const struct br_function *f, double t)
{
    enum { POINTS = 64 };
    double x[POINTS], value[POINTS], most = 0;
    for (int i = 0; i < POINTS; i++)
        x[i] = (i + 0.5) / POINTS * (double)field->n * field->h;
    br_function_evaluate(f, POINTS, x, t, value);
    for (int i = 0; i < POINTS; i++)
        most = fmax(most, fabs(value[i]));
    return most;
}

enum br_status br_step_load_init(struct br_step_load *load, const struct br_scene *scene,
                                 const struct br_field *field, struct br_error *err)
{
    *load = (struct br_step_load){.drive = {.factor = 1, .changed = true}};
    const struct br_scene_field *data = &scene->field[field->kind];
    enum br_status status = br_load_clone(&data->load, &load->functions, err);
    if (!status)
        status = br_function_clone(&data->tip_force, &load->tip_force, err);
    if (!status)
        status = br_function_clone(&data->tip_moment, &load->tip_moment, err);
    while (load->terms < BR_LOAD_TERMS && !br_product_is_zero(&load->functions.term[load->terms]))
        load->terms++;
    for (size_t i = 0; i < load->terms && !status; i++) {
        const struct br_function *space = &load->functions.term[i].space;
        load->vector[i] = br_store_take(&load->store, br_field_size(field), sizeof(double));
        if (!load->vector[i])
            status = br_no_memory(err, "a load vector");
        else if (!space->uses_t)
            status = br_assemble_load(field, space, 0, load->vector[i], err);
        else if (space->uses_x)
            status = br_load_fit_create(field, space, scene->duration, &load->fit[i], err);
    }
    if (load->terms > 1 && !status) {
        load->sum = br_store_take(&load->store, br_field_size(field), sizeof *load->sum);
        if (!load->sum)
            status = br_no_memory(err, "a load vector");
    }
    load->drive.vector = load->terms > 1 ? load->sum : load->vector[0];
    return status;
}

void br_step_load_clear(struct br_step_load *load)
{
    br_load_clear(&load->functions);
    br_function_free(&load->tip_force);
    br_function_free(&load->tip_moment);
    for (size_t i = 0; i < BR_LOAD_TERMS; i++)
        br_load_fit_free(load->fit[i]);
    br_store_clear(&load->store);
    *load = (struct br_step_load){0};
}

/* A function of t alone, checked. */
static enum br_status evaluate(const struct br_function *f, const char *name, double t,
                               double *value, struct br_error *err)
{
    *value = br_function_at(f, 0, t);
    if (!isfinite(*value))
        return br_fail(err, BR_NOT_FINITE, "the %s is %g at t = %.17g s", name, *value, t);
    return BR_OK;
}

/* sum = sum of factor_i * vector_i */
static void add_up(struct br_step_load *load, const struct br_field *field)
{
    const size_t size = br_field_size(field);
    for (size_t j = 0; j < size; j++)
        load->sum[j] = load->factor[0] * load->vector[0][j];
    for (size_t i = 1; i < load->terms; i++)
        for (size_t j = 0; j < size; j++)
            load->sum[j] += load->factor[i] * load->vector[i][j];
}

static enum br_status update(struct br_step_load *load, const struct br_field *field, double t,
                             struct br_error *err)
{
    struct br_drive *drive = &load->drive;
    enum br_status status = BR_OK;
    bool other = false; /* the sum differs from that of the last update */
    for (size_t i = 0; i < load->terms && !status; i++) {
        const struct br_product *term = &load->functions.term[i];
        const double before = load->factor[i];
        status = evaluate(&term->time, "load's time factor", t, &load->factor[i], err);
        other |= load->factor[i] != before;
        if (!status && term->space.uses_t) {
            const bool fits = load->fit[i] &&
                              br_load_fit_assemble(load->fit[i], &term->space, t, load->vector[i]);
            if (!fits)
                status = br_assemble_load(field, &term->space, t, load->vector[i], err);
            drive->changed = other = true;
        }
    }
    if (load->terms == 1)
        drive->factor = load->factor[0];
    if (load->terms > 1 && other && !status) {
        add_up(load, field);
        drive->changed = true;
    }
    if (br_function_is_zero(&load->tip_force) && br_function_is_zero(&load->tip_moment))
        return status;
    double moment = 0;
    if (!status)
        status = evaluate(&load->tip_force, "tip force", t, &load->drive.tip[0], err);
    if (!status)
        status = evaluate(&load->tip_moment, "tip moment", t, &moment, err);
    load->drive.tip[1] = moment / field->h; /* the slope is scaled, s = h w_x */
    return status;
}

enum br_status br_step_load_update(struct br_step_load *load, const struct br_field *field,
                                   double t, struct br_error *err)
{
    struct br_error inner; /* not cleared: this runs in every step */
    const enum br_status status = update(load, field, t, &inner);
    if (!status)
        return BR_OK;
    return br_fail(err, status, "%s load: %.900s", br_field_names[field->kind], inner.message);
}
