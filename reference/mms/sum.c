/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/mms/sum.h"

#include <math.h>

struct sum {
    struct br_sum of;
    struct br_derivative *derivative[BR_SUM_MOST_TERMS];
    double *part; /* workspace */
    size_t room;  /* its length */
};

static double value_at(const struct sum *s, double x, double t)
{
    const double at_x = isnan(s->of.x) ? x : s->of.x, at_t = isnan(s->of.t) ? t : s->of.t;
    double value = 0;
    for (size_t i = 0; i < s->of.count; i++)
        value += s->of.term[i].factor * br_derivative_at(s->derivative[i], at_x, at_t);
    return value;
}

/* Room for one term at count points; false without memory. */
static bool make_room(struct sum *s, size_t count)
{
    if (count <= s->room)
        return true;
    free(s->part);
    s->part = br_allocate(count, sizeof *s->part);
    s->room = s->part ? count : 0;
    return s->part;
}

static void sum_evaluate(void *self, size_t count, const double *x, double t, double *value)
{
    struct sum *s = self;
    if (!isnan(s->of.x) || !isnan(s->of.t) || count < 2 || !make_room(s, count)) {
        for (size_t i = 0; i < count; i++)
            value[i] = value_at(s, x[i], t);
        return;
    }
    for (size_t i = 0; i < count; i++)
        value[i] = 0;
    for (size_t term = 0; term < s->of.count; term++) {
        br_derivative_values(s->derivative[term], count, x, t, s->part);
        for (size_t i = 0; i < count; i++)
            value[i] += s->of.term[term].factor * s->part[i];
    }
}

static void sum_free(void *self)
{
    struct sum *s = self;
    for (size_t i = 0; s && i < s->of.count; i++)
        br_derivative_free(s->derivative[i]);
    if (s)
        free(s->part);
    free(s);
}

static void *sum_clone(const void *self)
{
    const struct sum *s = self;
    struct sum *copy = br_allocate(1, sizeof *copy);
    if (!copy)
        return NULL;
    copy->of = s->of;
    for (size_t i = 0; i < s->of.count; i++)
        if (br_derivative_clone(s->derivative[i], &copy->derivative[i], NULL)) {
            sum_free(copy);
            return NULL;
        }
    return copy;
}

static const struct br_function_ops sum_ops = {
    .evaluate = sum_evaluate,
    .clone = sum_clone,
    .free = sum_free,
};

static enum br_status derive(struct sum *s, const struct br_sum *from, const char *text,
                             struct br_error *err)
{
    enum br_status status = BR_OK;
    for (size_t i = 0; i < from->count && !status; i++) {
        const size_t at = s->of.count;
        if (from->term[i].factor == 0)
            continue;
        s->of.term[at] = from->term[i];
        status = br_derivative_create(&s->derivative[at], text, from->term[i].order, err);
        s->of.count += !status;
    }
    return status;
}

enum br_status br_sum_function(const struct br_sum *from, const char *text, struct br_function *f,
                               struct br_error *err)
{
    *f = (struct br_function){0};
    struct sum *s = br_allocate(1, sizeof *s);
    if (!s)
        return br_no_memory(err, "a sum of derivatives");
    s->of = (struct br_sum){.x = from->x, .t = from->t};
    const enum br_status status = derive(s, from, text, err);
    for (size_t i = 0; i < s->of.count; i++) {
        f->uses_x |= br_derivative_uses_x(s->derivative[i]) && isnan(s->of.x);
        f->uses_t |= br_derivative_uses_t(s->derivative[i]) && isnan(s->of.t);
    }
    if (!status && (f->uses_x || f->uses_t)) {
        f->ops = &sum_ops;
        f->self = s;
        return BR_OK;
    }
    const double constant = status ? 0 : value_at(s, 0, 0);
    *f = (struct br_function){.constant = constant};
    sum_free(s);
    return status;
}
