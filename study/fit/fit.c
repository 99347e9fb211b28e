/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/fit/fit.h"

#include <math.h>

#include "solver/scene.h"

const double br_flag_margin = 3;

static bool usable(const struct br_cell *c, enum br_part part)
{
    return c->flag[part] == BR_FLAG_NONE && c->error[part] > 0 && isfinite(c->error[part]);
}

static enum br_status fit_joint(const struct br_study *s, enum br_part part,
                                struct br_joint_fit *fit, struct br_error *err)
{
    struct br_observation *o = br_allocate(br_study_cells(s), sizeof *o);
    if (!o)
        return br_no_memory(err, "the fits");
    size_t count = 0;
    for (size_t i = 0; i < br_study_cells(s); i++) {
        const struct br_cell *c = &s->cell[i];
        if (!usable(c, part))
            continue;
        for (int axis = 0; axis < BR_AXES; axis++) {
            o[count].x[axis] = br_axis_size(s->scene, axis, c->at);
            o[count].ref[axis] = br_axis_size(s->scene, axis, c->against);
        }
        o[count++].error = c->error[part];
    }
    const enum br_status status = br_joint_fit_solve(o, count, false, NULL, fit, err);
    free(o);
    return status;
}

/* The reference's own error: by the auditor, by the reference's statement, or else by the model
 * against a reference without error. */
static double reference_error(const struct br_study *s, enum br_part part,
                              const struct br_joint_fit *fit)
{
    if (s->auditor)
        return s->reference_error[part];
    const double stated = br_norm_of_constant(s->norm, s->scene, s->judged_by.own_error, part);
    if (isfinite(stated))
        return stated;
    if (!br_joint_describes(fit))
        return NAN;
    return br_joint_model(fit, (double[]){br_reference_mesh(s), br_reference_step(s)},
                          (double[]){0, 0});
}

/* Predicted round-off of a component of a cell, m^(3/2); and of the reference, unless an auditor
 * has measured all of its error. */
static double round_off(const struct br_study *s, const struct br_cell *c, enum br_part part)
{
    const struct br_method *method = br_study_method(s, (size_t)(c - s->cell));
    double relative = s->auditor ? 0 : s->judged_by.round_off;
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        const struct br_field field = br_field_of_scene(
            s->scene, kind, c->at.n, br_time_step(s->scene, c->at.steps), method->axial_degree);
        if (s->scene->field[kind].modelled && br_part_has(part, kind))
            relative = fmax(relative, br_method_round_off(method, &field));
    }
    return relative * s->reference_scale;
}

/* Sets the flags of one component; returns how many changed. */
static size_t set_flags(struct br_study *s, enum br_part part, double reference)
{
    size_t changed = 0;
    if (!br_models(s->scene, part))
        return 0;
    for (size_t i = 0; i < br_study_cells(s); i++) {
        struct br_cell *c = &s->cell[i];
        enum br_flag flag = BR_FLAG_NONE;
        if (c->failure.status || !isfinite(c->error[part]))
            flag = BR_FLAG_FAILED;
        else if (c->unstable)
            flag = BR_FLAG_UNSTABLE;
        else if (!(c->error[part] >= br_flag_margin * round_off(s, c, part)))
            flag = BR_FLAG_ROUND_OFF;
        else if (isfinite(reference) && !(c->error[part] >= br_flag_margin * reference))
            flag = BR_FLAG_REFERENCE;
        changed += flag != c->flag[part];
        c->flag[part] = flag;
    }
    return changed;
}

enum br_status br_fit(struct br_study *s, enum br_part part, struct br_fits *fits,
                      struct br_error *err)
{
    *fits = (struct br_fits){.reference_error = NAN};
    set_flags(s, part, 0);
    enum br_status status = BR_OK;
    /* The reference's error only grows from round to round, so no flag is cleared and the rounds
     * end. */
    do {
        status = fit_joint(s, part, &fits->joint, err);
        const double own = reference_error(s, part, &fits->joint);
        if (!(own <= fits->reference_error) && isfinite(own))
            fits->reference_error = own;
    } while (!status && set_flags(s, part, fits->reference_error) != 0);
    return status;
}

void br_flag_beside(struct br_study *s)
{
    static const struct br_joint_fit none;
    for (enum br_part part = 0; part < BR_PARTS; part++)
        set_flags(s, part, reference_error(s, part, &none));
}
