/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/mms/mms.h"

#include <math.h>

#include "solver/laws.h"

/* ---- the tip force that makes a given solution fulfil the laws (8), (10), (11), (12) ---- */

/* What it is made of: functions of t. */
struct parts {
    enum br_field_kind kind;
    struct br_function stress;   /* N: a1 u_x + c1 u_xt, or -(a2 w_xxx + c2 w_xxxt) */
    struct br_function u;        /* u(L, t), m */
    struct br_function velocity; /* w_t(L, t), m/s; bending only */
    struct br_function stick;    /* lambda while that is zero, N; bending only */
    struct br_contact contact;
    struct br_friction friction;
    struct br_function above_gap; /* u - g, m; made from u, owns nothing */
};

static double contact_force(const struct parts *p, double u)
{
    return p->contact.stiffness * br_penetration(&p->contact, u);
}

/* The friction bound b(t), N. */
static double bound_at(const struct parts *p, double u)
{
    const struct br_scene laws = {.contact = p->contact, .friction = p->friction};
    return br_friction_bound(&laws, br_penetration(&p->contact, u));
}

/* lambda is b sign(w_t), or the stick force where w_t is zero. At the time when the tip begins to
 * slip, the force of the slip that begins: step() is 1 from zero on, too. */
static double friction_force(const struct parts *p, double t)
{
    double velocity = br_function_at(&p->velocity, 0, t);
    if (velocity == 0)
        velocity = br_function_at(&p->velocity, 0, nextafter(t, INFINITY));
    if (velocity == 0)
        return br_function_at(&p->stick, 0, t);
    const double bound = bound_at(p, br_function_at(&p->u, 0, t));
    return velocity > 0 ? bound : -bound;
}

/* stress + c_H (u - g)_+, from (8) and (10), or + lambda, from (11) and (12) */
static void evaluate(void *self, size_t count, const double *x, double t, double *value)
{
    const struct parts *p = self;
    (void)x;
    const double force =
        p->kind == BR_AXIAL ? contact_force(p, br_function_at(&p->u, 0, t)) : friction_force(p, t);
    for (size_t i = 0; i < count; i++)
        value[i] = br_function_at(&p->stress, 0, t) + force;
}

/* ---- what is proved of it ---- */

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
static struct br_interval between(const struct parts *p, struct br_interval u,
                                  double (*force)(const struct parts *, double u))
{
    const struct br_interval value = outward(force(p, u.low), force(p, u.high));
    return (struct br_interval){fmax(0, value.low), value.high};
}

/* The velocity in a box and at the next number after it: friction_force looks there. */
static bool velocity_in(const struct parts *p, struct br_box box, struct br_interval *v)
{
    box.t.high = nextafter(box.t.high, INFINITY);
    return br_function_bound(&p->velocity, box, v);
}

static bool bound(const void *self, struct br_box box, struct br_interval *value)
{
    const struct parts *p = self;
    struct br_interval u, v, stick;
    if (!br_function_bound(&p->u, box, &u))
        return false;
    if (p->kind == BR_AXIAL)
        return add(&p->stress, box, between(p, u, contact_force), value);
    if (!velocity_in(p, box, &v))
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
    const struct parts *p = self;
    const double g = p->contact.gap;
    return add(&p->u, box, (struct br_interval){-g, -g}, value);
}

static bool above_gap_taylor(const void *self, enum br_variable along, struct br_box box,
                             size_t order, struct br_interval *c)
{
    const struct parts *p = self;
    return br_function_taylor(&p->u, along, box, order, c) && above_gap_bound(self, box, c);
}

static void above_gap_evaluate(void *self, size_t count, const double *x, double t, double *value)
{
    const struct parts *p = self;
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
static bool add_penetration(const struct parts *p, double factor, struct br_box box, size_t order,
                            struct br_interval *sum)
{
    struct br_interval above;
    if (factor == 0)
        return true;
    if (!above_gap_bound(p, box, &above) || (above.low <= 0 && above.high >= 0))
        return false;
    return above.high < 0 || add_taylor(&p->above_gap, factor, box, order, sum);
}

static bool taylor(const void *self, enum br_variable along, struct br_box box, size_t order,
                   struct br_interval *c)
{
    const struct parts *p = self;
    struct br_interval v;
    if (along == BR_X)
        return bound(self, box, c); /* the others are zero */
    if (!br_function_taylor(&p->stress, BR_T, box, order, c))
        return false;
    if (p->kind == BR_AXIAL)
        return add_penetration(p, p->contact.stiffness, box, order, c);
    if (!velocity_in(p, box, &v))
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
    const struct parts *p = self;
    const struct br_function *parts[] = {&p->stress, &p->u, &p->velocity, &p->stick};
    for (size_t k = 0; k < sizeof parts / sizeof *parts; k++) {
        const struct br_function *found = guard_of(parts[k], &i);
        if (found)
            return found;
    }
    return i == 0 ? &p->above_gap : i == 1 ? &p->velocity : NULL;
}

/* ---- as a function ---- */

static void parts_free(void *self)
{
    struct parts *p = self;
    if (!p)
        return;
    br_function_free(&p->stress);
    br_function_free(&p->u);
    br_function_free(&p->velocity);
    br_function_free(&p->stick);
    free(p);
}

/* The guard borrows the parts. */
static void settle(struct parts *p)
{
    p->above_gap = (struct br_function){.ops = &above_gap_ops, .self = p, .uses_t = p->u.uses_t};
}

static void *parts_clone(const void *self)
{
    const struct parts *p = self;
    struct parts *copy = br_allocate(1, sizeof *copy);
    if (!copy)
        return NULL;
    copy->kind = p->kind;
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

static const struct br_function_ops parts_ops = {
    .evaluate = evaluate,
    .clone = parts_clone,
    .free = parts_free,
    .bound = bound,
    .taylor = taylor,
    .guard = guard,
};

/* ---- what the solution determines must not be given ---- */

static enum br_status check_free(const struct br_scene *s, enum br_field_kind kind,
                                 struct br_error *err)
{
    const struct br_axial *a = &s->axial;
    const struct br_bending *b = &s->bending;
    const struct {
        enum br_field_kind kind;
        const char *key;
        const struct br_function *function;
    } given[] = {
        {BR_AXIAL, "load", &a->load.term[0].space},
        {BR_AXIAL, "load", &a->load.term[0].time},
        {BR_AXIAL, "tip_force", &a->tip_force},
        {BR_AXIAL, "displacement", &a->displacement},
        {BR_AXIAL, "velocity", &a->velocity},
        {BR_BENDING, "load", &b->load.term[0].space},
        {BR_BENDING, "load", &b->load.term[0].time},
        {BR_BENDING, "tip_force", &b->tip_force},
        {BR_BENDING, "tip_moment", &b->tip_moment},
        {BR_BENDING, "displacement", &b->displacement},
        {BR_BENDING, "displacement_slope", &b->displacement_slope},
        {BR_BENDING, "velocity", &b->velocity},
        {BR_BENDING, "velocity_slope", &b->velocity_slope},
    };
    for (size_t i = 0; i < sizeof given / sizeof *given; i++)
        if (given[i].kind == kind && !br_function_is_zero(given[i].function))
            return br_fail(err, BR_BAD_INPUT,
                           "found '%s' beside it, expected none: it is derived from the solution",
                           given[i].key);
    return BR_OK;
}

/* ---- the data of each field ---- */

/* d^(x + t) of the solution; where it is taken: NaN: free */
static struct br_derivation one_term(int by_x, int by_t, double x, double t)
{
    return (struct br_derivation){1, {{1, {by_x, by_t}}}, x, t};
}

/* a d^order + c d/dt d^order at x = L: a stress with the signs of its factors */
static struct br_derivation stress_at_tip(const struct br_scene *s, double elastic, double viscous,
                                          int order)
{
    return (struct br_derivation){
        2, {{elastic, {order, 0}}, {viscous, {order, 1}}}, s->length, NAN};
}

/* f_H = rho u_tt - (a1 u_xx + c1 u_xxt), f_V = rho w_tt + a2 w_xxxx + c2 w_xxxxt */
static struct br_derivation load_of(double density, double elastic, double viscous, int order)
{
    return (struct br_derivation){
        3, {{density, {0, 2}}, {elastic, {order, 0}}, {viscous, {order, 1}}}, NAN, NAN};
}

/* What the law takes beside the stress: u(L, t), w_t(L, t), and the stick force. */
static enum br_status fill_parts(const struct br_scene *s, struct parts *p, struct br_error *err)
{
    const struct br_derivation u = one_term(0, 0, s->length, NAN),
                               v = one_term(0, 1, s->length, NAN);
    enum br_status status = BR_OK;
    if (p->kind == BR_BENDING)
        status = br_function_derive(&s->bending.given, &v, &p->velocity, err);
    if (!status && (p->kind == BR_AXIAL || s->friction.law == BR_COULOMB))
        status = br_function_derive(&s->axial.given, &u, &p->u, err);
    if (status || p->kind == BR_AXIAL)
        return status;
    status = br_stick_check(s, &p->u, &p->velocity, err);
    return status ? status : br_function_clone(&s->bending.stick_force, &p->stick, err);
}

/* The tip force (out) of a given solution, with its law if there is one. */
static enum br_status make_tip_force(const struct br_scene *s, enum br_field_kind kind,
                                     struct br_function *f, struct br_error *err)
{
    const struct br_axial *a = &s->axial;
    const struct br_bending *b = &s->bending;
    const bool axial = kind == BR_AXIAL;
    const struct br_function *given = axial ? &a->given : &b->given;
    const struct br_derivation stress = axial ? stress_at_tip(s, a->stiffness, a->viscosity, 1)
                                              : stress_at_tip(s, -b->stiffness, -b->viscosity, 3);
    if (!(axial ? s->contact.modelled : s->friction.law != BR_FRICTIONLESS))
        return br_function_derive(given, &stress, f, err);
    struct parts *p = br_allocate(1, sizeof *p);
    if (!p)
        return br_no_memory(err, "a tip force");
    p->kind = kind;
    p->contact = s->contact;
    p->friction = s->friction;
    enum br_status status = br_function_derive(given, &stress, &p->stress, err);
    if (!status)
        status = fill_parts(s, p, err);
    if (status) {
        parts_free(p);
        return status;
    }
    settle(p);
    *f = (struct br_function){.ops = &parts_ops, .self = p, .uses_t = true};
    return BR_OK;
}

/* What is derived from a solution. */
struct datum {
    struct br_function *function; /* out */
    struct br_derivation sum;
};

static enum br_status derive_all(const struct br_function *solution, const struct datum *data,
                                 size_t count, struct br_error *err)
{
    enum br_status status = BR_OK;
    for (size_t i = 0; i < count && !status; i++)
        status = br_function_derive(solution, &data[i].sum, data[i].function, err);
    return status;
}

/* Without density there is no initial velocity: it follows from the load. */
static enum br_status make_axial(struct br_scene *s, struct br_error *err)
{
    struct br_axial *a = &s->axial;
    const struct datum data[] = {
        {&a->load.term[0].space, load_of(s->density, -a->stiffness, -a->viscosity, 2)},
        {&a->displacement, one_term(0, 0, NAN, 0)},
        {&a->velocity, one_term(0, 1, NAN, 0)},
    };
    a->load.term[0].time = (struct br_function){.constant = 1};
    const enum br_status status = derive_all(&a->given, data, s->density > 0 ? 3 : 2, err);
    return status ? status : make_tip_force(s, BR_AXIAL, &a->tip_force, err);
}

static enum br_status make_bending(struct br_scene *s, struct br_error *err)
{
    struct br_bending *b = &s->bending;
    const struct datum data[] = {
        {&b->load.term[0].space, load_of(s->density, b->stiffness, b->viscosity, 4)},
        {&b->tip_moment, stress_at_tip(s, b->stiffness, b->viscosity, 2)},
        {&b->displacement, one_term(0, 0, NAN, 0)},
        {&b->displacement_slope, one_term(1, 0, NAN, 0)},
        {&b->velocity, one_term(0, 1, NAN, 0)},
        {&b->velocity_slope, one_term(1, 1, NAN, 0)},
    };
    b->load.term[0].time = (struct br_function){.constant = 1};
    const enum br_status status = derive_all(&b->given, data, s->density > 0 ? 6 : 4, err);
    return status ? status : make_tip_force(s, BR_BENDING, &b->tip_force, err);
}

/* ---- both ---- */

/* Every part that is modelled has a solution, and nothing beside it. */
static enum br_status check_parts(const struct br_scene *s, enum br_field_kind *culprit,
                                  struct br_error *err)
{
    *culprit = s->axial.solution ? BR_AXIAL : BR_BENDING;
    if (s->axial.modelled && s->bending.modelled && !(s->axial.solution && s->bending.solution))
        return br_fail(err, BR_BAD_INPUT, "found none in %s, expected one in every part",
                       s->axial.solution ? "bending" : "axial");
    *culprit = BR_AXIAL;
    const enum br_status status = check_free(s, BR_AXIAL, err);
    if (status)
        return status;
    *culprit = BR_BENDING;
    return check_free(s, BR_BENDING, err);
}

enum br_status br_manufactured_apply(struct br_scene *s, enum br_field_kind *culprit,
                                     struct br_error *err)
{
    const char *const text[] = {s->axial.solution, s->bending.solution};
    const struct br_function *const given[] = {&s->axial.given, &s->bending.given};
    if (!text[BR_AXIAL] && !text[BR_BENDING])
        return BR_OK;
    enum br_status status = check_parts(s, culprit, err);
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING && !status; kind++) {
        *culprit = kind;
        const struct br_given solution = {given[kind], *culprit, s->length, s->duration};
        if (text[kind])
            status = br_given_check(&solution, err);
    }
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING && !status; kind++) {
        *culprit = kind;
        if (text[kind])
            status = (kind == BR_AXIAL ? make_axial : make_bending)(s, err);
    }
    return status;
}
