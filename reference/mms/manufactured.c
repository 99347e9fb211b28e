/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/mms/mms.h"

#include <math.h>

/* ---- what the solution determines must not be given ---- */

struct given {
    const char *key;
    const struct br_function *function;
};

static enum br_status refuse_given(const struct given *given, size_t count, struct br_error *err)
{
    for (size_t i = 0; i < count; i++)
        if (!br_function_is_zero(given[i].function))
            return br_fail(err, BR_BAD_INPUT,
                           "found '%s' beside it, expected none: it is derived from the solution",
                           given[i].key);
    return BR_OK;
}

static enum br_status check_axial_free(const struct br_axial *a, struct br_error *err)
{
    const struct given given[] = {
        {"load", &a->load.term[0].space}, {"load", &a->load.term[0].time},
        {"tip_force", &a->tip_force},     {"displacement", &a->displacement},
        {"velocity", &a->velocity},
    };
    return refuse_given(given, sizeof given / sizeof *given, err);
}

static enum br_status check_bending_free(const struct br_bending *b, struct br_error *err)
{
    const struct given given[] = {
        {"load", &b->load.term[0].space},   {"load", &b->load.term[0].time},
        {"tip_force", &b->tip_force},       {"tip_moment", &b->tip_moment},
        {"displacement", &b->displacement}, {"displacement_slope", &b->displacement_slope},
        {"velocity", &b->velocity},         {"velocity_slope", &b->velocity_slope},
    };
    return refuse_given(given, sizeof given / sizeof *given, err);
}

/* ---- the data of each field ---- */

static const struct br_partial value = {0, 0}, slope = {1, 0};
static const struct br_partial rate = {0, 1}, slope_rate = {1, 1};

/* d^order of the solution, at x and t (NaN: free), times a factor */
static enum br_status one_term(double factor, struct br_partial order,
                               const struct br_function *solution, double x, double t,
                               struct br_function *f, struct br_error *err)
{
    const struct br_derivation sum = {1, {{factor, order}}, x, t};
    return br_function_derive(solution, &sum, f, err);
}

/* a d^order + c d/dt d^order at x = L: a stress with the signs of its factors */
static enum br_status stress_at_tip(const struct br_scene *s, const struct br_function *solution,
                                    double elastic, double viscous, int order,
                                    struct br_function *f, struct br_error *err)
{
    const struct br_derivation sum = {
        2, {{elastic, {order, 0}}, {viscous, {order, 1}}}, s->length, NAN};
    return br_function_derive(solution, &sum, f, err);
}

/* f_H = rho u_tt - (a1 u_xx + c1 u_xxt), f_V = rho w_tt + a2 w_xxxx + c2 w_xxxxt */
static enum br_status make_load(const struct br_function *solution, double density, double elastic,
                                double viscous, int order, struct br_load *load,
                                struct br_error *err)
{
    const struct br_derivation sum = {
        3, {{density, {0, 2}}, {elastic, {order, 0}}, {viscous, {order, 1}}}, NAN, NAN};
    load->term[0].time = (struct br_function){.constant = 1};
    return br_function_derive(solution, &sum, &load->term[0].space, err);
}

/* a1 u_x + c1 u_xt + c_H (u - g)_+ at x = L, from (8) and (10) */
static enum br_status make_axial_tip(struct br_scene *s, struct br_error *err)
{
    struct br_axial *a = &s->axial;
    if (!s->contact.modelled)
        return stress_at_tip(s, &a->given, a->stiffness, a->viscosity, 1, &a->tip_force, err);
    struct br_tip_parts parts = {.contact = s->contact};
    enum br_status status =
        stress_at_tip(s, &a->given, a->stiffness, a->viscosity, 1, &parts.stress, err);
    if (!status)
        status = one_term(1, value, &a->given, s->length, NAN, &parts.u, err);
    if (!status)
        return br_tip_axial(&parts, &a->tip_force, err);
    br_tip_parts_clear(&parts);
    return status;
}

/* What the friction law takes: u(L, t), w_t(L, t), and the stick force. */
static enum br_status make_friction_parts(const struct br_scene *s, struct br_tip_parts *parts,
                                          struct br_error *err)
{
    parts->contact = s->contact;
    parts->friction = s->friction;
    enum br_status status =
        one_term(1, rate, &s->bending.given, s->length, NAN, &parts->velocity, err);
    if (!status && s->friction.law == BR_COULOMB)
        status = one_term(1, value, &s->axial.given, s->length, NAN, &parts->u, err);
    if (!status)
        status = br_stick_check(s, &parts->u, &parts->velocity, err);
    if (!status)
        status = br_function_clone(&s->bending.stick_force, &parts->stick, err);
    return status;
}

/* lambda - (a2 w_xxx + c2 w_xxxt) at x = L, from (11) and (12) */
static enum br_status make_bending_tip(struct br_scene *s, struct br_error *err)
{
    struct br_bending *b = &s->bending;
    if (s->friction.law == BR_FRICTIONLESS)
        return stress_at_tip(s, &b->given, -b->stiffness, -b->viscosity, 3, &b->tip_force, err);
    struct br_tip_parts parts = {0};
    enum br_status status =
        stress_at_tip(s, &b->given, -b->stiffness, -b->viscosity, 3, &parts.stress, err);
    if (!status)
        status = make_friction_parts(s, &parts, err);
    if (!status)
        return br_tip_bending(&parts, &b->tip_force, err);
    br_tip_parts_clear(&parts);
    return status;
}

/* Without density there is no initial velocity: it follows from the load. */
static enum br_status make_axial(struct br_scene *s, struct br_error *err)
{
    struct br_axial *a = &s->axial;
    enum br_status status =
        make_load(&a->given, s->density, -a->stiffness, -a->viscosity, 2, &a->load, err);
    if (!status)
        status = make_axial_tip(s, err);
    if (!status)
        status = one_term(1, value, &a->given, NAN, 0, &a->displacement, err);
    if (!status && s->density > 0)
        status = one_term(1, rate, &a->given, NAN, 0, &a->velocity, err);
    return status;
}

static enum br_status make_bending(struct br_scene *s, struct br_error *err)
{
    struct br_bending *b = &s->bending;
    enum br_status status =
        make_load(&b->given, s->density, b->stiffness, b->viscosity, 4, &b->load, err);
    if (!status)
        status = make_bending_tip(s, err);
    if (!status)
        status = stress_at_tip(s, &b->given, b->stiffness, b->viscosity, 2, &b->tip_moment, err);
    if (!status)
        status = one_term(1, value, &b->given, NAN, 0, &b->displacement, err);
    if (!status)
        status = one_term(1, slope, &b->given, NAN, 0, &b->displacement_slope, err);
    if (!status && s->density > 0)
        status = one_term(1, rate, &b->given, NAN, 0, &b->velocity, err);
    if (!status && s->density > 0)
        status = one_term(1, slope_rate, &b->given, NAN, 0, &b->velocity_slope, err);
    return status;
}

/* ---- both ---- */

static const struct br_function *solution_of(const struct br_scene *s, enum br_field_kind kind)
{
    return kind == BR_AXIAL ? &s->axial.given : &s->bending.given;
}

/* Every part that is modelled has a solution, and nothing beside it. */
static enum br_status check_parts(const struct br_scene *s, enum br_field_kind *culprit,
                                  struct br_error *err)
{
    *culprit = s->axial.solution ? BR_AXIAL : BR_BENDING;
    if (s->axial.modelled && s->bending.modelled && !(s->axial.solution && s->bending.solution))
        return br_fail(err, BR_BAD_INPUT, "found none in %s, expected one in every part",
                       s->axial.solution ? "bending" : "axial");
    *culprit = BR_AXIAL;
    const enum br_status status = check_axial_free(&s->axial, err);
    if (status)
        return status;
    *culprit = BR_BENDING;
    return check_bending_free(&s->bending, err);
}

enum br_status br_manufactured_apply(struct br_scene *s, enum br_field_kind *culprit,
                                     struct br_error *err)
{
    if (!s->axial.solution && !s->bending.solution)
        return BR_OK;
    enum br_status status = check_parts(s, culprit, err);
    for (int kind = BR_AXIAL; kind <= BR_BENDING && !status; kind++) {
        *culprit = (enum br_field_kind)kind;
        const struct br_given solution = {solution_of(s, *culprit), *culprit, s->length,
                                          s->duration};
        if (kind == BR_AXIAL ? s->axial.solution : s->bending.solution)
            status = br_given_check(&solution, err);
    }
    if (status)
        return status;
    *culprit = BR_AXIAL;
    if (s->axial.solution)
        status = make_axial(s, err);
    if (status || !s->bending.solution)
        return status;
    *culprit = BR_BENDING;
    return make_bending(s, err);
}
