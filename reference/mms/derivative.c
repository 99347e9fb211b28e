/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/mms/derivative.h"

#include <math.h>
#include <matheval.h>
#include <pthread.h>
#include <string.h>

struct br_derivative {
    void *evaluator; /* of libmatheval */
    struct br_order order;
    bool uses_x, uses_t;
    char text[];
};

static char name_x[] = "x", name_t[] = "t";

/* libmatheval's scanner and parser keep global state. */
static pthread_mutex_t parser = PTHREAD_MUTEX_INITIALIZER;

/* libmatheval prints what its scanner does not know to stdout. */
static enum br_status check_characters(const char *text, struct br_error *err)
{
    static const char known[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                "0123456789_+-*/^(). ";
    const size_t good = strspn(text, known);
    if (text[good])
        return br_fail(err, BR_BAD_INPUT,
                       "found '%.1s' in '%s', expected only letters, digits, + - * / ^ ( ) . _ and "
                       "blanks, since it is derived symbolically",
                       text + good, text);
    return BR_OK;
}

/* Replaces the evaluator by its derivative. */
static void derive(struct br_derivative *d, char *name, int times)
{
    for (int i = 0; i < times && d->evaluator; i++) {
        void *next = evaluator_derivative(d->evaluator, name);
        evaluator_destroy(d->evaluator);
        d->evaluator = next;
    }
}

static enum br_status find_variables(struct br_derivative *d, struct br_error *err)
{
    char **names;
    int count;
    d->uses_x = d->uses_t = false;
    evaluator_get_variables(d->evaluator, &names, &count);
    for (int i = 0; i < count; i++) {
        const bool is_x = strcmp(names[i], "x") == 0, is_t = strcmp(names[i], "t") == 0;
        if (!is_x && !is_t)
            return br_fail(err, BR_BAD_INPUT, "found the variable '%s' in '%s', expected x and t",
                           names[i], d->text);
        d->uses_x |= is_x;
        d->uses_t |= is_t;
    }
    return BR_OK;
}

static enum br_status parse_and_derive(struct br_derivative *d, struct br_error *err)
{
    d->evaluator = evaluator_create(d->text);
    if (!d->evaluator)
        return br_fail(err, BR_BAD_INPUT,
                       "found '%s', expected an expression that can be derived symbolically: "
                       "+ - * / ^ sin cos tan asin acos atan sinh cosh tanh acosh atanh exp log "
                       "sqrt abs step",
                       d->text);
    enum br_status status = find_variables(d, err); /* of the whole, before some drop out */
    if (status)
        return status;
    derive(d, name_x, d->order.x);
    derive(d, name_t, d->order.t);
    return d->evaluator ? find_variables(d, err) : br_no_memory(err, "a derivative");
}

enum br_status br_derivative_create(struct br_derivative **out, const char *text,
                                    struct br_order order, struct br_error *err)
{
    *out = NULL;
    enum br_status status = check_characters(text, err);
    if (status)
        return status;
    struct br_derivative *d = br_allocate(1, sizeof *d + strlen(text) + 1);
    if (!d)
        return br_no_memory(err, "a derivative");
    strcpy(d->text, text);
    d->order = order;
    pthread_mutex_lock(&parser);
    status = parse_and_derive(d, err);
    pthread_mutex_unlock(&parser);
    if (status) {
        br_derivative_free(d);
        return status;
    }
    *out = d;
    return BR_OK;
}

enum br_status br_derivative_clone(const struct br_derivative *d, struct br_derivative **out,
                                   struct br_error *err)
{
    return br_derivative_create(out, d->text, d->order, err);
}

void br_derivative_free(struct br_derivative *d)
{
    if (d && d->evaluator)
        evaluator_destroy(d->evaluator);
    free(d);
}

static double evaluate(const struct br_derivative *d, double x, double t)
{
    char *names[] = {name_x, name_t};
    double values[] = {x, t};
    return evaluator_evaluate(d->evaluator, 2, names, values);
}

/* A few units in the last place to the right. */
static double beyond(double a)
{
    for (int i = 0; i < 4; i++)
        a = nextafter(a, INFINITY);
    return a;
}

double br_derivative_at(const struct br_derivative *d, double x, double t)
{
    const double points[][2] = {{x, t}, {x, beyond(t)}, {beyond(x), t}, {beyond(x), beyond(t)}};
    double value = NAN;
    for (size_t i = 0; i < sizeof points / sizeof *points && !isfinite(value); i++)
        value = evaluate(d, points[i][0], points[i][1]);
    return value;
}

bool br_derivative_uses_x(const struct br_derivative *d)
{
    return d->uses_x;
}

bool br_derivative_uses_t(const struct br_derivative *d)
{
    return d->uses_t;
}

enum { SAMPLES = 29 };

/* Compares the two at SAMPLES^2 points, relative to the largest value. */
static enum br_status compare(const struct br_derivative *d, const struct br_function *same,
                              double length, double duration, struct br_error *err)
{
    double largest = 0, worst = 0, at[4] = {0};
    for (int i = 0; i < SAMPLES * SAMPLES; i++) {
        const double x = length * (i % SAMPLES) / (SAMPLES - 1);
        const double t = duration * (i / SAMPLES) / (SAMPLES - 1);
        double expected;
        br_function_evaluate(same, 1, &x, t, &expected);
        const double found = br_derivative_at(d, x, t), distance = fabs(found - expected);
        largest = fmax(largest, fabs(expected));
        if (distance <= worst || isnan(worst))
            continue;
        worst = distance;
        memcpy(at, (double[]){x, t, found, expected}, sizeof at);
    }
    if (!(worst <= 1e-12 * largest))
        return br_fail(err, BR_BAD_INPUT,
                       "'%s' is %.10g at x = %g m, t = %g s where it is derived symbolically, "
                       "expected %.10g as expressions are read elsewhere (a^b^c needs parentheses)",
                       d->text, at[2], at[0], at[1], at[3]);
    return BR_OK;
}

enum br_status br_derivative_check_text(const char *text, const struct br_function *same,
                                        double length, double duration, struct br_error *err)
{
    struct br_derivative *d;
    enum br_status status = br_derivative_create(&d, text, (struct br_order){0, 0}, err);
    if (!status)
        status = compare(d, same, length, duration, err);
    br_derivative_free(d);
    return status;
}
