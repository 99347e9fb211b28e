/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Warns of a lagged contact beyond its stability limit, with what would be within it. */
#include "study/foresee/warn_contact.h"

#include <math.h>
#include <stdio.h>

#include "solver/laws.h"

double br_round_steps(double least)
{
    static const double round_ones[] = {1, 1.25, 1.6, 2, 2.5, 4, 5, 8};
    for (double power = 1; power <= 1e12; power *= 10)
        for (size_t i = 0; i < sizeof round_ones / sizeof *round_ones; i++) {
            const double steps = round_ones[i] * power;
            if (steps >= least && steps == floor(steps))
                return steps;
        }
    return INFINITY;
}

/* The first digits of x, cut. */
static double cut(double x)
{
    const double unit = pow(10, floor(log10(x)) - 3);
    return isfinite(x / unit) ? floor(x / unit) * unit : x;
}

static void remedy(const struct br_planned_march *o, const struct br_field *field, char text[400])
{
    const double longest = br_contact_limit_step(field, o->scene->contact.stiffness);
    const double steps = br_round_steps(o->scene->duration / longest);
    int length = snprintf(text, 400, "--contact implicit  # has no limit\n");
    if (longest > 0 && isfinite(steps))
        length += snprintf(text + length, 400 - (size_t)length,
                           "--k T/%.0f  # time steps of at most %.4g s\n", steps, cut(longest));
    snprintf(text + length, 400 - (size_t)length, "a contact stiffness of at most %.4g N/m",
             cut(br_contact_limit_stiffness(field)));
}

static enum br_status look(const struct br_planned_march *o, struct br_warnings *warnings,
                           struct br_error *err)
{
    (void)err;
    const struct br_scene *scene = o->scene;
    const double k = scene->duration / (double)o->steps;
    struct br_field field = br_field_of_scene(scene, BR_AXIAL, o->n, k);
    field.degree = o->method->axial_degree;
    if (!scene->contact.modelled || o->method->contact->at_new_step ||
        !br_contact_grows(&field, scene->contact.stiffness))
        return BR_OK;
    char text[400];
    remedy(o, &field, text);
    br_warn(
        warnings, BR_WARN_UNSTABLE, text,
        "the lagged contact is beyond its stability limit: with k = %g s it is stable up to a "
        "stiffness of %.4g N/m, the scene has %g N/m; while it is closed, every step multiplies "
        "its error by -%.4g, and the tip chatters",
        k, br_contact_limit_stiffness(&field), scene->contact.stiffness,
        br_contact_growth(&field, scene->contact.stiffness));
    return BR_OK;
}

const struct br_warning_source br_warn_contact = {
    .title = "the stability limit of the lagged contact",
    .every = true,
    .look = look,
};
