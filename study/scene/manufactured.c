/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The method of manufactured solutions: a scene whose loads, tip forces and initial data are
 * derived from a solution that is given (Roache 2002; Oberkampf and Roy 2010). */
#include "solver/laws.h"
#include "study/known/expression.h"

#include <float.h>
#include <math.h>

#include "reference/mms/mms.h"

/* ---- what the solution determines must not be given ---- */

static enum br_status check_free(struct br_scene *s, enum br_field_kind kind, struct br_error *err)
{
    const struct br_scene_field *f = &s->field[kind];
    const struct {
        const char *key;
        const struct br_function *function;
    } given[] = {
        {"load", &f->load.term[0].space},   {"load", &f->load.term[0].time},
        {"tip_force", &f->tip_force},       {"tip_moment", &f->tip_moment},
        {"displacement", &f->displacement}, {"displacement_slope", &f->displacement_slope},
        {"velocity", &f->velocity},         {"velocity_slope", &f->velocity_slope},
    };
    for (size_t i = 0; i < sizeof given / sizeof *given; i++)
        if (!br_function_is_zero(given[i].function))
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

/* ---- the tip force that makes a given solution fulfil the laws (8), (10), (11), (12) ---- */

/* What it is made of: functions of t. */
struct parts {
    struct br_function stress;   /* N: a1 u_x + c1 u_xt, or -(a2 w_xxx + c2 w_xxxt) */
    struct br_function u;        /* u(L, t), m */
    struct br_function velocity; /* w_t(L, t), m/s; bending only */
};

/* A function in the tree, with a node of it in the place of t; BR_NO_NODE: t. */
static unsigned graft(struct br_tree_builder *b, const struct br_function *f, unsigned t)
{
    const struct br_tree *tree = br_tree_of(f);
    return tree ? br_tree_substitute(b, tree, (unsigned)tree->count - 1, BR_NO_NODE, t)
                : br_tree_number(b, f->constant);
}

/* factor * (u - g)_+ */
static unsigned pressed(struct br_tree_builder *b, const struct br_scene *s,
                        const struct br_function *u, double factor)
{
    if (factor == 0)
        return br_tree_number(b, 0);
    const unsigned depth = br_tree_node(b, BR_OP_SUBTRACT, graft(b, u, BR_NO_NODE),
                                        br_tree_number(b, s->contact.gap), 0);
    return br_tree_node(b, BR_OP_MULTIPLY, br_tree_number(b, factor),
                        br_tree_node(b, BR_OP_MAX, depth, br_tree_number(b, 0), 0), 0);
}

/* The number after t, or the one after that. */
static unsigned after_t(struct br_tree_builder *b)
{
    const unsigned t = br_tree_node(b, BR_OP_T, 0, 0, 0);
    return br_tree_node(b, BR_OP_ADD,
                        br_tree_node(b, BR_OP_MULTIPLY, t, br_tree_number(b, 1 + DBL_EPSILON), 0),
                        br_tree_number(b, DBL_TRUE_MIN), 0);
}

/* The friction's bound by law. */
static unsigned tresca(struct br_tree_builder *b, const struct br_scene *s, const struct parts *p)
{
    (void)p;
    return br_tree_number(b, s->friction.coefficient);
}

static unsigned coulomb(struct br_tree_builder *b, const struct br_scene *s, const struct parts *p)
{
    return pressed(b, s, &p->u, s->friction.coefficient);
}

static unsigned (*const bounds[BR_FRICTION_LAWS])(struct br_tree_builder *, const struct br_scene *,
                                                  const struct parts *) = {
    [BR_TRESCA] = tresca,
    [BR_COULOMB] = coulomb,
};

/* lambda is h sign(w_t), or the stick force where w_t is zero. At the time when the tip begins to
 * slip, the force of the slip that begins: step() is 1 from zero on, too. */
static unsigned friction(struct br_tree_builder *b, const struct br_scene *s, const struct parts *p)
{
    const unsigned bound = bounds[s->friction.law](b, s, p);
    const unsigned velocity = graft(b, &p->velocity, after_t(b));
    const unsigned slip =
        br_tree_node(b, BR_OP_MULTIPLY, br_tree_node(b, BR_OP_SIGN, velocity, 0, 0), bound, 0);
    return br_tree_node(b, BR_OP_CHOOSE, velocity, slip,
                        graft(b, &s->bending.stick_force, BR_NO_NODE));
}

/* stress + c_H (u - g)_+, from (8) and (10), or + lambda, from (11) and (12) */
static enum br_status add_law(const struct br_scene *s, enum br_field_kind kind,
                              const struct parts *p, struct br_function *f, struct br_error *err)
{
    struct br_tree_builder b = {0};
    struct br_tree tree;
    const unsigned force = kind == BR_AXIAL
                               ? pressed(&b, s, &p->u, br_contact_stiffness(&s->contact))
                               : friction(&b, s, p);
    const unsigned sum = br_tree_node(&b, BR_OP_ADD, graft(&b, &p->stress, BR_NO_NODE), force, 0);
    const enum br_status status = br_tree_finish(&b, sum, &tree, err);
    return status ? status : br_tree_function(&tree, f, err);
}

/* The tip force (out) of a given solution, with its law if there is one. */
static enum br_status make_tip_force(const struct br_scene *s, enum br_field_kind kind,
                                     struct br_function *f, struct br_error *err)
{
    const bool axial = kind == BR_AXIAL;
    const struct br_scene_field *d = &s->field[kind];
    const double sign = axial ? 1 : -1;
    const struct br_derivation u = one_term(0, 0, s->length, NAN),
                               v = one_term(0, 1, s->length, NAN),
                               stress = stress_at_tip(s, sign * d->stiffness, sign * d->viscosity,
                                                      axial ? 1 : 3);
    if (!(axial ? s->contact.modelled : br_friction_rubs(&s->friction)))
        return br_function_derive(&d->given, &stress, f, err);
    struct parts p = {.u = {0}};
    if (!axial && !bounds[s->friction.law])
        return br_fail(err, BR_BAD_INPUT, "found it beside %s's law of friction, expected another",
                       br_friction_models[s->friction.law].title);
    enum br_status status = br_function_derive(&d->given, &stress, &p.stress, err);
    if (!status && (axial || br_friction_follows_contact(&s->friction)))
        status = br_function_derive(&s->axial.given, &u, &p.u, err);
    if (!status && !axial)
        status = br_function_derive(&d->given, &v, &p.velocity, err);
    if (!status && !axial)
        status = br_stick_check(s, &p.u, &p.velocity, err);
    if (!status)
        status = add_law(s, kind, &p, f, err);
    br_function_free(&p.stress);
    br_function_free(&p.u);
    br_function_free(&p.velocity);
    return status;
}

/* ---- all that is derived from a solution ---- */

/* Without density there is no initial velocity: it follows from the load. */
static enum br_status make_data(struct br_scene *s, enum br_field_kind kind, struct br_error *err)
{
    struct br_scene_field *a = &s->axial, *b = &s->bending, *f = &s->field[kind];
    const struct {
        enum br_field_kind kind;
        bool moving; /* a velocity */
        struct br_function *function;
        struct br_derivation sum;
    } data[] = {
        {BR_AXIAL, false, &a->load.term[0].space,
         load_of(s->density, -a->stiffness, -a->viscosity, 2)},
        {BR_AXIAL, false, &a->displacement, one_term(0, 0, NAN, 0)},
        {BR_AXIAL, true, &a->velocity, one_term(0, 1, NAN, 0)},
        {BR_BENDING, false, &b->load.term[0].space,
         load_of(s->density, b->stiffness, b->viscosity, 4)},
        {BR_BENDING, false, &b->tip_moment, stress_at_tip(s, b->stiffness, b->viscosity, 2)},
        {BR_BENDING, false, &b->displacement, one_term(0, 0, NAN, 0)},
        {BR_BENDING, false, &b->displacement_slope, one_term(1, 0, NAN, 0)},
        {BR_BENDING, true, &b->velocity, one_term(0, 1, NAN, 0)},
        {BR_BENDING, true, &b->velocity_slope, one_term(1, 1, NAN, 0)},
    };
    enum br_status status = BR_OK;
    f->load.term[0].time = (struct br_function){.constant = 1};
    for (size_t i = 0; i < sizeof data / sizeof *data && !status; i++)
        if (data[i].kind == kind && (s->density > 0 || !data[i].moving))
            status = br_function_derive(&f->given, &data[i].sum, data[i].function, err);
    return status ? status : make_tip_force(s, kind, &f->tip_force, err);
}

static enum br_status check_given(struct br_scene *s, enum br_field_kind kind, struct br_error *err)
{
    const struct br_function *f = &s->field[kind].given;
    return br_given_check(&(struct br_given){f, kind, s->length, s->duration}, err);
}

/* Every part that is modelled has a solution, and nothing beside it; all are checked before the
 * first is used. */
enum br_status br_manufactured_apply(struct br_scene *s, enum br_field_kind *culprit,
                                     struct br_error *err)
{
    static enum br_status (*const pass[])(struct br_scene *, enum br_field_kind,
                                          struct br_error *) = {check_free, check_given, make_data};
    const bool has[] = {s->axial.solution, s->bending.solution};
    enum br_status status = BR_OK;
    if (!has[BR_AXIAL] && !has[BR_BENDING])
        return BR_OK;
    *culprit = has[BR_AXIAL] ? BR_AXIAL : BR_BENDING;
    if (s->axial.modelled && s->bending.modelled && !(has[BR_AXIAL] && has[BR_BENDING]))
        return br_fail(err, BR_BAD_INPUT, "found none in %s, expected one in every part",
                       has[BR_AXIAL] ? "bending" : "axial");
    for (size_t i = 0; i < sizeof pass / sizeof *pass; i++)
        for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING && !status; kind++)
            if (has[kind]) {
                *culprit = kind;
                status = pass[i](s, kind, err);
            }
    return status;
}
