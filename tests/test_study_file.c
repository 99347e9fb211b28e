/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Study files: what they say, and what is refused. */
#include <stdio.h>
#include <string.h>

#include "checks.h"
#include "orders/request.h"

static const char *const full = "title: a study\n"
                                "run: sh -c 'echo l2={n}'\n"
                                "n: 10, 20, 40\n"
                                "k: 0.1, 0.05\n"
                                "read:\n"
                                "  l2: l2=(.*)\n"
                                "  drag: json:/drag\n"
                                "  lift: csv:lift\n"
                                "error: l2\n"
                                "value: drag, lift\n"
                                "dimension: 3\n"
                                "formal_order: 4\n"
                                "time_limit: 60 s\n"
                                "verify:\n"
                                "  l2: h 2 +- 0.1, k 1 +- 0.1\n"
                                "  drag: h 2 +- 0.2 down to 1e-9\n";

TEST(test_study_file)
{
    struct br_orders_request r;
    MUST(br_orders_request_read("s.yaml", full, &r, &err));
    assert_string_equal(r.title, "a study");
    assert_string_equal(r.command, "sh -c 'echo l2={n}'");
    assert_null(r.table);
    assert_int_equal(r.axis[BR_AXIS_SPACE].count, 3);
    CLOSE(r.axis[BR_AXIS_SPACE].given[2], 40, 0);
    assert_string_equal(r.axis[BR_AXIS_TIME].column->name, "k");
    assert_int_equal(r.readings, 3);
    assert_int_equal(r.reading[0].kind, BR_READING_REGEX);
    assert_int_equal(r.reading[1].kind, BR_READING_JSON);
    assert_string_equal(r.reading[1].what, "/drag");
    assert_int_equal(r.reading[2].kind, BR_READING_CSV);
    assert_string_equal(r.errors, "l2");
    assert_string_equal(r.values, "drag, lift");
    CLOSE(r.dimension, 3, 0);
    CLOSE(r.formal, 4, 0);
    CLOSE(r.seconds, 60, 0);
    assert_int_equal(r.expectations, 3);
    assert_int_equal(r.expectation[0].band.line, 15);
    assert_int_equal(r.expectation[2].band.line, 16);
    assert_string_equal(r.expectation[2].quantity, "drag");
    br_orders_request_clear(&r);
    static const char *const lists[] = {"n", "h", "dofs", "k", "dt", "steps"};
    for (size_t i = 0; i < 6; i++) {
        char text[128];
        snprintf(text, sizeof text, "run: a\n%s: 1, 2\nread: {a: b}\n", lists[i]);
        MUST(br_orders_request_read("s.yaml", text, &r, &err));
        const struct br_resolution_column *column = br_resolution_column_find(lists[i]);
        assert_ptr_equal(r.axis[column->axis].column, column);
        br_orders_request_clear(&r);
    }
}

TEST(test_study_table)
{
    const char *path = br_test_scene_file("h,l2\n1,3\n.5,x\n.25,1\n");
    char text[4096], message[4200];
    struct br_orders_request r;
    OWNED(br_numbers) numbers;
    snprintf(text, sizeof text, "table: %s\nerror: l2\n", path);
    MUST(br_orders_request_read("/usr/s.yaml", text, &r, &err));
    assert_string_equal(r.table_path, path);
    assert_true(r.table_is_outside);
    snprintf(message, sizeof message, "%s:3: l2: found 'x'", path); /* the table, not the study */
    REFUSED(br_orders_read(&r, &numbers, &err), BR_BAD_INPUT, message);
    br_orders_request_clear(&r);
    snprintf(text, sizeof text, "%s", path);
    char *const slash = strrchr(text, '/');
    *slash = '\0';
    char study[4096], in[4096];
    snprintf(study, sizeof study, "table: %s\n", slash + 1); /* in the folder of the study */
    snprintf(in, sizeof in, "%.4000s/s.yaml", text);
    MUST(br_orders_request_read(in, study, &r, &err));
    assert_string_equal(r.table_path, path);
    assert_false(r.table_is_outside);
    br_orders_request_clear(&r);
}

static void refuse_study(char *row)
{
    OWNED(br_orders_request) r;
    const char *message = br_test_part(row), *text = br_test_unescape(row);
    REFUSED(br_orders_request_read("s.yaml", text, &r, &err), BR_BAD_INPUT, message);
    assert_non_null(strstr(err.message, "s.yaml"));
}

TEST(test_refused_studies)
{
    br_test_rows("files of studies", refuse_study);
}

/* A text that is cut would be another expectation. */
TEST(test_long_expectation)
{
    char text[3000];
    OWNED(br_orders_request) r;
    snprintf(text, sizeof text, "run: a\nread: {a: b}\nverify:\n  a: 'h 2 +-%*s'\n", 995, "0.15");
    MUST(br_orders_request_read("s.yaml", text, &r, &err));
    CLOSE(r.expectation[0].band.tolerance, 0.15, 0);
}

TEST(test_is_study_file)
{
    assert_true(br_is_study_file(full));
    assert_true(br_is_study_file("table: a\n"));
    assert_false(br_is_study_file("  run: a\n"));
    assert_false(br_is_study_file("runs: a\ntitle: run: x\n"));
    assert_false(br_is_study_file(""));
}

static void problem_of(const char *from, const char *to, char problem[40])
{
    char text[2048];
    OWNED(br_orders_request) r;
    const char *at = strstr(full, from);
    assert_non_null(at);
    snprintf(text, sizeof text, "%.*s%s%s", (int)(at - full), full, to, at + strlen(from));
    MUST(br_orders_request_read("s.yaml", text, &r, &err));
    br_orders_problem(&r, problem);
}

TEST(test_problems)
{
    static const char *const others[][2] = {
        {"l2={n}", "l2={k}"},
        {"json:/drag", "json:/lift"},
        {"  lift: csv", "  loft: csv"},
        {"error: l2\n", ""},
        {"value: drag, lift", "value: drag"},
        {"h 2 +- 0.1", "h 2 +- 0.2"},
        {"h 2 +- 0.1", "h 3 +- 0.1"},
        {"down to 1e-9", "down to 1e-8"},
        {"  l2: h 2 +- 0.1, k", "  l2: k"},
    };
    char as_it_is[40], problem[40];
    problem_of("a study", "a study", as_it_is);
    assert_int_equal(strlen(as_it_is), 32);
    problem_of("a study", "another title", problem);
    assert_string_equal(problem, as_it_is);
    problem_of("n: 10, 20, 40", "n: 20, 40, 80", problem);
    assert_string_equal(problem, as_it_is);
    problem_of("60 s", "61 s", problem);
    assert_string_equal(problem, as_it_is);
    for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
        problem_of(others[i][0], others[i][1], problem);
        assert_string_not_equal(problem, as_it_is);
    }
}

/* ---- what is read of a program ---- */

static void refuse_run(const char *readings, const char *lists, const char *message)
{
    char text[1024];
    OWNED(br_orders_request) r;
    OWNED(br_numbers) numbers;
    snprintf(text, sizeof text, "run: echo a={n} b=-{n}\nn: 1, 2, 4\nread:\n  %s\n%s", readings,
             lists);
    MUST(br_orders_request_read("s.yaml", text, &r, &err));
    REFUSED(br_orders_read(&r, &numbers, &err), BR_BAD_INPUT, message);
}

TEST(test_readings)
{
    refuse_run("a: a=([^ ]*)", "value: b\n", "s.yaml: --value: nothing of the name 'b' is read");
    refuse_run("a: a=([^ ]*)", "error: b\n", "s.yaml: --error: nothing of the name 'b' is read");
    refuse_run("a: a=([^ ]*)", "error: a\nvalue: a\n", "'a' is given as an error and as a value");
    refuse_run("b: b=([^ ]*)", "", "s.yaml: n = 1: b: found -1, expected an error of at least 0");
}

/* ---- without memory ---- */

static enum br_status whole_study(const void *text, struct br_error *why)
{
    OWNED(br_orders_request) r;
    const enum br_status status = br_orders_request_read("s.yaml", text, &r, why);
    return status;
}

TEST(test_without_memory)
{
    br_test_without_memory(whole_study, full, 7);
}
