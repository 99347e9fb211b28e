/* SPDX-License-Identifier: GPL-3.0-or-later */
/* `beamrate trade` as a user runs it: what is refused, what is shown and what is written. */
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

static size_t lines_of(const char *text)
{
    size_t lines = 0;
    for (; *text; text++)
        lines += *text == '\n';
    return lines;
}

static json_t *table(const json_t *root, const char *key)
{
    json_t *t = json_object_get(json_object_get(root, "tables"), key);
    assert_non_null(t);
    return t;
}

/* Columns of a row of trials that stand in another row, too. */
static void same_trial(const json_t *trial, const json_t *row)
{
    static const char *const keys[] = {"method", "n",       "k",      "tolerance", "relative_error",
                                       "error",  "seconds", "set_up", "march",     "solves"};
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++) {
        assert_non_null(json_object_get(trial, keys[i]));
        assert_true(json_equal(json_object_get(trial, keys[i]), json_object_get(row, keys[i])));
    }
}

static void test_written(void **state)
{
    (void)state;
    cli_expect("trade example2 --methods euler+lagged,euler+implicit,adaptive --out o " SMALL, NULL,
               0, "The paper's way, euler+lagged, reaches none of the errors.");
    json_t *root = load("o/example2.json");
    const json_t *trials = table(root, "trials"),
                 *best = json_array_get(table(root, "cheapest"), 0);
    assert_int_equal(json_array_size(trials), 2 * 4 + 2);
    CLOSE(number(best, "target"), 1e-2, 1e-15);
    AT_MOST(number(best, "relative_error"), 1e-2);
    same_trial(json_array_get(trials, (size_t)number(best, "trial")), best);
    /* no trial that is good enough costs less */
    for (size_t i = 0; i < json_array_size(trials); i++) {
        const json_t *t = json_array_get(trials, i);
        if (number(t, "relative_error") < 0.99e-2)
            AT_MOST(number(best, "seconds"), number(t, "seconds"));
    }
    char words[256];
    snprintf(words, sizeof words, "1e-02 %s %d ",
             json_string_value(json_object_get(best, "method")), (int)number(best, "n"));
    assert_true(has_row(cli_read("o/example2.txt"), words));
    assert_int_equal(lines_of(cli_read("o/example2.csv")), json_array_size(trials) + 1);
    assert_int_equal(lines_of(cli_read("o/example2-cheapest.csv")), 9 + 1);
    assert_int_equal(lines_of(cli_read("o/example2-methods.csv")), 3 + 1);
    assert_true(cli_file_contains("o/example2.md", "## Cheapest way to an error"));
    assert_true(cli_file_contains("o/example2.tex", "\\begin{longtable}"));
    assert_true(cli_is_there("o/example2-schemes.gp") && cli_is_there("o/example2-work.dat"));
    assert_true(cli_file_contains("o/example2.json", "\"example2-schemes\""));
    assert_false(cli_is_there("o/example2-rules.gp"));
    json_decref(root);
}

/* The front in the order of seconds, each trial more accurate than the one before. */
static void test_front(void **state)
{
    (void)state;
    cli_expect("trade example4 --methods euler,bdf2,bdf3 --n 10,40 --k 0.1,0.01,0.001 --repeats 1 "
               "--out f --no-plots --format json,text",
               NULL, 0, "Pareto front: no trial is better in error and in seconds");
    json_t *root = load("f/example4.json");
    const json_t *trials = table(root, "trials");
    const json_t *fastest = NULL, *best = NULL;
    size_t front = 0;
    for (size_t i = 0; i < json_array_size(trials); i++) {
        const json_t *t = json_array_get(trials, i);
        if (!json_is_true(json_object_get(t, "front")))
            continue;
        front++;
        fastest = fastest && number(fastest, "seconds") < number(t, "seconds") ? fastest : t;
        best = best && number(best, "error") < number(t, "error") ? best : t;
    }
    assert_true(front > 1);
    const char *text = cli_read("f/example4.txt");
    const char *table_text = strstr(text, "Pareto front");
    assert_non_null(table_text);
    double seconds = 0;
    for (const char *line = strchr(strchr(table_text, '\n') + 1, '\n') + 1; *line != '\n';
         line = strchr(line, '\n') + 1, front--) {
        double error, cpu;
        assert_int_equal(sscanf(line, "%*s %*s %*s %*s %lf %lf", &error, &cpu), 2);
        assert_true(cpu >= seconds);
        seconds = cpu;
    }
    assert_int_equal(front, 0);
    char words[256];
    snprintf(words, sizeof words, "Fastest%s: %s, n = %d,",
             fastest == best ? " and most accurate" : "",
             json_string_value(json_object_get(fastest, "method")), (int)number(fastest, "n"));
    assert_true(has_row(text, words));
    snprintf(words, sizeof words, "Most accurate: %s, n = %d,",
             json_string_value(json_object_get(best, "method")), (int)number(best, "n"));
    assert_true(has_row(text, words) || fastest == best);
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
               NULL, 0, "over the time limit of 0.01 s");
    assert_true(cli_file_contains("l/example2.txt", "Trials: 1 done, 1 over limit."));
    assert_true(cli_file_contains("l/example2.csv", ",over limit,false,false,over the time limit"));
    assert_true(has_row(cli_read("l/example2.txt"), "euler+implicit 50 1e-08 over limit over the"));
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
               "Trials: 1 unstable.");
    assert_true(cli_file_contains("u/stiff.csv", ",unstable,false,false,"));
    assert_true(has_row(cli_read("u/stiff.txt"), "No trial has an error of 1e-03 or less."));
    assert_false(cli_file_contains("u/stiff.txt", "Cheapest way"));
    assert_true(cli_file_contains("u/stiff-cheapest.csv", "\n0.01,,,,"));
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
    const json_t *rows = table(root, "cheapest"), *row = json_array_get(rows, 9);
    assert_int_equal(json_array_size(rows), 18);
    assert_string_equal(json_string_value(json_object_get(row, "scene")), "example3");
    same_trial(json_array_get(table(one, "cheapest"), 0), row);
    assert_int_equal(lines_of(cli_read("s/summary.csv")), 18 + 1);
    assert_true(cli_is_there("s/summary.tex"));
    assert_true(has_row(cli_read("s/summary.txt"), "example3 1e-02 "));
    assert_true(has_row(cli_read("s/summary.txt"), "example3: "));
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
        cmocka_unit_test(test_loads),          cmocka_unit_test(test_written),
        cmocka_unit_test(test_front),          cmocka_unit_test(test_rules),
        cmocka_unit_test(test_over_the_limit), cmocka_unit_test(test_unstable),
        cmocka_unit_test(test_zero_solution),  cmocka_unit_test(test_several_scenes),
        cmocka_unit_test(test_interrupt),
    };
    return cmocka_run_group_tests(tests, cli_make_folder, cli_remove_folder);
}
