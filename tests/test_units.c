/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Units of scenes: their sizes are those of GSL's tables, decimal multiples are exact, others are
 * right to the last bit, and what is no unit is none. */
#include <gsl/gsl_const_mksa.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "study/scene/units.h"
#include "support.h"

/* GSL rounds those that it has itself. */
#define POUND_FORCE (GSL_CONST_MKSA_POUND_MASS * GSL_CONST_MKSA_GRAV_ACCEL)
#define PSI (POUND_FORCE / GSL_CONST_MKSA_INCH / GSL_CONST_MKSA_INCH)

static struct br_unit must_read(const char *text)
{
    struct br_unit unit;
    if (!br_unit_read(text, &unit))
        fail_msg("'%s' is no unit", text);
    return unit;
}

static double convert(const char *number, const char *text)
{
    const struct br_unit unit = must_read(text);
    struct br_si_number q;
    assert_true(br_unit_convert(&unit, number, strlen(number), &q));
    assert_true(q.value == (double)q.wide || nextafter(q.value, (double)q.wide) == (double)q.wide);
    return q.value;
}

static const struct {
    const char *text;
    double size; /* of 1 of it, m, s, kg */
    struct br_dimension of;
} known[] = {
    {"m", 1, {1, 0, 0}},
    {"s", 1, {0, 1, 0}},
    {"kg", 1, {0, 0, 1}},
    {"g", GSL_CONST_MKSA_GRAM_FORCE / GSL_CONST_MKSA_GRAV_ACCEL, {0, 0, 1}},
    {"t", GSL_CONST_MKSA_METRIC_TON, {0, 0, 1}},
    {"lb", GSL_CONST_MKSA_POUND_MASS, {0, 0, 1}},
    {"in", GSL_CONST_MKSA_INCH, {1, 0, 0}},
    {"inch", GSL_CONST_MKSA_INCH, {1, 0, 0}},
    {"ft", GSL_CONST_MKSA_FOOT, {1, 0, 0}},
    {"min", GSL_CONST_MKSA_MINUTE, {0, 1, 0}},
    {"h", GSL_CONST_MKSA_HOUR, {0, 1, 0}},
    {"N", GSL_CONST_MKSA_NEWTON, {1, -2, 1}},
    {"lbf", POUND_FORCE, {1, -2, 1}},
    {"kip", 1000 * POUND_FORCE, {1, -2, 1}},
    {"J", GSL_CONST_MKSA_JOULE, {2, -2, 1}},
    {"bar", GSL_CONST_MKSA_BAR, {-1, -2, 1}},
    {"psi", PSI, {-1, -2, 1}},
    {"ksi", 1000 * PSI, {-1, -2, 1}},
    {"lbf/in^2", PSI, {-1, -2, 1}},
    {"Pa", 1, {-1, -2, 1}},
    {"%", 0.01, {0, 0, 0}},
    {"1", 1, {0, 0, 0}},
    {"", 1, {0, 0, 0}},
    {"nm", 1e-9, {1, 0, 0}},
    {"um", 1e-6, {1, 0, 0}},
    {"\u00b5m", 1e-6, {1, 0, 0}},
    {"\u03bcm", 1e-6, {1, 0, 0}},
    {"mm", 1e-3, {1, 0, 0}},
    {"cm", 1e-2, {1, 0, 0}},
    {"dm", 0.1, {1, 0, 0}},
    {"hPa", 100, {-1, -2, 1}},
    {"km", 1000, {1, 0, 0}},
    {"MN", 1e6, {1, -2, 1}},
    {"GPa", 1e9, {-1, -2, 1}},
    {"TPa", 1e12, {-1, -2, 1}},
    {"mm^4", 1e-12, {4, 0, 0}},
    {"mm4", 1e-12, {4, 0, 0}},
    {"s^-1", 1, {0, -1, 0}},
    {"1/s", 1, {0, -1, 0}},
    {"kN/m", 1000, {0, -2, 1}},
    {"N mm^2 s", 1e-6, {3, -1, 1}},
    {"N*mm", 1e-3, {2, -2, 1}},
    {"N * mm/s", 1e-3, {2, -3, 1}},
    {"g/cm^3", 1000, {-3, 0, 1}},
    {"kg/(m s^2)", 1, {-1, -2, 1}},
    {"lb/ft", GSL_CONST_MKSA_POUND_MASS / GSL_CONST_MKSA_FOOT, {-1, 0, 1}},
};

TEST(test_known)
{
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        const double size = known[i].size;
        CLOSE(convert("1", known[i].text), size, 2e-15 * size);
        if (!br_dimension_is(must_read(known[i].text).of, known[i].of))
            fail_msg("'%s' has another dimension", known[i].text);
    }
}

TEST(test_unknown)
{
    static const char *const none[] = {
        "mn",  "M",   "kkm",  "mmin",  "N/",  "/s",     "m/s/s",    "N/m s",
        "m^",  "m^0", "m^10", "m^+2",  "s-1", "(m)",    "m)",       "1 m",
        "2 m", "m 1", "m**2", "m*",    "m[s", "N/(m s", "N/(m))",   "^2",
        "m.s", "m'",  "deg",  "rad/s", "Hz",  "mm^^2",  "m since 0"};
    struct br_unit unit;
    for (size_t i = 0; i < sizeof none / sizeof *none; i++)
        if (br_unit_read(none[i], &unit))
            fail_msg("'%s' is a unit", none[i]);
}

/* 12.345 mm is the double of 0.012345, whatever the digits: the same digits behind another point.
 */
TEST(test_decimals)
{
    static const struct {
        const char *unit;
        int ten;
    } decimal[] = {{"m", 0},    {"mm", -3},    {"cm", -2},    {"GPa", 9},
                   {"kN/m", 3}, {"mm^4", -12}, {"g/cm^3", 3}, {"N mm", -3},
                   {"ms", -3},  {"um", -6},    {"%", -2},     {"kN mm^2", -3}};
    struct br_test_random random = {7};
    for (int i = 0; i < 20000; i++) {
        const size_t d = br_test_index(&random, sizeof decimal / sizeof *decimal);
        const unsigned long long digits = (unsigned long long)br_test_log_uniform(&random, 1, 1e17);
        const int point = (int)br_test_index(&random, 8), ten = (int)br_test_index(&random, 9) - 4;
        char text[64], moved[64];
        snprintf(moved, sizeof moved, "%llue%d", digits, ten - point + decimal[d].ten);
        snprintf(text, sizeof text, "%0*llu", point + 1, digits);
        const size_t whole = strlen(text) - (size_t)point;
        memmove(text + whole + 1, text + whole, (size_t)point + 1);
        text[whole] = '.';
        snprintf(text + strlen(text), 16, "%c%d", i % 2 ? 'e' : 'E', ten);
        if (!(convert(text, decimal[d].unit) == strtod(moved, NULL)))
            fail_msg("%s %s is not %s", text, decimal[d].unit, moved);
    }
}

/* Of inches and hours: whole numbers make quotients of exact ones, which round once. */
TEST(test_others)
{
    struct br_test_random random = {8};
    for (int i = 0; i < 20000; i++) {
        const double count = floor(br_test_log_uniform(&random, 1, 1e11));
        char text[32];
        snprintf(text, sizeof text, "%.0f", count);
        assert_true(convert(text, "in") == count * 254 / 10000);
        assert_true(convert(text, "h") == count * 3600);
        assert_true(convert(text, "1/h") == count / 3600);
    }
}

/* Exponents may be absurd. */
TEST(test_odd_numbers)
{
    assert_true(convert("-0", "km") == 0);
    assert_true(convert("1e-99999999999999999999", "km") == 0);
    assert_true(isinf(convert("1e99999999999999999999", "mm")));
    assert_true(convert(".5e+1", "mm") == 0.005);
    char digits[500];
    memset(digits, '1', sizeof digits);
    struct br_si_number q;
    const struct br_unit unit = must_read("m");
    assert_false(br_unit_convert(&unit, digits, sizeof digits, &q));
}

TEST(test_expressions)
{
    static const struct {
        const char *unit, *expression, *applied;
    } rows[] = {{"N/m", "x + 1", "x + 1"},
                {"kN/m", "x + 1", "(x + 1)*1000"},
                {"mm", "t > 1 ? x : 2", "(t > 1 ? x : 2)/1000"},
                {"in", "x", "(x)*0.0254"},
                {"MN/mm", "x", "(x)*1000000000"}};
    char text[64];
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const struct br_unit unit = must_read(rows[i].unit);
        assert_true(br_unit_apply(&unit, rows[i].expression, text, sizeof text));
        assert_string_equal(text, rows[i].applied);
        assert_false(br_unit_apply(&unit, rows[i].expression, text, strlen(rows[i].applied)));
    }
}
