/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The program as a user meets it: exit codes, messages, files. $BEAMRATE is its path. */
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli_driver.h"
#include "support.h"

/* A CSV file of cells without its timings: the column of seconds. */
static char *read_without_seconds(const char *name)
{
    char path[512], line[1024];
    char *text = NULL;
    size_t size;
    cli_path(name, path);
    FILE *in = fopen(path, "r"), *out = open_memstream(&text, &size);
    assert_non_null(in);
    assert_non_null(out);
    while (fgets(line, sizeof line, in)) {
        int column = 0;
        for (const char *c = line; *c; c++) {
            column += *c == ',';
            if (column != 16)
                fputc(*c, out);
        }
    }
    fclose(in);
    fclose(out);
    return text;
}

#define SMALL "--n 5,10 --k 0.1,0.05 --quiet --no-plots"

static void test_bad_scene(void **state)
{
    (void)state;
    cli_write_file("bad.yaml", "title: x\nlength: 1 m\nduration: 1 s\ndensity: 1 kg\n");
    cli_expect("study bad.yaml", NULL, 2,
               "bad.yaml:4: density: found '1 kg', which is a mass, expected a mass "
               "per length, as kg/m");
    cli_write_file("bad.yaml", "title: x\nlength: 1 m\ncolour: red\n");
    cli_expect("study bad.yaml", NULL, 2, "bad.yaml:3: colour: unknown key");
    char path[512];
    cli_path("bad.yaml", path);
    remove(path);
}

static void test_good_run(void **state)
{
    (void)state;
    cli_expect("study example2 --out r " SMALL " --contact implicit --friction regularised", NULL,
               0, "");
    static const char *const files[] = {"r/example2.txt", "r/example2.csv",  "r/example2.md",
                                        "r/example2.tex", "r/example2.json", "r/example2-fits.csv"};
    for (size_t i = 0; i < sizeof files / sizeof *files; i++)
        assert_true(cli_is_there(files[i]));
    assert_int_equal(cli_count_files("r"), 9);                /* no hidden folder is left */
    cli_expect("study example2 --out r " SMALL, NULL, 0, ""); /* replaces them */
    assert_int_equal(cli_count_files("r"), 9);
    cli_expect("study example3 --out one --format csv " SMALL, NULL, 0, "");
    assert_int_equal(cli_count_files("one"), 4); /* cells, slopes, fits, tips */
}

/* One cell contradicts nothing, and the table does not say that it does. */
static void test_single_cell(void **state)
{
    (void)state;
    static struct cli_outcome out;
    cli_run_line("tables --n 100 --k 0.01 --reference fine:200,0.005 --no-plots --out single", NULL,
                 &out);
    assert_int_equal(out.exit_code, 0);
    assert_non_null(strstr(out.output, "DIFFER"));
    assert_null(strstr(out.output, "No reference can repair"));
}

static void test_threads(void **state)
{
    (void)state;
    char *first = NULL;
    for (int threads = 1; threads <= 4; threads++) {
        char line[256];
        snprintf(line, sizeof line,
                 "tables --n 5,10,20 --k 0.1,0.05,0.01 --reference fine:40,0.01 --out threads "
                 "--quiet --no-plots --threads %d",
                 threads);
        cli_expect(line, NULL, 0, "");
        char *text = read_without_seconds("threads/table2.csv");
        if (first)
            assert_string_equal(text, first);
        else
            first = strdup(text);
        free(text);
    }
    free(first);
}

/* Where no picture can be written for want of room, the report is shown first. */
static void expect_shown(const char *line, const char *report)
{
    struct cli_outcome out;
    cli_run_line(line, &(struct cli_circumstances){.file_size = 1024}, &out);
    assert_int_equal(out.exit_code, 3);
    const char *shown = strstr(out.output, report);
    const char *failed = strstr(out.output, "could not be written whole");
    assert_true(shown && failed && shown < failed);
}

static void test_failures(void **state)
{
    (void)state;
    /* a disk that is full: exit code 3, and nothing half-written */
    cli_expect("study example1 --out full " SMALL, &(struct cli_circumstances){.file_size = 2048},
               3, "could not be written whole");
    assert_int_equal(cli_count_files("full"), 0);
    /* what was computed is on the terminal all the same, also of those that draw only */
    expect_shown("study example1 --out full --n 5,10 --k 0.1,0.05", "Example 1");
    expect_shown("trade example2 --methods euler+lagged -n 5,10 -k 0.1,0.05 --out full",
                 "Example 2");
    expect_shown("trade example2 --split --methods euler+lagged -n 5 -k 0.1,0.05 --out full",
                 "Example 2");
    /* no gnuplot: the plots are written, but not drawn */
    cli_expect("study example1 --out bare --n 5,10 --k 0.1,0.05 --quiet",
               &(struct cli_circumstances){.path = "/dev/null"}, 0, "gnuplot is not installed");
    assert_true(cli_is_there("bare/example1-h.gp") && !cli_is_there("bare/example1-h.png"));
    /* Ctrl-C: ends by the signal and leaves nothing */
    cli_expect("tables --out stopped --quiet", &(struct cli_circumstances){.interrupt_after = 700},
               -SIGINT, "interrupted; no file is half written");
    assert_int_equal(cli_count_files("stopped"), 0);
    /* a file where the folder should be */
    cli_write_file("file", "");
    cli_expect("study example1 --out file " SMALL, NULL, 2, "--out: cannot");
    /* a cell that blows up is marked, and told after all has been written */
    cli_write_file("stiff.yaml", "title: stiff\nlength: 1 m\nduration: 1000 s\ndensity: 1 kg/m\n"
                                 "axial:\n  stiffness: 1 N\n  viscosity: 0.1 N s\n  load: 1 [N/m]\n"
                                 "contact:\n  gap: 0.1 m\n  stiffness: 1000 N/m\n");
    cli_expect("study stiff.yaml --n 4 --k 1.25 --reference fine:4,0.01 --out s --quiet --no-plots",
               NULL, 3, "1 of 1 cells failed; the first is n = 4: the march blew up at t = ");
    assert_true(cli_is_there("s/stiff.csv"));
}

/* A report for each norm, and without a reference for each direction. */
static void test_norms(void **state)
{
    (void)state;
    cli_expect(
        "study example2 --norm energy,l2 --n 5,10 --k 0.1,0.05 --format csv --no-plots --quiet "
        "--out norms",
        NULL, 0, "");
    assert_int_equal(cli_count_files("norms"), 8);
    cli_expect("study example2 --norm energy,tip --reference none --n 5,10,20 --k 0.1,0.05 "
               "--format text --no-plots --out none",
               NULL, 0, "Example 2, slip: differences of successive time steps");
    assert_int_equal(cli_count_files("none"), 4);
    assert_true(cli_file_contains("none/example2-tip-meshes.txt", "Error at the tip"));
    assert_true(cli_file_contains("none/example2-energy-steps.txt", "Error (25)"));
}

/* A command's own help: both ways to it, two screens at most. */
static void test_command_help(void **state)
{
    (void)state;
    static const char *const commands[] = {"tables", "study",       "check",    "run",
                                           "trade",  "plan",        "extremes", "figures",
                                           "scenes", "completions", "help"};
    for (size_t i = 0; i < sizeof commands / sizeof *commands; i++) {
        static struct cli_outcome out, other;
        char line[64], usage[64];
        size_t lines = 0, width = 0;
        snprintf(line, sizeof line, "%s -h", commands[i]);
        snprintf(usage, sizeof usage, "Usage: beamrate %s ", commands[i]);
        cli_run_line(line, NULL, &out);
        assert_int_equal(out.exit_code, 0);
        assert_int_equal(strncmp(out.output, usage, strlen(usage)), 0);
        snprintf(line, sizeof line, "help %s", commands[i]);
        cli_run_line(line, NULL, &other);
        assert_string_equal(out.output, other.output);
        for (const char *c = out.output; *c; c += strcspn(c, "\n") + 1, lines++)
            width = strcspn(c, "\n") > width ? strcspn(c, "\n") : width;
        assert_true(lines <= 60 && width <= 100);
    }
}

/* Numbers of steps, and parts of the duration, are the same cells as seconds. */
static void test_steps(void **state)
{
    (void)state;
    static char seconds[1 << 16], other[1 << 16];
    static const char *const steps[] = {"-k 0.1,0.05", "-k T/10,T/20", "--steps 20,10"};
    for (size_t i = 0; i < 3; i++) {
        char line[256];
        snprintf(line, sizeof line, "study example2 -n 5,10 %s -q --no-plots --format csv -o st",
                 steps[i]);
        cli_expect(line, NULL, 0, "");
        char *text = read_without_seconds("st/example2.csv");
        snprintf(i ? other : seconds, sizeof other, "%s", text);
        free(text);
        if (i)
            assert_string_equal(seconds, other);
    }
    cli_expect("run example2 -n 5 -k T/10", NULL, 0, "\nsteps: 10\ntime step k: 0.1 s\n");
    cli_expect("run example2 -n 5 --steps 20", NULL, 0, "\nsteps: 20\ntime step k: 0.05 s\n");
    cli_expect("study example2 -n 5 -k T/10 --reference fine:10,T/20 -q --no-plots -o st", NULL, 0,
               "");
}

static void test_data_folder(void **state)
{
    (void)state;
    cli_expect("study example1 " SMALL, &(struct cli_circumstances){.data = cli_folder()}, 2,
               "is no file and no bundled scene");
}

/* Every kernel runs and is named in the results, or is refused where the machine has it not. */
static void test_kernels(void **state)
{
    (void)state;
    for (const struct br_kernel *const *k = br_kernels; *k; k++) {
        char line[256], text[64], json[64];
        snprintf(line, sizeof line,
                 "study example2 --out kernel --solver riccati --kernel %s " SMALL, (*k)->name);
        if (!(*k)->available()) {
            cli_expect(line, NULL, 2, "which this machine does not have, expected one of: ");
            continue;
        }
        cli_expect(line, NULL, 0, "");
        snprintf(text, sizeof text, "solver riccati on %s", (*k)->name);
        snprintf(json, sizeof json, "\"kernel\": \"%s\"", (*k)->name);
        assert_true(cli_file_contains("kernel/example2.txt", text));
        assert_true(cli_file_contains("kernel/example2.json", json));
    }
    cli_expect("study example2 --out kernel --reference-solver plain --reference fine:20,0.05 "
               "--kernel portable " SMALL,
               NULL, 0, "");
    assert_true(cli_file_contains("kernel/example2.json", "\"kernel\": \"portable\""));
    assert_true(cli_file_contains("kernel/example2.json", "\"kernel\": null"));
}

/* Ctrl-C reaches gnuplot, too: its failure must not hide that the user wanted to stop. */
static void test_interrupted_plots(void **state)
{
    (void)state;
    char path[1024], program[512];
    cli_path("bin", program);
    assert_int_equal(mkdir(program, 0777), 0);
    snprintf(path, sizeof path, "%s:/usr/bin:/bin", program);
    cli_write_file(
        "bin/gnuplot",
        "#!/bin/sh\n" /* one of those at work: a second Ctrl-C ends the program at once */
        "mkdir \"$0.pressed\" 2>/dev/null && kill -INT $PPID\nexit 1\n");
    cli_path("bin/gnuplot", program);
    assert_int_equal(chmod(program, 0755), 0);
    cli_expect("study example2 --n 5,10 --k 0.1,0.05 --quiet --out drawing",
               &(struct cli_circumstances){.path = path}, -SIGINT,
               "interrupted; no file is half written");
    assert_int_equal(cli_count_files("drawing"), 0);
}

/* A title with a format's own characters, in a file whose name is not UTF-8. */
static void test_odd_names(void **state)
{
    (void)state;
    cli_write_file("b\xe4m.yaml", "title: 'A_b *t* `s` <i>'\nlength: 1 m\nduration: 1 s\n"
                                  "density: 1 kg/m\naxial:\n  stiffness: 1 N\n  viscosity: 1 N s\n"
                                  "  load: 1 [N/m]\n");
    cli_expect("study b\xe4m.yaml --out odd " SMALL, NULL, 0, "");
    assert_true(cli_file_contains("odd/b_m.md", "# A\\_b \\*t\\* \\`s\\` \\<i\\>\n"));
    assert_true(cli_file_contains("odd/b_m.tex", "A\\_b *t*"));
    assert_true(cli_file_contains("odd/b_m.json", "\"name\": \"b_m\""));
    assert_true(cli_file_contains("odd/b_m.json", "\"scene_path\": \"b\\\\xe4m.yaml\""));
    assert_true(cli_file_contains("odd/b_m.json", "\"scene_text\": \"title: 'A_b"));
    assert_true(cli_file_contains("odd/b_m.json", "study b\\\\xe4m.yaml"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bad_scene),
        cmocka_unit_test(test_good_run),
        cmocka_unit_test(test_threads),
        cmocka_unit_test(test_single_cell),
        cmocka_unit_test(test_failures),
        cmocka_unit_test(test_command_help),
        cmocka_unit_test(test_steps),
        cmocka_unit_test(test_data_folder),
        cmocka_unit_test(test_interrupted_plots),
        cmocka_unit_test(test_odd_names),
        cmocka_unit_test(test_norms),
        cmocka_unit_test(test_kernels),
    };
    return cmocka_run_group_tests(tests, cli_make_folder, cli_remove_folder);
}
