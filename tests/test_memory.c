/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The n-th allocation of the whole process fails, also in libraries: exit code 3 and its name, or
 * the same results. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli_driver.h"
#include "support.h"

static struct cli_outcome out;

/* What a command writes, without its numbers: jansson would forget members. */
static void take_results(char results[CLI_MOST_OUTPUT])
{
    char command[600];
    snprintf(command, sizeof command,
             "cd '%s' && cat set/*.csv set.json 2>/dev/null | sed -E 's/[0-9.e+-]*[0-9]//g'",
             cli_folder());
    FILE *pipe = popen(command, "r");
    assert_non_null(pipe);
    results[fread(results, 1, CLI_MOST_OUTPUT - 1, pipe)] = '\0';
    pclose(pipe);
}

static bool is_named(const char *said)
{
    return strstr(said, "out of memory") || strstr(said, "Cannot allocate memory");
}

/* The n-th fails, n = 1, 1 + every... up to the last one; how many did. timed: which rows there are
 * depends on the clock, and a trial without memory is a row that says so. */
static size_t sweep(const char *line, long every, bool timed)
{
    static char expected[CLI_MOST_OUTPUT], results[CLI_MOST_OUTPUT];
    char fault[64], record[512], clear[600];
    size_t failures = 0;
    cli_path("reached", record);
    setenv("BR_FAULT_LOG", record, 1);
    snprintf(clear, sizeof clear, "cd '%s' && exec rm -rf set set.json reached", cli_folder());
    assert_int_equal(system(clear), 0);
    cli_expect(line, NULL, 0, "");
    take_results(expected);
    for (long n = 1;; n += every) {
        assert_int_equal(system(clear), 0);
        snprintf(fault, sizeof fault, "memory %ld fail", n);
        setenv("BR_FAULT", fault, 1);
        cli_run_line(line, NULL, &out);
        unsetenv("BR_FAULT");
        if (!cli_is_there("reached"))
            break;
        failures += out.exit_code == 3;
        if (out.exit_code == 0)
            take_results(results);
        if (out.exit_code == 0 ? (timed ? !*results : strcmp(results, expected) != 0)
                               : out.exit_code != 3 || !is_named(out.output))
            fail_msg("beamrate %s: allocation %ld: exit code %d: %s\n%s", line, n, out.exit_code,
                     out.output, out.exit_code ? "" : results);
    }
    assert_true(failures > 0);
    return failures;
}

static const char small[] =
    "title: small\nlength: 1 m\nduration: 1 s\ndensity: 1 kg/m\naxial:\n  stiffness: 1 N\n"
    "  viscosity: 1 N s\n  load: t [N/m]\nverify:\n  space:\n    n: 2, 4, 8, 16, 32\n    k: 0.1 s\n"
    "    l2: 2 +- 0.9\n";

TEST(test_sweep)
{
    static const struct {
        const char *line;
        long every; /* by default; 0: only where everything is tested */
        bool timed;
    } runs[] = {
        {"scenes --new set.json", 1, false},
        {"run small.yaml --n 4 --k 0.1 --quiet --json set.json", 47, false},
        {"run small.yaml --n 4 --k 0.1 --quiet --out set", 195, false},
        {"study small.yaml --n 2,4 --k 0.1,0.05 --reference fine:8,0.025 --format csv --no-plots --quiet --out set",
         15, false}, /* lists of sets */
        {"study small.yaml --n 2,4 --k 0.1,0.05 --no-plots --quiet --out set", 75, false},
        {"check small.yaml --quiet --json set.json", 75, false},
        {"check small.yaml --quiet --compare old.json", 75, false},
        {"tables --n 2,4 --k 0.5,0.25 --reference fine:8,0.25 --no-plots --quiet --out set", 0,
         false},
        {"trade small.yaml --error 1e-1 --methods euler --quiet --out set", 795, true},
        {"trade small.yaml --methods euler,bdf2 --n 4 --k 0.1 --no-plots --quiet --out set", 311,
         true},
        {"trade small.yaml --split --n 4 --k 0.1 --no-plots --quiet --out set", 587, true},
        {"extremes stability small.yaml --n 4 --k 0.5,0.1 --no-plots --quiet --out set", 167,
         false},
        {"extremes steps small.yaml --k 0.1 --no-plots --quiet --out set", 159, false},
        {"extremes floors small.yaml --n 4 --k 0.1 --no-plots --quiet --out set", 147, false},
        {"orders table.csv --value drag --no-plots --quiet --out set", 59, false},
        {"orders run.yaml --trust --no-plots --quiet --out set", 227, false},
    };
    cli_write_file("small.yaml", small);
    cli_write_file("table.csv", "n,l2,drag\n10,1,3\n20,.25,2\n40,.0625,1.7\n80,.015625,1.6\n");
    cli_write_file("run.yaml", "title: a run\nrun: expr 1024 / {n}\nn: 2, 4, 8, 16\n"
                               "read: {l2: \"(.*)\"}\nverify: {l2: h 1 +- 0.1}\n");
    cli_expect("check small.yaml --quiet --json old.json", NULL, 0, "");
    for (size_t i = 0; i < sizeof runs / sizeof *runs; i++) {
        if (!runs[i].every && !br_test_long())
            continue;
        const size_t failures =
            sweep(runs[i].line, br_test_long() ? 1 : runs[i].every, runs[i].timed);
        print_message("# %s: %zu failures\n", runs[i].line, failures);
    }
}

AROUND_TESTS(cli_make_folder, cli_remove_folder)
