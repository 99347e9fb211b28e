/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which order theory states.
 *
 * In h, at one k. Each time step is an elliptic problem, so elements of degree p in a form with m
 * derivatives have order p + 1 - m in the energy norm (Strang and Fix, An Analysis of the Finite
 * Element Method, 1973, Theorem 3.7), and in L2 p + 1, by duality (Aubin 1967, Nitsche 1968); at the
 * nodes, where Green's function is smooth on either side, 2 (p + 1 - m) (Douglas and Dupont 1974).
 * Linear elements without mass are right at the nodes: they contain Green's function.
 *
 *   - This needs data that are smooth inside the elements. Loads are integrated by Gauss' rule. A
 *     jump inside an element costs it O(h), which depends on where in the element it is, a kink
 *     O(h^2). Initial data are interpolated: a kink leaves O(h^(3/2)) in L2.
 *   - Coulomb's bound is c_V (u(L) - g)_+, and u(L) has the order of the rod's tip, 2 for linear
 *     elements with mass. Friction is Lipschitz in its bound and works on the whole beam. So the
 *     error of w is A h^2 + B h^4, and its order anything from 2 to 4: 2 as h -> 0, but 4 as long
 *     as A h^2, which is proportional to the rod's mass, is small. Laws at the tip are Lipschitz,
 *     so switching costs no order in h.
 *
 * In k, on one mesh. A scheme has its order where the solution is smooth in time. The lagged contact
 * takes its force one step late, O(k): Campo et al. (2006), Theorem 2.3 and Remark 2.5 with order 1.
 * Where the tip switches (stick, slip, contact opens or closes) forces have a kink, and their
 * derivatives jump: order 1 stays, higher ones do not, and what remains depends on where in the
 * step the time of switching lies. A load that jumps inside a step acts as one that jumps at its
 * end: O(k), which depends on the place, too. */
#include "study/fit/theory.h"

#include <math.h>
#include <stdio.h>

#include "study/scene/words.h"

enum { DERIVATIVES = 4 };
static const double beside = 1e-9; /* of a cell: what lies nearer to its end is at its end */

static struct br_theory of_order(double order)
{
    return (struct br_theory){.order = order, .highest = order};
}

static struct br_theory none(const char *reason)
{
    struct br_theory t = of_order(NAN);
    snprintf(t.reason, sizeof t.reason, "%s", reason);
    return t;
}

/* ---- data ---- */

/* Whether f is proved to be smooth along a variable inside each of `cells` equal cells. A function
 * with guards may break between them. One without, as sqrt, is smooth at their ends, too. */
static bool is_smooth(const struct br_function *f, enum br_variable along, size_t cells,
                      const struct br_scene *s)
{
    const double length = along == BR_X ? s->length : s->duration;
    const double inset = br_function_guard(f, 0) ? beside : 0;
    bool smooth = true;
    if (!f->ops || !(along == BR_X ? f->uses_x : f->uses_t))
        return true;
    for (size_t i = 0; i < cells && smooth; i++) {
        const double size = length / (double)cells, low = ((double)i + inset) * size;
        const struct br_interval part = {low, low + (1 - 2 * inset) * size};
        const struct br_box box = {along == BR_X ? part : (struct br_interval){0, s->length},
                                   along == BR_T ? part : (struct br_interval){0, s->duration}};
        struct br_interval coefficient[DERIVATIVES + 1];
        smooth = br_function_taylor(f, along, box, DERIVATIVES, coefficient);
    }
    return smooth;
}

static bool load_is_smooth(const struct br_load *load, enum br_variable along, size_t cells,
                           const struct br_scene *s)
{
    bool smooth = true;
    for (size_t i = 0; i < BR_LOAD_TERMS && smooth; i++)
        smooth = is_smooth(&load->term[i].space, along, cells, s) &&
                 is_smooth(&load->term[i].time, along, cells, s);
    return smooth;
}

/* How many of f's value and first derivatives in t vanish at t = 0, for all x; at most DERIVATIVES.
 * Of a constant: all or none. */
static int zeros_at_start(const struct br_function *f, const struct br_scene *s)
{
    const struct br_box start = {{0, s->length}, {0, 0}};
    struct br_interval c[DERIVATIVES + 1];
    int zeros = 0;
    if (br_function_is_zero(f))
        return DERIVATIVES;
    if (!f->ops || !br_function_taylor(f, BR_T, start, DERIVATIVES, c))
        return 0;
    while (zeros < DERIVATIVES && c[zeros].low >= -1e-300 && c[zeros].high <= 1e-300)
        zeros++;
    return zeros;
}

static int load_zeros_at_start(const struct br_load *load, const struct br_scene *s)
{
    int zeros = DERIVATIVES;
    for (size_t i = 0; i < BR_LOAD_TERMS; i++) {
        const struct br_product *p = &load->term[i];
        const int of = zeros_at_start(&p->space, s) + zeros_at_start(&p->time, s);
        zeros = of < zeros ? of : zeros;
    }
    return zeros;
}

/* ---- in h ---- */

static struct br_theory rod_in_h(const struct br_study *s)
{
    const struct br_axial *rod = &s->scene->axial;
    const int p = s->method.axial_degree;
    const size_t cells = s->n[0];
    if (!load_is_smooth(&rod->load, BR_X, cells, s->scene) ||
        !is_smooth(&rod->displacement, BR_X, cells, s->scene) ||
        !is_smooth(&rod->velocity, BR_X, cells, s->scene))
        return none("the rod's data break inside elements");
    if (s->norm->level == br_norm_tip.level)
        return p == 1 && s->scene->density == 0 ? none("linear elements without mass are right at "
                                                       "the tip")
                                                : of_order(2 * p);
    return of_order(s->norm->energy ? p : p + 1);
}

static struct br_theory beam_in_h(const struct br_study *s)
{
    const struct br_scene *scene = s->scene;
    const struct br_bending *beam = &scene->bending;
    const size_t cells = s->n[0];
    if (!load_is_smooth(&beam->load, BR_X, cells, scene) ||
        !is_smooth(&beam->displacement, BR_X, cells, scene) ||
        !is_smooth(&beam->velocity, BR_X, cells, scene))
        return none("the beam's data break inside elements");
    struct br_theory t = of_order(s->norm->energy ? 2 : 4);
    if (scene->friction.law != BR_COULOMB || scene->friction.coefficient == 0)
        return t;
    struct br_study rod = *s;
    rod.norm = &br_norm_tip;
    const struct br_theory bound = rod_in_h(&rod);
    if (isnan(bound.order) && s->method.axial_degree == 1 && scene->density == 0)
        return t;
    if (isnan(bound.order))
        return none("Coulomb's bound takes u(L), and the rod's data break inside elements");
    if (bound.order < t.order) {
        t.order = bound.order;
        snprintf(t.reason, sizeof t.reason,
                 "%g as h -> 0: Coulomb's bound takes u(L) of linear elements; --axial-degree 2 "
                 "gives %g",
                 t.order, t.highest);
    }
    return t;
}

/* ---- in k ---- */

static struct br_theory in_k(const struct br_study *s, enum br_part part)
{
    const struct br_scene *scene = s->scene;
    const struct br_time_scheme *scheme = s->method.scheme;
    const size_t steps = s->steps[0];
    const bool contact = scene->contact.modelled,
               friction = scene->friction.law != BR_FRICTIONLESS && part != BR_PART_AXIAL;
    const bool rod = part != BR_PART_BENDING || scene->friction.law == BR_COULOMB,
               beam = part != BR_PART_AXIAL;
    if (scheme->adaptive)
        return none("the scheme chooses its own steps");
    if ((rod && !(load_is_smooth(&scene->axial.load, BR_T, steps, scene) &&
                  is_smooth(&scene->axial.tip_force, BR_T, steps, scene))) ||
        (beam && !(load_is_smooth(&scene->bending.load, BR_T, steps, scene) &&
                   is_smooth(&scene->bending.tip_force, BR_T, steps, scene) &&
                   is_smooth(&scene->bending.tip_moment, BR_T, steps, scene))))
        return none("forces break inside time steps");
    const int needed = (s->norm->energy ? 1 : 0) + scheme->order - 1;
    if ((rod && !scene->axial.solution &&
         !(br_function_is_zero(&scene->axial.displacement) &&
           br_function_is_zero(&scene->axial.velocity))) ||
        (beam && !scene->bending.solution &&
         !(br_function_is_zero(&scene->bending.displacement) &&
           br_function_is_zero(&scene->bending.velocity))))
        return none("initial data start modes that no step resolves");
    if ((rod && !scene->axial.solution &&
         (load_zeros_at_start(&scene->axial.load, scene) < needed ||
          zeros_at_start(&scene->axial.tip_force, scene) < needed)) ||
        (beam && !scene->bending.solution &&
         (load_zeros_at_start(&scene->bending.load, scene) < needed ||
          zeros_at_start(&scene->bending.tip_force, scene) < needed ||
          zeros_at_start(&scene->bending.tip_moment, scene) < needed)))
        return none("forces start suddenly");
    if (contact && rod && !s->method.contact->at_new_step) {
        struct br_theory t = of_order(1);
        if (scheme->order > 1)
            br_append(t.reason, sizeof t.reason, "1: the contact force is one step late");
        return t;
    }
    if (scheme->order > 1 && ((contact && rod) || friction))
        return none("the tip may switch inside a step, which costs order");
    return of_order(scheme->order);
}

/* ---- both ---- */

struct br_theory br_theory_of(const struct br_study *s, enum br_part part, enum br_axis axis)
{
    if (axis == BR_AXIS_TIME)
        return in_k(s, part);
    const bool rod = s->scene->axial.modelled && part != BR_PART_BENDING,
               beam = s->scene->bending.modelled && part != BR_PART_AXIAL;
    const struct br_theory u = rod ? rod_in_h(s) : of_order(INFINITY);
    const struct br_theory w = beam ? beam_in_h(s) : of_order(INFINITY);
    if (!(rod && beam) || isnan(u.order))
        return rod ? u : w;
    if (isnan(w.order))
        return w;
    struct br_theory t = u.order <= w.order ? u : w; /* the lower one in the limit */
    t.highest = fmax(u.order, w.highest);
    return t;
}

const char *br_theory_text(double order, double highest, char *buffer, size_t size)
{
    if (isnan(order))
        return "-";
    snprintf(buffer, size, highest > order ? "%g to %g" : "%g", order, highest);
    return buffer;
}
