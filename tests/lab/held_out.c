/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Classes of lines that nobody had seen while the laws and their priors were chosen: the later ones
 * have been looked at since, the last ones have not. */
#include "tests/lab/draw.h"

static void evenoddfloor(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 7, 10, 2);
    s->truth = PICK(r, 1, 2, 3);
    const double c = constant_of(r), a = uniform(r, .03, .15);
    const double level = c * pow(s->h[s->rows - whole(r, 2, 3)], s->truth) * uniform(r, .3, 1);
    EACH_ROW s->e[i] = digits(c * pow(s->h[i], s->truth) * (1 + (i % 2 ? a : -a)) + level, 5);
}

/* The solver of the finest mesh stops before the error of the mesh is reached. */
static void stopsearly(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 5, 9, 2);
    s->truth = PICK(r, 1, 2, 3, 4);
    const double c = constant_of(r), a = uniform(r, -.2, .2) / s->h[0];
    EACH_ROW s->e[i] = digits(c * pow(s->h[i], s->truth) * (1 + a * s->h[i]), 5);
    s->e[s->rows - 1] *= uniform(r, 1.3, 4);
}

/* Meshes of a generator: their size is known to some per cent, and no mesh is within another. */
static void notnested(struct br_test_random *r, struct br_error_line *s)
{
    s->rows = whole(r, 4, 8);
    s->truth = PICK(r, 1, 2, 3);
    const double c = constant_of(r), by = uniform(r, .01, .05);
    double h = uniform(r, .05, .3);
    EACH_ROW
    {
        s->h[i] = digits(h, 3);
        s->e[i] = digits(c * pow(h * exp(by * normal(r)), s->truth), 4);
        h /= uniform(r, 1.3, 2.2);
    }
}

/* A rule of too few points adds an error of order 2 of either sign; order 3 or 4 is in front. */
static void crime(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 5, 9, 2);
    s->truth = 2;
    const double p = PICK(r, 3, 4), c = constant_of(r);
    const double meet = s->h[s->rows - 1] * pow(2, uniform(r, .8, 2.5));
    const double d = c * pow(meet, p - 2) * PICK(r, -1, 1, 1);
    EACH_ROW s->e[i] = digits(fabs(c * pow(s->h[i], p) + d * s->h[i] * s->h[i]), 6);
}

/* A limiter clips extrema: 4/3 in the largest error, in waves with the phase of the mesh. */
static void limiter(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 5, 8, 2);
    s->truth = PICK(r, 4. / 3, 5. / 3);
    const double c = constant_of(r), b = uniform(r, .2, 2);
    const double wave = uniform(r, .02, .1), phase = uniform(r, 0, 6);
    EACH_ROW
    {
        const double x = s->h[i] / s->h[0], waves = 1 + wave * sin(2.5 * (double)i + phase);
        s->e[i] = digits(c * (pow(x, s->truth) * waves + b * x * x), 4);
    }
}

/* A boundary layer: order 1/2 while it is not resolved. */
static void boundarylayer(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 6, 9, 2);
    s->truth = PICK(r, 1, 2, 3);
    const double c = constant_of(r), t = s->h[whole(r, 1, s->rows - 4)];
    EACH_ROW
    {
        const double x = s->h[i] / t;
        s->e[i] = digits(c * pow(x, s->truth) / (1 + pow(x, s->truth - .5)), 6);
    }
}

static void lockingfloor(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 8, 10, 2);
    s->truth = PICK(r, 1, 2);
    const double c = constant_of(r), t = s->h[whole(r, 0, 2)];
    const double level = c * pow(s->h[s->rows - 2] / t, s->truth) * uniform(r, .2, 1);
    EACH_ROW
    {
        const double x = pow(s->h[i] / t, s->truth);
        s->e[i] = digits(c * x / (1 + x) + level, 5);
    }
}

/* The error of the time step stays, with either sign, and scatters a little. */
static void timefloor(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 5, 8, 2);
    s->truth = PICK(r, 2, 3, 4);
    const double c = constant_of(r);
    const double level =
        c * pow(s->h[s->rows - 1], s->truth) * uniform(r, .05, .4) * PICK(r, -1, 1);
    EACH_ROW s->e[i] = digits(c * pow(s->h[i], s->truth) + level * (1 + .02 * normal(r)), 5);
}

/* Values in single precision, whose round-off grows with the number of steps. */
static void single(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 6, 12, 2);
    s->values = true;
    s->limit = uniform(r, .5, 3) * PICK(r, -1, 1);
    s->truth = PICK(r, 1, 2, 3);
    const double d = br_test_decades(r, -2, 0), g = PICK(r, 0, .5);
    EACH_ROW
    {
        const double x = s->h[i] / s->h[0];
        const double off = 3e-8 * normal(r) * pow(x, -g);
        s->e[i] = (double)(float)(s->limit * (1 + off) + d * pow(x, s->truth));
    }
}

/* Straight edges for a curved boundary: order 2 in one norm with order 4 of the elements. */
static void geometry(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 5, 8, 2);
    s->truth = 2;
    const double c = constant_of(r), p = PICK(r, 3, 4);
    const double meet = s->h[s->rows - 1] * pow(2, uniform(r, 1, 3));
    const double d = c * pow(meet, p - 2), a = uniform(r, -.2, .2) / s->h[0];
    EACH_ROW s->e[i] =
        digits(hypot(c * pow(s->h[i], p) * (1 + a * s->h[i]), d * s->h[i] * s->h[i]), 5);
}

/* Adaptive meshes: sizes of unknowns, and a constant that drifts. */
static void drifts(struct br_test_random *r, struct br_error_line *s)
{
    s->rows = whole(r, 8, 14);
    s->truth = PICK(r, 1, 2, 3);
    const double c = constant_of(r);
    double h = .2, drift = 0;
    EACH_ROW
    {
        s->h[i] = digits(h, 4);
        s->e[i] = digits(c * pow(h, s->truth) * exp(drift), 4);
        drift += .05 * normal(r);
        h /= uniform(r, 1.2, 1.7);
    }
}

/* ---- the last ones ---- */

/* Two fields in one norm, of orders 2 and 3. */
static void twofields(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 4, 8, 2);
    s->truth = 2;
    const double c = constant_of(r), a = br_test_decades(r, -.7, .7);
    EACH_ROW
    {
        const double x = s->h[i] / s->h[0];
        s->e[i] = digits(c * x * x * hypot(1, a * x), 4);
    }
}

/* Cells cut by a boundary: the constant depends on how it cuts. */
static void cutcells(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 6, 10, 2);
    s->truth = PICK(r, 1, 2, 3);
    const double c = constant_of(r), by = uniform(r, .05, .2);
    EACH_ROW s->e[i] = digits(c * pow(s->h[i], s->truth) * (1 + uniform(r, -by, by)), 4);
}

/* Numbers of elements that are rounded, of ratio 1.5. */
static void roundedmeshes(struct br_test_random *r, struct br_error_line *s)
{
    s->rows = whole(r, 5, 9);
    s->truth = PICK(r, 1, 2, 4);
    const double c = constant_of(r), a = uniform(r, -1, 2);
    double n = uniform(r, 5, 12);
    EACH_ROW
    {
        s->h[i] = 1 / floor(n);
        s->e[i] = digits(c * pow(s->h[i], s->truth) * (1 + a * s->h[i] * s->h[i]), 3);
        n *= 1.5;
    }
}

/* Waves that coarse meshes do not resolve: the error of phase is larger there. */
static void pollution(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 5, 9, 2);
    s->truth = 2;
    const double c = constant_of(r), at = s->h[whole(r, 0, 1)];
    EACH_ROW
    {
        const double x = s->h[i] / at;
        s->e[i] = digits(c * x * x * (1 + x * x) / (1 + .1 * x * x * x * x), 5);
    }
}

/* The solver stops at a share of the first residual: a level that scatters, on the last rows. */
static void tolerance(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 6, 9, 2);
    s->truth = PICK(r, 2, 3, 4);
    const double c = constant_of(r);
    const double level = c * pow(s->h[s->rows - 2], s->truth) * uniform(r, .2, 2);
    EACH_ROW s->e[i] = digits(hypot(c * pow(s->h[i], s->truth), level * uniform(r, .3, 1)), 5);
}

/* Time steps reduce the order at boundaries: a term of half an order less, small at first. */
static void reduction(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 5, 8, 2);
    const double p = PICK(r, 2, 3);
    s->truth = p - .5;
    const double c = constant_of(r), a = uniform(r, .3, 3);
    EACH_ROW
    {
        const double x = s->h[i] / s->h[0];
        s->e[i] = digits(c * (pow(x, p) + a * pow(x, p - .5)), 5);
    }
}

/* Waves in log h, as of a corner with a complex exponent. */
static void logwaves(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 5, 9, 2);
    s->truth = PICK(r, 1, 1.5, 2);
    const double c = constant_of(r), by = uniform(r, .01, .05), phase = uniform(r, 0, 6);
    EACH_ROW s->e[i] =
        digits(c * pow(s->h[i], s->truth) * (1 + by * cos(1.3 * log(s->h[i]) + phase)), 5);
}

/* Values of few digits, as of a paper's table. */
static void fewdigits(struct br_test_random *r, struct br_error_line *s)
{
    mesh_sequence(r, s, 5, 7, 2);
    s->truth = PICK(r, 1, 2);
    s->values = true;
    s->limit = uniform(r, .5, 3);
    const double d = uniform(r, .05, .3), a = uniform(r, -.2, .2);
    EACH_ROW
    {
        const double x = s->h[i] / s->h[0];
        s->e[i] = digits(s->limit + d * pow(x, s->truth) * (1 + a * x), 6);
    }
}

const struct br_error_class br_later_classes[] = {
    {"even-odd, floor", BR_HARD_ERRORS, evenoddfloor},
    {"solver stops early", BR_HARD_ERRORS, stopsearly},
    {"meshes not nested", BR_NOISY_ERRORS, notnested},
    {"quadrature crime", BR_HARD_ERRORS, crime},
    {"limiter", BR_HARD_ERRORS, limiter},
    {"boundary layer", BR_HARD_ERRORS, boundarylayer},
    {"locking, floor", BR_HARD_ERRORS, lockingfloor},
    {"floor of time, signed", BR_HARD_ERRORS, timefloor},
    {"values, single precision", BR_HARD_ERRORS, single},
    {"geometry of order 2", BR_HARD_ERRORS, geometry},
    {"adaptive, drifts", BR_HARD_ERRORS, drifts},
    {NULL, BR_NO_ORDER, NULL},
};

const struct br_error_class br_held_out_classes[] = {
    {"two fields in one norm", BR_HARD_ERRORS, twofields},
    {"cut cells", BR_NOISY_ERRORS, cutcells},
    {"rounded meshes", BR_HARD_ERRORS, roundedmeshes},
    {"pollution", BR_HARD_ERRORS, pollution},
    {"tolerance of a solver", BR_HARD_ERRORS, tolerance},
    {"order reduction", BR_HARD_ERRORS, reduction},
    {"waves in log h", BR_HARD_ERRORS, logwaves},
    {"values of few digits", BR_HARD_ERRORS, fewdigits},
    {NULL, BR_NO_ORDER, NULL},
};
