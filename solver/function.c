/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solver/function.h"

#include <math.h>

#include "solver/arithmetic.h"

void br_function_evaluate(const struct br_function *f, size_t count, const double *x, double t,
                          double *value)
{
    if (f->ops) { /* the caller reports values that are not finite */
        const int traps = br_traps_lift();
        f->ops->evaluate(f->self, count, x, t, value);
        br_traps_restore(traps);
        return;
    }
    for (size_t i = 0; i < count; i++)
        value[i] = f->constant;
}

double br_function_at(const struct br_function *f, double x, double t)
{
    double value;
    br_function_evaluate(f, 1, &x, t, &value);
    return value;
}

enum br_status br_function_clone(const struct br_function *f, struct br_function *out,
                                 struct br_error *err)
{
    *out = *f;
    if (!f->ops)
        return BR_OK;
    out->self = f->ops->clone(f->self);
    if (!out->self) {
        *out = (struct br_function){0};
        return br_no_memory(err, "a copy of a function");
    }
    return BR_OK;
}

void br_function_free(struct br_function *f)
{
    if (f->ops)
        f->ops->free(f->self);
    *f = (struct br_function){0};
}

bool br_function_is_zero(const struct br_function *f)
{
    return !f->ops && f->constant == 0;
}

static const struct br_interval everywhere = {-INFINITY, INFINITY};

bool br_function_bound(const struct br_function *f, struct br_box box, struct br_interval *value)
{
    *value = f->ops ? everywhere : (struct br_interval){f->constant, f->constant};
    if (!f->ops || !f->ops->bound)
        return !f->ops;
    const int traps = br_traps_lift(); /* a bound may overflow */
    const bool bounded = f->ops->bound(f->self, box, value);
    br_traps_restore(traps);
    return bounded;
}

bool br_function_taylor(const struct br_function *f, enum br_variable along, struct br_box box,
                        size_t order, struct br_interval *c)
{
    for (size_t i = 0; i <= order; i++)
        c[i] = (struct br_interval){i || f->ops ? 0 : f->constant, i || f->ops ? 0 : f->constant};
    if (!f->ops || !f->ops->taylor)
        return !f->ops;
    const int traps = br_traps_lift();
    const bool smooth = f->ops->taylor(f->self, along, box, order, c);
    br_traps_restore(traps);
    return smooth;
}

const struct br_function *br_function_switching(const struct br_function *f, size_t i)
{
    return f->ops && f->ops->switching ? f->ops->switching(f->self, i) : NULL;
}

enum br_status br_function_derive(const struct br_function *f, const struct br_derivation *what,
                                  struct br_function *out, struct br_error *err)
{
    *out = (struct br_function){0};
    if (f->ops && !f->ops->derive)
        return br_fail(err, BR_BAD_INPUT, "found a function without derivatives");
    if (f->ops)
        return f->ops->derive(f->self, what, out, err);
    for (size_t i = 0; i < what->count; i++)
        if (what->term[i].order.x == 0 && what->term[i].order.t == 0)
            out->constant += what->term[i].factor * f->constant;
    return BR_OK;
}

enum br_status br_function_derivative(const struct br_function *f, struct br_partial order,
                                      struct br_function *out, struct br_error *err)
{
    const struct br_derivation what = {1, {{1, order}}, NAN, NAN};
    return br_function_derive(f, &what, out, err);
}
