/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/mms/mms.h"

#include <math.h>

#include "solver/laws.h"

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

/* ---- the forces ---- */

static double axial_force(const struct br_tip_parts *p, double t)
{
    return value_of(&p->stress, t) +
           p->contact.stiffness * br_penetration(&p->contact, value_of(&p->u, t));
}

/* At the time when the tip begins to slip, the force of the slip that begins: step() is 1 from zero
 * on, too. */
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

/* ---- what is proved of them ---- */

/* Two roundings at each end. */
static struct br_interval outward(double low, double high)
{
    return (struct br_interval){nextafter(nextafter(low, -INFINITY), -INFINITY),
                                nextafter(nextafter(high, INFINITY), INFINITY)};
}

static struct br_interval hull(struct br_interval a, struct br_interval b)
{
    return (struct br_interval){fmin(a.low, b.low), fmax(a.high, b.high)};
}

static bool add(const struct br_function *f, struct br_box box, struct br_interval term,
                struct br_interval *sum)
{
    struct br_interval value;
    const bool bounded = br_function_bound(f, box, &value);
    *sum = outward(value.low + term.low, value.high + term.high);
    return bounded;
}

/* A force that rises with the penetration, where u is in an interval. */
static struct br_interval between(const struct br_tip_parts *p, struct br_interval u,
                                  double (*force)(const struct br_tip_parts *, double u))
{
    const struct br_interval value = outward(force(p, u.low), force(p, u.high));
    return (struct br_interval){fmax(0, value.low), value.high};
}

static double contact_force(const struct br_tip_parts *p, double u)
{
    return p->contact.stiffness * br_penetration(&p->contact, u);
}

static double bound_at(const struct br_tip_parts *p, double u)
{
    return br_tip_bound(&p->contact, &p->friction, u);
}

static bool axial_bound(const void *self, struct br_box box, struct br_interval *value)
{
    const struct br_tip_parts *p = self;
    struct br_interval u;
    return br_function_bound(&p->u, box, &u) &&
           add(&p->stress, box, between(p, u, contact_force), value);
}

/* The velocity in a box and at the next number after it: friction_force looks there. */
static bool velocity_in(const struct br_tip_parts *p, struct br_box box, struct br_interval *v)
{
    box.t.high = nextafter(box.t.high, INFINITY);
    return br_function_bound(&p->velocity, box, v);
}

static bool bending_bound(const void *self, struct br_box box, struct br_interval *value)
{
    const struct br_tip_parts *p = self;
    struct br_interval u, v, stick;
    if (!br_function_bound(&p->u, box, &u) || !velocity_in(p, box, &v))
        return false;
    const struct br_interval b = between(p, u, bound_at), opposed = {-b.high, -b.low};
    if (v.low > 0 || v.high < 0)
        return add(&p->stress, box, v.low > 0 ? b : opposed, value);
    if (!br_function_bound(&p->stick, box, &stick))
        return false;
    const bool rests = v.low == 0 && v.high == 0;
    return add(&p->stress, box, rests ? stick : hull(stick, hull(b, opposed)), value);
}

/* u - g, whose change of sign makes the contact force bend. */
static bool above_gap_bound(const void *self, struct br_box box, struct br_interval *value)
{
    const struct br_tip_parts *p = self;
    const double g = p->contact.gap;
    return add(&p->u, box, (struct br_interval){-g, -g}, value);
}

static bool above_gap_taylor(const void *self, enum br_variable along, struct br_box box,
                             size_t order, struct br_interval *c)
{
    const struct br_tip_parts *p = self;
    return br_function_taylor(&p->u, along, box, order, c) && above_gap_bound(self, box, c);
}

static void above_gap_evaluate(void *self, size_t count, const double *x, double t, double *value)
{
    const struct br_tip_parts *p = self;
    br_function_evaluate(&p->u, count, x, t, value);
    for (size_t i = 0; i < count; i++)
        value[i] -= p->contact.gap;
}

static const struct br_function_ops above_gap_ops = {
    .evaluate = above_gap_evaluate,
    .bound = above_gap_bound,
    .taylor = above_gap_taylor,
};

enum { MOST_ORDER = 32 };

/* Adds factor times the coefficients of f. */
static bool add_taylor(const struct br_function *f, double factor, struct br_box box, size_t order,
                       struct br_interval *sum)
{
    struct br_interval c[MOST_ORDER + 1];
    if (order > MOST_ORDER || !br_function_taylor(f, BR_T, box, order, c))
        return false;
    for (size_t i = 0; i <= order; i++) {
        const double a = factor * c[i].low, b = factor * c[i].high;
        const struct br_interval term = outward(fmin(a, b), fmax(a, b));
        sum[i] = outward(sum[i].low + term.low, sum[i].high + term.high);
    }
    return true;
}

/* Adds factor times the coefficients of (u - g)_+. */
static bool add_penetration(const struct br_tip_parts *p, double factor, struct br_box box,
                            size_t order, struct br_interval *sum)
{
    struct br_interval above;
    if (factor == 0)
        return true;
    if (!above_gap_bound(p, box, &above) || (above.low <= 0 && above.high >= 0))
        return false;
    return above.high < 0 || add_taylor(&p->above_gap, factor, box, order, sum);
}

static bool axial_taylor(const void *self, enum br_variable along, struct br_box box, size_t order,
                         struct br_interval *c)
{
    const struct br_tip_parts *p = self;
    if (along == BR_X)
        return axial_bound(self, box, c); /* the others are zero */
    return br_function_taylor(&p->stress, BR_T, box, order, c) &&
           add_penetration(p, p->contact.stiffness, box, order, c);
}

static bool bending_taylor(const void *self, enum br_variable along, struct br_box box,
                           size_t order, struct br_interval *c)
{
    const struct br_tip_parts *p = self;
    struct br_interval v;
    if (along == BR_X)
        return bending_bound(self, box, c);
    if (!br_function_taylor(&p->stress, BR_T, box, order, c) || !velocity_in(p, box, &v))
        return false;
    if (v.low == 0 && v.high == 0)
        return add_taylor(&p->stick, 1, box, order, c);
    if (v.low <= 0 && v.high >= 0)
        return false;
    const double b = (v.low > 0 ? 1 : -1) * p->friction.coefficient;
    if (p->friction.law == BR_COULOMB)
        return add_penetration(p, b, box, order, c);
    c[0] = outward(c[0].low + b, c[0].high + b);
    return true;
}

/* Guard *i of f. Or NULL: then *i is reduced by the number of f's guards. */
static const struct br_function *guard_of(const struct br_function *f, size_t *i)
{
    const struct br_function *guard = br_function_guard(f, *i);
    for (size_t count = 0; !guard && br_function_guard(f, count); count++)
        --*i;
    return guard;
}

/* The guards of all parts, u - g, which makes the contact force bend, and the velocity. */
static const struct br_function *guard(const void *self, size_t i)
{
    const struct br_tip_parts *p = self;
    const struct br_function *parts[] = {&p->stress, &p->u, &p->velocity, &p->stick};
    for (size_t k = 0; k < sizeof parts / sizeof *parts; k++) {
        const struct br_function *found = guard_of(parts[k], &i);
        if (found)
            return found;
    }
    return i == 0 ? &p->above_gap : i == 1 ? &p->velocity : NULL;
}

/* ---- as functions ---- */

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

/* The guard borrows the parts. */
static void settle(struct br_tip_parts *p)
{
    p->above_gap = (struct br_function){.ops = &above_gap_ops, .self = p, .uses_t = p->u.uses_t};
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
    settle(copy);
    return copy;
}

static const struct br_function_ops axial_ops = {
    .evaluate = axial_evaluate,
    .clone = parts_clone,
    .free = parts_free,
    .bound = axial_bound,
    .taylor = axial_taylor,
    .guard = guard,
};
static const struct br_function_ops bending_ops = {
    .evaluate = bending_evaluate,
    .clone = parts_clone,
    .free = parts_free,
    .bound = bending_bound,
    .taylor = bending_taylor,
    .guard = guard,
};

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
    settle(own);
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
