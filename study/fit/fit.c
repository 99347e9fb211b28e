/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/fit/theory.h"

#include <float.h>
#include <math.h>

#include "solver/scene.h"

const double br_flag_margin = 3;

/* The errors of one component with their flags, as numbers of anybody. */
static enum br_status fill_numbers(const struct br_study *s, enum br_part part,
                                   struct br_numbers *n, struct br_error *err)
{
    static const char *const columns[BR_AXES] = {"n", "k"};
    *n = (struct br_numbers){.powers = true};
    if (br_numbers_make_room(n, br_study_cells(s), 1, err) ||
        br_numbers_add_quantity(n, br_part_names[part], s->norm->unit, false, err))
        return err->status;
    n->quantity->digits = DBL_DECIMAL_DIG;
    for (enum br_axis axis = 0; axis < BR_AXES; axis++) {
        n->column[axis] = br_resolution_column_find(columns[axis]);
        n->quantity->formal[axis] = br_theory_of(s, part, axis).formal;
    }
    for (size_t i = 0; i < n->rows; i++) {
        const struct br_cell *c = &s->cell[i];
        struct br_numbers_row *row = &n->row[i];
        for (int axis = 0; axis < BR_AXES; axis++) {
            row->z[axis] = br_axis_size(s->scene, axis, c->at);
            row->against[axis] = br_axis_size(s->scene, axis, c->against);
        }
        row->given[BR_AXIS_SPACE] = (double)c->at.n;
        row->given[BR_AXIS_TIME] = row->z[BR_AXIS_TIME];
        row->number[0] = c->error[part];
        row->out[0] = c->flag[part];
    }
    return BR_OK;
}

void br_fits_clear(struct br_fits *fits)
{
    br_orders_clear(&fits->orders);
    br_numbers_clear(&fits->numbers);
}

static enum br_status find_orders(const struct br_study *s, enum br_part part, struct br_fits *fits,
                                  struct br_error *err)
{
    br_fits_clear(fits);
    if (fill_numbers(s, part, &fits->numbers, err) ||
        br_orders_find(&fits->numbers, 0, &fits->orders, err))
        return err->status;
    fits->joint = fits->orders.of->joint;
    return BR_OK;
}

/* The reference's own error: by the reference check, by its statement, or else by the model
 * against a reference without error. */
static double reference_error(const struct br_study *s, enum br_part part,
                              const struct br_joint_fit *fit)
{
    if (s->reference_check)
        return s->reference_error[part];
    const double stated =
        br_norm_of_constant(s->norm, s->scene, s->reference_report.own_error, part);
    if (isfinite(stated))
        return stated;
    if (!br_joint_describes(fit))
        return NAN;
    return br_joint_model(fit, (double[]){br_reference_mesh(s), br_reference_step(s)},
                          (double[]){0, 0});
}

/* Predicted round-off of a component of a cell, m^(3/2); and of the reference, unless a reference
 * check has measured all of its error. */
static double round_off(const struct br_study *s, const struct br_cell *c, enum br_part part)
{
    const struct br_method *method = br_study_method(s, (size_t)(c - s->cell));
    double relative = s->reference_check ? 0 : s->reference_report.round_off;
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
        status = find_orders(s, part, fits, err);
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
