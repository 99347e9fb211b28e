/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solver/laws.h"

#include <math.h>
#include <stdio.h>

const char *const br_field_names[BR_FIELDS] = {"axial", "bending"};

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

static enum br_status check_material(const struct br_scene *s, enum br_field_kind kind,
                                     struct br_error *err)
{
    const struct br_scene_field *f = &s->field[kind];
    const struct range ranges[] = {
        {"stiffness", f->stiffness, true},
        {"viscosity", f->viscosity, true},
        {"stiffness plus viscosity", f->stiffness + f->viscosity, false},
    };
    char prefix[16];
    snprintf(prefix, sizeof prefix, "%s: ", br_field_names[kind]);
    return check_ranges(prefix, ranges, sizeof ranges / sizeof *ranges, err);
}

static enum br_status check_laws(const struct br_scene *s, struct br_error *err)
{
    if (s->contact.modelled && !s->axial.modelled)
        return br_fail(err, BR_BAD_INPUT, "contact needs the axial part, which is not modelled");
    if ((unsigned)s->friction.law >= BR_FRICTION_LAWS ||
        (br_friction_rubs(&s->friction) && !br_friction_models[s->friction.law].bound))
        return br_fail(err, BR_BAD_INPUT, "friction law %d has no bound, expected one of 1 to %d",
                       (int)s->friction.law, BR_FRICTION_LAWS - 1);
    if (br_friction_rubs(&s->friction) && !s->bending.modelled)
        return br_fail(err, BR_BAD_INPUT, "friction needs the bending part, which is not modelled");
    if (br_friction_follows_contact(&s->friction) && !s->contact.modelled)
        return br_fail(err, BR_BAD_INPUT,
                       "%s friction takes its bound from the contact, which is not modelled",
                       br_friction_models[s->friction.law].title);
    if (br_friction_follows_contact(&s->friction) && br_friction_bound(s, 0) != 0)
        return br_fail(err, BR_BAD_INPUT,
                       "%s friction has a bound of %g N without penetration, expected none, as its "
                       "bound follows the contact",
                       br_friction_models[s->friction.law].title, br_friction_bound(s, 0));
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
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING && !status; kind++)
        if (s->field[kind].modelled)
            status = check_material(s, kind, err);
    if (!status)
        status = check_laws(s, err);
    return status;
}

double br_contact_stiffness(const struct br_contact *contact)
{
    return contact->stiffness;
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
    enum { SINGLES = 8, ALL = SINGLES + 2 * BR_LOAD_TERMS };
    struct br_scene_field *f = &s->field[i < ALL ? BR_AXIAL : BR_BENDING];
    struct br_function *const single[SINGLES] = {
        &f->displacement, &f->displacement_slope, &f->velocity,    &f->velocity_slope,
        &f->tip_force,    &f->tip_moment,         &f->stick_force, &f->given,
    };
    const size_t at = i % ALL;
    if (i >= BR_FIELDS * ALL)
        return NULL;
    if (at < SINGLES)
        return single[at];
    struct br_product *product = &f->load.term[(at - SINGLES) / 2];
    return at % 2 ? &product->time : &product->space;
}

void br_scene_clear(struct br_scene *s)
{
    struct br_function *f;
    for (size_t i = 0; (f = br_scene_function(s, i)); i++)
        br_function_free(f);
    free(s->name);
    free(s->title);
    free(s->remark);
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        free(s->field[kind].solution);
    *s = (struct br_scene){0};
}
