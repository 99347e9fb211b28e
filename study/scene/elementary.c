/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/scene/elementary.h"

#include <fenv.h>
#include <math.h>

#define ROW(set) &br_elementary_##set,
const struct br_elementary *const br_elementary_all[] = {BR_INSTRUCTION_SETS(ROW) NULL};

const struct br_elementary *br_elementary_best(void)
{
    const struct br_elementary *const *set = br_elementary_all;
    while (!(*set)->available())
        set++;
    return *set;
}

/* ---- powers ---- */

static bool is_small_power(double b)
{
    return b == 1 || b == 2 || b == 3 || b == 4 || b == -1;
}

static double small_power(double a, double b)
{
    if (b == -1)
        return 1 / a;
    return b == 1 ? a : b == 2 ? a * a : b == 3 ? a * a * a : (a * a) * (a * a);
}

static void power(const struct br_elementary *set, size_t count, const double *a, const double *b,
                  double *out)
{
    bool small = true; /* all of them */
    for (size_t i = 0; i < count && small; i++)
        small = is_small_power(b[i]);
    if (!small)
        set->apply(BR_OP_POW, count, a, b, out);
    for (size_t i = 0; i < count; i++)
        if (is_small_power(b[i]))
            out[i] = small_power(a[i], b[i]);
}

/* ---- where SLEEF gives up before the doubles do ---- */

static void mend(enum br_operation operation, size_t count, const double *a, double *out)
{
    const bool grows = operation == BR_OP_SINH || operation == BR_OP_COSH;
    for (size_t i = 0; i < count; i++) {
        if (fabs(a[i]) <= (grows ? 709 : 1e150))
            continue;
        out[i] = operation == BR_OP_SINH    ? sinh(a[i])
                 : operation == BR_OP_COSH  ? cosh(a[i])
                 : operation == BR_OP_ASINH ? asinh(a[i])
                                            : acosh(a[i]);
    }
}

/* ---- all operations ---- */

#define LOOP(operation, value)             \
    case operation:                        \
        for (size_t i = 0; i < count; i++) \
            out[i] = (value);              \
        break;

/* A truth of two numbers. */
#define TRUTH(operation, truth) LOOP(operation, isunordered(a[i], b[i]) ? NAN : (double)(truth))

void br_operation_apply(const struct br_elementary *set, enum br_operation operation, size_t count,
                        const double *const argument[3], double *out)
{
    const double *const a = argument[0], *const b = argument[1], *const c = argument[2];
    switch (operation) {
        LOOP(BR_OP_NEGATE, -a[i])
        LOOP(BR_OP_NOT, isnan(a[i]) ? NAN : (double)(a[i] == 0))
        LOOP(BR_OP_SQRT, sqrt(a[i]))
        LOOP(BR_OP_ABS, fabs(a[i]))
        LOOP(BR_OP_SIGN, a[i] > 0 ? 1 : a[i] < 0 ? -1 : a[i])
        LOOP(BR_OP_STEP, a[i] >= 0 ? 1 : a[i] < 0 ? 0 : NAN)
        LOOP(BR_OP_ADD, a[i] + b[i])
        LOOP(BR_OP_SUBTRACT, a[i] - b[i])
        LOOP(BR_OP_MULTIPLY, a[i] * b[i])
        LOOP(BR_OP_DIVIDE, a[i] / b[i])
        LOOP(BR_OP_MIN, isnan(a[i]) || a[i] < b[i] ? a[i] : b[i])
        LOOP(BR_OP_MAX, isnan(a[i]) || a[i] > b[i] ? a[i] : b[i])
        TRUTH(BR_OP_LESS, a[i] < b[i])
        TRUTH(BR_OP_LESS_EQUAL, a[i] <= b[i])
        TRUTH(BR_OP_GREATER, a[i] > b[i])
        TRUTH(BR_OP_GREATER_EQUAL, a[i] >= b[i])
        TRUTH(BR_OP_EQUAL, a[i] == b[i])
        TRUTH(BR_OP_NOT_EQUAL, a[i] != b[i])
        TRUTH(BR_OP_AND, a[i] != 0 && b[i] != 0)
        TRUTH(BR_OP_OR, a[i] != 0 || b[i] != 0)
        LOOP(BR_OP_CHOOSE, isnan(a[i]) ? NAN : a[i] != 0 ? b[i] : c[i])
    case BR_OP_POW:
        power(set, count, a, b, out);
        break;
    default:
        set->apply(operation, count, a, b, out);
        if (operation == BR_OP_SINH || operation == BR_OP_COSH || operation == BR_OP_ASINH ||
            operation == BR_OP_ACOSH)
            mend(operation, count, a, out);
    }
}

double br_operation_value(enum br_operation operation, double a, double b, double c)
{
    enum { MOST_WIDTH = 8 };
    _Alignas(64) double value[4][MOST_WIDTH];
    for (size_t i = 0; i < MOST_WIDTH; i++) {
        value[0][i] = a;
        value[1][i] = b;
        value[2][i] = c;
    }
    const struct br_elementary *set = br_elementary_best();
    const double *const argument[3] = {value[0], value[1], value[2]};
    const int rounding = fegetround();
    fesetround(FE_TONEAREST);
    br_operation_apply(set, operation, set->width, argument, value[3]);
    fesetround(rounding);
    return value[3][0];
}
