/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Orders of errors and values over two sizes. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "made_tables.h"

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

/* The same with less scatter. */
static double bent_and_scattered(double h, double k)
{
    const double off = h > 0.7 || (h < 0.3 && h > 0.1) ? 0.05 : h > 0.3 ? -0.01 : -0.05;
    return k < 0.1 ? pow(h, 2.035) * exp(off) : bent(h, k < 0.2 ? 0.06 : k);
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
    /* An interval holds the order of the next line, 2, which does not hold its own. */
    for (int wide = 0; wide < 2; wide++) {
        find(grid_of(5, 5, wide ? bent_and_wide : bent_and_scattered), NULL);
        assert_false(br_joint_describes(&found.orders.of[0].joint));
        assert_true(isnan(found.orders.of[0].answer[BR_AXIS_SPACE].order.value));
        assert_non_null(found.orders.of[0].answer[BR_AXIS_SPACE].open);
    }
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

/* Three rows, of which no line has three: two constants and two orders are more unknowns. */
TEST(test_fewer_rows_than_unknowns)
{
    find("n,dt,l2\n50,.002,7e-4\n60,.002,5e-4\n100,.001,2e-4\n", NULL);
    for (int axis = 0; axis < BR_AXES; axis++)
        if (!isnan(found.orders.of[0].answer[axis].order.value))
            fail_msg("3 rows gave an order along axis %d", axis);
}
