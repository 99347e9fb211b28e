/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tests/rescale.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "study/known/expression.h"
#include "study/scene/schema.h"
#include "study/scene/units.h"

/* ---- the scene ---- */

/* The dimension of a member of the scene, by the key that gives it. */
static struct br_dimension dimension_of(const struct br_scene *s, const void *member)
{
    const size_t offset = (size_t)((const char *)member - (const char *)s);
    const struct br_scene_key *k = br_scene_keys;
    struct br_unit unit;
    while (k->offset != offset ||
           (k->laws && s->friction.law != BR_FRICTIONLESS && !(k->laws & 1u << s->friction.law)))
        k++;
    br_unit_read(k->unit, &unit);
    return unit.of;
}

struct change {
    struct br_units_change to;
    enum br_status status;
    struct br_error *err;
};

static double factor_of(struct change *c, struct br_dimension u)
{
    return pow(c->to.metre, u.metre) * pow(c->to.second, u.second) *
           pow(c->to.kilogram, u.kilogram);
}

static void scale(struct change *c, double *value, struct br_dimension u)
{
    const double old = *value;
    *value *= factor_of(c, u);
    if (isfinite(*value) && (old == 0 || fabs(*value) >= DBL_MIN || fabs(old) < DBL_MIN))
        return;
    if (!c->status)
        c->status = br_fail(c->err, BR_BAD_INPUT, "%g is %g in the other units", old, *value);
}

/* factor * f(x / metre, t / second) */
static enum br_status put_scaled(struct br_function *f, double factor, double metre, double second,
                                 struct br_error *err)
{
    const struct br_tree *old = br_tree_of(f);
    struct br_tree_builder b = {0};
    struct br_tree tree;
    if (!old)
        return br_fail(err, BR_UNSUPPORTED, "a function that is no expression, in other units");
    const unsigned x = br_tree_node(&b, BR_OP_DIVIDE, br_tree_node(&b, BR_OP_X, 0, 0, 0),
                                    br_tree_number(&b, metre), 0);
    const unsigned t = br_tree_node(&b, BR_OP_DIVIDE, br_tree_node(&b, BR_OP_T, 0, 0, 0),
                                    br_tree_number(&b, second), 0);
    const unsigned root = br_tree_substitute(&b, old, (unsigned)old->count - 1, x, t);
    const enum br_status status = br_tree_finish(
        &b, br_tree_node(&b, BR_OP_MULTIPLY, root, br_tree_number(&b, factor), 0), &tree, err);
    br_function_free(f);
    *f = (struct br_function){0};
    return status ? status : br_tree_function(&tree, f, err);
}

static void scale_function(struct change *c, struct br_function *f, struct br_dimension u)
{
    if (!f->ops) {
        if (f->constant != 0)
            scale(c, &f->constant, u);
        return;
    }
    const double factor = factor_of(c, u), metre = c->to.metre;
    const enum br_status status = put_scaled(f, factor, metre, c->to.second, c->err);
    c->status = c->status ? c->status : status;
}

/* Changes every number and function by its unit. The history of a load has its unit, and its shape
 * has none. */
static void change_all(struct change *c, struct br_scene *s)
{
    double *const numbers[] = {
        &s->density,           &s->axial.stiffness,      &s->axial.viscosity,
        &s->bending.stiffness, &s->bending.viscosity,    &s->contact.gap,
        &s->contact.stiffness, &s->friction.coefficient, &s->friction.regularisation,
    };
    struct br_function *const functions[] = {
        &s->axial.tip_force,     &s->axial.displacement,         &s->axial.velocity,
        &s->bending.tip_force,   &s->bending.tip_moment,         &s->bending.displacement,
        &s->bending.velocity,    &s->bending.displacement_slope, &s->bending.velocity_slope,
        &s->bending.stick_force,
    };
    struct br_load *const loads[] = {&s->axial.load, &s->bending.load};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        scale(c, numbers[i], dimension_of(s, numbers[i]));
    for (size_t i = 0; i < sizeof functions / sizeof *functions; i++)
        scale_function(c, functions[i], dimension_of(s, functions[i]));
    for (size_t i = 0; i < 2 * BR_LOAD_TERMS; i++) {
        struct br_product *term = &loads[i % 2]->term[i / 2];
        scale_function(c, &term->space, (struct br_dimension){0, 0, 0});
        scale_function(c, &term->time, dimension_of(s, loads[i % 2]));
    }
}

static char *copy_text(const char *text, struct change *c)
{
    char *copy = text ? br_allocate(strlen(text) + 1, 1) : NULL;
    if (copy)
        strcpy(copy, text);
    else if (text)
        c->status = br_no_memory(c->err, "a scene in other units");
    return copy;
}

static void copy_functions(struct br_scene *s, struct change *c)
{
    struct br_function *f;
    for (size_t i = 0; (f = br_scene_function(s, i)); i++) {
        const struct br_function old = *f;
        if (br_function_clone(&old, f, c->err))
            c->status = BR_NO_MEMORY;
    }
}

static enum br_status apply(const struct br_scene *scene, struct change *c, struct br_scene *out)
{
    *out = *scene;
    out->name = copy_text(scene->name, c);
    out->title = copy_text(scene->title, c);
    out->remark = NULL;
    out->axial.solution = out->bending.solution = NULL;
    out->axial.given = out->bending.given = (struct br_function){0};
    memset(out->derived, 0, sizeof out->derived);
    copy_functions(out, c);
    change_all(c, out);
    scale(c, &out->length, dimension_of(out, &out->length));
    scale(c, &out->duration, dimension_of(out, &out->duration));
    return c->status;
}

enum br_status br_rescale(const struct br_scene *scene, const struct br_units_change *units,
                          struct br_scene *out, struct br_error *err)
{
    struct change change = {.to = *units, .err = err};
    return apply(scene, &change, out);
}
