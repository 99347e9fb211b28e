/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/expression.h"

#include <math.h>
#include <muParserDLL.h>
#include <string.h>

struct expression {
    muParserHandle_t parser;
    double x, t;
    char text[];
};

/* muParser prints to stdout unless it has a handler; errors are asked for instead. */
static void ignore_error(muParserHandle_t parser)
{
    (void)parser;
}

static double natural_log(double a)
{
    return log(a);
}

static double minus_one(double a)
{
    return expm1(a);
}

static void expression_free(void *self)
{
    struct expression *e = self;
    if (!e)
        return;
    if (e->parser)
        mupRelease(e->parser);
    free(e);
}

static struct expression *expression_create(const char *text)
{
    struct expression *e = br_allocate(1, sizeof *e + strlen(text) + 1);
    if (!e)
        return NULL;
    strcpy(e->text, text);
    e->parser = mupCreate(muBASETYPE_FLOAT);
    if (!e->parser) {
        free(e);
        return NULL;
    }
    mupSetErrorHandler(e->parser, ignore_error);
    mupDefineVar(e->parser, "x", &e->x);
    mupDefineVar(e->parser, "t", &e->t);
    mupDefineConst(e->parser, "pi", M_PI);
    mupDefineConst(e->parser, "e", M_E);
    mupDefineFun1(e->parser, "expm1", minus_one, 1);
    mupDefineFun1(e->parser, "log", natural_log, 1);
    mupSetExpr(e->parser, e->text);
    return e;
}

static void expression_evaluate(void *self, size_t count, const double *x, double t, double *value)
{
    struct expression *e = self;
    e->t = t;
    for (size_t i = 0; i < count; i++) {
        e->x = x[i];
        value[i] = mupEval(e->parser);
        if (mupError(e->parser)) {
            mupErrorReset(e->parser);
            value[i] = NAN;
        }
    }
}

static void *expression_clone(const void *self)
{
    return expression_create(((const struct expression *)self)->text);
}

static const struct br_function_ops expression_ops = {
    .evaluate = expression_evaluate,
    .clone = expression_clone,
    .free = expression_free,
};

/* Which variables occur in the expression. */
static void find_variables(const struct expression *e, struct br_function *f)
{
    const int count = mupGetExprVarNum(e->parser);
    for (int i = 0; i < count; i++) {
        const char *name = NULL;
        double *address = NULL;
        mupGetExprVar(e->parser, (unsigned)i, &name, &address);
        f->uses_x |= address == &e->x;
        f->uses_t |= address == &e->t;
    }
}

enum br_status br_expression(const char *text, struct br_function *f, struct br_error *err)
{
    *f = (struct br_function){0};
    struct expression *e = expression_create(text);
    if (!e)
        return br_no_memory(err, "an expression");
    const double value = mupEval(e->parser);
    if (mupError(e->parser)) {
        br_fail(err, BR_BAD_INPUT, "'%s' is no expression in x and t: %s", text,
                mupGetErrorMsg(e->parser));
        expression_free(e);
        return BR_BAD_INPUT;
    }
    find_variables(e, f);
    if (!f->uses_x && !f->uses_t) {
        f->constant = value;
        expression_free(e);
        return isfinite(value) ? BR_OK
                               : br_fail(err, BR_BAD_INPUT, "'%s' is %g, expected a finite number",
                                         text, value);
    }
    f->ops = &expression_ops;
    f->self = e;
    return BR_OK;
}
