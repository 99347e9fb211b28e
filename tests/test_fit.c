/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Fits on made-up grids whose orders are known. */
#include <math.h>
#include <stdlib.h>

#include "solver/linear/linear_solver.h"
#include "solver/scene.h"
#include "study/fit/fit.h"
#include "support.h"

enum { ROWS = 6, COLUMNS = 6, CELLS = ROWS * COLUMNS };

static const size_t meshes[ROWS] = {100, 200, 400, 800, 1600, 3200};
static const size_t steps[COLUMNS] = {100, 200, 500, 1000, 2000, 10000};

/* A study that was never run: its errors are made up. */
static struct grid {
    struct br_scene scene;
    struct br_study study;
    struct br_cell cell[CELLS];
} g;
static struct br_fits fits; /* of it */

static void grid_init(bool fine)
{
    g = (struct grid){.scene = br_test_bare()};
    g.study = br_test_study(&g.scene, fine ? &br_reference_fine : &br_reference_exact, ROWS, meshes,
                            COLUMNS, steps);
    g.study.reference = (struct br_resolution){fine ? 12800 : 0, 100000};
    g.study.cell = g.cell;
    g.study.reference_report.own_error[BR_AXIAL][0] =
        g.study.reference_report.own_error[BR_BENDING][0] = fine ? NAN : 0;
    g.study.reference_scale = 1;
    for (size_t i = 0; i < CELLS; i++) {
        g.cell[i].at = (struct br_resolution){meshes[i / COLUMNS], steps[i % COLUMNS]};
        if (fine)
            g.cell[i].against = g.study.reference;
    }
}

struct truth {
    double c_h, p, c_k, q, r;
};

static double side(double c, double order, double x, double x_ref)
{
    return c * (pow(x, order) - (x_ref > 0 ? pow(x_ref, order) : 0));
}

/* The textbook law of cosines, with a relative noise of the given size. */
static void fill(const struct truth *t, double noise, uint64_t seed)
{
    struct br_test_random random = {seed};
    for (size_t i = 0; i < CELLS; i++) {
        const double a = side(t->c_h, t->p, g.scene.length / (double)g.cell[i].at.n,
                              br_reference_mesh(&g.study));
        const double b = side(t->c_k, t->q, g.scene.duration / (double)g.cell[i].at.steps,
                              br_reference_step(&g.study));
        /* nearly normal: a sum of uniform numbers */
        double sum = 0;
        for (int j = 0; j < 12; j++)
            sum += br_test_uniform(&random, -0.5, 0.5);
        g.cell[i].error[BR_PART_TOTAL] = sqrt(a * a + 2 * t->r * a * b + b * b) * exp(noise * sum);
    }
}

static void fit(enum br_part part)
{
    br_fits_clear(&fits);
    MUST(br_fit(&g.study, part, &fits, &err));
}

/* A grid of these errors, fitted. */
static void fit_truth(bool fine, const struct truth *t, double noise, uint64_t seed)
{
    grid_init(fine);
    fill(t, noise, seed);
    fit(BR_PART_TOTAL);
}

/* Against the solution, a fine reference, and one so near that its part in the derivatives matters:
 * with wrong ones the search would stall. */
TEST(test_recovers)
{
    static const struct truth truths[] = {
        {0.06, 2, 0.08, 1, -0.79}, {3, 2, 0.5, 1, 0},      {10, 2, 0.1, 1, 0.9},
        {40, 2, 0.2, 2, -0.5},     {0.5, 1, 0.3, 1, 0.25}, {2, 1.5, 0.05, 0.5, 0.6},
        {20, 1.7, 0.2, 0.8, 0.3},
    };
    for (size_t i = 0; i < sizeof truths / sizeof *truths; i++)
        for (int reference = 0; reference < 3; reference++) {
            grid_init(reference > 0);
            if (reference == 2)
                g.study.reference =
                    (struct br_resolution){meshes[ROWS - 1] + meshes[ROWS - 1] / 32,
                                           steps[COLUMNS - 1] + steps[COLUMNS - 1] / 32};
            for (size_t c = 0; c < CELLS && reference == 2; c++)
                g.cell[c].against = g.study.reference;
            if (reference == 1) /* its error is measured */
                g.study.reference_check = &br_reference_exact;
            fill(&truths[i], 0, 1);
            fit(BR_PART_TOTAL);
            const struct br_joint_fit *j = &fits.joint;
            assert_true(j->converged && br_joint_describes(j));
            assert_int_equal(j->kind, BR_JOINT_BOTH);
            CLOSE(j->order[0].value, truths[i].p, 1e-7);
            CLOSE(j->order[1].value, truths[i].q, 1e-7);
            CLOSE(j->r.value, truths[i].r, 1e-6);
            CLOSE(j->c[0].value / truths[i].c_h, 1, 1e-6);
            CLOSE(j->c[1].value / truths[i].c_k, 1, 1e-6);
            AT_MOST(j->worst, 1e-7);
            CLOSE(j->r_squared, 1, 1e-12);
        }
}

/* Whether the 99 % interval is as many times as wide as that of 95 % as Student's t of this freedom
 * says, by a table. */
static bool is_of_freedom(const struct br_joint_fit *f, enum br_axis axis, double wider)
{
    const struct br_estimate *order = &f->order[axis];
    const double half = wider * (order->high - order->value);
    return fabs(f->high99[axis] - order->value - half) < 1e-4 * half &&
           fabs(order->value - f->low99[axis] - half) < 1e-4 * half;
}

/* With noise of 1 %, the intervals hold the truth in about 95 % of the trials. */
TEST(test_coverage)
{
    enum { TRIALS = 200 };
    const struct truth truth = {20, 2, 0.2, 1, 0.3};
    size_t p = 0, q = 0, of_cells = 0, of_sizes = 0;
    for (uint64_t seed = 1; seed <= TRIALS; seed++) {
        fit_truth(true, &truth, 0.01, seed);
        p += fits.joint.order[0].low <= truth.p && truth.p <= fits.joint.order[0].high;
        q += fits.joint.order[1].low <= truth.q && truth.q <= fits.joint.order[1].high;
        /* Of 36 cells less 5 unknowns; or of 6 sizes that are left out, where that is wider. */
        of_cells += is_of_freedom(&fits.joint, BR_AXIS_SPACE, 2.7440 / 2.0395);
        of_sizes += is_of_freedom(&fits.joint, BR_AXIS_SPACE, 4.0321 / 2.5706);
    }
    assert_int_equal(of_cells + of_sizes, TRIALS);
    assert_true(of_cells > 0 && of_sizes > 0);
    /* 190 expected; three standard deviations are 9.2 */
    assert_true(p >= 180 && p <= TRIALS);
    assert_true(q >= 180 && q <= TRIALS);
    assert_true(p < TRIALS || q < TRIALS); /* intervals that never miss are too wide */
}

TEST(test_one_sided)
{
    static const struct truth truths[] = {{5, 2, 1e-9, 1, 0}, {1e-9, 2, 0.1, 1, 0}};
    static const enum br_joint_kind kinds[] = {BR_JOINT_SPACE, BR_JOINT_TIME};
    for (int axis = 0; axis < BR_AXES; axis++) {
        fit_truth(true, &truths[axis], 1e-4, 3);
        assert_int_equal(fits.joint.kind, kinds[axis]);
        CLOSE(fits.joint.order[axis].value, axis ? 1 : 2, 1e-3);
        assert_true(isnan(fits.joint.order[1 - axis].value));
    }
}

/* The width of the 95 % interval of the slope of the first row's errors over k. */
static double width_of_row(void)
{
    double x[COLUMNS], y[COLUMNS], mean_x = 0, mean_y = 0, xx = 0, xy = 0, rest = 0;
    for (size_t j = 0; j < COLUMNS; j++) {
        mean_x += (x[j] = -log((double)steps[j])) / COLUMNS;
        mean_y += (y[j] = log(g.cell[j].error[BR_PART_TOTAL])) / COLUMNS;
    }
    for (size_t j = 0; j < COLUMNS; j++) {
        xx += (x[j] - mean_x) * (x[j] - mean_x);
        xy += (x[j] - mean_x) * (y[j] - mean_y);
    }
    for (size_t j = 0; j < COLUMNS; j++)
        rest += pow(y[j] - mean_y - xy / xx * (x[j] - mean_x), 2);
    const struct br_estimate e =
        br_estimate_of(xy / xx, sqrt(rest / (COLUMNS - 2) / xx), COLUMNS - 2);
    return e.high - e.low;
}

/* Rows that repeat each other are no more evidence than one: the interval of 36 cells
 * is not narrower than that of one row of 6. */
TEST(test_replicates)
{
    grid_init(true);
    for (size_t i = 0; i < CELLS; i++) {
        const double k = 1.0 / (double)g.cell[i].at.steps;
        g.cell[i].error[BR_PART_TOTAL] = 0.1 * k * (1 + 0.05 * cos((double)g.cell[i].at.steps));
    }
    fit(BR_PART_TOTAL);
    const struct br_estimate *all = &fits.joint.order[1];
    assert_true(!isfinite(all->value) || all->high - all->low >= 0.8 * width_of_row());
}

/* Two time steps make no order in k, however many meshes there are. */
TEST(test_two_steps)
{
    const struct truth truth = {1e-9, 2, 0.1, 1, 0};
    grid_init(true);
    fill(&truth, 1e-3, 5);
    for (size_t i = 0; i < CELLS; i++)
        if (i % COLUMNS >= 2)
            g.cell[i].error[BR_PART_TOTAL] = NAN;
    fit(BR_PART_TOTAL);
    assert_true(isnan(fits.joint.order[1].value));
}

TEST(test_opposed)
{
    const struct truth truth = {0.0626, 2, 0.0785, 1, -0.79};
    grid_init(true);
    fill(&truth, 0, 1);
    const double coarse = br_study_cell(&g.study, 0, COLUMNS - 1)->error[BR_PART_TOTAL];
    const double fine = br_study_cell(&g.study, ROWS - 1, COLUMNS - 1)->error[BR_PART_TOTAL];
    assert_true(coarse < 0.8 * fine);
    fit(BR_PART_TOTAL);
    CLOSE(fits.joint.order[0].value, 2, 1e-4);
}

TEST(test_left_out)
{
    const struct truth truth = {20, 2, 0.2, 1, 0.3};
    grid_init(true);
    fill(&truth, 0, 1);
    g.cell[3].error[BR_PART_TOTAL] = NAN;
    g.cell[9].error[BR_PART_TOTAL] = INFINITY;
    g.cell[20].failure.status = BR_NOT_FINITE;
    g.cell[20].error[BR_PART_TOTAL] = 1e9;
    g.cell[30].error[BR_PART_TOTAL] = 0;
    fit(BR_PART_TOTAL);
    assert_int_equal(g.cell[3].flag[BR_PART_TOTAL], BR_FLAG_FAILED);
    assert_int_equal(g.cell[9].flag[BR_PART_TOTAL], BR_FLAG_FAILED);
    assert_int_equal(g.cell[20].flag[BR_PART_TOTAL], BR_FLAG_FAILED);
    assert_int_equal(g.cell[30].flag[BR_PART_TOTAL], BR_FLAG_ROUND_OFF);
    assert_int_equal(fits.joint.points, CELLS - 4);
    CLOSE(fits.joint.order[0].value, truth.p, 1e-4);
}

TEST(test_flags)
{
    grid_init(false);
    const struct truth truth = {20, 2, 0.2, 1, 0.3};
    fill(&truth, 0, 1);
    /* An exact reference that knows its own error: what is below three times it is marked. */
    const double smallest = br_study_cell(&g.study, ROWS - 1, COLUMNS - 1)->error[BR_PART_TOTAL];
    g.study.reference_report.own_error[BR_AXIAL][BR_DISPLACEMENT] = smallest / 2.9;
    fit(BR_PART_TOTAL);
    assert_int_equal(br_study_cell(&g.study, ROWS - 1, COLUMNS - 1)->flag[BR_PART_TOTAL],
                     BR_FLAG_REFERENCE);
    assert_int_equal(g.cell[0].flag[BR_PART_TOTAL], BR_FLAG_NONE);
    g.study.reference_report.own_error[BR_AXIAL][BR_DISPLACEMENT] = smallest / 3.1;
    fit(BR_PART_TOTAL);
    assert_int_equal(br_study_cell(&g.study, ROWS - 1, COLUMNS - 1)->flag[BR_PART_TOTAL],
                     BR_FLAG_NONE);
    g.study.reference_report.round_off = 1; /* nothing can be told any more */
    fit(BR_PART_TOTAL);
    for (size_t i = 0; i < CELLS; i++)
        assert_int_equal(g.cell[i].flag[BR_PART_TOTAL], BR_FLAG_ROUND_OFF);
    assert_false(fits.joint.converged);
    assert_true(isnan(fits.joint.order[0].value));
}

/* A solver's round-off is its field's own: errors just above that of the one are flagged in the
 * other and in the total, which have more of it. */
TEST(test_round_off)
{
    grid_init(false);
    g.study.method.solver = &br_umfpack;
    for (size_t i = 0; i < CELLS; i++) {
        const struct br_cell *c = &g.cell[i];
        const double k = br_time_step(&g.scene, c->at.steps);
        double limit[2];
        for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
            const struct br_field field = br_field_of_scene(&g.scene, kind, c->at.n, k, 1);
            limit[kind] = 3 * br_umfpack.round_off(&field);
        }
        assert_true(limit[BR_BENDING] > 4 * limit[BR_AXIAL]);
        for (enum br_part part = 0; part < BR_PARTS; part++) /* odd cells: twice the round-off */
            g.cell[i].error[part] = i % 2 ? 2 * limit[BR_AXIAL] / 3 : 2 * limit[BR_AXIAL];
    }
    br_flag_beside(&g.study);
    for (size_t i = 0; i < CELLS; i++) {
        assert_int_equal(g.cell[i].flag[BR_PART_AXIAL], i % 2 ? BR_FLAG_ROUND_OFF : BR_FLAG_NONE);
        assert_int_equal(g.cell[i].flag[BR_PART_BENDING], BR_FLAG_ROUND_OFF);
        assert_int_equal(g.cell[i].flag[BR_PART_TOTAL], BR_FLAG_ROUND_OFF);
    }
}

static void same_estimate(const struct br_estimate *a, const struct br_estimate *b,
                          double tolerance)
{
    assert_int_equal(isnan(a->value), isnan(b->value));
    if (!isnan(a->value))
        CLOSE(a->value, b->value, tolerance);
    if (isfinite(a->high - a->low) || isfinite(b->high - b->low))
        CLOSE(a->high - a->low, b->high - b->low, 1e-6 * (1 + b->high - b->low));
}

static void same_orders(const struct br_joint_fit *a, const struct br_joint_fit *b)
{
    assert_int_equal(a->kind, b->kind);
    same_estimate(&a->order[0], &b->order[0], 1e-9);
    same_estimate(&a->order[1], &b->order[1], 1e-9);
    same_estimate(&a->r, &b->r, 1e-7);
    CLOSE(a->misfit, b->misfit, 1e-9);
}

/* Where the minimum is flat (the space error is lost in noise, or three meshes are all there are),
 * the orders are still the same in other units of length, time and error. */
TEST(test_units)
{
    static const double unit[] = {1, 1e3, 1e-3, 1e6, 1e-6}; /* m in mm, km; s in ms, us */
    static const struct truth truths[] = {
        {20, 2, 0.2, 1, 0.3}, {1e-4, 2, 0.1, 1, -0.9}, {0.06, 1, 0.08, 1, 0.95}};
    struct br_point base[CELLS], scaled[CELLS];
    for (size_t i = 0; i < 3 * 4; i++) {
        grid_init(true);
        fill(&truths[i % 3], 0.005, 3 + i);
        const size_t rows = i < 6 ? ROWS : 3;
        struct br_joint_fit first = {0};
        for (size_t j = 0; j < rows * COLUMNS; j++)
            base[j] =
                (struct br_point){.x = {1 / (double)g.cell[j].at.n, 1 / (double)g.cell[j].at.steps},
                                  .ref = {1 / 12800.0, 1e-5},
                                  .error = g.cell[j].error[BR_PART_TOTAL]};
        for (size_t u = 0; u < 5 * 5; u++) {
            const double m = unit[u / 5], s = unit[u % 5], e = u ? 31.6 : 1;
            for (size_t j = 0; j < rows * COLUMNS; j++)
                scaled[j] = (struct br_point){.x = {base[j].x[0] * m, base[j].x[1] * s},
                                              .ref = {base[j].ref[0] * m, base[j].ref[1] * s},
                                              .error = base[j].error * e};
            struct br_joint_fit fit;
            MUST(br_joint_fit_solve(scaled, rows * COLUMNS, false, NULL, &fit, &err));
            if (u == 0)
                first = fit;
            same_orders(&fit, &first);
            if (isfinite(fit.order[0].value))
                CLOSE(fit.c[0].value * pow(m, fit.order[0].value) / e / first.c[0].value, 1, 1e-7);
            if (isfinite(fit.order[1].value))
                CLOSE(fit.c[1].value * pow(s, fit.order[1].value) / e / first.c[1].value, 1, 1e-7);
        }
    }
}

/* Hurvich and Tsai's criterion, by hand: n log(S / n) + 2 u n / (n - u - 1) with u unknowns, of
 * which the variance is one. */
TEST(test_few_points)
{
    CLOSE(br_akaike(9, 9, 5), 54, 1e-12);
    CLOSE(br_akaike(9, 9, 2), 10.8, 1e-12);
    CLOSE(br_akaike(36 * exp(-7), 36, 5), -36 * 7 + 12 * 36 / 29.0, 1e-12);
    assert_true(isinf(br_akaike(1, 7, 5))); /* seven points tell nothing of six unknowns */
    assert_true(isfinite(br_akaike(1, 8, 5)));
}

TEST(test_noise_is_no_order)
{
    grid_init(true);
    struct br_test_random random = {7};
    for (size_t i = 0; i < CELLS; i++)
        g.cell[i].error[BR_PART_TOTAL] = br_test_log_uniform(&random, 1e-6, 1e-2);
    fit(BR_PART_TOTAL);
    assert_false(br_joint_describes(&fits.joint));
    assert_true(isnan(fits.reference_error));
}

TEST(test_nan_passes_nothing)
{
    const struct br_estimate none = {NAN, NAN, NAN}, wide = {2, 1, 3}, low = {0.1, -0.1, 0.3};
    assert_false(br_order_determined(&none));
    assert_false(br_order_determined(&wide));
    assert_false(br_order_determined(&low));
    const struct br_joint_fit fit = {.converged = true, .misfit = NAN};
    assert_false(br_joint_describes(&fit));
    char buffer[64];
    assert_string_equal(br_order_text(&none, buffer, sizeof buffer), "-");
}

/* What the reference knows of its own error: the total's is the sum of both. */
TEST(test_own_error)
{
    static const double told[BR_PARTS] = {7e-9, 5e-9, 2e-9};
    const struct truth truth = {20, 2, 0.2, 1, 0.3};
    for (enum br_part part = 0; part < BR_PARTS; part++) {
        grid_init(false);
        fill(&truth, 0, 1);
        for (size_t i = 0; i < CELLS; i++)
            g.cell[i].error[part] = g.cell[i].error[BR_PART_TOTAL];
        g.study.reference_report.own_error[BR_AXIAL][BR_DISPLACEMENT] = 5e-9;
        g.study.reference_report.own_error[BR_BENDING][BR_DISPLACEMENT] = 2e-9;
        fit(part);
        CLOSE(fits.reference_error, told[part], 1e-20);
    }
}

/* ---- errors of a stranger, with any model ---- */

enum { SIZES = 5 };

/* A grid of errors a x^p and b y^q of correlation r, 2 % of noise. */
static void fit_stranger(const struct truth *t, uint64_t seed, struct br_joint_fit *found)
{
    struct br_point o[SIZES * SIZES] = {{.error = 0}};
    struct br_test_random random = {seed};
    for (size_t i = 0; i < SIZES * SIZES; i++) {
        const double x = ldexp(1, -(int)(i / SIZES)), y = ldexp(1, -(int)(i % SIZES));
        const double a = t->c_h * pow(x, t->p), b = t->c_k * pow(y, t->q);
        double sum = 0;
        for (int j = 0; j < 12; j++)
            sum += br_test_uniform(&random, -0.5, 0.5);
        o[i] = (struct br_point){.x = {x, y},
                                 .error = sqrt(a * a + 2 * t->r * a * b + b * b) * exp(0.02 * sum)};
    }
    MUST(br_joint_fit_solve(o, SIZES * SIZES, true, NULL, found, &err));
}

/* Of all models the interval of 99 % is wider by at least Student's t where one model has nearly
 * all of the weight. */
TEST(test_99_of_all_models)
{
    double least[2] = {INFINITY, INFINITY};
    for (uint64_t seed = 1; seed <= 12; seed++) {
        struct br_joint_fit f;
        fit_stranger(&(struct truth){20, 2, 0.2, 1, 0.3}, seed, &f);
        const struct br_estimate *p = &f.order[BR_AXIS_SPACE];
        least[0] = fmin(least[0], (p->value - f.low99[0]) / (p->value - p->low));
        least[1] = fmin(least[1], (f.high99[0] - p->value) / (p->high - p->value));
    }
    for (int side = 0; side < 2; side++)
        assert_true(least[side] > 1.38 && least[side] < 1.6); /* of 98 % it is less */
}

TEST(test_steep_in_k)
{
    const struct truth t = {0.05, 1.5, 1, 4, 0.3};
    for (uint64_t seed = 1; seed <= 6; seed++) {
        struct br_joint_fit found;
        fit_stranger(&t, seed, &found);
        CLOSE(found.order[BR_AXIS_SPACE].value, t.p, 0.04);
        CLOSE(found.order[BR_AXIS_TIME].value, t.q, 0.08);
    }
}

/* One error alone, C x^p (1 + 0.8 x) with a next term in its size, and the same in the other size.
 */
TEST(test_next_term_of_each_axis)
{
    for (int axis = 0; axis < BR_AXES; axis++) {
        struct br_point o[SIZES * SIZES] = {{.error = 0}};
        struct br_joint_fit found;
        for (size_t i = 0; i < SIZES * SIZES; i++) {
            o[i].x[0] = ldexp(1, -(int)(i / SIZES));
            o[i].x[1] = ldexp(1, -(int)(i % SIZES));
            o[i].error = 0.1 * pow(o[i].x[axis], 1.5) * (1 + 0.8 * o[i].x[axis]);
        }
        MUST(br_joint_fit_solve(o, SIZES * SIZES, true, NULL, &found, &err));
        assert_int_equal(found.kind, axis == BR_AXIS_SPACE ? BR_JOINT_SPACE : BR_JOINT_TIME);
        CLOSE(found.order[axis].value, 1.5, 1e-4);
        CLOSE(found.c[axis].value, 0.1, 1e-5);
        assert_string_equal(found.law[axis], "a next term");
    }
}

/* Rates 2 2 1.4 along one size, or 2 2.. 1.4 1.4 with the change between two sizes, and x^1 along
 * the other: both orders are in the interval, and none outside. */
TEST(test_order_that_changes)
{
    enum { LINE = 6 };
    static const double p = 2, q = 1.4;
    for (int turn = 0; turn < 4; turn++) {
        const int axis = turn % 2;
        const size_t sizes = turn < 2 ? 4 : LINE;
        const double at = turn < 2 ? 0.25 : 0.2;
        struct br_point o[LINE * LINE] = {{.error = 0}};
        struct br_joint_fit found;
        for (size_t i = 0; i < sizes * sizes; i++) {
            const double x = ldexp(1, -(int)(i / sizes)), y = ldexp(1, -(int)(i % sizes));
            o[i].x[axis] = x;
            o[i].x[1 - axis] = y;
            o[i].error = (x > at ? pow(x, p) : pow(at, p - q) * pow(x, q)) + 0.3 * y;
        }
        MUST(br_joint_fit_solve(o, sizes * sizes, true, NULL, &found, &err));
        CLOSE(found.order[axis].low, q, 0.01);
        CLOSE(found.order[axis].high, p, 0.01);
        AT_MOST(found.low99[axis], q);
        AT_MOST(p, found.high99[axis]);
        CLOSE(found.order[1 - axis].value, 1, 0.001);
        assert_string_equal(found.law[axis], "a change of the order");
    }
}

/* Errors that are another double next to each one have the same interval: on no machine, and with
 * no library, do last bits decide. */
TEST(test_last_bits)
{
    static const double error[] = {0.11,
                                   0.060059999999999995,
                                   0.035070000000000004,
                                   0.0225,
                                   0.1026025,
                                   0.052605000000000006,
                                   0.0275,
                                   0,
                                   0.10082625,
                                   0.050625,
                                   0.025650625,
                                   0.01315125,
                                   0.10015625,
                                   0.050206406,
                                   0.0252065625,
                                   0.01265625};
    enum { CELLS_OF = sizeof error / sizeof *error };
    struct br_joint_fit first = {0}, found;
    for (size_t turn = 0; turn < 6; turn++) {
        struct br_point o[CELLS_OF];
        size_t count = 0;
        for (size_t i = 0; i < CELLS_OF; i++)
            if (error[i] > 0)
                o[count++] = (struct br_point){
                    .x = {ldexp(0.1, -(int)(i / 4)), ldexp(0.1, -(int)(i % 4))},
                    .error = turn == 0 ? error[i] : nextafter(error[i], (i + turn) % 3 ? 0 : 1)};
        MUST(br_joint_fit_solve(o, count, true, NULL, turn ? &found : &first, &err));
        for (int axis = 0; axis < BR_AXES && turn > 0; axis++) {
            CLOSE(found.order[axis].value, first.order[axis].value, 1e-6);
            CLOSE(found.order[axis].low, first.order[axis].low, 1e-6);
            CLOSE(found.order[axis].high, first.order[axis].high, 1e-6);
        }
    }
    assert_true(br_joint_describes(&first));
}

/* By hand: x^1.5 of six sizes, with errors of the logarithm that are +-0.01 by turns and add up to
 * zero over each size, so that no order is off. A next term C x^p exp(D x) is not ruled out: two
 * unknowns have n ln S + 2 36 3/(36 - 4), three n ln S + 2 36 4/(36 - 5), 2.54 more. So the
 * interval is at least that of p beside D, by the regression of ln e on ln x and x; t is that of
 * 36 - 3 degrees of freedom. */
TEST(test_interval_of_what_is_not_ruled_out)
{
    enum { LINE = 6 };
    static const double noise = 0.01, t = 2.0345;
    for (int axis = 0; axis < BR_AXES; axis++) {
        struct br_point o[LINE * LINE] = {{.error = 0}};
        struct br_joint_fit found;
        double l[LINE], x[LINE], mean_l = 0, mean_x = 0, ll = 0, lx = 0, xx = 0;
        for (int i = 0; i < LINE * LINE; i++) {
            o[i].x[axis] = ldexp(1, -(i / LINE));
            o[i].x[1 - axis] = ldexp(1, -(i % LINE));
            o[i].error = pow(o[i].x[axis], 1.5) * exp((i / LINE + i % LINE) % 2 ? noise : -noise);
        }
        for (int i = 0; i < LINE; i++) {
            x[i] = ldexp(1, -i);
            l[i] = log(x[i]);
            mean_x += x[i] / LINE;
            mean_l += l[i] / LINE;
        }
        for (int i = 0; i < LINE; i++) {
            ll += LINE * pow(l[i] - mean_l, 2);
            lx += LINE * (l[i] - mean_l) * (x[i] - mean_x);
            xx += LINE * pow(x[i] - mean_x, 2);
        }
        const double half = t * noise * sqrt(36.0 / 33 / (ll - lx * lx / xx));
        MUST(br_joint_fit_solve(o, LINE * LINE, true, NULL, &found, &err));
        assert_int_equal(found.kind, axis == BR_AXIS_SPACE ? BR_JOINT_SPACE : BR_JOINT_TIME);
        CLOSE(found.order[axis].value, 1.5, 1e-3);
        AT_MOST(found.order[axis].low, 1.5 - 0.9999 * half);
        AT_MOST(1.5 + 0.9999 * half, found.order[axis].high);
    }
}
