/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The scheme ida, where it is built in: against exact values, the adaptive scheme and its own
 * promises; what it refuses, and how it tells that it failed. Without it, nothing is asked. */
#include <math.h>
#include <string.h>

#include "support.h"

static bool is_there(void)
{
    if (br_time_scheme_find("ida"))
        return true;
    print_message("# scheme ida is not built in\n");
    return false;
}

static struct br_method method(const char *scheme, double tolerance, const char *friction)
{
    struct br_method m = br_test_method(NULL, "implicit", friction);
    m.scheme = br_time_scheme_find(scheme);
    m.tolerance = tolerance;
    assert_non_null(m.scheme);
    return m;
}

/* Closed forms of the continuous problem; at the tip the elements have them to ten digits. */
static void test_exact_values(void **state)
{
    (void)state;
    static const struct {
        const char *scene;
        double u, w, middle;
    } exact[] = {
        {"example1", 0.171692329889782302, NAN, NAN},
        {"example2", 0.0429230824724455755, -0.0715950242871993164, NAN},
        {"example3", NAN, -0.24875, -0.129765625},
    };
    for (size_t i = 0; i < sizeof exact / sizeof *exact && is_there(); i++)
        for (double tolerance = 1e-4; tolerance > 1e-9; tolerance /= 100) {
            struct br_scene scene = br_test_bundled(exact[i].scene);
            const struct br_method m = method("ida", tolerance, NULL);
            const struct br_test_end end = br_test_run(&scene, 80, 10, &m);
            print_message("# %s to %g\n", exact[i].scene, tolerance);
            if (!isnan(exact[i].u))
                CLOSE(end.u_tip, exact[i].u, 0.01 * tolerance * exact[i].u + 1e-10);
            if (!isnan(exact[i].w))
                CLOSE(end.w_tip, exact[i].w, 0.01 * tolerance * fabs(exact[i].w) + 1e-12);
            if (!isnan(exact[i].middle))
                CLOSE(end.w_middle, exact[i].middle, 0.01 * tolerance + 1e-12);
            br_scene_clear(&scene);
        }
}

enum { MOST = 20 };

struct outcome {
    struct br_test_end end;
    struct br_switch found[MOST];
    size_t count; /* of switches */
};

static struct outcome outcome_of(const char *name, size_t steps, const struct br_method *m)
{
    struct outcome out = {0};
    struct br_scene scene = br_test_bundled(name);
    struct br_march *march = br_test_march(&scene, 20, steps, m);
    const struct br_switch *first;
    br_test_advance(march, steps);
    out.end.u_tip = br_march_tip_displacement(march, BR_AXIAL);
    out.end.w_tip = br_march_tip_displacement(march, BR_BENDING);
    out.count = br_march_switches(march, &first);
    assert_in_range(out.count, 0, MOST);
    if (out.count)
        memcpy(out.found, first, out.count * sizeof *first);
    br_march_free(march);
    br_scene_clear(&scene);
    return out;
}

/* Against the scheme adaptive to 1e-12 on the same mesh, so that what is left is ida's error in
 * time: of the tip relative to the larger of u and w, over the tolerance; of the switches' times,
 * s, over the tolerance. Measured: a third of these, or less. */
static const struct row {
    const char *scene;
    double error, times;
} rows[] = {
    {"example1", 1, 2},  {"example2", 0.01, 0},   {"example3", 0.01, 0.01}, {"example4", 2, 20},
    {"chatter", 15, 25}, {"reversal", 20, 90},    {"impact", 180, 40},      {"bouncing", 900, 3},
    {"brake", 100, 200}, {"initial_data", 10, 4}, {"moving_load", 130, 0},  {"vibration", 250, 0},
};

static double largest_error(const struct outcome *a, const struct outcome *b)
{
    const double size = fmax(fabs(b->end.u_tip), fabs(b->end.w_tip));
    const double u = fabs(a->end.u_tip - b->end.u_tip), w = fabs(a->end.w_tip - b->end.w_tip);
    return (u > w ? u : w) / size;
}

static void same_switches(const struct outcome *a, const struct outcome *b, double tolerance)
{
    assert_int_equal(a->count, b->count);
    for (size_t i = 0; i < a->count; i++) {
        assert_int_equal(a->found[i].kind, b->found[i].kind);
        assert_int_equal(a->found[i].from, b->found[i].from);
        assert_int_equal(a->found[i].to, b->found[i].to);
        CLOSE(a->found[i].time, b->found[i].time, tolerance);
    }
}

static void test_tolerance(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows && is_there(); i++) {
        const struct br_method judge = method("adaptive", 1e-12, NULL);
        const struct outcome expected = outcome_of(rows[i].scene, 10, &judge);
        for (double tolerance = 1e-4; tolerance > 1e-9; tolerance /= 100) {
            const struct br_method m = method("ida", tolerance, NULL);
            const struct outcome found = outcome_of(rows[i].scene, 10, &m);
            print_message("# %s to %g\n", rows[i].scene, tolerance);
            AT_MOST(largest_error(&found, &expected), rows[i].error * tolerance + 1e-11);
            same_switches(&found, &expected, rows[i].times * tolerance + 1e-11);
        }
    }
}

/* Example 3 lets go at 0.8 s whatever the viscosity, by the balance of moments; Example 1 sticks
 * after 40 microseconds. */
static void test_switches(void **state)
{
    (void)state;
    if (!is_there())
        return;
    const struct br_method m = method("ida", 1e-8, NULL);
    const struct outcome lets_go = outcome_of("example3", 5, &m);
    assert_int_equal(lets_go.count, 1);
    CLOSE(lets_go.found[0].time, 0.8, 1e-6);
    assert_int_equal(lets_go.found[0].from, BR_REGIME_STICK);
    assert_int_equal(lets_go.found[0].to, BR_REGIME_BACKWARD);
    const struct outcome sticks = outcome_of("example1", 5, &m);
    assert_int_equal(sticks.count, 1);
    CLOSE(sticks.found[0].time, 4.0e-5, 0.2e-5);
    assert_int_equal(sticks.found[0].to, BR_REGIME_STICK);
}

/* The law (29), whose corners ida finds as switches. */
static void test_regularised(void **state)
{
    (void)state;
    static const char *const names[] = {"smoothed", "smoothed_coulomb"};
    for (size_t i = 0; i < 2 && is_there(); i++) {
        const struct br_method judge = method("adaptive", 1e-11, "regularised");
        const struct br_method m = method("ida", 1e-7, "regularised");
        const struct outcome expected = outcome_of(names[i], 10, &judge);
        const struct outcome found = outcome_of(names[i], 10, &m);
        AT_MOST(largest_error(&found, &expected), 1e-6);
    }
}

/* Where it is looked at changes no digit, and there the laws hold: |lambda| at most h, and h where
 * it slips against the velocity; the contact presses only. */
static void check_laws(const struct br_scene *scene, const struct br_tip *tip)
{
    const double v = tip->velocity[BR_BENDING], lambda = tip->friction_force;
    const double depth = br_penetration(&scene->contact, tip->displacement);
    assert_true(tip->contact_force >= 0);
    CLOSE(tip->contact_force, scene->contact.stiffness * depth, 1e-9);
    CLOSE(tip->friction_bound, br_friction_bound(scene, depth), 1e-9);
    assert_true(fabs(lambda) <= tip->friction_bound);
    if (fabs(lambda) < tip->friction_bound)
        CLOSE(v, 0, 0);
    else if (tip->friction_bound > 0)
        assert_true(lambda * v >= 0);
}

static void test_looking(void **state)
{
    (void)state;
    if (!is_there())
        return;
    const struct br_method m = method("ida", 1e-7, NULL);
    struct br_scene scene = br_test_bundled("chatter");
    struct br_march *march = br_test_march(&scene, 20, 1000, &m);
    for (size_t step = 1; step <= 1000; step++) {
        br_test_advance(march, step);
        check_laws(&scene, br_march_tip(march));
    }
    const struct br_counts counts = br_march_counts(march);
    assert_in_range(counts.steps, 100, 3000);
    assert_in_range(counts.stages, counts.steps, 10 * counts.steps);
    assert_in_range(counts.set_ups, 10, counts.stages);
    const double u = br_march_tip_displacement(march, BR_AXIAL);
    br_march_free(march);
    br_scene_clear(&scene);
    assert_true(outcome_of("chatter", 7, &m).end.u_tip == u);
}

/* lambda of a tip that sticks, inertia and all, and what the derivatives of the equations are for:
 * few iterations. */
static void test_reaction(void **state)
{
    (void)state;
    if (!is_there())
        return;
    const struct br_method ida = method("ida", 1e-8, NULL), judge = method("adaptive", 1e-11, NULL);
    struct br_scene scene = br_test_bundled("chatter");
    struct br_march *a = br_test_march(&scene, 20, 160, &ida);
    struct br_march *b = br_test_march(&scene, 20, 160, &judge);
    for (size_t step = 9; step <= 37; step++) { /* 0.2 s to 0.93 s */
        br_test_advance(a, step);
        br_test_advance(b, step);
        const struct br_tip *tip = br_march_tip(b);
        assert_true(fabs(tip->friction_force) < tip->friction_bound);
        CLOSE(br_march_tip(a)->friction_force, tip->friction_force, 1e-4 * tip->friction_bound);
    }
    const struct br_counts counts = br_march_counts(a);
    assert_in_range(counts.stages, 1, 2 * counts.steps); /* 1.91 */
    br_march_free(a);
    br_march_free(b);
    br_scene_clear(&scene);
}

/* Nodal values and strain rates belong to one field. */
static void test_fields(void **state)
{
    (void)state;
    if (!is_there())
        return;
    const struct br_method m = method("ida", 1e-6, NULL);
    struct br_scene scene = br_test_bundled("example2");
    struct br_march *march = br_test_march(&scene, 4, 3, &m);
    double w[10], v[10], rate[8];
    br_test_advance(march, 3);
    br_march_get(march, BR_BENDING, w, v);
    br_march_strain_rate(march, BR_BENDING, rate);
    assert_true(w[0] == 0 && w[1] == 0 && v[0] == 0);
    assert_true(w[8] == br_march_tip_displacement(march, BR_BENDING));
    for (size_t e = 0; e < 4; e++) {
        double curvature[2];
        br_curvature(v + 2 * e, curvature);
        assert_true(curvature[0] == rate[2 * e] && curvature[1] == rate[2 * e + 1]);
    }
    br_march_get(march, BR_AXIAL, w, v);
    br_march_strain_rate(march, BR_AXIAL, rate);
    assert_true(w[0] == 0 && w[4] == br_march_tip_displacement(march, BR_AXIAL));
    assert_true(rate[0] == v[1] && rate[3] == v[4] - v[3]);
    br_march_free(march);
    br_scene_clear(&scene);
}

static void refused(const struct br_scene *scene, const struct br_method *m, const char *text)
{
    struct br_error err = {0};
    struct br_march *march;
    REFUSED(br_march_create(&march, scene, 10, 10, m, &err), BR_BAD_INPUT, text);
    assert_null(march);
}

static void test_refusals(void **state)
{
    (void)state;
    if (!is_there())
        return;
    struct br_scene scene = br_test_bundled("example2");
    struct br_method m = method("ida", 1e-6, NULL);
    m.axial_degree = 2;
    refused(&scene, &m, "scheme ida has no quadratic axial elements");
    m = method("ida", 1e-6, NULL);
    m.solver = br_linear_solver_find("plain");
    refused(&scene, &m, "linear solver plain with scheme ida");
    m = method("ida", 1e-6, "uzawa");
    refused(&scene, &m, "friction rule 'uzawa' with scheme ida");
    m = method("ida", 0, NULL);
    refused(&scene, &m, "the tolerance of time scheme 'ida' is 0");
    m = method("ida", 1e-6, NULL);
    m.contact = br_contact_rule_find("lagged");
    refused(&scene, &m, "contact rule 'lagged' does not go with time scheme 'ida'");
    m = method("ida", 1e-6, NULL);
    m.linear.kernel = br_linear_solver_kernel(m.solver, &m.linear);
    refused(&scene, &m, "with scheme ida, expected none to be given");
    m = method("ida", 1e-6, NULL);
    scene.density = 0;
    refused(&scene, &m, "density 0 with scheme ida");
    br_scene_clear(&scene);
}

/* A soft rod under a load, which fails with a message. */
static void fails(const char *load, double tolerance, const char *text)
{
    struct br_error err = {0};
    struct br_scene scene = br_test_bare();
    struct br_march *march;
    const struct br_method m = method("ida", tolerance, NULL);
    scene.axial.stiffness = scene.axial.viscosity = 1e-6;
    scene.axial.load = br_test_load(load);
    enum br_status status = br_march_create(&march, &scene, 10, 1, &m, &err);
    if (!status)
        status = br_march_step(march, &err);
    REFUSED(status, BR_NOT_FINITE, text);
    br_march_free(march);
    br_load_clear(&scene.axial.load);
}

static void test_failures(void **state)
{
    (void)state;
    if (!is_there())
        return;
    fails("sqrt(0.47 - t)", 1e-6, "axial load: ");
    fails("1/(t - 0.471)^2", 1e-6, "axial load: ");
}

/* Free fall of such a rod, thrown at t = 0.47 s: statics would mislead the scale of the tolerance.
 */
static void test_thrown(void **state)
{
    (void)state;
    if (!is_there())
        return;
    struct br_scene scene = br_test_bare();
    const struct br_method m = method("ida", 1e-6, NULL);
    scene.axial.stiffness = scene.axial.viscosity = 1e-9;
    scene.axial.load = br_test_load("t > 0.47 ? 1000 : 0");
    const struct br_test_end end = br_test_run(&scene, 100, 1, &m);
    CLOSE(end.u_tip, 500 * 0.53 * 0.53 * pow(scene.duration, 2) / scene.density, 0.05);
    br_load_clear(&scene.axial.load);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_exact_values), cmocka_unit_test(test_tolerance),
        cmocka_unit_test(test_switches),     cmocka_unit_test(test_regularised),
        cmocka_unit_test(test_looking),      cmocka_unit_test(test_reaction),
        cmocka_unit_test(test_fields),       cmocka_unit_test(test_refusals),
        cmocka_unit_test(test_failures),     cmocka_unit_test(test_thrown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
