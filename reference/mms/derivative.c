/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/mms/derivative.h"

#include <ctype.h>
#include <fenv.h>
#include <math.h>
#include <matheval.h>
#include <pthread.h>
#include <string.h>

#include "reference/mms/product.h"

struct br_derivative {
    void *evaluator[2]; /* of libmatheval: X(x) and T(t), or the whole and NULL */
    struct br_order order;
    bool uses[2]; /* x, t */
    size_t kept;  /* points at which X is known */
    double *x;    /* kept points, m, and then kept values of X */
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

static bool is_known(const char *word, size_t length)
{
    static const char *const words[] = {
        "x",    "t",    "pi",    "e",     "sin",   "cos", "tan", "asin", "acos", "atan", "sinh",
        "cosh", "tanh", "asinh", "acosh", "atanh", "exp", "log", "sqrt", "abs",  "step",
    };
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (strlen(words[i]) == length && memcmp(words[i], word, length) == 0)
            return true;
    return false;
}

/* libmatheval takes an unknown word for a variable, and leaks where it then fails. */
static enum br_status check_words(const char *text, struct br_error *err)
{
    for (const char *c = text; *c;) {
        const char *end = c;
        while (isalnum((unsigned char)*end) || *end == '_' || *end == '.')
            end++;
        const bool word = isalpha((unsigned char)*c) || *c == '_'; /* else a number */
        if (word && !is_known(c, (size_t)(end - c)))
            return br_fail(err, BR_BAD_INPUT,
                           "found '%.*s' in '%s', expected only what can be derived symbolically: "
                           "x t pi e sin cos tan asin acos atan sinh cosh tanh acosh atanh exp log "
                           "sqrt abs step",
                           (int)(end - c), c, text);
        c = end > c ? end : c + 1;
    }
    return BR_OK;
}

/* Replaces the evaluator by its derivative. */
static void derive(void **evaluator, char *name, int times)
{
    for (int i = 0; i < times && *evaluator; i++) {
        void *next = evaluator_derivative(*evaluator, name);
        evaluator_destroy(*evaluator);
        *evaluator = next;
    }
}

/* uses: in/out, x and t. */
static void find_variables(void *evaluator, bool uses[2])
{
    char **names;
    int count;
    evaluator_get_variables(evaluator, &names, &count);
    for (int i = 0; i < count; i++)
        uses[strcmp(names[i], "t") == 0] = true;
}

/* One factor, or the whole, derived. */
static enum br_status parse_and_derive(struct br_derivative *d, char *text, struct br_order order,
                                       void **evaluator, struct br_error *err)
{
    *evaluator = evaluator_create(text);
    if (!*evaluator)
        return br_fail(err, BR_BAD_INPUT,
                       "found '%s', expected an expression that can be derived symbolically",
                       d->text);
    derive(evaluator, name_x, order.x);
    derive(evaluator, name_t, order.t);
    if (!*evaluator)
        return br_no_memory(err, "a derivative");
    find_variables(*evaluator, d->uses);
    return BR_OK;
}

static enum br_status create_evaluators(struct br_derivative *d, struct br_error *err)
{
    const size_t size = br_product_size(strlen(d->text));
    char *in_x = br_allocate(2 * size, 1);
    if (!in_x)
        return br_no_memory(err, "a derivative");
    char *in_t = in_x + size;
    const bool product = br_product_split(d->text, in_x, in_t);
    pthread_mutex_lock(&parser);
    enum br_status status;
    if (product) {
        status = parse_and_derive(d, in_x, (struct br_order){d->order.x, 0}, &d->evaluator[0], err);
        if (!status)
            status =
                parse_and_derive(d, in_t, (struct br_order){0, d->order.t}, &d->evaluator[1], err);
    } else {
        status = parse_and_derive(d, d->text, d->order, &d->evaluator[0], err);
    }
    pthread_mutex_unlock(&parser);
    free(in_x);
    return status;
}

enum br_status br_derivative_create(struct br_derivative **out, const char *text,
                                    struct br_order order, struct br_error *err)
{
    *out = NULL;
    enum br_status status = check_characters(text, err);
    if (!status)
        status = check_words(text, err);
    if (status)
        return status;
    struct br_derivative *d = br_allocate(1, sizeof *d + strlen(text) + 1);
    if (!d)
        return br_no_memory(err, "a derivative");
    strcpy(d->text, text);
    d->order = order;
    status = create_evaluators(d, err);
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
    for (int i = 0; d && i < 2; i++)
        if (d->evaluator[i])
            evaluator_destroy(d->evaluator[i]);
    if (d)
        free(d->x);
    free(d);
}

/* A few units in the last place to the right. */
static double beyond(double a)
{
    for (int i = 0; i < 4; i++)
        a = nextafter(a, INFINITY);
    return a;
}

/* The value there, or of a derivative from the right. */
static double evaluate(const struct br_derivative *d, int factor, double x, double t)
{
    const double points[][2] = {{x, t}, {x, beyond(t)}, {beyond(x), t}, {beyond(x), beyond(t)}};
    const bool derived = d->order.x + d->order.t > 0;
    const size_t tries = derived ? sizeof points / sizeof *points : 1;
    char *names[] = {name_x, name_t};
    double value = NAN;
    fenv_t environment; /* the library raises flags on its way to a number */
    feholdexcept(&environment);
    for (size_t i = 0; i < tries && !isfinite(value); i++) {
        double at[] = {points[i][0], points[i][1]};
        value = evaluator_evaluate(d->evaluator[factor], 2, names, at);
    }
    fesetenv(&environment);
    return value;
}

double br_derivative_at(const struct br_derivative *d, double x, double t)
{
    const double in_t = d->evaluator[1] ? evaluate(d, 1, x, t) : 1;
    return in_t * evaluate(d, 0, x, t);
}

/* X at the points; NULL without memory. */
static const double *keep_factor(struct br_derivative *d, size_t count, const double *x)
{
    const size_t bytes = count * sizeof *x;
    if (count == d->kept && memcmp(x, d->x, bytes) == 0)
        return d->x + count;
    free(d->x);
    d->kept = 0;
    d->x = br_allocate(2 * count, sizeof *x);
    if (!d->x)
        return NULL;
    d->kept = count;
    memcpy(d->x, x, bytes);
    for (size_t i = 0; i < count; i++)
        d->x[count + i] = evaluate(d, 0, x[i], 0);
    return d->x + count;
}

void br_derivative_values(struct br_derivative *d, size_t count, const double *x, double t,
                          double *value)
{
    const double *factor = d->evaluator[1] && count > 1 ? keep_factor(d, count, x) : NULL;
    const double in_t = factor ? evaluate(d, 1, 0, t) : 0;
    for (size_t i = 0; i < count; i++)
        value[i] = factor ? in_t * factor[i] : br_derivative_at(d, x[i], t);
}

bool br_derivative_uses_x(const struct br_derivative *d)
{
    return d->uses[0];
}

bool br_derivative_uses_t(const struct br_derivative *d)
{
    return d->uses[1];
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
