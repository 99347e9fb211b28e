/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Symbolic derivatives against those by hand, and their check by quadrature. */
#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>

#include "reference/mms/check.h"
#include "reference/mms/product.h"
#include "study/scene/expression.h"
#include "support.h"

/* ---- derivatives ---- */

static const struct {
    const char *text;
    struct br_order order;
    double x, t, expected;
    bool uses_x, uses_t;
} derivatives[] = {
    {"x^3*t^2", {0, 0}, 2, 3, 72, true, true},
    {"x^3*t^2", {2, 1}, 2, 3, 72, true, true},
    {"x^3*t^2", {3, 2}, 2, 3, 12, true, true}, /* which variables drop out is not known */
    {"sin(2*x)*exp(-t)",
     {4, 1},
     0.3,
     0.7,
     -16 * 0.5646424733950354 * 0.4965853037914095,
     true,
     true},
    {"sin(2*x)*exp(-t) + 0",
     {4, 1},
     0.3,
     0.7,
     -16 * 0.5646424733950354 * 0.4965853037914095,
     true,
     true}, /* no product */
    {"cos(x*t)", {1, 1}, 0.5, 2, -0.8414709848078965 - 0.5403023058681398, true, true},
    {"log(1 + x)", {1, 0}, 1, 0, 0.5, true, false},
    {"2^t", {0, 1}, 0, 3, 8 * 0.6931471805599453, false, true},
    {"-x^2*2e-3/4", {1, 0}, 3, 0, -3e-3, true, false},
    {"pi*x", {1, 0}, 5, 5, M_PI, true, false},
    {"3", {1, 0}, 5, 5, 0, false, false},
    /* at kinks: from the right */
    {"abs(t - 0.5)", {0, 1}, 0, 0.5, 1, false, true},
    {"abs(t - 0.5)", {0, 1}, 0, 0.25, -1, false, true},
    {"x*abs(t - 0.5)^3", {0, 2}, 2, 0.5, 0, true, true},
    {"(t - 0.5)^2*step(t - 0.5)", {0, 2}, 0, 0.5, 2, false, true},
    {"(t - 0.5)^2*step(t - 0.5)", {0, 2}, 0, 0.4999, 0, false, true},
    {"(x - 0.5)^2*step(x - 0.5) + t", {2, 0}, 0.5, 0.5, 2, true, true},
    {"(x + t - 1)^2*step(x + t - 1)", {1, 1}, 0.5, 0.5, 2, true, true},
};

static void check_value(size_t i, const struct br_derivative *d)
{
    const double expected = derivatives[i].expected;
    CLOSE(br_derivative_at(d, derivatives[i].x, derivatives[i].t), expected,
          1e-9 + 1e-14 * fabs(expected));
    /* a variable that is said not to occur does not matter */
    if (!br_derivative_uses_x(d))
        CLOSE(br_derivative_at(d, 0.9, derivatives[i].t), expected, 1e-14);
    if (!br_derivative_uses_t(d))
        CLOSE(br_derivative_at(d, derivatives[i].x, 0.9), expected, 1e-14);
    assert_true(derivatives[i].uses_x || !br_derivative_uses_x(d));
    assert_true(derivatives[i].uses_t || !br_derivative_uses_t(d));
}

static void test_derivatives(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof derivatives / sizeof *derivatives; i++) {
        struct br_error err = {0};
        struct br_derivative *d, *copy;
        MUST(br_derivative_create(&d, derivatives[i].text, derivatives[i].order, &err));
        check_value(i, d);
        MUST(br_derivative_clone(d, &copy, &err));
        br_derivative_free(d);
        check_value(i, copy);
        br_derivative_free(copy);
    }
    br_derivative_free(NULL);
}

/* Many points at once, twice the same and then others: as one by one. */
static void test_values(void **state)
{
    (void)state;
    static const char *const texts[] = {"sin(3*x)*exp(t)*2", "sin(3*x + t)"};
    static const double x[][3] = {{0.1, 0.2, 0.3}, {0.1, 0.2, 0.3}, {0.3, 0.2, 0.1}};
    for (size_t i = 0; i < 2; i++) {
        struct br_error err = {0};
        struct br_derivative *d;
        MUST(br_derivative_create(&d, texts[i], (struct br_order){1, 1}, &err));
        for (size_t call = 0; call < 3; call++) {
            double value[3];
            br_derivative_values(d, 3, x[call], 0.1 * (double)call, value);
            for (size_t p = 0; p < 3; p++)
                CLOSE(value[p], br_derivative_at(d, x[call][p], 0.1 * (double)call), 1e-14);
        }
        br_derivative_free(d);
    }
}

static void test_products(void **state)
{
    (void)state;
    static const struct {
        const char *text, *in_x, *in_t; /* NULL: no product */
    } products[] = {
        {"sin(x)*cos(t)", "(sin(x))", "(cos(t))"},
        {"2*x*t*3", "(2)*(x)*(3)", "(t)"},
        {"-x^2/4*(1 + t)", "(-x^2/4)", "((1 + t))"},
        {"1e-3*exp(2*x)", "(1e-3)*(exp(2*x))", "1"},
        {"t*1.E+2", "(1.E+2)", "(t)"},
        {"t*-x", "(-x)", "(t)"},
        {"exp(t)", "1", "(exp(t))"},
        {"x*t - 1", NULL, NULL},
        {"exp - 1*x", NULL, NULL},
        {"x/t", NULL, NULL},
        {"sin(x + t)", NULL, NULL},
        {"x^t*2", NULL, NULL},
        {"(x + 1)*(t + 1)", "((x + 1))", "((t + 1))"},
        {"", NULL, NULL},
    };
    for (size_t i = 0; i < sizeof products / sizeof *products; i++) {
        char in_x[128], in_t[128];
        assert_true(br_product_size(strlen(products[i].text)) <= sizeof in_x);
        const bool split = br_product_split(products[i].text, in_x, in_t);
        assert_int_equal(split, products[i].in_x != NULL);
        if (split) {
            assert_string_equal(in_x, products[i].in_x);
            assert_string_equal(in_t, products[i].in_t);
        }
    }
}

static void test_language(void **state)
{
    (void)state;
    static const struct {
        const char *text, *message;
    } refusals[] = {
        {"x > t", "found '>' in 'x > t', expected only letters"},
        {"x ? 1 : 2", "found '?'"},
        {"min(x,t)", "found ','"},
        {"ln(1 + x)", "found 'ln' in 'ln(1 + x)', expected only what can be derived"},
        {"sign(x)", "found 'sign'"},
        {"expm1(x)", "found 'expm1'"},
    };
    for (size_t i = 0; i < sizeof refusals / sizeof *refusals; i++) {
        struct br_error err = {0};
        struct br_function same = br_test_function(refusals[i].text);
        REFUSED(br_derivative_check_text(refusals[i].text, &same, 1, 1, &err), BR_BAD_INPUT,
                refusals[i].message);
        br_function_free(&same);
    }
    struct br_error err = {0};
    struct br_derivative *d;
    REFUSED(br_derivative_create(&d, "x + y", (struct br_order){0, 0}, &err), BR_BAD_INPUT,
            "found 'y' in 'x + y', expected only what");
    assert_null(d);
    REFUSED(br_derivative_create(&d, "ln2*x", (struct br_order){0, 0}, &err), BR_BAD_INPUT,
            "found 'ln2' in"); /* a constant of libmatheval's */
    assert_null(d);
    struct br_function same = br_test_function("x^2^3");
    REFUSED(br_derivative_check_text("x^2^3", &same, 2, 1, &err), BR_BAD_INPUT,
            "'x^2^3' is 64 at x = 2 m, t = 0 s where it is derived symbolically, expected 256");
    br_function_free(&same);
}

/* Everything that derivative.h calls common is. */
static void test_common_language(void **state)
{
    (void)state;
    static const char *const texts[] = {
        "x + 2 - .5*t/1e-3^2",
        "-x^2",
        "2^-x",
        "sin(x)*cos(t)",
        "tan(x)",
        "asin(x/2) + acos(x/2)",
        "atan(x + t)",
        "sinh(x)",
        "cosh(x)",
        "tanh(x)",
        "acosh(x + 1.5)",
        "atanh(x/2)",
        "exp(x)",
        "log(1 + x)",
        "sqrt(x + t)",
        "abs(x - t)",
        "step(x - t)",
        "pi + e*x",
        "(1 + x)^2.5*t",
        "x - -t",
        "1.5E+2*x",
    };
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        struct br_error err = {0};
        struct br_function same = br_test_function(texts[i]);
        MUST(br_derivative_check_text(texts[i], &same, 1, 1, &err));
        br_function_free(&same);
    }
    struct br_function step = br_test_function("step(x)");
    const double x[] = {-1e-300, 0, 1};
    double value[3];
    br_function_evaluate(&step, 3, x, 0, value);
    assert_true(value[0] == 0 && value[1] == 1 && value[2] == 1);
    br_function_free(&step);
}

/* ---- the check ---- */

static const struct {
    enum br_field_kind kind;
    const char *text, *message; /* NULL: accepted */
} solutions[] = {
    {BR_AXIAL, "sin(x)*exp(t)", NULL},
    {BR_AXIAL, "x*abs(t - 0.3)*(t - 0.3)", NULL},        /* u_tt jumps */
    {BR_BENDING, "x^2*(t - 0.4)^2*step(t - 0.4)", NULL}, /* at no sample point */
    {BR_AXIAL, "x*(0.5 + (x + t - 1)^2*step(x + t - 1))", "u_xxt integrates"}, /* u_xx jumps */
    {BR_AXIAL, "1 + x", "u is 1 at x = 0, t = 0 s, expected 0 where the beam is clamped"},
    {BR_AXIAL, "x + (t - 0.5)^2*step(t - 0.5)", "u is "},
    {BR_BENDING, "1 + x^2", "w is 1 at x = 0, t = 0 s"},
    {BR_BENDING, "sin(x)", "w_x is 1 at x = 0, t = 0 s, expected 0"},
    {BR_AXIAL, "x/(t - 0.5)", "u is "},
    {BR_AXIAL, "x*log(t)", "u is "},
    {BR_AXIAL, "x*sqrt(t)", "u_t is "},
    {BR_AXIAL, "x*abs(t - 0.3)^1.5", "u_tt reaches "},
    {BR_AXIAL, "x*abs(t - 0.5)^1.5", "u_tt is "},
    {BR_AXIAL, "x*t^1.5", "u_tt is "},
    {BR_AXIAL, "x^1.5", "u_xx is "},
    {BR_AXIAL, "x*(1 + exp(-100*t))", NULL},
    {BR_AXIAL, "x/(t - 0.3)", "u_t "},
    /* jumps, whose deltas the derivatives leave out */
    {BR_AXIAL, "x*step(t - 0.3)",
     "u_t integrates to 0 from t = 0.25 to 0.375 s at x = 0.125 m, "
     "expected 0.125, the change of u there: it jumps"},
    {BR_AXIAL, "x*abs(t - 0.3)", "u_tt integrates to 0 from t = 0.25 to 0.375 s"},
    {BR_AXIAL, "x*step(x - 0.3)", "u_x integrates"},
    {BR_AXIAL, "x*abs(x - 0.3)", "u_xx integrates"},
    {BR_BENDING, "x^2*step(t - 0.3)", "w_t integrates"},
    {BR_BENDING, "x^2*abs(t - 0.3)", "w_tt integrates"},
    {BR_BENDING, "x^2*abs(x - 0.3)", "w_xx integrates"},
    {BR_BENDING, "x^2*abs(x - 0.3)*(x - 0.3)", "w_xxx integrates"},
    {BR_BENDING, "x^2*abs(x - 0.3)^3", "w_xxxx integrates"},
    {BR_BENDING, "x^2*abs(x - 0.3)^3*(x - 0.3)", NULL},
    /* libmatheval 1.1.11 takes the derivative of asinh for that of asin */
    {BR_AXIAL, "asinh(x/2)*t", "u_x integrates"},
    {BR_AXIAL, "x*asinh(t/2)", "u_t integrates"},
};

static void test_check(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof solutions / sizeof *solutions; i++) {
        struct br_error err = {0};
        const struct br_solution s = {solutions[i].text, solutions[i].kind, 1, 1};
        if (solutions[i].message)
            REFUSED(br_solution_check(&s, &err), BR_BAD_INPUT, solutions[i].message);
        else
            MUST(br_solution_check(&s, &err));
    }
}
/* libmatheval's parser has global state. */
static void *derive_many(void *wrong)
{
    for (int i = 0; i < 300; i++) {
        struct br_derivative *d;
        char text[64];
        snprintf(text, sizeof text, "%d*sin(x)*exp(t) + t", i);
        const bool good = !br_derivative_create(&d, text, (struct br_order){1, 1}, NULL) &&
                          fabs(br_derivative_at(d, 0, 0) - i) <= 1e-12;
        br_derivative_free(d);
        if (!good)
            atomic_fetch_add((atomic_int *)wrong, 1);
    }
    return NULL;
}

static void test_concurrent_parsers(void **state)
{
    (void)state;
    pthread_t thread[4];
    atomic_int wrong = 0;
    for (int i = 0; i < 4; i++)
        assert_int_equal(pthread_create(&thread[i], NULL, derive_many, &wrong), 0);
    for (int i = 0; i < 4; i++)
        pthread_join(thread[i], NULL);
    assert_int_equal(wrong, 0);
}
int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_derivatives),        cmocka_unit_test(test_values),
        cmocka_unit_test(test_products),           cmocka_unit_test(test_language),
        cmocka_unit_test(test_common_language),    cmocka_unit_test(test_check),
        cmocka_unit_test(test_concurrent_parsers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
