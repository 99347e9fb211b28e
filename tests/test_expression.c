/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Expressions: what is read, what is refused and where, and what they evaluate to. */
#include <fenv.h>
#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "solver/march.h"
#include "solver/scene.h"
#include "study/known/expression.h"
#include "study/known/operations.h"
#include "support.h"

static double value_of(const char *text, double x, double t)
{
    OWNED(br_function) f = br_test_function(text);
    double value;
    br_function_evaluate(&f, 1, &x, t, &value);
    return value;
}

/* ---- what is read ---- */

TEST(test_grammar)
{
    const double x = 0.7, t = 1.3;
    const struct {
        const char *text;
        double value;
    } rows[] = {
        {"1", 1},
        {"1.5e-3", 1.5e-3},
        {".5", 0.5},
        {"5.", 5},
        {"2e2", 200},
        {"2E+2", 200},
        {"1e0", 1},
        {"pi", M_PI},
        {"e", M_E},
        {"x", x},
        {" \tx\n", x},
        {"x+t", x + t},
        {"x-t-1", x - t - 1},
        {"x-(t-1)", x - (t - 1)},
        {"8/4/2", 1},
        {"8/4*2", 4},
        {"2+3*4", 14},
        {"2*3+4", 10},
        {"2*3^2", 18},
        {"2^3^2", 512},
        {"(2^3)^2", 64},
        {"-2^2", -4},
        {"(-2)^2", 4},
        {"2^-1", 0.5},
        {"2^-2^2", 1.0 / 16},
        {"2*-3", -6},
        {"2--3", 5},
        {"2-+3", -1},
        {"- - 2", 2},
        {"!0", 1},
        {"!x", 0},
        {"!x+1", 1},
        {"!(x>t)", 1},
        {"-x<t", 1},
        {"1+1<3", 1},
        {"1<1+1", 1},
        {"x<t", 1},
        {"x<=x", 1},
        {"x>t", 0},
        {"x>=x", 1},
        {"x==x", 1},
        {"x!=x", 0},
        {"x<t&&t<x", 0},
        {"x<t||t<x", 1},
        {"1||0&&0", 1},
        {"(1||0)&&0", 0},
        {"1&&2", 1},
        {"1 ? 2 : 3", 2},
        {"0 ? 2 : 3", 3},
        {"x<t ? 2 : 3", 2},
        {"0 ? 2 : 0 ? 3 : 4", 4},
        {"1 ? 0 ? 2 : 3 : 4", 3},
        {"0||1 ? 2+1 : 5", 3},
        {"min(3,2)", 2},
        {"max(3,2)", 3},
        {"min(3,2,1,4)", 1},
        {"max(x, t, 1)", t},
        {"sign(-3)", -1},
        {"sign(0)", 0},
        {"sign(x)", 1},
        {"step(-1e-300)", 0},
        {"step(0)", 1},
        {"step(x-t)", 0},
        {"abs(x-t)", t - x},
        {"sqrt(16)", 4},
        {"ln(e)", 1},
        {"log(e)", 1},
        {"log10(1000)", 3},
        {"log2(8)", 3},
        {"sin (x)", sin(x)},
        {"x^2", x * x},
        {"x^3", x * x * x},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        if (value_of(rows[i].text, x, t) != rows[i].value)
            fail_msg("%s is %.17g, expected %.17g", rows[i].text, value_of(rows[i].text, x, t),
                     rows[i].value);
}

static const struct {
    const char *text;
    int column;
    const char *reason;
} refusals[] = {
    {"", 1, "found the end, expected a number, a name or '('"},
    {"  ", 3, "found the end"},
    {"100*tt", 5, "unknown name 'tt', expected one of: x, t, pi, e, ln, sin, cos"},
    {"y", 1, "unknown name 'y'"},
    {"X", 1, "unknown name 'X'"},
    {"rint(x)", 1, "unknown name 'rint'"},
    {"1e", 2, "found 'e', expected an operator behind a number"},
    {"2x", 2, "found 'x', expected an operator behind a number"},
    {"0x10", 2, "found 'x10', expected an operator"},
    {"1.2.3", 4, "found '.', expected an operator"},
    {"1,5", 2, "it is more than one, separated by commas"},
    {"x, t", 2, "it is more than one, separated by commas"},
    {".", 1, "expected a digit beside the decimal point"},
    {"1e999", 1, "expected a number below"},
    {"x = 1", 3, "it assigns; a comparison is =="},
    {"sin(x=1)", 6, "it assigns; a comparison is =="},
    {"(x", 3, "found the end, expected an operator or ')'"},
    {"x)", 2, "found ')', expected an operator or the end"},
    {"x x", 3, "found 'x', expected an operator or the end"},
    {"x +", 4, "found the end, expected a number, a name or '('"},
    {"* x", 1, "found '*'"},
    {"x ** 2", 4, "found '*'"},
    {"x && ", 6, "found the end"},
    {"x & t", 3, "found '&'"},
    {"x | t", 3, "found '|'"},
    {"x ? 1", 6, "found the end, expected an operator or ':'"},
    {"x < t < 1", 7, "found a second comparison, expected && between two"},
    {"x == t == 1", 8, "found a second comparison"},
    {"sin", 4, "expected '(' behind a function's name"},
    {"sin x", 5, "found 'x', expected '(' behind a function's name"},
    {"sin()", 5, "found ')', expected a number"},
    {"sin(x,t)", 6, "found ',', expected ')'"},
    {"min(x)", 6, "found ')', expected ',' and one more argument"},
    {"min(x,t", 8, "found the end, expected ',' or ')'"},
    {"x $ t", 3, "found '$', expected an operator"},
    {"x + \x01", 5, "found the byte 0x01"},
    {"x + \xc3\xa9", 5, "found the byte 0xc3"},
    {"\"x\"", 1, "found '\"'"},
};

TEST(test_refusals)
{
    for (size_t i = 0; i < sizeof refusals / sizeof *refusals; i++) {
        struct br_function f;
        char column[32];
        snprintf(column, sizeof column, "at column %d: ", refusals[i].column);
        assert_int_equal(br_expression(refusals[i].text, &f, &err), BR_BAD_INPUT);
        if (!strstr(err.message, column) || !strstr(err.message, refusals[i].reason))
            fail_msg("'%s' gives '%s', expected '%s%s'", refusals[i].text, err.message, column,
                     refusals[i].reason);
        assert_null(f.ops);
    }
}

static void repeat(char *out, const char *what, int times)
{
    while (times-- > 0)
        out = stpcpy(out, what);
}

TEST(test_limits)
{
    static const char *const nest[] = {"(", "-", "x^", "sin(", "x?1:"};
    static char text[100000];
    struct br_function f;
    for (size_t i = 0; i < sizeof nest / sizeof *nest; i++) {
        repeat(text, nest[i], 20000);
        assert_int_equal(br_expression(text, &f, &err), BR_BAD_INPUT);
        assert_non_null(strstr(err.message, "more than 100 brackets, signs, powers or ?: in one "));
    }
    repeat(text, "-", 100);
    strcat(text, "x");
    assert_int_equal(br_expression(text, &f, &err), BR_OK);
    br_function_free(&f);
    char *end = text;
    for (int i = 0; i < 600; i++)
        end += sprintf(end, "x*%d+", i);
    strcpy(end, "0");
    assert_int_equal(br_expression(text, &f, &err), BR_BAD_INPUT);
    assert_non_null(strstr(err.message, "it has more than 1000 operations"));
    repeat(text, "x+", 900); /* deep as a tree, not as a text */
    strcat(text, "x");
    assert_true(value_of(text, 1, 0) == 901);
}

/* Other decimal points, and letters of other alphabets. */
TEST(test_locale)
{
    static const char *const names[] = {"de_DE.UTF-8", "de_DE", "fr_FR.UTF-8", "C.UTF-8"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (setlocale(LC_ALL, names[i]))
            assert_true(value_of("1.5*x", 2, 0) == 3);
    setlocale(LC_ALL, "C");
}

/* ---- what it is worth ---- */

TEST(test_no_numbers)
{
    static const char *const texts[] = {
        "sqrt(x)",  "log(x)",        "min(sqrt(x), 1)", "max(1, sqrt(x))", "sqrt(x) < 1",
        "!sqrt(x)", "asin(t)",       "acos(t)",         "sqrt(x) ? 1 : 2", "step(sqrt(x))",
        "0/(x+1)",  "sign(0/(x+1))", "x^0.5",           "atanh(t)",        "sqrt(x) || 1",
    };
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++)
        if (!isnan(value_of(texts[i], -1, 3)))
            fail_msg("%s is %g", texts[i], value_of(texts[i], -1, 3));
    assert_true(isinf(value_of("1/x", 0, 0)));
}

/* One place at a time gives the bits of many, in any rounding mode, by any instruction set. */
TEST(test_bits)
{
    enum { MOST = 700 };
    static const char text[] = "sin(3*x+t)*exp(-x*t)+cosh(x)*tan(t)^1.5-log(1+x*x)/(2+asinh(t*x))"
                               "+(x<0.3?atan(x):tanh(x))*max(x,t)";
    OWNED(br_function) f = br_test_function(text);
    double x[MOST], value[MOST], one;
    for (int i = 0; i < MOST; i++)
        x[i] = (double)i / 97;
    static const int modes[] = {FE_TONEAREST, FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO};
    br_function_evaluate(&f, MOST, x, 0.37, value);
    for (size_t m = 0; m < 4; m++)
        for (int i = 0; i < MOST; i++) {
            fesetround(modes[m]);
            br_function_evaluate(&f, 1, &x[i], 0.37, &one);
            assert_int_equal(fegetround(), modes[m]);
            fesetround(FE_TONEAREST);
            assert_memory_equal(&one, &value[i], sizeof one);
        }
}

/* ---- sums of products ---- */

static const struct {
    const char *text;
    size_t products, mixed; /* terms without t in their space, and with */
} loads[] = {
    {"7", 1, 0},
    {"sin(t)", 1, 0},
    {"exp(x)", 1, 0},
    {"x*t", 1, 0},
    {"-x*t", 1, 0},
    {"x*sin(t)/3", 1, 0},
    {"x*sin(t) + 5", 2, 0},
    {"x*sin(t) - x^2*cos(t)", 2, 0},
    {"x*sin(t) + x*cos(t)", 1, 0},
    {"x*sin(t) + 2*x*cos(t)", 2, 0},
    {"x*sin(t) + exp(x)*sin(t)", 1, 0},
    {"(x*t)^3", 1, 0},
    {"(x*t)^-2", 1, 0},
    {"(x*t)^0.5", 0, 1},
    {"abs(cos(5*x)*cos(3*t))", 1, 0},
    {"step(x-0.3)*sin(t)", 1, 0},
    {"(x > 0.2 ? 1 : x)*exp(-t)", 1, 0},
    {"(1+x)*(1+t)", 1, 0},
    {"(x+t)*sin(x)", 2, 0},
    {"sin(x)*(x-t)", 2, 0},
    {"(x+t)/(2*t*x)", 2, 0},
    {"(2*t*x)/(x+t+1)", 0, 1},
    {"(x-t)*(x+t)", 0, 1},
    {"(x-t)^2", 0, 1},
    {"exp(-(x-t)^2)", 0, 1},
    {"exp(-(x-t)^2)*t", 0, 1},
    {"exp(-(x-t)^2) + sin(x*t)", 0, 1},
    {"exp(-(x-t)^2) + x*t", 1, 1},
    {"x*t + 1 + x", 2, 0},
    {"x*t+x^2*t^2+x^3*t^3+x^4*t^4+x^5*t^5+x^6*t^6+x^7*t^7+x^8*t^8", 8, 0},
    {"x*t+x^2*t^2+x^3*t^3+x^4*t^4+x^5*t^5+x^6*t^6+x^7*t^7+x^8*t^8+x^9*t^9", 0, 1},
};

static void check_value(const struct br_load *load, const char *text, double x, double t)
{
    const double expected = value_of(text, x, t), found = br_load_value(load, x, t);
    if (!(fabs(found - expected) <= 1e-13 * (1 + fabs(expected))))
        fail_msg("%s is %.17g at x = %g, t = %g, expected %.17g", text, found, x, t, expected);
}

TEST(test_products)
{
    for (size_t i = 0; i < sizeof loads / sizeof *loads; i++) {
        struct br_function f = br_test_function(loads[i].text);
        OWNED(br_load) load;
        size_t products = 0, mixed = 0;
        MUST(br_products(&f, &load, &err));
        for (size_t j = 0; j < BR_LOAD_TERMS; j++) {
            const struct br_product *p = &load.term[j];
            assert_false(p->time.uses_x);
            products += !br_product_is_zero(p) && !p->space.uses_t;
            mixed += !br_product_is_zero(p) && p->space.uses_t;
        }
        if (products != loads[i].products || mixed != loads[i].mixed)
            fail_msg("%s has %zu products and %zu mixed terms", loads[i].text, products, mixed);
        for (double x = 0.1; x < 2; x += 0.3)
            for (double t = 0.1; t < 2; t += 0.3)
                check_value(&load, loads[i].text, x, t);
    }
}

static enum br_status use_expression(const void *text, struct br_error *why)
{
    struct br_function f, copy = {0};
    OWNED(br_load) load = {0};
    enum br_status status = br_expression(text, &f, why);
    if (!status)
        status = br_function_clone(&f, &copy, why);
    if (status)
        br_function_free(&f);
    else
        status = br_products(&f, &load, why); /* which takes it over */
    br_function_free(&copy);
    return status;
}

TEST(test_no_memory)
{
    br_test_without_memory(use_expression, "x*sin(t) + exp(-(x-t)^2)", 30);
}

static double tip_after(struct br_function f, bool products, enum br_field_kind kind)
{
    struct br_scene s = br_test_bare();
    struct br_load *load = &s.field[kind].load;
    if (products)
        MUST(br_products(&f, load, &err));
    else
        load->term[0] = (struct br_product){f, {.constant = 1}};
    const struct br_method method = br_method_default();
    OWNED(br_march) * march;
    MUST(br_march_create(&march, &s, 20, 50, &method, &err));
    for (int i = 0; i < 50; i++)
        MUST(br_march_step(march, &err));
    const double out = br_march_tip_displacement(march, kind);
    br_load_clear(load);
    return out;
}

/* A march with a load's terms, and with the load as one f(x, t). */
TEST(test_march)
{
    static const char *const texts[] = {"100*(x*sin(t) - x^2*cos(3*t) + exp(-(x-t)^2))",
                                        "100*x + 100*exp(-(x-t)^2)", "100*x*sin(t) + 50*x^2"};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++)
        for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
            const double sum = tip_after(br_test_function(texts[i]), true, kind),
                         whole = tip_after(br_test_function(texts[i]), false, kind);
            assert_true(fabs(whole) > 1e-3);
            CLOSE(sum, whole, 1e-12 * fabs(whole));
        }
}
