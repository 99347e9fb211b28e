/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/known/operations.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

const iv br_no_interval = {NAN, NAN};
static const iv all_signs = {-1, 1}, either = {0, 1};

/* ---- rounding outward ---- */

/* The next double above a; after -infinity the lowest finite one. */
static double next_up(double a)
{
    if (a == 0)
        return 0x1p-1074;
    if (isnan(a) || a == INFINITY)
        return a;
    uint64_t bits;
    memcpy(&bits, &a, sizeof bits);
    bits += a > 0 ? 1 : (uint64_t)-1;
    memcpy(&a, &bits, sizeof bits);
    return a;
}

static double next_down(double a)
{
    return -next_up(-a);
}

/* Lowers a value by some neighbours, but not through zero: its sign is right. */
static double lower(double a, int neighbours)
{
    const bool positive = !signbit(a);
    for (int i = 0; i < neighbours && !(positive && a == 0); i++)
        a = next_down(a);
    return a;
}

static double upper(double a, int neighbours)
{
    return -lower(-a, neighbours);
}

/* ---- arithmetic ---- */

/* Whether s = a + b without error (Knuth). */
static bool is_sum(double s, double a, double b)
{
    const double other = s - a;
    return (a - (s - other)) + (b - other) == 0;
}

/* Whether p = a b without error; underflow counts as an error. */
static bool is_product(double p, double a, double b)
{
    return a == 0 || b == 0 || (fabs(p) > 1e-290 && fma(a, b, -p) == 0);
}

iv br_interval_add(iv a, iv b)
{
    const double low = a.low + b.low, high = a.high + b.high;
    if (br_is_none(a) || br_is_none(b) || a.low + b.high != a.low + b.high ||
        a.high + b.low != a.high + b.low)
        return br_no_interval; /* also for infinity minus infinity */
    return (iv){is_sum(low, a.low, b.low) ? low : next_down(low),
                is_sum(high, a.high, b.high) ? high : next_up(high)};
}

static iv negate(iv a)
{
    return (iv){-a.high, -a.low};
}

iv br_interval_subtract(iv a, iv b)
{
    return br_interval_add(a, negate(b));
}

/* Errors in units in the last place: at most 2 of the C library's functions, 1 of SLEEF's, and 1
 * more where the exponent changes. */
enum { NEIGHBOURS = 4 };

/* *value (out): a * b, a / b or a ^ b of two ends. Returns by how many neighbours it may be off. */
static inline int at_corner(enum br_operation o, double a, double b, double *value)
{
    if (o == BR_OP_MULTIPLY) {
        *value = a * b;
        return !is_product(*value, a, b);
    }
    if (o == BR_OP_DIVIDE) {
        *value = a / b;
        return !(a == 0 || (fabs(a) > 1e-290 && *value != 0 && is_product(a, *value, b)));
    }
    *value = pow(a, b);
    return a == 0 || a == 1 || b == 0 || b == 1 ? 0 : NEIGHBOURS;
}

/* For an operation whose values lie between its values at the four pairs of ends. */
static inline iv hull_of_corners(enum br_operation o, iv a, iv b)
{
    iv out = {INFINITY, -INFINITY};
    for (int i = 0; i < 4; i++) {
        double value;
        const int off = at_corner(o, i < 2 ? a.low : a.high, i % 2 ? b.high : b.low, &value);
        out.low = fmin(out.low, off ? lower(value, off) : value);
        out.high = fmax(out.high, off ? upper(value, off) : value);
    }
    return out;
}

iv br_interval_multiply(iv a, iv b)
{
    if (br_is_none(a) || br_is_none(b) || (br_has_zero(a) && !br_is_finite(b)) ||
        (br_has_zero(b) && !br_is_finite(a)))
        return br_no_interval;
    return hull_of_corners(BR_OP_MULTIPLY, a, b);
}

iv br_interval_divide(iv a, iv b)
{
    if (br_is_none(a) || br_is_none(b) || br_has_zero(b) || !(br_is_finite(a) || br_is_finite(b)))
        return br_no_interval;
    return hull_of_corners(BR_OP_DIVIDE, a, b);
}

iv br_interval_square(iv a)
{
    const double most = magnitude(a), least = br_has_zero(a) ? 0 : fmin(fabs(a.low), fabs(a.high));
    const double low = least * least, high = most * most;
    if (br_is_none(a))
        return a;
    return (iv){is_product(low, least, least) ? low : lower(low, 1),
                is_product(high, most, most) ? high : upper(high, 1)};
}

iv br_interval_hull(iv a, iv b)
{
    return br_is_none(a) || br_is_none(b) ? br_no_interval
                                          : (iv){fmin(a.low, b.low), fmax(a.high, b.high)};
}

/* ---- elementary functions ---- */

/* Functions that increase, or decrease, on their whole domain. */
static const struct monotone {
    double (*f)(double);
    double from, to; /* the domain; `open`: without its ends */
    bool open, falls;
    double exact_at; /* the argument at which the value is exactly 0 or 1 */
    double least, most;
} monotone[] = {
#define EVERYWHERE -INFINITY, INFINITY
    [BR_OP_ASIN] = {asin, -1, 1, false, false, 0, EVERYWHERE},
    [BR_OP_ACOS] = {acos, -1, 1, false, true, 1, EVERYWHERE},
    [BR_OP_ATAN] = {atan, EVERYWHERE, false, false, 0, EVERYWHERE},
    [BR_OP_SINH] = {sinh, EVERYWHERE, false, false, 0, EVERYWHERE},
    [BR_OP_COSH] = {cosh, EVERYWHERE, false, false, 0, 1 - DBL_EPSILON, INFINITY}, /* of |a| */
    [BR_OP_TANH] = {tanh, EVERYWHERE, false, false, 0, -1, 1},
    [BR_OP_ASINH] = {asinh, EVERYWHERE, false, false, 0, EVERYWHERE},
    [BR_OP_ACOSH] = {acosh, 1, INFINITY, false, false, 1, EVERYWHERE},
    [BR_OP_ATANH] = {atanh, -1, 1, true, false, 0, EVERYWHERE},
    [BR_OP_EXP] = {exp, EVERYWHERE, false, false, 0, EVERYWHERE},
    [BR_OP_EXPM1] = {expm1, EVERYWHERE, false, false, 0, -1, INFINITY},
    [BR_OP_LOG] = {log, 0, INFINITY, true, false, 1, EVERYWHERE},
    [BR_OP_LOG2] = {log2, 0, INFINITY, true, false, 1, EVERYWHERE},
    [BR_OP_LOG10] = {log10, 0, INFINITY, true, false, 1, EVERYWHERE},
};

static iv increasing(double (*f)(double), iv a, double exact_at)
{
    const double low = f(a.low), high = f(a.high);
    return (iv){a.low == exact_at ? low : lower(low, NEIGHBOURS),
                a.high == exact_at ? high : upper(high, NEIGHBOURS)};
}

static iv clip(iv a, double low, double high)
{
    return (iv){fmax(a.low, low), fmin(a.high, high)};
}

/* An infinite end always belongs to the domain: the function has a limit there or grows. */
static iv value_of(const struct monotone *m, iv a)
{
    const bool left = m->open && isfinite(m->from) ? a.low > m->from : a.low >= m->from;
    const bool right = m->open && isfinite(m->to) ? a.high < m->to : a.high <= m->to;
    if (!left || !right)
        return br_no_interval;
    const iv ends = m->falls ? (iv){a.high, a.low} : a;
    return clip(increasing(m->f, ends, m->exact_at), m->least, m->most);
}

/* Whether phase + k period may be in a, for an integer k. */
static bool has_phase(iv a, double phase, double period)
{
    const double slack = 4 * DBL_EPSILON * (magnitude(a) + 1);
    const double k = ceil((a.low - slack - phase) / period);
    return phase + k * period <= a.high + slack;
}

/* sin or cos, which is 1 at `top` and -1 half a period later. */
static iv wave(double (*f)(double), iv a, double top)
{
    if (!br_is_finite(a))
        return br_no_interval;
    if (magnitude(a) > 1e14 || a.high - a.low >= 2 * M_PI)
        return all_signs;
    const iv ends =
        br_interval_hull(increasing(f, point(a.low), 0), increasing(f, point(a.high), 0));
    return clip((iv){has_phase(a, top + M_PI, 2 * M_PI) ? -1 : ends.low,
                     has_phase(a, top, 2 * M_PI) ? 1 : ends.high},
                -1, 1);
}

static iv tangent(iv a)
{
    const bool pole = !br_is_finite(a) || magnitude(a) > 1e14 || a.high - a.low >= M_PI ||
                      has_phase(a, M_PI / 2, M_PI);
    return pole ? br_no_interval : increasing(tan, a, 0);
}

static iv absolute(iv a)
{
    return br_has_zero(a) ? (iv){0, magnitude(a)} : a.low > 0 ? a : negate(a);
}

/* ---- powers ---- */

static iv positive_power(iv a, iv b)
{
    return hull_of_corners(BR_OP_POW, a, b);
}

static iv whole_power(iv a, double n)
{
    if (n == 0)
        return point(1);
    if (n < 0 && br_has_zero(a))
        return br_no_interval;
    if (n == 2)
        return br_interval_square(a);
    if (fmod(n, 2) == 0 || a.low >= 0)
        return positive_power(absolute(a), point(n));
    if (a.high <= 0)
        return negate(positive_power(negate(a), point(n)));
    return (iv){-positive_power(point(-a.low), point(n)).high,
                positive_power(point(a.high), point(n)).high};
}

static iv power(iv a, iv b)
{
    if (!br_is_finite(a) || !br_is_finite(b))
        return br_no_interval;
    if (br_is_point(b) && trunc(b.low) == b.low)
        return whole_power(a, b.low);
    return a.low > 0 || (a.low == 0 && b.low >= 0) ? positive_power(a, b) : br_no_interval;
}

/* ---- truth values ---- */

static iv truth(bool certain, bool impossible)
{
    return certain ? point(1) : impossible ? point(0) : either;
}

static iv choose(iv condition, iv yes, iv no)
{
    if (br_is_none(condition))
        return br_no_interval;
    return !br_has_zero(condition) ? yes : br_is_point(condition) ? no : br_interval_hull(yes, no);
}

/* ---- all ---- */

static iv unary(enum br_operation o, iv a)
{
    switch (o) {
    case BR_OP_NEGATE:
        return negate(a);
    case BR_OP_NOT:
        return truth(br_is_zero(a), !br_has_zero(a));
    case BR_OP_SIN:
        return wave(sin, a, M_PI / 2);
    case BR_OP_COS:
        return wave(cos, a, 0);
    case BR_OP_TAN:
        return tangent(a);
    case BR_OP_SQRT:
        return a.low >= 0 ? (iv){lower(sqrt(a.low), 1), upper(sqrt(a.high), a.high != 0)}
                          : br_no_interval;
    case BR_OP_ABS:
        return absolute(a);
    case BR_OP_SIGN:
        return (iv){a.low > 0 ? 1 : a.low < 0 ? -1 : 0, a.high > 0 ? 1 : a.high < 0 ? -1 : 0};
    case BR_OP_STEP:
        return truth(a.low >= 0, a.high < 0);
    default:
        return value_of(&monotone[o], o == BR_OP_COSH ? absolute(a) : a);
    }
}

static iv binary(enum br_operation o, iv a, iv b, bool same)
{
    switch (o) {
    case BR_OP_ADD:
        return br_interval_add(a, b);
    case BR_OP_SUBTRACT:
        return same && br_is_finite(a) ? point(0) : br_interval_subtract(a, b);
    case BR_OP_MULTIPLY:
        return same ? br_interval_square(a) : br_interval_multiply(a, b);
    case BR_OP_DIVIDE:
        return same && br_is_finite(a) && !br_has_zero(a) ? point(1) : br_interval_divide(a, b);
    case BR_OP_POW:
        return power(a, b);
    case BR_OP_MIN:
        return (iv){fmin(a.low, b.low), fmin(a.high, b.high)};
    case BR_OP_MAX:
        return (iv){fmax(a.low, b.low), fmax(a.high, b.high)};
    case BR_OP_LESS:
        return truth(a.high < b.low && !same, a.low >= b.high || same);
    case BR_OP_LESS_EQUAL:
        return truth(a.high <= b.low || same, a.low > b.high && !same);
    case BR_OP_EQUAL:
        return truth((br_is_point(a) && br_is_point(b) && a.low == b.low) || same,
                     a.high < b.low || a.low > b.high);
    case BR_OP_AND:
        return truth(!br_has_zero(a) && !br_has_zero(b), br_is_zero(a) || br_is_zero(b));
    default: /* or */
        return truth(!br_has_zero(a) || !br_has_zero(b), br_is_zero(a) && br_is_zero(b));
    }
}

iv br_interval_apply(enum br_operation o, const iv *a, bool same)
{
    if (o == BR_OP_CHOOSE)
        return choose(a[0], a[1], a[2]);
    const unsigned arguments = br_operations[o].arguments;
    for (unsigned i = 0; i < arguments; i++)
        if (br_is_none(a[i]))
            return br_no_interval;
    return arguments == 1 ? unary(o, a[0]) : binary(o, a[0], a[1], same);
}
