/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Derivatives of solutions against those by hand, and what is checked of them. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "reference/mms/mms.h"
#include "study/scene/expression.h"
#include "support.h"

/* ---- derivatives ---- */

static const struct {
    const char *text;
    struct br_partial order;
    double x, t, expected;
    bool uses_x, uses_t;
} derivatives[] = {
    {"x^3*t^2", {0, 0}, 2, 3, 72, true, true},
    {"x^3*t^2", {2, 1}, 2, 3, 72, true, true},
    {"x^3*t^2", {3, 2}, 2, 3, 12, false, false},
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
    {"pi*x", {1, 0}, 5, 5, M_PI, false, false},
    {"3", {1, 0}, 5, 5, 0, false, false},
    /* at kinks: from the right */
    {"abs(t - 0.5)", {0, 1}, 0, 0.5, 1, false, true},
    {"abs(t - 0.5)", {0, 1}, 0, 0.25, -1, false, true},
    {"x*abs(t - 0.5)^3", {0, 2}, 2, 0.5, 0, true, true},
    {"(t - 0.5)^2*step(t - 0.5)", {0, 2}, 0, 0.5, 2, false, true},
    {"(t - 0.5)^2*step(t - 0.5)", {0, 2}, 0, 0.4999, 0, false, true},
    {"(x - 0.5)^2*step(x - 0.5) + t", {2, 0}, 0.5, 0.5, 2, true, false},
    {"(x + t - 1)^2*step(x + t - 1)", {1, 1}, 0.5, 0.5, 2, true, true},
};

TEST(test_derivatives)
{
    for (size_t i = 0; i < sizeof derivatives / sizeof *derivatives; i++) {
        struct br_error err = {0};
        struct br_function f = br_test_function(derivatives[i].text), d;
        double value;
        MUST(br_function_derivative(&f, derivatives[i].order, &d, &err));
        br_function_evaluate(&d, 1, &derivatives[i].x, derivatives[i].t, &value);
        CLOSE(value, derivatives[i].expected, 1e-9 + 1e-14 * fabs(derivatives[i].expected));
        assert_true(derivatives[i].uses_x == d.uses_x && derivatives[i].uses_t == d.uses_t);
        br_function_free(&d);
        br_function_free(&f);
    }
}

/* ---- the check ---- */

static const struct {
    enum br_field_kind kind;
    const char *text, *message; /* NULL: accepted */
} solutions[] = {
    {BR_AXIAL, "sin(x)*exp(t)", NULL},
    {BR_AXIAL, "x*abs(t - 0.3)*(t - 0.3)", NULL},                        /* u_tt jumps */
    {BR_BENDING, "x^2*(t - 0.4)^2*step(t - 0.4)", NULL},                 /* at no sample point */
    {BR_AXIAL, "x*(0.5 + (x + t - 1)^2*step(x + t - 1))", "u_xx jumps"}, /* u_xx jumps */
    {BR_AXIAL, "1 + x", "u is 1 at x = 0, t = 0 s, expected 0 where the beam is clamped"},
    {BR_AXIAL, "x + (t - 0.5)^2*step(t - 0.5)", "u is "},
    {BR_BENDING, "1 + x^2", "w is 1 at x = 0, t = 0 s"},
    {BR_BENDING, "sin(x)", "w_x is 1 at x = 0, t = 0 s, expected 0"},
    {BR_AXIAL, "x/(t - 0.5)", "u: "},
    {BR_AXIAL, "x*log(t)", "u: "},
    {BR_AXIAL, "x*sqrt(t)", "u_t: "},
    {BR_AXIAL, "x*abs(t - 0.3)^1.5", "u_tt: "},
    {BR_AXIAL, "x*abs(t - 0.5)^1.5", "u_tt: "},
    {BR_AXIAL, "x*t^1.5", "u_tt: "},
    {BR_AXIAL, "x^1.5", "u_xx: "},
    {BR_AXIAL, "x*(1 + exp(-100*t))", NULL},
    {BR_AXIAL, "x/(t - 0.3)", "u: "},
    /* jumps, whose deltas the derivatives leave out */
    {BR_AXIAL, "x*step(t - 0.3)",
     "u jumps by 0.125 at t = 0.3 s, x = 0.125 m, expected a solution whose derivatives"},
    {BR_AXIAL, "x*abs(t - 0.3)", "u_t jumps by 0.25 at t = 0.3 s"},
    {BR_AXIAL, "x*step(x - 0.3)", "u jumps"},
    {BR_AXIAL, "x*abs(x - 0.3)", "u_x jumps"},
    {BR_BENDING, "x^2*step(t - 0.3)", "w jumps"},
    {BR_BENDING, "x^2*abs(t - 0.3)", "w_t jumps"},
    {BR_BENDING, "x^2*abs(x - 0.3)", "w_x jumps"},
    {BR_BENDING, "x^2*abs(x - 0.3)*(x - 0.3)", "w_xx jumps"},
    {BR_BENDING, "x^2*abs(x - 0.3)^3", "w_xxx jumps"},
    {BR_BENDING, "x^2*abs(x - 0.3)^3*(x - 0.3)", NULL},
    {BR_AXIAL, "asinh(x/2)*t", NULL},
    {BR_AXIAL, "x*asinh(t/2)", NULL},
    {BR_AXIAL, "x > 0.3 ? x : x", NULL},
    {BR_AXIAL, "x > 0.3 ? x : 0", "u jumps"},
    {BR_AXIAL, "x*min(t, 0.3)", "u_t jumps"},
    {BR_BENDING, "ln(1 + x^2)*2^3^t", NULL},
    /* between all samples */
    {BR_AXIAL, "x*(1 + step(t - 0.3001) - step(t - 0.3002))", "u jumps by "},
    {BR_AXIAL, "x*(1 + (t > 0.3001 && t < 0.3002 && x > 0.7001 && x < 0.7002))", "u jumps by "},
    {BR_AXIAL, "x + 1e-9*x/(t - 0.300001)", "u: "},
};

TEST(test_check)
{
    for (size_t i = 0; i < sizeof solutions / sizeof *solutions; i++) {
        struct br_error err = {0};
        struct br_function f = br_test_function(solutions[i].text);
        const struct br_given s = {&f, solutions[i].kind, 1, 1};
        if (solutions[i].message)
            REFUSED(br_given_check(&s, &err), BR_BAD_INPUT, solutions[i].message);
        else
            MUST(br_given_check(&s, &err));
        br_function_free(&f);
    }
}
