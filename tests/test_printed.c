/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The printed tables as data: good files, and every kind of bad line. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "reference/printed.h"
#include "study/scene/file.h"
#include "support.h"

static struct br_error err;

static enum br_status read_text(const char *text, struct br_printed *printed)
{
    return br_printed_read(br_test_scene_file(text), printed, &err);
}

TEST(test_good)
{
    struct br_printed p;
    MUST(read_text("n,k,error\n100,0.01,5.042e-3\n200,1e-4,3.5E-6\r\n7,2,8", &p));
    assert_int_equal(p.count, 3);
    assert_int_equal(p.cell[1].n, 200);
    CLOSE(p.cell[1].k, 1e-4, 0);
    CLOSE(p.cell[1].error, 3.5e-6, 0);
    CLOSE(br_printed_error(&p, 100, 0.01), 5.042e-3, 0);
    CLOSE(br_printed_error(&p, 100, 0.01 * (1 + 1e-12)), 5.042e-3, 0); /* k = T/steps, rounded */
    CLOSE(br_printed_error(&p, 7, 2), 8, 0);
    assert_true(isnan(br_printed_error(&p, 100, 0.0101)));
    assert_true(isnan(br_printed_error(&p, 101, 0.01)));
    assert_true(isnan(br_printed_error(&p, 200, 0.01)));
    br_printed_clear(&p);
    assert_true(!p.cell && p.count == 0);
    assert_true(isnan(br_printed_error(&p, 100, 0.01)));
    MUST(read_text("n,k,error\r\n", &p)); /* a heading alone */
    assert_int_equal(p.count, 0);
    br_printed_clear(&p);
}

/* Lines that are none behind a good one; headings that are none, with the line that is refused. */
TEST(test_bad_files)
{
    static const char *const lines[] = {
        "",
        "100",
        "100,0.01",
        "100,0.01,",
        "100;0.01;1e-3",
        "a,0.01,1e-3",
        "100,b,1e-3",
        "100,0.01,c",
        "0,0.01,1e-3",
        "100,0,1e-3",
        "100,-1,1e-3",
        "100,nan,1e-3",
        "100,inf,1e-3",
        "100,0.01,0",
        "100,0.01,-1e-3",
        "100,0.01,nan",
        "100,0.01,inf",
        "100,0.01,1e-3,",
        "1.5,0.01,1e-3",
        "100,0.01,1e-3 x",
        "n,k,error",
        "100,0.01,1e999",
        "-100,0.01,1e-3",
    };
    static const char *const headings[][2] = {
        {"100,0.01,5e-3\n", ":1: found '100,0.01,5e-3'"},
        {"n,h,error\n", ":1: found 'n,h,error'"},
        {"k,n,error\n", ":1: found 'k,n,error'"},
        {"\nn,k,error\n", ":1: found ''"},
        {"", ":1: found nothing"},
    };
    struct br_printed p;
    char many[100000], where[128];
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
        snprintf(many, sizeof many, "n,k,error\n100,0.01,5e-3\n%s\n200,0.01,5e-3\n", lines[i]);
        snprintf(where, sizeof where, "%s:3: found '%s', expected n,k,error",
                 br_test_scene_file(many), lines[i]);
        REFUSED(read_text(many, &p), BR_BAD_INPUT, where);
        br_printed_clear(&p);
    }
    for (size_t i = 0; i < sizeof headings / sizeof *headings; i++) {
        REFUSED(read_text(headings[i][0], &p), BR_BAD_INPUT, headings[i][1]);
        br_printed_clear(&p);
    }
    REFUSED(br_printed_read("/no/such/file", &p, &err), BR_BAD_INPUT, "/no/such/file: No such");
    br_printed_clear(&p);
    REFUSED(br_printed_read("/proc", &p, &err), BR_IO, "/proc: "); /* a folder */
    br_printed_clear(&p);
    size_t used = (size_t)sprintf(many, "n,k,error\n");
    for (int i = 1; i <= 4097; i++)
        used += (size_t)sprintf(many + used, "%d,0.01,1e-3\n", i);
    REFUSED(read_text(many, &p), BR_BAD_INPUT, "more than 4096 cells");
    br_printed_clear(&p);
}

/* A line longer than the buffer must not be cut into two that look right. */
TEST(test_long_line)
{
    struct br_printed p;
    char text[1024] = "n,k,error\n100,0.01,0.";
    const size_t start = strlen(text);
    memset(text + start, '1', 10 + 255 - start); /* the buffer is full here: */
    strcpy(text + 10 + 255, "7,0.01,1e-3\n");    /* one line all the same */
    REFUSED(read_text(text, &p), BR_BAD_INPUT, ":2: ");
    br_printed_clear(&p);
}

/* The paper's: 36 cells each, and their first. */
TEST(test_the_paper)
{
    static const char *const files[] = {"reference/printed/table1.csv",
                                        "reference/printed/table2.csv"};
    static const double first[] = {5.042e-3, 1.522e-2};
    static const double k[] = {0.01, 0.005, 0.002, 0.001, 0.0005, 0.0001};
    for (int i = 0; i < 2; i++) {
        struct br_printed p;
        char file[1024];
        br_data_path(files[i], file, sizeof file);
        MUST(br_printed_read(file, &p, &err));
        assert_int_equal(p.count, 36);
        for (size_t n = 100; n <= 3200; n *= 2)
            for (int j = 0; j < 6; j++)
                assert_true(br_printed_error(&p, n, k[j]) > 0);
        CLOSE(br_printed_error(&p, 100, 0.01), first[i], 0);
        br_printed_clear(&p);
    }
}
