/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Orders of any program's numbers: of numbers that are known exactly, and expectations. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/load.h"
#include "base/words.h"
#include "checks.h"
#include "orders/line/line_order.h"
#include "orders/request.h"

static enum br_status read_table(const char *text, const char *errors, const char *values,
                                 struct br_numbers *numbers)
{
    const struct br_orders_request q = {.path = (char *)"t.csv",
                                        .table = (char *)text,
                                        .errors = (char *)errors,
                                        .values = (char *)values,
                                        .dimension = 2,
                                        .assumed_dimension = true};
    return br_orders_read(&q, numbers, &err);
}

static struct br_numbers read_with(const char *text, const char *values)
{
    struct br_numbers numbers;
    MUST(read_table(text, NULL, values, &numbers));
    return numbers;
}

static bool stops_at_once(void *self)
{
    return ++*(int *)self > 0;
}

/* ---- numbers that are made ---- */

enum { MOST_TEXT = 1 << 16 };

static double power_law(double h, double k, double p, double q)
{
    return (h > 0 ? 3 * pow(h, p) : 0) + (k > 0 ? 0.7 * pow(k, q) : 0);
}

/* A table of sizes 1/2, 1/4, ...; with both counts a grid. */
static const char *table_of(int meshes, int steps, double p, double q)
{
    static char text[MOST_TEXT];
    size_t used = (size_t)snprintf(text, sizeof text, "%s%s%s,l2\n", meshes ? "h" : "",
                                   meshes && steps ? "," : "", steps ? "k" : "");
    for (int i = meshes ? 1 : 0; i <= meshes; i++)
        for (int j = steps ? 1 : 0; j <= steps; j++) {
            const double h = i ? pow(2, -i) : 0, k = j ? pow(2, -j) : 0;
            if (i)
                used += (size_t)snprintf(text + used, sizeof text - used, "%.17g,", h);
            if (j)
                used += (size_t)snprintf(text + used, sizeof text - used, "%.17g,", k);
            used +=
                (size_t)snprintf(text + used, sizeof text - used, "%.17g\n", power_law(h, k, p, q));
        }
    return text;
}

/* A grid of numbers f(h, k), h = k = 1, 1/2, ..., as a table. */
static char *grid_of(int meshes, int steps, double (*f)(double h, double k))
{
    static char text[MOST_TEXT];
    size_t used = (size_t)snprintf(text, sizeof text, "h,k,l2\n");
    for (int i = 0; i < meshes; i++)
        for (int j = 0; j < steps; j++)
            used += (size_t)snprintf(text + used, sizeof text - used, "%.17g,%.17g,%.17g\n",
                                     pow(2, -i), pow(2, -j), f(pow(2, -i), pow(2, -j)));
    return text;
}

/* What was found last. */
static struct {
    struct br_numbers numbers;
    struct br_orders orders;
} found;

static void find(const char *text, const char *values)
{
    br_orders_clear(&found.orders);
    br_numbers_clear(&found.numbers);
    found.numbers = read_with(text, values);
    MUST(br_orders_find(&found.numbers, 2, &found.orders, &err));
}

TEST(test_lines)
{
    for (double p = 0.5; p < 6; p += 0.75) {
        find(table_of(5, 0, p, 0), NULL);
        const struct br_quantity_orders *of = &found.orders.of[0];
        assert_int_equal(of->lines, 1);
        CLOSE(of->line[0].observed.order.value, p, 1e-9);
        assert_string_equal(of->line[0].at, "");
        assert_true(isnan(br_orders_rate(&of->line[0], 0)));
        for (size_t i = 1; i < 5; i++)
            CLOSE(br_orders_rate(&of->line[0], i), p, 1e-9);
        find(table_of(0, 4, 0, p), NULL);
        assert_int_equal(found.orders.of[0].line[0].axis, BR_AXIS_TIME);
        CLOSE(found.orders.of[0].line[0].observed.order.value, p, 1e-9);
    }
}

TEST(test_grid)
{
    find(table_of(6, 5, 2, 1), NULL);
    const struct br_quantity_orders *of = &found.orders.of[0];
    assert_false(found.orders.tied);
    assert_true(br_joint_describes(&of->joint));
    CLOSE(of->joint.order[0].value, 2, 1e-9);
    CLOSE(of->joint.order[1].value, 1, 1e-9);
    CLOSE(of->joint.c[0].value, 3, 1e-8);
    assert_int_equal(of->joint.points, 30);
    assert_int_equal(of->lines, 11);
    for (size_t l = 0; l < of->lines; l++) { /* over space first; each from coarse to fine */
        char at[64];
        const bool space = l < 5;
        snprintf(at, sizeof at, "%s = %.6g", space ? "k" : "h",
                 pow(2, -(double)(space ? l : l - 5) - 1));
        assert_string_equal(of->line[l].at, at);
        assert_int_equal(of->line[l].axis, space ? BR_AXIS_SPACE : BR_AXIS_TIME);
        assert_int_equal(of->line[l].observed.points, space ? 6 : 5);
    }
    for (size_t row = 0; row < 30; row++)
        for (int axis = 0; axis < BR_AXES; axis++) {
            const struct br_row_point *at = &of->point[axis][row];
            CLOSE(at->line->observed.point[at->index].error, found.numbers.row[row].number[0], 0);
            assert_int_equal(at->line->observed.point[at->index].row, row);
        }
}

/* On a grid with a floor, the fit is made again without the rows at the floor. */
TEST(test_grid_with_a_floor)
{
    static char text[MOST_TEXT];
    size_t used = (size_t)snprintf(text, sizeof text, "h,k,l2\n");
    for (int i = 0; i < 10; i++)
        for (int j = 0; j < 14; j++)
            used +=
                (size_t)snprintf(text + used, sizeof text - used, "%.17g,%.17g,%.17g\n", pow(2, -i),
                                 pow(2, -j), fmax(power_law(pow(2, -i), pow(2, -j), 2, 1), 2e-3));
    find(text, NULL);
    const struct br_quantity_orders *of = &found.orders.of[0];
    assert_true(of->joint.points > 60 && of->joint.points < 140);
    assert_true(br_joint_describes(&of->joint));
    CLOSE(of->joint.order[0].value, 2, 1e-3);
    CLOSE(of->joint.order[1].value, 1, 1e-3);
}

/* A line at a fine size may begin at a finer mesh than one at a coarser size. */
TEST(test_lines_are_sorted)
{
    find("h,k,l2\n1,1,9\n1,.25,9\n.5,1,4\n.5,.5,4\n.5,.25,4\n.25,1,1\n.25,.5,1\n.25,.25,1\n"
         ".125,.5,.25\n",
         NULL);
    const struct br_quantity_orders *of = &found.orders.of[0];
    assert_string_equal(of->line[0].at, "k = 1");
    assert_string_equal(of->line[1].at, "k = 0.5");
    assert_string_equal(of->line[2].at, "k = 0.25");
}

/* 1000 and 1001 elements are two lines over k. */
TEST(test_near_sizes)
{
    find("n,k,l2\n1000,.4,4\n1000,.2,2\n1000,.1,1\n1001,.4,4\n1001,.2,2\n1001,.1,1\n", NULL);
    assert_int_equal(found.orders.of[0].lines, 2);
    assert_int_equal(found.orders.of[0].line[0].observed.points, 3);
}

TEST(test_tied)
{
    find("h,k,l2\n1,1,.3333333333333333\n.5,.25,.08333333333333333\n"
         ".25,.0625,.02083333333333333\n.125,.015625,.005208333333333333\n",
         NULL); /* by all their digits: rounded numbers leave other laws open */
    assert_true(found.orders.tied);
    assert_int_equal(found.orders.of[0].lines, 1);
    assert_int_equal(found.orders.of[0].line[0].axis, BR_AXIS_SPACE);
    CLOSE(found.orders.of[0].line[0].observed.order.value, 2, 1e-9);
    /* Neither line nor path: no order. */
    find("h,k,l2\n1,1,1\n1,.5,.9\n.5,1,.5\n.5,.5,.4\n.25,.25,.1\n", NULL);
    assert_false(found.orders.tied);
    assert_int_equal(found.orders.of[0].lines, 0);
}

/* Whoever stops the fits of lines and of a grid gets no orders. */
TEST(test_stopped_fits)
{
    int asked = 0;
    const struct br_observer stops = {.stop = stops_at_once, .self = &asked};
    struct br_joint_fit fit;
    REFUSED(br_joint_fit_solve(&(struct br_point){.x = {1, 1}, .error = 1}, 1, true, &stops, &fit,
                               &err),
            BR_INTERRUPTED, "interrupted");
    for (int steps = 0; steps < 5; steps += 4) {
        OWNED(br_numbers) n = read_with(table_of(5, steps, 2, 1), NULL);
        OWNED(br_orders) o;
        n.observer = &stops;
        REFUSED(br_orders_find(&n, 2, &o, &err), BR_INTERRUPTED, "interrupted");
    }
    assert_true(asked > 1);
}

static enum br_flag flag_of(size_t point)
{
    return found.orders.of[0].line[0].observed.point[point].flag;
}

/* h = 1, 1/2, ... with errors h^2 that do not fall below a floor; in units of that size. */
static const char *scaled_floor_table(int rows, double level, double unit)
{
    static char text[4096];
    size_t used = (size_t)snprintf(text, sizeof text, "h,l2\n");
    for (int i = 0; i < rows; i++)
        used += (size_t)snprintf(text + used, sizeof text - used, "%.17g,%.17g\n", pow(2, -i),
                                 unit * fmax(pow(4, -i), level));
    return text;
}

static const char *floor_table(int rows, double level)
{
    return scaled_floor_table(rows, level, 1);
}

/* What is left out, and by which name, depends on no unit. */
TEST(test_floors_in_any_unit)
{
    static const double units[] = {1e-12, 1e12};
    for (size_t u = 0; u < 2; u++) {
        find(scaled_floor_table(12, pow(4, -7), units[u]), NULL);
        for (size_t i = 0; i < 12; i++)
            assert_int_equal(flag_of(i), i < 8 ? BR_FLAG_NONE : BR_FLAG_STALLED);
        find(scaled_floor_table(16, pow(4, -12), units[u]), NULL);
        for (size_t i = 0; i < 16; i++)
            assert_int_equal(flag_of(i), i < 13 ? BR_FLAG_NONE : BR_FLAG_ROUND_OFF);
        /* A last rate of 0.8 after those of exactly 2 does not count: round-off, at its size. */
        for (int rows = 7; rows <= 14; rows += 7) {
            find(scaled_floor_table(rows, pow(4, 2 - rows) * pow(2, -0.8), units[u]), NULL);
            for (size_t i = 0; i + 1 < (size_t)rows; i++)
                assert_int_equal(flag_of(i), BR_FLAG_NONE);
            assert_int_equal(flag_of((size_t)rows - 1),
                             rows == 7 ? BR_FLAG_STALLED : BR_FLAG_ROUND_OFF);
        }
    }
}

/* Only what stays along both axes is at a floor. Along k at h = 1 errors stay, too, since that of
 * space is larger; but they fall in h. */
TEST(test_corners_of_a_floor)
{
    static char text[MOST_TEXT];
    size_t used = (size_t)snprintf(text, sizeof text, "h,k,l2\n"), left_out = 0;
    for (int i = 0; i < 10; i++)
        for (int j = 0; j < 10; j++)
            used +=
                (size_t)snprintf(text + used, sizeof text - used, "%.17g,%.17g,%.17g\n", pow(2, -i),
                                 pow(2, -j), fmax(fmax(pow(4, -i), pow(4, -j)), pow(4, -7)));
    find(text, NULL);
    for (size_t row = 0; row < 100; row++) {
        const struct br_row_point *a = &found.orders.of[0].point[0][row],
                                  *b = &found.orders.of[0].point[1][row];
        const enum br_flag flag = a->line->observed.point[a->index].flag;
        assert_int_equal(flag, b->line->observed.point[b->index].flag);
        if (abs((int)(row / 10) - (int)(row % 10)) > 1) /* else the two errors are alike */
            assert_true(!flag || found.numbers.row[row].number[0] < 10 * pow(4, -7));
        left_out += flag != BR_FLAG_NONE;
    }
    assert_true(left_out > 0);
}

static double floor_along_h(double h, double k)
{
    return k > 0 ? fmax(h * h, pow(4, -12)) : NAN;
}

static double floor_along_k(double h, double k)
{
    return floor_along_h(k, h);
}

/* A floor that only the longer lines can name has their name. */
TEST(test_name_of_a_floor)
{
    for (int turned = 0; turned < 2; turned++) {
        find(turned ? grid_of(3, 16, floor_along_k) : grid_of(16, 3, floor_along_h), NULL);
        for (size_t row = 0; row < 48; row++) {
            const struct br_row_point *at = &found.orders.of[0].point[turned][row];
            const enum br_flag flag = at->line->observed.point[at->index].flag;
            if (at->index > 12)
                assert_int_equal(flag, BR_FLAG_ROUND_OFF);
            else if (at->index < 10)
                assert_int_equal(flag, BR_FLAG_NONE);
        }
    }
}

static double larger_of_both(double h, double k)
{
    return fmax(h * h, k * k);
}

/* What stays along one axis alone is no floor, and what the other axis shows is no reason to leave
 * a row out. */
TEST(test_plateau_along_one_axis)
{
    for (int turned = 0; turned < 2; turned++) {
        find(grid_of(turned ? 6 : 10, turned ? 10 : 6, larger_of_both), NULL);
        const struct br_quantity_orders *of = &found.orders.of[0];
        assert_false(br_joint_describes(&of->joint));
        for (size_t row = 0; row < found.numbers.rows; row++)
            for (int axis = 0; axis < BR_AXES; axis++) {
                const struct br_row_point *at = &of->point[axis][row];
                const double *z = found.numbers.row[row].z;
                if (fabs(log2(z[0] / z[1])) > 1.5 && at->line->observed.point[at->index].flag)
                    fail_msg("%d: h = %g, k = %g: %s", turned, z[0], z[1],
                             br_flag_name(at->line->observed.point[at->index].flag));
            }
    }
}

TEST(test_floors)
{
    find(floor_table(12, pow(4, -7)), NULL); /* 6e-5: no round-off */
    const struct br_case *c = &found.orders.of[0].line[0].observed;
    for (size_t i = 0; i < 12; i++) /* row 7 is still h^2 */
        assert_int_equal(flag_of(i), i < 8 ? BR_FLAG_NONE : BR_FLAG_STALLED);
    assert_non_null(strstr(c->note, "left out: h = 0.00390625 (stagnation, error 6.1e-05)"));
    CLOSE(c->order.value, 2, 1e-9);
    find(floor_table(16, pow(4, -12)), NULL); /* 6e-8 of the coarsest one */
    for (size_t i = 0; i < 16; i++)
        assert_int_equal(flag_of(i), i < 13 ? BR_FLAG_NONE : BR_FLAG_ROUND_OFF);
    CLOSE(found.orders.of[0].line[0].observed.order.value, 2, 1e-9);
    find(floor_table(40, 0), NULL); /* none, however far it falls */
    for (size_t i = 0; i < 40; i++)
        assert_int_equal(flag_of(i), BR_FLAG_NONE);
    find("h,l2\n1,1.2345678901234\n.5,.30864197253085\n.25,.0771604931327125\n.125,0\n", NULL);
    assert_int_equal(flag_of(3), BR_FLAG_ROUND_OFF);
    CLOSE(found.orders.of[0].line[0].observed.order.value, 2, 1e-9);
    assert_true(isnan(br_orders_rate(&found.orders.of[0].line[0], 3)));
    find("h,l2\n1,1\n.5,.25\n.25,\n.125,.015625\n.0625,.00390625\n", NULL);
    assert_int_equal(flag_of(2), BR_FLAG_FAILED);
    assert_string_equal(found.orders.of[0].line[0].observed.point[2].failure, "has no number");
}

/* ---- printed digits ---- */

/* Of 100 lines that are printed to `digits` (or to so many decimals): how many intervals hold the
 * order, and the mean half width. */
static int printed_lines(bool fixed, int digits, double *half)
{
    struct br_test_random random = {20261126};
    int covered = 0;
    *half = 0;
    for (int line = 0; line < 100; line++) {
        char text[1024];
        const double order = br_test_uniform(&random, 0.8, 2.8),
                     c = br_test_uniform(&random, 0.3, 1.3),
                     next = br_test_uniform(&random, 0, 0.1);
        size_t used = (size_t)snprintf(text, sizeof text, "h,l2\n");
        for (double h = 1; h > 0.1; h /= 2)
            used += (size_t)snprintf(
                text + used, sizeof text - used, fixed ? "%g,%.*f\n" : "%g,%.*e\n", h,
                fixed ? digits : digits - 1, c * pow(h, order) * (1 + next * h));
        find(text, NULL);
        const struct br_estimate *e = &found.orders.of[0].line[0].observed.order;
        covered += e->low <= order && e->high >= order;
        *half += (e->high - e->low) / 200;
    }
    return covered;
}

TEST(test_printed_digits)
{
    static const struct {
        bool fixed;
        int digits;
    } rows[] = {{false, 2}, {false, 3}, {true, 3}, {true, 4}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) { /* 95 % of 100, less their scatter */
        double half;
        assert_true(printed_lines(rows[i].fixed, rows[i].digits, &half) >= 92);
        assert_true(half < 0.12);
    }
}

/* ---- values ---- */

TEST(test_values)
{
    const double limit = M_PI; /* numbers of all digits */
    static const double even[] = {1, .5, .25, .125, .0625}, uneven[] = {1, .5, .25, .125, .12, .01};
    for (double p = 0.5; p < 4; p += 0.5)
        for (int kind = 0; kind < 2; kind++) {
            char text[1024];
            size_t used = (size_t)snprintf(text, sizeof text, "h,drag\n");
            for (size_t i = 0; i < (kind ? 6 : 5); i++) {
                const double h = kind ? uneven[i] : even[i];
                used += (size_t)snprintf(text + used, sizeof text - used, "%.17g,%.17g\n", h,
                                         limit - 2 * pow(h, p));
            }
            find(text, "drag");
            const struct br_orders_line *line = &found.orders.of[0].line[0];
            assert_int_equal(line->observed.points, kind ? 5 : 4);
            CLOSE(line->observed.point[0].error, 2 * (1 - pow(.5, p)), 1e-14);
            CLOSE(line->observed.point[0].z_against, .5, 0);
            CLOSE(line->observed.order.value, p, 1e-8);
            for (size_t i = 1; i < line->observed.points; i++) {
                assert_int_equal(line->observed.point[i].flag, BR_FLAG_NONE);
                CLOSE(br_orders_rate(line, i), p, 1e-8);
            }
            CLOSE(line->limits.gci.order, p, 1e-8);
            CLOSE(line->limits.gci.fine.ratio, kind ? 12 : 2, 1e-12); /* of the finest */
            CLOSE(line->limits.gci.fine.limit, limit, 1e-9);
            assert_int_equal(line->limits.triples, kind ? 4 : 3);
            for (size_t i = 0; i < line->limits.triples; i++) {
                CLOSE(line->limits.triple[i].order, p, 1e-8);
                CLOSE(line->limits.triple[i].fine.limit, limit, 1e-9);
                assert_int_equal(line->limits.triple[i].row, i + 2);
            }
            assert_true(line->limits.limit.value.low <= limit &&
                        line->limits.limit.value.high >= limit);
        }
}

/* What finer sizes would give, of errors and of values; not at a floor, nor where a run failed. */
TEST(test_finer)
{
    double given;
    find("n,e\n8,.049382715604936\n16,.012345678901234\n32,.0030864197253085\n", NULL);
    struct br_orders_forecast f = br_orders_forecast_of(&found.orders, &found.orders.of[0]);
    CLOSE(br_orders_next(&found.orders, &f, &given), .000771604931327125, 1e-12);
    CLOSE(given, 64, 0);
    CLOSE(br_orders_needed(&found.orders, &f, 1e-3), 57, 0); /* 56.2 */
    CLOSE(br_orders_needed(&found.orders, &f, f.number * 1.001e-4), 3199, 0);
    assert_true(isnan(br_orders_needed(&found.orders, &f, f.number * .999e-4)));
    find("h,u\n1,1.1415926535897931\n.5,2.6415926535897931\n.25,3.0165926535897931\n"
         ".125,3.1103426535897931\n",
         "u"); /* pi - 2 h^2 */
    f = br_orders_forecast_of(&found.orders, &found.orders.of[0]);
    CLOSE(f.number, 1.25 * 0.03125 / 3.1103426535897931, 1e-12);
    CLOSE(br_orders_next(&found.orders, &f, &given), f.number / 4, 1e-12);
    CLOSE(given, 0.0625, 0);
    CLOSE(br_orders_needed(&found.orders, &f, f.number / 16), 0.03125, 1e-12);
    find("h,u\n1,3\n.5,4.5\n.25,4.875\n.125,4.96875\n.0625,\n", "u");
    assert_null(br_orders_forecast_of(&found.orders, &found.orders.of[0]).line);
    find("h,e\n1,1.01\n.5,.26\n.25,.0725\n.125,.025625\n.0625,.01390625\n", NULL); /* h^2 + .01 */
    assert_null(br_orders_forecast_of(&found.orders, &found.orders.of[0]).line);
    find("h,e\n1,.999\n.5,.249\n.25,.0615\n.125,.014625\n.0625,.00290625\n", NULL); /* h^2 - .001 */
    assert_true(found.orders.of[0].line[0].observed.law == BR_LAW_OFFSET);
    assert_null(br_orders_forecast_of(&found.orders, &found.orders.of[0]).line);
    find(floor_table(12, pow(4, -7)), NULL); /* its rows are left out */
    assert_null(br_orders_forecast_of(&found.orders, &found.orders.of[0]).line);
    find(table_of(4, 4, 2, 1), NULL); /* a grid */
    assert_null(br_orders_forecast_of(&found.orders, &found.orders.of[0]).line);
    find("dofs,e\n64,.049382715604936\n256,.012345678901234\n1024,.0030864197253085\n", NULL);
    f = br_orders_forecast_of(&found.orders, &found.orders.of[0]);
    br_orders_next(&found.orders, &f, &given);
    CLOSE(given, 4096, 0);
    assert_true(
        isnan(br_orders_needed(&found.orders, &f, f.number * .99e-2))); /* 101 times as many */
    CLOSE(br_orders_needed(&found.orders, &f, f.number * 1.024e-2), 100000, 0);
}

/* The number that a size was made of; of a size between two numbers, the larger one. */
TEST(test_given)
{
    static const double list[] = {1, 7, 49, 1000, 65537, 1368999999, 99999999999.0};
    static const char *const columns[] = {"n", "steps", "dofs", "cells"};
    for (size_t c = 0; c < 4; c++)
        for (int dimension = 1; dimension <= 3; dimension++)
            for (size_t i = 0; i < sizeof list / sizeof *list; i++) {
                const struct br_resolution_column *column = br_resolution_column_find(columns[c]);
                const double z = br_numbers_z(column, list[i], dimension);
                CLOSE(br_numbers_given(column, z, dimension), list[i], 0);
                const double between = br_numbers_z(column, list[i] + 0.3, dimension);
                CLOSE(br_numbers_given(column, between, dimension), list[i] + 1, 0);
            }
}

/* A difference goes over a missing value; without any finer value it names the finest row. */
TEST(test_gap_in_values)
{
    find("h,u\n1,1\n.5,2\n.25,\n.125,3.5\n.0625,4\n.03125,\n.015625,-\n", "u");
    const struct br_point *p = found.orders.of[0].line[0].observed.point;
    static const char *const label[] = {"h = 1",     "h = 0.5",      "h = 0.25",
                                        "h = 0.125", "h = 0.015625", "h = 0.03125"};
    for (size_t i = 0; i < 6; i++) {
        assert_string_equal(p[i].label, label[i]);
        assert_int_equal(p[i].flag == BR_FLAG_FAILED, i == 2 || i > 3);
    }
    CLOSE(p[1].error, 1.5, 0);
    CLOSE(p[1].z_against, 0.125, 0);
}

/* Differences that fall or grow faster than any order: nothing is said of them. */
TEST(test_steep_values)
{
    find("h,u\n1,0\n.5,1e300\n.25,1\n.125,2\n.0625,3\n.03125,1e300\n.015625,0\n"
         ".0078125,1e-300\n.00390625,2e-300\n",
         "u");
    const struct br_orders_line *line = &found.orders.of[0].line[0];
    CLOSE(br_orders_rate(line, 1), 0, 1e-9);
    assert_true(isnan(br_orders_rate(line, 2)));
    CLOSE(br_orders_rate(line, 3), 0, 1e-9);
    assert_true(isnan(br_orders_rate(line, 4)));
}

/* All runs count, also the finest one of values, which no difference begins at; short ones do not.
 */
TEST(test_growth)
{
    for (int is_value = 0; is_value < 2; is_value++) {
        struct br_numbers numbers =
            read_with("h,u\n1,1\n.5,.2\n.25,4\n.125,8\n.0625,16\n", is_value ? "u" : NULL);
        OWNED(br_orders) orders;
        struct br_estimate growth;
        for (int i = 0; i < 5; i++)
            numbers.row[i].seconds = i < 2 ? 0.001 : 0.1 * pow(8, i);
        MUST(br_orders_find(&numbers, 2, &orders, &err));
        MUST(br_orders_growth(&orders, BR_AXIS_SPACE, &growth, &err));
        CLOSE(growth.value, 3, 1e-9);
        assert_true(growth.low < 3 + 1e-9 && growth.high > 3 - 1e-9 && growth.low < growth.high);
        MUST(br_orders_growth(&orders, BR_AXIS_TIME, &growth, &err));
        assert_true(isnan(growth.value));
        for (int i = 0; i < 5; i++)
            numbers.row[i].seconds = 1e-6 * pow(8, i);
        MUST(br_orders_growth(&orders, BR_AXIS_SPACE, &growth, &err));
        assert_true(isnan(growth.value));
        br_numbers_clear(&numbers);
    }
}

/* ---- expectations ---- */

static void refuse_expectation(const char *text, const char *message)
{
    FREED struct br_order_expectation *e = NULL;
    size_t count = 0;
    REFUSED(br_expectations_read(text, 0, &e, &count, &err), BR_BAD_INPUT, message);
}

TEST(test_grammar)
{
    struct br_order_expectation *e = NULL;
    size_t count = 0;
    MUST(br_expectations_read(" l2 : h 2 +- 0.1, k 1\u00b1.05 down to 1e-9;\n drag x:k1+-.2 ", 0,
                              &e, &count, &err));
    assert_int_equal(count, 3);
    assert_string_equal(e[0].quantity, "l2");
    assert_int_equal(e[0].axis, BR_AXIS_SPACE);
    CLOSE(e[0].band.order, 2, 0);
    CLOSE(e[0].band.tolerance, 0.1, 0);
    CLOSE(e[0].band.down_to, 0, 0);
    assert_string_equal(e[1].quantity, "l2");
    assert_int_equal(e[1].axis, BR_AXIS_TIME);
    CLOSE(e[1].band.tolerance, 0.05, 0);
    CLOSE(e[1].band.down_to, 1e-9, 0);
    assert_string_equal(e[2].quantity, "drag x");
    assert_int_equal(e[2].axis, BR_AXIS_TIME);
    free(e);
    e = NULL; /* names that begin alike are two */
    count = 0;
    MUST(br_expectations_read("l2: h 2 +- .1; l2v: h 1 +- .1; l: h 1 +- .1", 0, &e, &count, &err));
    assert_int_equal(count, 3);
    free(e);
    refuse_expectation("", "expected an order, as in 'l2: h 2 +- 0.1'");
    refuse_expectation("l2", "found 'l2', expected an error's name and ':'");
    refuse_expectation(": h 2 +- .1", "expected an error's name");
    refuse_expectation("l2: x 2 +- .1", "found 'x 2 +- .1', expected an order above 0");
    refuse_expectation("l2: h -2 +- .1", "expected an order above 0");
    refuse_expectation("l2: h nan +- .1", "found 'nan +- .1', expected an order above 0");
    refuse_expectation("l2 = 2; h1; x = 2", "found 'h1; x = 2', expected an error's name");
    refuse_expectation("l2 = two", "found 'two', expected an order above 0");
    refuse_expectation("l2: h 2 +- 0", "expected a tolerance above 0 and below the order");
    refuse_expectation("l2: h 2 +- 2", "expected a tolerance above 0 and below the order");
    refuse_expectation("l2: h 4 to 2 +- .1", "expected an order above the first");
    refuse_expectation("l2: h 2 +- .1 down to 0", "expected an error above 0");
    refuse_expectation("l2: h 2 +- .1 more", "found 'more', expected ',' or ';' or the end");
    refuse_expectation("l2: h 2 +- .1,", "found '', expected an order above 0");
    refuse_expectation("l2: h 2 +- .1, k two", "found 'two', expected an order above 0");
    refuse_expectation("l2: h <= 2", "errors that do not fall have an order below any limit");
    refuse_expectation("l2: h >= 0", "expected an order above 0");
    refuse_expectation("l2: h >= 1.8 +- .1",
                       "found '+- .1', expected nothing: a least order has no tolerance");
    refuse_expectation("l2 >= 1.8 \u00b1 .1", "a least order has no tolerance");
    refuse_expectation(">= 1.8 +- .1", "a least order has no tolerance");
    refuse_expectation("l2: h exponential >= 1", "expected a factor above 1");
    refuse_expectation("l2: h >= 1.8, at most 3", "it belongs to one order");
    refuse_expectation("l2: h 2, constant 3 to 2",
                       "expected a constant above 0, and above the first");
    refuse_expectation("l2: h 2 +- .1, h 1 +- .1", "the order of l2 in h is given twice");
    refuse_expectation("2, >= 1", "the order of the errors is given twice");
    refuse_expectation("0123456789012345678901234567890123456789012345678901234567890123: h 2 +- 1",
                       "expected a name of at most 63 bytes");
}

/* Each text is read as another one says, in full. */
TEST(test_short_grammar)
{
    static const char *const rows[][2] = {
        {"2", " - 2 +- 0.2"},
        {"h 2", " h 2 +- 0.2"},
        {">= 1.8", " - >= 1.8"},
        {"k \u2265 1.8", " k >= 1.8"},
        {"at least 1.8", " - >= 1.8"},
        {"L2=2", "L2 - 2 +- 0.2"},
        {"L2 = 2 ; H1 = h 1", "L2 - 2 +- 0.2;H1 h 1 +- 0.1"},
        {"L2 >= 1.8, k 1", "L2 - >= 1.8;L2 k 1 +- 0.1"},
        {"L2=2, H1: h 1 +- .2; x >= 3", "L2 - 2 +- 0.2;H1 h 1 +- 0.2;x - >= 3"},
        {"l2: h 2 to 4 +- .2, constant 2 to 3", "l2 h 2 to 4 +- 0.2, 2 to 3"},
        {"l2: 2, at most 3, k >= 1", "l2 - 2 +- 0.2, nan to 3;l2 k >= 1"},
        {"l2: exponential >= 8", "l2 - exponential >= 8"},
        {"e [m = P1]: h 2; e [k = 2] >= 1; a>b: 3",
         "e [m = P1] h 2 +- 0.2;e [k = 2] - >= 1;a>b - 3 +- 0.3"},
        {"\"a: h 2\" = 3", "a: h 2 - 3 +- 0.3"},
        {"2: h 1", "2 h 1 +- 0.1"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        FREED struct br_order_expectation *e = NULL;
        size_t count = 0;
        char text[1024] = "", band[BR_EXPECTATION_TEXT];
        MUST(br_expectations_read(rows[i][0], 0, &e, &count, &err));
        for (size_t j = 0; j < count; j++) {
            br_append(text, sizeof text, "%s%s %s %s", j ? ";" : "", e[j].quantity,
                      e[j].axis == BR_AXES ? "-" : br_axis_letters[e[j].axis],
                      br_expectation_text(&e[j].band, band));
            if (!isnan(e[j].band.ceiling))
                br_append(text, sizeof text, ", %g to %g", e[j].band.floor, e[j].band.ceiling);
        }
        assert_string_equal(text, rows[i][1]);
    }
}

/* The verdict on the last expectation of the text; BR_BAD_INPUT, in the place of one, where it has
 * none. why: out, the reason. */
static int verdict_of(const char *table, const char *values, const char *expected, char why[768])
{
    FREED struct br_order_expectation *e = NULL;
    OWNED(br_check) check = {.path = "t.csv"};
    size_t count = 0;
    find(table, values);
    MUST(br_expectations_read(expected, 0, &e, &count, &err));
    int verdict = -1;
    err.status = BR_OK;
    if (!br_orders_check(&found.orders, e, count, &check, &err)) {
        assert_int_equal(check.count, count);
        verdict = (int)check.cases[count - 1].verdict;
    }
    assert_true(verdict >= 0 || err.status == BR_BAD_INPUT);
    snprintf(why, 768, "%.767s", verdict < 0 ? err.message : check.cases[count - 1].reason);
    return verdict;
}

/* An error that is just where the errors are expected to stop stops there. */
TEST(test_down_to)
{
    static const char table[] = "n,l2\n10,1e-2\n20,2.5e-3\n40,6.25e-4\n80,1.5625e-4\n160,1e-4\n";
    char why[768];
    assert_int_equal(verdict_of(table, NULL, "l2: h 2 +- 0.1 down to 1e-4", why), BR_PASS);
    assert_int_not_equal(verdict_of(table, NULL, "l2: h 2 +- 0.1 down to 0.99e-4", why), BR_PASS);
}

/* Rates from 1.9997 to 2.0000 are no reason to refine where 3 is expected. */
TEST(test_advice)
{
    static const char table[] = "n,l2\n10,3.6960e-3\n20,9.2422e-4\n40,2.3107e-4\n80,5.7767e-5\n";
    char why[768];
    assert_int_equal(verdict_of(table, NULL, "l2: h 3 +- 0.1", why), BR_FAIL);
    if (!strstr(why, "finer grids do not help: the two finest show 2.00"))
        fail_msg("%s", why);
    static const char digits[] = "n,l2\n4,.0613\n8,.0154\n16,.00387\n32,.000966\n64,.000243\n";
    assert_int_equal(verdict_of(digits, NULL, "l2: h 2 +- 0.005", why), BR_INCONCLUSIVE);
    if (!strstr(why, "Take a tolerance of 0.01, or give errors with more digits") ||
        strstr(why, "add a row"))
        fail_msg("%s", why);
    static const struct {
        const char *table, *values, *expect, *says;
    } rows[] = {
        {"dt,e\n.1,.2\n.05,.05\n.025,.0125\n.0125,30\n.00625,1e8\n", NULL, "e: k 2 +- 0.1",
         "the errors fall, but from dt = 0.025 on they grow, to 1.00e+08: a scheme that is not"},
        {"dt,e\n.1,1e9\n.05,3e4\n.025,.0125\n.0125,.0034\n.00625,.00078\n", NULL, "e: k 2 +- 0.1",
         "the coarse ones are beyond a limit of stability"},
        {"n,e\n8,.1\n16,.04\n32,.022\n64,.04\n128,.003\n", NULL, "e: h 2 +- 0.1",
         "the errors rise and fall: converge each run further"},
        {"n,e\n8,.1\n16,.025\n32,.00625\n64,.0015625\n128,.001\n", NULL, "2",
         "expect the order 'down to 4e-03', and add 1 coarser than n = 8"},
        {"n,e\n8,.1\n16,.025\n32,.00625\n64,.0015625\n128,.0004\n", NULL, "2 down to 7e-3",
         "add a row coarser than n = 8"},
        {"n,e\n8,1.31\n16,.92\n32,1.22\n64,.85\n128,1.3\n", "e", "e: h 2 +- 0.1",
         "the differences rise and fall: converge each run further"},
        {"n,e\n8,1\n16,1.1\n32,1.3\n64,1.7\n128,2.5\n", "e", "e: h 2 +- 0.1",
         "the differences grow with each finer size: there is no convergence"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        assert_int_not_equal(verdict_of(rows[i].table, rows[i].values, rows[i].expect, why),
                             BR_PASS);
        if (!strstr(why, rows[i].says))
            fail_msg("%zu: %s", i, why);
    }
}

static double of_time_alone(double h, double k)
{
    return k + 1e-12 * h * h;
}

/* No joint model has another order in h at each k. */
static double bent(double h, double k)
{
    return pow(h, k < 0.1 ? 2 : k < 0.2 ? 1 : 3);
}

/* The same, and scatter at the finest k. */
static double bent_and_wide(double h, double k)
{
    const double off = h > 0.3 ? -0.2 : h > 0.2 ? 0.5 : h > 0.1 ? -0.4 : 0.1;
    return k < 0.1 ? pow(h, 2.4) * exp(off) : bent(h, k < 0.2 ? 0.06 : k);
}

static double value_of_both(double h, double k)
{
    return 5 + h * h - k;
}

static double logarithm(double h, double k)
{
    return log(h) + 0 * k;
}

static double floor_below_a_product(double h, double k)
{
    return h * k * k + 0.05;
}

static double with_a_product(double h, double k)
{
    return 5 + h - k / 2 + h * k / 2;
}

/* Errors of which a floor is half and more are left out, those that it hardly changes are not; also
 * where they scatter at the floor. */
TEST(test_what_a_floor_changes)
{
    static const char scattered[] =
        "h,k,l2\n1,1,1.06603\n1,.5,.550146\n1,.25,.309583\n.5,1,.172254\n.5,.5,.110548\n"
        ".5,.25,.085169\n.25,1,.0629932\n.25,.5,.0599294\n.25,.25,.0555143\n.125,1,.0541571\n"
        ".125,.5,.0490572\n.125,.25,.0491872\n";
    for (int i = 0; i < 2; i++) {
        find(i ? scattered : grid_of(5, 5, floor_below_a_product), NULL);
        for (size_t row = 0; row < found.numbers.rows; row++) {
            const struct br_row_point *at = &found.orders.of[0].point[BR_AXIS_TIME][row];
            const double error = found.numbers.row[row].number[0];
            const bool out = at->line->observed.point[at->index].flag == BR_FLAG_STALLED;
            if (error < (i ? 0.12 : 0.1) ? !out : error > 0.3 && out)
                fail_msg("table %d: the error %g is left out: %d", i, error, out);
        }
    }
}

/* Where a grid does not show an order, the answer says so and the verdict is no other one. */
TEST(test_orders_that_a_grid_hides)
{
    char why[768];
    char *table = grid_of(5, 5, of_time_alone);
    find(table, NULL);
    const struct br_orders_answer *answer = found.orders.of[0].answer;
    assert_true(isnan(answer[BR_AXIS_SPACE].order.value));
    assert_string_equal(
        answer[BR_AXIS_SPACE].open,
        "the order in h is hidden, since the error in k is larger everywhere: a finer k, or a "
        "coarser h, would show it");
    CLOSE(answer[BR_AXIS_TIME].order.value, 1, 1e-6);
    const char *open = answer[BR_AXIS_SPACE].open; /* a new find clears the answer, not its text */
    assert_int_equal(verdict_of(table, NULL, "l2: h 2 +- 0.1", why), BR_INCONCLUSIVE);
    assert_string_equal(why, open);
    assert_int_equal(verdict_of(table, NULL, "l2: k 1 +- 0.1", why), BR_PASS);
    table = grid_of(5, 5, bent);
    find(table, NULL);
    assert_false(br_joint_describes(&found.orders.of[0].joint));
    assert_true(isnan(found.orders.of[0].answer[BR_AXIS_SPACE].order.value));
    assert_int_equal(verdict_of(table, NULL, "l2: h 2 +- 0.1", why), BR_INCONCLUSIVE);
    assert_string_equal(why, found.orders.of[0].answer[BR_AXIS_SPACE].open);
    /* A wide interval holds the order of the next line, 2, which does not hold its own. */
    find(grid_of(5, 5, bent_and_wide), NULL);
    assert_false(br_joint_describes(&found.orders.of[0].joint));
    assert_true(isnan(found.orders.of[0].answer[BR_AXIS_SPACE].order.value));
    assert_non_null(found.orders.of[0].answer[BR_AXIS_SPACE].open);
}

/* ---- kinds of grids, each for several sizes of its constants ---- */

enum { KINDS = 6 };

/* A table of sizes from 1/8 on, to so many digits. keep: NULL, all cells. */
static const char *kind_of(double (*f)(double h, double k, int kind), int kind, int digits,
                           bool (*keep)(int i, int j))
{
    static char text[MOST_TEXT];
    size_t used = (size_t)snprintf(text, sizeof text, "h,k,l2\n");
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < (keep ? 5 : 4); j++) {
            const double h = ldexp(1, -3 - i), k = ldexp(1, -3 - j);
            if (!keep || keep(i, j))
                used += (size_t)snprintf(text + used, sizeof text - used, "%.17g,%.17g,%.*e\n", h,
                                         k, digits - 1, f(h, k, kind));
        }
    return text;
}

static double steps_alone(double h, double k, int kind)
{
    return 0 * h + (1 + 0.37 * kind) * k * (1 - 0.02 * kind * k);
}

static double with_a_logarithm(double h, double k, int kind)
{
    return (21. / (1 + kind)) * h * h * log(1 / h) + k;
}

static double next_term_larger(double h, double k, int kind)
{
    return 20 * (h * h + h / (8 + 4 * kind)) + 0.5 * k;
}

static double blown_up(double h, double k, int kind)
{
    const double e = 64 * h * h + 10 * k;
    return k / h > 3 ? e * pow(10, 1 + 2 * kind) : e;
}

static double of_both(double h, double k, int kind)
{
    return 64 * h * h + (1 + kind) * k;
}

static double alike(double h, double k, int kind)
{
    return (1 + kind) * (h * h + k * k);
}

static bool on_two_diagonals(int i, int j)
{
    return j == i || j == i + 1;
}

static void check_both(const char *table, double p, double q, int in_h, int in_k)
{
    char expected[64], why[768];
    snprintf(expected, sizeof expected, "l2: h %g +- 0.1", p);
    const int h = verdict_of(table, NULL, expected, why);
    if (h != in_h)
        fail_msg("in h: %d, %s", h, why);
    snprintf(expected, sizeof expected, "l2: k %g +- 0.1", q);
    const int k = verdict_of(table, NULL, expected, why);
    if (k != in_k)
        fail_msg("in k: %d, %s", k, why);
}

/* An order of zero in h is a constant, and no interval comes from a fit that goes through all
 * points: the order in h is hidden, that in k has a width of its digits. */
TEST(test_an_axis_that_is_not_observed)
{
    for (int kind = 0; kind < KINDS; kind++) {
        const char *table = kind_of(steps_alone, kind, 3, NULL);
        find(table, NULL);
        const struct br_orders_answer *answer = found.orders.of[0].answer;
        const struct br_estimate *k = &answer[BR_AXIS_TIME].order;
        assert_true(isnan(answer[BR_AXIS_SPACE].order.value));
        assert_non_null(strstr(answer[BR_AXIS_SPACE].open, "hidden"));
        assert_true(k->low <= 1 && 1 <= k->high);
        AT_MOST(2e-3, k->high - k->low); /* half a unit of three digits is up to 0.5 % */
        check_both(table, 2, 1, BR_INCONCLUSIVE, BR_PASS);
    }
}

TEST(test_laws_of_lines_on_a_grid)
{
    char why[768];
    for (int kind = 0; kind < KINDS; kind++) {
        find(kind_of(with_a_logarithm, kind, 6, NULL), NULL);
        const struct br_estimate *h = &found.orders.of[0].answer[BR_AXIS_SPACE].order;
        assert_true(h->low <= 2 && 2 <= h->high && h->high - h->low < 0.2);
        find(kind_of(next_term_larger, kind, 6, NULL), NULL);
        h = &found.orders.of[0].answer[BR_AXIS_SPACE].order;
        assert_true(h->low <= 1 && 1 <= h->high && h->high - h->low < 0.2);
        assert_int_equal(
            verdict_of(kind_of(next_term_larger, kind, 6, NULL), NULL, "l2: h 2 +- 0.1", why),
            BR_FAIL);
        assert_null(strstr(why, "the two finest")); /* which the error in k bends */
    }
}

/* Three cells of sixteen are beyond a limit of stability: they are named and left out. */
TEST(test_blown_up_cells)
{
    for (int kind = 0; kind < KINDS; kind++) {
        const char *table = kind_of(blown_up, kind, 6, NULL);
        check_both(table, 2, 1, BR_PASS, BR_PASS);
        find(table, NULL);
        const struct br_quantity_orders *of = &found.orders.of[0];
        for (size_t i = 0; i < found.numbers.rows; i++) {
            const double *z = found.numbers.row[i].z;
            const struct br_row_point *at = &of->point[BR_AXIS_TIME][i];
            const enum br_flag flag = z[1] / z[0] > 3 ? BR_FLAG_OUTLIER : BR_FLAG_NONE;
            assert_int_equal(of->flag[i], flag);
            assert_int_equal(at->line->observed.point[at->index].flag, flag);
        }
        assert_int_equal(of->joint.points, 13);
    }
}

/* On a grid of two studies one lacks the coarsest mesh, and its finest error is zero. */
TEST(test_rows_that_a_study_lacks)
{
    char text[4096] = "method,h,k,l2\n";
    for (int i = 0; i < 32; i++) {
        const double h = pow(2, -i / 4 % 4), k = pow(2, -i % 4);
        const bool second = i >= 16, zero = second && i % 16 == 15;
        if (!second || h < 1)
            snprintf(text + strlen(text), sizeof text - strlen(text), "P%d,%g,%g,%.17g\n",
                     second + 1, h, k, zero ? 0 : power_law(h, k, 2, 1));
    }
    find(text, NULL);
    const struct br_quantity_orders *of = &found.orders.of[1];
    for (size_t i = 0; i < 16; i++)
        assert_int_equal(of->flag[i], i < 4     ? BR_FLAG_ABSENT
                                      : i == 15 ? BR_FLAG_ROUND_OFF
                                                : BR_FLAG_NONE);
    assert_int_equal(of->joint.points, 11);
}

/* No line has three sizes. */
TEST(test_two_diagonals)
{
    for (int kind = 0; kind < KINDS; kind++) {
        check_both(kind_of(of_both, kind, 6, on_two_diagonals), 2, 1, BR_PASS, BR_PASS);
        assert_int_equal(found.orders.of[0].lines, 0);
        check_both(kind_of(alike, kind, 6, on_two_diagonals), 2, 2, BR_PASS, BR_PASS);
    }
}

/* The limit of a value of h and k is that of both; one direction alone ends beside it. */
TEST(test_limit_of_a_grid)
{
    find(grid_of(5, 6, value_of_both), "l2");
    const struct br_quantity_orders *of = &found.orders.of[0];
    CLOSE(of->limit.value.value, 5, 1e-9);
    assert_true(of->limit.value.low < 5 && of->limit.value.high > 5);
    CLOSE(br_orders_finest(of, BR_AXIS_SPACE)->limits.limit.value.value, 5 - pow(2, -5), 1e-9);
    /* Both intervals, and the product at the finest sizes, which neither line shows alone. */
    find(grid_of(4, 4, with_a_product), "l2");
    of = &found.orders.of[0];
    double half = pow(2, -7);
    for (int axis = 0; axis < BR_AXES; axis++) {
        const struct br_estimate e = br_orders_finest(of, (enum br_axis)axis)->limits.limit.value;
        half += fmax(e.high - e.value, e.value - e.low);
    }
    CLOSE(of->limit.value.high - of->limit.value.low, 2 * half, 1e-3);
    /* Without the finest cell, from the one beside it. */
    static char missing[MOST_TEXT];
    snprintf(missing, sizeof missing, "%s", grid_of(5, 6, value_of_both));
    strcpy(strrchr(missing, ',') + 1, "-\n");
    find(missing, "l2");
    of = &found.orders.of[0];
    CLOSE(of->limit.value.value, 5, 1e-9);
    assert_true(of->limit.value.low < 5 && of->limit.value.high > 5);
    find("h,l2\n1,0\n.5,1\n.25,2\n.125,3.000000001\n.0625,4\n", "l2");
    assert_true(isnan(found.orders.of[0].limit.value.value));
    find(grid_of(5, 5, logarithm), "l2");
    assert_true(isnan(found.orders.of[0].limit.value.value));
}

static double weak_singularity(double h, double k)
{
    return pow(h / 8, 2) * log(8 / h) + 0.2 * pow(k / 8, 1.5);
}

/* Three sizes distinguish no law, and wide intervals of two lines agree about any order. */
TEST(test_three_sizes_of_a_logarithm)
{
    static const char six_digits[] =
        "h,k,l2\n12,4,0.435642\n12,2,0.299113\n12,1,0.250843\n6,4,0.312686\n6,2,0.176157\n"
        "6,1,0.127887\n3,4,0.254905\n3,2,0.118377\n3,1,0.070107\n"; /* h^1.5 log(1/h) + k^1.5 */
    find(grid_of(3, 3, weak_singularity), NULL);
    const struct br_estimate *order = &found.orders.of[0].answer[BR_AXIS_SPACE].order;
    if (!(order->low <= 2 && order->high >= 1.995))
        fail_msg("the order is 2, found %g to %g", order->low, order->high);
    find(six_digits, NULL);
    order = &found.orders.of[0].answer[BR_AXIS_SPACE].order;
    if (br_order_determined(order) && order->high < 1.5)
        fail_msg("the order is 1.5, found %g to %g", order->low, order->high);
}

TEST(test_verdicts)
{
    enum { REFUSED_ONE = -1 };
    static const char near_floor[] = "h,l2\n1,1\n.5,.25\n.25,.0625\n.125,.015625\n.0625,.0039\n"
                                     ".03125,.0039\n.015625,.0039\n";
    static const char few[] = "h,l2\n1,1\n.5,.25\n.25,.06\n",
                      gap[] = "h,l2\n1,1\n.5,.25\n.25,\n.125,.015625\n.0625,.00390625\n",
                      gaps[] = "h,l2\n1,1\n.5,.25\n.25,\n.125,.015625\n.0625,-\n",
                      drag[] = "h,u\n1,4\n.5,2\n.25,1.5\n.125,1.375\n.0625,1.34375\n";
    static const char spectral[] = "n,l2\n2,.01562\n3,.001953\n4,2.441e-4\n5,3.052e-5\n"
                                   "6,3.815e-6\n7,4.768e-7\n";
    /* against a reference of a size near the finest */
    static const char rises[] = "h,l2\n.1,1\n.05,.57196\n.025,.26775\n.0125,.093036\n";
    static const char digits[] = "n,l2\n4,.0613\n8,.0154\n16,.00387\n32,.000966\n64,.000243\n",
                      two[] = "h,Eh,eH\n1,4,4\n.5,1,1\n.25,.25,.25\n.125,.0625,.0625\n";
    static const char cases[] = "m,n,l2\nA,1,1\nA,2,.25\nA,4,.0625\nA,8,.015625\nB,1,1\nB,2,.5\n"
                                "B,4,.25\nB,8,.125\nB,16,.0625\n";
    /* the run of the finest size failed */
    static const char lost[] = "h,l2\n4,16\n2,4\n1,1\n.5,.25\n.25,.0625\n.125,.015625\n.0625,inf\n";
    static const char failed[] = "n,l2\n4,16\n8,4\n16,1\n32,.25\n64,.0625\n# 128 failed\n";
    static const char repeats[] =
        "n,run,l2\n4,1,16\n4,2,16.1\n8,1,4\n8,2,4.1\n16,1,1\n16,2,1.01\n"
        "32,1,.25\n32,2,.251\n64,1,.0625\n64,2,.0626\n128,1,.0156\n128,2,nan\n";
    char line[1024], grid[4096], floor[4096], blown[4096];
    strcpy(line, table_of(5, 0, 2, 0));
    strcpy(grid, table_of(5, 5, 2, 1));
    strcpy(blown, grid);
    strcpy(strrchr(blown, ',') + 1, "nan\n");
    strcpy(floor, floor_table(12, pow(4, -7)));
    const struct {
        const char *table, *values, *expected;
        int verdict;
        const char *why;
    } rows[] = {
        {line, NULL, "l2: h 2 +- 0.1", BR_PASS, ""},
        {line, NULL, "l2: h 3 +- 0.1", BR_FAIL, ""},
        {grid, NULL, "l2: h 2 +- 0.1, k 1 +- 0.1", BR_PASS, ""},
        {grid, NULL, "l2: k 2 +- 0.1", BR_FAIL, ""},
        {grid, NULL, "l2: h 1 +- 0.1", BR_FAIL, ""},
        {few, NULL, "l2: h 2 +- 0.1", BR_INCONCLUSIVE, "has 3 errors, expected at least 4"},
        {few, "l2", "l2: h 2 +- 0.1", BR_INCONCLUSIVE,
         "3 values have 2 differences; a verdict needs 5 sizes; add a row finer than all others"},
        {gap, NULL, "l2: h 2 +- 0.1", BR_PASS, ""},
        {gap, NULL, "l2: h 3 +- 0.1", BR_FAIL, ""},
        {gaps, NULL, "l2: h 2 +- 0.1", BR_INCONCLUSIVE,
         "3 of 5 errors can be used, an order needs 4"},
        {lost, NULL, ">= 1.8", BR_INCONCLUSIVE, "the finest row, h = 0.0625, has no number"},
        {lost, NULL, "2.5 +- 0.1", BR_FAIL, ""},
        {repeats, NULL, "2", BR_INCONCLUSIVE, "the finest row, n = 128, has no number"},
        {failed, NULL, "2", BR_INCONCLUSIVE, "the finest row, n = 128, has no number"},
        {cases, NULL, "l2 [m = A] = 2", BR_PASS, ""}, /* it has no row n = 16 */
        {lost, "l2", "2", BR_INCONCLUSIVE, "h = 0.0625, has no number; without it the others"},
        {blown, NULL, "h 2", BR_INCONCLUSIVE, "the finest row, h = 0.03125, k = 0.03125, has no"},
        {blown, NULL, "k 1", BR_INCONCLUSIVE, "the finest row, h = 0.03125, k = 0.03125, has no"},
        {floor, NULL, "l2: h 2 +- 0.1", BR_INCONCLUSIVE, "the errors do not fall"},
        {floor, NULL, "l2: h 2 +- 0.1 down to 1e-3", BR_PASS, ""},
        {floor, NULL, "l2: h 3 +- 0.1 down to 1e-3", BR_FAIL, ""},
        {near_floor, NULL, "l2: h 2 +- 0.1 down to .004", BR_PASS, ""},
        {spectral, NULL, "l2: h exponential 8 +- 0.5", BR_PASS, ""},
        {spectral, NULL, "l2: h exponential 9 +- 0.5", BR_FAIL, "one more of 1/h divides"},
        {spectral, NULL, "l2: h 4 +- 0.5", BR_FAIL, "the errors fall exponentially, by no order"},
        {line, NULL, "l2: h exponential 8 +- 0.5", BR_FAIL, "their order is 2.00"},
        {rises, NULL, "l2: h 1 +- 0.1", BR_INCONCLUSIVE, "may fall exponentially, with a"},
        {rises, NULL, "exponential >= 1.01", BR_INCONCLUSIVE, "exponentially, with a probability"},
        {drag, "u", "u: h 2 +- 0.1", BR_PASS, ""},
        {line, NULL, "2", BR_PASS, ""},
        {line, NULL, "L2 = 2", BR_PASS, ""},
        {line, NULL, ">= 1.8", BR_PASS, ""},
        {line, NULL, "l2: h >= 2.1", BR_FAIL, "lies below the band, at least 2.1"},
        {line, NULL, "l2: h 2, at most 2.9", BR_FAIL, "the constant, 3, is above its upper limit"},
        {line, NULL, "l2: h 2, constant 2.9 to 3.1", BR_PASS, ""},
        {digits, NULL, "l2: h >= 2", BR_INCONCLUSIVE, "contains the band's lower end, 2"},
        {spectral, NULL, "exponential >= 7.5", BR_PASS, ""},
        {spectral, NULL, "exponential >= 9", BR_FAIL, "expected at least 9"},
        {grid, NULL, "k >= 0.9", BR_PASS, ""},
        {grid, NULL, "2", REFUSED_ONE, "h and k are refined: expected one of the two"},
        {two, NULL, "2", REFUSED_ONE, "2 columns may be meant: expected the name of one"},
        {two, NULL, "Eh = 2; eH = 2", BR_PASS, ""},
        {two, NULL, "eh = 2", REFUSED_ONE,
         "an order of eh is expected, and 2 columns may be meant"},
        {line, NULL, "l3: h 2 +- .1", REFUSED_ONE,
         "t.csv: an order of 'l3' is expected, and there is no such column"},
        {line, NULL, "l2: k 2 +- .1", REFUSED_ONE,
         "t.csv: an order of l2 in k is expected, and there are no three sizes"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char why[768];
        const int verdict = verdict_of(rows[i].table, rows[i].values, rows[i].expected, why);
        if (verdict != rows[i].verdict || !strstr(why, rows[i].why))
            fail_msg("row %zu, %s: verdict %d, '%s'", i, rows[i].expected, verdict, why);
    }
}

/* Errors with noise, of any order and constant; the band does not hold the order. */
TEST(test_wrong_orders_never_pass)
{
    struct br_test_random random = {7};
    for (int i = 0; i < 300; i++) {
        char text[1024], expected[64], why[768];
        const double p = br_test_uniform(&random, 0.5, 4),
                     noise = br_test_log_uniform(&random, 1e-9, 1e-3);
        const double tolerance = br_test_uniform(&random, 0.05, 0.3);
        const double off = tolerance + br_test_uniform(&random, 0.01, 1);
        const double wrong =
            br_test_index(&random, 2) || p - off < tolerance + 0.05 ? p + off : p - off;
        size_t used = (size_t)snprintf(text, sizeof text, "n,l2\n");
        for (int row = 0; row < 4 + (int)br_test_index(&random, 5); row++)
            used += (size_t)snprintf(text + used, sizeof text - used, "%d,%.17g\n", 4 << row,
                                     5 * pow(4 << row, -p) *
                                         (1 + noise * br_test_uniform(&random, -1, 1)));
        snprintf(expected, sizeof expected, "l2: h %.17g +- %.17g", wrong, tolerance);
        if (verdict_of(text, NULL, expected, why) == BR_PASS)
            fail_msg("order %g passes as %s", p, expected);
    }
}

/* ---- without memory ---- */

static enum br_status whole_table(const void *text, struct br_error *why)
{
    OWNED(br_numbers) numbers;
    OWNED(br_orders) orders = {0};
    FREED struct br_order_expectation *e = NULL;
    OWNED(br_check) check = {.path = "t.csv"};
    size_t count = 0;
    enum br_status status = read_table(text, "l2", "u", &numbers);
    if (!status)
        status = br_orders_find(&numbers, 2, &orders, why);
    if (!status)
        status = br_expectations_read("l2: h 2 +- .1", 0, &e, &count, why);
    if (!status)
        status = br_orders_check(&orders, e, count, &check, why);
    return status;
}

/* A value that is missing spoils no difference of its neighbours: v = 7 + h^2, on every second
 * mesh. */
TEST(missing_values_hide_no_order)
{
    OWNED(br_numbers)
    n = read_with("h,v\n1,8\n.5,nan\n.25,7.0625\n.125,nan\n.0625,7.00390625\n"
                  ".03125,\n.015625,7.000244140625\n.0078125,-\n",
                  "v");
    OWNED(br_orders) orders;
    MUST(br_orders_find(&n, 2, &orders, &err));
    const struct br_orders_line *line = br_orders_finest(&orders.of[0], BR_AXIS_SPACE);
    CLOSE(line->observed.order.value, 2, 1e-6);
    assert_int_equal(line->observed.points, 7);
    assert_int_equal(line->observed.used, 3);
    for (size_t i = 0; i < 7; i++)
        assert_int_equal(line->observed.point[i].flag,
                         i % 2 || i == 6 ? BR_FLAG_FAILED : BR_FLAG_NONE);
}

TEST(test_without_memory)
{
    static const char *const csv = "h,k,l2,u\n1,1,2,4\n1,.5,1.5,2\n1,.25,1.2,1.5\n.5,1,1.3,1\n"
                                   ".5,.5,.7,1\n.5,.25,.5,1\n.25,1,1.1,1\n.25,.5,.6,1\n"
                                   ".25,.25,.3,1\n";
    br_test_without_memory(whole_table, csv, 60);
}

/* Values of nothing but scatter: the limit is the finest mean with its interval, by Student's t of
 * one degree of freedom, 12.706; and a mean has no printed digits. */
TEST(test_means_of_two)
{
    static const double h[] = {4, 2, 1}, mean[] = {1.5, 1.6, 1.5};
    OWNED(br_numbers) numbers = {.column = {br_resolution_column_find("h")}};
    OWNED(br_orders) orders;
    MUST(br_numbers_make_room(&numbers, 3, 1, &err));
    MUST(br_numbers_add_quantity(&numbers, "drag", NULL, true, &err));
    for (size_t i = 0; i < 3; i++) {
        struct br_numbers_row *row = &numbers.row[i];
        row->given[0] = row->z[0] = h[i];
        row->number[0] = mean[i];
        row->deviation[0] = 0.25;
        row->repeat = 2;
    }
    MUST(br_numbers_check(&numbers, "made", &err));
    MUST(br_orders_find(&numbers, 0, &orders, &err));
    const struct br_orders_line *line = &orders.of[0].line[0];
    assert_int_equal(line->limits.limit.sequence, BR_SEQUENCE_SCATTER);
    CLOSE(line->limits.limit.value.low, 1.5 - 0.25 * 12.706204736, 1e-8);
    CLOSE(line->limits.limit.value.high, 1.5 + 0.25 * 12.706204736, 1e-8);
    for (size_t i = 0; i < 2; i++)
        CLOSE(line->observed.point[i].rounding, 0, 0);
}
