/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cases whose discrete solution is known in closed form, for every solver of the
 * registry; symmetries; assembled loads and interpolants. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support.h"

enum { MOST_N = 64 };

/* One static step: no mass, no viscosity, k = 1, so that v_1 = w_1 = K^-1 F. */
static struct br_field static_field(enum br_field_kind kind, size_t n, double length,
                                    double stiffness)
{
    return (struct br_field){
        .kind = kind, .n = n, .h = length / (double)n, .stiffness = stiffness, .k = 1};
}

static const struct br_field_solver *solver_of(const struct br_linear_solver *s,
                                               enum br_field_kind kind)
{
    return kind == BR_AXIAL ? s->axial : s->bending;
}

/* Solves with a load vector and a force that resists the tip; nodal: out. */
static void solve_once(const struct br_linear_solver *s, const struct br_field *field,
                       const double *load, double tip_force, double *nodal)
{
    struct br_error err = {0};
    void *self;
    double free_velocity;
    const struct br_field_solver *solver = solver_of(s, field->kind);
    MUST(solver->create(field, &br_linear_defaults, &self, &err));
    MUST(solver->predict(self, &(struct br_drive){load, 1, true, {0, 0}}, &free_velocity, &err));
    const double velocity = solver->finish(self, tip_force);
    CLOSE(velocity, free_velocity - tip_force * solver->tip_compliance(self),
          1e-10 * (fabs(free_velocity) + fabs(velocity)));
    solver->get(self, nodal, NULL);
    CLOSE(solver->tip_displacement(self), nodal[br_field_size(field) - br_field_unknowns(field)],
          1e-14 * fabs(velocity));
    solver->free(self);
}

/* Relative round-off that the solver claims, and a little for the check itself. */
static double tolerance_of(const struct br_linear_solver *s, const struct br_field *field)
{
    return br_test_slack() * (1e-13 + s->round_off(field, &br_linear_defaults));
}

/* A tip force in the rod: constant strain, u = P x / a. */
static void test_constant_strain(void **state)
{
    (void)state;
    for (const struct br_linear_solver *const *s = br_linear_solvers; *s; s++)
        for (size_t n = 1; n <= MOST_N; n = 2 * n + 1) {
            const struct br_field field = static_field(BR_AXIAL, n, 2.5, 40);
            double u[MOST_N + 1];
            solve_once(*s, &field, NULL, -7, u);
            for (size_t i = 0; i <= n; i++)
                CLOSE(u[i], 7 * field.h * (double)i / 40, 0.4375 * tolerance_of(*s, &field));
        }
}

/* A moment M at the tip: constant curvature, w = M x^2 / (2a). Its work on the scaled
 * slope is M/h s. */
static void test_constant_curvature(void **state)
{
    (void)state;
    for (const struct br_linear_solver *const *s = br_linear_solvers; *s; s++)
        for (size_t n = 1; n <= MOST_N; n = 2 * n + 1) {
            const struct br_field field = static_field(BR_BENDING, n, 2.5, 40);
            double load[2 * (MOST_N + 1)] = {0}, w[2 * (MOST_N + 1)];
            load[2 * n + 1] = 3 / field.h;
            solve_once(*s, &field, load, 0, w);
            for (size_t i = 0; i <= n; i++) {
                const double x = field.h * (double)i;
                CLOSE(w[2 * i], 3 * x * x / 80, 0.25 * tolerance_of(*s, &field));
                CLOSE(w[2 * i + 1], field.h * 3 * x / 40, 0.25 * tolerance_of(*s, &field));
            }
        }
}

/* A force at the tip: the cubic w = P x^2 (3L - x) / (6a), exactly. */
static void test_cubic(void **state)
{
    (void)state;
    for (const struct br_linear_solver *const *s = br_linear_solvers; *s; s++)
        for (size_t n = 1; n <= MOST_N; n = 2 * n + 1) {
            const double length = 2.5;
            const struct br_field field = static_field(BR_BENDING, n, length, 40);
            double w[2 * (MOST_N + 1)];
            solve_once(*s, &field, NULL, -3, w);
            for (size_t i = 0; i <= n; i++) {
                const double x = field.h * (double)i;
                CLOSE(w[2 * i], 3 * x * x * (3 * length - x) / 240, 0.4 * tolerance_of(*s, &field));
                CLOSE(w[2 * i + 1], field.h * 3 * x * (2 * length - x) / 80,
                      0.4 * tolerance_of(*s, &field));
            }
        }
}

/* A uniform load: nodal values of the exact solution, u = f x (2L - x) / (2a) and
 * w = f x^2 (6L^2 - 4Lx + x^2) / (24a). */
static void test_uniform_load(void **state)
{
    (void)state;
    const struct br_function f = {.constant = 8};
    const double length = 2.5;
    for (const struct br_linear_solver *const *s = br_linear_solvers; *s; s++)
        for (size_t n = 1; n <= MOST_N; n = 2 * n + 1)
            for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
                struct br_error err = {0};
                const struct br_field field = static_field((enum br_field_kind)kind, n, length, 40);
                double load[2 * (MOST_N + 1)], nodal[2 * (MOST_N + 1)];
                MUST(br_assemble_load(&field, &f, 0, load, &err));
                solve_once(*s, &field, load, 0, nodal);
                for (size_t i = 0; i <= n; i++) {
                    const double x = field.h * (double)i;
                    const double expected =
                        kind == BR_AXIAL
                            ? 8 * x * (2 * length - x) / 80
                            : 8 * x * x * (6 * length * length - 4 * length * x + x * x) / 960;
                    CLOSE(nodal[i * br_field_unknowns(&field)], expected, tolerance_of(*s, &field));
                }
            }
}

static double compliance_of(const struct br_linear_solver *s, const struct br_field *field)
{
    struct br_error err = {0};
    void *self;
    const struct br_field_solver *solver = solver_of(s, field->kind);
    MUST(solver->create(field, &br_linear_defaults, &self, &err));
    const double z = solver->tip_compliance(self);
    solver->free(self);
    return z;
}

/* Without mass z_tip is L/(c + ka), or L^3/(3 (c + ka)), on any mesh. */
static void test_static_compliance(void **state)
{
    (void)state;
    for (const struct br_linear_solver *const *s = br_linear_solvers; *s; s++)
        for (size_t n = 1; n <= 300; n = 3 * n + 1) {
            struct br_field field = static_field(BR_AXIAL, n, 1.5, 1000);
            field.viscosity = 1;
            field.k = 1e-3;
            CLOSE(compliance_of(*s, &field) / (1.5 / 2), 1, tolerance_of(*s, &field));
            field.kind = BR_BENDING;
            CLOSE(compliance_of(*s, &field) / (1.5 * 1.5 * 1.5 / 6), 1, tolerance_of(*s, &field));
        }
}

/* With mass, a step is a rod or a beam on an elastic foundation of stiffness rho/k:
 *     z = tanh(y) / (b s),                               b^2 = rho/(k s), y = bL, s = c + ka
 *     z = 2b/f (sinh 2y - sin 2y)/2 / (cosh^2 y + cos^2 y),  4b^4 = f/s, f = rho/k
 * (Hetenyi 1946). The discrete one converges like h^2, and like h^4. */
static void test_dynamic_compliance(void **state)
{
    (void)state;
    const double length = 1.5, foundation = 50 / 0.01, s = 0.3 + 0.01 * 20;
    const double b = sqrt(foundation / s), rod = tanh(b * length) / (b * s);
    const double beta = pow(foundation / s / 4, 0.25), y = beta * length;
    const double beam =
        beta / foundation * (sinh(2 * y) - sin(2 * y)) / (cosh(y) * cosh(y) + cos(y) * cos(y));
    for (const struct br_linear_solver *const *solver = br_linear_solvers; *solver; solver++) {
        double last[2] = {0, 0};
        for (size_t n = 400; n <= 800; n *= 2)
            for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
                const struct br_field field = {
                    (enum br_field_kind)kind, n, length / (double)n, 50, 20, 0.3, 0.01, 1};
                const double z = compliance_of(*solver, &field);
                const double error = fabs(z / (kind == BR_AXIAL ? rod : beam) - 1);
                AT_MOST(error, kind == BR_AXIAL ? 0.02 : 1e-7);
                if (n == 800) /* order 2, or 4 (until round-off) */
                    AT_MOST(error, last[kind] / (kind == BR_AXIAL ? 3.9 : 8) +
                                       tolerance_of(*solver, &field));
                last[kind] = error;
            }
    }
}

/* A rigid motion has no curvature, to the last bit where it is a binary number. */
static void test_rigid_motion(void **state)
{
    (void)state;
    double curvature[2];
    br_curvature((const double[]){0.75, 0.5, 1.25, 0.5}, curvature);
    assert_true(curvature[0] == 0 && curvature[1] == 0);
    br_curvature((const double[]){0, 0, 0.5, 1}, curvature); /* xi^2 / 2 */
    assert_true(curvature[0] == 1 && curvature[1] == 0);
    br_curvature((const double[]){0, 0, 1, 3}, curvature); /* xi^3: 6 xi = 3 + 3 (2 xi - 1) */
    assert_true(curvature[0] == 3 && curvature[1] == 3);
}

/* Nodal values of two marches of the same mesh, the second times `factor`, bit for bit. */
static void assert_same_bits(const struct br_march *a, const struct br_march *b,
                             enum br_field_kind kind, double factor)
{
    double w[2][2 * (MOST_N + 1)], v[2][2 * (MOST_N + 1)];
    br_march_get(a, kind, w[0], v[0]);
    br_march_get(b, kind, w[1], v[1]);
    for (size_t i = 0; i < br_field_size(br_march_field(a, kind)); i++)
        assert_true(w[0][i] == factor * w[1][i] && v[0][i] == factor * v[1][i]);
}

/* The transverse load turned round: the solution turned round, to the last bit. */
static void test_mirrored(void **state)
{
    (void)state;
    for (const struct br_linear_solver *const *s = br_linear_solvers; *s; s++)
        for (size_t rule = 0; br_friction_rules[rule]; rule++) {
            struct br_method method = br_method_default();
            method.solver = *s;
            method.friction = br_friction_rules[rule];
            struct br_scene scene[2];
            struct br_march *march[2];
            for (int i = 0; i < 2; i++) {
                scene[i] = br_test_bundled("example2");
                br_function_free(&scene[i].bending.load.term[0].time);
                scene[i].bending.load.term[0].time = br_test_function("2000*sin(9*t)");
                scene[i].bending.load.term[0].space.constant = i ? -1 : 1;
                scene[i].friction.regularisation = 1e-3;
                march[i] = br_test_march(&scene[i], 17, 100, &method);
                br_test_advance(march[i], 100);
            }
            assert_same_bits(march[0], march[1], BR_BENDING, -1);
            assert_same_bits(march[0], march[1], BR_AXIAL, 1);
            assert_true(br_march_tip(march[0])->friction_force ==
                        -br_march_tip(march[1])->friction_force);
            assert_true(fabs(br_march_tip(march[0])->friction_force) > 0);
            for (int i = 0; i < 2; i++) {
                br_march_free(march[i]);
                br_scene_clear(&scene[i]);
            }
        }
}

/* Example 2 in other units of length, time and mass. */
static struct br_scene in_units(double metre, double second, double kilogram)
{
    const double newton = kilogram * metre / (second * second);
    struct br_scene s = {
        .length = metre,
        .duration = second,
        .density = 1e-4 * kilogram / metre,
        .axial = {.modelled = true, .stiffness = 1000 * newton, .viscosity = newton * second},
        .bending = {.modelled = true,
                    .stiffness = 1000 * newton * metre * metre,
                    .viscosity = newton * metre * metre * second},
        .contact = {.modelled = true, .stiffness = 1e3 * newton / metre},
        .friction = {.law = BR_COULOMB,
                     .coefficient = 1e4 * newton / metre,
                     .regularisation = 1e-10 * metre / second},
    };
    s.axial.load.term[0].space.constant = 100 * newton / metre;
    s.axial.load.term[0].time.constant = 1;
    s.bending.load.term[0].space.constant = -1000 * newton / metre;
    s.bending.load.term[0].time.constant = 1;
    return s;
}

/* No unit is built in: millimetres, milliseconds and grams give the same beam. */
static void test_units(void **state)
{
    (void)state;
    const struct br_scene si = in_units(1, 1, 1), other = in_units(1e3, 1e3, 1e3);
    for (const struct br_linear_solver *const *s = br_linear_solvers; *s; s++)
        for (size_t i = 0; i < 4; i++) {
            struct br_method method = br_method_default();
            method.solver = *s;
            method.contact = br_contact_rules[i % 2];
            method.friction = br_friction_rules[i / 2];
            const struct br_test_end expected = br_test_run(&si, 20, 100, &method);
            struct br_test_end end = br_test_run(&other, 20, 100, &method);
            end = (struct br_test_end){end.u_tip / 1e3, end.w_tip / 1e3, end.w_middle / 1e3};
            AT_MOST(br_test_deviation(&end, &expected), 1e-10);
        }
}

/* The load vector of f tested with the interpolant of a cubic (or linear) function gives
 * int f phi: here f = x^2 and phi = x^2 (or x), and the same with closed form. */
static void test_load_vectors(void **state)
{
    (void)state;
    struct br_error err = {0};
    struct br_function square = br_test_function("x^2"), slope = br_test_function("2*x"),
                       line = br_test_function("x"), in_time = br_test_function("3*t");
    for (size_t n = 1; n <= 9; n++) {
        struct br_field beam = static_field(BR_BENDING, n, 1.5, 1);
        struct br_field rod = static_field(BR_AXIAL, n, 1.5, 1);
        double load[20], phi[20], work = 0;
        MUST(br_interpolate(&beam, &square, &slope, phi, &err));
        MUST(br_assemble_load(&beam, &square, 0, load, &err));
        for (size_t i = 0; i < 2 * (n + 1); i++)
            work += load[i] * phi[i];
        CLOSE(work, pow(1.5, 5) / 5, 1e-14);

        MUST(br_assemble_load(&beam, &in_time, 2, load, &err));
        work = 0;
        for (size_t i = 0; i < 2 * (n + 1); i++)
            work += load[i] * phi[i];
        CLOSE(work, 6 * pow(1.5, 3) / 3, 1e-14);

        MUST(br_interpolate(&rod, &line, NULL, phi, &err));
        MUST(br_assemble_load(&rod, &square, 0, load, &err));
        work = 0;
        for (size_t i = 0; i <= n; i++)
            work += load[i] * phi[i];
        CLOSE(work, pow(1.5, 4) / 4, 1e-14);
    }
    br_function_free(&square);
    br_function_free(&slope);
    br_function_free(&line);
    br_function_free(&in_time);
}

/* A march starts from the interpolant of its initial data. */
static void test_initial_data(void **state)
{
    (void)state;
    for (const struct br_linear_solver *const *s = br_linear_solvers; *s; s++) {
        struct br_scene scene = br_test_bare();
        scene.length = 1.5;
        scene.axial.displacement = br_test_function("sin(x)");
        scene.axial.velocity = br_test_function("x^2");
        scene.bending.displacement = br_test_function("x^3");
        scene.bending.displacement_slope = br_test_function("3*x^2");
        scene.bending.velocity = br_test_function("1 - cos(x)");
        scene.bending.velocity_slope = br_test_function("sin(x)");
        struct br_method method = br_method_default();
        method.solver = *s;
        struct br_march *march = br_test_march(&scene, 6, 5, &method);
        double u[14], v[14], w[14], z[14];
        br_march_get(march, BR_AXIAL, u, v);
        br_march_get(march, BR_BENDING, w, z);
        for (int i = 0; i <= 6; i++) {
            const double x = 0.25 * i;
            CLOSE(u[i], sin(x), 1e-14);
            CLOSE(v[i], x * x, 1e-13);
            CLOSE(w[2 * i], x * x * x, 1e-13);
            CLOSE(w[2 * i + 1], 0.25 * 3 * x * x, 1e-13);
            CLOSE(z[2 * i], 1 - cos(x), 1e-13);
            CLOSE(z[2 * i + 1], 0.25 * sin(x), 1e-13);
        }
        CLOSE(br_march_tip(march)->displacement, sin(1.5), 1e-14);
        CLOSE(br_march_tip_displacement(march, BR_BENDING), 3.375, 1e-13);
        br_march_free(march);
        br_scene_clear(&scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_constant_strain),
        cmocka_unit_test(test_constant_curvature),
        cmocka_unit_test(test_cubic),
        cmocka_unit_test(test_uniform_load),
        cmocka_unit_test(test_static_compliance),
        cmocka_unit_test(test_dynamic_compliance),
        cmocka_unit_test(test_rigid_motion),
        cmocka_unit_test(test_mirrored),
        cmocka_unit_test(test_units),
        cmocka_unit_test(test_load_vectors),
        cmocka_unit_test(test_initial_data),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
