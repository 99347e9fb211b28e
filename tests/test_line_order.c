/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The order of a line: what no unit changes, where its numbers stand to each other, and the line
 * that is drawn of it. */
#include "study/fit/line_order.h"

#include <math.h>

#include "support.h"

enum { ROWS = 7, SETS = 150 };

static struct br_error err;

/* Errors h^p with a floor of this size, and scatter. */
static void draw(struct br_test_random *random, double p, double floor, double scatter,
                 struct br_order_point point[ROWS])
{
    for (size_t i = 0; i < ROWS; i++) {
        const double z = pow(0.5, (double)i);
        const double noise = exp(scatter * br_test_uniform(random, -1, 1));
        point[i] = (struct br_order_point){z, 0, (pow(z, p) + floor) * noise};
    }
}

/* The median has the truth above it as often as below it. */
TEST(test_median)
{
    struct br_test_random random = {5};
    size_t above = 0;
    for (size_t set = 0; set < SETS; set++) {
        struct br_order_point point[ROWS];
        struct br_line_order found;
        draw(&random, 2, 0, 0.1, point);
        MUST(br_line_order_find(point, ROWS, &found, &err));
        above += found.order.value > 2;
        assert_true(found.low99 <= found.order.low && found.order.low <= found.order.value);
        assert_true(found.order.value <= found.order.high && found.order.high <= found.high99);
        assert_true(found.order.low < found.order.high);
    }
    if (above < SETS * 42 / 100 || above > SETS * 58 / 100)
        fail_msg("%zu of %d orders are above the truth", above, SETS);
}

/* Other units of error and of length: the same order, rows, and law; the floor has the unit. */
TEST(test_units)
{
    struct br_test_random random = {6};
    for (size_t set = 0; set < 40; set++) {
        struct br_order_point point[ROWS], other[ROWS];
        struct br_line_order a, b;
        draw(&random, 1 + (double)(set % 3), set % 2 ? 1e-3 : 0, set % 5 ? 0.02 : 0, point);
        if (set % 4 == 3)
            point[3].error *= 3; /* an outlier */
        for (size_t i = 0; i < ROWS; i++)
            other[i] = (struct br_order_point){1e3 * point[i].z, 0, 1e-9 * point[i].error};
        MUST(br_line_order_find(point, ROWS, &a, &err));
        MUST(br_line_order_find(other, ROWS, &b, &err));
        const double little = 3e-3 * (a.high99 - a.low99) + 1e-7; /* quantiles are searched */
        CLOSE(b.order.value, a.order.value, little);
        CLOSE(b.order.low, a.order.low, little);
        CLOSE(b.order.high, a.order.high, little);
        CLOSE(b.low99, a.low99, 3 * little);
        CLOSE(b.high99, a.high99, 3 * little);
        assert_true(a.first == b.first && a.last == b.last && a.outlier == b.outlier);
        CLOSE(b.floor, 1e-9 * a.floor, 1e-9 * a.floor * 1e-6);
        for (int law = 0; law < BR_LAWS; law++)
            CLOSE(b.law[law], a.law[law], 1e-3);
    }
}

/* The line goes through exact errors, also of differences; its band is wider away from them, and
 * what is left aside has no part in it. */
TEST(test_fit)
{
    struct br_order_point point[ROWS];
    const struct br_estimate order = {2, 1.5, 3};
    for (size_t i = 0; i < ROWS; i++) {
        point[i] = (struct br_order_point){pow(0.5, (double)i), pow(0.5, (double)i + 1), 0};
        point[i].error = 7 * (point[i].z * point[i].z - point[i].z_against * point[i].z_against);
    }
    point[0].error = NAN;
    point[ROWS - 1].error = 0;
    for (size_t i = 0; i < ROWS; i++) {
        const double exact = 7 * 0.75 * point[i].z * point[i].z;
        const struct br_estimate fit = br_line_fit(point, ROWS, i, &order);
        CLOSE(fit.value, exact, 1e-12 * exact);
        /* h^1.5 and h^3 through the middle, i = 3 */
        const double away = pow(2, fabs((double)i - 3));
        CLOSE(fit.low, exact * pow(away, i > 3 ? -1.0 : -0.5), 1e-12 * exact);
        CLOSE(fit.high, exact * pow(away, i < 3 ? 1.0 : 0.5), 1e-12 * exact);
    }
    const struct br_estimate none = {NAN, NAN, NAN};
    assert_true(isnan(br_line_fit(point, ROWS, 2, &none).value));
    for (size_t i = 0; i < ROWS; i++)
        point[i].error = NAN;
    assert_true(isnan(br_line_fit(point, ROWS, 2, &order).value));
}
