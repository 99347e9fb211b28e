/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which order theory states.
 *
 * In h, at one k. Each time step is an elliptic problem, so elements of degree p in a form with m
 * derivatives have order p + 1 - m in the energy norm (Strang and Fix, An Analysis of the Finite
 * Element Method, 1973, Theorem 3.7), and in L2 p + 1, by duality (Aubin 1967, Nitsche 1968); at
 * the nodes, where Green's function is smooth on either side, 2 (p + 1 - m) (Douglas and Dupont
 * 1974). Linear elements without mass are right at the nodes: they contain Green's function.
 *
 *   - This needs data that are smooth inside the elements. Loads are integrated by Gauss' rule. A
 *     jump inside an element costs it O(h), which depends on where in the element it is, a kink
 *     O(h^2). Initial data are interpolated: a kink leaves O(h^(3/2)) in L2.
 *   - A bound that follows the contact, as Coulomb's, c_V (u(L) - g)_+, uses u(L), which has the
 * order of the rod's tip, 2 for linear elements with mass. Friction is Lipschitz in its bound and
 * works on the whole beam. So the error of w is A h^2 + B h^4, and its order anything from 2 to 4:
 * 2 as h -> 0, but 4 as long as A h^2, which is proportional to the rod's mass, is small. Laws at
 * the tip are Lipschitz, so switching costs no order in h.
 *
 * In k, on one mesh. A scheme has its order where the solution is smooth in time. The lagged
 * contact takes its force one step late, O(k): Campo et al. (2006), Theorem 2.3 and Remark 2.5 with
 * order 1. Where the tip switches (stick, slip, contact opens or closes) forces have a kink, and
 * their derivatives jump: order 1 stays, higher ones do not, and what remains depends on where in
 * the step the time of switching lies. A load that jumps inside a step acts as one that jumps at
 * its end: O(k), which depends on the place, too. */
#include "study/fit/theory.h"

#include <math.h>
#include <stdio.h>

#include "solver/laws.h"

enum { DERIVATIVES = 4 };
static const double beside = 1e-9; /* of a cell: what lies nearer to its end is at its end */

static struct br_theory of_order(double order)
{
    return (struct br_theory){.order = order, .highest = order, .formal = order};
}

static struct br_theory none(double formal, const char *reason)
{
    struct br_theory t = {.order = NAN, .highest = NAN, .formal = formal};
    snprintf(t.reason, sizeof t.reason, "%s", reason);
    return t;
}

/* ---- data ---- */

/* Whether f is proved to be smooth along a variable inside each of `cells` equal cells. A function
 * with switching functions may break between them. One without, as sqrt, is smooth at their ends,
 * too. */
static bool is_smooth(const struct br_function *f, enum br_variable along, size_t cells,
                      const struct br_scene *s)
{
    const double size = (along == BR_X ? s->length : s->duration) / (double)cells;
    const double inset = br_function_switching(f, 0) && cells > 1 ? beside : 0;
    bool smooth = true;
    if (!f->ops || !(along == BR_X ? f->uses_x : f->uses_t))
        return true;
    for (size_t i = 0; i < cells && smooth; i++) {
        const struct br_interval part = {((double)i + inset) * size,
                                         ((double)i + 1 - inset) * size};
        struct br_box box = {{0, s->length}, {0, s->duration}};
        struct br_interval coefficient[DERIVATIVES + 1];
        *(along == BR_X ? &box.x : &box.t) = part;
        smooth = br_function_taylor(f, along, box, DERIVATIVES, coefficient);
    }
    return smooth;
}

/* How many of f's value and first derivatives in t vanish at t = 0 for all x. */
static int zeros_at_start(const struct br_function *f, const struct br_scene *s)
{
    const struct br_box start = {{0, s->length}, {0, 0}};
    struct br_interval c[DERIVATIVES + 1];
    int zeros = 0;
    if (br_function_is_zero(f))
        return DERIVATIVES;
    if (!f->ops || !br_function_taylor(f, BR_T, start, DERIVATIVES, c))
        return 0;
    while (zeros < DERIVATIVES && c[zeros].low == 0 && c[zeros].high == 0)
        zeros++;
    return zeros;
}

static bool starts_at_rest(const struct br_scene_field *d)
{
    return d->solution ||
           (br_function_is_zero(&d->displacement) && br_function_is_zero(&d->velocity));
}

/* ---- what a norm measures ---- */

/* A rate has a derivative in time, which starts with one order less. */
enum { IS_RATE = 1, AT_TIP = 2 };

static int what_is(enum br_measure measure)
{
    switch (measure) {
    case BR_DISPLACEMENT:
    case BR_MEASURES:
        break;
    case BR_VELOCITY:
    case BR_STRAIN_RATE:
        return IS_RATE;
    case BR_TIP:
        return AT_TIP;
    }
    return 0;
}

/* ---- in h ---- */

/* Of a field whose laws leave its order. */
static struct br_theory of_elements(const struct br_study *s, enum br_field_kind kind)
{
    const struct br_scene *scene = s->scene;
    const struct br_scene_field *d = &scene->field[kind];
    const int degree = kind == BR_AXIAL ? s->method.axial_degree : 3,
              derivatives = kind == BR_AXIAL ? 1 : 2;
    bool smooth = is_smooth(&d->displacement, BR_X, s->n[0], scene) &&
                  is_smooth(&d->velocity, BR_X, s->n[0], scene);
    for (size_t i = 0; i < BR_LOAD_TERMS && smooth; i++)
        smooth = is_smooth(&d->load.term[i].space, BR_X, s->n[0], scene);
    const bool tip = what_is(s->norm->level) & AT_TIP;
    const double order =
        tip ? 2 * (degree + 1 - derivatives)
            : degree + 1 - (br_norm_needs(s->norm, BR_STRAIN_RATE) ? derivatives : 0);
    if (s->method.scheme->adaptive)
        return none(order, "each mesh has time steps of its own");
    if (!smooth)
        return none(order, "loads or initial data are not smooth inside elements");
    if (degree > 1 && !starts_at_rest(d))
        return none(order, "initial data start a boundary layer");
    if (tip && scene->density == 0 && degree < 2 * derivatives)
        return none(order, "without mass, the elements are exact at the tip");
    return of_order(order);
}

static struct br_theory of_beam(const struct br_study *s)
{
    struct br_theory t = of_elements(s, BR_BENDING);
    struct br_study rod = *s;
    rod.norm = &br_norm_tip;
    const struct br_theory bound = of_elements(&rod, BR_AXIAL);
    const struct br_friction *friction = &s->scene->friction;
    const bool exact = s->scene->density == 0 && s->method.axial_degree == 1;
    if (!br_friction_follows_contact(friction) || br_friction_bound(s->scene, 1) == 0 || exact ||
        isnan(t.order) || bound.order >= t.order)
        return t;
    const char *title = br_friction_models[friction->law].title;
    t.order = bound.order;
    if (isnan(bound.order)) {
        t.highest = NAN;
        snprintf(t.reason, sizeof t.reason,
                 "%s's bound uses u(L) of a rod whose data are not smooth", title);
    } else
        snprintf(t.reason, sizeof t.reason,
                 "%s's bound uses u(L) of linear elements, accurate to h^2; --axial-degree 2 "
                 "gives %g",
                 title, t.highest);
    return t;
}

/* The lower one. */
static struct br_theory in_h(const struct br_study *s, enum br_part part)
{
    const bool rod = s->scene->axial.modelled && br_part_has(part, BR_AXIAL),
               beam = s->scene->bending.modelled && br_part_has(part, BR_BENDING);
    const struct br_theory u = rod ? of_elements(s, BR_AXIAL) : of_order(INFINITY);
    const struct br_theory w = beam ? of_beam(s) : of_order(INFINITY);
    if (isnan(u.order) || !beam)
        return u;
    if (isnan(w.order) || !rod)
        return w;
    return u.order <= w.order ? u : w;
}

/* ---- in k ---- */

/* Why a field's data give a scheme of this order no order; NULL: they do not. `zeros`: how many of
 * the loads' value and derivatives have to vanish at t = 0, unless a solution is given. */
static const char *what_spoils(const struct br_scene *s, enum br_field_kind kind, int zeros)
{
    const struct br_scene_field *d = &s->field[kind];
    bool smooth = is_smooth(&d->tip_force, BR_T, 1, s) && is_smooth(&d->tip_moment, BR_T, 1, s);
    int vanish = DERIVATIVES;
    for (size_t i = 0; i < BR_LOAD_TERMS; i++) {
        const struct br_product *p = &d->load.term[i];
        const int of = zeros_at_start(&p->space, s) + zeros_at_start(&p->time, s);
        smooth = smooth && is_smooth(&p->space, BR_T, 1, s) && is_smooth(&p->time, BR_T, 1, s);
        vanish = of < vanish ? of : vanish;
    }
    if (!smooth)
        return "forces are not smooth in time";
    if (!starts_at_rest(d))
        return "initial data start a motion that no time step resolves";
    return d->solution || (vanish >= zeros && zeros_at_start(&d->tip_force, s) >= zeros &&
                           zeros_at_start(&d->tip_moment, s) >= zeros)
               ? NULL
               : "forces start suddenly, which no time step resolves";
}

static struct br_theory in_k(const struct br_study *s, enum br_part part)
{
    const struct br_scene *scene = s->scene;
    const int order = s->method.scheme->order;
    const bool beam = scene->bending.modelled && br_part_has(part, BR_BENDING),
               rod = scene->axial.modelled &&
                     (br_part_has(part, BR_AXIAL) || br_friction_follows_contact(&scene->friction)),
               contact = scene->contact.modelled && rod,
               lags = contact && !s->method.contact->at_new_step;
    const int zeros = (what_is(s->norm->level) & IS_RATE) + (lags ? 1 : order) - 1;
    const char *why = rod ? what_spoils(scene, BR_AXIAL, zeros) : NULL;
    if (s->method.scheme->adaptive)
        why = "the scheme chooses its own steps";
    if (!why && beam)
        why = what_spoils(scene, BR_BENDING, zeros);
    if (!why && order > 1 && !lags && (contact || (beam && br_friction_rubs(&scene->friction))))
        why = "the tip may switch inside a time step, which lowers orders above 1";
    return why ? none(lags ? 1 : order, why) : of_order(lags ? 1 : order);
}

struct br_theory br_theory_of(const struct br_study *s, enum br_part part, enum br_axis axis)
{
    return axis == BR_AXIS_SPACE ? in_h(s, part) : in_k(s, part);
}
