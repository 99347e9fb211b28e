/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How often is an observed order right? Random lines of errors of each class (errors.c), and grids
 * of them (grids.h), their orders and verdicts. As a test, 12 lines a class of seed 1 (--long:
 * 300), and a quarter of that of grids, with bounds; it prints claims   an interval above 0 and at
 * most 1 wide covers   of the claims: the interval holds the truth silent   of all: claims, misses
 * the truth by more than 0.005, and says nothing of the rows PASS, FAIL   verdicts on the true
 * order +- 0.1; else INCONCLUSIVE false    PASS on an order that is 0.4 too low or 0.5 too high
 *   width    the interval's over that of a regression of all rows, the median
 * usage: orders [SEED LINES [CLASS]] */
#include <gsl/gsl_cdf.h>
#include <gsl/gsl_fit.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "study/orders/orders.h"
#include "tests/lab/grids.h"
#include "tests/lab/published.h"
#include "tests/support.h"

enum { SAMPLE = 12, MANY = 300, MOST_LINES = 100000 };

static const double near = 0.005, tolerance = 0.1;

struct tally {
    size_t lines, claims, covers, silent, pass, fail, wrong_pass;
    size_t contradicts; /* FAIL beside no order, or another order in the verdict */
    double *width;
    size_t widths;
};

/* What a line shows. */
static void observe(const struct br_error_line *line, struct br_point *point, struct br_case *c)
{
    struct br_error err = {0};
    *c = (struct br_case){
        .kind = BR_VERIFY_SPACE,
        .expected = {.order = NAN, .tolerance = tolerance, .floor = NAN, .ceiling = NAN},
        .measure = "error",
        .part = "",
        .unit = "",
        .point = point,
        .points = line->rows - line->values};
    for (size_t i = 0; i < c->points; i++) {
        point[i] = (struct br_point){
            .z = line->h[i], .error = line->e[i], .deviation = line->deviation[i]};
        snprintf(point[i].label, sizeof point[i].label, "h = %g", line->h[i]);
        if (line->values) {
            point[i].z_against = line->h[i + 1];
            point[i].error = fabs(line->e[i] - line->e[i + 1]);
        }
    }
    if (br_case_observe(c, BR_VERIFY_LEAST_POINTS, &err)) {
        printf("Bail out! %s\n", err.message);
        exit(99);
    }
}

/* Its verdict with this order expected. */
static enum br_verdict judge(struct br_case *c, double expected)
{
    c->expected.order = expected;
    br_case_judge(c);
    return c->verdict;
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

/* Counts a verdict on the true order, and the order. said: whether a remark names what is wrong. */
static void count(struct tally *t, const struct br_case *c, const struct br_estimate *order,
                  double truth, bool said)
{
    const bool claims = br_order_determined(order);
    const bool covers = order->low <= truth + near && order->high >= truth - near;
    t->lines++;
    t->claims += claims;
    t->covers += claims && covers;
    t->silent += claims && !covers && !said;
    t->pass += c->verdict == BR_PASS;
    t->fail += c->verdict == BR_FAIL;
}

static void try_line(size_t class, uint64_t seed, size_t index, struct tally *t)
{
    struct br_error_line line = {.truth = NAN};
    struct br_random random = br_random_of(seed * 1000 + class, index);
    struct br_point point[BR_MOST_ERRORS];
    struct br_case c;
    br_error_classes[class].draw(&random, &line);
    const double expected = isnan(line.truth) ? 2 : line.truth;
    observe(&line, point, &c);
    t->wrong_pass += judge(&c, index % 2 == 0 ? expected + 0.5 : expected - 0.4) == BR_PASS;
    judge(&c, expected);
    count(t, &c, &c.order, line.truth, c.note[0]);
    if (br_order_determined(&c.order) && !line.values)
        t->width[t->widths++] = (c.order.high - c.order.low) / 2 / regression(&line);
}

/* One column of numbers, with its orders. k: NULL, they are a line in h. */
static void find(size_t rows, const double *h, const double *k, const double *e, bool values,
                 struct br_numbers *n, struct br_orders *o)
{
    struct br_error err = {0};
    *n = (struct br_numbers){0};
    n->column[0] = br_resolution_column_find("h");
    n->column[1] = k ? br_resolution_column_find("k") : NULL;
    enum br_status status = br_numbers_make_room(n, rows, 1, &err);
    if (!status)
        status = br_numbers_add_quantity(n, "e", NULL, values, &err);
    for (size_t i = 0; i < rows && !status; i++) {
        n->row[i].given[0] = n->row[i].z[0] = h[i];
        n->row[i].given[1] = n->row[i].z[1] = k ? k[i] : NAN;
        n->row[i].number[0] = e[i];
    }
    if (!status)
        status = br_numbers_check(n, "made", &err);
    if (!status)
        status = br_orders_find(n, 2, o, &err);
    if (status) {
        printf("Bail out! %s\n", err.message);
        exit(99);
    }
}

static enum br_verdict verdict_of(const struct br_orders *o, int axis, double expected,
                                  struct br_case *c)
{
    struct br_error err = {0};
    struct br_check check = {.path = "made"};
    const struct br_order_expectation e = {
        .quantity = "e", .axis = (enum br_axis)axis, .order = expected, .tolerance = tolerance};
    *c = (struct br_case){.verdict = BR_INCONCLUSIVE, .order = {NAN, NAN, NAN}};
    if (!br_orders_check(o, &e, 1, &check, &err)) /* else there is no line of three sizes */
        *c = check.cases[0];
    br_check_clear(&check);
    return c->verdict;
}

static const char *const found_texts[] = {"covers", "is near", "excludes", "not determined"};

/* A published column: whether the interval covers the order that its source states, misses it by a
 * rounding of what authors print, excludes it, or is no claim. */
static size_t try_published(size_t number)
{
    const struct br_published *p = &br_published[number];
    const struct br_error_line line = br_published_line(p);
    struct br_numbers n;
    struct br_orders o;
    struct br_case c;
    char order[64];
    find(line.rows, line.h, NULL, line.e, false, &n, &o);
    verdict_of(&o, BR_AXIS_SPACE, p->order, &c);
    const double off = fmax(c.order.low - p->order, p->order - c.order.high);
    const size_t found = !br_order_determined(&c.order) ? 3 : off <= near ? 0 : off <= 0.05 ? 1 : 2;
    printf("# %-14s %-46s %g: %s, %s%s%s\n", found_texts[found], p->name, p->order,
           br_order_text(&c.order, order, sizeof order), br_verdict_names[c.verdict],
           *c.note ? "; " : "", c.note);
    br_orders_clear(&o);
    br_numbers_clear(&n);
    return found;
}

/* The orders in h and in k of one grid; the answer and the verdict have to state the same. */
static void try_grid(size_t class, uint64_t seed, size_t index, struct tally *t)
{
    const struct br_grid g = br_grid_of(class, seed, index);
    struct br_numbers n;
    struct br_orders o;
    find(g.rows, g.h, g.k, g.e, false, &n, &o);
    for (int axis = 0; axis < BR_AXES; axis++) {
        struct br_case c;
        const struct br_estimate *order = &o.of[0].answer[axis].order;
        const double truth = g.order[axis], expected = isnan(truth) ? 2 : truth;
        t->wrong_pass +=
            verdict_of(&o, axis, index % 2 == 0 ? expected + 0.5 : expected - 0.4, &c) == BR_PASS;
        t->contradicts += verdict_of(&o, axis, expected, &c) == BR_FAIL && !isfinite(order->value);
        t->contradicts += c.points >= BR_VERIFY_LEAST_POINTS && isfinite(order->value) &&
                          fabs(order->value - c.order.value) > 0;
        count(t, &c, order, truth, c.note[0]);
    }
    br_orders_clear(&o);
    br_numbers_clear(&n);
}

/* The limit of the values of a grid, or of a line; width: half of its interval, over the distance
 * from it. */
static void try_limit(size_t class, uint64_t seed, size_t index, struct tally *t)
{
    double truth;
    const struct br_grid g = br_value_grid_of(class, seed, index, &truth);
    struct br_numbers n;
    struct br_orders o;
    find(g.rows, g.h, g.steps > 1 ? g.k : NULL, g.e, true, &n, &o);
    const struct br_estimate *limit = &o.of[0].limit.value;
    const bool claims = isfinite(limit->high - limit->low);
    const bool covers = limit->low <= truth && truth <= limit->high;
    t->lines++;
    t->claims += claims;
    t->covers += claims && covers;
    t->silent += claims && !covers;
    if (claims)
        t->width[t->widths++] = (limit->high - limit->low) / 2 / fabs(g.e[g.rows - 1] - truth);
    br_orders_clear(&o);
    br_numbers_clear(&n);
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

static bool is_good(enum br_error_group group, const struct tally *t)
{
    const bool hard = group > BR_NOISY_ERRORS, none = group == BR_NO_ORDER;
    const double silent = hard ? 0.03 : 0.02;
    return t->contradicts == 0 && at_most(t->silent, silent, t->lines) &&
           (none || at_most(t->fail, hard ? 0.03 : 0.01, t->lines)) &&
           at_most(t->wrong_pass, 0.002, t->lines) &&
           (hard || at_most(t->claims - t->covers, 0.05, t->claims));
}

static void print(const char *name, struct tally *t)
{
    const double all = (double)t->lines / 100;
    qsort(t->width, t->widths, sizeof *t->width, by_size);
    printf("%-26s %6.1f %6.1f %6.1f %6.1f %6.1f %6.1f %8.2f\n", name, (double)t->claims / all,
           100 * (double)t->covers / (double)t->claims, (double)t->silent / all,
           (double)t->pass / all, (double)t->fail / all, (double)t->wrong_pass / all,
           t->widths ? t->width[t->widths / 2] : (double)NAN);
}

/* Tries so many lines, or grids, of a class; only: the class, NULL: all.
 * Returns whether their orders are good. */
static bool try_class(size_t number, const char *name, enum br_error_group group, size_t class,
                      void (*try)(size_t, uint64_t, size_t, struct tally *), uint64_t seed,
                      size_t lines, const char *only, double *width)
{
    struct tally t = {.width = width};
    if (only && strcmp(name, only) != 0)
        return true;
    for (size_t i = 0; i < lines; i++)
        try(class, seed, i, &t);
    const bool good = is_good(group, &t);
    printf("# ");
    print(name, &t);
    printf("%sok %zu - %s\n", good ? "" : "not ", number, name);
    return good;
}

/* All published columns; number: of the test. Returns whether at most one order is worse than
 * docs/observed-orders.md says. */
static bool try_all_published(size_t number)
{
    size_t all[4] = {0}, later[4] = {0};
    for (size_t i = 0; i < BR_PUBLISHED; i++) {
        const size_t found = try_published(i);
        all[found]++;
        later[found] += i >= BR_PUBLISHED_FIRST;
    }
    for (size_t i = 0; i < 4; i++)
        printf("# %-14s %3zu of %d columns, %2zu of the later %d\n", found_texts[i], all[i],
               BR_PUBLISHED, later[i], BR_PUBLISHED - BR_PUBLISHED_FIRST);
    const bool ok = all[0] >= 129 && all[2] <= 10 && all[3] <= 19;
    printf("%sok %zu - published columns\n", ok ? "" : "not ", number);
    return ok;
}

int main(int arguments, char **argument)
{
    const uint64_t seed = arguments >= 3 ? strtoull(argument[1], NULL, 10) : 1;
    const size_t lines = arguments >= 3   ? strtoul(argument[2], NULL, 10)
                         : br_test_long() ? MANY
                                          : SAMPLE;
    const char *only = arguments == 4 ? argument[3] : NULL;
    const size_t grids = (lines + 3) / 4; /* of two orders and some ten lines each */
    size_t classes = 0, bad = 0;
    double *width = br_allocate(lines + 1, sizeof *width);
    while (br_error_classes[classes].name)
        classes++;
    if (!width || !(lines > 0 && lines <= MOST_LINES) ||
        (arguments != 1 && arguments != 3 && arguments != 4)) {
        fputs("usage: orders [SEED LINES [CLASS]]\n", stderr);
        return 2;
    }
    printf("TAP version 13\n1..%zu\n", classes + BR_GRID_CLASSES + BR_VALUE_CLASSES + 1);
    printf("# %% of %zu lines, seed %llu\n# %-24s %6s %6s %6s %6s %6s %6s %8s\n", lines,
           (unsigned long long)seed, "class", "claims", "covers", "silent", "PASS", "FAIL", "false",
           "width");
    for (size_t i = 0; i < classes; i++)
        bad += !try_class(i + 1, br_error_classes[i].name, br_error_classes[i].group, i, try_line,
                          seed, lines, only, width);
    printf("# %zu grids, of two orders each\n", grids);
    for (size_t i = 0; i < BR_GRID_CLASSES; i++)
        bad += !try_class(classes + i + 1, br_grid_classes[i].name, br_grid_classes[i].group, i,
                          try_grid, seed, grids, only, width);
    printf("# %zu limits of values\n", grids);
    for (size_t i = 0; i < BR_VALUE_CLASSES; i++)
        bad += !try_class(classes + BR_GRID_CLASSES + i + 1, br_value_classes[i].name,
                          BR_NOISY_ERRORS, i, try_limit, seed, grids, only, width);
    const size_t last = classes + BR_GRID_CLASSES + BR_VALUE_CLASSES + 1;
    if (!only || strcmp(only, "published") == 0)
        bad += !try_all_published(last);
    free(width);
    return bad > 0;
}
