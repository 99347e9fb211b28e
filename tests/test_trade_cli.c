/* SPDX-License-Identifier: GPL-3.0-or-later */
/* `beamrate trade` as a user runs it: what is refused, what is written, and that all formats say
 * the same. */
#include <jansson.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>

#include "cli_driver.h"
#include "support.h"

#define SMALL "--n 10,20 --k 0.1,0.05 --tolerances 1e-3 --repeats 1 --threads 2"

/* What the finest march does not see of a load is told before, whichever way it is marched. */
static void test_loads(void **state)
{
    (void)state;
    static const char unseen[] = "blow: the axial load does between the time levels what they do "
                                 "not see";
    cli_write_file("blow.yaml", "title: blow\nlength: 1 m\nduration: 1 s\ndensity: 1 kg/m\naxial:\n"
                                "  stiffness: 1 N\n  viscosity: 1 N s\n"
                                "  load: t + 100 * exp(-((t - 0.333) / 1e-3)^2) [N/m]\n");
    cli_expect("trade blow.yaml --methods euler --n 2 --k 0.1,0.05 --repeats 1 --out blow "
               "--no-plots",
               NULL, 0, unseen);
    cli_expect("trade blow.yaml --split --methods euler --n 2 --k 0.1,0.05 --out blow --no-plots",
               NULL, 0, unseen);
}

static json_t *load(const char *name)
{
    char path[512];
    cli_path(name, path);
    json_t *root = json_load_file(path, 0, NULL);
    assert_non_null(root);
    return root;
}

static double number(const json_t *o, const char *key)
{
    return json_number_value(json_object_get(o, key));
}

/* A line of the text that begins with these words, after blanks are made one. */
static bool has_row(const char *text, const char *words)
{
    char line[512];
    for (const char *at = text; *at; at += strcspn(at, "\n"), at += *at == '\n') {
        size_t used = 0;
        for (const char *c = at; *c && *c != '\n' && used + 1 < sizeof line; c++)
            if (*c != ' ' || (used && line[used - 1] != ' '))
                line[used++] = *c;
        line[used] = '\0';
        if (strncmp(line, words, strlen(words)) == 0)
            return true;
    }
    return false;
}

/* What the text has of a trial. */
static void expect_trial(const char *text, const json_t *t)
{
    char words[512], step[64], seconds[64];
    const bool adaptive = json_is_null(json_object_get(t, "k"));
    snprintf(step, sizeof step, adaptive ? "tol %.0e" : "%.6g",
             number(t, adaptive ? "tolerance" : "k"));
    snprintf(seconds, sizeof seconds, "%.3g %.3g", number(t, "set_up"), number(t, "march"));
    snprintf(words, sizeof words, "%s %d %s %.2e %.3e %.3e %.3e %s %d %d %d %s",
             json_string_value(json_object_get(t, "method")), (int)number(t, "n"), step,
             number(t, "relative_error"), number(t, "error"), number(t, "axial"),
             number(t, "bending"), seconds, (int)number(t, "steps"), (int)number(t, "solves"),
             (int)number(t, "iterations"), json_string_value(json_object_get(t, "end")));
    if (!has_row(text, words))
        fail_msg("the text has no line '%s'", words);
}

static void test_formats_agree(void **state)
{
    (void)state;
    cli_expect("trade example2 --methods euler+lagged,euler+implicit,adaptive --out o " SMALL, NULL,
               0, "Cheapest way to an error");
    json_t *root = load("o/example2.json");
    const json_t *trials = json_object_get(root, "trials");
    const char *text = cli_read("o/example2.txt");
    assert_int_equal(json_array_size(trials), 2 * 4 + 2);
    for (size_t i = 0; i < json_array_size(trials); i++)
        expect_trial(text, json_array_get(trials, i));
    /* the cheapest way to 1e-2 */
    const json_t *best = json_array_get(json_object_get(root, "cheapest"), 0);
    CLOSE(number(best, "target"), 1e-2, 1e-15);
    const json_t *t =
        json_array_get(trials, (size_t)json_integer_value(json_object_get(best, "trial")));
    char words[256];
    snprintf(words, sizeof words, "1e-02 %s %d ", json_string_value(json_object_get(t, "method")),
             (int)number(t, "n"));
    assert_true(has_row(text, words));
    AT_MOST(number(t, "relative_error"), 1e-2);
    /* a line each in CSV, below the heading, and as many fields */
    const char *csv = cli_read("o/example2.csv");
    size_t lines = 0;
    for (const char *c = csv; *c; c++)
        lines += *c == '\n';
    assert_int_equal(lines, json_array_size(trials) + 1);
    assert_true(cli_file_contains("o/example2.md", "## Cheapest way to an error"));
    assert_true(cli_file_contains("o/example2.tex", "\\begin{longtable}"));
    assert_true(cli_is_there("o/example2-schemes.gp") && cli_is_there("o/example2-work.dat"));
    assert_false(cli_is_there("o/example2-rules.gp"));
    json_decref(root);
}

/* Other friction rules and solvers have a picture of their own, with what they are held against. */
static void test_rules(void **state)
{
    (void)state;
    cli_expect("trade example2 --methods bdf2,bdf2+umfpack,euler --out r " SMALL, NULL, 2,
               "--tolerances");
    cli_expect("trade example2 --methods bdf2,bdf2+umfpack,euler --n 10 --k 0.1,0.05 --repeats 1 "
               "--format csv --out r",
               &(struct cli_circumstances){.path = "/dev/null"}, 0, "gnuplot is not installed");
    assert_true(cli_file_contains("r/example2-rules.gp", "'bdf2+umfpack'"));
    assert_true(cli_file_contains("r/example2-rules.gp", "'bdf2'"));
    assert_false(cli_file_contains("r/example2-rules.gp", "'euler'"));
    assert_true(cli_file_contains("r/example2-schemes.gp", "'euler'"));
    assert_false(cli_file_contains("r/example2-schemes.gp", "umfpack"));
    assert_false(cli_is_there("r/example2.json"));
}

/* What is over the limit is shown with its reason, and nothing else is lost. */
static void test_over_the_limit(void **state)
{
    (void)state;
    cli_expect("trade example2 --methods euler+implicit --n 50 --k 0.1,1e-8 --time-limit 0.01 "
               "--repeats 1 --out l --no-plots",
               NULL, 0, "over limit: over the time limit of 0.01 s");
    assert_true(cli_file_contains("l/example2.txt", "over limit: 1"));
    assert_true(cli_file_contains("l/example2.csv", "over limit,0,0,over the time limit"));
    assert_true(has_row(cli_read("l/example2.txt"),
                        "euler+implicit 50 1e-08 - - - - - - - - - over limit"));
    cli_expect("trade example2 --methods euler+implicit --n 50 --k 1e-8 --time-limit 0.01 "
               "--out m --no-plots --quiet",
               NULL, 3, "example2: no trial came to its end");
    assert_true(cli_is_there("m/example2.txt"));
    /* even one that has ended before anybody looked at the clock */
    cli_expect("trade example2 --methods euler --n 1 --k 0.5 --time-limit 1e-12 --out m --quiet",
               NULL, 3, "over the time limit of 1e-12 s");
}

/* The paper's method beyond its limit is marked, and never the cheapest. */
static void test_unstable(void **state)
{
    (void)state;
    cli_write_file("stiff.yaml", "title: stiff\nlength: 1 m\nduration: 1 s\ndensity: 1e-3 kg/m\n"
                                 "axial:\n  stiffness: 1 N\n  viscosity: 1e-3 N s\n"
                                 "  load: 1 [N/m]\n"
                                 "contact:\n  gap: 0.01 m\n  stiffness: 100 N/m\n");
    cli_expect("trade stiff.yaml --methods euler+lagged --n 4 --k 0.1 --out u --no-plots", NULL, 0,
               "unstable: 1");
    assert_true(cli_file_contains("u/stiff.csv", "unstable,0,0,"));
    assert_true(has_row(cli_read("u/stiff.txt"), "1e-02 - - -"));
}

/* At rest there is nothing that an error is a part of. */
static void test_zero_solution(void **state)
{
    (void)state;
    cli_write_file("rest.yaml", "title: rest\nlength: 1 m\nduration: 1 s\ndensity: 1e-3 kg/m\n"
                                "axial:\n  stiffness: 1 N\n  viscosity: 1e-3 N s\n"
                                "  load: 0 [N/m]\n");
    cli_expect("trade rest.yaml --methods bdf2 --n 4 --k 0.1 --out z --no-plots", NULL, 3,
               "the solution is zero");
    cli_expect("trade rest.yaml --split --n 4 --k 0.1 --out z --no-plots", NULL, 3,
               "the solution is zero");
}

static void test_several_scenes(void **state)
{
    (void)state;
    cli_expect("trade example2 example3 --methods euler,bdf2 --n 10 --k 0.1,0.05 --repeats 1 "
               "--out s --no-plots",
               NULL, 0, "Cheapest way to an error, by scene");
    json_t *root = load("s/summary.json"), *one = load("s/example3.json");
    const json_t *rows = json_object_get(root, "cheapest");
    assert_int_equal(json_array_size(rows), 18);
    const json_t *row = json_array_get(rows, 9);
    assert_string_equal(json_string_value(json_object_get(row, "scene")), "example3");
    const json_t *best = json_array_get(json_object_get(one, "cheapest"), 0);
    const json_t *t = json_array_get(json_object_get(one, "trials"),
                                     (size_t)json_integer_value(json_object_get(best, "trial")));
    assert_true(json_equal(t, json_object_get(row, "trial")));
    assert_true(cli_is_there("s/summary.csv") && cli_is_there("s/summary.tex"));
    assert_true(has_row(cli_read("s/summary.txt"), "example3 1e-02 "));
    json_decref(root);
    json_decref(one);
}

static void test_interrupt(void **state)
{
    (void)state;
    cli_expect("trade example2 --methods euler --n 1000 --k 1e-10 --time-limit 1e9 --out i --quiet",
               &(struct cli_circumstances){.interrupt_after = 300}, -SIGINT,
               "interrupted; no file is half written");
    assert_false(cli_is_there("i"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_loads),          cmocka_unit_test(test_formats_agree),
        cmocka_unit_test(test_rules),          cmocka_unit_test(test_over_the_limit),
        cmocka_unit_test(test_unstable),       cmocka_unit_test(test_zero_solution),
        cmocka_unit_test(test_several_scenes), cmocka_unit_test(test_interrupt),
    };
    return cmocka_run_group_tests(tests, cli_make_folder, cli_remove_folder);
}
