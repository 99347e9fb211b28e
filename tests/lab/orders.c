/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How often is an observed order right? Random lines of errors of each class (errors.c), their
 * orders and verdicts. As a test, 20 lines a class of seed 1 (--long: 300), with bounds; it prints
 *   claims   an interval above 0 and at most 1 wide
 *   covers   of the claims: the interval holds the truth
 *   silent   of all: claims, misses the truth by more than 0.005, and says nothing of the rows
 *   PASS, FAIL   verdicts on the true order +- 0.1; else INCONCLUSIVE
 *   false    PASS on an order that is 0.4 too low or 0.5 too high
 *   width    the interval's over that of a regression of all rows, the median
 * usage: orders [SEED LINES] */
#include <gsl/gsl_cdf.h>
#include <gsl/gsl_fit.h>
#include <stdio.h>
#include <stdlib.h>

#include "study/verify/check.h"
#include "tests/lab/errors.h"
#include "tests/support.h"

enum { SAMPLE = 20, MANY = 300, MOST_LINES = 100000 };

static const double near = 0.005, tolerance = 0.1;

struct tally {
    size_t lines, claims, covers, silent, pass, fail, inconclusive, wrong_pass;
    double *width;
    size_t widths;
};

/* The case of a line with this order expected, and its verdict. */
static void judge(const struct br_error_line *line, double expected, struct br_point *point,
                  struct br_case *c)
{
    struct br_error err = {0};
    *c = (struct br_case){.kind = BR_VERIFY_SPACE,
                          .expected = {.order = expected,
                                       .tolerance = tolerance,
                                       .floor = NAN,
                                       .ceiling = NAN},
                          .measure = "error",
                          .part = "",
                          .unit = "",
                          .point = point,
                          .points = line->rows - line->values};
    for (size_t i = 0; i < c->points; i++) {
        point[i] = (struct br_point){.z = line->h[i], .error = line->e[i]};
        snprintf(point[i].label, sizeof point[i].label, "h = %g", line->h[i]);
        if (line->values) {
            point[i].z_against = line->h[i + 1];
            point[i].error = fabs(line->e[i] - line->e[i + 1]);
        }
    }
    if (br_verdict_reach(c, &err)) {
        printf("Bail out! %s\n", err.message);
        exit(99);
    }
}

/* Half the width of the 95 % interval of a regression of log e over log h. */
static double regression(const struct br_error_line *line)
{
    double x[BR_MOST_ERRORS], y[BR_MOST_ERRORS], c0, c1, c00, c01, c11, sum;
    for (size_t i = 0; i < line->rows; i++) {
        x[i] = log(line->h[i]);
        y[i] = log(line->e[i]);
    }
    gsl_fit_linear(x, 1, y, 1, line->rows, &c0, &c1, &c00, &c01, &c11, &sum);
    return gsl_cdf_tdist_Pinv(0.975, (double)line->rows - 2) * sqrt(c11);
}

static void try_line(const struct br_error_class *class, struct br_random *random, bool high,
                     struct tally *t)
{
    struct br_error_line line = {.truth = NAN};
    struct br_point point[BR_MOST_ERRORS];
    struct br_case c;
    class->draw(random, &line);
    const double expected = isnan(line.truth) ? 2 : line.truth;
    judge(&line, high ? expected + 0.5 : expected - 0.4, point, &c);
    t->wrong_pass += c.verdict == BR_PASS;
    judge(&line, expected, point, &c);
    const struct br_estimate *order = &c.order;
    const bool claims = br_order_determined(order);
    const bool covers = order->low <= line.truth + near && order->high >= line.truth - near;
    t->lines++;
    t->claims += claims;
    t->covers += claims && covers;
    t->silent += claims && !covers && !c.note[0];
    t->pass += c.verdict == BR_PASS;
    t->fail += c.verdict == BR_FAIL;
    t->inconclusive += c.verdict == BR_INCONCLUSIVE;
    if (claims && !line.values)
        t->width[t->widths++] = (order->high - order->low) / 2 / regression(&line);
}

static int by_size(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Whether at most this share of n lines was found, but for chance: two deviations and one line. */
static bool at_most(size_t found, double share, size_t n)
{
    const double mean = share * (double)n;
    return (double)found <= mean + 2 * sqrt(mean) + 1;
}

static bool is_good(const struct br_error_class *class, const struct tally *t)
{
    const bool hard = class->group > BR_NOISY_ERRORS, none = class->group == BR_NO_ORDER;
    const double silent = hard ? 0.03 : 0.02;
    return at_most(t->silent, silent, t->lines) &&
           (none || at_most(t->fail, hard ? 0.03 : 0.01, t->lines)) &&
           at_most(t->wrong_pass, 0.002, t->lines) &&
           (hard || at_most(t->claims - t->covers, 0.05, t->claims));
}

static void print(const struct br_error_class *class, struct tally *t)
{
    const double all = (double)t->lines / 100;
    qsort(t->width, t->widths, sizeof *t->width, by_size);
    printf("%-26s %6.1f %6.1f %6.1f %6.1f %6.1f %6.1f %8.2f\n", class->name,
           (double)t->claims / all, 100 * (double)t->covers / (double)t->claims,
           (double)t->silent / all, (double)t->pass / all, (double)t->fail / all,
           (double)t->wrong_pass / all, t->widths ? t->width[t->widths / 2] : (double)NAN);
}

int main(int arguments, char **argument)
{
    const uint64_t seed = arguments == 3 ? strtoull(argument[1], NULL, 10) : 1;
    const size_t lines = arguments == 3    ? strtoul(argument[2], NULL, 10)
                         : br_test_long() ? MANY
                                          : SAMPLE;
    size_t classes = 0, bad = 0;
    double *width = br_allocate(lines + 1, sizeof *width);
    while (br_error_classes[classes].name)
        classes++;
    if (!width || !(lines > 0 && lines <= MOST_LINES) || (arguments != 1 && arguments != 3)) {
        fputs("usage: orders [SEED LINES]\n", stderr);
        return 2;
    }
    printf("TAP version 13\n1..%zu\n", classes);
    printf("# %% of %zu lines, seed %llu\n# %-24s %6s %6s %6s %6s %6s %6s %8s\n", lines,
           (unsigned long long)seed, "class", "claims", "covers", "silent", "PASS", "FAIL", "false",
           "width");
    for (size_t i = 0; i < classes; i++) {
        struct tally t = {.width = width};
        for (size_t j = 0; j < lines; j++) {
            struct br_random random = br_random_of(seed * 1000 + i, j);
            try_line(&br_error_classes[i], &random, j % 2 == 0, &t);
        }
        const bool good = is_good(&br_error_classes[i], &t);
        bad += !good;
        printf("# ");
        print(&br_error_classes[i], &t);
        printf("%sok %zu - %s\n", good ? "" : "not ", i + 1, br_error_classes[i].name);
    }
    free(width);
    return bad > 0;
}
