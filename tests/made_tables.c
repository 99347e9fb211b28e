/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "made_tables.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum br_status read_table(const char *text, const char *errors, const char *values,
                          struct br_numbers *numbers)
{
    const struct br_orders_request q = {.path = (char *)"t.csv",
                                        .table = (char *)text,
                                        .errors = (char *)errors,
                                        .values = (char *)values,
                                        .dimension = 2,
                                        .assumed_dimension = true};
    return br_orders_read(&q, numbers, &err);
}

struct br_numbers read_with(const char *text, const char *values)
{
    struct br_numbers numbers;
    MUST(read_table(text, NULL, values, &numbers));
    return numbers;
}

double power_law(double h, double k, double p, double q)
{
    return (h > 0 ? 3 * pow(h, p) : 0) + (k > 0 ? 0.7 * pow(k, q) : 0);
}

const char *table_of(int meshes, int steps, double p, double q)
{
    static char text[MOST_TEXT];
    size_t used = (size_t)snprintf(text, sizeof text, "%s%s%s,l2\n", meshes ? "h" : "",
                                   meshes && steps ? "," : "", steps ? "k" : "");
    for (int i = meshes ? 1 : 0; i <= meshes; i++)
        for (int j = steps ? 1 : 0; j <= steps; j++) {
            const double h = i ? pow(2, -i) : 0, k = j ? pow(2, -j) : 0;
            if (i)
                used += (size_t)snprintf(text + used, sizeof text - used, "%.17g,", h);
            if (j)
                used += (size_t)snprintf(text + used, sizeof text - used, "%.17g,", k);
            used +=
                (size_t)snprintf(text + used, sizeof text - used, "%.17g\n", power_law(h, k, p, q));
        }
    return text;
}

char *grid_of(int meshes, int steps, double (*f)(double h, double k))
{
    static char text[MOST_TEXT];
    size_t used = (size_t)snprintf(text, sizeof text, "h,k,l2\n");
    for (int i = 0; i < meshes; i++)
        for (int j = 0; j < steps; j++)
            used += (size_t)snprintf(text + used, sizeof text - used, "%.17g,%.17g,%.17g\n",
                                     pow(2, -i), pow(2, -j), f(pow(2, -i), pow(2, -j)));
    return text;
}

struct found found;

void find(const char *text, const char *values)
{
    br_orders_clear(&found.orders);
    br_numbers_clear(&found.numbers);
    found.numbers = read_with(text, values);
    MUST(br_orders_find(&found.numbers, 2, &found.orders, &err));
}

const char *scaled_floor_table(int rows, double level, double unit)
{
    static char text[4096];
    size_t used = (size_t)snprintf(text, sizeof text, "h,l2\n");
    for (int i = 0; i < rows; i++)
        used += (size_t)snprintf(text + used, sizeof text - used, "%.17g,%.17g\n", pow(2, -i),
                                 unit * fmax(pow(4, -i), level));
    return text;
}

const char *floor_table(int rows, double level)
{
    return scaled_floor_table(rows, level, 1);
}

int verdict_of(const char *table, const char *values, const char *expected, char why[768])
{
    FREED struct br_order_expectation *e = NULL;
    OWNED(br_check) check = {.path = "t.csv"};
    size_t count = 0;
    find(table, values);
    MUST(br_expectations_read(expected, 0, &e, &count, &err));
    int verdict = -1;
    err.status = BR_OK;
    if (!br_orders_check(&found.orders, e, count, &check, &err)) {
        assert_int_equal(check.count, count);
        verdict = (int)check.cases[count - 1].verdict;
    }
    assert_true(verdict >= 0 || err.status == BR_BAD_INPUT);
    snprintf(why, 768, "%.767s", verdict < 0 ? err.message : check.cases[count - 1].reason);
    return verdict;
}
