/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Checks the intervals of orders with synthetic studies of known orders, of five kinds, 400 each.
 * Prints how many of the 95 % intervals contain the order, and how many verdicts on an order that
 * is wrong by 0.3 to 1 are PASS. Run it with `meson test --benchmark orders`. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include "orders/orders.h"

enum { STUDIES = 400, MOST_ROWS = 64 };

static uint64_t state = 20061122;

/* Uniform in (0, 1): SplitMix64. */
static double uniform(void)
{
    uint64_t z = state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return ((double)((z ^ (z >> 31)) >> 11) + 0.5) * 0x1p-53;
}

static double between(double low, double high)
{
    return low + (high - low) * uniform();
}

static double normal(void)
{
    return sqrt(-2 * log(uniform())) * cos(2 * acos(-1) * uniform());
}

/* A synthetic study: rows of one error. */
struct made {
    struct br_quantity quantity;
    struct br_numbers_row row[MOST_ROWS];
    double error[MOST_ROWS];
    enum br_flag out; /* none */
    struct br_numbers numbers;
    double p, q; /* the orders; q: NaN without time steps */
};

static void add(struct made *m, double h, double k, double error)
{
    const size_t i = m->numbers.rows++;
    m->error[i] = error;
    m->row[i] = (struct br_numbers_row){.given = {h, k},
                                        .z = {h, k},
                                        .number = &m->error[i],
                                        .out = &m->out,
                                        .line = i + 2,
                                        .seconds = NAN};
}

/* A line of 6 to 8 meshes, of ratio 1.5 to 2. */
static void make_line(struct made *m, double (*error)(double h, double p, const double *drawn))
{
    const double p = m->p = round(2 * between(1, 4)) / 2, ratio = between(1.5, 2);
    const double drawn[] = {uniform(), uniform(), uniform()};
    const size_t count = 6 + (size_t)(3 * uniform());
    double h = between(0.1, 0.3);
    for (size_t i = 0; i < count; i++, h /= ratio)
        add(m, h, NAN, between(1, 1) * error(h, p, drawn));
}

static double clean(double h, double p, const double *drawn)
{
    return (0.1 + drawn[0]) * pow(h, p);
}

static double pre_asymptotic(double h, double p, const double *drawn)
{
    return pow(h, p) * (1 + 2 * drawn[0] * h - drawn[1] * h * h);
}

static double noisy(double h, double p, const double *drawn)
{
    return pow(h, p) * exp((0.01 + 0.09 * drawn[0]) * normal());
}

static double floored(double h, double p, const double *drawn)
{
    const double level = pow(10, -14 + 5 * drawn[0]);
    return 10 * pow(h, 2 * p) + level * (0.5 + uniform());
}

/* A grid of space and time errors that may have opposite signs. */
static void make_grid(struct made *m)
{
    m->p = 1 + (double)(int)(3 * uniform());
    m->q = 1 + (double)(int)(2 * uniform());
    const double a = between(0.2, 2), b = between(0.2, 2) * (uniform() < 0.5 ? -1 : 1);
    const size_t n = 4 + (size_t)(3 * uniform());
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < n; j++) {
            const double h = 0.2 * pow(2, -(double)i), k = 0.1 * pow(2, -(double)j);
            add(m, h, k, fabs(a * pow(h, m->p) + b * pow(k, m->q)));
        }
}

static const struct {
    const char *name;
    double (*error)(double h, double p, const double *drawn); /* NULL: a grid */
    double factor;                                            /* of the order */
} kinds[] = {{"clean", clean, 1},
             {"pre-asymptotic", pre_asymptotic, 1},
             {"noise of 1 to 10 %", noisy, 1},
             {"floor", floored, 2},
             {"signed, h and k", NULL, 1}};

struct tally {
    size_t tried, covered, wrong, passed;
    double width;
};

static void cover(struct tally *t, const struct br_estimate *order, double truth)
{
    const double round_off = 1e-9;
    if (!isfinite(order->low) || !isfinite(order->high))
        return;
    t->tried++;
    t->covered += order->low - round_off <= truth && truth <= order->high + round_off;
    t->width += order->high - order->low;
}

/* Verdicts that expect another order. */
static void expect_wrong(struct tally *t, const struct br_orders *o, enum br_axis axis,
                         double truth)
{
    struct br_error err;
    struct br_check check = {.path = "made"};
    const double off = between(0.3, 1) * (uniform() < 0.5 ? -1 : 1);
    struct br_order_expectation e = {
        .quantity = "e",
        .axis = axis,
        .band = {.order = truth + off, .tolerance = 0.1, .floor = NAN, .ceiling = NAN}};
    if (!(e.band.order > e.band.tolerance) || br_orders_check(o, &e, 1, &check, &err))
        return;
    t->wrong++;
    t->passed += check.cases[0].verdict == BR_PASS;
    br_check_clear(&check);
}

static bool study(size_t kind, struct tally *t)
{
    struct br_error err;
    static struct made m;
    struct br_orders o;
    m = (struct made){.quantity = {.name = (char[]){"e"}}, .q = NAN};
    m.numbers = (struct br_numbers){.column = {br_resolution_column_find("h")},
                                    .quantity = &m.quantity,
                                    .quantities = 1,
                                    .row = m.row};
    if (kinds[kind].error)
        make_line(&m, kinds[kind].error);
    else {
        m.numbers.column[BR_AXIS_TIME] = br_resolution_column_find("k");
        make_grid(&m);
    }
    const double p = m.p * kinds[kind].factor;
    if (br_orders_find(&m.numbers, 2, &o, &err))
        return false;
    if (kinds[kind].error)
        cover(t, &o.of[0].line[0].observed.order, p);
    else if (br_joint_describes(&o.of[0].joint)) {
        cover(t, &o.of[0].joint.order[0], p);
        cover(t, &o.of[0].joint.order[1], m.q);
    }
    expect_wrong(t, &o, BR_AXIS_SPACE, p);
    br_orders_clear(&o);
    return true;
}

int main(void)
{
    struct tally all = {0};
    printf("%-20s %8s %10s %12s %8s %8s\n", "studies", "orders", "covered", "mean width", "wrong",
           "PASS");
    for (size_t kind = 0; kind < sizeof kinds / sizeof *kinds; kind++) {
        struct tally t = {0};
        for (size_t i = 0; i < STUDIES; i++)
            if (!study(kind, &t))
                return EXIT_FAILURE;
        printf("%-20s %8zu %8.1f %% %12.3g %8zu %8zu\n", kinds[kind].name, t.tried,
               100 * (double)t.covered / (double)t.tried, t.width / (double)t.tried, t.wrong,
               t.passed);
        all.tried += t.tried;
        all.covered += t.covered;
        all.wrong += t.wrong;
        all.passed += t.passed;
    }
    printf("%-20s %8zu %8.1f %% %12s %8zu %8zu\n", "all", all.tried,
           100 * (double)all.covered / (double)all.tried, "", all.wrong, all.passed);
    return EXIT_SUCCESS;
}
