/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How a number is read of what a program has written. */
#include <dlfcn.h>
#include <math.h>
#include <regex.h>
#include <string.h>

#include "checks.h"
#include "orders/request.h"

static const struct br_reading err_reading = {"err", "err=(.*)", BR_READING_REGEX,
                                              NULL,  false,      false};

/* Longer than any search takes that ends by itself, s. */
enum { PATIENCE = 600 };

TEST(test_readings)
{
    enum { REGEX = BR_READING_REGEX, JSON = BR_READING_JSON, CSV = BR_READING_CSV };
    static const struct {
        int kind;
        const char *what, *output;
        double number;       /* NaN: it fails ... */
        const char *failure; /* ... with this */
    } cases[] = {
        {REGEX, "L2 *= *([-+.0-9e]+)", "x\nL2 = 1.5e-7\ny", 1.5e-7, NULL},
        {REGEX, "^([^ ]+) m$", "0x1p-3 m\r\n1 s\n-2.5e+3 m\n", -2500, NULL},
        {REGEX, "err=(.*)", "err= 12 \r\n", 12, NULL},
        {REGEX, "e=([0-9]+),", "e=1,5\n", 1, NULL},
        {REGEX, "err-([0-9]+)", "err-3 ", 3, NULL},
        {REGEX, "^(.*)$", "3", 3, NULL},
        {REGEX, "(.*)", "3", 3, NULL},
        {REGEX, "([0-9]*)", "12 34", NAN, "matches 2 times, expected once; lines 1, 1"},
        {REGEX, "e=([0-9.]+)", "e=1.5e-7", NAN, "only a part of the number on line 1: 'e=1.5e-7'"},
        {REGEX, "e=([0-9.]+)", "\ne=1.5D-7", NAN, "only a part of the number on line 2"},
        {REGEX, "e=([0-9.]+)e", "e=1.5e-7", NAN, "part of the number"},
        {REGEX, "e=([0-9.]+)", "e=1,5", NAN, "part of the number"},
        {REGEX, "e=.*([0-9]+)", "e=12", NAN, "part of the number"},
        {REGEX, "e=.*([0-9]+)", "e=1.5e-7", NAN, "part of the number"},
        {REGEX, "e=-?([0-9]+)", "e=-12", NAN, "part of the number"},
        {REGEX, "e=(.*)", "e=1e999", NAN, "found '1e999'"},
        {REGEX, "e=(.*)", "e=1e-999", NAN, "found '1e-999'"},
        {REGEX, "e=(.*)", "e=1 2", NAN, "found '1 2'"},
        {REGEX, "e=(.*)", "e=infinity", NAN, "found 'infinity'"},
        {REGEX, "([0-9])", "1 2 3", NAN, "matches 3 times, expected once; lines 1, 1, 1"},
        {REGEX, "x|e=(1)", "x", NAN, "found ''"},
        {REGEX, "e=(.*)", "", NAN, "matches nothing"},
        {REGEX, "e(.*)",
         "e1111111111111111111111111111111111111111111111111111111111111111111111111111", NAN,
         "of 76 bytes"},
        {JSON, "/a/1/b~1c~0d", "{\"a\": [0, {\"b/c~d\": -2.5e3}]}\n", -2500, NULL},
        {JSON, "", " 12345678901234567890 ", 12345678901234567890.0, NULL},
        {JSON, "/", "{\"\": 1}", 1, NULL},
        {JSON, "/a/01", "{\"a\": [0, 1]}", NAN, "has no '/a/01'"},
        {JSON, "/a/-", "{\"a\": [0, 1]}", NAN, "has no"},
        {JSON, "/a/2", "{\"a\": [0, 1]}", NAN, "has no"},
        {JSON, "/a/b", "{\"a\": 1}", NAN, "has no"},
        {JSON, "/a", "{\"a\": \"1\"}", NAN, "is a text, expected a number"},
        {JSON, "/a", "{\"a\": null}", NAN, "is null"},
        {JSON, "/a", "{\"a\": [1]}", NAN, "is an array"},
        {JSON, "/a", "{\"a\": NaN}", NAN, "no JSON, line 1"},
        {JSON, "/a", "{\"a\": 1e999}", NAN, "no JSON, line 1"},
        {JSON, "/a", "{\"a\": 1, \"a\": 2}", NAN, "no JSON"},
        {JSON, "/a", "{\"a\": 1} x", NAN, "no JSON"},
        {JSON, "/a", "", NAN, "no JSON"},
        {CSV, "L2", "n,L2,x\n4,0.5,1\n8,0.25,2\n", 0.25, NULL},
        {CSV, "L2", "# a\r\n\r\nn, \"L2\"\r\n", NAN, "found no row of numbers"},
        {CSV, "L2", ",L2\n4,0.5\n", 0.5, NULL},
        {CSV, "a \"b\", c", "\"n\",\"a \"\"b\"\", c\"\r\n\"1\n2\",\"0.5\"\r\n", 0.5, NULL},
        {CSV, "x", "n,x\n4, 0.5", 0.5, NULL},
        {CSV, "n", "n\n\n3\n\n", 3, NULL},
        {CSV, "x", "n,x\n4,0.5\nError: no convergence\n", NAN, "found 'Error: no convergence'"},
        {CSV, "x", "n,x\n4,0.5\n# failed in step 3\n", NAN, "'failed in step 3' below the last"},
        {CSV, "x", "1 of 2 failed\nn,x\n4,0.5\ndone\n", 0.5, NULL},
        {CSV, "y", "n,x\n4,0.5", NAN, "found 0 columns 'y'"},
        {CSV, "x", "x,x\n4,0.5", NAN, "found 2 columns 'x'"},
        {CSV, "x", "n,x\n", NAN, "found no row of numbers"},
        {CSV, "x", "", NAN, "the output:1: the table is empty"},
        {CSV, "x", "n,x\n1,5,2\n", NAN, "the output:2: found more than the 2 fields"},
        {CSV, "x", "n,x\n1\n", NAN, "found nothing below 'x'"},
        {CSV, "x", "n,x\n1,\n", NAN, "found '', expected a finite number"},
        {CSV, "x", "n,x\n1,nan\n", NAN, "found 'nan'"},
        {CSV, "x", "n,x\n1,\"2", NAN, "quote"},
        {CSV, "x", "n,x\n1,\"2\"3", NAN, "quote"},
        {CSV, "x", "n,x\n1,2\"", NAN, "found '2\"'"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const struct br_reading reading = {"q",  cases[i].what, (enum br_reading_kind)cases[i].kind,
                                           NULL, false,         false};
        const struct br_orders_request q = {
            .reading = &reading, .readings = 1, .seconds = PATIENCE};
        const char *output = cases[i].output;
        double number = 0;
        MUST(br_reading_check(&reading, &err));
        const enum br_status status = br_reading_take(&q, 0, output, strlen(output), &number, &err);
        if (!cases[i].failure && !(status == BR_OK && number == cases[i].number))
            fail_msg("'%s' in '%s': %g, %s", cases[i].what, output, number, err.message);
        if (cases[i].failure && !(status == BR_BAD_INPUT && strstr(err.message, cases[i].failure)))
            fail_msg("'%s' in '%s': %g, %s", cases[i].what, output, number, err.message);
        if (cases[i].failure)
            assert_memory_equal(err.message, "q: ", 3);
    }
}

TEST(test_refused_readings)
{
    static const struct {
        struct br_reading reading;
        const char *message;
    } cases[] = {
        {{"", "(.)", BR_READING_REGEX, NULL, false, false}, "no name"},
        {{"q", "(", BR_READING_REGEX, NULL, false, false},
         "q: '(' is no extended regular expression"},
        {{"q", "a", BR_READING_REGEX, NULL, false, false}, "has 0 groups, expected one"},
        {{"q", "(a)(b)", BR_READING_REGEX, NULL, false, false}, "has 2 groups"},
        {{"q", "a", BR_READING_JSON, NULL, false, false}, "'a' is no JSON pointer"},
        {{"q", "/a~2", BR_READING_JSON, NULL, false, false}, "is no JSON pointer"},
        {{"q", "/a~", BR_READING_JSON, NULL, false, false}, "is no JSON pointer"},
        {{"q", "", BR_READING_CSV, NULL, false, false}, "no column"},
    };
    static const double three[] = {16, 4, 8};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const struct br_orders_request p = {
            .command = (char *)"true {n}",
            .axis[BR_AXIS_SPACE] = {br_resolution_column_find("n"), three, 3},
            .dimension = 1,
            .reading = &cases[i].reading,
            .readings = 1,
            .jobs = 1,
            .seconds = PATIENCE};
        struct br_numbers numbers;
        REFUSED(br_program_run(&p, &numbers, &err), BR_BAD_INPUT, cases[i].message);
        assert_null(numbers.row);
    }
}

/* An expression that the C library would crash on, or compile or match for ever. */
TEST(test_hostile_expressions)
{
    static const struct {
        const char *begin, *repeated;
        int times;
        const char *end, *message; /* NULL: it is taken */
    } cases[] = {
        {"", "(", 20000, "a", "has 20001 letters, expected at most 1000"},
        {"(a)", "(", 40, "", "has 41 groups, expected one"},
        {"(a)", "b", 997, "", NULL},
        {"(a)", "b", 998, "", "has 1001 letters, expected at most 1000"},
        {"([ab]*)", "\\1", 1, "", "letter 8: found \\1, expected no back-reference"},
        {"(a)[\\1]\\\\", "1", 1, "", NULL},
        {"(a{10,100}){10}", "", 1, "", NULL},
        {"(a{10,100}){11}", "", 1, "", "letter 12: repeats to more than 1000 letters"},
        {"(a)b{100}", "{2}", 4, "c", "letter 19: repeats to more than 1000 letters"},
        {"(a{,1000})", "", 1, "", NULL},
        {"(a{1000,})", "", 1, "", "letter 3: repeats to more than 1000 letters"},
        {"(a{99999999999999999999})", "", 1, "", "letter 3: repeats"},
        {"(a)", "b+", 300, "", NULL},
        {"(a)b", "+", 18, "", "repeats to more than 1000 letters"},
        {"([]{9999}[:alpha:][=a=]({9999}])", "", 1, "", NULL},
        {"(a)[b", "", 1, "", "is no extended regular expression"},
        {"(a)[[:", "", 1, "", "is no extended regular expression"},
        {"(a)\\", "", 1, "", "is no extended regular expression"},
        {"(a){2", "", 1, "", "is no extended regular expression"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        static char text[1 << 15];
        const struct br_reading reading = {"q", text, BR_READING_REGEX, NULL, false, false};
        strcpy(text, cases[i].begin);
        for (int j = 0; j < cases[i].times; j++)
            strcat(text, cases[i].repeated);
        strcat(text, cases[i].end);
        if (cases[i].message)
            REFUSED(br_reading_check(&reading, &err), BR_BAD_INPUT, cases[i].message);
        else
            MUST(br_reading_check(&reading, &err));
    }
}

static bool always(void *self)
{
    (void)self;
    return true;
}

/* A search can be stopped, takes no longer than a run, and has a longest line. */
TEST(test_long_searches)
{
    static const struct br_observer stops = {.stop = always};
    static const struct br_reading reading = {"q",  "(.*)a.{900}b", BR_READING_REGEX,
                                              NULL, false,          false};
    static char output[8200] = "\n1234\n";
    struct br_orders_request q = {.reading = &reading, .readings = 1, .seconds = 1e-9};
    double number;
    memset(output + 6, 'a', 8193);
    REFUSED(br_reading_take(&q, 0, output, strlen(output), &number, &err), BR_BAD_INPUT,
            "q: the search for '(.*)a.{900}b' did not end within 1e-09 s");
    q.observer = &stops;
    REFUSED(br_reading_take(&q, 0, output, strlen(output), &number, &err), BR_INTERRUPTED, "");
    q = (struct br_orders_request){.reading = &err_reading, .readings = 1, .seconds = PATIENCE};
    REFUSED(br_reading_take(&q, 0, output, strlen(output), &number, &err), BR_BAD_INPUT,
            "err: line 3 of the output has 8193 bytes, expected at most 8192 for a regular");
    memcpy(output + 8193, "err=7", 5); /* of 8192 bytes, with a match at its end */
    MUST(br_reading_take(&q, 0, output, strlen(output) - 1, &number, &err));
    CLOSE(number, 7, 0);
}

/* ---- memory ---- */

/* These stand before the C library's own functions. */
static enum { NOTHING, COMPILING, SEARCHING } fails;

int regcomp(regex_t *regex, const char *text, int flags)
{
    int (*own)(regex_t *, const char *, int);
    *(void **)&own = dlsym(RTLD_NEXT, "regcomp");
    return fails == COMPILING ? REG_ESPACE : own(regex, text, flags);
}

regoff_t re_search(regex_t *regex, const char *text, regoff_t length, regoff_t from, regoff_t range,
                   struct re_registers *registers)
{
    regoff_t (*own)(regex_t *, const char *, regoff_t, regoff_t, regoff_t, struct re_registers *);
    *(void **)&own = dlsym(RTLD_NEXT, "re_search");
    return fails == SEARCHING ? -2 : own(regex, text, length, from, range, registers);
}

TEST(test_expressions_without_memory)
{
    const struct br_orders_request q = {
        .reading = &err_reading, .readings = 1, .seconds = PATIENCE};
    double number;
    fails = COMPILING;
    REFUSED(br_reading_check(&err_reading, &err), BR_NO_MEMORY, "a regular expression");
    REFUSED(br_reading_take(&q, 0, "err=1", 5, &number, &err), BR_NO_MEMORY, "expression");
    fails = SEARCHING;
    REFUSED(br_reading_take(&q, 0, "err=1", 5, &number, &err), BR_NO_MEMORY, "expression");
    fails = NOTHING;
    MUST(br_reading_take(&q, 0, "err=1", 5, &number, &err));
}
