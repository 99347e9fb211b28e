/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Enclosures of operations and of random trees over random boxes, judged by Arb: its ball of the
 * exact value at a point of the box, and what evaluation gives there, lie inside; and they are not
 * much wider than what is seen there. Taylor coefficients against Arb's power series. */
#include "study/scene/enclosure.h"

#include <arb.h>
#include <arb_hypgeom.h>
#include <arb_poly.h>
#include <math.h>
#include <string.h>

#include "study/scene/expression.h"
#include "study/scene/interval.h"
#include "support.h"

typedef struct br_interval iv;

enum { BITS = 200, MOST_NODES = 40 };

/* ---- Arb's value of an operation ---- */

typedef void unary(arb_t out, const arb_t a, slong bits);

static void log_of(arb_t out, const arb_t a, slong base)
{
    arb_log_base_ui(out, a, (ulong)base, BITS);
}

/* sign(a) of a ball with a known sign, or of zero. */
static int sign_of(const arb_t a)
{
    return arb_is_zero(a) ? 0 : arb_is_positive(a) ? 1 : arb_is_negative(a) ? -1 : 2;
}

/* Truths and the like, where Arb knows the signs. False: it does not. */
static bool decide(enum br_operation o, arb_t out, const arb_t a, const arb_t b, const arb_t c)
{
    arb_t difference;
    arb_init(difference);
    arb_sub(difference, a, b, BITS);
    const int s = sign_of(difference), p = sign_of(a), q = sign_of(b);
    arb_clear(difference);
    switch (o) {
    case BR_OP_NOT:
        arb_set_si(out, p == 0);
        return p != 2;
    case BR_OP_SIGN:
        arb_set_si(out, p);
        return p != 2;
    case BR_OP_STEP:
        arb_set_si(out, p >= 0);
        return p != 2;
    case BR_OP_AND:
        arb_set_si(out, p != 0 && q != 0);
        return p != 2 && q != 2;
    case BR_OP_OR:
        arb_set_si(out, p != 0 || q != 0);
        return p != 2 && q != 2;
    case BR_OP_CHOOSE:
        arb_set(out, p ? b : c);
        return p != 2;
    case BR_OP_EQUAL:
    case BR_OP_NOT_EQUAL:
        arb_set_si(out, (s == 0) == (o == BR_OP_EQUAL));
        return s != 2;
    case BR_OP_LESS:
    case BR_OP_LESS_EQUAL:
        arb_set_si(out, s < 0 || (s == 0 && o == BR_OP_LESS_EQUAL));
        return s != 2;
    default:
        arb_set_si(out, s > 0 || (s == 0 && o == BR_OP_GREATER_EQUAL));
        return s != 2;
    }
}

static void power(arb_t out, const arb_t a, const arb_t b)
{
    if (arb_is_exact(b) && arf_is_int(arb_midref(b)) && arf_cmpabs_2exp_si(arb_midref(b), 30) < 0) {
        fmpz_t n;
        fmpz_init(n);
        arf_get_fmpz(n, arb_midref(b), ARF_RND_NEAR);
        arb_pow_fmpz(out, a, n, BITS);
        fmpz_clear(n);
    } else if (arb_is_zero(a) && arb_is_positive(b)) {
        arb_zero(out);
    } else {
        arb_pow(out, a, b, BITS);
    }
}

/* The value of an operation at balls. False: Arb cannot tell. */
static bool judge(enum br_operation o, arb_t out, const arb_t a, const arb_t b, const arb_t c)
{
    static unary *const known[] = {
        [BR_OP_SIN] = arb_sin,     [BR_OP_COS] = arb_cos,     [BR_OP_TAN] = arb_tan,
        [BR_OP_ASIN] = arb_asin,   [BR_OP_ACOS] = arb_acos,   [BR_OP_ATAN] = arb_atan,
        [BR_OP_SINH] = arb_sinh,   [BR_OP_COSH] = arb_cosh,   [BR_OP_TANH] = arb_tanh,
        [BR_OP_ASINH] = arb_asinh, [BR_OP_ACOSH] = arb_acosh, [BR_OP_ATANH] = arb_atanh,
        [BR_OP_EXP] = arb_exp,     [BR_OP_EXPM1] = arb_expm1, [BR_OP_LOG] = arb_log,
        [BR_OP_SQRT] = arb_sqrt,
    };
    if (o < sizeof known / sizeof *known && known[o])
        known[o](out, a, BITS);
    else if (o == BR_OP_LOG2 || o == BR_OP_LOG10)
        log_of(out, a, o == BR_OP_LOG2 ? 2 : 10);
    else if (o == BR_OP_NEGATE)
        arb_neg(out, a);
    else if (o == BR_OP_ABS)
        arb_abs(out, a);
    else if (o == BR_OP_ADD)
        arb_add(out, a, b, BITS);
    else if (o == BR_OP_SUBTRACT)
        arb_sub(out, a, b, BITS);
    else if (o == BR_OP_MULTIPLY)
        arb_mul(out, a, b, BITS);
    else if (o == BR_OP_DIVIDE)
        arb_div(out, a, b, BITS);
    else if (o == BR_OP_MIN)
        arb_min(out, a, b, BITS);
    else if (o == BR_OP_MAX)
        arb_max(out, a, b, BITS);
    else if (o == BR_OP_POW)
        power(out, a, b);
    else if (!decide(o, out, a, b, c))
        return false;
    return arb_is_finite(out);
}

/* Whether a ball touches an interval; a ball of 200 bits that does not is outside. */
static bool touches(iv a, const arb_t ball)
{
    arb_t low, high;
    arb_init(low);
    arb_init(high);
    arb_set_d(low, a.low);
    arb_set_d(high, a.high);
    const bool outside = arb_lt(ball, low) || arb_gt(ball, high);
    arb_clear(low);
    arb_clear(high);
    return !outside;
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

static void check_point(enum br_operation o, const iv a[3], iv bound, const double p[3])
{
    arb_t at[3], exact;
    arb_init(exact);
    for (int k = 0; k < 3; k++) {
        arb_init(at[k]);
        arb_set_d(at[k], p[k]);
    }
    const double value = br_operation_value(o, p[0], p[1], p[2]);
    const bool known = judge(o, exact, at[0], at[1], at[2]);
    if (!(bound.low <= value && value <= bound.high) || (known && !touches(bound, exact))) {
        arb_printn(exact, 25, 0);
        fail_msg("%s(%.17g, %.17g, %.17g) = %.17g outside of %.17g .. %.17g over %g %g, %g %g",
                 br_operation_word(o), p[0], p[1], p[2], value, bound.low, bound.high, a[0].low,
                 a[0].high, a[1].low, a[1].high);
    }
    for (int k = 0; k < 3; k++)
        arb_clear(at[k]);
    arb_clear(exact);
}

static void test_operations(void **state)
{
    (void)state;
    struct br_test_random r = {1};
    for (int o = BR_OP_NEGATE; o <= BR_OP_CHOOSE; o++) {
        size_t bounded = 0;
        const size_t all = cases(700);
        for (size_t i = 0; i < all; i++) {
            const iv a[3] = {any_interval(&r), any_interval(&r), any_interval(&r)};
            const iv bound = br_interval_apply((enum br_operation)o, a, false);
            if (br_is_none(bound))
                continue;
            bounded++;
            for (int k = 0; k < 3; k++) {
                const double p[] = {any_point(&r, a[0]), any_point(&r, a[1]), any_point(&r, a[2])};
                check_point((enum br_operation)o, a, bound, p);
            }
        }
        AT_MOST((double)all / 30, (double)bounded); /* and not most are given up */
    }
}

/* Narrow arguments have narrow bounds: (range of f) + 10 units. */
static void test_tight(void **state)
{
    (void)state;
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
                         br_operation_word((enum br_operation)o), x, w, bound.low, bound.high, f,
                         g);
        }
}

/* ---- trees ---- */

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
    const unsigned a = any_tree(r, b, depth - 1), c = any_tree(r, b, depth - 1);
    return br_tree_node(b, o, a, br_test_index(r, 5) ? c : a, any_tree(r, b, depth - 1));
}

/* Arb's value of a tree at a point. False: it cannot tell. */
static bool judge_tree(const struct br_tree *tree, double x, double t, arb_t out)
{
    arb_t node[MOST_NODES];
    bool known[MOST_NODES];
    for (size_t i = 0; i < tree->count; i++) {
        const struct br_node *n = &tree->node[i];
        arb_init(node[i]);
        known[i] = true;
        for (unsigned k = 0; k < br_operation_arguments(n->operation); k++)
            known[i] = known[i] && known[n->argument[k]];
        if (n->operation <= BR_OP_T)
            arb_set_d(node[i], n->operation == BR_OP_NUMBER ? n->number
                               : n->operation == BR_OP_X    ? x
                                                            : t);
        else
            known[i] = known[i] && judge(n->operation, node[i], node[n->argument[0]],
                                         node[n->argument[1]], node[n->argument[2]]);
    }
    const bool last = known[tree->count - 1];
    arb_set(out, node[tree->count - 1]);
    for (size_t i = 0; i < tree->count; i++)
        arb_clear(node[i]);
    return last;
}

static void check_tree(const struct br_tree *tree, const struct br_function *f, struct br_box box,
                       iv bound, struct br_test_random *r)
{
    const double x = any_point(r, box.x), t = any_point(r, box.t);
    double value;
    arb_t exact;
    arb_init(exact);
    br_function_evaluate(f, 1, &x, t, &value);
    const bool known = judge_tree(tree, x, t, exact);
    if (!(bound.low <= value && value <= bound.high) || (known && !touches(bound, exact))) {
        for (size_t i = 0; i < tree->count; i++)
            printf("# %zu: %s %u %u %u %.17g\n", i, br_operation_word(tree->node[i].operation),
                   tree->node[i].argument[0], tree->node[i].argument[1], tree->node[i].argument[2],
                   tree->node[i].number);
        printf("# ");
        arb_printn(exact, 25, 0);
        fail_msg(" %.17g at x = %.17g, t = %.17g: outside of %.17g .. %.17g over %.17g %.17g, "
                 "%.17g %.17g",
                 value, x, t, bound.low, bound.high, box.x.low, box.x.high, box.t.low, box.t.high);
    }
    arb_clear(exact);
}

static void test_trees(void **state)
{
    (void)state;
    struct br_test_random r = {5};
    size_t bounded = 0;
    for (size_t i = 0; i < cases(6000); i++) {
        struct br_tree_builder b = {0};
        struct br_tree tree, copy;
        struct br_function f;
        struct br_error err;
        const unsigned root = any_tree(&r, &b, 4);
        struct br_tree_builder again = {0};
        const unsigned second = br_tree_graft(&again, &b.tree, root);
        MUST(br_tree_finish(&b, root, &tree, &err));
        MUST(br_tree_finish(&again, second, &copy, &err));
        MUST(br_tree_function(&copy, &f, &err));
        for (int k = 0; k < 4 && tree.count <= MOST_NODES && f.ops; k++) {
            const struct br_box box = {any_interval(&r), any_interval(&r)};
            iv bound;
            if (!br_function_bound(&f, box, &bound))
                continue;
            bounded++;
            for (int j = 0; j < 3; j++)
                check_tree(&tree, &f, box, bound, &r);
        }
        br_tree_clear(&tree);
        br_function_free(&f);
    }
    AT_MOST((double)cases(6000) / 2, (double)bounded);
}

/* Where abs, min and max turn inside of the box, or something is taken by one of them only. */
static void test_kinks(void **state)
{
    (void)state;
    static const char *const rows[] = {"abs(x) - x",          "abs(x - t) + x - t",
                                       "max(x, t) - x",       "min(x, 2*t) + abs(t - x) - t",
                                       "x*abs(x) - x*t",      "t - max(x, t, -x)",
                                       "(x < t ? x : t) - x", "sign(x)*x - abs(x)"};
    struct br_test_random r = {7};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        struct br_tree tree;
        struct br_error err;
        MUST(br_expression_parse(rows[i], &tree, &err));
        struct br_function f = br_test_function(rows[i]);
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
        br_tree_clear(&tree);
        br_function_free(&f);
    }
}

/* Halved boxes are enclosed four times as tightly: the excess over the range falls quadratically.
 */
static void test_quadratic(void **state)
{
    (void)state;
    struct br_function f = br_test_function("(x - t)*exp(x)*sin(3*t) - x^2*t + x*t^3 - x*x*x");
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
    br_function_free(&f);
}

/* ---- Taylor coefficients ---- */

typedef void series(arb_poly_t out, const arb_poly_t a, slong length, slong bits);

/* Of g(u(t)), u = 0.3 + 0.7 t + 0.2 t^2 at a point, and over a box that holds it. */
static void check_series(const char *text, series *g, double shift, struct br_test_random *r)
{
    enum { ORDER = 12 };
    char full[200];
    iv point[ORDER + 1], box[ORDER + 1];
    snprintf(full, sizeof full, text, shift);
    struct br_function f = br_test_function(full);
    for (int i = 0; i < (int)cases(20); i++) {
        const double t = br_test_uniform(r, 0, 0.2), w = br_test_log_uniform(r, 1e-12, 1e-2);
        arb_poly_t u, out;
        arb_t c;
        arb_init(c);
        arb_poly_init(u);
        arb_poly_init(out);
        const struct br_box at = {{0, 0}, {t, t}}, around = {{0, 0}, {t - w, t + w}};
        assert_true(br_function_taylor(&f, BR_T, at, ORDER, point));
        assert_true(br_function_taylor(&f, BR_T, around, ORDER, box));
        /* u(t + h) = shift + 0.7 t + 0.2 t^2 + (0.7 + 0.4 t) h + 0.2 h^2, in the tree's numbers */
        arb_t tt, one, two;
        arb_init(tt);
        arb_init(one);
        arb_init(two);
        arb_set_d(tt, t);
        arb_set_d(one, 0.7);
        arb_set_d(two, 0.2);
        arb_poly_set_coeff_arb(u, 2, two);
        arb_mul(c, two, tt, BITS);
        arb_add(c, c, one, BITS);
        arb_mul(c, c, tt, BITS);
        arb_set_d(one, shift);
        arb_add(c, c, one, BITS);
        arb_poly_set_coeff_arb(u, 0, c);
        arb_set_d(one, 0.7);
        arb_mul(c, two, tt, BITS);
        arb_mul_2exp_si(c, c, 1);
        arb_add(c, c, one, BITS);
        arb_poly_set_coeff_arb(u, 1, c);
        g(out, u, ORDER + 1, BITS);
        for (slong k = 0; k <= ORDER; k++) {
            arb_poly_get_coeff_arb(c, out, k);
            if (!touches(point[k], c) || !touches(box[k], c) || point[k].low < box[k].low ||
                point[k].high > box[k].high)
                fail_msg("%s at %.17g: coefficient %ld in %.17g .. %.17g", full, t, k, point[k].low,
                         point[k].high);
            AT_MOST(point[k].high - point[k].low,
                    1e-11 * (br_magnitude(point[k]) + pow(10, (double)k)));
        }
        arb_clear(tt);
        arb_clear(one);
        arb_clear(two);
        arb_clear(c);
        arb_poly_clear(u);
        arb_poly_clear(out);
    }
    br_function_free(&f);
}

static void cube(arb_poly_t out, const arb_poly_t a, slong length, slong bits)
{
    arb_poly_pow_ui_trunc_binexp(out, a, 3, length, bits);
}

static void root_power(arb_poly_t out, const arb_poly_t a, slong length, slong bits)
{
    arb_t half;
    arb_init(half);
    arb_set_d(half, 1.5);
    arb_poly_pow_arb_series(out, a, half, length, bits);
    arb_clear(half);
}

static void inverse(arb_poly_t out, const arb_poly_t a, slong length, slong bits)
{
    arb_poly_inv_series(out, a, length, bits);
}

static void both(arb_poly_t out, const arb_poly_t a, slong length, slong bits)
{
    arb_poly_pow_series(out, a, a, length, bits);
}

static void tangent_h(arb_poly_t out, const arb_poly_t a, slong length, slong bits)
{
    arb_poly_t s, c;
    arb_poly_init(s);
    arb_poly_init(c);
    arb_poly_sinh_cosh_series(s, c, a, length, bits);
    arb_poly_div_series(out, s, c, length, bits);
    arb_poly_clear(s);
    arb_poly_clear(c);
}

/* Inverse hyperbolic functions by logarithms: log(u + sqrt(u^2 + s)), s = 1 or -1. */
static void area(arb_poly_t out, const arb_poly_t a, slong s, slong length, slong bits)
{
    arb_poly_mullow(out, a, a, length, bits);
    arb_poly_add_si(out, out, s, bits);
    arb_poly_sqrt_series(out, out, length, bits);
    arb_poly_add(out, out, a, bits);
    arb_poly_log_series(out, out, length, bits);
}

static void area_sine(arb_poly_t out, const arb_poly_t a, slong length, slong bits)
{
    area(out, a, 1, length, bits);
}

static void area_cosine(arb_poly_t out, const arb_poly_t a, slong length, slong bits)
{
    area(out, a, -1, length, bits);
}

/* log((1 + u) / (1 - u)) / 2 */
static void area_tangent(arb_poly_t out, const arb_poly_t a, slong length, slong bits)
{
    arb_poly_t below;
    arb_poly_init(below);
    arb_poly_neg(below, a);
    arb_poly_add_si(below, below, 1, bits);
    arb_poly_add_si(out, a, 1, bits);
    arb_poly_div_series(out, out, below, length, bits);
    arb_poly_log_series(out, out, length, bits);
    arb_poly_scalar_mul_2exp_si(out, out, -1);
    arb_poly_clear(below);
}

static void exp_less_one(arb_poly_t out, const arb_poly_t a, slong length, slong bits)
{
    arb_poly_exp_series(out, a, length, bits);
    arb_poly_add_si(out, out, -1, bits);
}

static void same(arb_poly_t out, const arb_poly_t a, slong length, slong bits)
{
    (void)length;
    (void)bits;
    arb_poly_set(out, a);
}

static void test_taylor(void **state)
{
    (void)state;
    struct br_test_random r = {9};
#define U "(%.17g + 0.7*t + 0.2*t^2)"
    static const struct {
        const char *text;
        series *g;
        double shift;
    } rows[] = {
        {"sin" U, arb_poly_sin_series, 0.3},
        {"cos" U, arb_poly_cos_series, 0.3},
        {"tan" U, arb_poly_tan_series, 0.3},
        {"asin" U, arb_poly_asin_series, 0.3},
        {"acos" U, arb_poly_acos_series, 0.3},
        {"atan" U, arb_poly_atan_series, 0.3},
        {"sinh" U, arb_poly_sinh_series, 0.3},
        {"cosh" U, arb_poly_cosh_series, 0.3},
        {"tanh" U, tangent_h, 0.3},
        {"asinh" U, area_sine, 0.3},
        {"acosh" U, area_cosine, 1.3},
        {"atanh" U, area_tangent, 0.3},
        {"exp" U, arb_poly_exp_series, 0.3},
        {"expm1" U, exp_less_one, 0.3},
        {"log" U, arb_poly_log_series, 0.3},
        {"sqrt" U, arb_poly_sqrt_series, 0.3},
        {U "^3", cube, -0.1},
        {U "^1.5", root_power, 0.4},
        {"1/" U, inverse, 0.4},
        {U "^-1", inverse, 0.4},
        {"exp" U "*1", arb_poly_exp_series, 0.3},
        {"abs" U, same, 0.3},
        {"max(-9," U ")", same, -0.3},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        check_series(rows[i].text, rows[i].g, rows[i].shift, &r);
    check_series("(0.5 + 0.7*t + 0.2*t^2)^(%.17g + 0.7*t + 0.2*t^2)", both, 0.5, &r);
}

/* Where they are none. */
static void test_not_smooth(void **state)
{
    (void)state;
    static const char *const rows[] = {
        "abs(t - 0.5)", "step(t - 0.5)", "t < 0.5", "min(t, 0.5)",  "sqrt(t)",   "log(t)",
        "t^1.5",        "1/t",           "asin(t)", "acosh(1 + t)", "tan(pi*t)", "t > 0.5 ? t : 1"};
    const struct br_box box = {{0, 1}, {0, 1}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        struct br_function f = br_test_function(rows[i]);
        iv c[4];
        assert_false(br_function_taylor(&f, BR_T, box, 3, c));
        br_function_free(&f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_operations), cmocka_unit_test(test_tight),
        cmocka_unit_test(test_trees),      cmocka_unit_test(test_kinks),
        cmocka_unit_test(test_quadratic),  cmocka_unit_test(test_taylor),
        cmocka_unit_test(test_not_smooth),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
