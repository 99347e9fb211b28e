/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cases whose solution is known in closed form, for every solver of the registry, and a symmetry to
 * the last bit. All else that a march does is compared in test_extreme_marches. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "solver/function.h"
#include "solver/linear/linear_solver.h"
#include "solver/scene.h"
#include "support.h"

enum { MOST_N = 64 };

/* One static step: no mass, no viscosity, k = 1, so that v_1 = w_1 = K^-1 F. */
static struct br_field static_field(enum br_field_kind kind, size_t n, double length,
                                    double stiffness)
{
    return (struct br_field){
        .kind = kind, .n = n, .h = length / (double)n, .stiffness = stiffness, .k = 1};
}

/* Solves with a load vector and a force that resists the tip; nodal: out. */
static void solve_once(const struct br_linear_solver *s, const struct br_field *field,
                       const double *load, double tip_force, double *nodal)
{
    struct br_error err = {0};
    void *self;
    double free_velocity;
    const struct br_field_solver *solver = br_linear_solver_for(s, field);
    MUST(solver->create(field, NULL, &self, &err));
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
    const struct br_linear_solver *taken = br_linear_solver_taken(s, field, 0);
    return br_test_slack() * (1e-13 + taken->round_off(field));
}

/* A uniform load: nodal values of the exact solution, u = f x (2L - x) / (2a) and
 * w = f x^2 (6L^2 - 4Lx + x^2) / (24a). */
TEST(test_uniform_load)
{
    const struct br_function f = {.constant = 8};
    const double length = 2.5;
    for (const struct br_linear_solver *const *s = br_linear_solvers; *s; s++)
        for (size_t n = 1; n <= MOST_N; n = 2 * n + 1)
            for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
                struct br_error err = {0};
                const struct br_field field = static_field(kind, n, length, 40);
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
    const struct br_field_solver *solver = br_linear_solver_for(s, field);
    MUST(solver->create(field, NULL, &self, &err));
    const double z = solver->tip_compliance(self);
    solver->free(self);
    return z;
}

/* With mass, a step is a rod or a beam on an elastic foundation of stiffness rho/k:
 *     z = tanh(y) / (b s),                               b^2 = rho/(k s), y = bL, s = c + ka
 *     z = 2b/f (sinh 2y - sin 2y)/2 / (cosh^2 y + cos^2 y),  4b^4 = f/s, f = rho/k
 * (Hetenyi 1946). The discrete one converges like h^2, and like h^4. */
TEST(test_dynamic_compliance)
{
    const double length = 1.5, foundation = 50 / 0.01, s = 0.3 + 0.01 * 20;
    const double b = sqrt(foundation / s), rod = tanh(b * length) / (b * s);
    const double beta = pow(foundation / s / 4, 0.25), y = beta * length;
    const double beam =
        beta / foundation * (sinh(2 * y) - sin(2 * y)) / (cosh(y) * cosh(y) + cos(y) * cos(y));
    for (const struct br_linear_solver *const *solver = br_linear_solvers; *solver; solver++) {
        double last[2] = {0, 0};
        for (size_t n = 400; n <= 800; n *= 2)
            for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
                const struct br_field field = {kind, n, length / (double)n, 50, 20, 0.3, 0.01, 1};
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
TEST(test_rigid_motion)
{
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
TEST(test_mirrored)
{
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

/* ---- forces and moments on the tip ---- */

/* Without inertia, with the stiffness a and the viscosity c, a load that begins at t = 0 makes the
 * beam creep towards its static shape S like S (1 - exp(-a t / c)), of which implicit Euler makes
 * S (1 - (1 + k a / c)^-n); both elements hold that shape to all digits. */
enum { N = 7, STEPS = 30 };
static const double length = 1.5, duration = 2, stiffness = 40, viscosity = 25;

static struct br_scene creeping_scene(void)
{
    return (struct br_scene){
        .length = length,
        .duration = duration,
        .axial = {.modelled = true, .stiffness = stiffness, .viscosity = viscosity},
        .bending = {.modelled = true, .stiffness = stiffness, .viscosity = viscosity},
    };
}

static double creep(size_t step)
{
    return 1 - pow(1 + duration / STEPS * stiffness / viscosity, -(double)step);
}

/* Static shapes of a force F and a moment M at the tip. */
static double pulled(double force, double x)
{
    return force * x / stiffness;
}

static double bent(double force, double moment, double x)
{
    return (force * x * x * (3 * length - x) / 6 + moment * x * x / 2) / stiffness;
}

static void check_creep(const struct br_linear_solver *solver)
{
    struct br_scene scene = creeping_scene();
    scene.axial.tip_force.constant = 3;
    scene.bending.tip_force.constant = -2;
    scene.bending.tip_moment.constant = 0.7;
    struct br_method method = br_method_default();
    method.solver = solver;
    struct br_march *march = br_test_march(&scene, N, STEPS, &method);
    double u[N + 1], w[2 * (N + 1)];
    for (size_t step = 1; step <= STEPS; step++) {
        br_test_advance(march, step);
        br_march_get(march, BR_AXIAL, u, NULL);
        br_march_get(march, BR_BENDING, w, NULL);
        for (size_t i = 1; i <= N; i++) {
            const double x = length * (double)i / N;
            assert_true(fabs(u[i] / (creep(step) * pulled(3, x)) - 1) <= 1e-12);
            assert_true(fabs(w[2 * i] / (creep(step) * bent(-2, 0.7, x)) - 1) <= 1e-11);
        }
    }
    br_march_free(march);
}

TEST(test_creep)
{
    for (size_t i = 0; br_linear_solvers[i]; i++)
        check_creep(br_linear_solvers[i]);
}

TEST(test_not_finite)
{
    struct br_scene scene = creeping_scene();
    scene.bending.tip_moment = br_test_function("1/(1-t)");
    const struct br_method method = br_method_default();
    struct br_error err = {0};
    struct br_march *march = br_test_march(&scene, N, 2, &method);
    REFUSED(br_march_step(march, &err), BR_NOT_FINITE, "the tip moment is inf at t = 1 s");
    br_march_free(march);
    br_scene_clear(&scene);
}
