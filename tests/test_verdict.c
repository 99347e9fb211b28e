/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Verdicts on errors that are made up, so that what they should be is known. */
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "checks.h"
#include "study/verify/check.h"

enum { MOST = 12 };

/* A case over time with the given errors at z = 1/100, 1/200, ...: expected 1 +- 0.1. */
struct made {
    struct br_case it;
    struct br_point point[MOST];
};

static void make(struct made *m, const double *error, size_t count)
{
    *m = (struct made){
        .it = {.kind = BR_VERIFY_JOINT,
               .expected = {1, 0.1, NAN, NAN, .line = 7},
               .measure = "l2",
               .part = "total",
               .unit = "m^(3/2)",
               .point = m->point,
               .points = count},
    };
    for (size_t i = 0; i < count; i++) {
        m->point[i] = (struct br_point){.at = {10u << i, 100u << i}, .error = error[i]};
        m->point[i].z = 1 / (double)m->point[i].at.steps;
        snprintf(m->point[i].label, sizeof m->point[i].label, "(n = %zu, k = T/%zu)",
                 m->point[i].at.n, m->point[i].at.steps);
    }
}

/* Errors C z^order. */
static void make_power(struct made *m, double order, size_t count)
{
    double error[MOST];
    for (size_t i = 0; i < count; i++)
        error[i] = 3 * pow(1 / (double)(100u << i), order);
    make(m, error, count);
}

static void find_verdict(struct br_case *c)
{
    MUST(br_case_observe(c, BR_VERIFY_LEAST_POINTS, &err));
    br_case_decide(c);
}

static void reach(struct made *m, enum br_verdict expected, const char *reason)
{
    find_verdict(&m->it);
    if (m->it.verdict != expected || !strstr(m->it.reason, reason))
        fail_msg("%s because '%s', expected %s because '%s'", br_verdict_names[m->it.verdict],
                 m->it.reason, br_verdict_names[expected], reason);
}

TEST(test_order)
{
    static const struct {
        double order;
        enum br_verdict verdict;
        const char *reason;
    } rows[] = {
        {1, BR_PASS, ""},
        {1.098, BR_PASS, ""},
        {0.902, BR_PASS, ""},
        {0.898, BR_FAIL, "lies below the band, 0.9 to 1.1"},
        {1.102, BR_FAIL, "lies above the band, 0.9 to 1.1"},
        {2, BR_FAIL, "lies above"},
        {60, BR_FAIL, "lies above"},
        {0.01, BR_FAIL, "lies below"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        struct made m;
        make_power(&m, rows[i].order, 5);
        reach(&m, rows[i].verdict, rows[i].reason);
        CLOSE(m.it.order.value, rows[i].order, 1e-5);
        AT_MOST(m.it.order.high - m.it.order.low, 2e-3);
        AT_MOST(5e-4, m.it.order.high - m.it.order.low); /* five rows leave that open */
        CLOSE(m.it.margin, 0.1 - fabs(rows[i].order - 1), 1e-3);
        assert_int_equal(m.it.used, 5);
    }
}

/* Where orders from 2 to 4 are expected, orders from size to size that fall from 4 to 2 pass, as of
 * A z^2 + B z^4. Those that rise, or lie below, do not. */
TEST(test_two_powers)
{
    static const struct {
        double rate[4];
        bool pass;
    } rows[] = {
        {{4, 4, 4, 4}, true},          {{2, 2, 2, 2}, true},          {{3.7, 3.1, 2.5, 2.1}, true},
        {{2.1, 2.5, 3.1, 3.7}, false}, {{3.7, 3.1, 2.5, 1.5}, false}, {{1, 1, 1, 1}, false},
        {{5, 5, 5, 5}, false},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        struct made m;
        make_power(&m, 1, 5);
        m.it.expected.order = 2;
        m.it.expected.highest = 4;
        for (size_t j = 1; j < 5; j++)
            m.point[j].error = m.point[j - 1].error * pow(2, -rows[i].rate[j - 1]);
        find_verdict(&m.it);
        if ((m.it.verdict == BR_PASS) != rows[i].pass)
            fail_msg("row %zu: %s because '%s'", i, br_verdict_names[m.it.verdict], m.it.reason);
        if (i == 2 && !strstr(m.it.note, "row to row, 3.70, 3.10, 2.50, 2.10, fall from 4 to 2"))
            fail_msg("row %zu: the note is '%s'", i, m.it.note);
    }
}

/* Errors against the next finer grid, with ratios that differ, tell the same order. */
TEST(test_differences)
{
    static const double parts[] = {10, 20, 60, 120, 480};
    struct made m;
    make_power(&m, 1, 4);
    m.it.kind = BR_VERIFY_SPACE;
    m.it.expected.order = 2;
    for (size_t i = 0; i < 4; i++) {
        m.point[i].z = 1 / parts[i];
        m.point[i].z_against = 1 / parts[i + 1];
        m.point[i].error = 5 * (pow(m.point[i].z, 2) - pow(m.point[i].z_against, 2));
    }
    reach(&m, BR_PASS, "");
    CLOSE(m.it.order.value, 2, 1e-6);
    CLOSE(m.it.constant, 5, 1e-12);
}

TEST(test_errors)
{
    static const struct {
        double error[5];
        enum br_verdict verdict;
        const char *reason;
    } rows[] = {
        /* towards order 1, about 1, and away from it */
        {{1e-2, 6.0e-3, 3.3e-3, 1.7e-3, 8.6e-4}, BR_INCONCLUSIVE, "are not asymptotic"},
        {{1e-2, 5.9e-3, 2.2e-3, 1.4e-3, 6.0e-4},
         BR_INCONCLUSIVE,
         "the interval is wider than the band"},
        {{1e-2, 5.0e-3, 2.6e-3, 1.5e-3, 1.0e-3},
         BR_INCONCLUSIVE,
         "the errors fall more slowly, 1.00e-03"},
        /* that do not fall */
        {{0, 0, 0, 0, 0}, BR_FAIL, ""},
        {{1e-3, 1e-3, 1e-3, 1e-3, 1e-3}, BR_FAIL, ""},
        {{1e-3, 2e-3, 4e-3, 8e-3, 16e-3}, BR_FAIL, ""},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        struct made m;
        make(&m, rows[i].error, 5);
        reach(&m, rows[i].verdict, rows[i].reason);
        if (strstr(m.it.reason, "the order's interval"))
            assert_true(m.it.margin < 0);
    }
}

/* Many coarse points neither outvote a stall at the end, nor hold back an order that is reached. */
TEST(test_many_points)
{
    struct made m;
    for (size_t count = 4; count <= MOST; count++) {
        make_power(&m, 1, count);
        for (size_t i = 0; i < count; i++) /* the last local order is 0.45 */
            m.point[i].error += 1.3 * m.point[count - 1].error;
        find_verdict(&m.it);
        assert_int_not_equal(m.it.verdict, BR_PASS);
    }
    make_power(&m, 1, 8);
    m.point[7].error *= 1.35; /* the last one only */
    reach(&m, BR_INCONCLUSIVE, "from (n = 1280, k = T/12800) on the errors fall more slowly");
    make_power(&m, 1, 10);
    for (size_t i = 0; i < 10; i++)
        m.point[i].error *= 1 + 100 * m.point[i].z; /* twice as large at first */
    reach(&m, BR_PASS, "");
    assert_int_equal(m.it.used, 10);
    m.point[9].flag = BR_FLAG_REFERENCE;
    reach(&m, BR_PASS, "");
    assert_int_equal(m.it.used, 9);
}

/* A finest error that is far too small shows terms that cancel, or a reference that is the solution
 * itself: the others do not make it pass. */
TEST(test_far_too_small)
{
    struct made m;
    make_power(&m, 1, 7);
    m.point[6].error /= 1000;
    reach(&m, BR_INCONCLUSIVE,
          "from (n = 640, k = T/6400) on the errors are far smaller than that");
    m.it.expected.down_to = m.point[6].error;
    m.point[6].flag = BR_FLAG_STALLED; /* as is expected */
    reach(&m, BR_PASS, "");
    make_power(&m, 1, 7);
    m.point[6].error *= 0.8;
    reach(&m, BR_INCONCLUSIVE, "from (n = 640, k = T/6400) on the errors are smaller than that");
    make_power(&m, 1, 7);
    m.point[6].error = 0;
    m.point[6].flag = BR_FLAG_ROUND_OFF; /* as zeros are */
    reach(&m, BR_INCONCLUSIVE,
          "from (n = 640, k = T/6400) on the errors are far smaller than that, 0.00e+00");
    m.it.expected.down_to = 1e-300;
    reach(&m, BR_PASS, "");
    m.it.expected.down_to = 0;
    m.point[6].rounding = 0.51 * m.point[5].error; /* what is below it is printed as zero */
    reach(&m, BR_PASS, "");
}

/* Takes the numbers out of a text. */
static void keep_words(char *text)
{
    char *to = text;
    for (const char *at = text; *at; at++)
        if (!strchr("0123456789.+-e", *at) ||
            (*at == 'e' && at > text && isalpha((unsigned char)at[-1])))
            *to++ = *at;
    *to = '\0';
}

/* No word depends on the unit of the errors. */
TEST(test_any_unit)
{
    static const double error[][8] = {
        {1, .5, .25, .126, .063, .05, .05, .05},
        {9, 4, .25, .125, .0625, .03125, 1e-7, 1e-7},
        {1, .52, .3, .2, .15, .125, .1125, .10625},
        {1, .5, .25, .125, .3, .031, .0156, .0078},
        {1, 2, 4, 8, 16, 32, 64, 128},
        {1, .5, .25, .125, .0625, .03125, .0156, 1e-6},
        {1, .5, .2, .1, .01, .016, .0178, .0172},
        {1, .9, 1.1, .95, 1, 1.02, .97, 1},
    };
    for (size_t l = 0; l < sizeof error / sizeof *error; l++) {
        struct made a, b;
        make(&a, error[l], 8);
        make(&b, error[l], 8);
        for (size_t i = 0; i < 8; i++)
            b.point[i].error *= 1e-9;
        find_verdict(&a.it);
        find_verdict(&b.it);
        assert_int_equal(a.it.verdict, b.it.verdict);
        assert_true(a.it.law == b.it.law);
        keep_words(a.it.reason), keep_words(b.it.reason);
        keep_words(a.it.note), keep_words(b.it.note);
        assert_string_equal(a.it.reason, b.it.reason);
        assert_string_equal(a.it.note, b.it.note);
        for (size_t i = 0; i < 8; i++)
            if (a.point[i].flag != b.point[i].flag)
                fail_msg("line %zu, error %zu: %s, and %s in another unit", l, i,
                         br_flag_name(a.point[i].flag), br_flag_name(b.point[i].flag));
    }
}

/* What would settle a verdict on a table is the row to add. */
TEST(test_sizes)
{
    static const double error[] = {1, .52, .271, .1435};
    struct made m;
    make(&m, error, 4);
    m.it.may_miss = true;
    reach(&m, BR_INCONCLUSIVE, "; add a row finer than (n = 80, k = T/800)");
    m.point[2].flag = m.point[3].flag = BR_FLAG_ROUND_OFF;
    reach(&m, BR_INCONCLUSIVE, "; add a row coarser than (n = 10, k = T/100)");
}

/* Of a least order the interval must lie above it; faster is right, and a constant is that of the
 * observed order. */
TEST(test_least_order)
{
    static const struct {
        double order, least;
        enum br_verdict verdict;
        const char *reason;
    } rows[] = {
        {1, 0.99, BR_PASS, ""},
        {3, 0.99, BR_PASS, ""},
        {1, 1.01, BR_FAIL, "lies below the band, at least 1.01"},
        {1, 1, BR_INCONCLUSIVE, "contains the band's lower end, 1; finer grids would decide"},
        {0.01, 1, BR_FAIL, "lies below the band, at least 1; finer grids do not help"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        struct made m;
        make_power(&m, rows[i].order, 5);
        m.it.expected.order = rows[i].least;
        m.it.expected.tolerance = 0;
        reach(&m, rows[i].verdict, rows[i].reason);
        CLOSE(m.it.margin, m.it.order.low - rows[i].least, 1e-15);
        CLOSE(m.it.constant, 3, 1e-3);
        assert_null(strstr(m.it.reason, "tolerance"));
    }
    static const double bad[][5] = {
        {1e-3, 1e-3, 1e-3, 1e-3, 1e-3}, {1, 2, 4, 8, 16}, {1, .5, .25, NAN, .0625}};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct made m;
        make(&m, bad[i], 5);
        m.it.expected.tolerance = 0;
        reach(&m, BR_FAIL, "");
    }
}

/* What the order does not say stands in the note. */
TEST(test_notes)
{
    static const struct {
        double error[6];
        const char *note;
    } rows[] = {
        {{.6610623, .1602090, .03838335, .009168145, .002230114, .0005493928},
         "the order from row to row still falls, the last is 2.02"},
        {{1.01, .51, .26, .135, .0725, .04125}, "the errors also show a floor"},
        {{9, 5e-1, 2.5e-1, 1.25e-1, 6.25e-2, 3.12e-2}, "(not asymptotic, error 9.0e+00)"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        struct made m;
        make(&m, rows[i].error, 6);
        find_verdict(&m.it);
        char note[BR_CASE_NOTE];
        if (!strstr(br_case_note(&m.it, note), rows[i].note))
            fail_msg("found '%s', expected '%s'", note, rows[i].note);
        assert_null(strstr(m.it.note, "also show")); /* a PASS says no law */
    }
}

/* Errors x + x^-2 fall, then grow, whatever is expected. */
TEST(test_turning)
{
    double error[6];
    struct made m;
    for (int i = 0; i < 6; i++)
        error[i] = ldexp(1, 3 - i) + ldexp(1, 2 * i - 6);
    make(&m, error, 6);
    reach(&m, BR_FAIL, "on they grow, to 1.62e+01");
    m.it.expected.order = 2;
    reach(&m, BR_FAIL, "on they grow");
    error[5] = 3; /* it does not grow by the same law */
    make(&m, error, 6);
    find_verdict(&m.it);
    assert_null(strstr(m.it.reason, "on they grow"));
}

/* Round-off scatters while it grows, above the coarsest error, too. */
TEST(test_round_off)
{
    static const double errors[][MOST] = {{2.454e-3, 6.134e-4, 1.533e-4, 3.825e-5, 1.014e-5,
                                           1.642e-6, 1.383e-6, 2.182e-5, 3.1e-5, 1.883e-4, 1.213e-3,
                                           2.951e-3},
                                          {6.634e-4, 1.659e-4, 4.146e-5, 1.037e-5, 2.591e-6,
                                           6.466e-7, 1.596e-7, 5.095e-8, 7.526e-8, 3.82e-7}};
    static const size_t rows[] = {12, 10};
    for (size_t i = 0; i < 2; i++) {
        struct made m;
        make(&m, errors[i], rows[i]);
        m.it.expected.order = 2;
        reach(&m, BR_INCONCLUSIVE, "");
    }
}

/* What is advised would do. */
TEST(test_advice)
{
    static const double error[] = {1, .52, .271, .1435};
    struct made m;
    make(&m, error, 4);
    reach(&m, BR_INCONCLUSIVE, "a tolerance of 0.11 would include it");
    m.it.expected.tolerance = 0.11;
    reach(&m, BR_PASS, "");
}

/* What is not a number fails, wherever it stands and whatever else is well. */
TEST(test_not_a_number)
{
    static const double bad[] = {NAN, INFINITY, -INFINITY, -1e-3};
    for (size_t b = 0; b < sizeof bad / sizeof *bad; b++)
        for (size_t i = 0; i < 5; i++)
            for (int flag = BR_FLAG_NONE; flag <= BR_FLAG_UNSTABLE; flag++) {
                struct made m;
                make_power(&m, 1, 5);
                m.point[i].error = bad[b];
                m.point[i].flag = (enum br_flag)flag;
                reach(&m, BR_FAIL, "the error is not a number");
            }
    struct made m;
    make_power(&m, 1, 5);
    snprintf(m.point[2].failure, sizeof m.point[2].failure, "it blew up");
    reach(&m, BR_FAIL, "at (n = 40, k = T/400) it blew up");
    make_power(&m, 1, 5);
    m.point[4].flag = BR_FLAG_FAILED;
    reach(&m, BR_FAIL, "n = 160");
}

TEST(test_too_few)
{
    struct made m;
    for (size_t count = 0; count < BR_VERIFY_LEAST_POINTS; count++) {
        make_power(&m, 1, count);
        reach(&m, BR_INCONCLUSIVE, "expected at least 4");
    }
    make_power(&m, 1, 5);
    m.point[4].flag = BR_FLAG_ROUND_OFF;
    reach(&m, BR_PASS, "");
    assert_int_equal(m.it.used, 4);
    assert_non_null(strstr(m.it.note, "left out: (n = 160, k = T/1600) (round-off"));
    m.point[3].flag = BR_FLAG_REFERENCE;
    reach(&m, BR_INCONCLUSIVE, "3 of 5 errors can be used, an order needs 4: use coarser grids");
    m.point[0].flag = BR_FLAG_UNSTABLE;
    reach(&m, BR_INCONCLUSIVE, "smaller time steps");
}

/* A point that is left out must not count, however far off it is. */
TEST(test_left_out)
{
    struct made m;
    make_power(&m, 1, 6);
    m.point[5].error *= 1e3;
    m.point[5].flag = BR_FLAG_ROUND_OFF;
    m.it.expected.ceiling = 3.01;
    reach(&m, BR_PASS, "");
    m.point[5].flag = BR_FLAG_NONE;
    reach(&m, BR_FAIL, "");
}

TEST(test_constant)
{
    struct made m;
    make_power(&m, 1, 5);
    m.it.expected.ceiling = 3.001;
    reach(&m, BR_PASS, "");
    CLOSE(m.it.constant, 3, 1e-12);
    m.it.expected.ceiling = 2.999;
    reach(&m, BR_FAIL, "the constant, 3 m^(3/2), is above its upper limit, 2.999");
    m.it.expected.ceiling = 4;
    m.it.expected.floor = 3.001;
    reach(&m, BR_FAIL, "below its lower limit, 3.001");
    m.it.expected.floor = 2.999;
    reach(&m, BR_PASS, "");
    m.it.expected.order = 2; /* both are wrong: both are said */
    m.it.expected.ceiling = 3;
    reach(&m, BR_FAIL, "above its upper limit, 3; and the order");
}

/* Of 400 noisy power laws about 95 % have their order within its interval. */
TEST(test_coverage)
{
    struct br_test_random random = {20261121};
    int within = 0;
    const int trials = 400;
    for (int t = 0; t < trials; t++) {
        struct made m;
        make_power(&m, 1, 5);
        for (size_t i = 0; i < 5; i++) { /* about normal: a sum of 12 uniform numbers */
            double normal = -6;
            for (int j = 0; j < 12; j++)
                normal += br_test_uniform(&random, 0, 1);
            m.point[i].error *= exp(0.05 * normal);
        }
        find_verdict(&m.it);
        within += m.it.order.low <= 1 && m.it.order.high >= 1;
    }
    if (!(within >= 0.93 * trials))
        fail_msg("%d of %d intervals hold the order", within, trials);
}
