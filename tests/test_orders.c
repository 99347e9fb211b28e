/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Orders of any program's numbers: of errors and values over one size that are known exactly. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "made_tables.h"

static bool stops_at_once(void *self)
{
    return ++*(int *)self > 0;
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

/* 1000 and 1001 elements are two lines over k. */
TEST(test_near_sizes)
{
    find("n,k,l2\n1000,.4,4\n1000,.2,2\n1000,.1,1\n1001,.4,4\n1001,.2,2\n1001,.1,1\n", NULL);
    assert_int_equal(found.orders.of[0].lines, 2);
    assert_int_equal(found.orders.of[0].line[0].observed.points, 3);
}

static void find_by_hand(const char *text, const char *columns)
{
    const struct br_orders_request q = {
        .path = (char *)"t.csv", .table = (char *)text, .columns = (char *)columns};
    br_orders_clear(&found.orders);
    br_numbers_clear(&found.numbers);
    MUST(br_orders_read(&q, &found.numbers, &err));
    MUST(br_orders_find(&found.numbers, 2, &found.orders, &err));
}

TEST(test_tied)
{
    const char *table = /* with all digits: rounded numbers leave other laws open */
        "h,k,l2\n1,1,.3333333333333333\n.5,.25,.08333333333333333\n"
        ".25,.0625,.02083333333333333\n.125,.015625,.005208333333333333\n";
    find(table, NULL);
    assert_null(found.numbers.column[BR_AXIS_TIME]);
    assert_non_null(strstr(found.numbers.taken, "k (refined together with h)"));
    find_by_hand(table, "h=h,k=k");
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

TEST(test_without_memory)
{
    static const char *const csv = "h,k,l2,u\n1,1,2,4\n1,.5,1.5,2\n1,.25,1.2,1.5\n.5,1,1.3,1\n"
                                   ".5,.5,.7,1\n.5,.25,.5,1\n.25,1,1.1,1\n.25,.5,.6,1\n"
                                   ".25,.25,.3,1\n";
    br_test_without_memory(whole_table, csv, 60);
}
