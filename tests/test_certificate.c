/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The certificate itself: it must see every planted fault, and never let a NaN through. That good
 * steps pass is in test_watched. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "reference/certificate/certificate.h"
#include "solver/scene.h"
#include "support.h"

enum { N = 20, SIZE = 2 * (N + 1) };

/* A step taken apart, so that it can be spoilt. */
struct recorded {
    struct br_scene scene;
    struct br_method method;
    double axial[5][SIZE], bending[5][SIZE]; /* displacements and velocities, twice each; loads */
    struct br_checked_step step;
};

static void record(struct recorded *r, const char *contact, const char *friction, double mu,
                   int degree)
{
    *r = (struct recorded){.scene = br_test_bundled("example2")};
    r->scene.friction.regularisation = mu;
    r->method = br_test_method(NULL, contact, friction);
    r->method.axial_degree = degree;
    OWNED(br_march) *march = br_test_march(&r->scene, N, 100, &r->method);
    double(*const nodal[2])[SIZE] = {r->axial, r->bending};
    r->step = (struct br_checked_step){.scene = &r->scene, .method = &r->method, .n = N, .k = 0.01};
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        double(*x)[SIZE] = nodal[kind];
        r->step.field[kind] = (struct br_step_field){x[0], x[1], x[2], x[3], x[4]};
    }
    for (size_t i = 0; i < 2; i++) {
        br_test_advance(march, 60 + i);
        for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++)
            br_march_get(march, kind, nodal[kind][i], nodal[kind][2 + i]);
    }
    br_march_load(march, BR_AXIAL, r->axial[4]);
    br_march_load(march, BR_BENDING, r->bending[4]);
    r->step.tip = *br_march_tip(march);
}

static struct br_certificate certify(const struct br_checked_step *step)
{
    struct br_certificate both = br_certify_field(step, BR_AXIAL);
    const struct br_certificate bending = br_certify_field(step, BR_BENDING);
    br_certificate_merge(&both, &bending);
    return both;
}

static struct br_certificate limits(void)
{
    return br_certificate_limits(br_time_schemes[0], N, 0);
}

/* The step is refused, by the entry whose description contains `what`. */
static void assert_detected(struct recorded *r, const char *what)
{
    const struct br_certificate certificate = certify(&r->step), most = limits();
    REFUSED(br_certificate_check(&certificate, &most, &err), BR_VERDICT, what);
}

static void assert_good(struct recorded *r)
{
    const struct br_certificate certificate = certify(&r->step), most = limits();
    MUST(br_certificate_check(&certificate, &most, &err));
}

/* value * (1 + 1e-6), and back. */
static void assert_detected_in(struct recorded *r, double *value, const char *what)
{
    const double good = *value;
    *value = good * (1 + 1e-6);
    assert_detected(r, what);
    *value = good;
}

TEST(test_planted_faults)
{
    static struct recorded r;
    record(&r, "lagged", "exact", 0, 1);
    assert_good(&r);
    assert_detected_in(&r, &r.axial[4][N / 2], "(27)");
    assert_detected_in(&r, &r.bending[4][N], "(28)");
    assert_detected_in(&r, &r.scene.axial.stiffness, "(27)");
    assert_detected_in(&r, &r.scene.axial.viscosity, "(27)");
    assert_detected_in(&r, &r.scene.bending.stiffness, "(28)");
    assert_detected_in(&r, &r.scene.bending.viscosity, "(28)");
    assert_detected_in(&r, &r.axial[0][N], "");
    assert_detected_in(&r, &r.axial[3][N / 2], "");
    assert_detected_in(&r, &r.bending[0][N], "the update");
    assert_detected_in(&r, &r.bending[3][N], "");
    assert_detected_in(&r, &r.axial[1][N / 2], "(27)");
    assert_detected_in(&r, &r.bending[1][N], "(28)");
    assert_detected_in(&r, &r.step.tip.friction_force, "(28)");
    assert_detected_in(&r, &r.step.tip.contact_force, "(27)");
    assert_detected_in(&r, &r.step.tip.friction_bound, "(12)");
    assert_detected_in(&r, &r.step.tip.displacement, "the update");
    assert_detected_in(&r, &r.step.tip.velocity[BR_AXIAL], "the update");
    assert_detected_in(&r, &r.step.tip.velocity[BR_BENDING], "the update");
    assert_detected_in(&r, &r.scene.friction.coefficient, "(12)");
    assert_detected_in(&r, &r.scene.contact.stiffness, "(10)");
    assert_good(&r);
    br_scene_clear(&r.scene);
}

/* The mass has little weight in Example 2: a thousandth of its velocity is still seen. */
TEST(test_planted_velocity)
{
    static struct recorded r;
    record(&r, "lagged", "exact", 0, 1);
    for (int field = 0; field < 2; field++) {
        double *velocity = field ? r.bending[2] : r.axial[2];
        for (size_t i = 0; i < SIZE; i++)
            velocity[i] *= 1.001;
        assert_detected(&r, field ? "(28)" : "(27)");
        for (size_t i = 0; i < SIZE; i++)
            velocity[i] /= 1.001;
    }
    r.scene.density *= 1.001;
    assert_detected(&r, "(27)");
    br_scene_clear(&r.scene);
}

/* Each law taken for the other one. */
TEST(test_wrong_law)
{
    static struct recorded r;
    record(&r, "lagged", "exact", 0, 1);
    r.method.contact = br_contact_rule_find("implicit");
    assert_detected(&r, "(10)");
    const struct br_contact_rule unknown = {.name = "unknown"};
    r.method.contact = &unknown;
    assert_detected(&r, "(10)");
    br_scene_clear(&r.scene);

    record(&r, "implicit", "regularised", 0.1, 1); /* |v| < mu: it sticks, and creeps */
    assert_good(&r);
    r.method.contact = br_contact_rule_find("lagged");
    assert_detected(&r, "(10)");
    r.method.contact = br_contact_rule_find("implicit");
    r.method.friction = br_friction_rule_find("exact");
    assert_detected(&r, "(12)");
    br_scene_clear(&r.scene);
}

/* The graph of the exact law: on it, and off it in each direction, by however little: the force by
 * some last bits, the speed, which has the round-off of velocities, by a few hundred. */
TEST(test_friction_graph)
{
    static const struct {
        double v, lambda, off; /* off: at least; 0: on it */
    } points[] = {
        {0, 0, 0},
        {0, 2.9, 0},
        {0, -3, 0},
        {0.5, 3, 0},
        {-0.5, -3, 0},
        {0.5, -3, 0.03},
        {-0.5, 3, 0.03},
        {0.5, 2, 0.03},
        {0.5, 0, 0.03},
        {0, 3.1, 0.03},
        {0.5, 3.1, 0.03},
        {-0.5, -3.1, 0.03},
        {0, 3 + 3e-14, 9e-15},
        {0.5, 3 + 3e-14, 9e-15},
        {0.5, 3 - 3e-14, 9e-15},
        {-0.5, -3 + 3e-14, 9e-15},
        {1e-12, 2, 1e-13},
        {-1e-12, 3, 1e-13},
    };
    struct br_scene scene = br_test_bare();
    scene.axial.modelled = false;
    scene.friction = (struct br_friction){.law = BR_TRESCA, .coefficient = 3};
    const struct br_method method = br_method_default();
    for (size_t i = 0; i < sizeof points / sizeof *points; i++) {
        const double zero[4] = {0}, velocity[4] = {0, 0, points[i].v, 1};
        const struct br_checked_step step = {
            .scene = &scene,
            .method = &method,
            .n = 1,
            .k = 1,
            .field[BR_BENDING] = {zero, velocity, zero, velocity, zero},
            .tip = {.velocity[BR_BENDING] = points[i].v,
                    .friction_force = points[i].lambda,
                    .friction_bound = 3},
        };
        const double distance = certify(&step).friction;
        assert_true(points[i].off > 0 ? distance >= points[i].off : distance <= 1e-15);
    }
}

/* What was largest before lends only its last bit: a slip of a thousandth of what moves now is
 * seen, where all was 1e9 times as large before. */
TEST(test_last_bit_of_before)
{
    struct br_scene scene = br_test_bare();
    scene.axial.modelled = false;
    scene.friction = (struct br_friction){.law = BR_TRESCA, .coefficient = 3};
    const struct br_method method = br_method_default();
    const double zero[4] = {0}, velocity[4] = {0, 0, 1e-12, 1e-9};
    double largest[2][BR_SCALES];
    for (int i = 0; i < 2 * BR_SCALES; i++)
        largest[i / BR_SCALES][i % BR_SCALES] = 1;
    const struct br_checked_step step = {
        .scene = &scene,
        .method = &method,
        .n = 1,
        .k = 1,
        .largest = largest,
        .field[BR_BENDING] = {zero, velocity, zero, velocity, zero},
        .tip = {.velocity[BR_BENDING] = 1e-12, .friction_bound = 3}};
    assert_true(certify(&step).friction >= 1e-4);
}

/* The norm of a residual is that of the moment (or the force) that balances it: a force P
 * too much at the tip of a beam at rest, P (L - x), so |m| = P (L^3/3)^1/2. */
TEST(test_residual_norm)
{
    struct br_scene scene = br_test_bare();
    scene.length = 3;
    scene.friction = (struct br_friction){.law = BR_TRESCA, .coefficient = 10};
    const struct br_method method = br_method_default();
    const double zero[2 * 4] = {0};
    double load[2 * 4] = {0};
    load[2 * 3 + 1] = 2; /* a moment of 2 h = 2 N m at the tip: |m| = 2 L^1/2 */
    const struct br_checked_step step = {
        .scene = &scene,
        .method = &method,
        .n = 3,
        .k = 1,
        .field = {{zero, zero, zero, zero, zero}, {zero, zero, zero, zero, load}},
        .tip = {.friction_force = 1, .friction_bound = 10},
    };
    /* m = (L - x) - 2 over L = 3: its square integrates to 3; the terms to 9 and 12 */
    CLOSE(certify(&step).bending_residual, sqrt(3) / (sqrt(9) + sqrt(12)), 1e-15);
    assert_true(certify(&step).axial_residual == 0);
}

/* Quadratic elements: a bubble that is off is seen. */
TEST(test_wrong_bubble)
{
    static struct recorded r;
    record(&r, "lagged", "exact", 0, 2);
    assert_good(&r);
    assert_detected_in(&r, &r.axial[4][N + 1], "(27)");
    assert_detected_in(&r, &r.axial[1][N + 1], "(27)");
    assert_detected_in(&r, &r.axial[3][N + 1], "");
    br_scene_clear(&r.scene);
}

/* The size of a force on the last bubble beside one on the tip: its normal force stays in its
 * element, 3 f (2 xi - 1). */
TEST(test_size_of_residual)
{
    static const double rest[10], load[10] = {[9] = -0.5};
    struct br_scene scene = br_test_bare();
    scene.length = 1.5;
    scene.bending.modelled = false;
    struct br_method method = br_method_default();
    method.axial_degree = 2;
    const struct br_checked_step step = {.scene = &scene,
                                         .method = &method,
                                         .n = 4,
                                         .k = 0.1,
                                         .field = {{rest, rest, rest, rest, load}},
                                         .tip = {.contact_force = 2}};
    const double tip = 2 * sqrt(1.5), bubble = 0.5 * sqrt(3 * 1.5 / 4);
    CLOSE(certify(&step).axial_residual, hypot(tip, bubble) / (tip + bubble), 1e-14);
}

/* ---- what is no number ---- */

/* A NaN or an infinity anywhere fails every entry. */
static void assert_all_nan(const struct recorded *r)
{
    const struct br_certificate c = certify(&r->step);
    assert_true(isnan(c.axial_residual) && isnan(c.bending_residual) && isnan(c.update) &&
                isnan(c.friction) && isnan(c.contact));
}

TEST(test_not_finite)
{
    static struct recorded r;
    record(&r, "lagged", "exact", 0, 1);
    static const double bad[] = {NAN, INFINITY, -INFINITY};
    for (size_t b = 0; b < 3; b++) {
        double *values[] = {&r.step.tip.displacement,   &r.step.tip.velocity[0],
                            &r.step.tip.velocity[1],    &r.step.tip.contact_force,
                            &r.step.tip.friction_force, &r.step.tip.friction_bound};
        for (size_t i = 0; i < sizeof values / sizeof *values; i++) {
            const double good = *values[i];
            *values[i] = bad[b];
            assert_all_nan(&r);
            *values[i] = good;
        }
        for (int a = 0; a < 5; a++)
            for (size_t i = 0; i < SIZE; i += 5) {
                double *value = i <= N ? &r.axial[a][i] : &r.bending[a][i];
                const double good = *value;
                *value = bad[b];
                assert_all_nan(&r);
                *value = good;
            }
    }
    assert_good(&r);
    br_scene_clear(&r.scene);
}

/* The verdict on each entry, at and above its limit, and NaN. */
TEST(test_verdict)
{
    const struct br_certificate most = {1, 2, 3, 4, 5};
    struct br_certificate c = most;
    MUST(br_certificate_check(&c, &most, &err));
    double *const entries[] = {&c.axial_residual, &c.bending_residual, &c.update, &c.friction,
                               &c.contact};
    static const char *const names[] = {"(27)", "(28)", "update", "friction", "contact"};
    for (size_t i = 0; i < 5; i++) {
        const double good = *entries[i];
        *entries[i] = nextafter(good, 9);
        REFUSED(br_certificate_check(&c, &most, &err), BR_VERDICT, names[i]);
        *entries[i] = NAN;
        REFUSED(br_certificate_check(&c, &most, &err), BR_VERDICT, names[i]);
        *entries[i] = good;
    }
}

/* 64 last bits a node, and what an adaptive step loses at a switch or just after the start. */
TEST(test_limits)
{
    const struct br_time_scheme *adaptive = br_time_scheme_find("adaptive");
    const struct br_certificate c = br_certificate_limits(br_time_schemes[0], 9, 0),
                                a = br_certificate_limits(adaptive, 9, 0);
    AT_MOST(c.axial_residual, 1.5e-13);
    AT_MOST(c.bending_residual, 1.5e-12);
    AT_MOST(c.update, 1.5e-13);
    AT_MOST(br_worse_of(c.friction, c.contact), 1.5e-13);
    AT_MOST(a.axial_residual, 1.5e-13);
    AT_MOST(a.bending_residual, 1e-10);
    AT_MOST(br_worse_of(a.friction, a.contact), 1.2e-12);
}

TEST(test_merge)
{
    struct br_certificate worst = {0};
    br_certificate_merge(&worst, &(struct br_certificate){1, 5, NAN, 0, 2});
    br_certificate_merge(&worst, &(struct br_certificate){3, 4, 1, 0, NAN});
    assert_true(worst.axial_residual == 3 && worst.bending_residual == 5 && worst.friction == 0);
    assert_true(isnan(worst.update) && isnan(worst.contact));
}
