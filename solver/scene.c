/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solver/scene.h"

#include <math.h>

/* One physical number: its name, value, and the range that makes sense. */
struct range {
    const char *name;
    double value;
    bool zero_allowed;
};

/* prefix: "axial: ", or "". */
static enum br_status check_ranges(const char *prefix, const struct range *ranges, size_t count,
                                   struct br_error *err)
{
    for (const struct range *r = ranges; r < ranges + count; r++)
        if (!(isfinite(r->value) && (r->zero_allowed ? r->value >= 0 : r->value > 0)))
            return br_fail(err, BR_BAD_INPUT, "%s%s is %g, expected a finite number %s 0", prefix,
                           r->name, r->value, r->zero_allowed ? ">=" : ">");
    return BR_OK;
}

static enum br_status check_material(const char *prefix, double stiffness, double viscosity,
                                     struct br_error *err)
{
    const struct range ranges[] = {
        {"stiffness", stiffness, true},
        {"viscosity", viscosity, true},
        {"stiffness plus viscosity", stiffness + viscosity, false},
    };
    return check_ranges(prefix, ranges, sizeof ranges / sizeof *ranges, err);
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
    enum br_status status = check_ranges("", ranges, sizeof ranges / sizeof *ranges, err);
    if (!status && !s->axial.modelled && !s->bending.modelled)
        status = br_fail(err, BR_BAD_INPUT, "neither axial nor bending is modelled");
    if (!status && s->axial.modelled)
        status = check_material("axial: ", s->axial.stiffness, s->axial.viscosity, err);
    if (!status && s->bending.modelled)
        status = check_material("bending: ", s->bending.stiffness, s->bending.viscosity, err);
    if (!status)
        status = check_laws(s, err);
    return status;
}

bool br_product_is_zero(const struct br_product *p)
{
    return br_function_is_zero(&p->space) || br_function_is_zero(&p->time);
}

bool br_load_is_zero(const struct br_load *load)
{
    bool zero = true;
    for (size_t i = 0; i < BR_LOAD_TERMS; i++)
        zero = zero && br_product_is_zero(&load->term[i]);
    return zero;
}

double br_load_value(const struct br_load *load, double x, double t)
{
    double sum = 0;
    for (size_t i = 0; i < BR_LOAD_TERMS; i++)
        sum +=
            br_function_at(&load->term[i].space, x, t) * br_function_at(&load->term[i].time, x, t);
    return sum;
}

enum br_status br_load_clone(const struct br_load *load, struct br_load *out, struct br_error *err)
{
    enum br_status status = BR_OK;
    struct br_product *to = out->term;
    *out = (struct br_load){0};
    for (size_t i = 0; i < BR_LOAD_TERMS && !status; i++) {
        if (br_product_is_zero(&load->term[i]))
            continue;
        status = br_function_clone(&load->term[i].space, &to->space, err);
        if (!status)
            status = br_function_clone(&load->term[i].time, &to->time, err);
        to++;
    }
    return status;
}

void br_load_clear(struct br_load *load)
{
    for (size_t i = 0; i < BR_LOAD_TERMS; i++) {
        br_function_free(&load->term[i].space);
        br_function_free(&load->term[i].time);
    }
}

struct br_function *br_scene_function(struct br_scene *s, size_t i)
{
    struct br_function *const single[] = {
        &s->axial.displacement,   &s->axial.velocity,
        &s->bending.displacement, &s->bending.displacement_slope,
        &s->bending.velocity,     &s->bending.velocity_slope,
        &s->axial.tip_force,      &s->bending.tip_force,
        &s->bending.tip_moment,   &s->bending.stick_force,
        &s->axial.given,          &s->bending.given,
    };
    const size_t singles = sizeof single / sizeof *single;
    if (i < singles)
        return single[i];
    const size_t term = (i - singles) / 2;
    if (term >= 2 * BR_LOAD_TERMS)
        return NULL;
    struct br_load *load = term < BR_LOAD_TERMS ? &s->axial.load : &s->bending.load;
    struct br_product *product = &load->term[term % BR_LOAD_TERMS];
    return (i - singles) % 2 ? &product->time : &product->space;
}

void br_scene_clear(struct br_scene *s)
{
    struct br_function *f;
    for (size_t i = 0; (f = br_scene_function(s, i)); i++)
        br_function_free(f);
    free(s->name);
    free(s->title);
    free(s->remark);
    free(s->axial.solution);
    free(s->bending.solution);
    *s = (struct br_scene){0};
}
