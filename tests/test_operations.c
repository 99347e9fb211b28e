/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The operations of expressions against the C library's in long double: their error, their bits by
 * each instruction set, and their derivatives. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "study/known/expression.h"
#include "study/known/operations.h"
#include "support.h"
#include "tests/operation_oracle.h"

typedef long double real;

/* ---- accuracy ---- */

enum { FIRST = BR_OP_NEGATE, LAST = BR_OP_CHOOSE };

/* Numbers of all sizes, of usual ones, and special ones. */
static double draw(struct br_test_random *r)
{
    static const double special[] = {0,      -0.0,    1,        -1,      0.5,   2,
                                     3,      DBL_MIN, 5e-324,   DBL_MAX, 709.9, -745.2,
                                     M_PI_2, 1e22,    710.4758, -0.1};
    const double sign = br_test_index(r, 2) ? 1 : -1;
    switch (br_test_index(r, 4)) {
    case 0:
        return special[br_test_index(r, sizeof special / sizeof *special)];
    case 1:
        return sign * br_test_log_uniform(r, 1e-307, 1e307);
    case 2:
        return br_test_uniform(r, -30, 30);
    default:
        return br_test_uniform(r, -1, 1);
    }
}

/* The distance in units in the last place of the truth; NaN where one alone is no number. */
static double error_of(double found, real expected)
{
    if (isnan(expected) && isnan(found))
        return 0;
    if (fabsl(expected) > DBL_MAX) /* it may be just below or just above */
        return fabs(found) >= DBL_MAX && (found > 0) == (expected > 0) ? 0 : NAN;
    int exponent;
    frexpl(expected, &exponent);
    const real unit = ldexpl(1, expected == 0 ? -1074 : exponent < -1021 ? -1074 : exponent - 53);
    return (double)(fabsl((real)found - expected) / unit);
}

/* As operations.h has it. */
static double allowed(enum br_operation operation, const double a[3])
{
    const bool exact = operation < BR_OP_SIN || (operation >= BR_OP_SQRT && operation != BR_OP_POW);
    if (exact)
        return 0.501;
    const bool grows = operation == BR_OP_SINH || operation == BR_OP_COSH;
    const bool area = operation == BR_OP_ASINH || operation == BR_OP_ACOSH;
    if (operation == BR_OP_POW && fabs(a[1]) <= 4 && a[1] == rint(a[1]))
        return 2;
    return (grows && fabs(a[0]) > 709) || (area && fabs(a[0]) > 1e150) ? 2 : 1;
}

TEST(test_accuracy)
{
    if (LDBL_MANT_DIG < 64)
        SKIP("long double is double here");
    struct br_test_random r = {.state = 11};
    for (int operation = FIRST; operation <= LAST; operation++)
        for (int i = 0; i < (br_test_long() ? 1000000 : 20000); i++) {
            const enum br_operation o = (enum br_operation)operation;
            const double a[] = {draw(&r), draw(&r), draw(&r)};
            const real exact[] = {a[0], a[1], a[2]};
            const double found = br_operation_value(o, a[0], a[1], a[2]);
            const double error = error_of(found, oracle_operation(o, exact));
            if (!(error <= allowed(o, a)))
                fail_msg("'%s' of %.17g, %.17g, %.17g is %.17g, off by %g units in the last place",
                         br_operations[o].word, a[0], a[1], a[2], found, error);
        }
}

/* Every instruction set that is there gives the same bits. */
TEST(test_sets)
{
    enum { COUNT = 4096 };
    static _Alignas(64) double a[3][COUNT], first[COUNT], other[COUNT];
    struct br_test_random r = {.state = 12};
    const double *const argument[] = {a[0], a[1], a[2]};
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < COUNT; i++)
            a[k][i] = draw(&r);
    for (int o = FIRST; o <= LAST; o++) {
        br_elementary_portable.apply((enum br_operation)o, COUNT, argument, first);
        for (size_t set = br_instruction_set_best(); br_elementary_all[set]; set++) {
            br_elementary_all[set]->apply((enum br_operation)o, COUNT, argument, other);
            for (int i = 0; i < COUNT; i++)
                if (memcmp(&first[i], &other[i], sizeof first[i]) != 0 &&
                    !(isnan(first[i]) && isnan(other[i])))
                    fail_msg(
                        "'%s' of %.17g, %.17g is %.17g by set %zu and %.17g by the portable one",
                        br_operations[o].word, a[0][i], a[1][i], other[i], set, first[i]);
        }
    }
}

/* ---- derivatives ---- */

/* f' with an error of h^4, from long double's values */
static real difference(const struct br_tree *tree, enum br_variable by, real x, real t)
{
    const real h = 1e-3L, dx = by == BR_X ? h : 0, dt = by == BR_T ? h : 0;
    const real one = oracle_tree(tree, x + dx, t + dt) - oracle_tree(tree, x - dx, t - dt);
    const real two =
        oracle_tree(tree, x + 2 * dx, t + 2 * dt) - oracle_tree(tree, x - 2 * dx, t - 2 * dt);
    return (8 * one - two) / (12 * h);
}

static void check_derivative(const char *text, const struct br_tree *tree, enum br_variable by,
                             struct br_tree *derivative)
{
    MUST(br_tree_derive(tree, by, derivative, &err));
    for (real x = 0.15L; x < 0.9L; x += 0.1L)
        for (real t = 0.17L; t < 0.9L; t += 0.1L) {
            const real expected = difference(tree, by, x, t), found = oracle_tree(derivative, x, t);
            if (!(fabsl(found - expected) <= 1e-8L * (1 + fabsl(expected))))
                fail_msg("d/d%s of %s at x = %.3Lg, t = %.3Lg is %.12Lg, expected %.12Lg",
                         by == BR_X ? "x" : "t", text, x, t, found, expected);
        }
}

/* All rules, with something inside; derived twice, by x and by t. */
TEST(test_derivatives)
{
    static const char *const texts[] = {
        "3",
        "x + 2*t - x*t",
        "x/(1 + t)",
        "(x + t)/(1 + x*t)",
        "sin(2*x + t*x)",
        "cos(x*t - x)",
        "tan(0.5*x + 0.3*t)",
        "asin(0.5*x + 0.2*t)",
        "acos(0.5*x*t)",
        "atan(x - 2*t)",
        "sinh(x + t)",
        "cosh(x*t)",
        "tanh(2*x - t)",
        "asinh(3*x*t - 1)",
        "acosh(1.5 + x + t)",
        "atanh(0.4*x + 0.3*t)",
        "exp(-x*t)",
        "expm1(x - t)",
        "log(1 + x + t^2)",
        "log2(1 + x*t)",
        "log10(2 + x - t)",
        "sqrt(1 + x*t)",
        "abs(x - t - 0.005)*x",
        "sign(x - t - 0.005)*x",
        "step(x - t - 0.005)*sin(t)",
        "x^3*t^2 - x^-1",
        "(1 + x)^2.5*t",
        "2^(x*t)",
        "(1 + x)^(1 + t)",
        "min(x, t + 0.005)*x",
        "max(x*x, t + 0.0051, 0.3)",
        "x > t + 0.005 ? sin(x*t) : cos(x + t)",
        "!(x > t + 0.005)*x + (x < 0.405 && t < 0.505)*t",
        "(x <= 0.3 || t >= 0.203)*x*t + (x == t)",
        "-x^2 + -(-t)",
    };
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        struct br_tree tree, once, twice;
        MUST(br_expression_parse(texts[i], &tree, &err));
        for (int by = BR_X; by <= BR_T; by++) {
            check_derivative(texts[i], &tree, (enum br_variable)by, &once);
            check_derivative(texts[i], &once, by == BR_X ? BR_T : BR_X, &twice);
            br_tree_clear(&twice);
            br_tree_clear(&once);
        }
        br_tree_clear(&tree);
    }
}

/* What a derivative leaves behind: nothing that is 0 or 1. */
TEST(test_simplified)
{
    static const struct {
        const char *text;
        size_t nodes;
    } rows[] = {{"x", 1},      {"t", 1},   {"x*t", 1},   {"5*x", 1},
                {"exp(x)", 2}, {"x^2", 3}, {"sin(x)", 2}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        struct br_tree tree, derived;
        MUST(br_expression_parse(rows[i].text, &tree, &err));
        MUST(br_tree_derive(&tree, BR_X, &derived, &err));
        assert_int_equal(derived.count, rows[i].nodes);
        br_tree_clear(&derived);
        br_tree_clear(&tree);
    }
}

static enum br_status derive(const void *f, struct br_error *why)
{
    const struct br_derivation what = {2, {{2, {1, 1}}, {3, {0, 2}}}, 0.5, NAN};
    OWNED(br_function) out;
    const enum br_status status = br_function_derive(f, &what, &out, why);
    assert_true(status ? !out.ops : out.uses_t && !out.uses_x);
    return status;
}

/* One that grows too long is refused, and memory that is missing told. */
TEST(test_derivation_refusals)
{
    struct br_function f =
        br_test_function("sin(x*exp(t)*sin(x*cos(x*exp(t*x^2)+log(2+x*t))))^t^x");
    struct br_function out;
    REFUSED(br_function_derivative(&f, (struct br_partial){9, 3}, &out, &err), BR_BAD_INPUT,
            "more than 10000 operations");
    assert_null(out.ops);
    br_test_without_memory(derive, &f, 50);
    br_function_free(&f);
}
