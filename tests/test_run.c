/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A march that is watched: rows and looks, events, energies, what is modelled. */
#include "study/run/run.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "reference/textbook.h"
#include "tests/support.h"

/* ---- energies ---- */

/* Half of a'Ma or a'Ka of nodal values, by the reference's elements, J. */
static double energy_of(const struct br_field *f, enum br_element_matrix matrix, const double *a)
{
    const struct br_element *e = br_element_of(f->kind, f->degree);
    double sum = 0;
    for (size_t i = 0; i < f->n; i++)
        sum += (double)br_element_product(e, matrix, a + i * e->unknowns, a + i * e->unknowns) / 2;
    return matrix == BR_MASS ? sum * f->density * f->h : sum * f->stiffness / pow(f->h, e->power);
}

/* On L = 2: u = x, w = x^2 lie in the spaces, so their energies are exact. */
TEST(test_energy_of_states)
{
    struct br_scene scene = br_test_bare();
    scene.length = 2;
    scene.density = 3;
    scene.axial.stiffness = 5;
    scene.bending.stiffness = 7;
    struct br_function x = br_test_function("x"), square = br_test_function("x^2"),
                       twice = br_test_function("2*x");
    struct br_field axial = br_field_of_scene(&scene, BR_AXIAL, 6, 0.1, 1);
    const struct br_field bending = br_field_of_scene(&scene, BR_BENDING, 6, 0.1, 1);
    double u[14], w[14];
    for (axial.degree = 1; axial.degree <= 2; axial.degree++) {
        MUST(br_interpolate(&axial, &x, NULL, u, &err));
        CLOSE(energy_of(&axial, BR_STIFFNESS, u), 5.0 / 2 * 2, 1e-14);
        CLOSE(energy_of(&axial, BR_MASS, u), 3.0 / 2 * 8 / 3, 1e-14);
    }
    axial.degree = 2;
    MUST(br_interpolate(&axial, &square, NULL, u, &err));
    CLOSE(energy_of(&axial, BR_STIFFNESS, u), 5.0 / 2 * 32 / 3, 1e-13);
    CLOSE(energy_of(&axial, BR_MASS, u), 3.0 / 2 * 32 / 5, 1e-13);
    MUST(br_interpolate(&bending, &square, &twice, w, &err));
    CLOSE(energy_of(&bending, BR_STIFFNESS, w), 7.0 / 2 * 4 * 2, 1e-12);
    CLOSE(energy_of(&bending, BR_MASS, w), 3.0 / 2 * 32 / 5, 1e-13);
    br_function_free(&x);
    br_function_free(&square);
    br_function_free(&twice);
}

static struct br_run_report run(const struct br_scene *scene, size_t n, size_t steps,
                                const char *contact)
{
    struct br_run_report report;
    const struct br_run_request request = {
        .scene = scene,
        .method = br_test_method(NULL, contact, NULL),
        .n = n,
        .steps = steps,
        .check = true,
    };
    MUST(br_run(&request, &report, &err));
    return report;
}

/* A balance that round-off alone may spoil by more than says something is not checked; others are.
 */
TEST(test_energy_that_says_nothing)
{
    struct br_run_report report;
    OWNED(br_scene) s = br_test_bare();
    s.length = 7;
    s.duration = 2e4;
    s.density = 2000;
    s.axial.modelled = false;
    s.bending.stiffness = 1e-3;
    s.bending.viscosity = 0;
    s.bending.load = br_test_load("-3e10");
    for (size_t n = 20; n <= 3620; n += 3600) {
        const struct br_run_request request = {
            .scene = &s,
            .method = br_test_method("umfpack", NULL, NULL),
            .n = n,
            .steps = 1,
            .check = true,
        };
        MUST(br_run(&request, &report, &err));
        assert_int_equal(report.bad_steps, 0);
        assert_true(n == 20 ? report.energy_limit < br_energy_useless
                            : report.energy_worst > br_energy_useless &&
                                  report.energy_limit == INFINITY);
    }
}

/* A cantilever that creeps to rest under q: q^2 L^5/(40 a) but for the elements' bubbles, which
 * have (h/L)^4/36 of it. The load does twice that work; viscosity and the scheme have the other
 * half. */
TEST(test_energy_at_rest)
{
    const double q = 3, a = 2, exact = q * q / (40 * a) * (1 - pow(1.0 / 8, 4) / 36);
    OWNED(br_scene) scene = br_test_bare();
    scene.duration = 60;
    scene.axial.modelled = false;
    scene.bending.stiffness = a;
    scene.bending.load = br_test_load("3");
    const struct br_run_report p = run(&scene, 8, 6000, NULL);
    CLOSE(p.energy_now.stored[BR_BENDING], exact, 1e-11 * exact);
    AT_MOST(p.energy_now.kinetic[BR_BENDING], 1e-20);
    CLOSE(p.work.loads[BR_BENDING], 2 * exact, 1e-10 * exact);
    CLOSE(p.work.viscous[BR_BENDING] + p.work.scheme[BR_BENDING], exact, 1e-10 * exact);
    AT_MOST(fabs(br_energy_imbalance(&p.energy_start, &p.energy_now, &p.work)), 1e-12);
}

/* ---- events ---- */

static void watch_rows(struct br_tip_watch *w, const double rows[][4], size_t count)
{
    struct br_scene scene = br_test_bare();
    scene.contact = (struct br_contact){true, 1, 1};
    scene.friction.law = BR_COULOMB;
    const struct br_history_observer o = br_tip_watch_start(w, &scene, 10);
    for (size_t i = 0; i < count; i++) {
        const struct br_history_row row = {
            .step = i,
            .time = 0.1 * (double)i,
            .displacement = {rows[i][0], NAN},
            .friction_force = rows[i][1],
            .friction_bound = rows[i][2],
            .velocity = {0, rows[i][3]},
        };
        assert_int_equal(o.step(o.self, NULL, &row, NULL), BR_OK);
    }
}

TEST(test_events)
{
    static const double rows[][4] = {
        {0, NAN, 0, 0},  {0, 0, 0, 1}, /* open: free */
        {2, 5, 5, 1},                  /* closed, slips up */
        {2, 4, 5, 0},                  /* sticks */
        {2, -5, 5, -1},                /* slips down: a reversal through a stick */
        {2, 5, 5, 1},                  /* and at once */
        {1, 0, 0, 1},                  /* opened: u = g is open */
        {1.5, -1, 2, 0},               /* closed and sticks */
        {1.5, 2, 2, 1},                /* slips on in the direction it last did */
    };
    static const struct {
        enum br_tip_event_kind kind;
        size_t step;
        int direction;
    } expected[] = {
        {BR_TIP_CLOSED, 2, 0},    {BR_TIP_SLIPPED, 2, 1},  {BR_TIP_STUCK, 3, 0},
        {BR_TIP_REVERSED, 4, -1}, {BR_TIP_REVERSED, 5, 1}, {BR_TIP_OPENED, 6, 0},
        {BR_TIP_CLOSED, 7, 0},    {BR_TIP_STUCK, 7, 0},    {BR_TIP_SLIPPED, 8, 1},
    };
    static struct br_tip_watch w;
    watch_rows(&w, rows, sizeof rows / sizeof *rows);
    assert_false(w.closed_at_start);
    assert_int_equal(w.regime_at_start, BR_TIP_FREE);
    assert_int_equal(w.events, sizeof expected / sizeof *expected);
    for (size_t i = 0; i < w.events; i++) {
        assert_int_equal(w.event[i].kind, expected[i].kind);
        assert_int_equal(w.event[i].step, expected[i].step);
        assert_int_equal(w.event[i].direction, expected[i].direction);
    }
    assert_int_equal(w.closed_steps, 6);
    assert_int_equal(w.regime_steps[BR_TIP_FREE], 2);
    assert_int_equal(w.regime_steps[BR_TIP_STICK], 2);
    assert_int_equal(w.regime_steps[BR_TIP_SLIP], 4);
    CLOSE(w.friction_work, 0.1 * (5 + 5 + 5 + 2), 1e-14);
    CLOSE(w.friction_force.value, 5, 0);
    CLOSE(w.friction_force.time, 0.2, 1e-15); /* the first of the largest */
}

/* ---- the history ---- */

static void check_rows_and_looks(int degree)
{
    enum { N = 10 };
    OWNED(br_scene) scene = br_test_bundled("initial_data");
    struct br_method method = br_method_default();
    method.axial_degree = degree;
    OWNED(br_history_record) record = {0};
    const struct br_history_observer recorder = br_history_recorder(&record, N);
    static const size_t level[] = {0, 7, 200};
    const struct br_history_request request = {
        .scene = &scene,
        .method = &method,
        .n = N,
        .steps = 200,
        .stride = 3,
        .level = level,
        .levels = 3,
        .observer = &recorder,
        .observers = 1,
    };
    struct br_history_end end;
    MUST(br_history_run(&request, NULL, &end, &err));
    assert_int_equal(record.rows, 68); /* 0, 3, ..., 198, 200 */
    assert_int_equal(record.row[66].step, 198);
    assert_int_equal(record.row[67].step, 200);
    assert_int_equal(end.last.step, 200);
    assert_int_equal(record.samples, 3);
    OWNED(br_march) *again = br_test_march(&scene, N, 200, &method);
    double y[2][2 * (N + 1)];
    for (size_t i = 0; i < 6; i++) {
        const enum br_field_kind kind = i % 2 ? BR_BENDING : BR_AXIAL;
        const size_t size = (kind == BR_BENDING ? 2 : (size_t)degree) * (N + 1) * sizeof(double);
        br_test_advance(again, level[i / 2]);
        assert_int_equal(record.at[i / 2].step, level[i / 2]);
        br_march_get(again, kind, y[0], y[1]);
        assert_memory_equal(br_history_field(&record, i / 2, kind, false), y[0], size);
        assert_memory_equal(br_history_field(&record, i / 2, kind, true), y[1], size);
    }
    const double tip = br_march_tip_displacement(again, BR_BENDING);
    assert_true(record.row[67].displacement[BR_BENDING] == tip);
    assert_true(record.row[67].velocity[BR_BENDING] == br_march_tip(again)->velocity[BR_BENDING]);
    assert_true(isnan(record.row[0].friction_force));
    CLOSE(record.row[0].velocity[BR_AXIAL], -0.5, 1e-15);
}

TEST(test_rows_and_looks)
{
    check_rows_and_looks(1);
    check_rows_and_looks(2);
}

TEST(test_stride)
{
    for (size_t steps = 1; steps < 300; steps++)
        for (size_t rows = 2; rows < 40; rows++) {
            const size_t stride = br_history_stride(steps, rows);
            assert_true(steps / stride + 1 + (steps % stride != 0) <= rows);
            assert_true(stride == 1 ||
                        steps / (stride - 1) + 1 + (steps % (stride - 1) != 0) > rows);
        }
}

struct stop_at {
    size_t step, told;
};

static enum br_status full_disk(void *self, const struct br_march *march,
                                const struct br_history_row *row, struct br_error *why)
{
    (void)march;
    struct stop_at *s = self;
    s->told = row->step;
    return row->step == s->step ? br_fail(why, BR_IO, "the disk is full") : BR_OK;
}

/* An observer's failure is the run's; a march's is a result. */
TEST(test_failures)
{
    struct br_run_report report;
    OWNED(br_scene) scene = br_test_bare();
    scene.axial.load = br_test_load("sqrt(0.705 - t)");
    struct stop_at s = {.step = 5};
    struct br_history_observer observer = {.self = &s, .step = full_disk};
    struct br_run_request request = {.scene = &scene,
                                     .method = br_method_default(),
                                     .n = 4,
                                     .steps = 100,
                                     .output = &observer,
                                     .outputs = 1,
                                     .stride = 50};
    REFUSED(br_run(&request, &report, &err), BR_IO, "the disk is full");
    assert_int_equal(s.told, 5);
    OWNED(br_history_record) record = {0};
    observer = br_history_recorder(&record, 4);
    MUST(br_run(&request, &report, &err));
    assert_int_equal(report.failure.status, BR_NOT_FINITE);
    assert_non_null(strstr(report.failure.message, "axial load: "));
    assert_non_null(strstr(report.failure.message, "t = 0.70999999999999996 s"));
    assert_non_null(strstr(report.failure.message, "the last good step, 70 at t = 0.7 s"));
    assert_int_equal(report.end.last.step, 70);
    assert_int_equal(record.rows, 3); /* 0, 50, 70 */
    assert_int_equal(record.row[2].step, 70);
    assert_false(report.at_end);
}

/* ---- what is modelled ---- */

static const struct br_model_row *find(const struct br_run_report *p, const char *key)
{
    for (size_t i = 0; i < p->model_rows; i++)
        if (strcmp(p->model[i].key, key) == 0)
            return &p->model[i];
    fail_msg("no row '%s'", key);
    return NULL;
}

TEST(test_model)
{
    struct br_run_report p;
    OWNED(br_scene) scene = br_test_bundled("example2");
    struct br_run_request request = {
        .scene = &scene, .method = br_method_default(), .n = 4, .steps = 10};
    request.wanted = BR_WANT_BENDING;
    REFUSED(br_run(&request, &p, &err), BR_BAD_INPUT, "Coulomb's friction bound");
    request.wanted = BR_WANT_AXIAL;
    MUST(br_run(&request, &p, &err));
    assert_false(find(&p, "bending")->modelled);
    assert_false(find(&p, "friction")->modelled);
    assert_true(find(&p, "contact")->modelled);
    const double u = p.end.last.displacement[BR_AXIAL];

    scene.friction.law = BR_TRESCA;
    request.wanted = 0;
    MUST(br_run(&request, &p, &err));
    assert_false(find(&p, "axial")->modelled);
    assert_non_null(strstr(find(&p, "axial")->why, "--fields axial,bending marches it"));
    assert_false(find(&p, "contact")->modelled);
    assert_true(p.end.last.displacement[BR_AXIAL] == 0);
    const double w = p.end.last.displacement[BR_BENDING];
    request.wanted = BR_WANT_AXIAL | BR_WANT_BENDING;
    MUST(br_run(&request, &p, &err));
    assert_true(find(&p, "axial")->modelled);
    assert_true(p.end.last.displacement[BR_AXIAL] == u);
    assert_true(p.end.last.displacement[BR_BENDING] == w); /* to the bit */

    scene.friction.law = BR_FRICTIONLESS;
    request.wanted = 0;
    MUST(br_run(&request, &p, &err));
    assert_true(find(&p, "axial")->modelled && find(&p, "bending")->modelled);
    assert_non_null(strstr(find(&p, "friction")->why, "no friction algebra"));
    assert_non_null(
        strstr(find(&p, "axial_load")->why, "one evaluation of its history in each step"));
    assert_non_null(strstr(find(&p, "initial_data")->why, "not interpolated"));
    request.wanted = BR_WANT_BENDING;
    MUST(br_run(&request, &p, &err));
    assert_string_equal(find(&p, "axial")->why, "not asked for by --fields");
}
