/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solver/scene.h"

#include <math.h>

/* One physical number: its name, value, and the range that makes sense. */
struct range {
    const char *name;
    double value;
    bool zero_allowed;
};

static enum br_status check_range(const struct range *r, struct br_error *err)
{
    const bool fits = isfinite(r->value) && (r->zero_allowed ? r->value >= 0 : r->value > 0);
    if (!fits)
        return br_fail(err, BR_BAD_INPUT, "%s is %g, expected a finite number %s 0", r->name,
                       r->value, r->zero_allowed ? ">=" : ">");
    return BR_OK;
}

static enum br_status check_material(const char *part, double stiffness, double viscosity,
                                     struct br_error *err)
{
    const struct range ranges[] = {
        {"stiffness", stiffness, true},
        {"viscosity", viscosity, true},
        {"stiffness plus viscosity", stiffness + viscosity, false},
    };
    for (size_t i = 0; i < sizeof ranges / sizeof *ranges; i++) {
        struct br_error inner = {0};
        if (check_range(&ranges[i], &inner))
            return br_fail(err, BR_BAD_INPUT, "%s: %s", part, inner.message);
    }
    return BR_OK;
}

static enum br_status check_laws(const struct br_scene *s, struct br_error *err)
{
    if (s->contact.modelled && !s->axial.modelled)
        return br_fail(err, BR_BAD_INPUT, "contact needs the axial part, which is not modelled");
    if (s->friction.law != BR_FRICTIONLESS && !s->bending.modelled)
        return br_fail(err, BR_BAD_INPUT, "friction needs the bending part, which is not modelled");
    if (s->friction.law == BR_COULOMB && !s->contact.modelled)
        return br_fail(err, BR_BAD_INPUT,
                       "Coulomb friction takes its bound from the contact, which is not modelled");
    return BR_OK;
}

enum br_status br_scene_check(const struct br_scene *s, struct br_error *err)
{
    const struct range ranges[] = {
        {"length", s->length, false},
        {"duration", s->duration, false},
        {"density", s->density, true},
        {"contact gap", s->contact.gap, true},
        {"contact stiffness", s->contact.stiffness, true},
        {"friction coefficient", s->friction.coefficient, true},
        {"friction regularisation", s->friction.regularisation, true},
    };
    enum br_status status = BR_OK;
    for (size_t i = 0; i < sizeof ranges / sizeof *ranges && !status; i++)
        status = check_range(&ranges[i], err);
    if (!status && !s->axial.modelled && !s->bending.modelled)
        status = br_fail(err, BR_BAD_INPUT, "neither axial nor bending is modelled");
    if (!status && s->axial.modelled)
        status = check_material("axial", s->axial.stiffness, s->axial.viscosity, err);
    if (!status && s->bending.modelled)
        status = check_material("bending", s->bending.stiffness, s->bending.viscosity, err);
    if (!status)
        status = check_laws(s, err);
    return status;
}

void br_scene_clear(struct br_scene *s)
{
    struct br_function *functions[] = {
        &s->axial.load.space,     &s->axial.load.time,
        &s->axial.displacement,   &s->axial.velocity,
        &s->bending.load.space,   &s->bending.load.time,
        &s->bending.displacement, &s->bending.displacement_slope,
        &s->bending.velocity,     &s->bending.velocity_slope,
        &s->axial.tip_force,      &s->bending.tip_force,
        &s->bending.tip_moment,   &s->bending.stick_force,
    };
    for (size_t i = 0; i < sizeof functions / sizeof *functions; i++)
        br_function_free(functions[i]);
    free(s->name);
    free(s->title);
    free(s->remark);
    free(s->axial.solution);
    free(s->bending.solution);
    *s = (struct br_scene){0};
}
