/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How often is an observed order right? Random lines of errors of each class (errors.c), and grids
 * of them (grids.h), their orders and verdicts, and limits of values. As a test, 12 lines a class
 * of seed 1 (--long: 300), and a quarter of that of grids, with bounds.
 *
 * Its columns are % of the lines:
 *
 * - claims: an interval above 0 and at most 1 wide; of limits: one is stated.
 * - covers, of the claims: the interval holds the truth, or both where two orders are as likely.
 * - silent: claims, misses the truth by more than 0.005, and says nothing of the rows.
 * - PASS, FAIL: verdicts on the true order +- 0.1; the rest is INCONCLUSIVE.
 * - false: PASS on an order that is 0.4 too low or 0.5 too high, or on that of the coarse rows.
 * - narrow: claims, does not cover, and is narrower than 0.01.
 * - width: of the interval over that of a regression of all rows, the median; of limits: half of
 *   it over the distance of the finest value.
 *
 * compare: beside the methods of others (others.c), as tables of docs/observed-orders.md.
 * usage: orders [SEED LINES [CLASS | published | compare]] */
#include <gsl/gsl_cdf.h>
#include <gsl/gsl_fit.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "orders/line/laws.h"
#include "orders/orders.h"
#include "tests/checks.h"
#include "tests/lab/grids.h"
#include "tests/lab/others.h"
#include "tests/lab/published.h"

enum { SAMPLE = 12, MANY = 300, MOST_LINES = 100000 };

static const double near = 0.005, tolerance = 0.1, narrow = 0.01;

struct tally {
    size_t lines, claims, covers, silent, pass, fail, wrong_pass, narrow;
    size_t contradicts; /* FAIL beside no order, or another order in the verdict */
    double *width;
    size_t widths;
};

/* What a line shows. */
static void observe(const struct br_error_line *line, struct br_point *point, struct br_case *c)
{
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
    const bool few = c->points < BR_VERIFY_LEAST_POINTS; /* they have an order, and no verdict */
    if (br_case_observe(c, few ? c->points : BR_VERIFY_LEAST_POINTS, &err)) {
        printf("Bail out! %s\n", err.message);
        exit(99);
    }
}

/* Its verdict with this order expected. */
static enum br_verdict find_verdict(struct br_case *c, double expected)
{
    c->expected.order = expected;
    br_case_decide(c);
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

static bool holds(const struct br_estimate *order, double truth)
{
    return order->low <= truth + near && order->high >= truth - near;
}

/* Counts a verdict on the true order, and the order. other: another one as likely, or NaN.
 * said: whether a remark names what is wrong. */
static void count(struct tally *t, const struct br_case *c, const struct br_estimate *order,
                  const double truth[2], bool said)
{
    const bool claims = br_order_determined(order);
    const bool covers = holds(order, truth[0]) && (isnan(truth[1]) || holds(order, truth[1]));
    t->lines++;
    t->claims += claims;
    t->covers += claims && covers;
    t->silent += claims && !covers && !said;
    t->narrow += claims && !covers && !(order->high - order->low >= narrow);
    t->pass += c->verdict == BR_PASS;
    t->fail += c->verdict == BR_FAIL;
}

/* Draws line `index` of a class. */
static struct br_error_line line_of(const struct br_error_class *class, uint64_t seed, size_t index)
{
    struct br_error_line line = {.truth = NAN, .other = NAN, .limit = NAN};
    struct br_test_random random = br_test_random_of(seed, index);
    class->draw(&random, &line);
    return line;
}

static void try_line_of(const struct br_error_line *drawn, size_t index, struct tally *t)
{
    const struct br_error_line line = *drawn;
    struct br_point point[BR_MOST_ERRORS];
    struct br_case c;
    const double expected = isnan(line.truth) ? 2 : line.truth;
    observe(&line, point, &c);
    bool wrong = find_verdict(&c, index % 2 == 0 ? expected + 0.5 : expected - 0.4) == BR_PASS;
    wrong = isnan(line.other) ? wrong : find_verdict(&c, line.other) == BR_PASS;
    t->wrong_pass += wrong;
    find_verdict(&c, expected);
    count(t, &c, &c.order, (const double[]){line.truth, line.other}, c.note[0]);
    if (br_order_determined(&c.order) && !line.values)
        t->width[t->widths++] = (c.order.high - c.order.low) / 2 / regression(&line);
}

static void try_line(size_t class, uint64_t seed, size_t index, struct tally *t)
{
    const struct br_error_line line = line_of(&br_error_classes[class], seed * 1000 + class, index);
    try_line_of(&line, index, t);
}

static struct br_error_line held_out_line_of(size_t class, uint64_t seed, size_t index)
{
    return line_of(&br_held_out_classes[class], seed * 1000 + 400 + class, index);
}

static void try_later(size_t class, uint64_t seed, size_t index, struct tally *t)
{
    const struct br_error_line line =
        line_of(&br_later_classes[class], seed * 1000 + 300 + class, index);
    try_line_of(&line, index, t);
}

static void try_held_out(size_t class, uint64_t seed, size_t index, struct tally *t)
{
    const struct br_error_line line = held_out_line_of(class, seed, index);
    try_line_of(&line, index, t);
}

/* One column of numbers, with its orders. k: NULL, they are a line in h. */
static void find(size_t rows, const double *h, const double *k, const double *e, bool values,
                 struct br_numbers *n, struct br_orders *o)
{
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
    OWNED(br_check) check = {.path = "made"};
    const struct br_order_expectation e = {
        .quantity = "e",
        .axis = (enum br_axis)axis,
        .band = {.order = expected, .tolerance = tolerance, .floor = NAN, .ceiling = NAN}};
    *c = (struct br_case){.verdict = BR_INCONCLUSIVE, .order = {NAN, NAN, NAN}};
    if (!br_orders_check(o, &e, 1, &check, &err)) /* else there is no line of three sizes */
        *c = check.cases[0];
    return c->verdict;
}

static const char *const found_texts[] = {"covers", "is near", "excludes", "not determined"};

/* A published column: whether the interval covers the order that its source states, misses it by a
 * rounding of what authors print, excludes it, or is no claim. */
static size_t try_published(const struct br_published *p)
{
    const struct br_error_line *line = &p->line;
    OWNED(br_numbers) n;
    OWNED(br_orders) o;
    struct br_case c;
    char order[64];
    find(line->rows, line->h, NULL, line->e, false, &n, &o);
    verdict_of(&o, BR_AXIS_SPACE, line->truth, &c);
    const double off = fmax(c.order.low - line->truth, line->truth - c.order.high);
    const size_t found = !br_order_determined(&c.order) ? 3 : off <= near ? 0 : off <= 0.05 ? 1 : 2;
    printf("# %-14s %-46s %g: %s, %s%s%s\n", found_texts[found], p->name, line->truth,
           br_order_text(&c.order, order, sizeof order), br_verdict_names[c.verdict],
           *c.note ? "; " : "", c.note);
    return found;
}

/* The orders in h and in k of one grid; the answer and the verdict have to state the same. */
static void try_grid(size_t class, uint64_t seed, size_t index, struct tally *t)
{
    const struct br_grid g = br_grid_of(class, seed, index);
    OWNED(br_numbers) n;
    OWNED(br_orders) o;
    find(g.rows, g.h, g.k, g.e, false, &n, &o);
    for (int axis = 0; axis < BR_AXES; axis++) {
        struct br_case c;
        const struct br_estimate *order = &o.of[0].answer[axis].order;
        const double truth = g.order[axis], expected = isnan(truth) ? 2 : truth;
        bool wrong =
            verdict_of(&o, axis, index % 2 == 0 ? expected + 0.5 : expected - 0.4, &c) == BR_PASS;
        wrong = isnan(g.other[axis]) ? wrong : verdict_of(&o, axis, g.other[axis], &c) == BR_PASS;
        t->wrong_pass += wrong;
        t->contradicts += verdict_of(&o, axis, expected, &c) == BR_FAIL && !isfinite(order->value);
        t->contradicts += c.points >= BR_VERIFY_LEAST_POINTS && isfinite(order->value) &&
                          fabs(order->value - c.order.value) > 0;
        count(t, &c, order, (const double[]){truth, g.other[axis]}, c.note[0]);
    }
}

/* Counts the interval of a limit. */
static void count_limit(struct tally *t, double low, double high, double truth, double finest)
{
    const bool claims = isfinite(high - low), covers = low <= truth && truth <= high;
    t->lines++;
    t->claims += claims;
    t->covers += claims && covers;
    t->silent += claims && !covers;
    t->narrow += claims && !covers && high - low < narrow * fabs(finest - truth);
    if (claims && !isnan(truth))
        t->width[t->widths++] = (high - low) / 2 / fabs(finest - truth);
}

/* The limit of the values of a grid, or of a line. */
static void try_limit(size_t class, uint64_t seed, size_t index, struct tally *t)
{
    double truth;
    const struct br_grid g = br_value_grid_of(class, seed, index, &truth);
    OWNED(br_numbers) n;
    OWNED(br_orders) o;
    find(g.rows, g.h, g.steps > 1 ? g.k : NULL, g.e, true, &n, &o);
    const struct br_estimate *limit = &o.of[0].limit.value;
    count_limit(t, limit->low, limit->high, truth, g.e[g.rows - 1]);
}

/* What `orders` states of a line: its order or, of values, its limit. */
static struct br_estimate stated(const struct br_error_line *line)
{
    OWNED(br_numbers) n;
    OWNED(br_orders) o;
    find(line->rows, line->h, NULL, line->e, line->values, &n, &o);
    const struct br_estimate found =
        line->values ? o.of[0].limit.value : o.of[0].answer[BR_AXIS_SPACE].order;
    return found;
}

static struct br_error_line limit_line_of(size_t class, uint64_t seed, size_t index)
{
    return line_of(&br_limit_classes[class], seed * 1000 + 600 + class, index);
}

/* The limit of the values of a line. */
static void try_line_limit(size_t class, uint64_t seed, size_t index, struct tally *t)
{
    const struct br_error_line line = limit_line_of(class, seed, index);
    const struct br_estimate limit = stated(&line);
    count_limit(t, limit.low, limit.high, line.limit, line.e[line.rows - 1]);
}

/* The same of a class that nobody had seen. */
static void try_held_out_limit(size_t class, uint64_t seed, size_t index, struct tally *t)
{
    const struct br_error_line line = held_out_line_of(class, seed, index);
    const struct br_estimate limit = stated(&line);
    count_limit(t, limit.low, limit.high, line.limit, line.e[line.rows - 1]);
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
    const bool hard = group > BR_NOISY_ERRORS;
    const bool none = group == BR_NO_ORDER || group == BR_GROWTH;
    const double silent = hard ? 0.03 : 0.02;
    return t->contradicts == 0 && at_most(t->silent, silent, t->lines) &&
           at_most(t->narrow, 0.005, t->lines) &&
           (none || at_most(t->fail, hard ? 0.03 : 0.01, t->lines)) &&
           (group != BR_GROWTH || at_most(t->lines - t->fail, 0.1, t->lines)) &&
           at_most(t->wrong_pass, 0.002, t->lines) &&
           ((hard && group != BR_TWO_ORDERS) || at_most(t->claims - t->covers, 0.05, t->claims));
}

/* A column of the table; NaN: there is nothing to say. */
static void print_column(int width, const char *format, double value)
{
    char text[32] = "-";
    if (!isnan(value))
        snprintf(text, sizeof text, format, value);
    printf(" %*s", width, text);
}

static void print(const char *name, struct tally *t)
{
    const size_t counted[] = {t->silent, t->pass, t->fail, t->wrong_pass, t->narrow};
    const double all = (double)t->lines / 100;
    if (t->widths)
        qsort(t->width, t->widths, sizeof *t->width, by_size);
    printf("%-29s", name);
    print_column(6, "%.1f", (double)t->claims / all);
    print_column(6, "%.1f", t->claims ? 100 * (double)t->covers / (double)t->claims : NAN);
    for (size_t i = 0; i < sizeof counted / sizeof *counted; i++)
        print_column(6, "%.1f", (double)counted[i] / all);
    print_column(8, "%.2g", t->widths ? t->width[t->widths / 2] : NAN);
    printf("\n");
}

static const char *const group_names[BR_GROUPS] = {"smooth",   "noisy",      "hard",
                                                   "no order", "two orders", "growth"};

/* A run of the program. */
struct lab_run {
    uint64_t seed;
    const char *only;   /* the class; NULL: all */
    double *width;      /* of the lines of a class */
    size_t number, bad; /* tests so far, and those that failed */
    bool held_out; /* classes that are kept for the measure alone: only a wrong PASS is too much */
    struct tally group[BR_GROUPS]; /* all lines of a part of the program */
    double seconds;
};

typedef void try_one(size_t class, uint64_t seed, size_t index, struct tally *t);

static void add(struct tally *sum, const struct tally *t)
{
    sum->lines += t->lines;
    sum->claims += t->claims;
    sum->covers += t->covers;
    sum->silent += t->silent;
    sum->pass += t->pass;
    sum->fail += t->fail;
    sum->wrong_pass += t->wrong_pass;
    sum->narrow += t->narrow;
}

/* Tries so many lines, or grids, of a class. */
static void try_class(struct lab_run *run, const char *name, enum br_error_group group,
                      size_t class, try_one *try, size_t lines)
{
    struct tally t = {.width = run->width};
    run->number++;
    if (run->only && strcmp(name, run->only) != 0)
        return;
    const clock_t start = clock();
    for (size_t i = 0; i < lines; i++)
        try(class, run->seed, i, &t);
    run->seconds += (double)(clock() - start) / CLOCKS_PER_SEC;
    const bool good = run->held_out ? t.contradicts == 0 && at_most(t.wrong_pass, 0.002, t.lines)
                                    : is_good(group, &t);
    run->bad += !good;
    printf("# ");
    print(name, &t);
    printf("%sok %zu - %s\n", good ? "" : "not ", run->number, name);
    add(&run->group[group], &t);
}

/* Begins a part of the program. */
static void begin(struct lab_run *run, size_t lines, const char *of)
{
    printf("# %zu %s a class\n", lines, of);
    memset(run->group, 0, sizeof run->group);
    run->seconds = 0;
}

/* The sums of a part, and how long one line of it took. */
static void end(struct lab_run *run)
{
    size_t lines = 0;
    for (size_t i = 0; i < BR_GROUPS && !run->only; i++)
        if (run->group[i].lines > 0) {
            printf("# all %zu: ", run->group[i].lines);
            print(group_names[i], &run->group[i]);
            lines += run->group[i].lines;
        }
    if (lines > 0)
        printf("# %.2g ms each\n", 1000 * run->seconds / (double)lines);
}

/* Classes of lines, up to the one without a name. */
static void try_classes(struct lab_run *run, const struct br_error_class *class, try_one *try,
                        size_t lines, const char *of)
{
    begin(run, lines, of);
    for (size_t i = 0; class[i].name; i++)
        try_class(run, class[i].name, class[i].group, i, try, lines);
    end(run);
}

/* All published columns. At most one order is worse than docs/observed-orders.md says. */
static void try_all_published(struct lab_run *run)
{
    static struct br_published column[BR_MOST_PUBLISHED];
    const size_t columns = br_published_read(column);
    size_t found[4][BR_PUBLISHED_LAST + 1] = {{0}}; /* by groups */
    for (size_t i = 0; i < columns; i++)
        found[try_published(&column[i])][column[i].group]++;
    for (size_t i = 0; i < 4; i++)
        printf("# %-14s %3zu of the first columns, %2zu of the later ones, %2zu of the last ones\n",
               found_texts[i], found[i][0], found[i][1], found[i][2]);
    const size_t covers = found[0][0] + found[0][1], excludes = found[2][0] + found[2][1],
                 none = found[3][0] + found[3][1];
    const bool ok = columns == 204 && covers >= 129 && excludes <= 10 && none <= 19 &&
                    found[0][2] >= 34 && found[2][2] <= 1;
    printf("%sok %zu - published columns\n", ok ? "" : "not ", ++run->number);
    run->bad += !ok;
}

/* ---- beside others ---- */

/* A cell of a table: held of stated, and the median width. */
static void print_cell(struct tally *t)
{
    if (t->widths)
        qsort(t->width, t->widths, sizeof *t->width, by_size);
    if (t->claims == 0)
        printf(" - |");
    else if (t->widths == 0)
        printf(" %zu of %zu |", t->covers, t->claims);
    else
        printf(" %zu of %zu, %.2g |", t->covers, t->claims, t->width[t->widths / 2]);
}

/* Counts an interval of one method: of an order, whose width is itself, or of a limit. */
static void count_interval(struct tally *t, struct br_other_interval found,
                           const struct br_error_line *line)
{
    const struct br_estimate order = {NAN, found.low, found.high};
    const bool two = isnan(line->other) || holds(&order, line->other);
    if (line->values) {
        count_limit(t, found.low, found.high, line->limit, line->e[line->rows - 1]);
    } else if (isfinite(found.high - found.low) && found.low > 0 && found.high - found.low <= 1) {
        t->claims++;
        t->covers += holds(&order, line->truth) && two;
        t->width[t->widths++] = (found.high - found.low) / 2;
    }
}

enum { METHODS = BR_OTHERS + 1 }; /* ours is the first */

/* What a method states of a line. */
static struct br_other_interval state(size_t method, const struct br_error_line *line)
{
    const enum br_other other = (enum br_other)(method - 1);
    const struct br_estimate ours = method == 0 ? stated(line) : (struct br_estimate){0};
    return method == 0    ? (struct br_other_interval){ours.low, ours.high}
           : line->values ? br_other_limit(other, line)
                          : br_other_order(other, line);
}

/* A row of a table: ours and the methods of others on the same lines of a class. */
static void compare_class(const struct br_error_class *class, uint64_t seed, size_t lines,
                          double *width, struct tally sum[METHODS])
{
    printf("| %s |", class->name);
    for (size_t method = 0; method < METHODS; method++) {
        struct tally t = {.width = width};
        for (size_t i = 0; i < lines; i++) {
            const struct br_error_line line = line_of(class, seed, i);
            count_interval(&t, state(method, &line), &line);
        }
        print_cell(&t);
        add(&sum[method], &t);
    }
    printf("\n");
}

/* A table of the classes of errors, or of values; seed: of the first class. The last rows are the
 * sums of the groups. */
static void compare(const struct br_error_class *class, uint64_t seed, bool values, size_t lines,
                    double *width)
{
    struct tally sum[BR_GROUPS][METHODS] = {0};
    printf("| %s | beamrate |", values ? "limits" : "orders");
    for (size_t other = 0; other < BR_OTHERS; other++)
        printf(" %s |", br_other_names[other]);
    printf("\n|---|---|---|---|---|---|\n");
    for (size_t i = 0; class[i].name; i++)
        if (line_of(&class[i], 1, 0).values == values)
            compare_class(&class[i], seed + i, lines, width, sum[class[i].group]);
    for (size_t group = 0; group < BR_GROUPS; group++) {
        size_t stated_by_any = 0;
        for (size_t method = 0; method < METHODS; method++)
            stated_by_any += sum[group][method].claims;
        if (stated_by_any > 0)
            printf("| all, %s |", group_names[group]);
        for (size_t method = 0; method < METHODS && stated_by_any > 0; method++)
            print_cell(&sum[group][method]);
        printf("%s", stated_by_any > 0 ? "\n" : "");
    }
    printf("\n");
}

/* ---- priors ---- */

#ifdef BR_PRIORS_CHANGE

/* What lines and limits show together, as shares of 100, and the mean of the logarithm of widths.
 */
enum { CLAIMS, COVERS, SILENT, FAILS, FALSE_PASS, WIDTH, LIMITS, HELD, LIMIT_WIDTH, MEASURES };
static const char *const measure_names[MEASURES] = {"claims",         "covers",     "silent",
                                                    "FAIL",           "false PASS", "width",
                                                    "limits: claims", "covers",     "width"};

static void add_classes(const struct lab_run *run, const struct br_error_class *class, try_one *try,
                        size_t lines, struct tally *sum, double *log_width)
{
    for (size_t i = 0; class[i].name; i++) {
        struct tally t = {.width = run->width};
        const bool has_order = class[i].group <= BR_HARD_ERRORS || class[i].group == BR_TWO_ORDERS;
        for (size_t k = 0; k < lines && has_order; k++)
            try(i, run->seed, k, &t);
        for (size_t k = 0; k < t.widths; k++)
            *log_width += log(fmax(t.width[k], 1e-6));
        sum->widths += t.widths;
        add(sum, &t);
    }
}

static void measure(const struct lab_run *run, size_t lines, double m[MEASURES])
{
    struct tally t = {0}, limits = {0};
    double width = 0, limit_width = 0;
    add_classes(run, br_error_classes, try_line, lines, &t, &width);
    add_classes(run, br_later_classes, try_later, lines, &t, &width);
    add_classes(run, br_limit_classes, try_line_limit, lines, &limits, &limit_width);
    m[CLAIMS] = 100 * (double)t.claims / (double)t.lines;
    m[COVERS] = 100 * (double)t.covers / (double)t.claims;
    m[SILENT] = 100 * (double)t.silent / (double)t.lines;
    m[FAILS] = 100 * (double)t.fail / (double)t.lines;
    m[FALSE_PASS] = 100 * (double)t.wrong_pass / (double)t.lines;
    m[WIDTH] = width / (double)t.widths;
    m[LIMITS] = 100 * (double)limits.claims / (double)limits.lines;
    m[HELD] = 100 * (double)limits.covers / (double)limits.claims;
    m[LIMIT_WIDTH] = limit_width / (double)limits.widths;
}

/* A cell: what moves from what it was before. */
static void print_moves(const struct lab_run *run, size_t lines, const double before[MEASURES])
{
    double m[MEASURES];
    bool moves = false;
    measure(run, lines, m);
    for (size_t i = 0; i < MEASURES; i++) {
        const bool width = i == WIDTH || i == LIMIT_WIDTH;
        const double by = m[i] - before[i];
        if (!(fabs(by) >= (width ? 0.01 : 0.1)))
            continue;
        if (width)
            printf("%s %s x%.2f", moves ? "," : "", measure_names[i], exp(by));
        else
            printf("%s %s %+.1f", moves ? "," : "", measure_names[i], by);
        moves = true;
    }
    printf("%s |", moves ? "" : " -");
    fflush(stdout);
}

static void print_prior(const struct lab_run *run, size_t lines, const char *name, double *prior,
                        double off, const double before[MEASURES])
{
    const double kept = *prior, values[] = {off, kept / 2, kept * 2};
    printf("| %s, %g |", name, kept);
    for (size_t i = 0; i < 3; i++) {
        *prior = values[i];
        print_moves(run, lines, before);
    }
    *prior = kept;
    printf("\n");
}

/* All laws beside one power and, if everything, all other priors. */
static void scale(double by, bool everything)
{
    for (struct br_family *f = br_families; f < br_families + BR_FAMILIES; f++)
        f->prior *= by;
#define X(row, value, off, why) br_priors.row *= everything ? by : 1;
    BR_PRIOR_LIST(X)
#undef X
}

static void print_all(const struct lab_run *run, size_t lines, bool everything,
                      const double before[MEASURES])
{
    printf("| *%s* | |", everything ? "all priors" : "all laws beside one power");
    for (double by = 0.5; by < 3; by *= 4) {
        scale(by, everything);
        print_moves(run, lines, before);
        scale(1 / by, everything);
    }
    printf("\n");
}

/* One row a prior: what moves without it, with half of it and with twice as much; then all. */
static void print_priors(const struct lab_run *run, size_t lines)
{
    double before[MEASURES];
    char name[64];
    measure(run, lines, before);
    for (size_t i = 0; i < MEASURES; i++)
        printf("# %s %.2f\n", measure_names[i], before[i]);
    printf("| prior | without | half | twice |\n|---|---|---|---|\n");
    print_all(run, lines, true, before);
    print_all(run, lines, false, before);
#define X(row, value, off, why) print_prior(run, lines, #row, &br_priors.row, off, before);
    BR_PRIOR_LIST(X)
#undef X
    for (struct br_family *f = br_families; f < br_families + BR_FAMILIES; f++) {
        snprintf(name, sizeof name, f->curve > 0 ? "%s h^%.2g and h^%.2g" : "%s h^%.2g",
                 br_law_text(f->law), f->s, f->curve);
        print_prior(run, lines, name, &f->prior, 0, before);
    }
}

#endif

int main(int arguments, char **argument)
{
    const size_t lines = arguments >= 3   ? strtoul(argument[2], NULL, 10)
                         : br_test_long() ? MANY
                                          : SAMPLE;
    const size_t grids = (lines + 3) / 4; /* of two orders and some ten lines each */
    struct lab_run run = {
        .seed = arguments >= 3 ? strtoull(argument[1], NULL, 10) : 1,
        .only = arguments == 4 ? argument[3] : NULL,
        .width = br_allocate(lines + 1, sizeof *run.width),
    };
    if (!run.width || !(lines > 0 && lines <= MOST_LINES) ||
        (arguments != 1 && arguments != 3 && arguments != 4)) {
        fputs("usage: orders [SEED LINES [CLASS | published | compare]]\n", stderr);
        return 2;
    }
    if (run.only && strcmp(run.only, "compare") == 0) {
        compare(br_error_classes, run.seed * 1000, false, lines, run.width);
        compare(br_limit_classes, run.seed * 1000 + 600, true, lines, run.width);
        free(run.width);
        return 0;
    }
#ifdef BR_PRIORS_CHANGE
    print_priors(&run, lines);
    free(run.width);
    return 0;
#endif
    printf("TAP version 13\n");
    printf("# %%, seed %llu\n# %-29s %6s %6s %6s %6s %6s %6s %6s %8s\n",
           (unsigned long long)run.seed, "class", "claims", "covers", "silent", "PASS", "FAIL",
           "false", "narrow", "width");
    try_classes(&run, br_error_classes, try_line, lines, "lines");
    begin(&run, grids, "grids, of two orders each,");
    for (size_t i = 0; i < BR_GRID_CLASSES; i++)
        try_class(&run, br_grid_classes[i].name, br_grid_classes[i].group, i, try_grid, grids);
    end(&run);
    begin(&run, grids, "limits of values");
    for (size_t i = 0; i < BR_VALUE_CLASSES; i++)
        try_class(&run, br_value_classes[i].name, BR_NOISY_ERRORS, i, try_limit, grids);
    end(&run);
    try_classes(&run, br_limit_classes, try_line_limit, lines, "limits of lines");
    run.held_out = true;
    try_classes(&run, br_later_classes, try_later, lines, "lines that came later");
    try_classes(&run, br_held_out_classes, try_held_out, lines, "held-out lines");
    begin(&run, lines, "limits of held-out lines");
    for (size_t i = 0; br_held_out_classes[i].name; i++)
        if (line_of(&br_held_out_classes[i], 1, 0).values)
            try_class(&run, br_held_out_classes[i].name, BR_NOISY_ERRORS, i, try_held_out_limit,
                      lines);
    end(&run);
    if (!run.only || strcmp(run.only, "published") == 0)
        try_all_published(&run);
    printf("1..%zu\n", run.number);
    free(run.width);
    return run.bad > 0;
}
