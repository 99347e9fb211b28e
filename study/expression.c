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

/* 1 from zero on, as in GNU libmatheval (reference/mms/derivative.h). */
static double unit_step(double a)
{
    return a >= 0 ? 1 : a < 0 ? 0 : NAN;
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
    mupDefineFun1(e->parser, "step", unit_step, 1);
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

/* muParser would take x = 1 as an assignment, and x, t as two expressions. */
static bool has_assignment(const char *text)
{
    for (const char *c = text; *c; c++) {
        const bool comparison = (c > text && strchr("=!<>", c[-1])) || c[1] == '=';
        if (*c == '=' && !comparison)
            return true;
    }
    return false;
}

static enum br_status refuse(struct expression *e, const char *reason, struct br_error *err)
{
    br_fail(err, BR_BAD_INPUT, "'%s' is no expression in x and t: %s", e->text, reason);
    expression_free(e);
    return BR_BAD_INPUT;
}

enum br_status br_expression(const char *text, struct br_function *f, struct br_error *err)
{
    *f = (struct br_function){0};
    struct expression *e = expression_create(text);
    if (!e)
        return br_no_memory(err, "an expression");
    if (has_assignment(text))
        return refuse(e, "it assigns; a comparison is ==", err);
    int count = 0;
    const double *values = mupEvalMulti(e->parser, &count);
    if (mupError(e->parser))
        return refuse(e, mupGetErrorMsg(e->parser), err);
    if (count != 1)
        return refuse(e, "it is more than one, separated by commas", err);
    const double value = values[0];
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
