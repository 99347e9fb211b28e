/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A partial derivative of an expression in x and t, derived symbolically by GNU
 * libmatheval (1.1.11).
 *
 * The language: what libmatheval and the expressions of a scene (study/expression.h)
 * have in common, checked by br_derivative_check_text:
 *     + - * / ^ ( ), numbers like 2, .5 and 1e-3, the variables x and t, pi and e,
 *     sin cos tan asin acos atan sinh cosh tanh acosh atanh exp log (natural) sqrt
 *     abs step (0 below zero, 1 from zero on).
 * Not in common: ln, sign and others (unknown to libmatheval), a^b^c ((a^b)^c to libmatheval,
 * a^(b^c) elsewhere: parentheses are needed), asinh (libmatheval derives it wrongly,
 * which the check of check.h finds). */
#ifndef BR_MMS_DERIVATIVE_H
#define BR_MMS_DERIVATIVE_H

#include "solver/scene.h"

/* d^(x + t) / dx^x dt^t */
struct br_order {
    int x, t;
};

/* One instance is for one thread at a time; clone it for another. */
struct br_derivative;

/* Derives the expression. Fails with BR_BAD_INPUT (no expression of libmatheval's, or
 * another variable than x and t) or BR_NO_MEMORY; *derivative is then NULL. */
enum br_status br_derivative_create(struct br_derivative **derivative, const char *text,
                                    struct br_order order, struct br_error *err);

/* From the text again, since libmatheval prints but six digits. */
enum br_status br_derivative_clone(const struct br_derivative *derivative,
                                   struct br_derivative **out, struct br_error *err);
void br_derivative_free(struct br_derivative *derivative); /* accepts NULL */

/* The value at x, m, and t, s. At a kink, where the derivatives of abs and step are not
 * finite, that of a derivative from the right: at a slightly later t, else at a slightly larger x.
 */
double br_derivative_at(const struct br_derivative *derivative, double x, double t);

/* The same at count points x, in; value: out, count. Of a product X(x) T(t) the values of X
 * are kept for the next call with the same x, as a load or a projection makes it. */
void br_derivative_values(struct br_derivative *derivative, size_t count, const double *x, double t,
                          double *value);

/* Which variables occur in it. */
bool br_derivative_uses_x(const struct br_derivative *derivative);
bool br_derivative_uses_t(const struct br_derivative *derivative);

/* Refuses (BR_BAD_INPUT) a text that libmatheval cannot read, or reads as something else
 * than `same`, the function of the same text by another parser, at sample points of
 * [0, length] x [0, duration]. */
enum br_status br_derivative_check_text(const char *text, const struct br_function *same,
                                        double length, double duration, struct br_error *err);

#endif
