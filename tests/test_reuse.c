/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is not computed anew, and what is: reports repeated, scenes with another value, work that is
 * kept and resumed. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli_driver.h"
#include "support.h"

static const char rod[] = "title: a rod\nlength: 1 m\nduration: 1 s\ndensity: 1 kg/m\naxial:\n"
                          "  stiffness: 100 N\n  viscosity: 1 N s\n  load: 10*t [N/m]\n";

/* A copy of a file in which each of a text is another one. */
static void write_replaced(const char *from, const char *to, const char *text, const char *instead)
{
    const char *rest = cli_read(from), *at;
    char *copy = calloc(4 * strlen(rest) + 1, 1);
    size_t found = 0;
    for (; (at = strstr(rest, text)); rest = at + strlen(text), found++) {
        strncat(copy, rest, (size_t)(at - rest));
        strcat(copy, instead);
    }
    strcat(copy, rest);
    cli_write_file(to, copy);
    free(copy);
    if (!found)
        fail_msg("no '%s' in %s", text, from);
}

/* ---- repeat ---- */

static void test_repeated(void **state)
{
    (void)state;
    cli_write_file("rod.yaml", rod);
    cli_expect("study rod.yaml -n 4,8,16 -k 0.1,0.05,0.025 --quiet --no-plots --out s", NULL, 0,
               "");
    cli_expect("repeat s/rod.json", NULL, 0, "values differs beyond its stated error or round-off");
    cli_expect("run example2 -n 4 -k 0.1 --contact implicit --json r.json --quiet", NULL, 0, "");
    cli_expect("repeat r.json", NULL, 0, "differs beyond");
    cli_expect("trade example2 --methods bdf2 -n 10 -k 0.1 --quiet --no-plots --out t", NULL, 0,
               "");
    cli_expect("repeat t/example2.json", NULL, 0, "None of 5 values");
    cli_expect("run rod.yaml -n 4 -k 0.1 --vary length=1,2 --quiet --out v", NULL, 0, "");
    cli_expect("repeat v/rod-length.json", NULL, 0, "differs beyond");
}

static void test_what_differs(void **state)
{
    (void)state;
    write_replaced("s/rod.json", "x.json", "\"error\": 0.0", "\"error\": 0.1");
    cli_expect("repeat x.json", NULL, 1, "values DIFFER beyond their stated error");
    cli_expect("repeat x.json", NULL, 1, "tables.cells[0].error");
    write_replaced("s/rod.json", "x.json", "\"fitted\": \"exact\"", "\"fitted\": \"fine\"");
    cli_expect("repeat x.json", NULL, 1, "fitted  fine  exact");
    write_replaced("r.json", "x.json", "\"closed\": true", "\"closed\": false");
    cli_expect("repeat x.json", NULL, 1, "tip.closed");
    write_replaced("r.json", "x.json", "\"step\": 10,", "\"stap\": 10,");
    cli_expect("repeat x.json", NULL, 1, "not there");
    cli_expect("check example3 --json c.json --quiet", NULL, 0, "");
    write_replaced("c.json", "x.json", "\"verdict\": \"PASS\"", "\"verdict\": \"FAIL\"");
    cli_expect("repeat x.json --quiet", NULL, 1, "values differ");
    write_replaced("s/rod.json", "x.json", "\"wall_seconds\": ", "\"wall_seconds\": 1");
    cli_expect("repeat x.json", NULL, 0, "differs beyond");
}

/* A number within the interval that is stated beside it is no difference, one outside is. */
static void test_stated_interval(void **state)
{
    (void)state;
    const char *q = strstr(cli_read("s/rod.json"), "\"extrapolated\": ");
    char was[80], now[80];
    if (!q)
        fail_msg("no extrapolated tip");
    const double value = strtod(q + strlen("\"extrapolated\": "), NULL);
    snprintf(was, sizeof was, "%.*s", (int)strcspn(q, ","), q);
    snprintf(now, sizeof now, "\"extrapolated\": %.17g", value * (1 + 1e-6));
    write_replaced("s/rod.json", "x.json", was, now);
    cli_expect("repeat x.json", NULL, 0, "differs beyond");
    snprintf(now, sizeof now, "\"extrapolated\": %.17g", value * 2);
    write_replaced("s/rod.json", "x.json", was, now);
    write_replaced("x.json", "x.json", "\"extrapolated_low\": 0.", "\"extrapolated_low\": 10.");
    cli_expect("repeat x.json", NULL, 1, "tables.tips[0].extrapolated");
}

/* The scene as it was is in the report. */
static void test_scene_that_has_changed(void **state)
{
    (void)state;
    write_replaced("rod.yaml", "rod.yaml", "100 N", "200 N");
    cli_expect("repeat s/rod.json", NULL, 0, "its text in the report was taken");
    cli_expect("repeat s/rod.json", NULL, 0, "differs beyond");
}

/* ---- a value of a scene that is varied ---- */

/* The table's row is what `run` finds of a file with that value. */
static void test_varied_as_written(void **state)
{
    (void)state;
    cli_write_file("rod.yaml", rod);
    write_replaced("rod.yaml", "stiff.yaml", "100 N", "250 N");
    cli_expect("run stiff.yaml -n 4 -k 0.1 --json one.json --quiet", NULL, 0, "");
    cli_expect("run rod.yaml -n 4 -k 0.1 --vary axial.stiffness=250 --quiet --out w", NULL, 0, "");
    const char *tip = strstr(cli_read("one.json"), "\"displacement\"");
    const char *axial = tip ? strstr(tip, "\"axial\": ") : NULL;
    char number[40] = "";
    if (axial)
        snprintf(number, sizeof number, "%.*s", (int)strcspn(axial + 9, ","), axial + 9);
    if (!*number || !cli_file_contains("w/rod-axial-stiffness.csv", number))
        fail_msg("no tip '%s' in the table", number);
}

/* Another place that an alias names keeps its value. */
static void test_varied_beside_alias(void **state)
{
    (void)state;
    cli_write_file("alias.yaml",
                   "title: both\nlength: 1 m\nduration: 1 s\ndensity: &one 0.1 kg/m\naxial:\n"
                   "  stiffness: &a 100 N\n  viscosity: 1 N s\n  load: 10*t [N/m]\n"
                   "friction:\n  law: tresca\n  bound: *a\nbending:\n  stiffness: 10 N m^2\n"
                   "  viscosity: 1 N m^2 s\n  load: 10*t [N/m]\n");
    cli_write_file("plain.yaml",
                   "title: both\nlength: 1 m\nduration: 1 s\ndensity: 0.1 kg/m\naxial:\n"
                   "  stiffness: 100 N\n  viscosity: 1 N s\n  load: 10*t [N/m]\n"
                   "friction:\n  law: tresca\n  bound: 1 N\nbending:\n  stiffness: 10 N m^2\n"
                   "  viscosity: 1 N m^2 s\n  load: 10*t [N/m]\n");
    const char *const line =
        "run %s.yaml -n 4 -k 0.1 --fields axial,bending --vary friction.bound=1,2 "
        "--quiet --out %s";
    char text[200], first[2000];
    snprintf(text, sizeof text, line, "alias", "a");
    cli_expect(text, NULL, 0, "");
    snprintf(text, sizeof text, line, "plain", "b");
    cli_expect(text, NULL, 0, "");
    snprintf(first, sizeof first, "%s", cli_read("a/alias-friction-bound.csv"));
    assert_string_equal(first, cli_read("b/plain-friction-bound.csv"));
}

/* ---- resume ---- */

#define VARIED                                                                                     \
    "study example2 -n 20,40,80,160 -k 0.02,0.01,0.005,0.0025 --solver umfpack --no-plots --vary " \
    "contact.stiffness=100,200,300,400,500,600,700,800 --format csv --out "

/* Stopped where some values are finished and some are not, then resumed: the same bits. The clock
 * says nothing of the time that another machine needs, so the wait grows until it is right. */
static void test_stopped_and_resumed(void **state)
{
    (void)state;
    static struct cli_outcome out;
    struct cli_circumstances c = {.interrupt_after = 40};
    char whole[4000];
    size_t kept = 0;
    cli_expect(VARIED "one", NULL, 0, "");
    const size_t all = cli_count_files("one/.kept");
    snprintf(whole, sizeof whole, "%s", cli_read("one/example2-contact-stiffness.csv"));
    for (; c.interrupt_after < 60000 && kept == 0; c.interrupt_after *= 2) {
        cli_run_line(VARIED "two", &c, &out);
        kept = cli_is_there("two/.kept") ? cli_count_files("two/.kept") : 0;
    }
    if (!(kept > 0 && kept < all) || out.exit_code == 0)
        fail_msg("%zu of %zu entries were kept: %s", kept, all, out.output);
    assert_false(cli_is_there("two/example2-contact-stiffness.csv"));
    cli_expect(VARIED "two --resume", NULL, 0,
               "finished cells, trials and cases taken from two/.kept");
    assert_string_equal(whole, cli_read("two/example2-contact-stiffness.csv"));
    assert_int_equal(cli_count_files("two/.kept"), all);
}

/* The clock of a trial is as it was, so the whole table is. */
static void test_trials_resumed(void **state)
{
    (void)state;
    static const char line[] = "trade example2 --methods bdf2 -n 10,20 -k 0.1,0.05 --no-plots "
                               "--format csv --out tr";
    static char whole[8000];
    char again[200];
    cli_expect(line, NULL, 0, "");
    snprintf(whole, sizeof whole, "%s", cli_read("tr/example2.csv"));
    snprintf(again, sizeof again, "%s --resume", line);
    cli_expect(again, NULL, 0, "finished cells, trials and cases taken from tr/.kept: 8");
    assert_string_equal(whole, cli_read("tr/example2.csv"));
}

/* Another method, another scene: none of the entries. */
static void test_not_resumed(void **state)
{
    (void)state;
    static struct cli_outcome out;
    const char *const line =
        "study rod.yaml -n 4,8 -k 0.1,0.05 --no-plots --format csv --out n --resume";
    cli_run_line(line, NULL, &out);
    assert_int_equal(out.exit_code, 0);
    assert_null(strstr(out.output, "were taken"));
    cli_expect(line, NULL, 0, "cases taken from n/.kept: 4");
    cli_run_line("study rod.yaml -n 4,8 -k 0.1,0.05 --scheme bdf2 --no-plots --format csv --out n "
                 "--resume",
                 NULL, &out);
    assert_null(strstr(out.output, "were taken"));
    write_replaced("rod.yaml", "rod.yaml", "10*t", "11*t");
    cli_run_line(line, NULL, &out);
    assert_null(strstr(out.output, "were taken"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_repeated),
        cmocka_unit_test(test_what_differs),
        cmocka_unit_test(test_stated_interval),
        cmocka_unit_test(test_scene_that_has_changed),
        cmocka_unit_test(test_varied_as_written),
        cmocka_unit_test(test_varied_beside_alias),
        cmocka_unit_test(test_stopped_and_resumed),
        cmocka_unit_test(test_trials_resumed),
        cmocka_unit_test(test_not_resumed),
    };
    return cmocka_run_group_tests(tests, cli_make_folder, cli_remove_folder);
}
