/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Quadratic elements of the rod: the solver against a dense implementation by the nodes (begin,
 * middle, end) that shares no code with it, exact solutions, states, and every step's
 * certificate and energy. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "reference/certificate.h"
#include "reference/energy.h"
#include "support.h"

typedef long double real;

enum { MOST = 32 }; /* nodes of the dense rod, the clamped one included */

/* ---- the dense implementation ---- */

struct dense {
    const struct br_scene *scene;
    size_t n, nodes; /* elements; 2 n + 1 */
    real h, k;
    real mass[MOST][MOST], stiffness[MOST][MOST];
    real u[MOST], v[MOST];
    real contact_force;
};

static void dense_init(struct dense *d, const struct br_scene *scene, size_t n, real k)
{
    static const int mass[3][3] = {{4, 2, -1}, {2, 16, 2}, {-1, 2, 4}};
    static const int stiffness[3][3] = {{7, -8, 1}, {-8, 16, -8}, {1, -8, 7}};
    *d = (struct dense){.scene = scene, .n = n, .nodes = 2 * n + 1};
    d->h = (real)scene->length / (real)n;
    d->k = k;
    for (size_t e = 0; e < n; e++)
        for (size_t i = 0; i < 3; i++)
            for (size_t j = 0; j < 3; j++) {
                d->mass[2 * e + i][2 * e + j] += scene->density * d->h / 30 * mass[i][j];
                d->stiffness[2 * e + i][2 * e + j] += stiffness[i][j] / (3 * d->h);
            }
    for (size_t i = 1; i < d->nodes; i++) {
        const double x = (double)(d->h * (real)i / 2);
        double value;
        br_function_evaluate(&scene->axial.displacement, 1, &x, 0, &value);
        d->u[i] = value;
        br_function_evaluate(&scene->axial.velocity, 1, &x, 0, &value);
        d->v[i] = value;
    }
}

/* Three Gauss points an element: exact for a load that is a polynomial of degree 3. */
static void dense_load(const struct dense *d, double t, real load[MOST])
{
    static const real weight[3] = {5.0L / 18, 8.0L / 18, 5.0L / 18};
    memset(load, 0, MOST * sizeof *load);
    for (size_t e = 0; e < d->n; e++)
        for (int q = 0; q < 3; q++) {
            const real xi = 0.5L + (q - 1) * sqrtl(0.15L);
            const double x = (double)(d->h * ((real)e + xi)), zero = 0;
            double space, time;
            br_function_evaluate(&d->scene->axial.load.term[0].space, 1, &x, t, &space);
            br_function_evaluate(&d->scene->axial.load.term[0].time, 1, &zero, t, &time);
            const real force = d->h * weight[q] * space * time;
            load[2 * e] += force * (1 - xi) * (1 - 2 * xi);
            load[2 * e + 1] += force * 4 * xi * (1 - xi);
            load[2 * e + 2] += force * xi * (2 * xi - 1);
        }
    const double zero = 0;
    double tip;
    br_function_evaluate(&d->scene->axial.tip_force, 1, &zero, t, &tip);
    load[d->nodes - 1] += tip;
}

/* x (in: right side) = (M/k + C + kK)^-1 x by elimination; the clamped node is left out. */
static void dense_solve(const struct dense *d, real x[MOST])
{
    static real a[MOST][MOST];
    const real stiff = (real)d->scene->axial.viscosity + d->k * d->scene->axial.stiffness;
    for (size_t i = 1; i < d->nodes; i++)
        for (size_t j = 1; j < d->nodes; j++)
            a[i][j] = d->mass[i][j] / d->k + stiff * d->stiffness[i][j];
    for (size_t p = 1; p < d->nodes; p++)
        for (size_t i = p + 1; i < d->nodes; i++) {
            const real factor = a[i][p] / a[p][p];
            for (size_t j = p; j < d->nodes; j++)
                a[i][j] -= factor * a[p][j];
            x[i] -= factor * x[p];
        }
    for (size_t p = d->nodes; p-- > 1;) {
        for (size_t j = p + 1; j < d->nodes; j++)
            x[p] -= a[p][j] * x[j];
        x[p] /= a[p][p];
    }
    x[0] = 0;
}

/* One step with the contact force at u_n. */
static void dense_step(struct dense *d, double t)
{
    real v[MOST], z[MOST] = {0};
    const size_t tip = d->nodes - 1;
    dense_load(d, t, v);
    for (size_t i = 1; i < d->nodes; i++)
        for (size_t j = 1; j < d->nodes; j++)
            v[i] += d->mass[i][j] / d->k * d->v[j] -
                    d->scene->axial.stiffness * d->stiffness[i][j] * d->u[j];
    dense_solve(d, v);
    z[tip] = 1;
    dense_solve(d, z);
    const struct br_contact *c = &d->scene->contact;
    const real depth = d->u[tip] + d->k * v[tip] - c->gap;
    d->contact_force =
        c->modelled && depth > 0 ? c->stiffness * depth / (1 + c->stiffness * d->k * z[tip]) : 0;
    for (size_t i = 1; i < d->nodes; i++) {
        d->v[i] = v[i] - d->contact_force * z[i];
        d->u[i] += d->k * d->v[i];
    }
}

/* ---- marches ---- */

static struct br_method quadratic(const char *solver)
{
    struct br_method method = br_test_method(solver, "implicit", NULL);
    method.axial_degree = 2;
    return method;
}

/* Of nodal values of quadratic elements: at dense node i. */
static double at_dense(const double *nodal, size_t i)
{
    return i % 2 == 0 ? nodal[i] : (nodal[i - 1] + nodal[i + 1]) / 2 - nodal[i + 2] / 4;
}

static void check_against_dense(const char *solver, const struct br_scene *scene, size_t n,
                                size_t steps)
{
    static struct dense d;
    const struct br_method method = quadratic(solver);
    const double k = scene->duration / (double)steps;
    struct br_march *march = br_test_march(scene, n, steps, &method);
    dense_init(&d, scene, n, k);
    double u[MOST + 1], v[MOST + 1];
    for (size_t step = 1; step <= steps; step++) {
        br_test_advance(march, step);
        dense_step(&d, br_march_time(march));
        br_march_get(march, BR_AXIAL, u, v);
        for (size_t i = 0; i < d.nodes; i++) {
            CLOSE(at_dense(u, i), (double)d.u[i], 2e-13 * br_test_slack());
            CLOSE(at_dense(v, i), (double)d.v[i], 2e-11 * br_test_slack());
        }
        CLOSE(br_march_tip(march)->displacement, (double)d.u[d.nodes - 1], 2e-13);
        CLOSE(br_march_tip(march)->contact_force, (double)d.contact_force, 1e-9);
    }
    br_march_free(march);
}

static struct br_scene rod_scene(const char *load)
{
    struct br_scene scene = br_test_bare();
    scene.length = 1.5;
    scene.density = 2;
    scene.axial.stiffness = 30;
    scene.axial.viscosity = 0.4;
    scene.bending.modelled = false;
    scene.axial.load = br_test_load(load);
    scene.contact = (struct br_contact){true, 0.01, 500};
    return scene;
}

static const char *const solvers[] = {"plain", "riccati"};

static void test_dense(void **state)
{
    (void)state;
    static const char *const loads[] = {"40", "40*cos(9*t)*(1 + x - 3*x^3)", "20*(x - 1)"};
    for (size_t l = 0; l < sizeof loads / sizeof *loads; l++)
        for (size_t n = 1; n <= 15; n = n < 5 ? n + 1 : 3 * n) {
            struct br_scene scene = rod_scene(loads[l]);
            scene.axial.tip_force = br_test_function("5*sin(7*t)");
            scene.axial.displacement = br_test_function("0.02*x*(2 - x)");
            scene.axial.velocity = br_test_function("sin(2*x)");
            for (size_t s = 0; s < 2; s++)
                check_against_dense(solvers[s], &scene, n, 40);
            br_scene_clear(&scene);
        }
}

/* A steady state under a uniform load is a parabola: on any mesh, everywhere. */
static void test_patch(void **state)
{
    (void)state;
    for (size_t n = 1; n <= 1000; n = n < 3 ? n + 1 : 10 * n) {
        struct br_scene scene = rod_scene("6");
        scene.density = 1e-9;
        scene.axial.viscosity = 0;
        scene.contact.modelled = false;
        const struct br_method method = quadratic("plain");
        struct br_march *march = br_test_march(&scene, n, 1, &method);
        br_test_advance(march, 1);
        double *u = calloc(2 * (n + 1), sizeof *u);
        assert_non_null(u);
        br_march_get(march, BR_AXIAL, u, NULL);
        for (size_t i = 0; i <= 2 * n; i++) {
            const double x = 1.5 * (double)i / (double)(2 * n);
            CLOSE(at_dense(u, i), 6.0 / 30 * x * (1.5 - x / 2), 1e-9);
        }
        free(u);
        br_march_free(march);
        br_scene_clear(&scene);
    }
}

/* ---- what is around a field ---- */

static struct br_field field_of(size_t n)
{
    return (struct br_field){.kind = BR_AXIAL,
                             .n = n,
                             .h = 1.5 / (double)n,
                             .density = 2,
                             .stiffness = 30,
                             .viscosity = 0.4,
                             .k = 0.01,
                             .degree = 2};
}

/* Interpolants of parabolas are the parabolas, but at the clamped end. */
static void test_interpolation(void **state)
{
    (void)state;
    struct br_error err = {0};
    struct br_function f = br_test_function("x*(3 - 2*x)");
    for (size_t n = 1; n < 9; n++) {
        const struct br_field field = field_of(n);
        double nodal[MOST];
        assert_int_equal(br_field_size(&field), 2 * (n + 1));
        MUST(br_interpolate(&field, &f, NULL, nodal, &err));
        for (size_t i = 0; i <= 2 * n; i++) {
            const double x = field.h * (double)i / 2;
            CLOSE(at_dense(nodal, i), x * (3 - 2 * x), 1e-15 * 8);
        }
        CLOSE(nodal[1], 0, 0);
    }
    br_function_free(&f);
}

/* ---- states ---- */

struct both {
    double u[2][24], v[2][24]; /* what is expected, and what is there */
};

static void get(const struct br_field_solver *s, void *self, struct both *b)
{
    s->get(self, b->u[1], b->v[1]);
}

static void random_nodal(struct br_test_random *r, size_t size, double *nodal)
{
    nodal[0] = nodal[1] = 0;
    for (size_t i = 2; i < size; i++)
        nodal[i] = br_test_uniform(r, -1, 1);
}

static void test_states(void **state)
{
    (void)state;
    struct br_error err = {0};
    struct br_test_random r = {11};
    const struct br_field field = field_of(7);
    const struct br_field_solver *s = br_linear_solver_for(br_linear_solver_find("plain"), &field);
    const size_t size = br_field_size(&field);
    void *self;
    struct both one, two;
    MUST(s->create(&field, &br_linear_defaults, &self, &err));
    MUST(s->keep(self, 2, &err));
    random_nodal(&r, size, one.u[0]);
    random_nodal(&r, size, one.v[0]);
    random_nodal(&r, size, two.u[0]);
    random_nodal(&r, size, two.v[0]);
    s->set(self, one.u[0], one.v[0]);
    s->combine(self, 1, 1, (double[]){1});
    s->set(self, two.u[0], two.v[0]);
    MUST(s->set_step(self, 0.003, &err));
    get(s, self, &two);
    for (size_t i = 0; i < size; i++)
        CLOSE(two.u[1][i], two.u[0][i], 1e-15 * 8);
    s->combine(self, 0, 2, (double[]){0.5, -3});
    get(s, self, &one);
    for (size_t i = 0; i < size; i++) {
        CLOSE(one.u[1][i], 0.5 * two.u[0][i] - 3 * one.u[0][i], 2e-14);
        CLOSE(one.v[1][i], 0.5 * two.v[0][i] - 3 * one.v[0][i], 2e-14);
    }
    CLOSE(s->tip_displacement(self), one.u[1][size - 2], 2e-14);
    double sum[2] = {0}, got[2];
    for (size_t e = 0; e < field.n; e++) {
        const double *nodal[2] = {one.u[1] + 2 * e, one.v[1] + 2 * e};
        for (int j = 0; j < 2; j++) /* Simpson's rule of the square of h u_x */
            for (int q = 0; q < 3; q++)
                sum[j] += (q == 1 ? 4 : 1) / 6.0 / field.h *
                          pow(nodal[j][2] - nodal[j][0] + (q - 1) * nodal[j][3], 2);
    }
    s->size(self, 0, got);
    for (int j = 0; j < 2; j++)
        CLOSE(got[j], sqrt(sum[j]), 1e-13 * sqrt(sum[j]));
    s->free(self);
}

/* A step after set_step is a step of a solver that was made for it. */
static void test_set_step(void **state)
{
    (void)state;
    struct br_error err = {0};
    struct br_test_random r = {12};
    struct br_field field = field_of(9);
    const struct br_field_solver *s = br_linear_solver_for(br_linear_solver_find("plain"), &field);
    double u[24], v[24], load[24], other[24], end[24];
    random_nodal(&r, 20, u);
    random_nodal(&r, 20, v);
    random_nodal(&r, 20, load);
    const struct br_drive drive = {.vector = load, .factor = 2, .changed = true, .tip = {3, 0}};
    void *self[2];
    MUST(s->create(&field, &br_linear_defaults, &self[0], &err));
    MUST(s->set_step(self[0], 0.2, &err));
    field.k = 0.2;
    MUST(s->create(&field, &br_linear_defaults, &self[1], &err));
    for (int i = 0; i < 2; i++) {
        double free_velocity;
        s->set(self[i], u, v);
        MUST(s->predict(self[i], &drive, &free_velocity, &err));
        const double tip = s->finish(self[i], 0.7);
        CLOSE(tip, free_velocity - 0.7 * s->tip_compliance(self[i]), 1e-13);
        s->get(self[i], i == 0 ? other : end, NULL);
        s->free(self[i]);
    }
    assert_memory_equal(other, end, 20 * sizeof *end);
}

/* ---- certificates ---- */

static void check_scene(const char *name, const char *solver)
{
    struct br_error err = {0};
    struct br_scene scene = br_test_bundled(name);
    const struct br_method method = quadratic(solver);
    struct br_march *march = br_test_march(&scene, 20, 500, &method);
    struct br_witness *witness;
    struct br_energy_meter *meter;
    MUST(br_witness_create(&witness, march, &scene, &method, &err));
    MUST(br_energy_meter_create(&meter, march, &scene, &method, &err));
    const struct br_certificate limits =
        br_certificate_limits(method.scheme, 20, br_march_round_off(march) * br_test_slack());
    for (size_t step = 1; step <= 500; step++) {
        MUST(br_march_step(march, &err));
        const struct br_certificate c = br_witness_step(witness);
        MUST(br_certificate_check(&c, &limits, &err));
        AT_MOST(br_energy_meter_step(meter),
                br_energy_limit(20, br_march_round_off(march)) * br_test_slack());
    }
    struct br_energy start, now;
    struct br_work work;
    br_energy_meter_read(meter, &start, &now, &work);
    AT_MOST(fabs(br_energy_imbalance(&start, &now, &work)), 1e-12 * br_test_slack());
    br_energy_meter_free(meter);
    br_witness_free(witness);
    br_march_free(march);
    br_scene_clear(&scene);
}

static void test_certificates(void **state)
{
    (void)state;
    static const char *const scenes[] = {"example2", "chatter", "impact", "initial_data",
                                         "moving_load"};
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++)
        for (size_t s = 0; s < 2; s++)
            check_scene(scenes[i], solvers[s]);
}

/* What a certificate is for: a bubble that is off is seen. */
static void test_wrong_bubble(void **state)
{
    (void)state;
    struct br_scene scene = rod_scene("40*x");
    const struct br_method method = quadratic("plain");
    struct br_march *march = br_test_march(&scene, 4, 50, &method);
    double before[2][10], after[2][10], load[10];
    br_test_advance(march, 3);
    br_march_get(march, BR_AXIAL, before[0], before[1]);
    br_test_advance(march, 4);
    br_march_get(march, BR_AXIAL, after[0], after[1]);
    br_march_load(march, BR_AXIAL, load);
    struct br_step step = {.scene = &scene,
                           .method = &method,
                           .n = 4,
                           .k = br_march_field(march, BR_AXIAL)->k,
                           .field = {{before[0], after[0], before[1], after[1], load}},
                           .tip = *br_march_tip(march)};
    AT_MOST(br_certify(&step).axial_residual, 1e-13);
    load[5] *= 1.01;
    if (!(br_certify(&step).axial_residual > 1e-5))
        fail_msg("a wrong load of a bubble is not seen: %g", br_certify(&step).axial_residual);
    load[5] /= 1.01;
    after[1][5] *= 1.1;
    const struct br_certificate wrong = br_certify(&step);
    if (!(wrong.axial_residual > 1e-5 && wrong.update > 1e-5))
        fail_msg("a wrong bubble is not seen: %g, %g", wrong.axial_residual, wrong.update);
    br_march_free(march);
    br_scene_clear(&scene);
}

/* The size of a force on the last bubble beside one on the tip: its normal force stays in its
 * element, 3 f (2 xi - 1). */
static void test_size_of_residual(void **state)
{
    (void)state;
    static const double rest[10], load[10] = {[9] = -0.5};
    struct br_scene scene = rod_scene("0");
    const struct br_method method = quadratic("plain");
    const struct br_step step = {.scene = &scene,
                                 .method = &method,
                                 .n = 4,
                                 .k = 0.1,
                                 .field = {{rest, rest, rest, rest, load}},
                                 .tip = {.contact_force = 2}};
    const double tip = 2 * sqrt(1.5), bubble = 0.5 * sqrt(3 * 1.5 / 4);
    CLOSE(br_certify(&step).axial_residual, hypot(tip, bubble) / (tip + bubble), 1e-14);
    br_scene_clear(&scene);
}

/* ---- refusals ---- */

static void test_refusals(void **state)
{
    (void)state;
    struct br_error err = {0};
    struct br_scene scene = br_test_bare();
    struct br_method method = quadratic("umfpack");
    struct br_march *march;
    REFUSED(br_march_create(&march, &scene, 4, 4, &method, &err), BR_BAD_INPUT,
            "'umfpack' has no quadratic axial elements, expected one of riccati, plain");
    assert_null(march);
    scene.axial.modelled = false; /* nothing to refuse */
    MUST(br_march_create(&march, &scene, 4, 4, &method, &err));
    br_march_free(march);
    for (int degree = 0; degree <= 3; degree += 3) {
        method = br_method_default();
        method.axial_degree = degree;
        REFUSED(br_march_create(&march, &scene, 4, 4, &method, &err), BR_BAD_INPUT,
                "expected 1 or 2");
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_dense),         cmocka_unit_test(test_patch),
        cmocka_unit_test(test_interpolation), cmocka_unit_test(test_states),
        cmocka_unit_test(test_set_step),      cmocka_unit_test(test_certificates),
        cmocka_unit_test(test_wrong_bubble),  cmocka_unit_test(test_size_of_residual),
        cmocka_unit_test(test_refusals),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
