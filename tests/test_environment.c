/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Marches in other floating-point environments and units. No step raises a flag that could trap.
 * Rounding up, down or to zero changes results by no more than the predicted round-off, and
 * certificates pass. A scene in other units of length, time and mass gives the same results, to the
 * bit if the units are powers of two. */
#include <fenv.h>
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "reference/certificate/certificate.h"
#include "rescale.h"
#include "solver/linear/linear_solver.h"
#include "solver/method.h"
#include "study/scene/file.h"
#include "support.h"

enum { MOST = 2 * 100 };

/* Displacements and velocities at the end. */
struct result {
    size_t size[2];
    double value[2][2][MOST]; /* by field, derivative */
    double round_off;
};

static int bad_flags(void)
{
    return fetestexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);
}

static struct br_method method_of(size_t solver, size_t scheme)
{
    struct br_method method = br_test_method(NULL, "implicit", NULL);
    method.solver = br_linear_solvers[solver];
    method.scheme = br_time_schemes[scheme];
    return method;
}

static bool goes(const struct br_scene *s, size_t n, size_t steps, const struct br_method *method)
{
    OWNED(br_march) * march;
    const enum br_status status = br_march_create(&march, s, n, steps, method, &err);
    return status == BR_OK;
}

static struct br_march *marched(const struct br_scene *s, size_t n, size_t steps,
                                const struct br_method *method)
{
    struct br_march *march = br_test_march(s, n, steps, method);
    br_test_advance(march, steps);
    return march;
}

/* Frees the march, too. */
static struct result result_of(struct br_march *march)
{
    struct result r = {.round_off = br_march_round_off(march)};
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        r.size[kind] = br_field_size(br_march_field(march, kind));
        assert_true(r.size[kind] <= MOST);
        br_march_get(march, kind, r.value[kind][0], r.value[kind][1]);
    }
    br_march_free(march);
    return r;
}

static struct result run(const struct br_scene *s, size_t n, size_t steps,
                         const struct br_method *method)
{
    return result_of(marched(s, n, steps, method));
}

static double largest(const double *x, size_t size)
{
    double most = 0;
    for (size_t i = 0; i < size; i++)
        most = fmax(most, fabs(x[i]));
    return most;
}

/* Largest difference between a and b * factor, relative to the largest value of a. */
static double distance(const struct result *a, const struct result *b, enum br_field_kind kind,
                       double factor)
{
    const double *x = a->value[kind][0], *y = b->value[kind][0];
    const double scale = largest(x, a->size[kind]);
    double most = 0;
    for (size_t i = 0; i < a->size[kind]; i++)
        if (!(fabs(x[i] - factor * y[i]) <= most))
            most = fabs(x[i] - factor * y[i]);
    return scale > 0 ? most / scale : most;
}

/* Impacts magnify differences, so no impacts chatter in these scenes. */
static const char *const scenes[] = {"example1", "example2", "example3",    "example4",
                                     "impact",   "release",  "moving_load", "vibration"};
enum { SCENES = sizeof scenes / sizeof *scenes };

#define EACH_METHOD(solver, scheme)                            \
    for (size_t scheme = 0; br_time_schemes[scheme]; scheme++) \
        for (size_t solver = 0; br_linear_solvers[solver]; solver++)

/* ---- flags ---- */

TEST(test_flags)
{
    char **names;
    size_t count;
    MUST(br_scene_list(&names, &count, &err));
    assert_true(count > 5);
    for (size_t i = 0; i < count; i++) {
        OWNED(br_scene) s = br_test_bundled(names[i]);
        EACH_METHOD(solver, scheme)
        {
            const struct br_method method = method_of(solver, scheme);
            feclearexcept(FE_ALL_EXCEPT);
            if (goes(&s, 24, 40, &method))
                run(&s, 24, 40, &method);
            if (bad_flags())
                fail_msg("%s, %s, %s: flags %x", names[i], method.solver->name, method.scheme->name,
                         (unsigned)bad_flags());
        }
    }
    br_scene_list_free(names, count);
}

/* ---- rounding ---- */

static const struct {
    int mode;
    const char *name;
} modes[] = {{FE_UPWARD, "up"}, {FE_DOWNWARD, "down"}, {FE_TOWARDZERO, "to zero"}};

/* If all operations round to one side, errors add up that would else cancel. */
static const double one_sided = 16;
/* More so in a factorisation: 42 times was seen, with umfpack, a vibration, bdf2, rounding up. */
static const double one_sided_factors = 64;

static double one_sided_by(const struct br_method *method)
{
    const bool flexible = method->solver != &br_umfpack;
    return flexible ? one_sided : one_sided_factors;
}

static void compare_modes(const struct br_scene *s, const char *name,
                          const struct br_method *method)
{
    enum { N = 48, STEPS = 100 };
    if (!goes(s, N, STEPS, method))
        return;
    const struct result nearest = run(s, N, STEPS, method);
    for (size_t i = 0; i < sizeof modes / sizeof *modes; i++) {
        fesetround(modes[i].mode);
        const struct result r = run(s, N, STEPS, method);
        fesetround(FE_TONEAREST);
        /* Steps by a tolerance may have other lengths; results then differ by their error. */
        const double limit = method->scheme->adaptive ? 100 * method->tolerance
                                                      : one_sided_by(method) * nearest.round_off;
        for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++)
            if (!(distance(&nearest, &r, kind, 1) <= limit))
                fail_msg("%s, %s, %s, rounding %s: off by %g, expected %g at most", name,
                         method->solver->name, method->scheme->name, modes[i].name,
                         distance(&nearest, &r, kind, 1), limit);
    }
}

TEST(test_rounding)
{
    for (size_t i = 0; i < SCENES; i++) {
        OWNED(br_scene) s = br_test_bundled(scenes[i]);
        EACH_METHOD(solver, scheme)
        {
            const struct br_method method = method_of(solver, scheme);
            compare_modes(&s, scenes[i], &method);
        }
    }
}

static void certify(const struct br_scene *s, const char *name, const struct br_method *method,
                    const char *mode)
{
    enum { N = 24, STEPS = 50 };
    struct br_step_checker *checker;
    if (!goes(s, N, STEPS, method))
        return;
    OWNED(br_march) *march = br_test_march(s, N, STEPS, method);
    const struct br_certificate limits = br_certificate_limits(
        method->scheme, N, br_test_slack() * one_sided * br_march_round_off(march));
    MUST(br_step_checker_create(&checker, march, s, method, &err));
    for (size_t step = 1; step <= STEPS; step++) {
        br_test_advance(march, step);
        const struct br_certificate c = br_step_checker_step(checker);
        if (br_certificate_check(&c, &limits, &err))
            fail_msg("%s, %s, %s, rounding %s, step %zu: %s", name, method->solver->name,
                     method->scheme->name, mode, step, err.message);
    }
    br_step_checker_free(checker);
}

TEST(test_certificates)
{
    for (size_t i = 0; i < SCENES; i++) {
        OWNED(br_scene) s = br_test_bundled(scenes[i]);
        for (size_t scheme = 0; br_time_schemes[scheme]; scheme++)
            for (size_t m = 0; m < sizeof modes / sizeof *modes; m++) {
                const struct br_method method = method_of((scheme + i) % 2, scheme);
                fesetround(modes[m].mode);
                certify(&s, scenes[i], &method, modes[m].name);
                fesetround(FE_TONEAREST);
            }
    }
}

/* ---- other units ---- */

/* A soft contact and any friction: nothing magnifies differences. */
static struct br_scene any_scene(struct br_test_random *r)
{
    struct br_scene s = br_test_bare();
    s.length = br_test_log_uniform(r, 0.1, 10);
    s.duration = br_test_log_uniform(r, 0.1, 10);
    s.density = br_test_index(r, 4) ? br_test_log_uniform(r, 1e-3, 1e3) : 0;
    s.axial.stiffness = br_test_log_uniform(r, 1e-3, 1e3);
    s.axial.viscosity = br_test_index(r, 4) ? br_test_log_uniform(r, 1e-3, 1e3) : 0;
    s.bending.stiffness = br_test_log_uniform(r, 1e-3, 1e3);
    s.bending.viscosity = br_test_index(r, 4) ? br_test_log_uniform(r, 1e-3, 1e3) : 0;
    s.axial.load.term[0].space.constant = br_test_uniform(r, -1, 3);
    s.bending.load.term[0].space.constant = br_test_uniform(r, -3, 3);
    s.axial.load.term[0].time.constant = s.bending.load.term[0].time.constant = 1;
    s.contact = (struct br_contact){true, br_test_index(r, 2) ? br_test_uniform(r, 0, 1e-2) : 0,
                                    s.axial.stiffness / s.length};
    s.friction.law = (enum br_friction_law)br_test_index(r, 3);
    s.friction.coefficient = br_test_log_uniform(r, 1e-3, 1e3);
    s.friction.regularisation = br_test_log_uniform(r, 1e-6, 1);
    return s;
}

static void compare_units(const struct br_scene *s, const struct br_method *method, size_t n,
                          const struct br_units_change *u, bool exact)
{
    struct br_scene other;
    if (!goes(s, n, 30, method))
        return;
    MUST(br_rescale(s, u, &other, &err));
    const struct result a = run(s, n, 30, method), b = run(&other, n, 30, method);
    br_scene_clear(&other);
    /* The other scene's numbers are rounded, too, which changes an assembled matrix. */
    const bool flexible = method->solver != &br_umfpack;
    const double numbers = flexible ? 1e-12 : 1e-8;
    const double limit = exact                      ? 0
                         : method->scheme->adaptive ? 100 * method->tolerance
                                                    : 16 * a.round_off + numbers;
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        if (!(distance(&a, &b, kind, 1 / u->metre) <= limit))
            fail_msg("%s, %s, %s, n = %zu, units %g %g %g: off by %g, expected %g at most",
                     method->solver->name, method->scheme->name, method->friction->name, n,
                     u->metre, u->second, u->kilogram, distance(&a, &b, kind, 1 / u->metre), limit);
}

/* The most vibrations that elements of either field make in the scene. */
static double vibrations(const struct br_scene *s, size_t n)
{
    const double waves = (double)n / s->length; /* 1/m */
    return s->duration * waves *
           fmax(sqrt(s->axial.stiffness / s->density),
                waves * sqrt(s->bending.stiffness / s->density));
}

TEST(test_units)
{
    for (uint64_t i = 0; i < (br_test_quick() ? 4 : 25); i++) {
        struct br_test_random r = {5 + i};
        struct br_scene s = any_scene(&r);
        const size_t n = 1 + br_test_index(&r, 40);
        const struct br_units_change any = {br_test_log_uniform(&r, 1e-6, 1e6),
                                            br_test_log_uniform(&r, 1e-6, 1e6),
                                            br_test_log_uniform(&r, 1e-6, 1e6)};
        const struct br_units_change twos = {ldexp(1, (int)br_test_index(&r, 40) - 20),
                                             ldexp(1, (int)br_test_index(&r, 40) - 20),
                                             ldexp(1, (int)br_test_index(&r, 40) - 20)};
        const char *friction = br_test_index(&r, 2) ? "regularised" : "exact";
        EACH_METHOD(solver, scheme)
        {
            struct br_method method = method_of(solver, scheme);
            method.friction = br_friction_rule_find(friction);
            if (method.scheme->adaptive && s.density > 0 && vibrations(&s, n) > 100)
                continue; /* its steps may resolve every vibration: too many steps */
            compare_units(&s, &method, n, &any, false);
            compare_units(&s, &method, n, &twos, !method.scheme->adaptive);
        }
    }
}
