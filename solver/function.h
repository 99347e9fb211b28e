/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A function of x and t: how it is evaluated, and what can be proved of it. */
#ifndef BR_SOLVER_FUNCTION_H
#define BR_SOLVER_FUNCTION_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"

/* A closed interval, low <= high. */
struct br_interval {
    double low, high;
};

/* All x of an interval at all t of another. Either may be one point. */
struct br_box {
    struct br_interval x; /* m */
    struct br_interval t; /* s */
};

enum br_variable { BR_X, BR_T };

/* d^(x + t) f / dx^x dt^t */
struct br_partial {
    int x, t;
};

enum { BR_DERIVATION_TERMS = 3 };

/* A sum of a function's derivatives, each with a factor. Terms with the factor 0 cost nothing. */
struct br_derivation {
    size_t count;
    struct {
        double factor;
        struct br_partial order;
    } term[BR_DERIVATION_TERMS];
    double x, t; /* m, s: the point of evaluation, whatever x and t are given; NaN: the given one */
};

struct br_function;

/* How a function is evaluated, copied, released, and enclosed. An instance may be used by one
 * thread at a time; clone it for another. Without bound, taylor or switching function (NULL)
 * nothing can be proved of the function, and callers that need a proof refuse it. Without derive it
 * has no derivatives. */
struct br_function_ops {
    /* x: in, m, count values; t: s; value: out, count values */
    void (*evaluate)(void *self, size_t count, const double *x, double t, double *value);
    void *(*clone)(const void *self); /* NULL when out of memory */
    void (*free)(void *self);         /* accepts NULL */

    /* Encloses all values that evaluate gives, or exact arithmetic would, in a box; rounded
     * outward. False: there is no enclosure; the function may be infinite or not a number there. */
    bool (*bound)(const void *self, struct br_box box, struct br_interval *value);

    /* Encloses the Taylor coefficients f^(i) / i! along one variable, i = 0 to order, at all points
     * of the box. False: the function may be infinite, no number, or not smooth somewhere in the
     * box (at a switching function, or as sqrt is at zero). */
    bool (*taylor)(const void *self, enum br_variable along, struct br_box box, size_t order,
                   struct br_interval *coefficient);

    /* Guard i, borrowed, or NULL from the last one on: a function whose change of sign, and nothing
     * else, makes this function or a derivative of it jump. A switching function is the argument of
     * step, abs and sign, or the difference of the two arguments of min, max and a comparison. A
     * switching function has enclosures only. */
    const struct br_function *(*switching)(const void *self, size_t i);

    /* A sum of derivatives as a function (out), by the rules of differentiation; at a jump or a
     * kink it has the value beside it. Fails with BR_NO_MEMORY or BR_BAD_INPUT (it is too long). */
    enum br_status (*derive)(const void *self, const struct br_derivation *what,
                             struct br_function *out, struct br_error *err);
};

/* With ops == NULL it is the constant `constant`. */
struct br_function {
    const struct br_function_ops *ops;
    void *self;
    double constant;
    bool uses_x, uses_t;
};

/* Values of f at count points x (in, m) and time t (s) into value (out). */
void br_function_evaluate(const struct br_function *f, size_t count, const double *x, double t,
                          double *value);

double br_function_at(const struct br_function *f, double x, double t);

/* out becomes an independent copy of f. Fails with BR_NO_MEMORY. */
enum br_status br_function_clone(const struct br_function *f, struct br_function *out,
                                 struct br_error *err);
void br_function_free(struct br_function *f);

/* Whether f is the constant zero. */
bool br_function_is_zero(const struct br_function *f);

/* Enclosures and switching functions, as in br_function_ops; value and coefficient (order + 1) are
 * out. */
bool br_function_bound(const struct br_function *f, struct br_box box, struct br_interval *value);
bool br_function_taylor(const struct br_function *f, enum br_variable along, struct br_box box,
                        size_t order, struct br_interval *coefficient);
const struct br_function *br_function_switching(const struct br_function *f, size_t i);

/* A sum of derivatives of f; *out is zero where it fails (BR_NO_MEMORY; BR_BAD_INPUT: f has none).
 */
enum br_status br_function_derive(const struct br_function *f, const struct br_derivation *what,
                                  struct br_function *out, struct br_error *err);

/* One derivative; likewise. */
enum br_status br_function_derivative(const struct br_function *f, struct br_partial order,
                                      struct br_function *out, struct br_error *err);

#endif
