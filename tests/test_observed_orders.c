/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which orders a report claims, of errors that are made up. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "solver/scene.h"
#include "study/fit/report.h"
#include "support.h"

enum { ROWS = 4, COLUMNS = 4, CELLS = ROWS * COLUMNS };
static const size_t n[ROWS] = {25, 50, 100, 200}, steps[COLUMNS] = {100, 200, 400, 800};

/* A study of errors a h^p + b k^q of a rod, and the differences of its meshes. */
struct made {
    struct br_scene scene;
    struct br_cell cell[CELLS], difference[ROWS - 1];
    struct br_study study, meshes;
    struct br_report report;
};

static void make(struct made *m, double a, double p, double b, double q)
{
    *m = (struct made){.scene = br_test_bare()};
    m->scene.bending.modelled = false;
    for (size_t i = 0; i < CELLS; i++) {
        m->cell[i].at = (struct br_resolution){n[i / COLUMNS], steps[i % COLUMNS]};
        const double h = 1 / (double)m->cell[i].at.n, k = 1 / (double)m->cell[i].at.steps;
        for (enum br_part part = 0; part < BR_PARTS; part++)
            m->cell[i].error[part] = a * pow(h, p) + b * pow(k, q);
    }
    for (size_t i = 0; i < ROWS - 1; i++) {
        m->difference[i].at = (struct br_resolution){n[i], steps[0]};
        m->difference[i].against = (struct br_resolution){n[i + 1], steps[0]};
        for (enum br_part part = 0; part < BR_PARTS; part++)
            m->difference[i].error[part] =
                a * (pow(1 / (double)n[i], p) - pow(1 / (double)n[i + 1], p));
    }
    m->study = br_test_study(&m->scene, &br_reference_exact, ROWS, n, COLUMNS, steps);
    m->study.cell = m->cell;
    m->study.reference_report.own_error[BR_AXIAL][BR_DISPLACEMENT] = DBL_MIN;
    m->meshes = br_test_study(&m->scene, &br_reference_none, ROWS - 1, n, 1, steps);
    m->meshes.cell = m->difference;
    m->report =
        (struct br_report){.study = &m->study, .fitted = &m->study, .compared = {&m->meshes}};
}

static void fit(struct br_report *report)
{
    for (enum br_part part = 0; part < BR_PARTS; part++)
        MUST(br_fit(report->fitted, part, &report->fits[part], &err));
}

static void observe(struct br_report *report)
{
    fit(report);
    for (enum br_axis axis = 0; axis < BR_AXES; axis++)
        MUST(br_report_observe_orders(report, axis, &err));
    br_report_clear(report);
}

static void see(struct made *m)
{
    observe(&m->report);
}

static void expect(const struct br_observed_order *observed, double order, const char *remark)
{
    if (isfinite(order))
        CLOSE(observed->order.value, order, 0.02);
    else
        assert_true(isnan(observed->order.value));
    if (!strstr(observed->remark, remark))
        fail_msg("found '%s', expected '%s'", observed->remark, remark);
}

/* An error in k a million times larger hides the order in h from the grid, not from differences. */
TEST(test_hidden_in_h)
{
    struct made m;
    make(&m, 1e-3, 2, 10, 1);
    see(&m);
    const struct br_observed_order *observed = m.report.observed[BR_PART_TOTAL];
    expect(&observed[BR_AXIS_SPACE], 2, "agrees with theory");
    assert_non_null(
        strstr(observed[BR_AXIS_SPACE].by, "differences of successive meshes at k = 0.01 s"));
    expect(&observed[BR_AXIS_TIME], 1, "agrees with theory");
    assert_false(m.report.observed[BR_PART_BENDING][BR_AXIS_SPACE].asked);
    m.report.compared[BR_AXIS_SPACE] = NULL;
    m.report.no_meshes = "the march failed";
    see(&m);
    expect(&observed[BR_AXIS_SPACE], 2, "agrees with theory"); /* these have no other errors */
    assert_non_null(strstr(observed[BR_AXIS_SPACE].by, "joint fit of 16 cells"));
    for (size_t i = 0; i < CELLS; i++)
        m.cell[i].error[0] *= 1 + 0.001 * (double)(i % 3);
    see(&m);
    expect(&observed[BR_AXIS_SPACE], NAN, "not measurable: the march failed");
}

/* No order in k where space is in the way, and none of the joint fit. */
TEST(test_hidden_in_k)
{
    struct made m;
    make(&m, 10, 2, 1e-6, 1);
    for (size_t i = 0; i < CELLS; i++)
        m.cell[i].error[0] *= 1 + 0.1 * (double)(i % 3); /* no fit describes that */
    see(&m);
    expect(&m.report.observed[BR_PART_TOTAL][BR_AXIS_SPACE], 2, "agrees with theory");
    expect(&m.report.observed[BR_PART_TOTAL][BR_AXIS_TIME], NAN,
           "not measurable: the error in h hides the order in k: a finer h");
}

/* What stands in the errors of the finest mesh, in k. */
static void expect_of(const double error[COLUMNS], double order, const char *remark)
{
    struct made m;
    make(&m, 1e-12, 2, 1, 1);
    for (size_t i = 0; i < CELLS; i++)
        m.cell[i].error[BR_PART_TOTAL] = error[i % COLUMNS] * (i / COLUMNS == 1 ? 1.1 : 1);
    see(&m);
    expect(&m.report.observed[BR_PART_TOTAL][BR_AXIS_TIME], order, remark);
}

TEST(test_remarks)
{
    expect_of((const double[]){1, 2, 3, 2.5}, NAN, "the errors do not fall: 1.0e+00, 2.0e+00");
    expect_of((const double[]){8, 7, 6, 5.2}, NAN,
              "not measurable: the errors fall with the orders 0.19, 0.22, 0.21 from row to row");
    expect_of((const double[]){8, 6, 3.6, 2}, 0.93, "agrees with theory"); /* 0.42, 0.74, 0.85 */
    expect_of((const double[]){8, 4.757, 2.72, 1.483}, 0.81, "not settled, but comes closer: 0.75");
    /* by the first and the last of them */
    expect_of((const double[]){8.0000, 4.9246, 3.0314, 1.6818}, 0.70,
              "but comes closer: 0.70, 0.70");
    expect_of((const double[]){8.0000, 4.9246, 2.7321, 1.5157}, 0.85,
              "but comes closer: 0.70, 0.85");
    expect_of((const double[]){8, 4.9, 3, 1.83}, 0.71, "below theory: 0.71, 0.71, 0.71");
    expect_of((const double[]){8, 2, 0.5, 0.125}, 2, "above theory: 2.00, 2.00, 2.00");
    expect_of((const double[]){8, 4.1124, 2.114, 1.0867}, 0.96, "agrees with theory");
    expect_of((const double[]){8, 4, NAN, NAN}, NAN,
              "not measurable: 2 of 4 errors are left out, the first: failed; an order needs 3");
}

/* Of all that marches can come to, nothing is claimed that is not above zero. */
TEST(test_no_order_of_zero)
{
    struct br_test_random random = {7};
    for (int trial = 0; trial < 20; trial++) {
        struct made m;
        make(&m, br_test_log_uniform(&random, 1e-8, 1), br_test_uniform(&random, -1, 3),
             br_test_log_uniform(&random, 1e-8, 1), br_test_uniform(&random, -1, 2));
        for (size_t i = 0; i < CELLS; i++)
            m.cell[i].error[0] *= br_test_uniform(&random, 0.9, 1.1);
        see(&m);
        for (int i = 0; i < BR_AXES; i++) {
            const struct br_observed_order *observed = &m.report.observed[BR_PART_TOTAL][i];
            assert_true(isnan(observed->order.value) || observed->order.low > 0);
            assert_true(*observed->remark);
        }
    }
}

static void expect_theory(const struct made *m, enum br_part part, double in_h, double in_k)
{
    OWNED(br_report) r = m->report;
    observe(&r);
    assert_true(r.observed[part][BR_AXIS_SPACE].theory.order == in_h);
    assert_true(r.observed[part][BR_AXIS_TIME].theory.order == in_k);
}

TEST(test_theory)
{
    struct made m;
    make(&m, 1, 2, 1, 1);
    expect_theory(&m, BR_PART_TOTAL, 2, 1);
    m.study.method.axial_degree = 2;
    m.study.method.scheme = br_time_scheme_find("bdf2");
    expect_theory(&m, BR_PART_TOTAL, 3, 2);
    m.scene.contact.modelled = true; /* of the level before */
    expect_theory(&m, BR_PART_TOTAL, 3, 1);
    m.scene.bending.modelled = true;
    expect_theory(&m, BR_PART_BENDING, 4, 2); /* without friction it knows no contact */
    m.study.norm = &br_norm_energy;
    expect_theory(&m, BR_PART_TOTAL, 2, 1);
    expect_theory(&m, BR_PART_BENDING, 2, 2);
    m.study.norm = &br_norm_tip;
    expect_theory(&m, BR_PART_AXIAL, 4, 1);
    m.study.method.scheme = br_time_scheme_find("adaptive");
    MUST(br_report_observe_orders(&m.report, BR_AXIS_TIME, &err));
    assert_false(
        m.report.observed[BR_PART_TOTAL][BR_AXIS_TIME].asked); /* it has steps of its own */
}

/* Coulomb's friction gives the order of the axial part to the bending part, Tresca's does not. */
TEST(test_bending_by_friction)
{
    struct made m;
    make(&m, 1, 2, 1, 1);
    m.scene.bending.modelled = true;
    m.scene.friction = (struct br_friction){.law = BR_COULOMB, .coefficient = 1};
    see(&m);
    const struct br_observed_order *observed = &m.report.observed[BR_PART_BENDING][BR_AXIS_SPACE];
    expect(observed, 2, "agrees with theory");
    assert_non_null(
        strstr(observed->theory.reason, "Coulomb's bound uses u(L) of linear elements"));
    m.scene.friction.law = BR_TRESCA;
    see(&m);
    expect(observed, 2, "below theory: 2.00, 2.00 from row to row");
}

/* ---- the order in k from differences of time steps on one mesh ---- */

enum { PAIRS = 6 };
static const size_t halved[PAIRS] = {1600, 3200, 6400, 12800, 25600, 51200};

/* Differences of successive steps with these errors. */
static struct br_study pairs_of(struct made *m, struct br_cell cell[PAIRS],
                                const double error[PAIRS])
{
    static const size_t mesh = 10;
    for (size_t i = 0; i < PAIRS; i++) {
        cell[i] = (struct br_cell){.at = {mesh, halved[i]}, .against = {mesh, 2 * halved[i]}};
        for (enum br_part part = 0; part < BR_PARTS; part++)
            cell[i].error[part] = error[i];
    }
    struct br_study s = br_test_study(&m->scene, &br_reference_none, 1, &mesh, PAIRS, halved);
    s.cell = cell;
    return s;
}

/* Errors on the grid that show no order in k. */
static void make_hidden(struct made *m)
{
    make(m, 10, 2, 1e-6, 1);
    for (size_t i = 0; i < CELLS; i++)
        m->cell[i].error[BR_PART_TOTAL] *= 1 + 0.1 * (double)(i % 3);
}

TEST(test_differences_of_steps)
{
    struct made m;
    struct br_cell cell[PAIRS];
    make_hidden(&m);
    see(&m);
    const struct br_observed_order *observed = &m.report.observed[BR_PART_TOTAL][BR_AXIS_TIME];
    assert_false(br_report_settles(&m.report, BR_AXIS_TIME));
    expect(observed, NAN, "the error in h hides the order in k");
    const struct br_study exact = pairs_of(&m, cell, (double[]){9, 16, 8, 4, 2, 1});
    m.report.compared[BR_AXIS_TIME] = &exact;
    see(&m);
    expect(observed, 1, "agrees with theory");
    assert_null(strstr(observed->remark, "may settle it"));
    assert_string_equal(observed->by, "differences of successive time steps at n = 10");
    assert_true(br_report_settles(&m.report, BR_AXIS_TIME));
    assert_int_equal(observed->points, PAIRS);
    for (size_t i = 0; i < PAIRS; i++) { /* the first does not count, and the line ignores it */
        const double line = 16 * pow(2, 1 - (double)i);
        assert_int_equal(observed->point[i].flag, i == 0 ? BR_FLAG_COARSE : BR_FLAG_NONE);
        CLOSE(observed->point[i].fit.value, line, 1e-3 * line);
        assert_true(observed->point[i].fit.low <= line * (1 + 1e-12));
        assert_true(line <= observed->point[i].fit.high * (1 + 1e-12));
        CLOSE(observed->point[i].z, 1 / (double)halved[i], 1e-15);
    }
    /* nor does one of those that are fitted, if it is outside the window */
    const struct br_study steep = pairs_of(&m, cell, (double[]){99, 60, 8, 4, 2, 1});
    m.report.compared[BR_AXIS_TIME] = &steep;
    see(&m);
    expect(observed, 1, "agrees with theory");
    assert_int_equal(observed->point[1].flag, BR_FLAG_COARSE);
    assert_int_equal(observed->point[2].flag, BR_FLAG_NONE);
    /* errors that do not fall tell nothing, and it is said what might */
    const struct br_study flat = pairs_of(&m, cell, (double[]){3, 1, 2, 1, 2, 1});
    m.report.compared[BR_AXIS_TIME] = &flat;
    see(&m);
    expect(observed, NAN, "not measurable: the errors do not fall");
    assert_non_null(strstr(observed->remark, "smaller time steps may settle it: -k "
                                             "T/12800,T/25600,T/51200"));
    assert_true(isnan(observed->point[0].fit.value));
    assert_false(br_report_settles(&m.report, BR_AXIS_TIME));
    double printed[CELLS]; /* a printed grid cannot be refined */
    m.report.printed = printed;
    fit(&m.report);
    MUST(br_report_observe_orders(&m.report, BR_AXIS_TIME, &err));
    assert_null(strstr(observed->remark, "may settle it"));
    m.report.printed = NULL;
    br_report_clear(&m.report);
    /* an order that is not that of theory settles nothing */
    const struct br_study other =
        pairs_of(&m, cell, (double[]){32, 22.627417, 16, 11.3137085, 8, 5.65685425});
    m.report.compared[BR_AXIS_TIME] = &other;
    see(&m);
    expect(observed, 0.5, "below theory");
    assert_false(br_report_settles(&m.report, BR_AXIS_TIME));
    /* differences have no error of the other axis: what contradicts them is wrong */
    make(&m, 1e-3, 2, 10, 1);
    for (size_t i = 0; i < CELLS; i++)
        m.cell[i].error[BR_PART_TOTAL] *= 1 + 0.01 * (double)(i % 3 == 1);
    m.report.compared[BR_AXIS_TIME] = &other;
    see(&m);
    expect(observed, 0.5, "below theory");
    const struct br_study rough = pairs_of(
        &m, cell, (double[]){32, 18.65, 11.54, 6.66, 4.08, 2.35}); /* wider than the grid's */
    make(&m, 1e-3, 2, 10, 1);
    m.report.compared[BR_AXIS_TIME] = &rough;
    see(&m);
    expect(observed, 0.75, "below theory");
    for (size_t i = 0; i < CELLS; i++)
        m.cell[i].error[BR_PART_TOTAL] *= 1 + 0.01 * (double)(i % 3 == 1);
    /* but what the grid shows better stays */
    const struct br_study wide = pairs_of(&m, cell, (double[]){32, 15, 9, 4, 2.2, 1});
    m.report.compared[BR_AXIS_TIME] = &wide;
    see(&m);
    expect(observed, 1, "agrees with theory");
    assert_non_null(strstr(observed->by, "joint fit of 16 cells"));
    assert_true(br_report_settles(&m.report, BR_AXIS_TIME));
    /* its picture: the errors on the finest mesh, and the model */
    assert_int_equal(observed->points, COLUMNS);
    for (size_t i = 0; i < COLUMNS; i++)
        CLOSE(observed->point[i].fit.value, observed->point[i].error,
              0.02 * observed->point[i].error);
}

/* Where errors subtract, the least one may be that of an order inside the interval: the band holds
 * the errors of all of them. */
TEST(test_band_of_errors_that_subtract)
{
    enum { MANY = 1000 };
    const double h = 1e-2, k[COLUMNS] = {8e-3, 4e-3, 2e-3, 1e-3}, none[BR_AXES] = {0, 0};
    const struct br_joint_fit fit = {
        .converged = true, /* the same errors at k[2] for an order of 1.14 */
        .c = {{1 / (h * h), NAN, NAN}, {1.05 / k[2], NAN, NAN}},
        .order = {{2, 1.9, 2.1}, {1, 0.8, 1.2}},
        .r = {-1, -1, -1},
    };
    for (size_t i = 0; i < COLUMNS; i++) {
        const double middle = sqrt(k[0] * k[COLUMNS - 1]);
        const struct br_estimate band =
            br_joint_band(&fit, BR_AXIS_TIME, middle, (double[]){h, k[i]}, none);
        double low = INFINITY, high = 0;
        for (int j = 0; j <= MANY; j++) {
            const double e =
                fabs(1 - 1.05 * middle / k[2] * pow(k[i] / middle, 0.8 + 0.4 * (double)j / MANY));
            low = fmin(low, e);
            high = fmax(high, e);
        }
        CLOSE(band.value, fabs(1 - 1.05 * k[i] / k[2]), 1e-9);
        CLOSE(band.low, low, 3e-3);
        CLOSE(band.high, high, 1e-3);
    }
}

/* Without numbers: 1.0e+00 and 1.0e-09 have the same words around them. */
static const char *words_of(const char *text, char *words)
{
    char *end = words;
    for (; *text; text++)
        if (!strchr("0123456789.+-", *text) && !(*text == 'e' && strchr("+-", text[1]) && text[1]))
            *end++ = *text;
    *end = '\0';
    return words;
}

/* Errors of a millionth of a millionth have the words of large ones. */
TEST(test_words_in_any_unit)
{
    static const double errors[][COLUMNS] = {{1, 2, 3, 2.5},    {8, 7, 6, 5.2},     {8, 6, 3.6, 2},
                                             {8, 4.9, 3, 1.83}, {8, 2, 0.5, 0.125}, {8, 4, 2, 1.9},
                                             {8, 4, 2, 1},      {8, 4, NAN, NAN}};
    for (size_t i = 0; i < sizeof errors / sizeof *errors; i++) {
        struct br_observed_order before[BR_AXES];
        for (int small = 0; small < 2; small++) {
            struct made m;
            make(&m, 1e-12, 2, 1, 1);
            for (size_t c = 0; c < CELLS; c++)
                m.cell[c].error[BR_PART_TOTAL] = errors[i][c % COLUMNS];
            for (size_t c = 0; c < CELLS && small; c++)
                for (enum br_part part = 0; part < BR_PARTS; part++)
                    m.cell[c].error[part] *= 1e-12;
            for (size_t c = 0; c < ROWS - 1 && small; c++)
                for (enum br_part part = 0; part < BR_PARTS; part++)
                    m.difference[c].error[part] *= 1e-12;
            see(&m);
            for (int axis = 0; axis < BR_AXES; axis++) {
                char a[512], b[512];
                const struct br_observed_order *o = &m.report.observed[BR_PART_TOTAL][axis];
                if (!small)
                    before[axis] = *o;
                assert_string_equal(words_of(o->remark, a), words_of(before[axis].remark, b));
                assert_string_equal(o->by, before[axis].by);
                if (isfinite(before[axis].order.value))
                    CLOSE(o->order.value, before[axis].order.value, 1e-4);
                else
                    assert_true(isnan(o->order.value));
            }
        }
    }
}

/* Digits stand as far as the width allows, and nothing is minus zero. */
TEST(test_uncertain)
{
    static const struct {
        double value, half;
        const char *text;
    } rows[] = {
        {-0.22163, 0.0138, "-0.222 +- 0.014"},
        {0.17169233, 6.7e-9, "0.1716923300 +- 6.7e-09"},
        {-0.0, NAN, "0"},
        {1.00922190775, 6e-12, "1.009221908 +- 6.0e-12"},
        {3274, 1448, "3300 +- 1400"},
        {-3.6e-16, 5.2e-15, "-4e-16 +- 5.2e-15"},
        {-1e-3, 0.5, "0 +- 0.50"},
        {1234567, 1200, "1234600 +- 1200"},
        {-0.2216, NAN, "-0.2216"},
        {1.5e-9, 2.5e-11, "1.500e-09 +- 2.5e-11"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char text[64];
        assert_string_equal(br_uncertain_text(rows[i].value, rows[i].half, text, sizeof text),
                            rows[i].text);
    }
    char text[64];
    assert_string_equal(br_digits_text(-453.048, 2, text, sizeof text), "-450");
    assert_string_equal(br_digits_text(-0.163812, 2, text, sizeof text), "-0.16");
    assert_string_equal(br_digits_text(1.90822e-7, 3, text, sizeof text), "1.91e-07");
    assert_string_equal(br_digits_text(12345678, 3, text, sizeof text), "1.23e+07");
    assert_string_equal(br_digits_text(-0.0, 3, text, sizeof text), "0");
}
