/* SPDX-License-Identifier: GPL-3.0-or-later */
/* `beamrate extremes` as a user runs it, with made parts (made_parts.c): what is refused, what is
 * written, and what an interruption leaves. $BEAMRATE is that program. */
#include <jansson.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>

#include "cli_driver.h"
#include "support.h"

/* What a part refuses or fails at says which part. */
static void test_failures(void **state)
{
    (void)state;
    cli_expect("extremes fast --seed 14", NULL, 2, "fast: 14 is refused");
    cli_expect("extremes fast --seed 15", NULL, 3, "fast: 15 failed");
    assert_false(cli_is_there("extremes"));
}

static void test_asked(void **state)
{
    (void)state;
    cli_expect("extremes fast --quiet", NULL, 0, "");
    assert_true(cli_file_contains("extremes/fast.txt",
                                  "cases 0, seed 0, threads 0, rounding 0, 0 n up to 0, 0 k, kept "
                                  "nowhere"));
    cli_expect("extremes fast --cases 7 --seed 9000000000000000 --threads 2 --n 10,20 --k 0.1 "
               "--no-plots --out o",
               NULL, 0,
               "cases 7, seed 9000000000000000, threads 2, rounding 0, 2 n up to 20, "
               "1 k");
    cli_expect("extremes slow fast --cases 1 --no-plots --out both", NULL, 0, "A made part");
    assert_true(cli_is_there("both/slow.md") && cli_is_there("both/fast.md"));
    static const char *const modes[] = {"up", "down", "zero"};
    for (size_t i = 0; i < 3; i++) {
        char line[128];
        snprintf(line, sizeof line, "extremes fast --rounding %s --no-plots --out o", modes[i]);
        cli_expect(line, NULL, 0, "cases 0");
        assert_false(cli_file_contains("o/fast.txt", "rounding 0"));
    }
}

static void test_files(void **state)
{
    (void)state;
    cli_expect("extremes fast --out files", NULL, 0, "Written to files/");
    static const char *const all[] = {
        "fast.txt",      "fast.csv",       "fast.md",      "fast.tex",      "fast.json",
        "fast-chart.gp", "fast-chart.dat", "fast-heat.gp", "fast-heat.dat", "report.html"};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        char name[64];
        snprintf(name, sizeof name, "files/%s", all[i]);
        if (!cli_is_there(name))
            fail_msg("%s is not there", name);
    }
    char path[512];
    cli_path("files/fast.json", path);
    json_t *root = json_load_file(path, 0, NULL);
    assert_non_null(root);
    assert_string_equal(json_string_value(json_object_get(root, "name")), "fast");
    assert_string_equal(json_string_value(json_object_get(root, "format")),
                        "beamrate extremes made");
    const json_t *pictures_of = json_object_get(root, "pictures");
    assert_int_equal(json_array_size(pictures_of), 2);
    assert_string_equal(json_string_value(json_object_get(json_array_get(pictures_of, 1), "stem")),
                        "fast-heat");
    const json_t *made = json_object_get(root, "provenance");
    assert_non_null(strstr(json_string_value(json_object_get(made, "command_line")),
                           "extremes fast --out files"));
    json_decref(root);
    size_t pictures = 0; /* gnuplot may be missing, or its terminal for PDF */
    pictures += cli_is_there("files/fast-heat.svg") ? 4 : 0;
    pictures += cli_is_there("files/fast-heat.pdf") ? 2 : 0;
    assert_int_equal(cli_count_files("files"), 10 + pictures);
    cli_expect("extremes fast --out some --format csv,json --no-plots --quiet", NULL, 0, "");
    assert_int_equal(cli_count_files("some"), 2);
}

/* All is written, and then the verdict told. */
static void test_verdict(void **state)
{
    (void)state;
    cli_expect("extremes fast slow --seed 13 --cases 2 --no-plots --out wrong", NULL, 1,
               "fast: 13 is silently wrong");
    assert_true(cli_file_contains("wrong/fast-13.yaml", "a reproducer"));
    assert_true(cli_is_there("wrong/slow.json"));
}

/* Whole or not at all, but what was done is kept, and not done again where that is asked for. */
static void test_interrupted(void **state)
{
    (void)state;
    static const struct cli_circumstances soon = {.interrupt_after = 300};
    static struct cli_outcome out;
    cli_run_line("extremes fast slow --cases 1000 --quiet --out late", &soon, &out);
    assert_int_equal(out.exit_code, -SIGINT);
    assert_true(cli_is_there("late/.kept"));
    assert_int_equal(cli_count_files("late"), 0);
    cli_expect("extremes slow --cases 3 --resume --out late --format text", NULL, 0,
               "something was done before, and is 3 cases now");
    cli_expect("extremes slow --cases 3 --out late --format text", NULL, 0,
               "nothing was done before, and is 3 cases now");
    assert_int_equal(cli_count_files("late"), 1);
    assert_true(cli_is_there("late/slow.txt"));
}

/* A full disk, no place to write, no gnuplot. */
static void test_circumstances(void **state)
{
    (void)state;
    static const struct cli_circumstances full = {.file_size = 256}, bare = {.path = "/nowhere"};
    cli_expect("extremes fast --no-plots --quiet --out full", &full, 3,
               "could not be written whole");
    assert_false(cli_is_there("full"));
    cli_expect("extremes fast --out full", &full, 3, "cases 0, seed 0"); /* shown, then drawn */
    cli_expect("extremes fast --out /proc/nowhere", NULL, 2, "--out: cannot make the folder");
    cli_expect("extremes fast --quiet --out bare", &bare, 0, "gnuplot is not installed");
    assert_true(cli_is_there("bare/fast-heat.gp") && !cli_is_there("bare/fast-heat.png"));
    cli_write_file("file", "");
    cli_expect("extremes fast --out file", NULL, 2, "--out: cannot");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_failures),    cmocka_unit_test(test_asked),
        cmocka_unit_test(test_files),       cmocka_unit_test(test_verdict),
        cmocka_unit_test(test_interrupted), cmocka_unit_test(test_circumstances),
    };
    return cmocka_run_group_tests(tests, cli_make_folder, cli_remove_folder);
}
