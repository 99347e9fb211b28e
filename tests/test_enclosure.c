/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Enclosures of operations and of random trees over random boxes, checked by long
 * double: its value at a point of the box, and what evaluation gives there, lie inside; and
 * they are not much wider than what is seen there. Taylor coefficients against Cauchy's integral.
 */
#include "study/known/operations.h"

#include <complex.h>
#include <float.h>
#include <math.h>
#include <stdio.h>

#include "study/known/expression.h"
#include "support.h"
#include "tests/operation_oracle.h"

typedef long double real;
typedef long double complex complex_point;
typedef struct br_interval iv;

enum { MOST_NODES = 40 };

/* Whether a value that is known to `error` may lie in an interval. One that is rounded to the
 * nearest number of more digits stays on its side of an end, which has fewer. */
static bool may_hold(iv a, real value, real error)
{
    return !isfinite(value) || (value + error >= a.low && value - error <= a.high);
}

/* The library's functions are off by units of long double's last place: far less than the ends of
 * an interval, which are doubles, are apart. */
static bool holds(iv a, double evaluated, real value)
{
    return a.low <= evaluated && evaluated <= a.high &&
           may_hold(a, value, 4 * LDBL_EPSILON * br_test_slack() * fabsl(value));
}

/* ---- random boxes ---- */

/* A number of any size and sign, often a round one. */
static double any_number(struct br_test_random *r)
{
    static const double round[] = {0, 1, -1, 0.5, 2, 3, -2, 10, 1e-300, 5e-324, M_PI, 709, 1e15};
    const double sign = br_test_index(r, 2) ? 1 : -1;
    switch (br_test_index(r, 8)) {
    case 0:
        return round[br_test_index(r, sizeof round / sizeof *round)];
    case 1:
        return sign * br_test_log_uniform(r, 1e-310, 1e300);
    case 2:
        return sign * br_test_log_uniform(r, 1e-6, 1e3);
    default:
        return br_test_uniform(r, -3, 3);
    }
}

static iv any_interval(struct br_test_random *r)
{
    const double a = any_number(r);
    double b = a;
    switch (br_test_index(r, 5)) {
    case 0:
        b = any_number(r);
        break;
    case 1:
        break;
    case 2:
        b = nextafter(a, INFINITY);
        break;
    default:
        b = a + fabs(a) * br_test_log_uniform(r, 1e-15, 1);
    }
    return (iv){fmin(a, b), fmax(a, b)};
}

static double any_point(struct br_test_random *r, iv a)
{
    const size_t kind = br_test_index(r, 4);
    const double p = a.low + (a.high - a.low) * br_test_uniform(r, 0, 1);
    return kind == 0     ? a.low
           : kind == 1   ? a.high
           : isfinite(p) ? fmin(fmax(p, a.low), a.high)
                         : a.low;
}

static size_t cases(size_t usual)
{
    return br_test_long() ? 50 * usual : usual;
}

/* ---- one operation ---- */

/* Narrow arguments have narrow bounds: (range of f) + 10 units. */
TEST(test_tight)
{
    struct br_test_random r = {2};
    for (int o = BR_OP_NEGATE; o <= BR_OP_POW; o++)
        for (size_t i = 0; i < cases(400); i++) {
            const bool above = o == BR_OP_ACOSH, inverse = o >= BR_OP_ASIN && o <= BR_OP_ACOS;
            const double x = above                         ? br_test_uniform(&r, 1.1, 9)
                             : inverse || o == BR_OP_ATANH ? br_test_uniform(&r, 0.01, 0.9)
                                                           : br_test_uniform(&r, 0.01, 1.5),
                         y = br_test_uniform(&r, 0.1, 3), w = br_test_log_uniform(&r, 1e-17, 1e-2);
            const iv a[3] = {{x, x + w}, {y, y}, {y, y}};
            const iv bound = br_interval_apply((enum br_operation)o, a, false);
            const double f = br_operation_value((enum br_operation)o, x, y, y),
                         g = br_operation_value((enum br_operation)o, x + w, y, y);
            const double slack = 12 * 2.3e-16 * fmax(fabs(f), fabs(g));
            if (!(bound.high - bound.low <= fabs(g - f) + slack))
                fail_msg("%s at %.17g + %g: %.17g .. %.17g, but %.17g .. %.17g",
                         br_operations[o].word, x, w, bound.low, bound.high, f, g);
        }
}

/* ---- trees ---- */

static unsigned any_tree(struct br_test_random *r, struct br_tree_builder *b, int depth);

static unsigned any_node(struct br_test_random *r, struct br_tree_builder *b, enum br_operation o,
                         int depth)
{
    const unsigned a = any_tree(r, b, depth), c = any_tree(r, b, depth);
    return br_tree_node(b, o, a, br_test_index(r, 5) ? c : a, any_tree(r, b, depth));
}

static unsigned any_tree(struct br_test_random *r, struct br_tree_builder *b, int depth)
{
    const size_t kind = br_test_index(r, depth > 0 ? 12 : 3);
    if (kind == 0)
        return br_tree_number(b, any_number(r));
    if (kind < 3)
        return br_tree_node(b, kind == 1 ? BR_OP_X : BR_OP_T, 0, 0, 0);
    const enum br_operation o =
        kind < 6
            ? BR_OP_ADD + (enum br_operation)br_test_index(r, 4)
            : BR_OP_NEGATE + (enum br_operation)br_test_index(r, BR_OP_CHOOSE - BR_OP_NEGATE + 1);
    return any_node(r, b, o, depth - 1);
}

static void check_tree(const struct br_tree *tree, const struct br_function *f, struct br_box box,
                       iv bound, struct br_test_random *r)
{
    const double x = any_point(r, box.x), t = any_point(r, box.t);
    const real exact = oracle_tree(tree, x, t);
    double value;
    br_function_evaluate(f, 1, &x, t, &value);
    if (holds(bound, value, exact))
        return;
    for (size_t i = 0; i < tree->count; i++)
        printf("# %zu: %s %u %u %u %.17g\n", i, br_operations[tree->node[i].operation].word,
               tree->node[i].argument[0], tree->node[i].argument[1], tree->node[i].argument[2],
               tree->node[i].number);
    fail_msg("%.17g, exactly %.21Lg, at x = %.17g, t = %.17g: outside of %.17g .. %.17g over %.17g "
             "%.17g, %.17g %.17g",
             value, exact, x, t, bound.low, bound.high, box.x.low, box.x.high, box.t.low,
             box.t.high);
}

/* Boxes over which a random tree with an operation at its root is bounded. */
static size_t check_trees(struct br_test_random *r, enum br_operation o, int depth, size_t trees)
{
    size_t bounded = 0;
    for (size_t i = 0; i < trees; i++) {
        struct br_tree_builder b = {0};
        struct br_tree tree, copy;
        struct br_function f;
        const unsigned root = any_node(r, &b, o, depth);
        struct br_tree_builder again = {0};
        const unsigned second = br_tree_graft(&again, &b.tree, root);
        MUST(br_tree_finish(&b, root, &tree, &err));
        MUST(br_tree_finish(&again, second, &copy, &err));
        MUST(br_tree_function(&copy, &f, &err));
        for (int k = 0; k < 4 && tree.count <= MOST_NODES && f.ops; k++) {
            const struct br_box box = {any_interval(r), any_interval(r)};
            iv bound;
            if (!br_function_bound(&f, box, &bound))
                continue;
            bounded++;
            for (int j = 0; j < 3; j++)
                check_tree(&tree, &f, box, bound, r);
        }
        br_tree_clear(&tree);
        br_function_free(&f);
    }
    return bounded;
}

/* Each operation of numbers and variables, and of other operations; and not most are given up. */
TEST(test_trees)
{
    struct br_test_random r = {5};
    for (int o = BR_OP_NEGATE; o <= BR_OP_CHOOSE; o++) {
        const size_t alone = check_trees(&r, (enum br_operation)o, 0, cases(300));
        const size_t all = alone + check_trees(&r, (enum br_operation)o, 3, cases(200));
        AT_MOST((double)cases(300) / 20, (double)alone);
        AT_MOST((double)cases(200) / 4, (double)all);
    }
}

/* Where abs, min and max turn inside of the box, or something is taken by one of them only. */
TEST(test_kinks)
{
    static const char *const rows[] = {"abs(x) - x",          "abs(x - t) + x - t",
                                       "max(x, t) - x",       "min(x, 2*t) + abs(t - x) - t",
                                       "x*abs(x) - x*t",      "t - max(x, t, -x)",
                                       "(x < t ? x : t) - x", "sign(x)*x - abs(x)"};
    struct br_test_random r = {7};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        OWNED(br_tree) tree;
        MUST(br_expression_parse(rows[i], &tree, &err));
        OWNED(br_function) f = br_test_function(rows[i]);
        for (size_t k = 0; k < cases(300); k++) {
            const double x = br_test_uniform(&r, -1, 0.1), t = br_test_uniform(&r, -1, 0.1),
                         w = br_test_log_uniform(&r, 1e-3, 2);
            const struct br_box box = {{x, x + w}, {t, t + w}};
            iv bound;
            assert_true(br_function_bound(&f, box, &bound));
            AT_MOST(bound.high - bound.low, 12 * w * (1 + w));
            for (int j = 0; j < 4; j++)
                check_tree(&tree, &f, box, bound, &r);
        }
    }
}

/* Halved boxes are enclosed four times as tightly: the excess over the range falls quadratically.
 */
TEST(test_quadratic)
{
    OWNED(br_function) f = br_test_function("(x - t)*exp(x)*sin(3*t) - x^2*t + x*t^3 - x*x*x");
    double before = 0;
    for (int k = 6; k <= 16; k++) {
        const double w = ldexp(1, -k);
        const struct br_box box = {{0.4, 0.4 + w}, {0.3, 0.3 + w}};
        double low = INFINITY, high = -INFINITY;
        iv bound;
        assert_true(br_function_bound(&f, box, &bound));
        for (int i = 0; i <= 20; i++)
            for (int j = 0; j <= 20; j++) {
                const double x = 0.4 + w * i / 20;
                double value;
                br_function_evaluate(&f, 1, &x, 0.3 + w * j / 20, &value);
                low = fmin(low, value);
                high = fmax(high, value);
            }
        const double excess = bound.high - bound.low - (high - low);
        if (k > 6)
            AT_MOST(excess, before / 3 + 1e-14);
        before = excess;
    }
}

/* ---- Taylor coefficients ---- */

enum { ORDER = 12 };
typedef complex_point function_of(complex_point u);

static complex_point cube(complex_point u)
{
    return u * u * u;
}

static complex_point root_power(complex_point u)
{
    return u * csqrtl(u);
}

static complex_point inverse(complex_point u)
{
    return 1 / u;
}

static complex_point both(complex_point u)
{
    return cpowl(u, u);
}

static complex_point exp_less_one(complex_point u)
{
    return cexpl(u) - 1;
}

static complex_point same(complex_point u)
{
    return u;
}

/* c[k] (out) of g(shift + 0.7 t + 0.2 t^2) at t by Cauchy's integral over a circle within half of
 * the way to the nearest singularity, by the trapezoidal rule; error[k]: what rounding leaves. */
static void integrate(function_of *g, double shift, double t, real c[], real error[])
{
    enum { POINTS = 64 };
    const real radius = 0.25L, turn = 2 * acosl(-1) / POINTS;
    real largest = 0;
    for (int k = 0; k <= ORDER; k++)
        c[k] = 0;
    for (int i = 0; i < POINTS; i++) {
        const complex_point z = t + radius * cexpl(1.0iL * turn * i);
        const complex_point value = g((real)shift + z * ((real)0.7 + z * (real)0.2));
        largest = fmaxl(largest, cabsl(value));
        for (int k = 0; k <= ORDER; k++)
            c[k] += creall(value * cexpl(-1.0iL * turn * (i * k % POINTS))) / POINTS;
    }
    for (int k = 0; k <= ORDER; k++) {
        c[k] /= powl(radius, k);
        error[k] = 16 * LDBL_EPSILON * br_test_slack() * largest / powl(radius, k);
    }
}

/* At a point, and over a box that holds it. */
static void check_series(const char *text, function_of *g, double shift, struct br_test_random *r)
{
    char full[200];
    iv at_point[ORDER + 1], in_box[ORDER + 1];
    real c[ORDER + 1], error[ORDER + 1];
    snprintf(full, sizeof full, text, shift);
    OWNED(br_function) f = br_test_function(full);
    for (size_t i = 0; i < cases(20); i++) {
        const double t = br_test_uniform(r, 0, 0.2), w = br_test_log_uniform(r, 1e-12, 1e-2);
        const struct br_box at = {{0, 0}, {t, t}}, around = {{0, 0}, {t - w, t + w}};
        assert_true(br_function_taylor(&f, BR_T, at, ORDER, at_point));
        assert_true(br_function_taylor(&f, BR_T, around, ORDER, in_box));
        integrate(g, shift, t, c, error);
        for (int k = 0; k <= ORDER; k++) {
            const iv p = at_point[k], b = in_box[k];
            if (!may_hold(p, c[k], error[k]) || !may_hold(b, c[k], error[k]) || p.low < b.low ||
                p.high > b.high)
                fail_msg("%s at %.17g: coefficient %d, %.21Lg +- %.1Lg, in %.17g .. %.17g", full, t,
                         k, c[k], error[k], p.low, p.high);
            AT_MOST(p.high - p.low, 1e-11 * (magnitude(p) + pow(10, k)));
        }
    }
}

TEST(test_taylor)
{
    struct br_test_random r = {9};
#define U "(%.17g + 0.7*t + 0.2*t^2)"
    static const struct {
        const char *text;
        function_of *g;
        double shift;
    } rows[] = {
        {"sin" U, csinl, 0.3},     {"cos" U, ccosl, 0.3},          {"tan" U, ctanl, 0.3},
        {"asin" U, casinl, 0.3},   {"acos" U, cacosl, 0.3},        {"atan" U, catanl, 0.3},
        {"sinh" U, csinhl, 0.3},   {"cosh" U, ccoshl, 0.3},        {"tanh" U, ctanhl, 0.3},
        {"asinh" U, casinhl, 0.3}, {"acosh" U, cacoshl, 1.3},      {"atanh" U, catanhl, 0.3},
        {"exp" U, cexpl, 0.3},     {"expm1" U, exp_less_one, 0.3}, {"log" U, clogl, 0.3},
        {"sqrt" U, csqrtl, 0.3},   {U "^3", cube, -0.1},           {U "^1.5", root_power, 0.4},
        {"1/" U, inverse, 0.4},    {U "^-1", inverse, 0.4},        {"exp" U "*1", cexpl, 0.3},
        {"abs" U, same, 0.3},      {"max(-9," U ")", same, -0.3},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        check_series(rows[i].text, rows[i].g, rows[i].shift, &r);
    check_series("(0.5 + 0.7*t + 0.2*t^2)^(%.17g + 0.7*t + 0.2*t^2)", both, 0.5, &r);
}

/* Where they are none. */
TEST(test_not_smooth)
{
    static const char *const rows[] = {
        "abs(t - 0.5)", "step(t - 0.5)", "t < 0.5", "min(t, 0.5)",  "sqrt(t)",   "log(t)",
        "t^1.5",        "1/t",           "asin(t)", "acosh(1 + t)", "tan(pi*t)", "t > 0.5 ? t : 1"};
    const struct br_box box = {{0, 1}, {0, 1}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        OWNED(br_function) f = br_test_function(rows[i]);
        iv c[4];
        assert_false(br_function_taylor(&f, BR_T, box, 3, c));
    }
    static const struct br_function_ops none = {0};
    const struct br_function unknown = {.ops = &none}, constant = {.constant = 3};
    iv c[4];
    assert_false(br_function_taylor(&unknown, BR_T, box, 3, c));
    assert_true(br_function_taylor(&constant, BR_T, box, 3, c));
    assert_true(c[0].low == 3 && c[0].high == 3 && c[1].low == 0 && c[3].high == 0);
}
