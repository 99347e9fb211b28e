/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Compiled once for each instruction set, BR_SET (solver/instruction_set.h). */
#include <math.h>
#include <sleef.h>

#include "solver/vectors.h"
#include "study/known/operations.h"

#define NAME(stem) BR_JOIN(stem, BR_SET)

#if !defined __x86_64__
typedef double vector; /* no vectors */
enum { STRIDE = 1 };
#define SLEEF(name) Sleef_cinz_##name##d1_u10purec
#else
typedef double vector __attribute__((vector_size(8 * WIDTH), may_alias));
enum { STRIDE = WIDTH };
#define SLEEF_portable(name) Sleef_cinz_##name##d2_u10sse2
#define SLEEF_avx2(name) Sleef_cinz_##name##d4_u10avx
#define SLEEF_avx512(name) Sleef_cinz_##name##d8_u10avx512fnofma
#define SLEEF NAME(SLEEF_)
#endif

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

static void power(size_t count, const double *a, const double *b, double *restrict out)
{
    bool small = true; /* whether all powers are small */
    for (size_t i = 0; i < count && small; i++)
        small = is_small_power(b[i]);
    for (size_t i = 0; i < count && !small; i += STRIDE)
        *(vector *)(out + i) = SLEEF(pow)(*(const vector *)(a + i), *(const vector *)(b + i));
    for (size_t i = 0; i < count; i++)
        if (is_small_power(b[i]))
            out[i] = small_power(a[i], b[i]);
}

/* ---- all operations ---- */

#define LOOP(operation, value)             \
    case operation:                        \
        for (size_t i = 0; i < count; i++) \
            out[i] = (value);              \
        break;

/* A truth value of two numbers; NaN if one of them is NaN. */
#define TRUTH(operation, truth) LOOP(operation, isunordered(a[i], b[i]) ? NAN : (double)(truth))

/* SLEEF's function; beyond a limit, where it fails on finite values, the C library's. */
#define MENDED(operation, name, limit)                                    \
    case operation:                                                       \
        for (size_t i = 0; i < count; i += STRIDE)                        \
            *(vector *)(out + i) = SLEEF(name)(*(const vector *)(a + i)); \
        for (size_t i = 0; i < count && isfinite(limit); i++)             \
            if (!(fabs(a[i]) <= (limit)))                                 \
                out[i] = name(a[i]);                                      \
        break;
#define UNARY(operation, name) MENDED(operation, name, INFINITY)

static void apply(enum br_operation operation, size_t count, const double *const argument[3],
                  double *restrict out)
{
    const double *const a = argument[0], *const b = argument[1], *const c = argument[2];
    switch (operation) {
        LOOP(BR_OP_NEGATE, -a[i])
        LOOP(BR_OP_NOT, isnan(a[i]) ? NAN : (double)(a[i] == 0))
        UNARY(BR_OP_SIN, sin)
        UNARY(BR_OP_COS, cos)
        UNARY(BR_OP_TAN, tan)
        UNARY(BR_OP_ASIN, asin)
        UNARY(BR_OP_ACOS, acos)
        UNARY(BR_OP_ATAN, atan)
        MENDED(BR_OP_SINH, sinh, 709.0)
        MENDED(BR_OP_COSH, cosh, 709.0)
        UNARY(BR_OP_TANH, tanh)
        MENDED(BR_OP_ASINH, asinh, 1e150)
        MENDED(BR_OP_ACOSH, acosh, 1e150)
        UNARY(BR_OP_ATANH, atanh)
        UNARY(BR_OP_EXP, exp)
        UNARY(BR_OP_EXPM1, expm1)
        UNARY(BR_OP_LOG, log)
        UNARY(BR_OP_LOG2, log2)
        UNARY(BR_OP_LOG10, log10)
        LOOP(BR_OP_SQRT, sqrt(a[i]))
        LOOP(BR_OP_ABS, fabs(a[i]))
        LOOP(BR_OP_SIGN, a[i] > 0 ? 1 : a[i] < 0 ? -1 : a[i])
        LOOP(BR_OP_STEP, a[i] >= 0 ? 1 : a[i] < 0 ? 0 : NAN)
        LOOP(BR_OP_ADD, a[i] + b[i])
        LOOP(BR_OP_SUBTRACT, a[i] - b[i])
        LOOP(BR_OP_MULTIPLY, a[i] * b[i])
        LOOP(BR_OP_DIVIDE, a[i] / b[i])
    case BR_OP_POW:
        power(count, a, b, out);
        break;
        LOOP(BR_OP_MIN, isnan(a[i]) || a[i] < b[i] ? a[i] : b[i])
        LOOP(BR_OP_MAX, isnan(a[i]) || a[i] > b[i] ? a[i] : b[i])
        TRUTH(BR_OP_LESS, a[i] < b[i])
        TRUTH(BR_OP_LESS_EQUAL, a[i] <= b[i])
        TRUTH(BR_OP_EQUAL, a[i] == b[i])
        TRUTH(BR_OP_AND, a[i] != 0 && b[i] != 0)
        TRUTH(BR_OP_OR, a[i] != 0 || b[i] != 0)
        LOOP(BR_OP_CHOOSE, isnan(a[i]) ? NAN : a[i] != 0 ? b[i] : c[i])
    default: /* numbers and variables */
        break;
    }
}

const struct br_elementary NAME(br_elementary_) = {.width = WIDTH, .apply = apply};
