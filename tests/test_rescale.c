/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The same scene in other units, and with the beam upside down: all that a study reports, by every
 * reference and in every norm, is the same, in its own unit. What is relative to a wrong length, or
 * squared by mistake, is not. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "rescale.h"
#include "study/fit/fit.h"
#include "study/grid/sweep.h"
#include "study/run/run.h"
#include "support.h"

enum { NORMS = BR_TEST_NORMS, MESHES = 3, STEPS = 3 };
static const size_t meshes[MESHES] = {3, 6, 12}, steps[STEPS] = {10, 20, 40};

/* Both fields and laws, loads of x and t, forces at the tip, and a beam that moves at first; `up`
 * is 1 or -1. */
static struct br_scene made(int up)
{
    struct br_scene scene = br_test_bare();
    const char *const load[] = {"-60*sin(2.7*t+0.3)*(1+x)", "60*sin(2.7*t+0.3)*(1+x)"};
    const char *const force[] = {"-3*sin(t)", "3*sin(t)"};
    const char *const velocity[] = {"-0.2*x^2", "0.2*x^2"}, *const slope[] = {"-0.4*x", "0.4*x"};
    scene.density = 0.5;
    scene.axial.stiffness = 100;
    scene.axial.viscosity = 20;
    scene.axial.load = br_test_load("100*sin(pi*t)+20*x");
    scene.axial.tip_force = br_test_function("5*t");
    scene.bending.stiffness = 20;
    scene.bending.viscosity = 5;
    scene.bending.load = br_test_load(load[up > 0]);
    scene.bending.tip_force = br_test_function(force[up > 0]);
    scene.bending.velocity = br_test_function(velocity[up > 0]);
    scene.bending.velocity_slope = br_test_function(slope[up > 0]);
    scene.contact = (struct br_contact){.modelled = true, .gap = 0.1, .stiffness = 1000};
    scene.friction = (struct br_friction){.law = BR_COULOMB, .coefficient = 30};
    return scene;
}

/* ---- one set of units against another ---- */

/* How many new units an old one is. */
struct factors {
    double metre, second;
    double sign;      /* of the bending field */
    double tolerance; /* relative to the largest of its kind */
};

static double norm_factor(const struct br_norm *norm, const struct factors *f)
{
    if (norm == &br_norm_tip)
        return f->metre;
    const double root = f->metre * sqrt(f->metre); /* of an L2 norm of metres */
    return norm == &br_norm_energy ? root / f->second : root;
}

static double measure_factor(enum br_field_kind kind, int measure, const struct factors *f)
{
    const double root = sqrt(f->metre);
    const double factor[BR_MEASURES] = {
        [BR_DISPLACEMENT] = f->metre * root,
        [BR_VELOCITY] = f->metre * root / f->second,
        [BR_STRAIN_RATE] = (kind == BR_AXIAL ? root : root / f->metre) / f->second,
        [BR_TIP] = f->metre,
    };
    return factor[measure];
}

static void expect(const char *what, double now, double before, double factor, double tolerance)
{
    if (!(fabs(now - factor * before) <= tolerance * fabs(factor * before)) &&
        !(isnan(now) && isnan(before)))
        fail_msg("%s is %.12g in the new units, expected %.12g", what, now, factor * before);
}

/* The same of a reference's own error, which may be round-off: a few times as much is no other
 * unit, where one is a thousand old ones. */
static void expect_about(const char *what, double now, double before, double factor)
{
    const double most = log(5);
    if (!(fabs(log(now / (factor * before))) <= most) && !(now == 0 && before == 0) &&
        !(isnan(now) && isnan(before)))
        fail_msg("%s is %.3g in the new units, expected about %.3g", what, now, factor * before);
}

static void compare_cells(const struct br_study *a, const struct br_study *b,
                          const struct factors *f)
{
    const double sign[2] = {1, f->sign};
    for (size_t i = 0; i < br_study_cells(a); i++) {
        const struct br_cell *x = &a->cell[i], *y = &b->cell[i];
        for (enum br_part part = 0; part < BR_PARTS; part++) {
            expect("an error", y->error[part], x->error[part], norm_factor(a->norm, f),
                   f->tolerance);
            expect("its time", y->worst_time[part], x->worst_time[part], f->second, 1e-12);
        }
        for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++)
            expect("a tip", y->tip[kind], x->tip[kind], f->metre * sign[kind], f->tolerance);
        assert_int_equal(y->unstable, x->unstable);
    }
}

static void compare_references(const struct br_study *a, const struct br_study *b,
                               const struct factors *f)
{
    const double sign[2] = {1, f->sign};
    for (enum br_part part = 0; part < BR_PARTS; part++)
        expect("the reference's measured error", b->reference_error[part], a->reference_error[part],
               norm_factor(a->norm, f), f->tolerance);
    expect("the reference's size", b->reference_scale, a->reference_scale, norm_factor(a->norm, f),
           f->tolerance);
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        expect("the reference's tip", b->reference_tip[kind], a->reference_tip[kind],
               f->metre * sign[kind], f->tolerance);
        for (int m = 0; m < BR_MEASURES; m++)
            expect_about("the reference's own error", b->reference_report.own_error[kind][m],
                         a->reference_report.own_error[kind][m], measure_factor(kind, m, f));
    }
}

/* A minimum may be flat: an order is the same to a tenth of its interval. */
static void compare_joint(const struct br_joint_fit *x, const struct br_joint_fit *y, double norm,
                          const struct factors *f)
{
    if (!br_joint_describes(x))
        return;
    assert_true(br_joint_describes(y));
    for (int axis = 0; axis < BR_AXES; axis++) {
        const struct br_estimate *order = &x->order[axis];
        if (br_order_determined(order))
            CLOSE(y->order[axis].value, order->value, 0.1 * (order->high - order->low));
    }
    const double none[BR_AXES] = {0}, at[] = {1 / 10.0, 1 / 40.0},
                 scaled[] = {f->metre / 10, f->second / 40};
    CLOSE(br_joint_model(y, scaled, none) / norm / br_joint_model(x, at, none), 1, 0.01);
}

/* A reference that knows its error is compared by that, which is round-off; the orders are none. */
static void compare_fits(struct br_study *a, struct br_study *b, const struct factors *f)
{
    for (enum br_part part = 0; part < BR_PARTS; part++) {
        struct br_fits x, y;
        const double norm = norm_factor(a->norm, f);
        MUST(br_fit(a, part, &x, &err));
        MUST(br_fit(b, part, &y, &err));
        expect_about("what limits the cells", y.reference_error, x.reference_error, norm);
        assert_int_equal(x.joint.kind, y.joint.kind);
        compare_joint(&x.joint, &y.joint, norm, f);
        for (size_t i = 0; i < br_study_cells(a); i++)
            assert_int_equal(b->cell[i].flag[part], a->cell[i].flag[part]);
        br_fits_clear(&x);
        br_fits_clear(&y);
    }
}

/* ---- studies ---- */

static void run(const struct br_scene *scene, const struct br_reference *reference_kind,
                struct br_study s[NORMS])
{
    s[0] = br_test_study(scene, reference_kind, MESHES, meshes, STEPS, steps);
    if (reference_kind == &br_reference_fine) {
        s[0].reference = (struct br_resolution){24, 160};
        s[0].reference_check = &br_reference_exact;
    }
    br_test_all_norms(s);
    MUST(br_study_run(s, 1, 2, NULL, &err));
}

static const struct br_reference *const references[] = {&br_reference_exact, &br_reference_fine};
enum { REFERENCES = sizeof references / sizeof *references };

/* The scene as it is, and what is said of it. */
static struct br_scene before;
static struct br_study known[REFERENCES][NORMS];

static int run_once(void **state)
{
    (void)state;
    before = made(1);
    for (size_t j = 0; j < REFERENCES; j++)
        run(&before, references[j], known[j]);
    return 0;
}

static int forget(void **state)
{
    (void)state;
    for (size_t j = 0; j < REFERENCES; j++)
        for (size_t m = 0; m < NORMS; m++)
            br_study_clear(&known[j][m]);
    br_scene_clear(&before);
    return 0;
}

static void compare_studies(size_t reference_kind, const struct br_scene *now,
                            const struct factors *f)
{
    struct br_study *a = known[reference_kind], b[NORMS];
    run(now, references[reference_kind], b);
    for (size_t m = 0; m < NORMS; m++) {
        assert_true(a[m].cell[0].error[BR_PART_BENDING] > 0);
        compare_cells(&a[m], &b[m], f);
        compare_references(&a[m], &b[m], f);
        compare_fits(&a[m], &b[m], f);
        br_study_clear(&b[m]);
    }
}

/* What successive grids say without a reference. */
static struct br_study differences_of(const struct br_scene *scene, enum br_axis axis)
{
    struct br_study over;
    const struct br_study grid = {
        .scene = scene,
        .norm = &br_norm_energy,
        .method = br_method_default(),
        .n_count = MESHES,
        .k_count = STEPS,
        .n = meshes,
        .steps = steps,
    };
    MUST(br_differences_run(&grid, axis, &over, 2, NULL, &err));
    return over;
}

static void compare_differences(const struct br_scene *now, const struct factors *f)
{
    for (enum br_axis axis = 0; axis < BR_AXES; axis++) {
        struct br_study a = differences_of(&before, axis), b = differences_of(now, axis);
        compare_cells(&a, &b, f);
        br_study_clear(&a);
        br_study_clear(&b);
    }
}

/* ---- what is done to the scene ---- */

static struct br_scene in_units(const struct br_units_change *units)
{
    struct br_scene now;
    MUST(br_rescale(&before, units, &now, &err));
    return now;
}

/* ---- certificates and energies of a march ---- */

/* Scenes, NULL: the made one; how they are marched. */
static const struct march {
    const char *scene, *scheme, *contact;
    size_t n, steps;
} marches[] = {
    {NULL, "euler", "lagged", 12, 40},
    {"chatter", "esdirk4", "implicit", 10, 200},
    {"impact", "trbdf2", "implicit", 20, 200},
};

static struct br_run_report watched(const struct br_scene *scene, const struct march *m)
{
    struct br_run_report report;
    struct br_method method = br_test_method(NULL, m->contact, NULL);
    method.scheme = br_time_scheme_find(m->scheme);
    const struct br_run_request request = {
        .scene = scene,
        .method = method,
        .n = m->n,
        .steps = m->steps,
        .check = true,
        .energies = true,
    };
    MUST(br_run(&request, &report, &err));
    assert_int_equal(report.failure.status, BR_OK);
    assert_int_equal(report.verdict.status, BR_OK);
    assert_true(report.checked && report.summed);
    return report;
}

enum { ENERGIES = 21, PURE = 12 };

/* All that is in joules. */
static void list_energies(const struct br_run_report *p, double list[ENERGIES])
{
    const struct br_energy *start = &p->energy_start, *now = &p->energy_now;
    const struct br_work *w = &p->work;
    double *to = list;
    for (int kind = 0; kind < 2; kind++) {
        *to++ = start->kinetic[kind];
        *to++ = start->stored[kind];
        *to++ = now->kinetic[kind];
        *to++ = now->stored[kind];
        *to++ = w->loads[kind];
        *to++ = w->viscous[kind];
        *to++ = w->scheme[kind];
        *to++ = w->noise[kind];
        *to++ = w->gained[kind];
    }
    *to++ = now->contact;
    *to++ = w->friction;
    *to++ = w->scheme_contact;
    assert_ptr_equal(to, list + ENERGIES);
}

/* All that has no unit: what a march is off by, and by how much it may be. */
static void list_pure(const struct br_run_report *p, double list[PURE])
{
    memcpy(list, &p->worst, sizeof p->worst);
    list[5] = p->energy_worst;
    memcpy(list + 6, &p->limits, sizeof p->limits);
    list[11] = p->energy_limit;
}

/* Where no digit is rounded, what is round-off is the same; else it is of its size. */
static void compare_marches(const struct march *m, const struct br_units_change *units,
                            double tolerance)
{
    struct br_scene scene = m->scene ? br_test_bundled(m->scene) : made(1), now;
    MUST(br_rescale(&scene, units, &now, &err));
    const struct br_run_report a = watched(&scene, m), b = watched(&now, m);
    const double joule = units->kilogram * pow(units->metre / units->second, 2);
    double x[ENERGIES], y[ENERGIES], p[PURE], q[PURE];
    list_energies(&a, x);
    list_energies(&b, y);
    list_pure(&a, p);
    list_pure(&b, q);
    for (size_t i = 0; i < ENERGIES; i++)
        expect("an energy", y[i], x[i], joule, tolerance);
    for (size_t i = 0; i < PURE; i++)
        if (tolerance == 0 || i >= PURE / 2)
            expect("a pure number", q[i], p[i], 1, tolerance);
        else
            expect_about("a certificate's number", q[i], p[i], 1);
    assert_memory_equal(a.work.steps, b.work.steps, sizeof a.work.steps);
    assert_memory_equal(a.work.gaining, b.work.gaining, sizeof a.work.gaining);
    br_scene_clear(&now);
    br_scene_clear(&scene);
}

TEST(test_certificates)
{
    static const struct br_units_change fours = {1024, 0.25, 16}, thousand = {1000, 1e-3, 1e3};
    for (size_t i = 0; i < sizeof marches / sizeof *marches; i++) {
        compare_marches(&marches[i], &fours, 0);
        compare_marches(&marches[i], &thousand, 1e-9);
    }
}

/* Powers of two round nothing: a beam of 1024 m has the digits of one of 1 m. */
TEST(test_powers_of_two)
{
    OWNED(br_scene) now = in_units(&(struct br_units_change){1024, 0.125, 32});
    const struct factors f = {1024, 0.125, 1, 1e-12};
    for (size_t j = 0; j < REFERENCES; j++)
        compare_studies(j, &now, &f);
}

TEST(test_other_units)
{
    OWNED(br_scene) now = in_units(&(struct br_units_change){0.001, 700, 11});
    const struct factors f = {0.001, 700, 1, 1e-7};
    compare_studies(0, &now, &f);
    compare_differences(&now, &f);
}

TEST(test_upside_down)
{
    OWNED(br_scene) now = made(-1);
    const struct factors f = {1, 1, -1, 1e-12};
    compare_studies(1, &now, &f);
    compare_differences(&now, &f);
}

AROUND_TESTS(run_once, forget)
