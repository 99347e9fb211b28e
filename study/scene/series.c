/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Taylor coefficients of operations, by the recurrences of Moore: series of order + 1 intervals. */
#include "study/scene/enclosure.h"

#include <math.h>
#include <string.h>

#include "study/scene/elementary.h"

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

/* What the series of one operation are made of. Its own first coefficient is known, which a
 * recurrence may put another one in the place of; the others are none. */
struct recurrence {
    size_t order;
    const iv *a, *b;
    iv *out;
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
static void quotient_series(const struct recurrence *r)
{
    for (size_t k = 1; k <= r->order; k++) {
        const iv known = convolve(r->b, r->out, k, 1, k);
        r->out[k] = br_interval_divide(br_interval_subtract(r->a[k], known), r->b[0]);
    }
}

/* s s = a */
static void root_series(size_t order, const iv *a, iv *s)
{
    for (size_t k = 1; k <= order; k++)
        s[k] = br_interval_divide(br_interval_subtract(a[k], convolve(s, s, k, 1, k - 1)),
                                  scale(2, s[0]));
}

/* y' = a' y */
static void exponential_series(const struct recurrence *r)
{
    for (size_t k = 1; k <= r->order; k++)
        r->out[k] = convolve_slope(r->a, r->out, k, k);
}

/* y' = a' v, v = 1 + sign y^2: tan and tanh */
static void tangent_series(const struct recurrence *r, double sign)
{
    iv v[BR_TREE_WORK] = {add(br_point(1), scale(sign, square_at(r->out, 0)))};
    for (size_t k = 1; k <= r->order; k++) {
        r->out[k] = convolve_slope(r->a, v, k, k);
        v[k] = scale(sign, square_at(r->out, k));
    }
}

/* y' = a' z, z' = sign a' y: sin and cos, sinh and cosh. The partner's first is apply's, too. */
static void pair_series(const struct recurrence *r, enum br_operation partner, double y_sign,
                        double z_sign)
{
    iv z[BR_TREE_WORK] = {br_interval_apply(partner, r->a, false)};
    for (size_t k = 1; k <= r->order; k++) {
        r->out[k] = scale(y_sign, convolve_slope(r->a, z, k, k));
        z[k] = scale(z_sign, convolve_slope(r->a, r->out, k, k));
    }
}

/* w y' = sign a' */
static void integral_series(const struct recurrence *r, const iv *w, double sign)
{
    for (size_t k = 1; k <= r->order; k++) {
        const iv known = convolve_slope(r->out, w, k, k - 1);
        r->out[k] = br_interval_divide(br_interval_subtract(scale(sign, r->a[k]), known), w[0]);
    }
}

/* w = constant + sign a^2 or its root: for the inverse functions */
static void inverse_series(const struct recurrence *r, double constant, double sign, bool root,
                           double slope)
{
    iv square[BR_TREE_WORK], w[BR_TREE_WORK];
    square_series(r->order, r->a, square);
    for (size_t k = 0; k <= r->order; k++)
        square[k] = scale(sign, square[k]);
    square[0] = add(br_point(constant), square[0]);
    w[0] = root ? br_interval_apply(BR_OP_SQRT, square, false) : square[0];
    if (root)
        root_series(r->order, square, w);
    integral_series(r, root ? w : square, slope);
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

static bool is_constant(size_t order, const iv *a)
{
    for (size_t k = 1; k <= order; k++)
        if (a[k].low != 0 || a[k].high != 0)
            return false;
    return br_is_point(a[0]);
}

/* exp(b log a) */
static void power_of_both(const struct recurrence *r)
{
    iv logarithm[BR_TREE_WORK] = {br_interval_apply(BR_OP_LOG, r->a, false)},
       exponent[BR_TREE_WORK];
    integral_series(&(struct recurrence){r->order, r->a, NULL, logarithm}, r->a, 1);
    product_series(r->order, r->b, logarithm, exponent);
    exponential_series(&(struct recurrence){r->order, exponent, NULL, r->out});
}

static void power_series(const struct recurrence *r)
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

static void copy_series(size_t order, const iv *a, double sign, iv *out)
{
    for (size_t k = 0; k <= order; k++)
        out[k] = scale(sign, a[k]);
}

/* Of what compares: constant where that is decided, else none. */
static void decided_series(const struct recurrence *r)
{
    if (br_is_point(r->out[0]))
        memset(r->out + 1, 0, r->order * sizeof *r->out);
}

/* The one of both that is less (sign 1) or larger (sign -1), where that is decided. */
static void extreme_series(const struct recurrence *r, double sign)
{
    const iv difference = scale(sign, br_interval_subtract(r->a[0], r->b[0]));
    if (difference.high <= 0 || difference.low >= 0)
        copy_series(r->order, difference.high <= 0 ? r->a : r->b, 1, r->out);
}

/* log a over log unit */
static void logarithm_series(const struct recurrence *r, double unit)
{
    const iv base = br_point(unit);
    integral_series(r, r->a, 1);
    for (size_t k = 1; k <= r->order; k++)
        r->out[k] = br_interval_divide(r->out[k], br_interval_apply(BR_OP_LOG, &base, false));
}

static void unary_series(enum br_operation o, const struct recurrence *r)
{
    switch (o) {
    case BR_OP_NEGATE:
        return copy_series(r->order, r->a, -1, r->out);
    case BR_OP_SIN:
        return pair_series(r, BR_OP_COS, 1, -1);
    case BR_OP_COS:
        return pair_series(r, BR_OP_SIN, -1, 1);
    case BR_OP_TAN:
        return tangent_series(r, 1);
    case BR_OP_ASIN:
        return inverse_series(r, 1, -1, true, 1);
    case BR_OP_ACOS:
        return inverse_series(r, 1, -1, true, -1);
    case BR_OP_ATAN:
        return inverse_series(r, 1, 1, false, 1);
    case BR_OP_SINH:
        return pair_series(r, BR_OP_COSH, 1, 1);
    case BR_OP_COSH:
        return pair_series(r, BR_OP_SINH, 1, 1);
    case BR_OP_TANH:
        return tangent_series(r, -1);
    case BR_OP_ASINH:
        return inverse_series(r, 1, 1, true, 1);
    case BR_OP_ACOSH:
        return inverse_series(r, -1, 1, true, 1);
    case BR_OP_ATANH:
        return inverse_series(r, 1, -1, false, 1);
    case BR_OP_EXP:
        return exponential_series(r);
    case BR_OP_EXPM1: /* exp but for its first coefficient */
        r->out[0] = br_interval_apply(BR_OP_EXP, r->a, false);
        return exponential_series(r);
    case BR_OP_LOG:
        return integral_series(r, r->a, 1);
    case BR_OP_LOG2:
        return logarithm_series(r, 2);
    case BR_OP_LOG10:
        return logarithm_series(r, 10);
    case BR_OP_SQRT:
        return root_series(r->order, r->a, r->out);
    case BR_OP_ABS:
        if (r->a[0].low >= 0 || r->a[0].high <= 0)
            copy_series(r->order, r->a, r->a[0].low >= 0 ? 1 : -1, r->out);
        return;
    default:
        return decided_series(r);
    }
}

static void binary_series(enum br_operation o, const struct recurrence *r)
{
    switch (o) {
    case BR_OP_ADD:
        for (size_t k = 1; k <= r->order; k++)
            r->out[k] = add(r->a[k], r->b[k]);
        break;
    case BR_OP_SUBTRACT:
        for (size_t k = 1; k <= r->order; k++)
            r->out[k] = r->a == r->b ? br_point(0) : br_interval_subtract(r->a[k], r->b[k]);
        break;
    case BR_OP_MULTIPLY:
        return product_series(r->order, r->a, r->b, r->out);
    case BR_OP_DIVIDE:
        return quotient_series(r);
    case BR_OP_POW:
        return power_series(r);
    case BR_OP_MIN:
        return extreme_series(r, 1);
    case BR_OP_MAX:
        return extreme_series(r, -1);
    default:
        return decided_series(r);
    }
}

void br_series_apply(enum br_operation o, size_t order, const iv *const argument[3], iv *out)
{
    const struct recurrence r = {order, argument[0], argument[1], out};
    const iv first[3] = {argument[0][0], argument[1][0], argument[2][0]};
    const iv value = br_interval_apply(o, first, argument[0] == argument[1]);
    out[0] = value;
    for (size_t k = 1; k <= order; k++)
        out[k] = br_no_interval;
    if (o == BR_OP_CHOOSE) {
        if (!br_has_zero(first[0]) || br_is_point(first[0])) /* none is neither */
            copy_series(order, argument[br_has_zero(first[0]) ? 2 : 1], 1, out);
    } else if (!br_is_none(value)) {
        (br_operation_arguments(o) == 1 ? unary_series : binary_series)(o, &r);
    }
    out[0] = value;
}
