/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The exact discrete solution: against quadruple precision, and against the solver, with every law
 * and in every scheme that it knows. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "reference/discrete.h"
#include "support.h"

enum { MOST_N = 40 };

static struct br_discrete *created(const struct br_scene *scene, size_t n, size_t steps,
                                   const struct br_method *method)
{
    struct br_error err = {0};
    struct br_discrete *d;
    MUST(br_discrete_create(&d, scene, n, steps, method, &err));
    return d;
}

static void advance(struct br_discrete *d, size_t until)
{
    struct br_error err = {0};
    while (br_discrete_steps_done(d) < until)
        MUST(br_discrete_step(d, &err));
}

/* ---- the golden values: another form (stiffness), other digits (113 bits) ---- */

static void check_golden(const struct br_test_golden *row)
{
    struct br_scene scene = br_test_bundled(row->scene);
    const struct br_method method = br_test_method(NULL, "lagged", "exact");
    struct br_discrete *d = created(&scene, row->n, row->steps, &method);
    advance(d, row->steps);
    const size_t size = 2 * (row->n + 1);
    long double *w = calloc(size, sizeof *w);
    assert_non_null(w);
    br_discrete_get(d, BR_BENDING, w, NULL);
    const struct br_discrete_tip tip = br_discrete_tip(d);
    const struct br_test_end end = {(double)tip.displacement[BR_AXIAL],
                                    (double)tip.displacement[BR_BENDING], (double)w[row->n]};
    /* exp(t) - 1 is a double here */
    AT_MOST(br_test_deviation(&end, &row->end), 1e-14 * br_test_slack());
    CLOSE((double)w[2 * row->n], end.w_tip, 0);
    free(w);
    br_discrete_free(d);
    br_scene_clear(&scene);
}

TEST(test_golden)
{
    struct br_test_golden rows[BR_TEST_MOST_GOLDEN];
    const size_t count = br_test_golden(rows), most = br_test_quick() ? 0 : 3200;
    size_t checked = 0;
    for (size_t i = 0; i < count; i++)
        if (rows[i].n <= most) {
            check_golden(&rows[i]);
            checked++;
        }
    assert_true(checked == 4 || br_test_quick());
}

/* ---- against the solver, which is judged itself: laws, schemes, loads, initial data ---- */

/* Largest difference of the displacements, relative to the largest of them. */
static double deviation(const struct br_discrete *d, const struct br_march *march,
                        enum br_field_kind kind)
{
    long double x[2 * (MOST_N + 1)];
    double w[2 * (MOST_N + 1)], most = 0, largest = 0;
    br_discrete_get(d, kind, x, NULL);
    br_march_get(march, kind, w, NULL);
    for (size_t i = 0; i < br_field_size(br_march_field(march, kind)); i++) {
        const double error = (double)fabsl(x[i] - w[i]);
        most = !(error <= most) ? error : most;
        largest = fmax(largest, fabs((double)x[i]));
    }
    return largest > 0 ? most / largest : most;
}

static void same_as_solver(const struct br_scene *scene, const struct br_method *method,
                           double tolerance)
{
    enum { STEPS = 152 }; /* not 160: the tip of example3 lets go between two steps */
    struct br_discrete *d = created(scene, MOST_N, STEPS, method);
    struct br_march *march = br_test_march(scene, MOST_N, STEPS, method);
    for (size_t step = 8; step <= STEPS; step += 8) {
        advance(d, step);
        br_test_advance(march, step);
        AT_MOST(deviation(d, march, BR_AXIAL), tolerance * br_test_slack());
        AT_MOST(deviation(d, march, BR_BENDING), tolerance * br_test_slack());
    }
    br_march_free(march);
    br_discrete_free(d);
}

/* Every scheme with both friction laws; those that may lag with both contacts. */
static void check_scheme(const char *name, const struct br_time_scheme *scheme, int degree)
{
    for (int rules = scheme->may_lag ? 0 : 2; rules < 4; rules++) {
        struct br_scene scene = br_test_bundled(name);
        struct br_method method = br_test_method("plain", br_contact_rules[rules / 2]->name,
                                                 br_friction_rules[rules % 2]->name);
        method.scheme = scheme;
        method.axial_degree = degree;
        same_as_solver(&scene, &method, 1e-12);
        br_scene_clear(&scene);
    }
}

TEST(test_schemes)
{
    static const char *const scenes[] = {"example1", "example2", "example3", "example4"};
    for (size_t i = 0; i < 4; i++)
        for (size_t j = 0; br_time_schemes[j]; j++)
            if (!br_time_schemes[j]->adaptive)
                check_scheme(scenes[i], br_time_schemes[j], 1 + (int)(i + j) % 2);
}

TEST(test_data)
{
    struct br_scene s = br_test_bare();
    s.duration = 2;
    s.axial.load = br_test_load("100*sin(3*x)*cos(5*t)");
    s.axial.displacement = br_test_function("0.02*x");
    s.axial.velocity = br_test_function("sin(x)");
    s.axial.tip_force = br_test_function("3*cos(2*t)");
    s.bending.load = br_test_load("50*x^2");
    s.bending.displacement = br_test_function("0.3*x^2");
    s.bending.displacement_slope = br_test_function("0.6*x");
    s.bending.velocity = br_test_function("1 - cos(2*x)");
    s.bending.velocity_slope = br_test_function("2*sin(2*x)");
    s.bending.tip_force = br_test_function("1 + t");
    s.bending.tip_moment = br_test_function("sin(4*t)");
    s.contact = (struct br_contact){.modelled = true, .gap = 0.01, .stiffness = 50};
    s.friction = (struct br_friction){.law = BR_COULOMB, .coefficient = 20, .regularisation = 1e-3};
    struct br_method method = br_test_method("plain", "lagged", "regularised");
    same_as_solver(&s, &method, 1e-12);
    s.friction.law = BR_TRESCA;
    method = br_test_method("plain", "implicit", "exact");
    method.axial_degree = 2;
    same_as_solver(&s, &method, 1e-12);
    s.friction.law = BR_FRICTIONLESS;
    same_as_solver(&s, &method, 1e-12);
    s.axial.modelled = s.contact.modelled = false;
    same_as_solver(&s, &method, 1e-12);
    br_function_free(&s.axial.load.term[0].space);
    br_function_free(&s.axial.displacement);
    br_function_free(&s.axial.velocity);
    br_function_free(&s.axial.tip_force);
    br_function_free(&s.bending.load.term[0].space);
    br_function_free(&s.bending.displacement);
    br_function_free(&s.bending.displacement_slope);
    br_function_free(&s.bending.velocity);
    br_function_free(&s.bending.velocity_slope);
    br_function_free(&s.bending.tip_force);
    br_function_free(&s.bending.tip_moment);
}

/* ---- refusals ---- */

TEST(test_refusals)
{
    struct br_error err = {0};
    struct br_scene scene = br_test_bundled("example2");
    struct br_method method = br_method_default();
    struct br_discrete *d;
    REFUSED(br_discrete_create(&d, &scene, 0, 10, &method, &err), BR_BAD_INPUT, "0 elements");
    assert_null(d);
    method.scheme = br_time_scheme_find("adaptive");
    REFUSED(br_discrete_create(&d, &scene, 10, 10, &method, &err), BR_BAD_INPUT, "adaptive");
    method = br_method_default();
    method.friction = br_friction_rule_find("uzawa");
    REFUSED(br_discrete_create(&d, &scene, 10, 10, &method, &err), BR_BAD_INPUT, "uzawa");
    method = br_method_default();
    scene.bending.viscosity = NAN;
    d = created(&scene, 10, 10, &method);
    REFUSED(br_discrete_step(d, &err), BR_SINGULAR, "not positive definite at element 9 of 10");
    br_discrete_free(d);
    br_discrete_free(NULL);
    br_scene_clear(&scene);
}
