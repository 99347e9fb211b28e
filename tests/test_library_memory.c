/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The n-th allocation of a call of the library fails, also in GSL, Jansson and the C library: the
 * call returns "out of memory", or the same numbers, and never ends the process. */
#include <limits.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "faults.h"
#include "orders/library/beamrate.h"
#include "support.h"

static struct beamrate_error failure;
static struct beamrate_orders *orders;
static struct beamrate_check *check;

/* ---- calls: each makes one handle, and `number` of its results ---- */

struct call {
    const char *name;
    enum beamrate_status (*make)(const void *with, double *number);
    const void *with;
};

static enum beamrate_status find_orders(const void *values, double *number)
{
    static const double h[] = {8, 8, 8, 4, 4, 4, 2, 2, 2, 1, 1, 1}, line[] = {8, 4, 2, 1},
                        k[] = {4, 2, 1, 4, 2, 1, 4, 2, 1, 4, 2, 1}, value[] = {71, 23, 11, 8};
    static const double error[] = {68, 66, 65, 20, 18, 17, 8, 6, 5, 5, 3.01, 2};
    static const struct beamrate_expectation expected = {BEAMRATE_SPACE, 2, 0.5, 0};
    const bool are_values = *(const int *)values;
    const struct beamrate_numbers numbers = {.h = are_values ? line : h,
                                             .k = are_values ? NULL : k,
                                             .number = are_values ? value : error,
                                             .count = are_values ? 4 : 12,
                                             .values = are_values};
    struct beamrate_order order = {.points = 0};
    struct beamrate_case c = {.points = 0};
    enum beamrate_status status = beamrate_orders_find(&orders, &numbers, &failure);
    assert_int_equal(!orders, status != BEAMRATE_OK);
    if (!status) {
        beamrate_orders_line(orders, BEAMRATE_SPACE, &order);
        status = beamrate_orders_check(&check, orders, &expected, 1, &failure);
        assert_int_equal(!check, status != BEAMRATE_OK);
        if (!status)
            beamrate_check_case(check, 0, &c);
        beamrate_check_free(check);
    }
    *number = order.order.high + (are_values ? order.limit.high : 0) + c.margin;
    beamrate_orders_free(orders);
    return status;
}

static enum beamrate_status read_orders(const void *text, double *number)
{
    const struct beamrate_table table = {.text = text};
    const char *json = NULL;
    enum beamrate_status status = beamrate_orders_read(&orders, &table, &failure);
    assert_int_equal(!orders, status != BEAMRATE_OK);
    *number = 0;
    if (!status)
        status = beamrate_orders_report(orders, &json, &failure);
    assert_int_equal(!json, status != BEAMRATE_OK);
    for (const char *c = json; c && *c; c++) /* each letter counts, and its place */
        *number = fmod(*number * 31 + *c, 1e12);
    beamrate_orders_free(orders);
    return status;
}

static enum beamrate_status read_trade(const void *text, double *number)
{
    const struct beamrate_table table = {.name = "a.csv", .text = text};
    struct beamrate_trade *trade;
    const char *json = NULL;
    enum beamrate_status status = beamrate_trade_read(&trade, &table, 1, NULL, &failure);
    assert_int_equal(!trade, status != BEAMRATE_OK);
    *number = 0;
    if (!status)
        status = beamrate_trade_report(trade, &json, &failure);
    assert_int_equal(!json, status != BEAMRATE_OK);
    for (const char *c = json; c && *c; c++)
        *number = fmod(*number * 31 + *c, 1e12);
    beamrate_trade_free(trade);
    return status;
}

/* ---- all of them ---- */

static const int one = 1, none = 0;
static const struct call calls[] = {
    {"orders of errors", find_orders, &none},
    {"orders of values", find_orders, &one},
    {"a trade", read_trade, "n,e,seconds\n8,68,1\n16,20,4\n32,8,15\n"},
    {"orders of a table", read_orders, "h,e,f\n8,68,9\n4,20,\n2,8,3\n1,5,1.5\n"},
};

/* In a child process: 0: as without a failure; 3: out of memory, named; else wrong. */
static int outcome(const struct call *c, long n, double expected)
{
    fflush(NULL);
    const pid_t child = fork();
    if (child == 0) {
        signal(SIGSEGV, SIG_DFL); /* cmocka has handlers */
        signal(SIGABRT, SIG_DFL);
        double number;
        br_memory_fails_at(n);
        const enum beamrate_status status = c->make(c->with, &number);
        br_memory_fails_at(-1);
        if (status == BEAMRATE_NO_MEMORY)
            _exit(strstr(failure.message, "memory") ? 3 : 98);
        if (status)
            fprintf(stderr, "# status %d: %s\n", (int)status, failure.message);
        _exit(status ? 97 : memcmp(&number, &expected, sizeof number) ? 96 : 0);
    }
    int ended = 0;
    waitpid(child, &ended, 0);
    return WIFSIGNALED(ended) ? -WTERMSIG(ended) : WEXITSTATUS(ended);
}

TEST(any_allocation_may_fail)
{
    for (const struct call *c = calls; c < calls + sizeof calls / sizeof *calls; c++) {
        double expected;
        if (c->make(c->with, &expected)) /* what is kept for the process */
            fail_msg("%s: %s", c->name, failure.message);
        br_memory_fails_at(LONG_MAX);
        const enum beamrate_status status = c->make(c->with, &expected);
        const long all = br_memory_fails_at(-1);
        assert_int_equal(status, BEAMRATE_OK);
        long failures = 0, wrong = 0;
        for (long n = 1; n <= all; n++) {
            const int ended = outcome(c, n, expected);
            failures += ended == 3;
            if (ended && ended != 3 && ++wrong < 10)
                print_error("%s: allocation %ld of %ld: %d\n", c->name, n, all, ended);
        }
        print_message("# %s: %ld allocations, %ld failures\n", c->name, all, failures);
        if (wrong || !failures)
            fail_msg("%s: %ld of %ld allocations are not survived", c->name, wrong, all);
    }
}
