/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is expected of orders, as it is written, and verdicts on it. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/words.h"
#include "made_tables.h"

static void refuse_expectation(const char *text, const char *message)
{
    FREED struct br_order_expectation *e = NULL;
    size_t count = 0;
    REFUSED(br_expectations_read(text, 0, &e, &count, &err), BR_BAD_INPUT, message);
}

TEST(test_grammar)
{
    struct br_order_expectation *e = NULL;
    size_t count = 0;
    MUST(br_expectations_read(" l2 : h 2 +- 0.1, k 1\u00b1.05 down to 1e-9;\n drag x:k1+-.2 ", 0,
                              &e, &count, &err));
    assert_int_equal(count, 3);
    assert_string_equal(e[0].quantity, "l2");
    assert_int_equal(e[0].axis, BR_AXIS_SPACE);
    CLOSE(e[0].band.order, 2, 0);
    CLOSE(e[0].band.tolerance, 0.1, 0);
    CLOSE(e[0].band.down_to, 0, 0);
    assert_string_equal(e[1].quantity, "l2");
    assert_int_equal(e[1].axis, BR_AXIS_TIME);
    CLOSE(e[1].band.tolerance, 0.05, 0);
    CLOSE(e[1].band.down_to, 1e-9, 0);
    assert_string_equal(e[2].quantity, "drag x");
    assert_int_equal(e[2].axis, BR_AXIS_TIME);
    free(e);
    e = NULL; /* names that begin alike are two */
    count = 0;
    MUST(br_expectations_read("l2: h 2 +- .1; l2v: h 1 +- .1; l: h 1 +- .1", 0, &e, &count, &err));
    assert_int_equal(count, 3);
    free(e);
    refuse_expectation("", "expected an order, as in 'l2: h 2 +- 0.1'");
    refuse_expectation("l2", "found 'l2', expected an error's name and ':'");
    refuse_expectation(": h 2 +- .1", "expected an error's name");
    refuse_expectation("l2: x 2 +- .1", "found 'x 2 +- .1', expected an order above 0");
    refuse_expectation("l2: h -2 +- .1", "expected an order above 0");
    refuse_expectation("l2: h nan +- .1", "found 'nan +- .1', expected an order above 0");
    refuse_expectation("l2 = 2; h1; x = 2", "found 'h1; x = 2', expected an error's name");
    refuse_expectation("l2 = two", "found 'two', expected an order above 0");
    refuse_expectation("l2: h 2 +- 0", "expected a tolerance above 0 and below the order");
    refuse_expectation("l2: h 2 +- 2", "expected a tolerance above 0 and below the order");
    refuse_expectation("l2: h 4 to 2 +- .1", "expected an order above the first");
    refuse_expectation("l2: h 2 +- .1 down to 0", "expected an error above 0");
    refuse_expectation("l2: h 2 +- .1 more", "found 'more', expected ',' or ';' or the end");
    refuse_expectation("l2: h 2 +- .1,", "found '', expected an order above 0");
    refuse_expectation("l2: h 2 +- .1, k two", "found 'two', expected an order above 0");
    refuse_expectation("l2: h <= 2", "errors that do not fall have an order below any limit");
    refuse_expectation("l2: h >= 0", "expected an order above 0");
    refuse_expectation("l2: h >= 1.8 +- .1",
                       "found '+- .1', expected nothing: a least order has no tolerance");
    refuse_expectation("l2 >= 1.8 \u00b1 .1", "a least order has no tolerance");
    refuse_expectation(">= 1.8 +- .1", "a least order has no tolerance");
    refuse_expectation("l2: h exponential >= 1", "expected a factor above 1");
    refuse_expectation("l2: h >= 1.8, at most 3", "it belongs to one order");
    refuse_expectation("l2: h 2, constant 3 to 2",
                       "expected a constant above 0, and above the first");
    refuse_expectation("l2: h 2 +- .1, h 1 +- .1", "the order of l2 in h is given twice");
    refuse_expectation("2, >= 1", "the order of the errors is given twice");
    refuse_expectation("0123456789012345678901234567890123456789012345678901234567890123: h 2 +- 1",
                       "expected a name of at most 63 bytes");
}

/* Each text is read as another one says, in full. */
TEST(test_short_grammar)
{
    static const char *const rows[][2] = {
        {"2", " - 2 +- 0.2"},
        {"h 2", " h 2 +- 0.2"},
        {">= 1.8", " - >= 1.8"},
        {"k \u2265 1.8", " k >= 1.8"},
        {"at least 1.8", " - >= 1.8"},
        {"L2=2", "L2 - 2 +- 0.2"},
        {"L2 = 2 ; H1 = h 1", "L2 - 2 +- 0.2;H1 h 1 +- 0.1"},
        {"L2 >= 1.8, k 1", "L2 - >= 1.8;L2 k 1 +- 0.1"},
        {"L2=2, H1: h 1 +- .2; x >= 3", "L2 - 2 +- 0.2;H1 h 1 +- 0.2;x - >= 3"},
        {"l2: h 2 to 4 +- .2, constant 2 to 3", "l2 h 2 to 4 +- 0.2, 2 to 3"},
        {"l2: 2, at most 3, k >= 1", "l2 - 2 +- 0.2, nan to 3;l2 k >= 1"},
        {"l2: exponential >= 8", "l2 - exponential >= 8"},
        {"e [m = P1]: h 2; e [k = 2] >= 1; a>b: 3",
         "e [m = P1] h 2 +- 0.2;e [k = 2] - >= 1;a>b - 3 +- 0.3"},
        {"\"a: h 2\" = 3", "a: h 2 - 3 +- 0.3"},
        {"2: h 1", "2 h 1 +- 0.1"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        FREED struct br_order_expectation *e = NULL;
        size_t count = 0;
        char text[1024] = "", band[BR_EXPECTATION_TEXT];
        MUST(br_expectations_read(rows[i][0], 0, &e, &count, &err));
        for (size_t j = 0; j < count; j++) {
            br_append(text, sizeof text, "%s%s %s %s", j ? ";" : "", e[j].quantity,
                      e[j].axis == BR_AXES ? "-" : br_axis_letters[e[j].axis],
                      br_expectation_text(&e[j].band, band));
            if (!isnan(e[j].band.ceiling))
                br_append(text, sizeof text, ", %g to %g", e[j].band.floor, e[j].band.ceiling);
        }
        assert_string_equal(text, rows[i][1]);
    }
}

/* ---- verdicts ---- */

/* An error that is just where the errors are expected to stop stops there. */
TEST(test_down_to)
{
    static const char table[] = "n,l2\n10,1e-2\n20,2.5e-3\n40,6.25e-4\n80,1.5625e-4\n160,1e-4\n";
    char why[768];
    assert_int_equal(verdict_of(table, NULL, "l2: h 2 +- 0.1 down to 1e-4", why), BR_PASS);
    assert_int_not_equal(verdict_of(table, NULL, "l2: h 2 +- 0.1 down to 0.99e-4", why), BR_PASS);
}

/* Rates from 1.9997 to 2.0000 are no reason to refine where 3 is expected. */
TEST(test_advice)
{
    static const char table[] = "n,l2\n10,3.6960e-3\n20,9.2422e-4\n40,2.3107e-4\n80,5.7767e-5\n";
    char why[768];
    assert_int_equal(verdict_of(table, NULL, "l2: h 3 +- 0.1", why), BR_FAIL);
    if (!strstr(why, "finer grids do not help: the two finest show 2.00"))
        fail_msg("%s", why);
    static const char digits[] = "n,l2\n4,.0613\n8,.0154\n16,.00387\n32,.000966\n64,.000243\n";
    assert_int_equal(verdict_of(digits, NULL, "l2: h 2 +- 0.005", why), BR_INCONCLUSIVE);
    if (!strstr(why, "Take a tolerance of 0.01, or give errors with more digits") ||
        strstr(why, "add a row"))
        fail_msg("%s", why);
    static const struct {
        const char *table, *values, *expect, *says;
    } rows[] = {
        {"dt,e\n.1,.2\n.05,.05\n.025,.0125\n.0125,30\n.00625,1e8\n", NULL, "e: k 2 +- 0.1",
         "the errors fall, but from dt = 0.025 on they grow, to 1.00e+08: a scheme that is not"},
        {"dt,e\n.1,1e9\n.05,3e4\n.025,.0125\n.0125,.0034\n.00625,.00078\n", NULL, "e: k 2 +- 0.1",
         "the coarse ones are beyond a limit of stability"},
        {"n,e\n8,.1\n16,.04\n32,.022\n64,.04\n128,.003\n", NULL, "e: h 2 +- 0.1",
         "the errors rise and fall: converge each run further"},
        {"n,e\n8,.1\n16,.025\n32,.00625\n64,.0015625\n128,.001\n", NULL, "2",
         "expect the order 'down to 4e-03', and add 1 coarser than n = 8"},
        {"n,e\n8,.1\n16,.025\n32,.00625\n64,.0015625\n128,.0004\n", NULL, "2 down to 7e-3",
         "add a row coarser than n = 8"},
        {"n,e\n8,1.31\n16,.92\n32,1.22\n64,.85\n128,1.3\n", "e", "e: h 2 +- 0.1",
         "the differences rise and fall: converge each run further"},
        {"n,e\n8,1\n16,1.1\n32,1.3\n64,1.7\n128,2.5\n", "e", "e: h 2 +- 0.1",
         "the differences grow with each finer size: there is no convergence"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        assert_int_not_equal(verdict_of(rows[i].table, rows[i].values, rows[i].expect, why),
                             BR_PASS);
        if (!strstr(why, rows[i].says))
            fail_msg("%zu: %s", i, why);
    }
}

TEST(test_verdicts)
{
    enum { REFUSED_ONE = -1 };
    static const char near_floor[] = "h,l2\n1,1\n.5,.25\n.25,.0625\n.125,.015625\n.0625,.0039\n"
                                     ".03125,.0039\n.015625,.0039\n";
    static const char few[] = "h,l2\n1,1\n.5,.25\n.25,.06\n",
                      gap[] = "h,l2\n1,1\n.5,.25\n.25,\n.125,.015625\n.0625,.00390625\n",
                      gaps[] = "h,l2\n1,1\n.5,.25\n.25,\n.125,.015625\n.0625,-\n",
                      drag[] = "h,u\n1,4\n.5,2\n.25,1.5\n.125,1.375\n.0625,1.34375\n";
    static const char spectral[] = "n,l2\n2,.01562\n3,.001953\n4,2.441e-4\n5,3.052e-5\n"
                                   "6,3.815e-6\n7,4.768e-7\n";
    /* against a reference of a size near the finest */
    static const char rises[] = "h,l2\n.1,1\n.05,.57196\n.025,.26775\n.0125,.093036\n";
    static const char digits[] = "n,l2\n4,.0613\n8,.0154\n16,.00387\n32,.000966\n64,.000243\n",
                      stays[] = "h,L2,H1\n1,4,.5\n.5,1,.5\n.25,.25,.5\n.125,.0625,.5\n",
                      two[] = "h,Eh,eH\n1,4,4\n.5,1,1\n.25,.25,.25\n.125,.0625,.0625\n";
    static const char cases[] = "m,n,l2\nA,1,1\nA,2,.25\nA,4,.0625\nA,8,.015625\nB,1,1\nB,2,.5\n"
                                "B,4,.25\nB,8,.125\nB,16,.0625\n";
    /* the run of the finest size failed */
    static const char lost[] = "h,l2\n4,16\n2,4\n1,1\n.5,.25\n.25,.0625\n.125,.015625\n.0625,inf\n";
    static const char failed[] = "n,l2\n4,16\n8,4\n16,1\n32,.25\n64,.0625\n# 128 failed\n";
    static const char repeats[] =
        "n,run,l2\n4,1,16\n4,2,16.1\n8,1,4\n8,2,4.1\n16,1,1\n16,2,1.01\n"
        "32,1,.25\n32,2,.251\n64,1,.0625\n64,2,.0626\n128,1,.0156\n128,2,nan\n";
    char line[1024], grid[4096], floor[4096], blown[4096];
    strcpy(line, table_of(5, 0, 2, 0));
    strcpy(grid, table_of(5, 5, 2, 1));
    strcpy(blown, grid);
    strcpy(strrchr(blown, ',') + 1, "nan\n");
    strcpy(floor, floor_table(12, pow(4, -7)));
    const struct {
        const char *table, *values, *expected;
        int verdict;
        const char *why;
    } rows[] = {
        {line, NULL, "l2: h 2 +- 0.1", BR_PASS, ""},
        {line, NULL, "l2: h 3 +- 0.1", BR_FAIL, ""},
        {grid, NULL, "l2: h 2 +- 0.1, k 1 +- 0.1", BR_PASS, ""},
        {grid, NULL, "l2: k 2 +- 0.1", BR_FAIL, ""},
        {grid, NULL, "l2: h 1 +- 0.1", BR_FAIL, ""},
        {few, NULL, "l2: h 2 +- 0.1", BR_INCONCLUSIVE, "has 3 errors, expected at least 4"},
        {few, "l2", "l2: h 2 +- 0.1", BR_INCONCLUSIVE,
         "3 values have 2 differences; a verdict needs 5 sizes; add a row finer than all others"},
        {gap, NULL, "l2: h 2 +- 0.1", BR_PASS, ""},
        {gap, NULL, "l2: h 3 +- 0.1", BR_FAIL, ""},
        {gaps, NULL, "l2: h 2 +- 0.1", BR_INCONCLUSIVE,
         "3 of 5 errors can be used, an order needs 4"},
        {lost, NULL, ">= 1.8", BR_INCONCLUSIVE, "the finest row, h = 0.0625, has no number"},
        {lost, NULL, "2.5 +- 0.1", BR_FAIL, ""},
        {repeats, NULL, "2", BR_INCONCLUSIVE, "the finest row, n = 128, has no number"},
        {failed, NULL, "2", BR_INCONCLUSIVE, "the finest row, n = 128, has no number"},
        {cases, NULL, "l2 [m = A] = 2", BR_PASS, ""}, /* it has no row n = 16 */
        {lost, "l2", "2", BR_INCONCLUSIVE, "h = 0.0625, has no number; without it the others"},
        {blown, NULL, "h 2", BR_INCONCLUSIVE, "the finest row, h = 0.03125, k = 0.03125, has no"},
        {blown, NULL, "k 1", BR_INCONCLUSIVE, "the finest row, h = 0.03125, k = 0.03125, has no"},
        {floor, NULL, "l2: h 2 +- 0.1", BR_INCONCLUSIVE, "the errors do not fall"},
        {floor, NULL, "l2: h 2 +- 0.1 down to 1e-3", BR_PASS, ""},
        {floor, NULL, "l2: h 3 +- 0.1 down to 1e-3", BR_FAIL, ""},
        {near_floor, NULL, "l2: h 2 +- 0.1 down to .004", BR_PASS, ""},
        {spectral, NULL, "l2: h exponential 8 +- 0.5", BR_PASS, ""},
        {spectral, NULL, "l2: h exponential 9 +- 0.5", BR_FAIL, "one more of 1/h divides"},
        {spectral, NULL, "l2: h 4 +- 0.5", BR_FAIL, "the errors fall exponentially, by no order"},
        {line, NULL, "l2: h exponential 8 +- 0.5", BR_FAIL, "their order is 2.00"},
        {rises, NULL, "l2: h 1 +- 0.1", BR_INCONCLUSIVE, "may fall exponentially, with a"},
        {rises, NULL, "exponential >= 1.01", BR_INCONCLUSIVE, "exponentially, with a probability"},
        {drag, "u", "u: h 2 +- 0.1", BR_PASS, ""},
        {line, NULL, "2", BR_PASS, ""},
        {line, NULL, "L2 = 2", BR_PASS, ""},
        {line, NULL, ">= 1.8", BR_PASS, ""},
        {line, NULL, "l2: h >= 2.1", BR_FAIL, "lies below the band, at least 2.1"},
        {line, NULL, "l2: h 2, at most 2.9", BR_FAIL, "the constant, 3, is above its upper limit"},
        {line, NULL, "l2: h 2, constant 2.9 to 3.1", BR_PASS, ""},
        {digits, NULL, "l2: h >= 2", BR_INCONCLUSIVE, "contains the band's lower end, 2"},
        {spectral, NULL, "exponential >= 7.5", BR_PASS, ""},
        {spectral, NULL, "exponential >= 9", BR_FAIL, "expected at least 9"},
        {grid, NULL, "k >= 0.9", BR_PASS, ""},
        {grid, NULL, "2", REFUSED_ONE, "h and k are refined: expected one of the two"},
        {two, NULL, "2", REFUSED_ONE, "2 columns may be meant: expected the name of one"},
        {stays, NULL, "2", REFUSED_ONE, "two columns may be meant, of which H1 is left aside"},
        {stays, NULL, "l2: 2", BR_PASS, ""},
        {two, NULL, "Eh = 2; eH = 2", BR_PASS, ""},
        {two, NULL, "eh = 2", REFUSED_ONE,
         "an order of eh is expected, and 2 columns may be meant"},
        {line, NULL, "l3: h 2 +- .1", REFUSED_ONE,
         "t.csv: an order of 'l3' is expected, and there is no such column"},
        {line, NULL, "l2: k 2 +- .1", REFUSED_ONE,
         "t.csv: an order of l2 in k is expected, and there are no three sizes"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char why[768];
        const int verdict = verdict_of(rows[i].table, rows[i].values, rows[i].expected, why);
        if (verdict != rows[i].verdict || !strstr(why, rows[i].why))
            fail_msg("row %zu, %s: verdict %d, '%s'", i, rows[i].expected, verdict, why);
    }
}

/* Errors with noise, of any order and constant; the band does not hold the order. */
TEST(test_wrong_orders_never_pass)
{
    struct br_test_random random = {7};
    for (int i = 0; i < 300; i++) {
        char text[1024], expected[64], why[768];
        const double p = br_test_uniform(&random, 0.5, 4),
                     noise = br_test_log_uniform(&random, 1e-9, 1e-3);
        const double tolerance = br_test_uniform(&random, 0.05, 0.3);
        const double off = tolerance + br_test_uniform(&random, 0.01, 1);
        const double wrong =
            br_test_index(&random, 2) || p - off < tolerance + 0.05 ? p + off : p - off;
        size_t used = (size_t)snprintf(text, sizeof text, "n,l2\n");
        for (int row = 0; row < 4 + (int)br_test_index(&random, 5); row++)
            used += (size_t)snprintf(text + used, sizeof text - used, "%d,%.17g\n", 4 << row,
                                     5 * pow(4 << row, -p) *
                                         (1 + noise * br_test_uniform(&random, -1, 1)));
        snprintf(expected, sizeof expected, "l2: h %.17g +- %.17g", wrong, tolerance);
        if (verdict_of(text, NULL, expected, why) == BR_PASS)
            fail_msg("order %g passes as %s", p, expected);
    }
}
