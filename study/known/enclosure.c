/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Taylor coefficients of operations by Moore's recurrences, and with them Taylor coefficients and
 * bounds of a tree over a box. */
#include "study/known/operations.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* ---- series of order + 1 intervals ---- */

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
    return br_interval_multiply(point(factor), a);
}

struct rule;

/* The input and output of one recurrence. out[0] is the known value of the operation, and the other
 * coefficients start as none. A recurrence may overwrite out[0]; `apply` restores it. */
struct recurrence {
    size_t order;
    const iv *a, *b;
    iv *out;
    const struct rule *by; /* of the operation; NULL: not needed */
};

/* The recurrence of an operation, and its parameters. */
struct rule {
    void (*series)(const struct recurrence *r);
    double sign;
    double constant, slope; /* of an inverse function; slope: of a logarithm its base */
    enum { ITSELF, SQUARE, SLOPE } next; /* of a flow: how its second series is made */
    bool root;                           /* of an inverse function: take the square root */
    enum br_operation partner;           /* its value begins the second series */
};

/* sum of a_j b_(k-j), j = from .. to */
static iv convolve(const iv *a, const iv *b, size_t k, size_t from, size_t to)
{
    iv sum = {0, 0};
    for (size_t j = from; j <= to; j++)
        sum = add(sum, multiply(a[j], b[k - j]));
    return sum;
}

/* sum of j a_j b_(k-j), j = 1 .. to, divided by k */
static iv convolve_slope(const iv *a, const iv *b, size_t k, size_t to)
{
    iv sum = {0, 0};
    for (size_t j = 1; j <= to; j++)
        sum = add(sum, scale((double)j, multiply(a[j], b[k - j])));
    return br_interval_divide(sum, point((double)k));
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

/* y' = sign a' v, where v is y (exp) or 1 + slope y^2 (tan and tanh), or solves v' = slope a' y
 * (sin and cos, sinh and cosh) */
static void flow(const struct recurrence *r)
{
    const struct rule *by = r->by;
    iv v[BR_TREE_WORK] = {by->next == SQUARE ? add(point(1), scale(by->slope, square_at(r->out, 0)))
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
            const iv factor =
                br_interval_subtract(multiply(point(n), point((double)j)), point((double)(k - j)));
            sum = add(sum, multiply(factor, multiply(r->a[j], r->out[k - j])));
        }
        r->out[k] = br_interval_divide(sum, scale((double)k, r->a[0]));
    }
}

/* s s = a; gives tighter intervals than a power */
static void root(const struct recurrence *r)
{
    iv *s = r->out;
    for (size_t k = 1; k <= r->order; k++)
        s[k] = br_interval_divide(br_interval_subtract(r->a[k], convolve(s, s, k, 1, k - 1)),
                                  scale(2, s[0]));
}

/* w y' = sign a' */
static void integral(const struct recurrence *r, const iv *w, double sign)
{
    for (size_t k = 1; k <= r->order; k++) {
        const iv known = convolve_slope(r->out, w, k, k - 1);
        r->out[k] = br_interval_divide(br_interval_subtract(scale(sign, r->a[k]), known), w[0]);
    }
}

/* w y' = slope a', where w is constant + sign a^2 or its square root */
static void inverse(const struct recurrence *r)
{
    iv square[BR_TREE_WORK], w[BR_TREE_WORK];
    square_series(r->order, r->a, square);
    for (size_t k = 0; k <= r->order; k++)
        square[k] = scale(r->by->sign, square[k]);
    square[0] = add(point(r->by->constant), square[0]);
    if (r->by->root) {
        w[0] = br_interval_apply(BR_OP_SQRT, square, false);
        root(&(struct recurrence){r->order, square, NULL, w, NULL});
    }
    integral(r, r->by->root ? w : square, r->by->slope);
}

/* log(a) / log(slope); slope 0: log(a) */
static void logarithm(const struct recurrence *r)
{
    const iv base = point(r->by->slope);
    integral(r, r->a, 1);
    for (size_t k = 1; k <= r->order && r->by->slope != 0; k++)
        r->out[k] = br_interval_divide(r->out[k], br_interval_apply(BR_OP_LOG, &base, false));
}

/* a^n, n = 2, 3 ...: by repeated squares, so that a may be 0 */
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
                    : r->a == r->b  ? point(0)
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

/* The smaller (sign 1) or larger (sign -1) argument, if the intervals decide which. */
static void extreme(const struct recurrence *r)
{
    const iv difference = scale(r->by->sign, br_interval_subtract(r->a[0], r->b[0]));
    if (difference.high <= 0 || difference.low >= 0)
        copy(r, difference.high <= 0 ? r->a : r->b, 1);
}

/* Of operations that are constant between jumps; stays none where there may be a jump. */
static void decided(const struct recurrence *r)
{
    if (br_is_point(r->out[0]))
        memset(r->out + 1, 0, r->order * sizeof *r->out);
}

/* Operations without a row use `decided`, except ?:, which `apply` handles. */
static const struct rule rules[BR_OP_CHOOSE + 1] = {
    [BR_OP_NEGATE] = {.series = negative},
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
    [BR_OP_LOG] = {.series = logarithm},
    [BR_OP_LOG2] = {logarithm, .slope = 2},
    [BR_OP_LOG10] = {logarithm, .slope = 10},
    [BR_OP_SQRT] = {.series = root},
    [BR_OP_ABS] = {.series = absolute},
    [BR_OP_ADD] = {sum, .sign = 1},
    [BR_OP_SUBTRACT] = {sum, .sign = -1},
    [BR_OP_MULTIPLY] = {.series = product},
    [BR_OP_DIVIDE] = {.series = quotient},
    [BR_OP_POW] = {.series = power},
    [BR_OP_MIN] = {extreme, .sign = 1},
    [BR_OP_MAX] = {extreme, .sign = -1},
};

/* The Taylor coefficients of an operation, order + 1 of them (out), from those of its arguments. */
static void apply(enum br_operation o, size_t order, const iv *const argument[3], iv *out)
{
    const struct recurrence r = {order, argument[0], argument[1], out, &rules[o]};
    const iv first[3] = {argument[0][0], argument[1][0], argument[2][0]};
    const iv value = br_interval_apply(o, first, argument[0] == argument[1]);
    out[0] = value;
    for (size_t k = 1; k <= order; k++)
        out[k] = br_no_interval;
    if (o == BR_OP_CHOOSE) {
        if (!br_has_zero(first[0]) || br_is_point(first[0])) /* decided */
            copy(&r, argument[br_has_zero(first[0]) ? 2 : 1], 1);
    } else if (!br_is_none(value)) {
        (r.by->series ? r.by->series : decided)(&r);
    }
    out[0] = value;
}

/* ---- Taylor coefficients of a tree ---- */

static iv variable_of(const struct br_node *n, struct br_box box)
{
    return n->operation == BR_OP_NUMBER ? point(n->number)
           : n->operation == BR_OP_X    ? box.x
                                        : box.t;
}

bool br_tree_taylor(const struct br_tree *tree, iv *work, enum br_variable along, struct br_box box,
                    size_t order, iv *coefficient)
{
    const enum br_operation variable = along == BR_X ? BR_OP_X : BR_OP_T;
    const size_t size = order + 1;
    const int rounding = br_round_to_nearest();
    for (size_t i = 0; i < tree->count; i++) {
        const struct br_node *n = &tree->node[i];
        iv *out = work + i * size;
        if (br_operations[n->operation].arguments) {
            const iv *const argument[] = {work + n->argument[0] * size,
                                          work + n->argument[1] * size,
                                          work + n->argument[2] * size};
            apply(n->operation, order, argument, out);
            continue;
        }
        out[0] = variable_of(n, box);
        for (size_t k = 1; k <= order; k++)
            out[k] = point(k == 1 && n->operation == variable);
    }
    br_round_as_before(rounding);
    memcpy(coefficient, work + (tree->count - 1) * size, size * sizeof *coefficient);
    bool finite = true;
    for (size_t k = 0; k <= order; k++)
        finite &= br_is_finite(coefficient[k]);
    return finite;
}

/* ---- bounds ---- */

/* A node over a box: its range, its value at the centre of the box, and its derivatives with
 * respect to x and t over the box. Where a derivative jumps, its interval covers both sides.
 * slope[ERROR] bounds the error of evaluation, which propagates as a derivative does. */
enum { ERROR = 2, DIRECTIONS };
struct form {
    iv range, centre, slope[DIRECTIONS];
};

_Static_assert(sizeof(struct form) <= BR_TREE_WORK * sizeof(iv), "the workspace of a node");

/* The derivative in a direction, by the first Taylor coefficient. */
static iv slope_of(enum br_operation o, const struct form *const argument[3], int direction)
{
    iv series[3][2], out[2];
    bool constant = true;
    for (unsigned k = 0; k < 3; k++) {
        series[k][0] = argument[k]->range;
        series[k][1] = argument[k]->slope[direction];
        constant &= k >= br_operations[o].arguments || br_is_zero(series[k][1]);
    }
    if (constant)
        return point(0);
    if (o == BR_OP_ABS && br_has_zero(series[0][0]))
        return br_interval_multiply((iv){-1, 1}, series[0][1]);
    if ((o == BR_OP_MIN || o == BR_OP_MAX) &&
        br_has_zero(br_interval_subtract(series[0][0], series[1][0])))
        return br_interval_hull(series[0][1], series[1][1]);
    apply(o, 1, (const iv *const[]){series[0], series[1], series[2]}, out);
    return out[1];
}

static void differentiate(enum br_operation o, const struct form *const argument[3], struct form *f)
{
    const bool exact = o == BR_OP_NEGATE || o == BR_OP_ABS || o == BR_OP_MIN || o == BR_OP_MAX ||
                       o == BR_OP_CHOOSE;
    for (int direction = 0; direction < DIRECTIONS; direction++)
        f->slope[direction] = slope_of(o, argument, direction);
    if (exact)
        return;
    /* 2.5 units in the last place, and the rounding of these sums */
    const double error = magnitude(f->slope[ERROR]) * (1 + 8 * DBL_EPSILON) +
                         3 * DBL_EPSILON * magnitude(f->range) + 8 * 0x1p-1074;
    f->slope[ERROR] = (iv){-error, error};
}

/* Intersects the range with centre + slopes * (box - middle) +- error. */
static void cut(struct br_box box, struct br_box middle, struct form *f)
{
    const iv along_x = br_interval_multiply(f->slope[0], br_interval_subtract(box.x, middle.x));
    const iv along_t = br_interval_multiply(f->slope[1], br_interval_subtract(box.t, middle.t));
    const iv mean = br_interval_add(br_interval_add(f->centre, along_x),
                                    br_interval_add(along_t, f->slope[ERROR]));
    if (!br_is_finite(mean) || mean.low > f->range.high || mean.high < f->range.low)
        return;
    f->range = (iv){fmax(f->range.low, mean.low), fmin(f->range.high, mean.high)};
}

static bool are_equal(const struct br_node *n)
{
    return br_operations[n->operation].arguments == 2 && n->argument[0] == n->argument[1];
}

static void bound_node(const struct br_node *n, const struct form *forms, bool wide,
                       struct br_box box, struct br_box middle, struct form *f)
{
    const struct form *const argument[] = {&forms[n->argument[0]], &forms[n->argument[1]],
                                           &forms[n->argument[2]]};
    iv range[3], centre[3];
    for (unsigned k = 0; k < 3; k++) {
        range[k] = argument[k]->range;
        centre[k] = argument[k]->centre;
    }
    f->range = br_interval_apply(n->operation, range, are_equal(n));
    if (!wide)
        return;
    f->centre = br_interval_apply(n->operation, centre, are_equal(n));
    differentiate(n->operation, argument, f);
    if (br_is_finite(f->range) && !br_is_point(f->range))
        cut(box, middle, f);
}

bool br_tree_bound(const struct br_tree *tree, iv *work, struct br_box box, iv *value)
{
    struct form *forms = (struct form *)work;
    const int rounding = br_round_to_nearest();
    const struct br_box centre = {point(middle(box.x)), point(middle(box.t))};
    const bool wide = !br_is_point(box.x) || !br_is_point(box.t);
    for (size_t i = 0; i < tree->count; i++) {
        const struct br_node *n = &tree->node[i];
        struct form *f = &forms[i];
        if (br_operations[n->operation].arguments)
            bound_node(n, forms, wide, box, centre, f);
        else
            *f = (struct form){
                .range = variable_of(n, box),
                .centre = variable_of(n, centre),
                .slope = {point(n->operation == BR_OP_X), point(n->operation == BR_OP_T)}};
    }
    br_round_as_before(rounding);
    *value = forms[tree->count - 1].range;
    return br_is_finite(*value);
}
