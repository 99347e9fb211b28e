/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solver/method.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "solver/linear/linear_solver.h"
#include "solver/scene.h"

struct br_method br_method_default(void)
{
    return (struct br_method){
        .scheme = br_time_schemes[0],
        .tolerance = 1e-6,
        .solver = br_linear_solvers[0],
        .contact = br_contact_rules[0],
        .friction = br_friction_rules[0],
        .iteration = br_iteration_defaults,
        .axial_degree = 1,
    };
}

/* ---- the linear solver ---- */

const struct br_linear_solver *br_method_solver(const struct br_method *m,
                                                const struct br_field *field)
{
    return br_linear_solver_taken(m->solver, field, br_time_scheme_sums(m->scheme));
}

double br_method_round_off(const struct br_method *m, const struct br_field *field)
{
    const struct br_linear_solver *solver = br_method_solver(m, field);
    return solver->round_off(field);
}

double br_method_residual(const struct br_method *m, const struct br_field *field)
{
    const struct br_linear_solver *solver = br_method_solver(m, field);
    return solver->residual ? solver->residual(field) : 0;
}

double br_method_cost(const struct br_method *m, const struct br_scene *scene, size_t n)
{
    const double sums = br_time_scheme_sums(m->scheme);
    double cost = 0;
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        const struct br_field field = br_field_of_scene(scene, kind, n, 1, m->axial_degree);
        const struct br_linear_solver *solver = br_method_solver(m, &field);
        if (scene->field[kind].modelled)
            cost += br_linear_solver_cost(solver, &field, sums);
    }
    return cost * br_time_scheme_stages(m->scheme);
}

const struct br_contact_rule *br_contact_rule_of(const struct br_time_scheme *scheme)
{
    const struct br_contact_rule *const *rule = br_contact_rules;
    while (!scheme->may_lag && rule[1] && !(*rule)->at_new_step)
        rule++;
    return *rule;
}

/* Refuses a solver without the elements of a field, with the names of those that have them. */
static enum br_status check_elements(const struct br_method *m, enum br_field_kind kind,
                                     struct br_error *err)
{
    const struct br_field field = {.kind = kind, .n = 1, .h = 1, .degree = m->axial_degree};
    char names[256] = "";
    if (br_linear_solver_for(m->solver, &field))
        return BR_OK;
    for (const struct br_linear_solver *const *s = br_linear_solvers; *s; s++)
        if (br_linear_solver_for(*s, &field) && !br_linear_solver_chooses(*s)) {
            const size_t used = strlen(names);
            snprintf(names + used, sizeof names - used, "%s%s", used ? ", " : "", (*s)->name);
        }
    return br_fail(err, BR_BAD_INPUT, "solver '%s' has no %s%s elements, expected one of %s",
                   m->solver->name, br_field_is_quadratic(&field) ? "quadratic " : "",
                   br_field_names[kind], names);
}

static bool vibrates_undamped(const struct br_scene *s)
{
    return s->density > 0 && ((s->axial.modelled && s->axial.viscosity == 0) ||
                              (s->bending.modelled && s->bending.viscosity == 0));
}

enum br_status br_method_check(const struct br_method *m, const struct br_scene *scene,
                               struct br_error *err)
{
    if (m->axial_degree != 1 && m->axial_degree != 2)
        return br_fail(err, BR_BAD_INPUT, "the axial degree is %d, expected 1 or 2",
                       m->axial_degree);
    /* Smaller tolerances are below round-off, larger ones have no effect. */
    if (m->scheme->adaptive && !(m->tolerance > 1e-14 && m->tolerance < 1))
        return br_fail(err, BR_BAD_INPUT,
                       "the tolerance of time scheme '%s' is %g, expected a number above 1e-14 and "
                       "below 1",
                       m->scheme->name, m->tolerance);
    if (scene && m->scheme->needs_damping && vibrates_undamped(scene))
        return br_fail(err, BR_BAD_INPUT,
                       "scheme %s with a viscosity of 0, expected more than 0 or another scheme: "
                       "it lets undamped vibration grow",
                       m->scheme->name);
    for (enum br_field_kind kind = BR_AXIAL; scene && kind <= BR_BENDING; kind++)
        if (scene->field[kind].modelled && check_elements(m, kind, err))
            return BR_BAD_INPUT;
    if ((!scene || scene->contact.modelled) && !m->scheme->may_lag && !m->contact->at_new_step)
        return br_fail(err, BR_BAD_INPUT,
                       "contact rule '%s' does not go with time scheme '%s', expected '%s'",
                       m->contact->name, m->scheme->name, br_contact_rule_of(m->scheme)->name);
    if (scene && scene->friction.law == BR_FRICTIONLESS)
        return BR_OK;
    if (scene && m->scheme->adaptive && m->friction->iterates)
        return br_fail(err, BR_BAD_INPUT,
                       "friction rule '%s' with scheme %s, expected exact or regularised: this "
                       "scheme keeps stick or slip between switches and does not iterate",
                       m->friction->name, m->scheme->name);
    if (scene && m->friction->needs_regularisation && !(scene->friction.regularisation > 0))
        return br_fail(err, BR_BAD_INPUT,
                       "friction rule '%s' needs the scene's regularisation, mu > 0",
                       m->friction->name);
    return br_friction_check(m->friction, &m->iteration, err);
}

bool br_lagged_contact_grows(const struct br_method *m, const struct br_scene *scene, size_t n,
                             double k)
{
    const struct br_field rod = br_field_of_scene(scene, BR_AXIAL, n, k, m->axial_degree);
    return scene->contact.modelled && !m->contact->at_new_step &&
           br_contact_grows(&rod, br_contact_stiffness(&scene->contact));
}

/* ---- damping ---- */

/* A mode of frequency om has z = om k (-xi +- i sqrt(1 - xi^2)) with xi = c om / (2 a), and grows
 * with bdf3 where z lies in one of the two lobes that
 *     z = 11/6 - 3 e + 3/2 e^2 - 1/3 e^3,    e = exp(-i theta),
 * bounds to the left of the imaginary axis. Along it -Re z / |z|^2, which is c / (2 a k), is at
 * most |z|^2 / 4 and at most 0.0710, and |z| at most 1.937 (Hairer and Wanner, Solving Ordinary
 * Differential Equations II, V.1, figure 1.1). */

static const double lobe_ends = 1.937, lobe_depth = 0.0710;

/* The least share of a mode's stiffness that the elements have beside a spring at the tip: in a
 * rod's lowest mode with c_H L / a of about 2 it is 0.64. */
static const double beside_spring = 0.6;

/* The squares of the lowest frequency and of an upper bound of the highest one, 1/s^2. The highest
 * frequency of a free element bounds that of the mesh. */
static void frequencies(const struct br_field *f, double square[2])
{
    const double h = f->h, rod = br_field_is_quadratic(f) ? 60 : 12;
    const double highest = f->kind == BR_AXIAL ? rod / (h * h) : 8400 / (h * h * h * h);
    square[0] = f->stiffness / f->density * br_field_lowest_mode(f);
    square[1] = f->stiffness / f->density * highest;
}

/* If |om k| may reach the whole lobe, c / (2 a k) >= depth is sufficient; else c / (2 a k) >= (om
 * k)^2 / 4, so that k^3 <= 2 c / (a om^2). */
double br_damping_largest_step(const struct br_field *f, bool spring)
{
    double square[2];
    if (f->density == 0 || f->stiffness == 0)
        return INFINITY;
    frequencies(f, square);
    const double damping = (spring ? beside_spring : 1) * f->viscosity / f->stiffness;
    return fmax(damping / (2 * lobe_depth), cbrt(2 * damping / square[1]));
}

/* Whether even the slowest mode lies beyond the lobes, where the scheme damps it; a spring only
 * raises its frequency. */
static bool beyond_lobes(const struct br_field *f)
{
    double square[2];
    if (f->density == 0 || f->stiffness == 0)
        return true;
    frequencies(f, square);
    return f->k * sqrt(square[0]) > lobe_ends;
}

enum br_status br_damping_check(const struct br_method *method, const struct br_scene *scene,
                                size_t n, double k, struct br_error *err)
{
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING && method->scheme->needs_damping;
         kind++) {
        const struct br_field field = br_field_of_scene(scene, kind, n, k, method->axial_degree);
        const bool spring = kind == BR_AXIAL && scene->contact.modelled;
        const double most = br_damping_largest_step(&field, spring);
        if (!scene->field[kind].modelled || k <= most || beyond_lobes(&field))
            continue;
        return br_fail(err, BR_BAD_INPUT,
                       "scheme %s with k = %g s and a viscosity of %g in %s: it lets vibration of "
                       "so little damping grow, expected k of at most %g s, or another scheme",
                       method->scheme->name, k, field.viscosity, br_field_names[kind], most);
    }
    return BR_OK;
}
