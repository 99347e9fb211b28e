/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tests/lab/errors.h"

#include <stdio.h>
#include <stdlib.h>

static double uniform(struct br_random *r, double a, double b)
{
    return br_random_uniform(r, a, b);
}

static double normal(struct br_random *r)
{
    return sqrt(-2 * log(1 - uniform(r, 0, 1))) * cos(2 * 3.14159265358979 * uniform(r, 0, 1));
}

static size_t whole(struct br_random *r, size_t a, size_t b)
{
    return a + br_random_index(r, b - a + 1);
}

static double pick(struct br_random *r, const double *v, size_t n)
{
    return v[br_random_index(r, n)];
}

#define PICK(r, ...) \
    pick(r, (const double[]){__VA_ARGS__}, sizeof((const double[]){__VA_ARGS__}) / sizeof(double))

static void ladder(struct br_random *r, struct br_error_line *s, size_t least, size_t most,
                   double ratio)
{
    s->rows = whole(r, least, most);
    const double n0 = floor(uniform(r, 4, 20));
    for (size_t i = 0; i < s->rows; i++)
        s->h[i] = 1 / (n0 * pow(ratio, (double)i));
}

static double digits(double v, int d)
{
    char t[40];
    snprintf(t, sizeof t, "%.*e", d - 1, v);
    return strtod(t, NULL);
}

static double order(struct br_random *r)
{
    return PICK(r, 0.5, 1, 1.5, 2, 3, 4);
}

#define EACH_ROW for (size_t i = 0; i < s->rows; i++)

static double constant_of(struct br_random *r)
{
    return br_random_decades(r, -3, 3);
}

static void clean(struct br_random *r, struct br_error_line *s)
{
    ladder(r, s, 4, 8, 2);
    s->truth = order(r);
    double c = constant_of(r);
    int d = (int)whole(r, 4, 16);
    EACH_ROW s->e[i] = digits(c * pow(s->h[i], s->truth), d);
}

static void next(struct br_random *r, struct br_error_line *s, double by)
{
    ladder(r, s, 4, 8, 2);
    s->truth = order(r);
    double c = constant_of(r), a = uniform(r, -.5, .5) / pow(s->h[0], by);
    EACH_ROW s->e[i] = digits(c * pow(s->h[i], s->truth) * (1 + a * pow(s->h[i], by)), 6);
}

static void next1(struct br_random *r, struct br_error_line *s)
{
    next(r, s, 1);
}

static void next2(struct br_random *r, struct br_error_line *s)
{
    next(r, s, 2);
}

static void series(struct br_random *r, struct br_error_line *s)
{
    ladder(r, s, 4, 8, 2);
    s->truth = PICK(r, 1, 2, 4);
    double c = constant_of(r), a = uniform(r, -.5, .5), b = uniform(r, -.3, .3), h0 = s->h[0];
    EACH_ROW
    {
        double x = s->h[i] / h0;
        s->e[i] = c * pow(s->h[i], s->truth) * (1 + a * x + b * x * x - b * a * x * x * x);
    }
}

static void ratios(struct br_random *r, struct br_error_line *s)
{
    s->rows = whole(r, 4, 8);
    s->truth = order(r);
    double c = constant_of(r), h = .1, a = uniform(r, -.3, .3) / h;
    EACH_ROW
    {
        s->h[i] = h;
        h /= uniform(r, 1.25, 2.4);
        s->e[i] = c * pow(s->h[i], s->truth) * (1 + a * s->h[i]);
    }
}

static void linear(struct br_random *r, struct br_error_line *s)
{
    s->rows = whole(r, 4, 10);
    s->truth = order(r);
    double c = constant_of(r), a = uniform(r, -.3, .3) * 10;
    EACH_ROW
    {
        s->h[i] = 1 / (10. + 10 * (double)i);
        s->e[i] = digits(c * pow(s->h[i], s->truth) * (1 + a * s->h[i]), 6);
    }
}

static void root2(struct br_random *r, struct br_error_line *s)
{
    ladder(r, s, 4, 8, sqrt(2));
    s->truth = order(r);
    double c = constant_of(r), a = uniform(r, -.3, .3) / s->h[0];
    EACH_ROW s->e[i] = digits(c * pow(s->h[i], s->truth) * (1 + a * s->h[i]), 5);
}

static void roundoff(struct br_random *r, struct br_error_line *s)
{
    ladder(r, s, 6, 9, 2);
    s->truth = PICK(r, 2, 3, 4);
    double c = constant_of(r);
    size_t meet = s->rows - whole(r, 1, 3);
    double f = c * pow(s->h[meet], s->truth), g = PICK(r, 0, .5, 1, 2);
    EACH_ROW s->e[i] =
        fabs(c * pow(s->h[i], s->truth) + f * normal(r) * .3 * pow(s->h[meet] / s->h[i], g));
}

static void evenodd(struct br_random *r, struct br_error_line *s)
{
    ladder(r, s, 5, 9, 2);
    s->truth = order(r);
    double c = constant_of(r), a = uniform(r, .02, .2);
    EACH_ROW s->e[i] = c * pow(s->h[i], s->truth) * (1 + (i % 2 ? a : -a));
}

static void noise(struct br_random *r, struct br_error_line *s, size_t l, size_t m, double a)
{
    ladder(r, s, l, m, 2);
    s->truth = PICK(r, 1, 2, 3, 4);
    double c = constant_of(r);
    EACH_ROW s->e[i] = c * pow(s->h[i], s->truth) * exp(a * normal(r));
}

static void noise1(struct br_random *r, struct br_error_line *s)
{
    noise(r, s, 4, 8, .01);
}

static void noise5(struct br_random *r, struct br_error_line *s)
{
    noise(r, s, 5, 8, .05);
}

static void noise20(struct br_random *r, struct br_error_line *s)
{
    noise(r, s, 8, 12, .2);
}

static void adaptive(struct br_random *r, struct br_error_line *s)
{
    s->rows = whole(r, 8, 14);
    s->truth = PICK(r, 1, 2, 3, 4);
    double c = constant_of(r), h = .2;
    EACH_ROW
    {
        s->h[i] = h;
        h /= uniform(r, 1.2, 1.8);
        s->e[i] = c * pow(s->h[i], s->truth) * exp(.1 * normal(r));
    }
}

static void ratio11(struct br_random *r, struct br_error_line *s)
{
    ladder(r, s, 6, 10, 1.1);
    s->truth = PICK(r, 1, 2, 3, 4);
    double c = constant_of(r), a = uniform(r, -.3, .3) / s->h[0];
    EACH_ROW s->e[i] = digits(c * pow(s->h[i], s->truth) * (1 + a * s->h[i]), 6);
}

static void values(struct br_random *r, struct br_error_line *s)
{
    ladder(r, s, 4, 8, 2);
    s->values = true;
    s->truth = PICK(r, 1, 1.5, 2, 3, 4);
    const double limit = uniform(r, -3, 3);
    double c = constant_of(r) * .01 / pow(s->h[0], s->truth), a = uniform(r, -.3, .3) / s->h[0];
    EACH_ROW s->e[i] = limit + c * pow(s->h[i], s->truth) * (1 + a * s->h[i]);
}

static void oscillate(struct br_random *r, struct br_error_line *s)
{
    ladder(r, s, 5, 8, 2);
    s->values = true;
    s->truth = PICK(r, 1, 2, 3);
    const double limit = uniform(r, -3, 3);
    double c = .1 / pow(s->h[0], s->truth);
    EACH_ROW s->e[i] = limit + c * pow(s->h[i], s->truth) * (i % 2 ? -1 : 1);
}

static void lower(struct br_random *r, struct br_error_line *s)
{
    ladder(r, s, 4, 8, 2);
    double p = PICK(r, 2, 3, 4), q = PICK(r, 1, 1.5, 2, 3);
    while (q >= p)
        q = PICK(r, 1, 1.5, 2);
    s->truth = q;
    size_t m = s->rows - whole(r, 1, 2);
    double b = pow(s->h[m], p - q), c = constant_of(r);
    EACH_ROW s->e[i] = c * (pow(s->h[i], p) + b * pow(s->h[i], q));
}

static void lowervalue(struct br_random *r, struct br_error_line *s)
{
    ladder(r, s, 4, 8, 2);
    s->values = true;
    s->truth = 1;
    const double limit = uniform(r, .5, 3);
    double a = uniform(r, .5, 2), c = uniform(r, -.3, .3);
    EACH_ROW
    {
        double x = s->h[i] / s->h[0];
        s->e[i] = limit * (1 + c * (x + a * x * x));
    }
}

static void tied(struct br_random *r, struct br_error_line *s)
{
    ladder(r, s, 4, 7, 2);
    s->truth = 1;
    double a = br_random_decades(r, 0, 1.5), c = constant_of(r);
    EACH_ROW s->e[i] = c * (a / s->h[0] * s->h[i] * s->h[i] + s->h[i]);
}

static void floored(struct br_random *r, struct br_error_line *s)
{
    ladder(r, s, 5, 8, 2);
    s->truth = PICK(r, 1, 2, 3, 4);
    double c = constant_of(r);
    size_t m = s->rows - whole(r, 2, 4);
    double f = c * pow(s->h[m], s->truth);
    EACH_ROW s->e[i] = c * pow(s->h[i], s->truth) + f;
}

static void floorq(struct br_random *r, struct br_error_line *s)
{
    ladder(r, s, 5, 8, 2);
    s->truth = PICK(r, 1, 2, 3, 4);
    double c = constant_of(r);
    size_t m = s->rows - whole(r, 2, 4);
    double f = c * pow(s->h[m], s->truth);
    EACH_ROW s->e[i] = hypot(c * pow(s->h[i], s->truth), f);
}

static void saturated(struct br_random *r, struct br_error_line *s)
{
    ladder(r, s, 5, 8, 2);
    s->truth = PICK(r, 1, 2, 3);
    double c = constant_of(r), ref = s->h[s->rows - 1] / PICK(r, 1.5, 2, 4);
    EACH_ROW s->e[i] = c * (pow(s->h[i], s->truth) - pow(ref, s->truth));
}

static void norms(struct br_random *r, struct br_error_line *s)
{
    ladder(r, s, 4, 8, 2);
    bool b = r->state & 4;
    s->truth = b ? 2. / 3 : 4. / 3;
    double p = b ? 1 : 2, c = constant_of(r),
           a = br_random_decades(r, -1, .5) / pow(s->h[s->rows / 2], p - s->truth);
    EACH_ROW s->e[i] = c * hypot(pow(s->h[i], s->truth), a * pow(s->h[i], p));
}

static void logs(struct br_random *r, struct br_error_line *s)
{
    ladder(r, s, 4, 8, 2);
    s->truth = PICK(r, 1, 2);
    double c = constant_of(r), m = PICK(r, 1, .5, 1);
    EACH_ROW s->e[i] = c * pow(s->h[i], s->truth) * pow(fabs(log(s->h[i])), m);
}

static void change(struct br_random *r, struct br_error_line *s)
{
    ladder(r, s, 5, 8, 2);
    s->truth = order(r);
    double c = constant_of(r), at = s->h[s->rows - 1] * pow(2, uniform(r, .1, 2.5));
    EACH_ROW s->e[i] = c * fabs(pow(s->h[i], s->truth) - pow(s->h[i], s->truth + 1) / at);
}

static void changeearly(struct br_random *r, struct br_error_line *s)
{
    ladder(r, s, 6, 9, 2);
    s->truth = order(r);
    double c = constant_of(r), at = s->h[1] * pow(2, uniform(r, -1, 1));
    EACH_ROW s->e[i] = c * fabs(pow(s->h[i], s->truth) - pow(s->h[i], s->truth + 1) / at);
}

static void badcoarse(struct br_random *r, struct br_error_line *s)
{
    ladder(r, s, 5, 8, 2);
    s->truth = PICK(r, 1, 2, 3);
    double c = constant_of(r), a = uniform(r, -.1, .1) / s->h[0], f = br_random_decades(r, .3, 1.5);
    EACH_ROW s->e[i] = c * pow(s->h[i], s->truth) * (1 + a * s->h[i]);
    s->e[0] *= r->state & 8 ? f : 1 / f;
}

static void unresolved(struct br_random *r, struct br_error_line *s)
{
    ladder(r, s, 5, 9, 2);
    s->truth = PICK(r, 1, 2, 3);
    double c = constant_of(r), a = uniform(r, -.1, .1) / s->h[0];
    EACH_ROW s->e[i] = c * pow(s->h[i], s->truth) * (1 + a * s->h[i]);
    size_t m = whole(r, 1, s->rows - 4);
    double level = s->e[m];
    for (size_t i = 0; i < m; i++)
        s->e[i] = level * uniform(r, .6, 1.6);
}

static void outlier(struct br_random *r, struct br_error_line *s)
{
    ladder(r, s, 5, 9, 2);
    s->truth = PICK(r, 1, 2, 3);
    double c = constant_of(r), a = uniform(r, -.1, .1) / s->h[0];
    EACH_ROW s->e[i] = c * pow(s->h[i], s->truth) * (1 + a * s->h[i]);
    double f = br_random_decades(r, .3, 1);
    s->e[whole(r, 1, s->rows - 2)] *= r->state & 8 ? f : 1 / f;
}

static void locking(struct br_random *r, struct br_error_line *s)
{
    ladder(r, s, 6, 9, 2);
    s->truth = PICK(r, 1, 2);
    double c = constant_of(r), t = s->h[whole(r, 0, 2)];
    EACH_ROW
    {
        double x = pow(s->h[i] / t, s->truth);
        s->e[i] = c * x / (1 + x);
    }
}

static void three(struct br_random *r, struct br_error_line *s)
{
    ladder(r, s, 3, 3, 2);
    s->truth = order(r);
    double c = constant_of(r), a = uniform(r, -.2, .2) / s->h[0];
    EACH_ROW s->e[i] = digits(c * pow(s->h[i], s->truth) * (1 + a * s->h[i]), 5);
}

static void mcone(struct br_random *r, struct br_error_line *s)
{
    s->rows = whole(r, 6, 14);
    s->truth = .5;
    EACH_ROW
    {
        s->h[i] = pow(.25, (double)i);
        s->e[i] = sqrt(s->h[i]) * fabs(normal(r));
    }
}

static void mcrms(struct br_random *r, struct br_error_line *s)
{
    s->rows = whole(r, 5, 10);
    s->truth = .5;
    EACH_ROW
    {
        s->h[i] = pow(.25, (double)i);
        double q = 0;
        for (int j = 0; j < 50; j++) {
            double g = normal(r);
            q += g * g;
        }
        s->e[i] = sqrt(s->h[i] * q / 50);
    }
}

/* Means of runs that scatter, from row to row by other amounts, with the deviations that the runs
 * show, as of orders --repeat. */
static void means(struct br_random *r, struct br_error_line *s, double next)
{
    const size_t runs = whole(r, 4, 12);
    ladder(r, s, 4, 8, 2);
    s->truth = PICK(r, .5, 1, 2);
    const double c = constant_of(r), a = uniform(r, -next, next) / s->h[0];
    EACH_ROW
    {
        const double scatter = br_random_decades(r, -2, -.5);
        double sum = 0, squares = 0;
        for (size_t j = 0; j < runs; j++) {
            const double e =
                c * pow(s->h[i], s->truth) * (1 + a * s->h[i]) * (1 + scatter * normal(r));
            sum += e, squares += e * e;
        }
        const double n = (double)runs;
        s->e[i] = sum / n;
        s->deviation[i] = sqrt((squares - sum * sum / n) / (n - 1) / n);
    }
}

static void means0(struct br_random *r, struct br_error_line *s)
{
    means(r, s, 0);
}

static void means1(struct br_random *r, struct br_error_line *s)
{
    means(r, s, .5);
}

static void mixed(struct br_random *r, struct br_error_line *s)
{
    lower(r, s);
    EACH_ROW s->e[i] *= exp(.02 * normal(r));
}

static void nextnoise(struct br_random *r, struct br_error_line *s)
{
    ladder(r, s, 5, 8, 2);
    s->truth = PICK(r, 1, 2, 3);
    double c = constant_of(r), a = uniform(r, -.5, .8) / s->h[0];
    EACH_ROW s->e[i] = c * pow(s->h[i], s->truth) * (1 + a * s->h[i]) * exp(.02 * normal(r));
}

static void floornoise(struct br_random *r, struct br_error_line *s)
{
    floored(r, s);
    EACH_ROW s->e[i] *= exp(.03 * normal(r));
}

static void fewlow(struct br_random *r, struct br_error_line *s)
{
    ladder(r, s, 4, 5, 2);
    s->truth = PICK(r, 1, 2);
    double c = constant_of(r), a = uniform(r, .5, 3) / s->h[0];
    EACH_ROW s->e[i] = c * pow(s->h[i], s->truth) * (1 + a * s->h[i]);
}

static void layers(struct br_random *r, struct br_error_line *s)
{
    ladder(r, s, 6, 9, 2);
    s->truth = 2;
    double c = constant_of(r), t = s->h[whole(r, 0, 2)];
    EACH_ROW
    {
        double x = s->h[i] / t;
        s->e[i] = c * (1 - 2 / (exp(x) + exp(-x)));
    }
}

static void constant(struct br_random *r, struct br_error_line *s)
{
    ladder(r, s, 4, 8, 2);
    s->truth = NAN;
    double c = constant_of(r), a = uniform(r, 0, .3);
    EACH_ROW s->e[i] = c * (1 + a * pow(s->h[i] / s->h[0], 2));
}

static void grows(struct br_random *r, struct br_error_line *s)
{
    ladder(r, s, 4, 8, 2);
    s->truth = NAN;
    double c = constant_of(r), g = uniform(r, .5, 5);
    EACH_ROW s->e[i] = c * pow(s->h[i], -g) * exp(.1 * normal(r));
}

static void scatter(struct br_random *r, struct br_error_line *s)
{
    ladder(r, s, 4, 10, 2);
    s->truth = NAN;
    EACH_ROW s->e[i] = exp(normal(r));
}

static void dipped(struct br_random *r, struct br_error_line *s)
{
    ladder(r, s, 5, 8, 2);
    s->truth = NAN;
    double c = constant_of(r), at = s->h[s->rows - 1] * pow(2, uniform(r, .5, 2.5));
    EACH_ROW s->e[i] = c * fabs(pow(s->h[i], 2) - at * at);
}

const struct br_error_class br_error_classes[] = {
    {"one power, 4 to 16 digits", BR_SMOOTH_ERRORS, clean},
    {"next term h", BR_SMOOTH_ERRORS, next1},
    {"next term h^2", BR_SMOOTH_ERRORS, next2},
    {"three terms", BR_SMOOTH_ERRORS, series},
    {"random ratios", BR_SMOOTH_ERRORS, ratios},
    {"linear ladder", BR_SMOOTH_ERRORS, linear},
    {"ratio sqrt 2", BR_SMOOTH_ERRORS, root2},
    {"ratio 1.1", BR_SMOOTH_ERRORS, ratio11},
    {"round-off", BR_SMOOTH_ERRORS, roundoff},
    {"even-odd", BR_SMOOTH_ERRORS, evenodd},
    {"values", BR_SMOOTH_ERRORS, values},
    {"values that oscillate", BR_SMOOTH_ERRORS, oscillate},
    {"1 % noise", BR_NOISY_ERRORS, noise1},
    {"5 % noise", BR_NOISY_ERRORS, noise5},
    {"20 % noise, 8 to 12 rows", BR_NOISY_ERRORS, noise20},
    {"adaptive, 10 % scatter", BR_NOISY_ERRORS, adaptive},
    {"Monte Carlo, RMS of 50", BR_NOISY_ERRORS, mcrms},
    {"means of runs", BR_NOISY_ERRORS, means0},
    {"means of runs, next term", BR_HARD_ERRORS, means1},
    {"next term, 2 % noise", BR_HARD_ERRORS, nextnoise},
    {"lower power comes up", BR_HARD_ERRORS, lower},
    {"the same with 2 % noise", BR_HARD_ERRORS, mixed},
    {"lower power, values", BR_HARD_ERRORS, lowervalue},
    {"k tied to h", BR_HARD_ERRORS, tied},
    {"few rows, lower power", BR_HARD_ERRORS, fewlow},
    {"floor, added", BR_HARD_ERRORS, floored},
    {"floor, by squares", BR_HARD_ERRORS, floorq},
    {"floor, 3 % noise", BR_HARD_ERRORS, floornoise},
    {"saturated reference", BR_HARD_ERRORS, saturated},
    {"sum of squares", BR_HARD_ERRORS, norms},
    {"logarithm", BR_HARD_ERRORS, logs},
    {"sign change at the end", BR_HARD_ERRORS, change},
    {"sign change, early", BR_HARD_ERRORS, changeearly},
    {"bad coarse mesh", BR_HARD_ERRORS, badcoarse},
    {"unresolved coarse", BR_HARD_ERRORS, unresolved},
    {"outlier inside", BR_HARD_ERRORS, outlier},
    {"locking", BR_HARD_ERRORS, locking},
    {"layer", BR_HARD_ERRORS, layers},
    {"three rows", BR_HARD_ERRORS, three},
    {"Monte Carlo, single", BR_HARD_ERRORS, mcone},
    {"constant", BR_NO_ORDER, constant},
    {"grows", BR_NO_ORDER, grows},
    {"scatter", BR_NO_ORDER, scatter},
    {"passes zero to a level", BR_NO_ORDER, dipped},
    {NULL, BR_NO_ORDER, NULL},
};
