/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/mms/tip.h"

#include <math.h>

#include "solver/contact.h"
#include "solver/friction.h"

static double value_of(const struct br_function *f, double t)
{
    const double x = 0; /* of t alone */
    double value;
    br_function_evaluate(f, 1, &x, t, &value);
    return value;
}

double br_tip_bound(const struct br_contact *contact, const struct br_friction *friction, double u)
{
    const struct br_scene laws = {.contact = *contact, .friction = *friction};
    return br_friction_bound(&laws, br_penetration(contact, u));
}

static double axial_force(const struct br_tip_parts *p, double t)
{
    return value_of(&p->stress, t) +
           p->contact.stiffness * br_penetration(&p->contact, value_of(&p->u, t));
}

/* Where the tip begins to slip, as from there on: as step is 1 from zero on. */
static double friction_force(const struct br_tip_parts *p, double t)
{
    double velocity = value_of(&p->velocity, t);
    if (velocity == 0)
        velocity = value_of(&p->velocity, nextafter(t, INFINITY));
    if (velocity == 0)
        return value_of(&p->stick, t);
    const double bound = br_tip_bound(&p->contact, &p->friction, value_of(&p->u, t));
    return velocity > 0 ? bound : -bound;
}

static double bending_force(const struct br_tip_parts *p, double t)
{
    return value_of(&p->stress, t) + friction_force(p, t);
}

static void axial_evaluate(void *self, size_t count, const double *x, double t, double *value)
{
    (void)x;
    for (size_t i = 0; i < count; i++)
        value[i] = axial_force(self, t);
}

static void bending_evaluate(void *self, size_t count, const double *x, double t, double *value)
{
    (void)x;
    for (size_t i = 0; i < count; i++)
        value[i] = bending_force(self, t);
}

void br_tip_parts_clear(struct br_tip_parts *p)
{
    br_function_free(&p->stress);
    br_function_free(&p->u);
    br_function_free(&p->velocity);
    br_function_free(&p->stick);
}

static void parts_free(void *self)
{
    if (self)
        br_tip_parts_clear(self);
    free(self);
}

static void *parts_clone(const void *self)
{
    const struct br_tip_parts *p = self;
    struct br_tip_parts *copy = br_allocate(1, sizeof *copy);
    if (!copy)
        return NULL;
    copy->contact = p->contact;
    copy->friction = p->friction;
    if (br_function_clone(&p->stress, &copy->stress, NULL) ||
        br_function_clone(&p->u, &copy->u, NULL) ||
        br_function_clone(&p->velocity, &copy->velocity, NULL) ||
        br_function_clone(&p->stick, &copy->stick, NULL)) {
        parts_free(copy);
        return NULL;
    }
    return copy;
}

static const struct br_function_ops axial_ops = {
    .evaluate = axial_evaluate, .clone = parts_clone, .free = parts_free};
static const struct br_function_ops bending_ops = {
    .evaluate = bending_evaluate, .clone = parts_clone, .free = parts_free};

static enum br_status take_over(struct br_tip_parts *parts, const struct br_function_ops *ops,
                                struct br_function *f, struct br_error *err)
{
    *f = (struct br_function){0};
    struct br_tip_parts *own = br_allocate(1, sizeof *own);
    if (!own) {
        br_tip_parts_clear(parts);
        return br_no_memory(err, "a tip force");
    }
    *own = *parts;
    *parts = (struct br_tip_parts){0};
    *f = (struct br_function){.ops = ops, .self = own, .uses_t = true};
    return BR_OK;
}

enum br_status br_tip_axial(struct br_tip_parts *parts, struct br_function *f, struct br_error *err)
{
    return take_over(parts, &axial_ops, f, err);
}

enum br_status br_tip_bending(struct br_tip_parts *parts, struct br_function *f,
                              struct br_error *err)
{
    return take_over(parts, &bending_ops, f, err);
}
