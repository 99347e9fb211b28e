/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Compiled once for each instruction set, BR_SET (solver/instruction_set.h). */
#include <sleef.h>

#include "study/scene/operations.h"

#define JOIN_(a, b) a##b
#define JOIN(a, b) JOIN_(a, b)
#define NAME(stem) JOIN(stem, BR_SET)

enum { WIDTH = NAME(BR_WIDTH_) };

#if !defined __x86_64__
typedef double vector; /* one by one */
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

#define UNARY(operation, name)                                            \
    case operation:                                                       \
        for (size_t i = 0; i < count; i += STRIDE)                        \
            *(vector *)(out + i) = SLEEF(name)(*(const vector *)(a + i)); \
        break;

static void apply(enum br_operation operation, size_t count, const double *a, const double *b,
                  double *out)
{
    switch (operation) {
        UNARY(BR_OP_SIN, sin)
        UNARY(BR_OP_COS, cos)
        UNARY(BR_OP_TAN, tan)
        UNARY(BR_OP_ASIN, asin)
        UNARY(BR_OP_ACOS, acos)
        UNARY(BR_OP_ATAN, atan)
        UNARY(BR_OP_SINH, sinh)
        UNARY(BR_OP_COSH, cosh)
        UNARY(BR_OP_TANH, tanh)
        UNARY(BR_OP_ASINH, asinh)
        UNARY(BR_OP_ACOSH, acosh)
        UNARY(BR_OP_ATANH, atanh)
        UNARY(BR_OP_EXP, exp)
        UNARY(BR_OP_EXPM1, expm1)
        UNARY(BR_OP_LOG, log)
        UNARY(BR_OP_LOG2, log2)
        UNARY(BR_OP_LOG10, log10)
    case BR_OP_POW:
        for (size_t i = 0; i < count; i += STRIDE)
            *(vector *)(out + i) = SLEEF(pow)(*(const vector *)(a + i), *(const vector *)(b + i));
        break;
    default:
        break;
    }
}

#define TEXT_(word) #word
#define TEXT(word) TEXT_(word)

const struct br_elementary NAME(br_elementary_) = {
    .name = TEXT(BR_SET), .width = WIDTH, .available = NAME(br_has_), .apply = apply};
