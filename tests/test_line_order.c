/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One line of errors for each law, with numbers that no other law makes: the law is found, with its
 * order, and no row but the finest is left out: a floor may hide that one. */
#include "orders/line/line_order.h"

#include <math.h>

#include "checks.h"

enum { ROWS = 8, MOST = 12, SOME = 7 };

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

static double kink(double z)
{
    return z > 0.1 ? z : 0.125 * pow(8 * z, 2);
}

static double exponential(double z)
{
    return exp(-0.3 / z);
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
    [BR_LAW_KINK] = {kink, 2, 1e-3, 0},
    [BR_LAW_EXPONENTIAL] = {exponential, NAN, 0, 0},
};

static void find(const struct br_point *point, size_t count, struct br_line_order *found)
{
    MUST(br_line_order_find(point, count, found, &err));
}

static void make(double (*error)(double z), double unit, struct br_point *point)
{
    for (size_t i = 0; i < ROWS; i++) {
        const double z = ldexp(1, -(int)i);
        point[i] = (struct br_point){.z = z, .error = unit * error(z)};
    }
}

TEST(test_each_law)
{
    assert_int_equal(sizeof lines / sizeof *lines, BR_LAWS);
    for (enum br_law law = 0; law < BR_LAWS; law++) {
        struct br_point point[ROWS];
        struct br_line_order found;
        make(lines[law].error, 1, point);
        find(point, ROWS, &found);
        if (!(found.law[law] > 0.5))
            fail_msg("%s: its probability is %g", br_law_text(law), found.law[law]);
        if (law == BR_LAW_EXPONENTIAL) {
            assert_true(isnan(found.order.value) && found.power == 1);
            assert_true(found.low99 <= found.rate.low && found.rate.high <= found.high99);
            CLOSE(found.rate.value, 0.3, 1e-3);
            assert_true(found.rate.low <= 0.3 && 0.3 <= found.rate.high);
            continue;
        }
        assert_true(isnan(found.rate.value) && isnan(found.power));
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

static double inverse_logarithm(double z)
{
    return 1 / (2.3 - log(z));
}

static double inverse_square(double z)
{
    return pow(inverse_logarithm(z), 2);
}

static double floor_that_falls(double z)
{
    return 0.02 * pow(z, 0.2) + 0.1 * z;
}

static double roots(double z)
{
    return 0.05 * pow(z, 0.2) + 0.05 * z;
}

/* Laws with a correction have no order near zero, and their intervals do not exclude it, from as
 * many rows on as show that the order falls. */
/* Errors fall to round-off: the rows before it show the rate. */
TEST(test_exponential_to_a_floor)
{
    static const double error[] = {1.93e-2, 2.064e-4, 2.016e-8, 1.063e-15, 7.267e-16, 8.576e-16};
    enum { COUNT = sizeof error / sizeof *error };
    struct br_point point[COUNT];
    struct br_line_order found;
    for (size_t i = 0; i < COUNT; i++)
        point[i] = (struct br_point){.z = ldexp(0.25, -(int)i), .error = error[i]};
    find(point, COUNT, &found);
    assert_true(found.law[BR_LAW_EXPONENTIAL] > 0.5 && found.power == 1 && found.last == 2);
    assert_true(found.rate.low > 1 && found.rate.low < 1.15 && found.rate.high > 1.15 &&
                found.rate.high < 1.3);
}

TEST(test_small_orders)
{
    static const struct {
        double (*error)(double z);
        size_t least;
    } small[] = {{inverse_logarithm, 4}, {inverse_square, 4}, {floor_that_falls, 6}, {roots, 4}};
    for (size_t i = 0; i < sizeof small / sizeof *small; i++)
        for (size_t rows = small[i].least; rows <= ROWS; rows++) {
            struct br_point point[ROWS];
            struct br_line_order f;
            make(small[i].error, 1, point);
            find(point, rows, &f);
            if (!(f.order.low <= 0 && f.low99 < f.order.low))
                fail_msg("line %zu, %zu rows: %g [%g, %g]", i, rows, f.order.value, f.order.low,
                         f.order.high);
        }
}

/* The interval of 99 % holds that of 95 %, that holds the value; the laws' probabilities add up. */
TEST(test_what_is_stated)
{
    for (enum br_law law = 0; law < BR_LAW_EXPONENTIAL; law++) {
        struct br_point point[ROWS];
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

/* Rows that do not count are named by their place among all points. */
TEST(test_left_out)
{
    struct br_point point[MOST];
    struct br_line_order found;
    make(power, 1, point);
    point[0].error = 7; /* coarse: not asymptotic */
    find(point, ROWS, &found);
    assert_int_equal(found.first, 1);
    assert_int_equal(br_line_order_flag(&found, point, 0), BR_FLAG_COARSE);
    assert_int_equal(found.last, ROWS - 1);
    make(power, 1, point);
    point[3].error *= 5;  /* an outlier inside */
    point[5].error = NAN; /* missing */
    find(point, ROWS, &found);
    assert_int_equal(found.outlier, 3);
    assert_int_equal(br_line_order_flag(&found, point, 3), BR_FLAG_OUTLIER);
    assert_int_equal(br_line_order_flag(&found, point, 4), BR_FLAG_NONE);
    CLOSE(found.order.value, 2, 1e-3);
    for (size_t odd = 1; odd + 1 < ROWS; odd++) { /* each row inside, and no other */
        make(power, 1, point);
        point[odd].error *= 5;
        find(point, ROWS, &found);
        assert_int_equal(found.outlier, odd);
        assert_int_equal(found.first, 0);
        assert_int_equal(found.last, ROWS - 1);
        CLOSE(found.order.value, 2, 1e-3);
    }
    make(power, 1, point);
    point[6].error = 0; /* below what can be told */
    point[7].error = 1;
    find(point, ROWS, &found);
    assert_int_equal(found.last, 5);
    assert_int_equal(br_line_order_flag(&found, point, 7), BR_FLAG_STALLED);
    CLOSE(found.order.value, 2, 1e-3);
}

/* Two coarse rows may be left out, but not half of the line. */
TEST(test_mostly_coarse)
{
    struct br_point point[ROWS];
    struct br_line_order found;
    for (size_t i = 0; i < ROWS; i++) {
        const double z = ldexp(1, -(int)i);
        point[i] = (struct br_point){.z = z, .error = i < 5 ? z : 32 * z * z};
    }
    find(point, ROWS, &found);
    if (!(found.order.low < 1.99)) /* three rows of order 2 behind five of order 1 */
        fail_msg("the order is %g, %g to %g", found.order.value, found.order.low, found.order.high);
}

TEST(test_too_few)
{
    struct br_point point[ROWS];
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

/* A power leads through three rows to 0.1 %; what a half power adds is half of each error. */
TEST(test_three_rows)
{
    struct br_point point[3];
    struct br_line_order found;
    for (size_t i = 0; i < 3; i++) {
        const double z = pow(1.3, -(double)i);
        point[i] = (struct br_point){.z = z, .error = z * z * (1 + sqrt(z))};
    }
    find(point, 3, &found);
    assert_true(found.order.low <= 2 && 2 <= found.order.high);
    AT_MOST(found.order.high - found.order.low, 1);
}

TEST(test_root_of_a_logarithm)
{
    struct br_point point[ROWS];
    struct br_line_order found;
    for (size_t i = 0; i < ROWS; i++) {
        const double z = ldexp(1, -(int)i);
        point[i] = (struct br_point){.z = z, .error = z * sqrt(2 - log(z))};
    }
    find(point, ROWS, &found);
    if (!(found.order.low <= 1 && 1 <= found.order.high && found.order.high < 1.1 &&
          found.order.low > 0.9)) /* half powers beside it are not ruled out */
        fail_msg("%g to %g", found.order.low, found.order.high);
}

/* The value is the median: in the middle of the interval where the scatter has no side. */
TEST(test_median)
{
    struct br_point point[ROWS];
    struct br_line_order found;
    make(power, 1, point);
    for (size_t i = 0; i < ROWS; i++)
        point[i].error *= i == 0 || i == 3 || i == 5 || i == 6 ? 1.05 : 0.95;
    find(point, ROWS, &found);
    CLOSE((found.order.value - found.order.low) / (found.order.high - found.order.low), 0.5, 0.04);
}

/* Errors h^p with a floor of this size, and scatter. */
static void draw(struct br_test_random *random, double p, double floor, double scatter,
                 struct br_point point[SOME])
{
    for (size_t i = 0; i < SOME; i++) {
        const double z = pow(0.5, (double)i);
        const double noise = exp(scatter * br_test_uniform(random, -1, 1));
        point[i] = (struct br_point){.z = z, .error = (pow(z, p) + floor) * noise};
    }
}

/* Errors whose scatter is known weigh by it: coarse ones are scattered ten times as much here.
 * Equal scatter, or one that is not known, changes nothing. */
TEST(test_means)
{
    struct br_test_random random = {9};
    double width = 0, plain = 0;
    size_t covered = 0;
    enum { SETS = 100 };
    for (size_t set = 0; set < SETS; set++) {
        struct br_point point[SOME];
        struct br_line_order a, b, c;
        for (size_t i = 0; i < SOME; i++) {
            const double z = pow(0.5, (double)i);
            const double scatter = i < SOME / 2 ? 0.05 : 0.005;
            const double noise = br_test_uniform(&random, -1, 1) + br_test_uniform(&random, -1, 1) +
                                 br_test_uniform(&random, -1, 1);
            point[i] = (struct br_point){.z = z, .error = z * exp(scatter * noise)};
        }
        MUST(br_line_order_find(point, SOME, &b, &err));
        for (size_t i = 0; i < SOME; i++)
            point[i].deviation = (i < SOME / 2 ? 0.05 : 0.005) * point[i].error;
        MUST(br_line_order_find(point, SOME, &a, &err));
        covered += a.order.low <= 1 && a.order.high >= 1;
        width += a.order.high - a.order.low;
        plain += b.order.high - b.order.low;
        for (size_t i = 0; i < SOME; i++)
            point[i].deviation = 0.0625 * point[i].error;
        MUST(br_line_order_find(point, SOME, &c, &err));
        CLOSE(c.order.value, b.order.value, 0);
        point[3].deviation = set % 2 ? 0 : NAN;
        MUST(br_line_order_find(point, SOME, &c, &err));
        CLOSE(c.order.high, b.order.high, 0);
    }
    if (!(covered >= 90 && width < 0.85 * plain))
        fail_msg("%zu of %d covered, width %g of %g", covered, SETS, width, plain);
}

/* Other units of error and of length: the same order, rows, and law; the floor has the unit. */
TEST(test_units)
{
    struct br_test_random random = {6};
    for (size_t set = 0; set < 40; set++) {
        struct br_point point[SOME], other[SOME];
        struct br_line_order a, b;
        draw(&random, 1 + (double)(set % 3), set % 2 ? 1e-3 : 0, set % 5 ? 0.02 : 0, point);
        if (set % 4 == 3)
            point[3].error *= 3; /* an outlier */
        for (size_t i = 0; i < SOME; i++)
            other[i] = (struct br_point){.z = 1e3 * point[i].z, .error = 1e-9 * point[i].error};
        MUST(br_line_order_find(point, SOME, &a, &err));
        MUST(br_line_order_find(other, SOME, &b, &err));
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
    struct br_point point[SOME];
    const struct br_estimate order = {2, 1.5, 3};
    for (size_t i = 0; i < SOME; i++) {
        point[i] =
            (struct br_point){.z = pow(0.5, (double)i), .z_against = pow(0.5, (double)i + 1)};
        point[i].error = 7 * (point[i].z * point[i].z - point[i].z_against * point[i].z_against);
    }
    point[0].error = NAN;
    point[SOME - 1].error = 0;
    for (size_t i = 0; i < SOME; i++) {
        const double exact = 7 * 0.75 * point[i].z * point[i].z;
        const struct br_estimate fit = br_line_fit(point, SOME, i, &order);
        CLOSE(fit.value, exact, 1e-12 * exact);
        /* h^1.5 and h^3 through the middle, i = 3 */
        const double away = pow(2, fabs((double)i - 3));
        CLOSE(fit.low, exact * pow(away, i > 3 ? -1.0 : -0.5), 1e-12 * exact);
        CLOSE(fit.high, exact * pow(away, i < 3 ? 1.0 : 0.5), 1e-12 * exact);
    }
    const struct br_estimate none = {NAN, NAN, NAN};
    assert_true(isnan(br_line_fit(point, SOME, 2, &none).value));
    for (size_t i = 0; i < SOME; i++)
        point[i].error = NAN;
    assert_true(isnan(br_line_fit(point, SOME, 2, &order).value));
}

/* An order's interval may reach below zero: an error, or a difference, then grows there with
 * refinement, and the band has two ends, which hold the line. */
TEST(test_band_of_a_wide_interval)
{
    static const struct br_estimate order = {3.7, -11, 18.7};
    for (int differences = 0; differences < 2; differences++) {
        struct br_point point[SOME];
        for (size_t i = 0; i < SOME; i++) {
            const double z = pow(0.5, (double)i);
            point[i] = (struct br_point){
                .z = z, .z_against = differences ? z / 2 : 0, .error = pow(z, 3.7)};
        }
        for (size_t i = 0; i < SOME; i++) {
            const struct br_estimate fit = br_line_fit(point, SOME, i, &order);
            const double away = (double)i - 3, e = point[i].error;
            CLOSE(log2(fit.value / e), 0, 1e-12);
            CLOSE(log2(fit.low / e), -(away > 0 ? 15.0 : 14.7) * fabs(away), 1e-11);
            CLOSE(log2(fit.high / e), (away > 0 ? 14.7 : 15.0) * fabs(away), 1e-11);
            assert_true(fit.low <= fit.value && fit.value <= fit.high);
        }
        for (size_t i = 0; i < SOME; i++) /* one that counts: the line and its band go through it */
            point[i].error = i == 2 ? 0.3 : NAN;
        const struct br_estimate fit = br_line_fit(point, SOME, 2, &order);
        CLOSE(fit.value, 0.3, 1e-12);
        assert_true(fit.low <= fit.value && fit.value <= fit.high);
        assert_true(br_line_fit(point, SOME, 3, &order).low <
                    br_line_fit(point, SOME, 3, &order).value);
        assert_true(isnan(br_line_fit(point, SOME, 3, &(struct br_estimate){2, NAN, NAN}).low));
    }
}

/* Two next terms whose effects turn the orders from row to row: the interval holds the true order.
 */
TEST(test_two_terms)
{
    struct br_point point[ROWS];
    struct br_line_order found;
    for (size_t i = 0; i < 6; i++) {
        const double z = ldexp(1, -(int)i);
        point[i] = (struct br_point){.z = z, .error = 3 * z * z * (1 + 0.2 * z - 0.15 * z * z)};
    }
    find(point, 6, &found);
    if (!(found.order.low <= 2 && 2 <= found.order.high))
        fail_msg("%g to %g", found.order.low, found.order.high);
}

/* The largest of two errors, which meet between two rows: the interval holds both orders, with two
 * rows of the finer one and with three. */
TEST(test_break_between_rows)
{
    for (size_t l = 0; l < 4; l++) {
        const size_t fine = 2 + l % 2, rows = l < 2 ? 5 : 7;
        struct br_point point[ROWS];
        struct br_line_order found;
        for (size_t i = 0; i < rows; i++) {
            const double z = ldexp(1, -(int)i), meet = 1.4 * ldexp(1, (int)fine - (int)rows);
            point[i] = (struct br_point){.z = z, .error = fmax(z * z, sqrt(meet) * pow(z, 1.5))};
        }
        find(point, rows, &found);
        if (!(found.order.low <= 1.501 && 1.999 <= found.order.high))
            fail_msg("%zu of %zu rows are fine: %g to %g", fine, rows, found.order.low,
                     found.order.high);
    }
}

/* Errors whose orders from row to row are given. */
static size_t of_rates(const double *rate, struct br_point *point)
{
    size_t count = 1;
    point[0] = (struct br_point){.z = 1, .error = 1};
    for (; rate[count - 1] != 0; count++)
        point[count] = (struct br_point){.z = point[count - 1].z / 2,
                                         .error = point[count - 1].error * exp2(-rate[count - 1])};
    return count;
}

/* One order on coarse rows and another one on the finest: the interval holds both. */
TEST(test_kinks)
{
    static const double rates[][MOST] = {
        {4, 4, 4, 4, 4, 2, 2, 2}, {2.5, 2.5, 2.5, 3, 3},       {2, 2, 2, 1, 1},
        {1, 1, 1, 1, 3, 3},       {2, 2, 2, 2, 1.5, 1.5, 1.5}, {1.5, 1.5, 1.5, 2, 2, 2}};
    for (size_t l = 0; l < sizeof rates / sizeof *rates; l++) {
        struct br_point point[MOST];
        struct br_line_order f;
        const size_t rows = of_rates(rates[l], point);
        find(point, rows, &f);
        const double first = rates[l][0], last = rates[l][rows - 2];
        if (!(f.order.low <= fmin(first, last) && fmax(first, last) <= f.order.high))
            fail_msg("line %zu: %g to %g", l, f.order.low, f.order.high);
        assert_int_equal(br_line_order_flag(&f, point, rows - 1), BR_FLAG_NONE);
    }
}

/* Errors that fall and then grow, by clean powers: their order is that of the growth. */
TEST(test_growth_at_the_fine_end)
{
    static const double rates[][MOST] = {{2, 2, 2, -1, -1, -1}, {1, 1, 1, -0.5, -0.5, -0.5, -0.5}};
    for (size_t l = 0; l < sizeof rates / sizeof *rates; l++) {
        struct br_point point[MOST];
        struct br_line_order f;
        find(point, of_rates(rates[l], point), &f);
        assert_true(f.high99 < 0);
    }
}

/* No interval has the width zero, whatever the digits: so few rows cannot show that. */
TEST(test_least_width)
{
    for (size_t rows = 3; rows <= ROWS; rows++) {
        struct br_point point[ROWS];
        struct br_line_order f;
        make(power, 1, point);
        find(point, rows, &f);
        AT_MOST(3e-4, f.order.high - f.order.low);
    }
}

/* Of noise alone, the interval is about that of a regression: t sqrt(S / f / Sxx). */
TEST(test_interval_of_noise)
{
    static const struct {
        size_t rows;
        double t, t99; /* of rows - 2 degrees of freedom, 97.5 % and 99.5 % */
    } lines_of[] = {{4, 4.302653, 9.924843},
                    {5, 3.182446, 5.840909},
                    {6, 2.776445, 4.604095},
                    {7, 2.570582, 4.032143}};
    static const double noise[] = {0.02, -0.03, 0.03, -0.02, 0.01, -0.025, 0.03};
    for (size_t l = 0; l < sizeof lines_of / sizeof *lines_of; l++) {
        struct br_point point[ROWS];
        struct br_line_order found;
        const double n = (double)lines_of[l].rows;
        double x = 0, y = 0, xx = 0, xy = 0, yy = 0;
        for (size_t i = 0; i < lines_of[l].rows; i++) {
            const double log_z = -(double)i * log(2), log_e = 2 * log_z + noise[i];
            point[i] = (struct br_point){.z = exp(log_z), .error = exp(log_e)};
            x += log_z, y += log_e, xx += log_z * log_z, xy += log_z * log_e, yy += log_e * log_e;
        }
        xx -= x * x / n, xy -= x * y / n, yy -= y * y / n;
        const double half = lines_of[l].t * sqrt((yy - xy * xy / xx) / (n - 2) / xx);
        find(point, lines_of[l].rows, &found);
        const double ratio = (found.order.high - found.order.low) / 2 / half;
        if (!(ratio >= 0.8 && ratio <= 2))
            fail_msg("%zu rows: %g times as wide", lines_of[l].rows, ratio);
        const double wider = (found.high99 - found.low99) / (found.order.high - found.order.low);
        const double share = wider * lines_of[l].t / lines_of[l].t99;
        if (!(share >= 0.84 && share <= 1.55)) /* of a 98 % interval 0.68 to 0.83 */
            fail_msg("%zu rows: the 99 %% interval is %g times as wide", lines_of[l].rows, wider);
    }
}

/* Rounding makes no interval empty, on neither side. */
TEST(test_texts_of_intervals)
{
    static const struct {
        struct br_estimate e;
        const char *order, *interval;
    } rows[] = {
        {{2, 1.97, 2.03}, "2.00 [1.97, 2.03]", "2.000 [1.970, 2.030]"},
        {{3.1623, 3.1612, 3.1634}, "3.162 [3.161, 3.163]", "3.1623 [3.1612, 3.1634]"},
        {{10, 9.984, 10.016}, "10.00 [9.98, 10.02]", "10.000 [9.984, 10.016]"},
        {{4.0002, 3.996, 4.0066}, "4.000 [3.996, 4.007]", "4.0002 [3.9960, 4.0066]"},
        {{2, 1.99999, 2.5}, "2.0000 [1.9999, 2.5000]", "2.00000 [1.99999, 2.50000]"},
        {{1, 0.9, 1}, "1.00 [0.90, 1.00]", "1.000 [0.900, 1.000]"},
        {{2, 2, 2}, "2.0000 [1.9999, 2.0001]", "2"},
    };
    char text[128];
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        assert_string_equal(br_order_text(&rows[i].e, text, sizeof text), rows[i].order);
        assert_string_equal(br_interval_text(&rows[i].e, text, sizeof text), rows[i].interval);
    }
    struct br_test_random random = {3};
    for (int i = 0; i < 2000; i++) {
        const double value = br_test_log_uniform(&random, 0.1, 9);
        const struct br_estimate e = {value, value - br_test_log_uniform(&random, 1e-7, 1),
                                      value + br_test_log_uniform(&random, 1e-7, 1)};
        for (int kind = 0; kind < 2; kind++) {
            double shown, low, high;
            (kind ? br_interval_text : br_order_text)(&e, text, sizeof text);
            assert_int_equal(sscanf(text, "%lf [%lf, %lf]", &shown, &low, &high), 3);
            if (!(low < shown && shown < high))
                fail_msg("%.9g [%.9g, %.9g] is shown as %s", value, e.low, e.high, text);
        }
    }
}

/* By hand: a row that scatters ten times as much has a hundredth of the weight. */
TEST(test_weights)
{
    enum { HAND = 5 };
    for (size_t odd = 0; odd < HAND; odd++) {
        struct br_point point[HAND];
        struct br_line_order found;
        double slope[3]; /* by weights of 1, 1/sigma and 1/sigma^2 */
        for (int power_of = 0; power_of < 3; power_of++) {
            double w = 0, x = 0, y = 0, xx = 0, xy = 0;
            for (size_t i = 0; i < HAND; i++) {
                const double log_z = -(double)i * log(2);
                const double log_e = 2 * log_z + (i == odd ? 0.03 : i % 2 ? 0.003 : -0.003);
                const double sigma = i == odd ? 0.02 : 0.002, weight = pow(sigma, -power_of);
                point[i] = (struct br_point){
                    .z = exp(log_z), .error = exp(log_e), .deviation = sigma * exp(log_e)};
                w += weight, x += weight * log_z, y += weight * log_e;
                xx += weight * log_z * log_z, xy += weight * log_z * log_e;
            }
            slope[power_of] = (w * xy - x * y) / (w * xx - x * x);
        }
        find(point, HAND, &found);
        if (odd != HAND / 2) /* there no weight turns the line */
            AT_MOST(fabs(found.order.value - slope[2]), 0.25 * fabs(slope[1] - slope[2]));
    }
}
