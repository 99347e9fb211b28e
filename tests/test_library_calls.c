/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The library's calls: orders and verdicts, errors by value, several threads, ends of memory. That
 * it is installed and found is tested by library.sh. */
#include <gsl/gsl_errno.h>
#include <locale.h>
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "orders/library/beamrate.h"
#include "support.h"

static struct beamrate_error failure;

/* A call that must end with a status, and say a text. */
#define ENDS(call, expected, text)                                                                 \
    do {                                                                                           \
        const enum beamrate_status ended = (call);                                                 \
        if (ended != (expected) || failure.status != (expected) || !strstr(failure.message, text)) \
            fail_msg("%s: status %d, message '%s', expected %d and '%s'", #call, (int)ended,       \
                     failure.message, (int)(expected), text);                                      \
    } while (0)
#define WORKS(call) ENDS(call, BEAMRATE_OK, "")

/* ---- orders ---- */

TEST(orders_of_numbers)
{
    double h[16], k[16], error[16], value[16];
    struct beamrate_orders *orders;
    struct beamrate_order order;
    struct beamrate_fit fit;
    struct beamrate_check *check;
    struct beamrate_case c;
    for (int i = 0; i < 16; i++) {
        h[i] = ldexp(0.1, -(i / 4));
        k[i] = ldexp(0.2, -(i % 4));
        error[i] = 3 * h[i] * h[i] + 0.5 * k[i];
        value[i] = 7 + h[i] * h[i];
    }
    struct beamrate_numbers numbers = {.h = h, .k = k, .number = error, .count = 16};
    WORKS(beamrate_orders_find(&orders, &numbers, &failure));
    beamrate_orders_fit(orders, &fit);
    CLOSE(fit.p.value, 2, 1e-6);
    CLOSE(fit.q.value, 1, 1e-6);
    CLOSE(fit.c_h.value, 3, 1e-5);
    CLOSE(fit.c_k.value, 0.5, 1e-6);
    assert_int_equal(fit.describes, 1);
    const struct beamrate_expectation expected[] = {{BEAMRATE_SPACE, 2, 0.1, 0},
                                                    {BEAMRATE_TIME, 2, 0.1, 0}};
    WORKS(beamrate_orders_check(&check, orders, expected, 2, &failure));
    beamrate_orders_free(orders);
    assert_int_equal(beamrate_check_count(check), 2);
    beamrate_check_case(check, 0, &c);
    assert_int_equal(c.verdict, BEAMRATE_PASS);
    assert_string_equal(c.study, "space");
    assert_string_equal(c.measure, "error");
    assert_true(c.expected == 2 && c.tolerance == 0.1 && c.margin >= 0 && !*c.reason);
    beamrate_check_case(check, 1, &c);
    assert_int_equal(c.verdict, BEAMRATE_FAIL);
    assert_true(c.margin < 0 && *c.reason);
    assert_string_equal(c.study, "time");
    beamrate_check_free(check);
    double coarse[4] = {h[0], h[4], h[8], h[12]},
           values[4] = {value[0], value[4], value[8], value[12]};
    numbers = (struct beamrate_numbers){.h = coarse, .number = values, .count = 4, .values = 1};
    WORKS(beamrate_orders_find(&orders, &numbers, &failure));
    assert_int_equal(beamrate_orders_line(orders, BEAMRATE_SPACE, &order), 1);
    CLOSE(order.order.value, 2, 1e-6);
    CLOSE(order.constant, 1, 1e-5);
    CLOSE(order.limit.value, 7, 1e-9);
    assert_int_equal(order.points, 3);
    assert_int_equal(beamrate_orders_line(orders, BEAMRATE_TIME, &order), 0);
    beamrate_orders_fit(orders, &fit);
    assert_true(isnan(fit.p.value) && isnan(fit.misfit) && !fit.describes);
    ENDS(beamrate_orders_check(&check, orders, &expected[1], 1, &failure), BEAMRATE_BAD_INPUT,
         "numbers: an order of value in k is expected");
    beamrate_orders_free(orders);
    beamrate_orders_free(NULL);
}

TEST(wrong_numbers_are_refused)
{
    double h[] = {4, 2, 1}, error[] = {16, 4, 1};
    struct beamrate_orders *orders;
    struct beamrate_numbers numbers = {.number = error, .count = 3};
    ENDS(beamrate_orders_find(&orders, &numbers, &failure), BEAMRATE_BAD_INPUT, "neither h nor k");
    numbers.h = h;
    numbers.count = 2;
    ENDS(beamrate_orders_find(&orders, &numbers, &failure), BEAMRATE_BAD_INPUT, "at least 3");
    numbers.count = 3;
    error[1] = -4;
    ENDS(beamrate_orders_find(&orders, &numbers, &failure), BEAMRATE_BAD_INPUT, "numbers:2: error");
    error[1] = 4;
    h[2] = NAN;
    ENDS(beamrate_orders_find(&orders, &numbers, &failure), BEAMRATE_BAD_INPUT, "numbers:3: h");
    assert_null(orders);
    h[2] = 1;
    WORKS(beamrate_orders_find(&orders, &numbers, &failure));
    const struct beamrate_expectation wrong[] = {{BEAMRATE_SPACE, 2, 3, 0},
                                                 {BEAMRATE_SPACE, NAN, 0.1, 0},
                                                 {BEAMRATE_SPACE, INFINITY, 0.1, 0},
                                                 {BEAMRATE_SPACE, 2, 0.1, NAN}};
    struct beamrate_check *check;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        ENDS(beamrate_orders_check(&check, orders, &wrong[i], 1, &failure), BEAMRATE_BAD_INPUT,
             "expectation 0: found order");
    beamrate_orders_free(orders);
}

/* e = 3 h^2 and v = 7 + h on h = 1/n; the mesh of 5 has another error. */
static const char two_columns[] = "N; e [m]; v\n5; 0,9; 7,2\n10; 0,03; 7,1\n20; 0,0075; 7,05\n"
                                  "40; 0,001875; 7,025\n80; 0,00046875; 7,0125\n";

TEST(orders_of_a_table)
{
    struct beamrate_table table = {.text = two_columns, .errors = "e", .values = "v", .formal = 1};
    struct beamrate_orders *orders;
    struct beamrate_answer answer;
    struct beamrate_order_point point;
    struct beamrate_check *check;
    struct beamrate_case c;
    const char *json;
    WORKS(beamrate_orders_read(&orders, &table, &failure));
    for (size_t i = 0; i < 2; i++) {
        assert_int_equal(beamrate_orders_answer(orders, i, BEAMRATE_SPACE, &answer), 1);
        assert_string_equal(answer.quantity, i ? "v" : "e");
        assert_int_equal(answer.values, i);
        assert_int_equal(answer.refined, 1);
        CLOSE(answer.order.value, i ? 1 : 2, 1e-4); /* of few digits */
        assert_string_equal(answer.open, "");
        assert_int_equal(beamrate_orders_answer(orders, i, BEAMRATE_TIME, &answer), 1);
        assert_true(!answer.refined && isnan(answer.order.value));
        for (size_t at = 1; at < 5 - i; at++) {
            assert_int_equal(beamrate_orders_point(orders, i, BEAMRATE_SPACE, at, &point), 1);
            CLOSE(point.size, 0.2 / (double)(1 << at), 1e-12);
            CLOSE(point.error, i ? point.size / 2 : 3 * point.size * point.size, 1e-12);
            CLOSE(point.fit.value, point.error, 1e-4 * point.error);
            assert_true(point.fit.low <= point.fit.value && point.fit.value <= point.fit.high);
            assert_string_equal(point.left_out, "");
            if (at > 1)
                CLOSE(point.rate, i ? 1 : 2, 1e-9);
        }
        assert_int_equal(beamrate_orders_point(orders, i, BEAMRATE_SPACE, 5 - i, &point), 0);
        assert_true(isnan(point.error) && !*point.left_out);
        assert_int_equal(beamrate_orders_point(orders, i, BEAMRATE_TIME, 0, &point), 0);
        const struct beamrate_expectation expected = {BEAMRATE_SPACE, i ? 1 : 2, 0.1, 0};
        WORKS(beamrate_orders_check_quantity(&check, orders, i, &expected, 1, &failure));
        beamrate_check_case(check, 0, &c);
        assert_int_equal(c.verdict, BEAMRATE_PASS);
        assert_string_equal(c.measure, i ? "v" : "e");
        beamrate_check_free(check);
    }
    beamrate_orders_point(orders, 0, BEAMRATE_SPACE, 0, &point);
    assert_string_equal(point.left_out, "not asymptotic");
    assert_int_equal(beamrate_orders_answer(orders, 2, BEAMRATE_SPACE, &answer), 0);
    assert_true(!*answer.quantity && isnan(answer.order.value));
    WORKS(beamrate_orders_report(orders, &json, &failure));
    assert_non_null(strstr(json, "\"answer\": [\n  \"e: order 2.00"));
    assert_non_null(strstr(json, "\"gci_fine\": "));
    WORKS(beamrate_orders_expect(&check, orders, "V >= 0.9; e: h 2", &failure));
    assert_int_equal(beamrate_check_count(check), 2);
    beamrate_check_case(check, 0, &c);
    assert_int_equal(c.verdict, BEAMRATE_PASS);
    assert_string_equal(c.measure, "v");
    CLOSE(c.tolerance, 0, 0);
    beamrate_check_free(check);
    ENDS(beamrate_orders_expect(&check, orders, "2", &failure), BEAMRATE_BAD_INPUT,
         "2 columns may be meant");
    ENDS(beamrate_orders_expect(&check, orders, NULL, &failure), BEAMRATE_BAD_INPUT, "found NULL");
    const struct beamrate_expectation expected = {BEAMRATE_SPACE, 2, 0.1, 0};
    ENDS(beamrate_orders_check_quantity(&check, orders, 2, &expected, 1, &failure),
         BEAMRATE_BAD_INPUT, "quantity: found 2, expected less than 2");
    WORKS(beamrate_orders_check_quantity(&check, orders, 1, &expected, 1, &failure));
    beamrate_orders_free(orders); /* verdicts outlive their orders, names and all */
    beamrate_check_case(check, 0, &c);
    assert_string_equal(c.measure, "v");
    assert_int_equal(c.verdict, BEAMRATE_FAIL);
    beamrate_check_free(check);
    static const struct {
        struct beamrate_table table;
        const char *message;
    } refused[] = {
        {{.text = NULL}, "table: found NULL"},
        {{.text = "h,e\n4,1\n2,1\n1,-1\n"}, "table:4: e: found -1"},
        {{.text = "h,e\n4,1\n2,1\n1,1\n", .name = "a.csv", .errors = "f"},
         "a.csv: --error: there is"},
        {{.text = two_columns, .dimension = NAN}, "table: found dimension nan"},
        {{.text = two_columns, .dimension = INFINITY}, "table: found dimension inf"},
        {{.text = two_columns, .dimension = 2.5}, "table: found dimension 2.5, expected a whole"},
        {{.text = two_columns, .dimension = 17}, "table: found dimension 17"},
        {{.text = two_columns, .formal = -1}, "formal order is -1"},
    };
    for (size_t i = 0; i < sizeof refused / sizeof *refused; i++) {
        ENDS(beamrate_orders_read(&orders, &refused[i].table, &failure), BEAMRATE_BAD_INPUT,
             refused[i].message);
        assert_null(orders);
    }
    ENDS(beamrate_orders_read(&orders, NULL, &failure), BEAMRATE_BAD_INPUT, "table: found NULL");
}

/* The dimension of a mesh, and that it was assumed. */
TEST(a_trade_of_tables)
{
    static const struct beamrate_table tables[] = {
        {.name = "low.csv", .text = "n,l2,seconds\n8,1e-2,1\n16,2.5e-3,4\n32,6.25e-4,16\n"},
        {.name = "high.csv", .text = "n,l2,seconds\n8,1e-3,9\n16,1e-4,50\n32,1e-5,300\n"},
        {.name = "other.csv", .text = "n,h1,seconds\n8,1e-3,9\n16,1e-4,50\n32,1e-5,300\n"}};
    struct beamrate_trade *trade, *none;
    const char *json;
    assert_int_equal(beamrate_trade_read(&trade, tables, 2, NULL, &failure), BEAMRATE_OK);
    assert_int_equal(beamrate_trade_report(trade, &json, &failure), BEAMRATE_OK);
    assert_non_null(strstr(json, "Cheapest to 1e-2: low, n = 8, 1 s; next: high, 9 s."));
    ENDS(beamrate_trade_report(trade, NULL, &failure), BEAMRATE_BAD_INPUT,
         "found no trade or NULL");
    ENDS(beamrate_trade_report(NULL, &json, &failure), BEAMRATE_BAD_INPUT,
         "found no trade or NULL");
    assert_null(json);
    ENDS(beamrate_trade_read(&none, tables, 3, NULL, &failure), BEAMRATE_BAD_INPUT,
         "low measures l2; high measures l2; other measures h1");
    assert_null(none);
    ENDS(beamrate_trade_read(&none, tables, 2, "flops", &failure), BEAMRATE_BAD_INPUT,
         "found no cost 'flops'");
    ENDS(beamrate_trade_read(&none, NULL, 2, NULL, &failure), BEAMRATE_BAD_INPUT, "found none");
    ENDS(beamrate_trade_read(NULL, tables, 2, NULL, &failure), BEAMRATE_BAD_INPUT,
         "place for a handle");
    beamrate_trade_free(trade);
    beamrate_trade_free(NULL);
}

TEST(dimensions_of_a_table)
{
    static const char text[] = "dofs,e\n1,64\n64,4\n4096,0.25\n262144,0.015625\n";
    const struct beamrate_expectation expected = {BEAMRATE_SPACE, 2, 0.1, 0};
    struct beamrate_check *check;
    for (int dimension = 0; dimension < 4; dimension++) {
        const struct beamrate_table table = {.text = text, .dimension = dimension};
        struct beamrate_orders *orders;
        struct beamrate_answer answer;
        const char *json;
        WORKS(beamrate_orders_read(&orders, &table, &failure));
        WORKS(beamrate_orders_report(orders, &json, &failure));
        beamrate_orders_answer(orders, 0, BEAMRATE_SPACE, &answer);
        CLOSE(answer.order.value, 2 * (dimension ? dimension : 2) / 3., 1e-6);
        assert_int_equal(!!strstr(json, "assumed"), !dimension);
        assert_int_equal(!!strstr(answer.open, "dimension"), !dimension);
        if (dimension)
            WORKS(beamrate_orders_check(&check, orders, &expected, 1, &failure));
        else
            ENDS(beamrate_orders_check(&check, orders, &expected, 1, &failure), BEAMRATE_BAD_INPUT,
                 "state the dimension of the mesh");
        beamrate_check_free(check);
        beamrate_orders_free(orders);
    }
}

/* Numbers at a floor are left out of the fit, and counted. */
TEST(used_numbers_are_counted)
{
    static const double h[] = {256, 128, 64, 32, 16, 8, 4, 2},
                        error[] = {65536, 16384, 4096, 1024, 256, 64, 10, 10};
    const struct beamrate_numbers numbers = {.h = h, .number = error, .count = 8};
    const struct beamrate_expectation expected = {BEAMRATE_SPACE, 2, 0.5, 10};
    struct beamrate_orders *orders;
    struct beamrate_order order;
    struct beamrate_check *check;
    struct beamrate_case c;
    WORKS(beamrate_orders_find(&orders, &numbers, &failure));
    assert_int_equal(beamrate_orders_line(orders, BEAMRATE_SPACE, &order), 1);
    assert_int_equal(order.points, 8);
    assert_int_equal(order.used, 6);
    CLOSE(order.constant, 1, 0.01); /* of the observed order, whose interval the floor widens */
    WORKS(beamrate_orders_check(&check, orders, &expected, 1, &failure));
    WORKS(beamrate_check_case(check, 0, &c));
    assert_int_equal(c.points, order.points);
    assert_int_equal(c.used, 6);
    CLOSE(c.constant, 1, 1e-6);
    assert_true(*c.note);
    beamrate_check_free(check);
    beamrate_orders_free(orders);
}

/* Values of order 3: their limit, which does not depend on what theory says. */
TEST(limit_of_values)
{
    static const double h[] = {16, 8, 4, 2, 1}, formal[] = {2, 4, 0};
    static const double value[] = {7 + 4096.1, 7 + 511.9, 7 + 64.1, 7 + 7.9, 7 + 1};
    for (size_t i = 0; i < 3; i++) {
        const struct beamrate_numbers numbers = {
            .h = h, .number = value, .count = 5, .values = 1, .formal = formal[i]};
        struct beamrate_orders *orders;
        struct beamrate_order order;
        WORKS(beamrate_orders_find(&orders, &numbers, &failure));
        assert_int_equal(beamrate_orders_line(orders, BEAMRATE_SPACE, &order), 1);
        CLOSE(order.limit.value, 7, 0.2);
        assert_true(order.limit.low <= 7 && 7 <= order.limit.high);
        beamrate_orders_free(orders);
    }
    const struct beamrate_numbers wrong = {
        .h = h, .number = value, .count = 5, .values = 1, .formal = 0.5};
    struct beamrate_orders *none;
    ENDS(beamrate_orders_find(&none, &wrong, &failure), BEAMRATE_BAD_INPUT, "formal order is 0.5");
}

/* ---- what is no handle, no index, no number ---- */

static const double sizes[] = {4, 2, 1}, errors[] = {16, 4, 1};
static const struct beamrate_numbers three = {.h = sizes, .number = errors, .count = 3};
static const struct beamrate_expectation second = {BEAMRATE_SPACE, 2, 0.1, 0};

/* What has no message fills with zeros, NaN and "". */
static void results_are_refused(void *orders, void *check)
{
    struct beamrate_fit fit;
    struct beamrate_order order;
    struct beamrate_answer answer;
    struct beamrate_order_point point;
    struct beamrate_case c;
    assert_int_equal(beamrate_orders_line(orders, BEAMRATE_SPACE, &order), 0);
    assert_true(isnan(order.order.value));
    assert_int_equal(beamrate_orders_answer(orders, 0, BEAMRATE_SPACE, &answer), 0);
    assert_int_equal(beamrate_orders_point(orders, 0, BEAMRATE_SPACE, 0, &point), 0);
    assert_true(isnan(answer.order.value) && isnan(point.size) && !*point.left_out);
    assert_int_equal(beamrate_orders_fit(orders, &fit), BEAMRATE_BAD_INPUT);
    assert_true(isnan(fit.p.value));
    assert_int_equal(beamrate_check_case(check, 0, &c), BEAMRATE_BAD_INPUT);
    assert_int_equal(c.verdict, BEAMRATE_FAIL);
    assert_int_equal(beamrate_check_count(check), 0);
}

TEST(wrong_handles_are_refused)
{
    struct beamrate_orders *orders, *none;
    struct beamrate_check *check, *made;
    struct beamrate_case c;
    const char *json;
    WORKS(beamrate_orders_find(&orders, &three, &failure));
    WORKS(beamrate_orders_check(&check, orders, &second, 1, &failure));
    for (int other = 0; other < 2; other++) { /* NULL, or the other handle */
        void *const no_orders = other ? check : NULL, *const no_check = other ? orders : NULL;
        results_are_refused(no_orders, no_check);
        ENDS(beamrate_orders_check(&made, no_orders, &second, 1, &failure), BEAMRATE_BAD_INPUT,
             other ? "orders: found something else, expected a handle of kind 'orders'"
                   : "orders: found NULL");
        assert_null(made);
        ENDS(beamrate_orders_report(no_orders, &json, &failure), BEAMRATE_BAD_INPUT,
             "orders: found");
        assert_null(json);
        beamrate_orders_free(no_orders); /* nothing */
        beamrate_check_free(no_check);
    }
    assert_int_equal(beamrate_check_case(check, 0, &c), BEAMRATE_OK); /* all are as they were */
    WORKS(beamrate_orders_report(orders, &json, &failure));
    assert_int_equal(beamrate_check_case(check, 1, &c), BEAMRATE_BAD_INPUT);
    assert_int_equal(beamrate_check_case(check, 0, NULL), BEAMRATE_BAD_INPUT);
    ENDS(beamrate_orders_find(NULL, &three, &failure), BEAMRATE_BAD_INPUT, "place for a handle");
    ENDS(beamrate_orders_find(&none, NULL, &failure), BEAMRATE_BAD_INPUT, "numbers: found NULL");
    assert_null(none);
    assert_int_equal(beamrate_orders_find(&none, NULL, NULL), BEAMRATE_BAD_INPUT);
    beamrate_check_free(check);
    beamrate_orders_free(orders);
}

TEST(wrong_indices_are_refused)
{
    struct beamrate_orders *orders;
    struct beamrate_check *check;
    struct beamrate_order order;
    struct beamrate_answer answer;
    struct beamrate_order_point point;
    struct beamrate_expectation expected = second;
    struct beamrate_numbers numbers = three;
    WORKS(beamrate_orders_find(&orders, &numbers, &failure));
    assert_int_equal(beamrate_orders_line(orders, (enum beamrate_axis)2, &order), 0);
    assert_int_equal(beamrate_orders_answer(orders, 0, (enum beamrate_axis)2, &answer), 0);
    assert_int_equal(beamrate_orders_answer(orders, 0, BEAMRATE_SPACE, NULL), 0);
    assert_int_equal(beamrate_orders_point(orders, SIZE_MAX, BEAMRATE_SPACE, 0, &point), 0);
    ENDS(beamrate_orders_report(orders, NULL, &failure), BEAMRATE_BAD_INPUT, "json: found NULL");
    expected.axis = (enum beamrate_axis) - 1;
    ENDS(beamrate_orders_check(&check, orders, &expected, 1, &failure), BEAMRATE_BAD_INPUT,
         "expectation 0: axis: found -1");
    ENDS(beamrate_orders_check(&check, orders, &expected, 0, &failure), BEAMRATE_BAD_INPUT,
         "expectations: found none");
    beamrate_orders_free(orders);
    numbers.formal = NAN;
    ENDS(beamrate_orders_find(&orders, &numbers, &failure), BEAMRATE_BAD_INPUT,
         "formal order is nan");
    numbers.formal = -1;
    ENDS(beamrate_orders_find(&orders, &numbers, &failure), BEAMRATE_BAD_INPUT,
         "formal order is -1");
}

/* ---- threads and memory ---- */

static void fatal(const char *reason, const char *file, int line, int number)
{
    fail_msg("%s (%s:%d, %d)", reason, file, line, number);
}

/* What a thread does, often: orders of a table of its own, which gets a verdict and the report
 * shows, and a table that is refused. */
struct job {
    double order; /* of its errors */
    struct beamrate_estimate found;
    struct beamrate_case verdict;
    struct beamrate_error refusal;
    char answer[100];
    int ended; /* calls that ended well */
};

enum { OFTEN = 20 };

static void *find_often(void *self)
{
    struct job *job = self;
    char text[400] = "h,e\n";
    for (int i = 0; i < 5; i++)
        snprintf(strchr(text, 0), 60, "%.17g,%.17g\n", ldexp(1, -i), exp2(-job->order * i));
    const struct beamrate_table table = {.text = text}, wrong = {.text = "h,e\n1,2\n"};
    const struct beamrate_expectation expected = {BEAMRATE_SPACE, job->order, 0.1, 0};
    for (int turn = 0; turn < OFTEN; turn++) {
        struct beamrate_orders *orders;
        struct beamrate_check *check;
        struct beamrate_answer answer;
        const char *json;
        if (beamrate_orders_read(&orders, &table, NULL))
            return NULL;
        const bool ended = !beamrate_orders_check(&check, orders, &expected, 1, NULL) &&
                           !beamrate_check_case(check, 0, &job->verdict) &&
                           beamrate_orders_answer(orders, 0, BEAMRATE_SPACE, &answer) == 1 &&
                           !beamrate_orders_report(orders, &json, NULL);
        if (ended) {
            job->ended++;
            job->found = answer.order;
            snprintf(job->answer, sizeof job->answer, "%s", strstr(json, "\"answer\""));
        }
        beamrate_check_free(check);
        beamrate_orders_free(orders);
        beamrate_orders_read(&orders, &wrong, &job->refusal);
    }
    return NULL;
}

static void same_job(const struct job *a, const struct job *b)
{
    assert_int_equal(a->ended, OFTEN);
    assert_int_equal(b->ended, OFTEN);
    CLOSE(a->found.value, a->order, 1e-4);
    assert_memory_equal(&a->found, &b->found, sizeof a->found);
    assert_int_equal(a->verdict.verdict, BEAMRATE_PASS);
    assert_memory_equal(&a->verdict.order, &b->verdict.order, sizeof a->verdict.order);
    assert_string_equal(a->answer, b->answer);
    assert_int_equal(a->refusal.status, BEAMRATE_BAD_INPUT);
    assert_string_equal(a->refusal.message, b->refusal.message);
}

TEST(threads_do_not_disturb_each_other)
{
    struct job alone[4], together[4];
    pthread_t thread[4];
    gsl_error_handler_t *const handler = gsl_set_error_handler(fatal);
    for (int i = 0; i < 4; i++)
        alone[i] = together[i] = (struct job){.order = 1 + i};
    for (int i = 0; i < 4; i++)
        find_often(&alone[i]);
    for (int i = 0; i < 4; i++)
        assert_int_equal(pthread_create(&thread[i], NULL, find_often, &together[i]), 0);
    for (int i = 0; i < 4; i++)
        assert_int_equal(pthread_join(thread[i], NULL), 0);
    assert_true(gsl_set_error_handler(handler) == fatal);
    for (int i = 0; i < 4; i++)
        same_job(&alone[i], &together[i]);
}

/* Within a call numbers are those of the locale C, and GSL returns its errors; afterwards the
 * caller has its own locale and handler again. */
TEST(callers_keep_their_handler_and_locale)
{
    const locale_t mine = newlocale(LC_ALL_MASK, "C.UTF-8", (locale_t)0);
    assert_true(mine != (locale_t)0);
    struct beamrate_orders *orders;
    const locale_t before = uselocale(mine);
    gsl_error_handler_t *const handler = gsl_set_error_handler(fatal);
    WORKS(beamrate_orders_find(&orders, &three, &failure));
    ENDS(beamrate_orders_find(NULL, &three, &failure), BEAMRATE_BAD_INPUT, "");
    assert_true(uselocale(before) == mine);
    assert_true(gsl_set_error_handler(handler) == fatal);
    freelocale(mine);
    beamrate_orders_free(orders);
}

/* Everything once. */
static enum br_status use_all(const void *text, struct br_error *why)
{
    struct beamrate_error *e = &failure;
    struct beamrate_check *check = NULL;
    struct beamrate_orders *orders = NULL, *read = NULL;
    const char *json;
    const struct beamrate_table table = {.text = text};
    if (!beamrate_orders_find(&orders, &three, e) &&
        !beamrate_orders_check(&check, orders, &second, 1, e) &&
        !beamrate_orders_read(&read, &table, e))
        beamrate_orders_report(read, &json, e);
    beamrate_check_free(check);
    beamrate_orders_free(orders);
    beamrate_orders_free(read);
    if (e->status == BEAMRATE_OK)
        return BR_OK;
    return br_fail(why, e->status == BEAMRATE_NO_MEMORY ? BR_NO_MEMORY : BR_VERDICT, "%s",
                   e->message);
}

TEST(memory_may_end_at_any_place)
{
    br_test_without_memory(use_all, two_columns, 60);
}
