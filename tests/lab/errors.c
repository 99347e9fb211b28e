/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tests/lab/draw.h"

static void clean(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 4, 8, 2);
    s->truth = order(r);
    double c = constant_of(r);
    int d = (int)whole(r, 4, 16);
    EACH_ROW s->e[i] = digits(c * pow(s->h[i], s->truth), d);
}

static void next(struct br_test_random *r, struct br_error_line *s, double by)
{
    mesh_sequence(r, s, 4, 8, 2);
    s->truth = order(r);
    double c = constant_of(r), a = uniform(r, -.5, .5) / pow(s->h[0], by);
    EACH_ROW s->e[i] = digits(c * pow(s->h[i], s->truth) * (1 + a * pow(s->h[i], by)), 6);
}

static void next1(struct br_test_random *r, struct br_error_line *s)
{
    next(r, s, 1);
}

static void next2(struct br_test_random *r, struct br_error_line *s)
{
    next(r, s, 2);
}

static void series(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 4, 8, 2);
    s->truth = PICK(r, 1, 2, 4);
    double c = constant_of(r), a = uniform(r, -.5, .5), b = uniform(r, -.3, .3), h0 = s->h[0];
    EACH_ROW
    {
        double x = s->h[i] / h0;
        s->e[i] = c * pow(s->h[i], s->truth) * (1 + a * x + b * x * x - b * a * x * x * x);
    }
}

static void ratios(struct br_test_random *r, struct br_error_line *s)
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

static void linear(struct br_test_random *r, struct br_error_line *s)
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

static void root2(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 4, 8, sqrt(2));
    s->truth = order(r);
    double c = constant_of(r), a = uniform(r, -.3, .3) / s->h[0];
    EACH_ROW s->e[i] = digits(c * pow(s->h[i], s->truth) * (1 + a * s->h[i]), 5);
}

static void roundoff(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 6, 9, 2);
    s->truth = PICK(r, 2, 3, 4);
    double c = constant_of(r);
    size_t meet = s->rows - whole(r, 1, 3);
    double f = c * pow(s->h[meet], s->truth), g = PICK(r, 0, .5, 1, 2);
    EACH_ROW s->e[i] =
        fabs(c * pow(s->h[i], s->truth) + f * normal(r) * .3 * pow(s->h[meet] / s->h[i], g));
}

static void evenodd(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 5, 9, 2);
    s->truth = order(r);
    double c = constant_of(r), a = uniform(r, .02, .2);
    EACH_ROW s->e[i] = c * pow(s->h[i], s->truth) * (1 + (i % 2 ? a : -a));
}

static void noise(struct br_test_random *r, struct br_error_line *s, size_t l, size_t m, double a)
{
    mesh_sequence(r, s, l, m, 2);
    s->truth = PICK(r, 1, 2, 3, 4);
    double c = constant_of(r);
    EACH_ROW s->e[i] = c * pow(s->h[i], s->truth) * exp(a * normal(r));
}

static void noise1(struct br_test_random *r, struct br_error_line *s)
{
    noise(r, s, 4, 8, .01);
}

static void noise5(struct br_test_random *r, struct br_error_line *s)
{
    noise(r, s, 5, 8, .05);
}

static void noise20(struct br_test_random *r, struct br_error_line *s)
{
    noise(r, s, 8, 12, .2);
}

static void adaptive(struct br_test_random *r, struct br_error_line *s)
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

static void ratio11(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 6, 10, 1.1);
    s->truth = PICK(r, 1, 2, 3, 4);
    double c = constant_of(r), a = uniform(r, -.3, .3) / s->h[0];
    EACH_ROW s->e[i] = digits(c * pow(s->h[i], s->truth) * (1 + a * s->h[i]), 6);
}

static void values(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 4, 8, 2);
    s->values = true;
    s->truth = PICK(r, 1, 1.5, 2, 3, 4);
    const double limit = s->limit = uniform(r, -3, 3);
    double c = constant_of(r) * .01 / pow(s->h[0], s->truth), a = uniform(r, -.3, .3) / s->h[0];
    EACH_ROW s->e[i] = limit + c * pow(s->h[i], s->truth) * (1 + a * s->h[i]);
}

static void oscillate(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 5, 8, 2);
    s->values = true;
    s->truth = PICK(r, 1, 2, 3);
    const double limit = s->limit = uniform(r, -3, 3);
    double c = .1 / pow(s->h[0], s->truth);
    EACH_ROW s->e[i] = limit + c * pow(s->h[i], s->truth) * (i % 2 ? -1 : 1);
}

static void lower(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 4, 8, 2);
    double p = PICK(r, 2, 3, 4), q = PICK(r, 1, 1.5, 2, 3);
    while (q >= p)
        q = PICK(r, 1, 1.5, 2);
    s->truth = q;
    size_t m = s->rows - whole(r, 1, 2);
    double b = pow(s->h[m], p - q), c = constant_of(r);
    EACH_ROW s->e[i] = c * (pow(s->h[i], p) + b * pow(s->h[i], q));
}

static void lowervalue(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 4, 8, 2);
    s->values = true;
    s->truth = 1;
    const double limit = s->limit = uniform(r, .5, 3);
    double a = uniform(r, .5, 2), c = uniform(r, -.3, .3);
    EACH_ROW
    {
        double x = s->h[i] / s->h[0];
        s->e[i] = limit * (1 + c * (x + a * x * x));
    }
}

static void tied(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 4, 7, 2);
    s->truth = 1;
    double a = br_test_decades(r, 0, 1.5), c = constant_of(r);
    EACH_ROW s->e[i] = c * (a / s->h[0] * s->h[i] * s->h[i] + s->h[i]);
}

static void floored(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 5, 8, 2);
    s->truth = PICK(r, 1, 2, 3, 4);
    double c = constant_of(r);
    size_t m = s->rows - whole(r, 2, 4);
    double f = c * pow(s->h[m], s->truth);
    EACH_ROW s->e[i] = c * pow(s->h[i], s->truth) + f;
}

static void floorq(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 5, 8, 2);
    s->truth = PICK(r, 1, 2, 3, 4);
    double c = constant_of(r);
    size_t m = s->rows - whole(r, 2, 4);
    double f = c * pow(s->h[m], s->truth);
    EACH_ROW s->e[i] = hypot(c * pow(s->h[i], s->truth), f);
}

static void saturated(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 5, 8, 2);
    s->truth = PICK(r, 1, 2, 3);
    double c = constant_of(r), ref = s->h[s->rows - 1] / PICK(r, 1.5, 2, 4);
    EACH_ROW s->e[i] = c * (pow(s->h[i], s->truth) - pow(ref, s->truth));
}

static void norms(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 4, 8, 2);
    bool b = r->state & 4;
    s->truth = b ? 2. / 3 : 4. / 3;
    double p = b ? 1 : 2, c = constant_of(r),
           a = br_test_decades(r, -1, .5) / pow(s->h[s->rows / 2], p - s->truth);
    EACH_ROW s->e[i] = c * hypot(pow(s->h[i], s->truth), a * pow(s->h[i], p));
}

static void logs(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 4, 8, 2);
    s->truth = PICK(r, 1, 2);
    double c = constant_of(r), m = PICK(r, 1, .5, 1);
    EACH_ROW s->e[i] = c * pow(s->h[i], s->truth) * pow(fabs(log(s->h[i])), m);
}

static void change(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 5, 8, 2);
    s->truth = order(r);
    double c = constant_of(r), at = s->h[s->rows - 1] * pow(2, uniform(r, .1, 2.5));
    EACH_ROW s->e[i] = c * fabs(pow(s->h[i], s->truth) - pow(s->h[i], s->truth + 1) / at);
}

static void changeearly(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 6, 9, 2);
    s->truth = order(r);
    double c = constant_of(r), at = s->h[1] * pow(2, uniform(r, -1, 1));
    EACH_ROW s->e[i] = c * fabs(pow(s->h[i], s->truth) - pow(s->h[i], s->truth + 1) / at);
}

static void badcoarse(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 5, 8, 2);
    s->truth = PICK(r, 1, 2, 3);
    double c = constant_of(r), a = uniform(r, -.1, .1) / s->h[0], f = br_test_decades(r, .3, 1.5);
    EACH_ROW s->e[i] = c * pow(s->h[i], s->truth) * (1 + a * s->h[i]);
    s->e[0] *= r->state & 8 ? f : 1 / f;
}

static void unresolved(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 5, 9, 2);
    s->truth = PICK(r, 1, 2, 3);
    double c = constant_of(r), a = uniform(r, -.1, .1) / s->h[0];
    EACH_ROW s->e[i] = c * pow(s->h[i], s->truth) * (1 + a * s->h[i]);
    size_t m = whole(r, 1, s->rows - 4);
    double level = s->e[m];
    for (size_t i = 0; i < m; i++)
        s->e[i] = level * uniform(r, .6, 1.6);
}

static void outlier(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 5, 9, 2);
    s->truth = PICK(r, 1, 2, 3);
    double c = constant_of(r), a = uniform(r, -.1, .1) / s->h[0];
    EACH_ROW s->e[i] = c * pow(s->h[i], s->truth) * (1 + a * s->h[i]);
    double f = br_test_decades(r, .3, 1);
    s->e[whole(r, 1, s->rows - 2)] *= r->state & 8 ? f : 1 / f;
}

static void locking(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 6, 9, 2);
    s->truth = PICK(r, 1, 2);
    double c = constant_of(r), t = s->h[whole(r, 0, 2)];
    EACH_ROW
    {
        double x = pow(s->h[i] / t, s->truth);
        s->e[i] = c * x / (1 + x);
    }
}

static void three(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 3, 3, 2);
    s->truth = order(r);
    double c = constant_of(r), a = uniform(r, -.2, .2) / s->h[0];
    EACH_ROW s->e[i] = digits(c * pow(s->h[i], s->truth) * (1 + a * s->h[i]), 5);
}

static void mcone(struct br_test_random *r, struct br_error_line *s)
{
    s->rows = whole(r, 6, 14);
    s->truth = .5;
    EACH_ROW
    {
        s->h[i] = pow(.25, (double)i);
        s->e[i] = sqrt(s->h[i]) * fabs(normal(r));
    }
}

static void mcrms(struct br_test_random *r, struct br_error_line *s)
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
static void means(struct br_test_random *r, struct br_error_line *s, double next)
{
    const size_t runs = whole(r, 4, 12);
    mesh_sequence(r, s, 4, 8, 2);
    s->truth = PICK(r, .5, 1, 2);
    const double c = constant_of(r), a = uniform(r, -next, next) / s->h[0];
    EACH_ROW
    {
        const double scatter = br_test_decades(r, -2, -.5);
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

static void means0(struct br_test_random *r, struct br_error_line *s)
{
    means(r, s, 0);
}

static void means1(struct br_test_random *r, struct br_error_line *s)
{
    means(r, s, .5);
}

static void mixed(struct br_test_random *r, struct br_error_line *s)
{
    lower(r, s);
    EACH_ROW s->e[i] *= exp(.02 * normal(r));
}

static void nextnoise(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 5, 8, 2);
    s->truth = PICK(r, 1, 2, 3);
    double c = constant_of(r), a = uniform(r, -.5, .8) / s->h[0];
    EACH_ROW s->e[i] = c * pow(s->h[i], s->truth) * (1 + a * s->h[i]) * exp(.02 * normal(r));
}

static void floornoise(struct br_test_random *r, struct br_error_line *s)
{
    floored(r, s);
    EACH_ROW s->e[i] *= exp(.03 * normal(r));
}

static void fewlow(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 4, 5, 2);
    s->truth = PICK(r, 1, 2);
    double c = constant_of(r), a = uniform(r, .5, 3) / s->h[0];
    EACH_ROW s->e[i] = c * pow(s->h[i], s->truth) * (1 + a * s->h[i]);
}

static void layers(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 6, 9, 2);
    s->truth = 2;
    double c = constant_of(r), t = s->h[whole(r, 0, 2)];
    EACH_ROW
    {
        double x = s->h[i] / t;
        s->e[i] = c * (1 - 2 / (exp(x) + exp(-x)));
    }
}

static void constant(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 4, 8, 2);
    s->truth = NAN;
    double c = constant_of(r), a = uniform(r, 0, .3);
    EACH_ROW s->e[i] = c * (1 + a * pow(s->h[i] / s->h[0], 2));
}

static void grows(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 4, 8, 2);
    s->truth = NAN;
    double c = constant_of(r), g = uniform(r, .5, 5);
    EACH_ROW s->e[i] = c * pow(s->h[i], -g) * exp(.1 * normal(r));
}

static void scatter(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 4, 10, 2);
    s->truth = NAN;
    EACH_ROW s->e[i] = exp(normal(r));
}

static void dipped(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 5, 8, 2);
    s->truth = NAN;
    double c = constant_of(r), at = s->h[s->rows - 1] * pow(2, uniform(r, .5, 2.5));
    EACH_ROW s->e[i] = c * fabs(pow(s->h[i], 2) - at * at);
}

/* ---- of two minds: the order may be that of the coarse rows or that of the finest ones ---- */

/* Errors whose order from row to row is p, and q between the last ones. */
static void kinked(struct br_test_random *r, struct br_error_line *s, double p, double q,
                   size_t last)
{
    s->other = p;
    s->truth = q;
    s->e[0] = constant_of(r);
    for (size_t i = 1; i < s->rows; i++)
        s->e[i] = s->e[i - 1] * pow(s->h[i] / s->h[i - 1], i + last < s->rows ? p : q);
}

static void drops(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 7, 9, 2);
    kinked(r, s, PICK(r, 3, 4), PICK(r, 1, 2), 3);
    const double deep = br_test_decades(r, -8, -7) / s->e[s->rows - 1];
    EACH_ROW s->e[i] = digits(deep * s->e[i], 6);
}

static void rises(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 6, 9, 2);
    const double p = PICK(r, 1, 1.5, 2, 2.5);
    kinked(r, s, p, p + uniform(r, .4, 1), 2);
    EACH_ROW s->e[i] = digits(s->e[i], 5);
}

static void kink(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 6, 10, PICK(r, 2, 2, 1.5));
    const double p = PICK(r, 1.5, 2, 3, 4);
    kinked(r, s, p, p - uniform(r, .4, 1), 2);
}

static void kink3(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 6, 10, 2);
    const double p = PICK(r, 1.5, 2, 3, 4);
    kinked(r, s, p, p - uniform(r, .4, 1), 3);
}

/* The largest of two errors at two places. */
static void maximum(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 5, 9, 2);
    s->other = PICK(r, 2, 2.5, 3);
    s->truth = s->other - PICK(r, .5, 1);
    const double meet = s->h[s->rows - 1] * pow(2, uniform(r, 1, 2.9));
    const double c = constant_of(r), d = c * pow(meet, s->other - s->truth);
    EACH_ROW s->e[i] = fmax(c * pow(s->h[i], s->other), d * pow(s->h[i], s->truth));
}

/* Values whose differences fall as errors of a kink do. Their limit is that of the finest rows. */
static void kinkedvalues(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 6, 9, 2);
    s->values = true;
    const double p = PICK(r, 2, 3), q = p - PICK(r, .5, 1);
    kinked(r, s, p, q, 3); /* rows - 1 differences, so two rates of q */
    double value = uniform(r, -3, 3);
    const double unit = uniform(r, -.1, .1) / s->e[0];
    EACH_ROW
    {
        const double change = unit * s->e[i];
        s->e[i] = value;
        value += change;
        s->limit = value + change / (pow(2, q) - 1);
    }
}

/* ---- laws beside the common ones ---- */

static void powerlogs(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 4, 9, 2);
    s->truth = PICK(r, 1, 2);
    const double c = constant_of(r), g = PICK(r, 1.5, 2, -1);
    EACH_ROW s->e[i] = c * pow(s->h[i], s->truth) * pow(fabs(log(s->h[i])), g);
}

static void halves(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 5, 9, 2);
    s->truth = PICK(r, 1, 1.5, 2);
    const double c = constant_of(r), a = uniform(r, -.6, 1.5), b = uniform(r, -.3, 1);
    EACH_ROW
    {
        const double x = s->h[i] / s->h[0];
        s->e[i] = c * pow(x, s->truth) * (1 + a * sqrt(x) + b * x);
    }
}

static void reference(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 4, 8, 2);
    s->truth = PICK(r, 1, 2, 3);
    const double c = constant_of(r), a = uniform(r, -.4, .6) / s->h[0];
    const double h = s->h[s->rows - 1] / PICK(r, 1.5, 2, 4);
    EACH_ROW s->e[i] =
        c * (pow(s->h[i], s->truth) * (1 + a * s->h[i]) - pow(h, s->truth) * (1 + a * h));
}

static void plateau(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 6, 9, 2);
    s->truth = PICK(r, 1, 2, 3, 4);
    const double c = constant_of(r), by = uniform(r, .1, .5);
    const size_t good = s->rows - whole(r, 1, 3);
    const double level = c * pow(s->h[good], s->truth) * br_test_decades(r, 0, .5);
    EACH_ROW s->e[i] =
        digits(c * pow(s->h[i], s->truth) + level * exp(by * normal(r)) * (i >= good), 5);
}

static void growingroundoff(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 8, 14, 2);
    s->truth = PICK(r, 2, 3, 4);
    const double c = constant_of(r), g = PICK(r, 1, 2);
    const size_t good = whole(r, 4, s->rows - 3);
    const double level = c * pow(s->h[good], s->truth) * br_test_decades(r, -1, 0);
    EACH_ROW s->e[i] = digits(
        fabs(c * pow(s->h[i], s->truth) + level * normal(r) * pow(s->h[good] / s->h[i], g)), 4);
}

static void highorder(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 3, 3, 2);
    s->truth = (double)whole(r, 6, 12);
    const double c = constant_of(r), a = uniform(r, -.2, .2) / s->h[0];
    EACH_ROW s->e[i] = digits(c * pow(s->h[i], s->truth) * (1 + a * s->h[i]), 5);
}

static void roundofffloor(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 6, 10, 2);
    s->truth = PICK(r, 1, 2, 3, 4);
    const double c = constant_of(r);
    const size_t good = s->rows - whole(r, 2, 4);
    const double level = c * pow(s->h[good], s->truth);
    EACH_ROW s->e[i] = fabs(c * pow(s->h[i], s->truth) + level * normal(r));
}

static void floorvalues(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 6, 9, 2);
    s->values = true;
    s->limit = uniform(r, -3, 3);
    s->truth = PICK(r, 1, 2, 3);
    const double c = uniform(r, .01, .3) / pow(s->h[0], s->truth);
    const double level = c * pow(s->h[s->rows - whole(r, 2, 3)], s->truth);
    EACH_ROW s->e[i] = s->limit + c * pow(s->h[i], s->truth) + .5 * level * normal(r);
}

static void zeroorder(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 3, 10, 2);
    const double c = constant_of(r), by = br_test_decades(r, -3, -.5);
    const int d = (int)whole(r, 2, 6);
    EACH_ROW s->e[i] = digits(c * exp(by * normal(r)), d);
}

static void turns(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 6, 10, 2);
    const double c = constant_of(r), p = PICK(r, 1, 2), g = uniform(r, .7, 3);
    const double at = s->h[s->rows - whole(r, 3, 4)];
    EACH_ROW s->e[i] = c * (pow(s->h[i] / at, p) + pow(at / s->h[i], g)) * exp(.02 * normal(r));
}

/* ---- limits ---- */

/* Values L + d x^p (1 + a x), x relative to the coarsest size. */
static void powervalues(struct br_test_random *r, struct br_error_line *s, double next)
{
    s->values = true;
    s->limit = uniform(r, -3, 3);
    s->truth = PICK(r, 1, 1.5, 2, 3, 4);
    const double d = br_test_decades(r, -3, 0) * PICK(r, -1, 1), a = uniform(r, -next, next);
    EACH_ROW
    {
        const double x = s->h[i] / s->h[0];
        s->e[i] = s->limit + d * pow(x, s->truth) * (1 + a * x);
    }
}

static void cleanlimit(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 4, 8, PICK(r, 2, 2, 1.5));
    powervalues(r, s, 0);
}

static void cleanlimit3(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 3, 3, PICK(r, 2, 2, 1.5));
    powervalues(r, s, 0);
}

static void nextlimit3(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 3, 3, PICK(r, 2, 2, 1.5));
    powervalues(r, s, .5);
}

static void badlimit(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 5, 8, 2);
    powervalues(r, s, 0);
    s->e[0] += (s->e[0] - s->limit) * PICK(r, -1, 1) * br_test_decades(r, -.3, 1);
}

/* A lower power that comes up within the rows, after p - q of 1 or 2. */
static void lowerlimit(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 4, 8, 2);
    powervalues(r, s, 0);
    s->truth = PICK(r, 1, 2);
    const double p = s->truth + PICK(r, 1, 2), d = uniform(r, -.3, .3);
    const double meet = s->h[s->rows - whole(r, 1, 3)] / s->h[0];
    EACH_ROW
    {
        const double x = s->h[i] / s->h[0];
        s->e[i] = s->limit + d * (pow(x, p) + pow(meet, p - s->truth) * pow(x, s->truth));
    }
}

/* Values with so many decimals that the finest of them differ by 0.3, 1 or 3 units. */
static void rounded(struct br_test_random *r, struct br_error_line *s)
{
    powervalues(r, s, .2);
    const double last = fabs(s->e[s->rows - 1] - s->e[s->rows - 2]);
    const double decimals = fmax(0, round(log10(PICK(r, .3, 1, 3) / last)));
    EACH_ROW
    {
        char text[64];
        snprintf(text, sizeof text, "%.*f", (int)decimals, s->e[i]);
        s->e[i] = strtod(text, NULL);
    }
}

static void rounded3(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 3, 3, 2);
    rounded(r, s);
}

static void rounded7(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 4, 7, 2);
    rounded(r, s);
}

/* Noise of so much of the finest difference. */
static void noisevalues(struct br_test_random *r, struct br_error_line *s, double noise)
{
    mesh_sequence(r, s, 4, 8, 2);
    powervalues(r, s, .2);
    noise *= s->e[s->rows - 1] - s->e[s->rows - 2];
    EACH_ROW s->e[i] += noise * normal(r);
}

static void noiselimit1(struct br_test_random *r, struct br_error_line *s)
{
    noisevalues(r, s, .01);
}

static void noiselimit20(struct br_test_random *r, struct br_error_line *s)
{
    noisevalues(r, s, .2);
}

static void cubics(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 3, 8, 2);
    s->values = true;
    s->truth = 1;
    s->limit = uniform(r, -3, 3);
    const double a = uniform(r, .2, 1), b = uniform(r, -1, 1), c = uniform(r, -1, 1);
    EACH_ROW
    {
        const double x = s->h[i] / s->h[0];
        s->e[i] = s->limit + x * (a + x * (b + x * c));
    }
}

/* The integral of exp(a x) sin(b x + 1) from 0 to 1 by midpoints, trapezoids or Simpson's rule. */
static void quadrature(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 3, 8, 2);
    s->values = true;
    const double a = uniform(r, -2, 2), b = uniform(r, .5, 6);
    const size_t rule = br_test_index(r, 3);
    s->truth = rule == 2 ? 4 : 2;
    s->limit =
        (exp(a) * (a * sin(b + 1) - b * cos(b + 1)) - a * sin(1) + b * cos(1)) / (a * a + b * b);
    EACH_ROW
    {
        const size_t n = (size_t)round(1 / s->h[i]);
        double sum = 0;
        for (size_t j = 0; j < n; j++) {
            const double x = (double)j / (double)n, m = x + .5 / (double)n, y = x + 1 / (double)n;
            const double middle = exp(a * m) * sin(b * m + 1);
            const double ends = (exp(a * x) * sin(b * x + 1) + exp(a * y) * sin(b * y + 1)) / 2;
            sum += rule == 0 ? middle : rule == 1 ? ends : (2 * middle + ends) / 3;
        }
        s->e[i] = sum / (double)n;
    }
}

/* y' = -a y + sin(b t), y = 1 at t = 0, at t = 1, by Euler's, the midpoint and the classical
 * method. */
static void ode(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 3, 8, 2);
    s->values = true;
    const double a = uniform(r, .5, 3), b = uniform(r, .5, 5), d = a * a + b * b;
    const size_t method = br_test_index(r, 3);
    s->truth = method == 0 ? 1 : method == 1 ? 2 : 4;
    s->limit = (a * sin(b) - b * cos(b)) / d + (1 + b / d) * exp(-a);
    EACH_ROW
    {
        const size_t n = (size_t)round(1 / s->h[i]);
        const double h = 1 / (double)n;
        double y = 1;
        for (size_t j = 0; j < n; j++) {
            const double t = (double)j * h, middle = sin(b * (t + h / 2));
            const double k1 = -a * y + sin(b * t), k2 = -a * (y + h / 2 * k1) + middle;
            const double k3 = -a * (y + h / 2 * k2) + middle;
            const double k4 = -a * (y + h * k3) + sin(b * (t + h));
            y += h * (method == 0 ? k1 : method == 1 ? k2 : (k1 + 2 * (k2 + k3) + k4) / 6);
        }
        s->e[i] = y;
    }
}

static void diverging(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 3, 9, 2);
    s->values = true;
    const double start = uniform(r, -3, 3), c = uniform(r, -1, 1), g = uniform(r, .05, 1.5);
    EACH_ROW s->e[i] = start + c * pow(s->h[0] / s->h[i], g);
}

static void logvalues(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 4, 10, 2);
    s->values = true;
    const double start = uniform(r, -3, 3), c = uniform(r, .1, 1) * PICK(r, -1, 1);
    const bool twice = br_test_once_in(r, 4);
    EACH_ROW
    {
        const double l = -log(s->h[i]);
        s->e[i] = start + c * (twice ? log(l) : l);
    }
}

/* Errors z^p log(1/z), of sizes in one ratio or in several. */
static void logarithmlimit(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 4, 8, 2);
    s->values = true;
    s->truth = PICK(r, .5, 1, 1.5, 2, 3);
    s->limit = uniform(r, -3, 3);
    const double c = uniform(r, .1, 1) * PICK(r, -1, 1), from = uniform(r, 1, 4);
    const bool uneven = br_test_once_in(r, 2);
    for (size_t i = 1; i < s->rows && uneven; i++)
        s->h[i] = s->h[i - 1] / uniform(r, 1.5, 3);
    EACH_ROW
    {
        const double z = s->h[i] / s->h[0];
        s->e[i] = s->limit + c * pow(z, s->truth) * (from - log(z));
    }
}

const struct br_error_class br_error_classes[] = {
    {"one power, 4 to 16 digits", BR_SMOOTH_ERRORS, clean},
    {"next term h", BR_SMOOTH_ERRORS, next1},
    {"next term h^2", BR_SMOOTH_ERRORS, next2},
    {"three terms", BR_SMOOTH_ERRORS, series},
    {"random ratios", BR_SMOOTH_ERRORS, ratios},
    {"linear sequence", BR_SMOOTH_ERRORS, linear},
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
    {"power drops at the end", BR_TWO_ORDERS, drops},
    {"rate rises at the end", BR_TWO_ORDERS, rises},
    {"kink, three finest", BR_TWO_ORDERS, kink},
    {"kink, four finest", BR_TWO_ORDERS, kink3},
    {"maximum of two places", BR_TWO_ORDERS, maximum},
    {"kink of values", BR_TWO_ORDERS, kinkedvalues},
    {"powers of the logarithm", BR_HARD_ERRORS, powerlogs},
    {"p, p + 1/2, p + 1", BR_HARD_ERRORS, halves},
    {"near reference, next term", BR_HARD_ERRORS, reference},
    {"plateau of iteration", BR_HARD_ERRORS, plateau},
    {"growing round-off, 8 to 14", BR_HARD_ERRORS, growingroundoff},
    {"order 6 to 12, three rows", BR_HARD_ERRORS, highorder},
    {"floor of round-off", BR_HARD_ERRORS, roundofffloor},
    {"values with a floor", BR_HARD_ERRORS, floorvalues},
    {"order zero", BR_NO_ORDER, zeroorder},
    {"values like log n", BR_NO_ORDER, logvalues},
    {"falls, then grows", BR_GROWTH, turns},
    {NULL, BR_NO_ORDER, NULL},
};

const struct br_error_class br_limit_classes[] = {
    {"limits: clean", BR_NOISY_ERRORS, cleanlimit},
    {"limits: clean, three rows", BR_NOISY_ERRORS, cleanlimit3},
    {"limits: next, three rows", BR_NOISY_ERRORS, nextlimit3},
    {"limits: bad coarse row", BR_NOISY_ERRORS, badlimit},
    {"limits: lower power", BR_NOISY_ERRORS, lowerlimit},
    {"limits: rounded, three", BR_NOISY_ERRORS, rounded3},
    {"limits: rounded, 4 to 7", BR_NOISY_ERRORS, rounded7},
    {"limits: 1 % noise", BR_NOISY_ERRORS, noiselimit1},
    {"limits: 20 % noise", BR_NOISY_ERRORS, noiselimit20},
    {"limits: floor", BR_NOISY_ERRORS, floorvalues},
    {"limits: cubics", BR_NOISY_ERRORS, cubics},
    {"limits: quadrature", BR_NOISY_ERRORS, quadrature},
    {"limits: ODE", BR_NOISY_ERRORS, ode},
    {"limits: oscillating", BR_NOISY_ERRORS, oscillate},
    {"limits: kink", BR_NOISY_ERRORS, kinkedvalues},
    {"limits: diverging", BR_NO_ORDER, diverging},
    {"limits: log n", BR_NO_ORDER, logvalues},
    {"limits: logarithm", BR_NOISY_ERRORS, logarithmlimit},
    {NULL, BR_NO_ORDER, NULL},
};
