/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One line of errors for each law, with numbers that no other law makes: the law is found, with its
 * order, and no row but the finest is left out: a floor may hide that one. */
#include "study/fit/line_order.h"

#include <math.h>

#include "support.h"

enum { ROWS = 8, MOST = 12 };

/* Errors at z = 1, 1/2, 1/4, ... The finest is at z = 1/128. */
static double power(double z)
{
    return 3 * pow(z, 2);
}

static double next(double z)
{
    return 3 * pow(z, 2) * (1 + 0.2 * z);
}

static double lower(double z)
{
    return pow(z, 3) + 0.02 * pow(z, 2);
}

static double locking(double z)
{
    return 3 * z / (1 + 2 * z);
}

static double cancel(double z)
{
    return fabs(pow(z, 2) - 20 * pow(z, 3));
}

static double squares(double z)
{
    return hypot(pow(z, 4. / 3), 0.03 * pow(z, 2. / 3));
}

static double logarithm(double z)
{
    return pow(z, 2) * (3 - log(z));
}

static double floored(double z)
{
    return pow(z, 2) + 1e-4;
}

static double floor_squares(double z)
{
    return hypot(pow(z, 2), 2e-5);
}

static double offset(double z)
{
    return pow(z, 2) - 4e-5;
}

static const struct {
    double (*error)(double z);
    double order, off; /* the true order, and how far the value may be from it */
    double floor;      /* of the law; 0: none */
} lines[] = {
    [BR_LAW_POWER] = {power, 2, 1e-5, 0},
    [BR_LAW_NEXT] = {next, 2, 1e-3, 0},
    [BR_LAW_LOWER] = {lower, 2, 0.01, 0},
    [BR_LAW_LOCKING] = {locking, 1, 0.003, 0},
    [BR_LAW_CANCEL] = {cancel, 2, 0.01, 0},
    [BR_LAW_SQUARES] = {squares, 2. / 3, 0.01, 0},
    [BR_LAW_LOGARITHM] = {logarithm, 2, 0.01, 0},
    [BR_LAW_FLOOR] = {floored, 2, 0.01, 1e-4},
    [BR_LAW_FLOOR_SQUARES] = {floor_squares, 2, 0.02, 2e-5},
    [BR_LAW_OFFSET] = {offset, 2, 0.01, 0},
};

static void find(const struct br_order_point *point, size_t count, struct br_line_order *found)
{
    struct br_error err = {0};
    MUST(br_line_order_find(point, count, found, &err));
}

static void make(double (*error)(double z), double unit, struct br_order_point *point)
{
    for (size_t i = 0; i < ROWS; i++) {
        const double z = ldexp(1, -(int)i);
        point[i] = (struct br_order_point){z, 0, unit * error(z)};
    }
}

TEST(test_each_law)
{
    assert_int_equal(sizeof lines / sizeof *lines, BR_LAWS);
    for (enum br_law law = 0; law < BR_LAWS; law++) {
        struct br_order_point point[ROWS];
        struct br_line_order found;
        make(lines[law].error, 1, point);
        find(point, ROWS, &found);
        if (!(found.law[law] > 0.5))
            fail_msg("%s: its probability is %g", br_law_text(law), found.law[law]);
        if (!(fabs(found.order.value - lines[law].order) <= lines[law].off))
            fail_msg("%s: order %g, expected %g", br_law_text(law), found.order.value,
                     lines[law].order);
        if (!(found.order.low <= lines[law].order && lines[law].order <= found.order.high))
            fail_msg("%s: %g to %g does not hold %g", br_law_text(law), found.order.low,
                     found.order.high, lines[law].order);
        if (found.first != 0 || found.last + 2 < ROWS || found.outlier != ROWS)
            fail_msg("%s: rows %zu to %zu without %zu", br_law_text(law), found.first, found.last,
                     found.outlier);
        CLOSE(found.floor, lines[law].floor, 0.03 * lines[law].floor);
    }
}

/* The interval of 99 % holds that of 95 %, that holds the value; the laws' probabilities add up. */
TEST(test_what_is_stated)
{
    for (enum br_law law = 0; law < BR_LAWS; law++) {
        struct br_order_point point[ROWS];
        struct br_line_order f;
        double sum = 0;
        make(lines[law].error, 1, point);
        for (size_t i = 0; i < ROWS; i++)
            point[i].error *= i % 2 ? 1.01 : 0.99;
        find(point, ROWS, &f);
        for (enum br_law l = 0; l < BR_LAWS; l++)
            sum += f.law[l];
        CLOSE(sum, 1, 1e-12);
        if (!(f.low99 < f.order.low && f.order.low < f.order.value &&
              f.order.value < f.order.high && f.order.high < f.high99))
            fail_msg("%s: %g %g %g %g %g", br_law_text(law), f.low99, f.order.low, f.order.value,
                     f.order.high, f.high99);
    }
}

/* An error's unit is no part of the order. */
TEST(test_any_unit)
{
    for (enum br_law law = 0; law < BR_LAWS; law++) {
        struct br_order_point point[ROWS];
        struct br_line_order here, there;
        make(lines[law].error, 1, point);
        find(point, ROWS, &here);
        make(lines[law].error, 1e-9, point);
        find(point, ROWS, &there);
        CLOSE(there.order.low, here.order.low, 1e-5);
        CLOSE(there.order.high, here.order.high, 1e-5);
        CLOSE(there.floor, 1e-9 * here.floor, 1e-12 * here.floor);
        assert_int_equal(there.first, here.first);
        assert_int_equal(there.last, here.last);
    }
}

/* Rows that do not count are named by their place among all points. */
TEST(test_left_out)
{
    struct br_order_point point[MOST];
    struct br_line_order found;
    make(power, 1, point);
    point[0].error = 7; /* coarse: not asymptotic */
    find(point, ROWS, &found);
    assert_int_equal(found.first, 1);
    assert_int_equal(found.last, ROWS - 1);
    make(power, 1, point);
    point[3].error *= 5; /* an outlier inside */
    point[5].error = NAN; /* missing */
    find(point, ROWS, &found);
    assert_int_equal(found.outlier, 3);
    CLOSE(found.order.value, 2, 1e-3);
    make(power, 1, point);
    point[6].error = 0; /* below what can be told */
    point[7].error = 1;
    find(point, ROWS, &found);
    assert_int_equal(found.last, 5);
    CLOSE(found.order.value, 2, 1e-3);
}

/* Two coarse rows may be left out, but not half of the line. */
TEST(test_mostly_coarse)
{
    struct br_order_point point[ROWS];
    struct br_line_order found;
    for (size_t i = 0; i < ROWS; i++) {
        const double z = ldexp(1, -(int)i);
        point[i] = (struct br_order_point){z, 0, i < 5 ? z : 32 * z * z};
    }
    find(point, ROWS, &found);
    if (!(found.order.low < 1.99)) /* three rows of order 2 behind five of order 1 */
        fail_msg("the order is %g, %g to %g", found.order.value, found.order.low, found.order.high);
}

TEST(test_too_few)
{
    struct br_order_point point[ROWS];
    struct br_line_order found;
    make(power, 1, point);
    for (size_t count = 0; count < 3; count++) {
        find(point, count, &found);
        assert_true(isnan(found.order.value) && isnan(found.order.low) && isnan(found.high99));
    }
    point[1].error = NAN;
    find(point, 3, &found);
    assert_true(isnan(found.order.value));
}

TEST(test_root_of_a_logarithm)
{
    struct br_order_point point[ROWS];
    struct br_line_order found;
    for (size_t i = 0; i < ROWS; i++) {
        const double z = ldexp(1, -(int)i);
        point[i] = (struct br_order_point){z, 0, z * sqrt(2 - log(z))};
    }
    find(point, ROWS, &found);
    CLOSE(found.order.value, 1, 0.002);
}

/* The value is the median: in the middle of the interval where the scatter has no side. */
TEST(test_median)
{
    struct br_order_point point[ROWS];
    struct br_line_order found;
    make(power, 1, point);
    for (size_t i = 0; i < ROWS; i++)
        point[i].error *= i == 0 || i == 3 || i == 5 || i == 6 ? 1.05 : 0.95;
    find(point, ROWS, &found);
    CLOSE((found.order.value - found.order.low) / (found.order.high - found.order.low), 0.5, 0.04);
}
