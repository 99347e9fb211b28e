/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Taylor coefficients of operations, by the recurrences of Moore: series of order + 1 intervals. */
#include "study/scene/operations.h"

#include <math.h>
#include <string.h>

typedef struct br_interval iv;

static iv add(iv a, iv b)
{
    return br_interval_add(a, b);
}

static iv multiply(iv a, iv b)
{
    return br_interval_multiply(a, b);
}

static iv scale(double factor, iv a)
{
    return br_interval_multiply(br_point(factor), a);
}

struct rule;

/* What the series of one operation are made of. Its own first coefficient is known, which a
 * recurrence may put another one in the place of; the others are none. */
struct recurrence {
    size_t order;
    const iv *a, *b;
    iv *out;
    const struct rule *by; /* of the operation; NULL: needs none */
};

/* How an operation's series are found. */
struct rule {
    void (*series)(const struct recurrence *r);
    double sign;
    double constant, slope; /* of an inverse function; slope: of a logarithm its unit */
    enum { ITSELF, SQUARE, SLOPE } next; /* of a flow: what its second series is made of */
    bool root;                           /* of an inverse function */
    enum br_operation partner;           /* whose value a second series begins with */
};

/* sum of a_j b_(k-j), j = from .. to */
static iv convolve(const iv *a, const iv *b, size_t k, size_t from, size_t to)
{
    iv sum = {0, 0};
    for (size_t j = from; j <= to; j++)
        sum = add(sum, multiply(a[j], b[k - j]));
    return sum;
}

/* sum of j a_j b_(k-j), j = 1 .. to, over k */
static iv convolve_slope(const iv *a, const iv *b, size_t k, size_t to)
{
    iv sum = {0, 0};
    for (size_t j = 1; j <= to; j++)
        sum = add(sum, scale((double)j, multiply(a[j], b[k - j])));
    return br_interval_divide(sum, br_point((double)k));
}

/* Coefficient k of a^2. */
static iv square_at(const iv *a, size_t k)
{
    if (k == 0)
        return br_interval_square(a[0]);
    const iv pairs = scale(2, convolve(a, a, k, 0, (k - 1) / 2));
    return k % 2 ? pairs : add(pairs, br_interval_square(a[k / 2]));
}

static void square_series(size_t order, const iv *a, iv *out)
{
    for (size_t k = 0; k <= order; k++)
        out[k] = square_at(a, k);
}

static void product_series(size_t order, const iv *a, const iv *b, iv *out)
{
    if (a == b) {
        square_series(order, a, out);
        return;
    }
    for (size_t k = 0; k <= order; k++)
        out[k] = convolve(a, b, k, 0, k);
}

/* b q = a */
static void quotient(const struct recurrence *r)
{
    for (size_t k = 1; k <= r->order; k++) {
        const iv known = convolve(r->b, r->out, k, 1, k);
        r->out[k] = br_interval_divide(br_interval_subtract(r->a[k], known), r->b[0]);
    }
}

static void product(const struct recurrence *r)
{
    product_series(r->order, r->a, r->b, r->out);
}

/* y' = sign a' v, and v is y' own: y (exp), 1 + slope y^2 (tan and tanh), or of v' = slope a' y
 * (sin and cos, sinh and cosh) */
static void flow(const struct recurrence *r)
{
    const struct rule *by = r->by;
    iv v[BR_TREE_WORK] = {by->next == SQUARE
                              ? add(br_point(1), scale(by->slope, square_at(r->out, 0)))
                              : br_interval_apply(by->partner, r->a, false)};
    for (size_t k = 1; k <= r->order; k++) {
        r->out[k] = scale(by->sign, convolve_slope(r->a, v, k, k));
        v[k] = by->next == ITSELF   ? r->out[k]
               : by->next == SQUARE ? scale(by->slope, square_at(r->out, k))
                                    : scale(by->slope, convolve_slope(r->a, r->out, k, k));
    }
}

/* k a_0 p_k = sum of (n j - (k - j)) a_j p_(k-j) */
static void real_power_series(const struct recurrence *r, double n)
{
    for (size_t k = 1; k <= r->order; k++) {
        iv sum = {0, 0};
        for (size_t j = 1; j <= k; j++) {
            const iv factor = br_interval_subtract(multiply(br_point(n), br_point((double)j)),
                                                   br_point((double)(k - j)));
            sum = add(sum, multiply(factor, multiply(r->a[j], r->out[k - j])));
        }
        r->out[k] = br_interval_divide(sum, scale((double)k, r->a[0]));
    }
}

static void root(const struct recurrence *r)
{
    real_power_series(r, 0.5);
}

/* w y' = sign a' */
static void integral(const struct recurrence *r, const iv *w, double sign)
{
    for (size_t k = 1; k <= r->order; k++) {
        const iv known = convolve_slope(r->out, w, k, k - 1);
        r->out[k] = br_interval_divide(br_interval_subtract(scale(sign, r->a[k]), known), w[0]);
    }
}

/* w y' = slope a', w = constant + sign a^2 or its root */
static void inverse(const struct recurrence *r)
{
    iv square[BR_TREE_WORK], w[BR_TREE_WORK];
    square_series(r->order, r->a, square);
    for (size_t k = 0; k <= r->order; k++)
        square[k] = scale(r->by->sign, square[k]);
    square[0] = add(br_point(r->by->constant), square[0]);
    if (r->by->root) {
        w[0] = br_interval_apply(BR_OP_SQRT, square, false);
        root(&(struct recurrence){r->order, square, NULL, w, NULL});
    }
    integral(r, r->by->root ? w : square, r->by->slope);
}

/* log a over log slope */
static void logarithm(const struct recurrence *r)
{
    const iv base = br_point(r->by->slope);
    integral(r, r->a, 1);
    for (size_t k = 1; k <= r->order && r->by->slope != 0; k++)
        r->out[k] = br_interval_divide(r->out[k], br_interval_apply(BR_OP_LOG, &base, false));
}

/* a^n, n = 2, 3 ...: by squares, so that a may be 0 */
static void whole_power_series(size_t order, const iv *a, double n, iv *out)
{
    iv square[BR_TREE_WORK], next[BR_TREE_WORK];
    const size_t size = (order + 1) * sizeof *a;
    bool begun = false;
    memcpy(square, a, size);
    for (; n >= 1; n = floor(n / 2)) {
        if (fmod(n, 2) == 1) {
            if (begun)
                product_series(order, out, square, next);
            memcpy(out, begun ? next : square, size);
            begun = true;
        }
        square_series(order, square, next);
        memcpy(square, next, size);
    }
}

static bool is_constant(size_t order, const iv *a)
{
    for (size_t k = 1; k <= order; k++)
        if (!br_is_zero(a[k]))
            return false;
    return br_is_point(a[0]);
}

/* exp(b log a) */
static void power_of_both(const struct recurrence *r)
{
    iv log_a[BR_TREE_WORK] = {br_interval_apply(BR_OP_LOG, r->a, false)}, exponent[BR_TREE_WORK];
    integral(&(struct recurrence){r->order, r->a, NULL, log_a, NULL}, r->a, 1);
    product_series(r->order, r->b, log_a, exponent);
    for (size_t k = 1; k <= r->order; k++)
        r->out[k] = convolve_slope(exponent, r->out, k, k);
}

static void power(const struct recurrence *r)
{
    const double n = r->b[0].low;
    if (!is_constant(r->order, r->b))
        power_of_both(r);
    else if (n == 0)
        memset(r->out, 0, (r->order + 1) * sizeof *r->out);
    else if (n > 0 && n == floor(n) && (n <= 4 || br_has_zero(r->a[0])))
        whole_power_series(r->order, r->a, n, r->out);
    else
        real_power_series(r, n);
}

static void copy(const struct recurrence *r, const iv *a, double sign)
{
    for (size_t k = 0; k <= r->order; k++)
        r->out[k] = scale(sign, a[k]);
}

/* a + sign b; a - a is 0 */
static void sum(const struct recurrence *r)
{
    for (size_t k = 1; k <= r->order; k++)
        r->out[k] = r->by->sign > 0 ? add(r->a[k], r->b[k])
                    : r->a == r->b  ? br_point(0)
                                    : br_interval_subtract(r->a[k], r->b[k]);
}

static void negative(const struct recurrence *r)
{
    copy(r, r->a, -1);
}

static void absolute(const struct recurrence *r)
{
    if (r->a[0].low >= 0 || r->a[0].high <= 0)
        copy(r, r->a, r->a[0].low >= 0 ? 1 : -1);
}

/* The one of both that is less (sign 1) or larger (sign -1), where that is decided. */
static void extreme(const struct recurrence *r)
{
    const iv difference = scale(r->by->sign, br_interval_subtract(r->a[0], r->b[0]));
    if (difference.high <= 0 || difference.low >= 0)
        copy(r, difference.high <= 0 ? r->a : r->b, 1);
}

/* Of what is constant between jumps: none where it may jump. */
static void decided(const struct recurrence *r)
{
    if (br_is_point(r->out[0]))
        memset(r->out + 1, 0, r->order * sizeof *r->out);
}

/* Those that are not here are decided, or chosen. */
static const struct rule rules[BR_OP_CHOOSE + 1] = {
    [BR_OP_NEGATE] = {negative},
    [BR_OP_SIN] = {flow, .sign = 1, .next = SLOPE, .slope = -1, .partner = BR_OP_COS},
    [BR_OP_COS] = {flow, .sign = -1, .next = SLOPE, .slope = 1, .partner = BR_OP_SIN},
    [BR_OP_TAN] = {flow, .sign = 1, .next = SQUARE, .slope = 1},
    [BR_OP_ASIN] = {inverse, .constant = 1, .sign = -1, .root = true, .slope = 1},
    [BR_OP_ACOS] = {inverse, .constant = 1, .sign = -1, .root = true, .slope = -1},
    [BR_OP_ATAN] = {inverse, .constant = 1, .sign = 1, .slope = 1},
    [BR_OP_SINH] = {flow, .sign = 1, .next = SLOPE, .slope = 1, .partner = BR_OP_COSH},
    [BR_OP_COSH] = {flow, .sign = 1, .next = SLOPE, .slope = 1, .partner = BR_OP_SINH},
    [BR_OP_TANH] = {flow, .sign = 1, .next = SQUARE, .slope = -1},
    [BR_OP_ASINH] = {inverse, .constant = 1, .sign = 1, .root = true, .slope = 1},
    [BR_OP_ACOSH] = {inverse, .constant = -1, .sign = 1, .root = true, .slope = 1},
    [BR_OP_ATANH] = {inverse, .constant = 1, .sign = -1, .slope = 1},
    [BR_OP_EXP] = {flow, .sign = 1, .partner = BR_OP_EXP},
    [BR_OP_EXPM1] = {flow, .sign = 1, .partner = BR_OP_EXP},
    [BR_OP_LOG] = {logarithm},
    [BR_OP_LOG2] = {logarithm, .slope = 2},
    [BR_OP_LOG10] = {logarithm, .slope = 10},
    [BR_OP_SQRT] = {root},
    [BR_OP_ABS] = {absolute},
    [BR_OP_ADD] = {sum, .sign = 1},
    [BR_OP_SUBTRACT] = {sum, .sign = -1},
    [BR_OP_MULTIPLY] = {product},
    [BR_OP_DIVIDE] = {quotient},
    [BR_OP_POW] = {power},
    [BR_OP_MIN] = {extreme, .sign = 1},
    [BR_OP_MAX] = {extreme, .sign = -1},
};

void br_series_apply(enum br_operation o, size_t order, const iv *const argument[3], iv *out)
{
    const struct recurrence r = {order, argument[0], argument[1], out, &rules[o]};
    const iv first[3] = {argument[0][0], argument[1][0], argument[2][0]};
    const iv value = br_interval_apply(o, first, argument[0] == argument[1]);
    out[0] = value;
    for (size_t k = 1; k <= order; k++)
        out[k] = br_no_interval;
    if (o == BR_OP_CHOOSE) {
        if (!br_has_zero(first[0]) || br_is_point(first[0])) /* none is neither */
            copy(&r, argument[br_has_zero(first[0]) ? 2 : 1], 1);
    } else if (!br_is_none(value)) {
        (r.by->series ? r.by->series : decided)(&r);
    }
    out[0] = value;
}
