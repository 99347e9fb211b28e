/* SPDX-License-Identifier: GPL-3.0-or-later */
/* `beamrate trade` as a user runs it: what is refused, and what golden/ does not hold of what is
 * shown and written. */
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

/* What is left out for time is said before and after; lists that are given are tried whole. */
static void test_left_out(void **state)
{
    (void)state;
    cli_expect("trade example2 --methods bdf2 --n 8 --k 0.1,0.01 --seconds 1e-6 --out b --no-plots",
               NULL, 0, "left out, the dearest first: 1, --seconds 1 has all");
    assert_true(cli_file_contains("b/example2.txt", "Trials: 1 done, 1 left out."));
    assert_true(cli_file_contains("b/example2.txt",
                                  "Left out for time, the dearest first: 1 of 2 trials, about "));
    assert_true(cli_file_contains("b/example2.csv", ",left out,false,false,"));
    assert_false(cli_file_contains("b/example2.txt", "did not come to their end"));
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
        cmocka_unit_test(test_loads),          cmocka_unit_test(test_rules),
        cmocka_unit_test(test_over_the_limit), cmocka_unit_test(test_left_out),
        cmocka_unit_test(test_unstable),       cmocka_unit_test(test_zero_solution),
        cmocka_unit_test(test_interrupt),
    };
    return cmocka_run_group_tests(tests, cli_make_folder, cli_remove_folder);
}
