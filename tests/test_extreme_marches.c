/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Marches at the extremes, with every linear solver and every scheme of fixed steps: random scenes
 * against quadruple precision; no inertia, no viscosity or neither; laws that degenerate, and their
 * corners; and what double precision cannot hold, which is refused. None raises a flag of a trap.
 */
#include <fenv.h>
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "solver/function.h"
#include "solver/linear/linear_solver.h"
#include "solver/method.h"
#include "solver/scene.h"
#include "support.h"
#include "tests/dense_march.h"

enum { MOST_N = 1500 };

static int bad_flags(void)
{
    return fetestexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);
}

static struct br_method method_of(size_t solver, size_t scheme, size_t contact, size_t friction)
{
    struct br_method method = br_method_default();
    method.solver = br_linear_solvers[solver];
    method.scheme = br_time_schemes[scheme];
    method.contact = br_contact_rules[method.scheme->may_lag ? contact : 1];
    method.friction = br_friction_rules[friction];
    return method;
}

static size_t solver_count(void)
{
    size_t count = 0;
    while (br_linear_solvers[count])
        count++;
    return count;
}

static size_t fixed_schemes(void)
{
    size_t count = 0;
    while (!br_time_schemes[count]->adaptive)
        count++;
    return count;
}

/* ---- random scenes against quadruple precision ---- */

/* 0 now and then, else anything from low to high. */
static double any(struct br_test_random *r, double low, double high, double zero)
{
    return br_test_uniform(r, 0, 1) < zero ? 0 : br_test_log_uniform(r, low, high);
}

/* A function of x that is given a size and the length. */
static struct br_function scaled(const char *format, double size, double length)
{
    char text[120];
    snprintf(text, sizeof text, format, size, length);
    return br_test_function(text);
}

static struct br_load any_load(struct br_test_random *r, double size, const struct br_scene *s)
{
    static const char *const times[] = {
        "1", "t/%.17g", "exp(t/%.17g)-1", "sin(30*t/%.17g)", "exp(-30*t/%.17g)", "t<0.3*%.17g?1:0"};
    static const char *const spaces[] = {"%.17g*(1-3*(x/%.17g)^3)", "%.17g*sin(3*x/%.17g)",
                                         "%.17g*exp(-x/%.17g)", "%.17g*sin(3*x/%.17g+t)"};
    char text[80];
    struct br_load load = {0};
    snprintf(text, sizeof text, times[br_test_index(r, 6)], s->duration);
    load.term[0].time = br_test_function(text);
    load.term[0].space.constant = br_test_index(r, 2) ? size : -size;
    if (br_test_index(r, 3) == 0)
        load.term[0].space = scaled(spaces[br_test_index(r, 4)], size, s->length);
    return load;
}

/* Forces at the tip as large as the load, and data at t = 0 that it moves in the duration. */
static void fill_tip_and_start(struct br_test_random *r, struct br_scene *s, double load)
{
    const double L = s->length, way = load * L / (s->axial.stiffness / L + 1 / DBL_MAX),
                 bend = load * pow(L, 4) / (s->bending.stiffness + 1 / DBL_MAX);
    if (br_test_index(r, 3) == 0) {
        s->axial.tip_force = scaled("%.17g*sin(9*t/%.17g)", load * L, s->duration);
        s->bending.tip_force = scaled("%.17g*cos(9*t/%.17g)", load * L, s->duration);
        s->bending.tip_moment.constant = load * L * L * br_test_uniform(r, -1, 1);
    }
    if (s->axial.stiffness == 0 || s->bending.stiffness == 0 || br_test_index(r, 4))
        return;
    const double T = s->duration;
    s->axial.displacement = scaled("%.17g*sin(2*x/%.17g)", 0.1 * way, L);
    s->axial.velocity = scaled("%.17g*x/%.17g", 0.1 * way / T, L);
    s->bending.displacement = scaled("%.17g*(x/%.17g)^2", 0.1 * bend, L);
    s->bending.displacement_slope = scaled("%.17g*x/%.17g", 0.2 * bend / L, L);
    s->bending.velocity = scaled("%.17g*(x/%.17g)^3", 0.1 * bend / T, L);
    s->bending.velocity_slope = scaled("%.17g*(x/%.17g)^2", 0.3 * bend / (T * L), L);
}

/* Numbers of the material as they come, or so that inertia, stiffness and viscosity have ratios up
 * to 1e12 over the duration. */
static void fill_material(struct br_test_random *r, struct br_scene *s)
{
    const double T = s->duration, L = s->length, ratio = br_test_index(r, 2) ? 1e3 : 1e12;
    s->axial.stiffness = br_test_log_uniform(r, 1e-6, 1e6);
    s->bending.stiffness = br_test_log_uniform(r, 1e-6, 1e6);
    s->density = any(r, 1e-6, 1e6, 0.15);
    s->axial.viscosity = any(r, 1e-6, 1e6, 0.2);
    s->bending.viscosity = any(r, 1e-6, 1e6, 0.2);
    if (br_test_index(r, 3)) {
        s->axial.viscosity = s->axial.stiffness * T * any(r, 1 / ratio, ratio, 0.2);
        s->bending.viscosity = s->bending.stiffness * T * any(r, 1 / ratio, ratio, 0.2);
        s->density = s->bending.stiffness * pow(T / (L * L), 2) * any(r, 1 / ratio, ratio, 0.2);
    }
    if (s->axial.viscosity > 0 && br_test_index(r, 8) == 0)
        s->axial.stiffness = 0;
    if (s->bending.viscosity > 0 && br_test_index(r, 8) == 0)
        s->bending.stiffness = 0;
}

/* A stiff contact that bounces magnifies every difference from bounce to bounce: none here. */
static void fill_laws(struct br_test_random *r, struct br_scene *s, double load)
{
    const double L = s->length, T = s->duration;
    const double inert = s->density * L / (T * T);
    const double rod = s->axial.stiffness / L + s->axial.viscosity / (T * L) + inert;
    s->contact.modelled = br_test_index(r, 3) > 0;
    s->contact.gap = load * L / rod * any(r, 1e-4, 10, 0.2);
    s->contact.stiffness = rod * any(r, 1e-4, s->density > 0 ? 1 : 1e6, 0.1);
    s->friction.law = (enum br_friction_law)br_test_index(r, s->contact.modelled ? 3 : 2);
    s->friction.coefficient =
        (s->friction.law == BR_TRESCA ? load * L : rod) * any(r, 1e-4, 1e6, 0.1);
    s->friction.regularisation = br_test_index(r, 2) ? br_test_log_uniform(r, 1e-300, 1)
                                                     : L / T * br_test_log_uniform(r, 1e-8, 1);
}

static struct br_scene any_scene(struct br_test_random *r)
{
    struct br_scene s = br_test_bare();
    s.length = br_test_log_uniform(r, 1e-6, 1e6);
    s.duration = br_test_log_uniform(r, 1e-6, 1e6);
    fill_material(r, &s);
    const double load = br_test_log_uniform(r, 1e-200, 1e12);
    s.axial.load = any_load(r, load, &s);
    s.bending.load = any_load(r, load * any(r, 1e-3, 1, 0.1), &s);
    fill_tip_and_start(r, &s, load);
    fill_laws(r, &s, load);
    return s;
}

/* bdf3 refuses vibration of little damping. */
static bool goes(const struct br_scene *s, const struct br_method *m, size_t n, size_t steps)
{
    return !m->scheme->needs_damping ||
           (!br_method_check(m, s, &err) &&
            !br_damping_check(m, s, n, s->duration / (double)steps, &err));
}

/* Strain rates are those of the nodal velocities, to what these are rounded to. */
static void check_strain_rate(const struct br_march *march, enum br_field_kind kind)
{
    const struct br_field *f = br_march_field(march, kind);
    const size_t u = br_field_unknowns(f);
    static double velocity[2 * (MOST_N + 1)], rate[2 * MOST_N];
    double most = 0;
    br_march_get(march, kind, NULL, velocity);
    br_march_strain_rate(march, kind, rate);
    for (size_t i = 0; i < br_field_size(f); i++)
        most = fmax(most, fabs(velocity[i]));
    for (size_t e = 0; e < f->n && br_march_models(march, kind); e++) {
        const double *v = velocity + u * e;
        double expected[2] = {v[u] - v[0], u == 2 ? v[3] : 0};
        if (kind == BR_BENDING)
            br_curvature(v, expected);
        for (size_t i = 0; i < u; i++)
            CLOSE(rate[u * e + i], expected[i],
                  DBL_MIN + (1e-14 + 4e-16 * (double)f->n) * br_test_slack() * most);
    }
}

/* Velocities are rounded to more than displacements, which they change little by little. */
static double field_deviation(struct br_march *march, struct dense_march *dense,
                              enum br_field_kind kind)
{
    check_strain_rate(march, kind);
    return fmax(dense_deviation(dense, kind, 0), dense_deviation(dense, kind, 1) / 8);
}

static double follow(struct br_march *march, struct dense_march *dense, size_t steps)
{
    double most = 0;
    for (size_t step = 1; step <= steps; step++) {
        feclearexcept(FE_ALL_EXCEPT);
        br_test_advance(march, step);
        if (bad_flags())
            return INFINITY;
        for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++)
            most = fmax(most, field_deviation(march, dense, kind));
    }
    return most;
}

/* Every solver with its options, every scheme of fixed steps, both degrees, the laws' direct rules.
 */
static struct br_method any_method(struct br_test_random *r)
{
    struct br_method m =
        method_of(br_test_index(r, solver_count()), br_test_index(r, fixed_schemes()),
                  br_test_index(r, 2), br_test_index(r, 2));
    size_t kernels = 0;
    while (br_kernels[kernels])
        kernels++;
    const struct br_kernel *kernel = br_kernels[br_test_index(r, kernels)];
    if (m.solver->takes_kernel && kernel->available())
        m.kernel = kernel;
    m.axial_degree = m.solver->axial_quadratic ? 1 + (int)br_test_index(r, 2) : 1;
    return m;
}

/* Solvers of little round-off on fine meshes, too. */
static size_t any_mesh(struct br_test_random *r, const struct br_method *m)
{
    static const size_t meshes[] = {1, 2, 5, 17, 21, 33, 40};
    const bool flexible = m->solver != &br_umfpack;
    if (flexible && br_test_index(r, 2))
        return (size_t)br_test_log_uniform(r, 1, br_test_index(r, 8) ? 200 : MOST_N);
    return meshes[br_test_index(r, 7)];
}

static void check_scene(uint64_t seed, size_t *compared)
{
    struct br_test_random r = {1000 + seed};
    OWNED(br_scene) s = any_scene(&r);
    const struct br_method method = any_method(&r);
    const size_t n = any_mesh(&r, &method), steps = 1 + br_test_index(&r, 30);
    if (goes(&s, &method, n, steps)) {
        OWNED(br_march) *march = br_test_march(&s, n, steps, &method);
        struct dense_march *dense = dense_follow(march, &s, &method);
        const double predicted = br_march_round_off(march);
        /* A lagged contact may magnify differences on its way to an impact. */
        const double limit =
            method.contact->at_new_step ? 2 * predicted : fmin(1e-10 + 4 * predicted, 1e-8);
        if (dense && !br_march_contact_unstable(march)) {
            const double most = follow(march, dense, steps);
            if (!(most <= limit))
                fail_msg("seed %zu: %s, %s, %s, %s, n = %zu, %zu steps: off by %g, expected %g",
                         (size_t)seed, method.solver->name, method.scheme->name,
                         method.contact->name, method.friction->name, n, steps, most, limit);
            ++*compared;
        }
        dense_free(dense);
    }
}

TEST(test_random_scenes)
{
    size_t compared = 0;
    const size_t most = getenv("BR_EXTREMES") ? (size_t)atol(getenv("BR_EXTREMES")) : 300;
    for (uint64_t seed = 1; seed <= (br_test_quick() ? 60 : most); seed++)
        check_scene(seed, &compared);
    print_message("# %zu scenes\n", compared);
    if (br_test_slack() == 1)
        assert_true(compared >= 40);
}

/* ---- no inertia, no viscosity, neither ---- */

/* A cantilever and a rod under constant loads: f L^4 / (8 a) and f L^2 / (2 a), exact at nodes. */
static struct br_scene loaded(void)
{
    struct br_scene s = br_test_bare();
    s.density = s.axial.viscosity = s.bending.viscosity = 0;
    s.length = 3;
    s.duration = 7;
    s.axial.stiffness = 11;
    s.bending.stiffness = 13;
    s.axial.load = s.bending.load = br_test_load("5");
    s.bending.load.term[0].space = s.axial.load.term[0].space = (struct br_function){.constant = 5};
    return s;
}

TEST(test_statics)
{
    const double u = 5.0 * 9 / 22, w = 5.0 * 81 / (8 * 13);
    for (size_t scheme = 0; scheme <= fixed_schemes(); scheme++) /* and the adaptive one */
        for (size_t solver = 0; solver < solver_count(); solver++) {
            OWNED(br_scene) s = loaded();
            const struct br_method method = method_of(solver, scheme, 1, 0);
            OWNED(br_march) *march = br_test_march(&s, 20, 25, &method);
            feclearexcept(FE_ALL_EXCEPT);
            for (size_t step = 1; step <= 25; step++) {
                br_test_advance(march, step);
                CLOSE(br_march_tip_displacement(march, BR_AXIAL), u, 1e-12 * u);
                CLOSE(br_march_tip_displacement(march, BR_BENDING), w, 1e-10 * w);
            }
            assert_int_equal(bad_flags(), 0);
        }
}

/* A load that jumps, and its field with it, on the adaptive scheme. */
TEST(test_jumps)
{
    const double u = 5.0 * 9 / 22, w = 5.0 * 81 / (8 * 13);
    for (size_t solver = 0; solver < solver_count(); solver++) {
        OWNED(br_scene) s = loaded();
        const struct br_method method = method_of(solver, fixed_schemes(), 1, 0);
        s.axial.viscosity = solver % 2 ? 0 : 1e-20;
        s.axial.load.term[0].time = br_test_function("t < 3.3 ? 1 : 0-2");
        s.bending.load.term[0].time = br_test_function("t < 4.4 ? 1 : 3");
        OWNED(br_march) *march = br_test_march(&s, 20, 14, &method);
        for (size_t step = 1; step <= 14; step++) {
            br_test_advance(march, step);
            const double t = 0.5 * (double)step;
            CLOSE(br_march_tip_displacement(march, BR_AXIAL), t < 3.3 ? u : -2 * u, 1e-11 * u);
            CLOSE(br_march_tip_displacement(march, BR_BENDING), t < 4.4 ? w : 3 * w, 1e-9 * w);
        }
    }
}

/* ---- laws that degenerate ---- */

struct outcome {
    double tip[4], w_middle;
};

static struct outcome outcome_of(const struct br_scene *s, const struct br_method *method)
{
    enum { N = 40, STEPS = 30 };
    OWNED(br_march) *march = br_test_march(s, N, STEPS, method);
    double w[2 * (N + 1)];
    struct outcome o;
    feclearexcept(FE_ALL_EXCEPT);
    br_test_advance(march, STEPS);
    assert_int_equal(bad_flags(), 0);
    br_march_get(march, BR_BENDING, w, NULL);
    o = (struct outcome){{br_march_tip_displacement(march, BR_AXIAL),
                          br_march_tip_displacement(march, BR_BENDING),
                          br_march_tip(march)->velocity[0], br_march_tip(march)->velocity[1]},
                         w[N]};
    return o;
}

/* The same bits: a law without an effect does nothing. */
static void same_bits(const struct br_scene *s, const struct br_scene *without,
                      const struct br_method *method, const char *what)
{
    const struct outcome a = outcome_of(s, method), b = outcome_of(without, method);
    for (int i = 0; i < 4; i++)
        if (!(a.tip[i] == b.tip[i]))
            fail_msg("%s, %s, %s: tip %d: %.17g, without the law %.17g", what, method->solver->name,
                     method->scheme->name, i, a.tip[i], b.tip[i]);
    assert_true(a.w_middle == b.w_middle);
}

static void check_without_effect(const struct br_method *method)
{
    struct br_scene s = br_test_bundled("example1"), plain = s;
    plain.friction = (struct br_friction){0};
    s.friction = (struct br_friction){.law = BR_TRESCA, .regularisation = 1e-3};
    same_bits(&s, &plain, method, "Tresca's friction with a bound of 0");
    s.friction.law = BR_COULOMB;
    same_bits(&s, &plain, method, "Coulomb's friction with a coefficient of 0");
    s.friction = plain.friction;
    plain.contact = (struct br_contact){0};
    s.contact.stiffness = 0;
    same_bits(&s, &plain, method, "a contact of stiffness 0");
    s.contact.stiffness = 1e15;
    s.contact.gap = 1e300;
    same_bits(&s, &plain, method, "a gap of 1e300 m");
    br_scene_clear(&s);
}

TEST(test_laws_without_effect)
{
    for (size_t i = 0; i < 4 * fixed_schemes(); i++) {
        const struct br_method method = method_of(i % 2, i / 4, i / 2 % 2, i % 4 / 2);
        check_without_effect(&method);
    }
}

/* ---- corners of the laws ---- */

/* A beam with a load at its tip and Tresca's friction: a reaction that is the load itself, once all
 * else rests. */
static struct br_scene held(double load, double bound)
{
    struct br_scene s = br_test_bare();
    s.axial.modelled = false;
    s.density = 0;
    s.bending.tip_force.constant = load;
    s.friction = (struct br_friction){.law = BR_TRESCA, .coefficient = bound};
    return s;
}

/* A bound that is the reaction of a stuck tip to the last bit holds it; one less lets it creep by
 * no more than that. */
TEST(test_bound_is_the_reaction)
{
    for (size_t i = 0; i < 3 * solver_count() * fixed_schemes(); i++) {
        const struct br_method method =
            method_of(i / 3 % solver_count(), i / 3 / solver_count(), 1, 0);
        const double bounds[] = {nextafter(3, 4), 3, nextafter(3, 2)};
        struct br_scene s = held(3, bounds[i % 3]);
        OWNED(br_march) *march = br_test_march(&s, 21, 40, &method);
        for (size_t step = 1; step <= 40; step++) {
            br_test_advance(march, step);
            CLOSE(br_march_tip_displacement(march, BR_BENDING), 0, 1e-12);
            AT_MOST(fabs(br_march_tip(march)->friction_force), bounds[i % 3]);
            CLOSE(br_march_tip(march)->friction_force, 3, 1e-12);
        }
    }
}

/* A load that turns round from one step to the next: slip one way, then the other. Without inertia
 * a tip that slips obeys 3 (a w + c v) / L^3 = f - lambda. */
TEST(test_reversal_in_a_step)
{
    for (size_t solver = 0; solver < solver_count(); solver++) {
        struct br_scene s = held(0, 1);
        s.bending.tip_force = br_test_function("t < 0.5 ? 5 : 0-5");
        s.bending.stiffness = 2;
        const struct br_method method = method_of(solver, 0, 1, 0);
        OWNED(br_march) *march = br_test_march(&s, 8, 11, &method);
        double w = 0;
        for (size_t step = 1; step <= 11; step++) {
            const double k = 1.0 / 11, f = step < 6 ? 4 : -4;
            br_test_advance(march, step);
            w = (f / 3 * k + w) / (1 + 2 * k);
            assert_true(br_march_tip(march)->friction_force == (step < 6 ? 1 : -1));
            CLOSE(br_march_tip_displacement(march, BR_BENDING), w, 1e-12);
        }
        br_function_free(&s.bending.tip_force);
    }
}

/* A tip that comes to the gap with no speed and stays: no force, no bound. */
TEST(test_grazing)
{
    for (size_t i = 0; i < solver_count() * fixed_schemes(); i++) {
        OWNED(br_scene) s = loaded();
        s.contact = (struct br_contact){.modelled = true, .stiffness = 1e15};
        const struct br_method method = method_of(i % solver_count(), i / solver_count(), 1, 0);
        for (int ulps = -1; ulps <= 1; ulps++) {
            s.contact.gap = 5.0 * 9 / 22 * (1 + ulps * DBL_EPSILON);
            OWNED(br_march) *march = br_test_march(&s, 17, 12, &method);
            for (size_t step = 1; step <= 12; step++) {
                br_test_advance(march, step);
                CLOSE(br_march_tip_displacement(march, BR_AXIAL), s.contact.gap, 1e-12);
                AT_MOST(br_march_tip(march)->contact_force, 1e-11);
            }
        }
    }
}

/* ---- beyond double precision ---- */

static enum br_status end_of(const struct br_scene *s, const struct br_method *method,
                             struct br_error *why)
{
    OWNED(br_march) * march;
    enum br_status status = br_march_create(&march, s, 21, 6, method, why);
    for (int step = 0; step < 6 && !status; step++)
        status = br_march_step(march, why);
    return status;
}

TEST(test_beyond_double)
{
    for (size_t i = 0; i < solver_count() * (fixed_schemes() + 1); i++) {
        const struct br_method method = method_of(i % solver_count(), i / solver_count(), 1, 0);
        OWNED(br_scene) s = loaded();
        /* An estimate of an error may say so first. */
        const char *const field = method.scheme->adaptive ? "" : "motion is lost to underflow";
        s.axial.load.term[0].space.constant = 1e-310;
        REFUSED(end_of(&s, &method, &err), BR_NOT_FINITE, field);
        s.axial.load.term[0].space.constant = 1;
        s.bending.load.term[0].space.constant = 1e-290;
        REFUSED(end_of(&s, &method, &err), BR_NOT_FINITE, field);
        s.bending.load.term[0].space.constant = 1e-200;
        MUST(end_of(&s, &method, &err));
        s.bending.load.term[0].space.constant = 1.7e308;
        REFUSED(end_of(&s, &method, &err), BR_NOT_FINITE, "bending load at t = ");
    }
}
