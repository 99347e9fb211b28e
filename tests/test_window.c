/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Windows by hand: the finest sizes alone, or all but some. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "checks.h"
#include "orders/request.h"

static enum br_status read_window(const char *text, const char *values, double finest,
                                  const char *without, struct br_numbers *numbers)
{
    const struct br_orders_request q = {.path = (char *)"t.csv",
                                        .table = (char *)text,
                                        .values = (char *)values,
                                        .dimension = 2,
                                        .assumed_dimension = true,
                                        .finest = finest,
                                        .without = (char *)without};
    return br_orders_read(&q, numbers, &err);
}

static void same_estimate(const struct br_estimate *a, const struct br_estimate *b)
{
    assert_memory_equal(a, b, sizeof *a);
}

/* What a window shows is, to the bit, what a table of its rows alone shows. */
static void window_is(const char *all, const char *alone, const char *values, double finest,
                      const char *without, const char *named)
{
    struct br_numbers n[2];
    struct br_orders o[2];
    MUST(read_window(all, values, finest, without, &n[0]));
    MUST(read_window(alone, values, 0, NULL, &n[1]));
    assert_string_equal(n[0].quantity->window, named);
    assert_null(n[1].quantity->window);
    assert_true(n[0].rows > n[1].rows); /* those left out are shown */
    for (int i = 0; i < 2; i++)
        MUST(br_orders_find(&n[i], 2, &o[i], &err));
    assert_int_equal(o[0].of->lines, o[1].of->lines);
    for (int axis = 0; axis < BR_AXES; axis++)
        same_estimate(&o[0].of->answer[axis].order, &o[1].of->answer[axis].order);
    for (size_t l = 0; l < o[0].of->lines; l++) {
        const struct br_orders_line *a = &o[0].of->line[l], *b = &o[1].of->line[l];
        assert_int_equal(a->observed.points, b->observed.points);
        same_estimate(&a->observed.order, &b->observed.order);
        same_estimate(&a->limits.limit.value, &b->limits.limit.value);
        if (values)
            CLOSE(a->limits.gci.fine.index, b->limits.gci.fine.index, 0);
    }
    same_estimate(&o[0].of->limit.value, &o[1].of->limit.value);
    same_estimate(&o[0].of->joint.order[0], &o[1].of->joint.order[0]);
    same_estimate(&o[0].of->joint.order[1], &o[1].of->joint.order[1]);
    for (int i = 0; i < 2; i++) {
        br_orders_clear(&o[i]);
        br_numbers_clear(&n[i]);
    }
}

TEST(test_windows)
{
    static const char errors[] = "n,l2\n2,0.93\n4,0.31\n8,0.99\n16,0.0101\n32,0.0025\n64,0.00062\n";
    static const char drag[] = "h,drag\n1,1.31\n.5,1.21\n.25,1.05\n.125,1.015\n.0625,1.004\n";
    char grid[600] = "h,k,l2\n", part[600] = "h,k,l2\n";
    window_is(errors, "n,l2\n16,0.0101\n32,0.0025\n64,0.00062\n", NULL, 3, NULL,
              "the 3 finest of 6");
    window_is(errors, "n,l2\n2,0.93\n4,0.31\n16,0.0101\n32,0.0025\n64,0.00062\n", NULL, 0, "8",
              "all but 8");
    window_is(errors, "n,l2\n4,0.31\n16,0.0101\n32,0.0025\n64,0.00062\n", NULL, 4, "n=8, 2",
              "the 4 finest of 4, without n=8, 2");
    window_is(drag, "h,drag\n.25,1.05\n.125,1.015\n.0625,1.004\n", "drag", 3, NULL,
              "the 3 finest of 5");
    window_is(drag, "h,drag\n1,1.31\n.5,1.21\n.25,1.05\n.0625,1.004\n", "drag", 0, "1/8",
              "all but 1/8");
    window_is("h,l2\n.33333333,1\n.3333333,1.1\n.25,.5\n.125,.12\n.0625,.03\n.03125,.008\n",
              "h,l2\n.25,.5\n.125,.12\n.0625,.03\n.03125,.008\n", NULL, 0, ".3333333",
              "all but .3333333"); /* both are shown as 0.333333 */
    for (int i = 0; i < 5; i++)
        for (int j = 0; j < 5; j++) {
            char row[60];
            snprintf(row, sizeof row, "%g,%g,%.10g\n", exp2(-i), exp2(-j),
                     0.3 * exp2(-2 * i) + 0.7 * exp2(-j));
            strcat(grid, row);
            strcat(part, i >= 1 && j >= 1 ? row : "");
        }
    window_is(grid, part, NULL, 4, NULL, "the 4 finest of 5 h and of 5 k");
    window_is(grid, part, NULL, 0, "h=1,k=1", "all but h=1,k=1");
}

/* A column with fewer sizes than the window has all of them; a long list is named whole. */
TEST(test_names_of_windows)
{
    struct br_numbers n;
    char list[700] = "2";
    for (int i = 0; i < 150; i++)
        strcat(list, ", 2");
    MUST(read_window("n,e,f\n2,,1\n4,.25,.5\n8,.06,.25\n16,.02,.12\n", NULL, 4, NULL, &n));
    assert_string_equal(n.quantity[0].window, "the 3 finest of 3");
    assert_string_equal(n.quantity[1].window, "the 4 finest of 4");
    br_numbers_clear(&n);
    MUST(read_window("n,e\n2,1\n4,.25\n8,.06\n16,.02\n", NULL, 0, list, &n));
    assert_string_equal(n.quantity->window + strlen("all but "), list);
    br_numbers_clear(&n);
}

TEST(test_refused_windows)
{
    static const char text[] = "n,k,l2\n2,.1,1\n4,.1,.25\n8,.1,.06\n2,8,2\n4,8,1.2\n8,8,1.1\n"
                               "2,1,2\n4,1,1.2\n8,1,1.1\n";
    static const struct {
        double finest;
        const char *without, *message;
    } rows[] = {
        {0, "7",
         "t.csv: --without: found 7, which is no size there, expected one of: n = 2, n = 4"},
        {0, "8", "--without: 8 is a size of n and of k, expected n=8 or k=8"},
        {0, "k=2", "found k=2, which is no size there"},
        {0, "fine", "found 'fine', expected sizes, like 8 or 8,16 or n=8"},
        {0, "m=8", "found m=8, which is no size there"},
        {0, "nan", "found 'nan', expected sizes"},
        {4, NULL, "--finest: found 4, expected at most the 3 sizes that have numbers"},
        {0, "n=2,k=1", "rows by hand: of l2 2 sizes would be left, expected at least 3"},
        {0, "k=.1,k=8", "rows by hand: of l2 1 size would be left, expected at least 2"},
    };
    struct br_numbers n;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        REFUSED(read_window(text, NULL, rows[i].finest, rows[i].without, &n), BR_BAD_INPUT,
                rows[i].message);
        br_numbers_clear(&n);
    }
}

static enum br_status whole_window(const void *text, struct br_error *why)
{
    OWNED(br_numbers) numbers;
    const enum br_status status = read_window(text, NULL, 3, "8", &numbers);
    if (status)
        *why = err;
    return status;
}

TEST(test_windows_without_memory)
{
    br_test_without_memory(whole_window, "n,l2\n4,1\n8,.3\n16,.09\n32,.02\n64,.006\n", 20);
}
