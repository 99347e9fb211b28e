/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The program under mpirun, on one machine: the same bits as one process, one voice, exit codes,
 * and ranks that die. $MPIRUN and $PROGRAM are paths. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli_driver.h"
#include "support.h"

/* Where one rank ends with an error, mpirun asks the others to end, sleeps for a second, and kills
 * them; here it need not sleep. */
#define KILL_AFTER "OMPI_MCA_odls_base_sigkill_timeout"

static struct cli_outcome out, other;

/* Runs the program on so many ranks, or, for 0, without mpirun. Standard error is apart: it comes
 * by another way, and mpirun may add to it. */
static void run(int ranks, const char *line, struct cli_outcome *outcome)
{
    char whole[1024];
    setenv("BEAMRATE", ranks ? getenv("MPIRUN") : getenv("PROGRAM"), 1);
    if (ranks)
        snprintf(whole, sizeof whole, "--oversubscribe -n %d %s %s", ranks, getenv("PROGRAM"),
                 line);
    else
        snprintf(whole, sizeof whole, "%s", line);
    cli_run_line(whole, &(struct cli_circumstances){.errors = "errors"}, outcome);
}

static void expect_exit(const struct cli_outcome *outcome, int code)
{
    if (outcome->exit_code != code)
        fail_msg("exit code %d, expected %d; it said:\n%s\n%s", outcome->exit_code, code,
                 outcome->output, cli_read("errors"));
}

static void expect_error(const char *message)
{
    if (!strstr(cli_read("errors"), message))
        fail_msg("expected '%s', found:\n%s", message, cli_read("errors"));
}

/* Hours of work, of which each rank has a share: whatever happens to it, happens before its end. */
static const char *const hours =
    "study example2 --n 800,1600,3200 --k 1e-7,1.25e-7,2e-7,2.5e-7 --reference fine:3200,2.5e-8 "
    "--quiet --no-plots --threads 1 --out";

/* Runs hours of work on 4 ranks, and does something to rank 2 once its thread that marches is
 * there: MPI has started by then, and the program heeds signals. `$$` becomes the program, and
 * `$PPID` is mpirun. */
static void run_with(const char *deed, const char *folder, struct cli_outcome *outcome)
{
    char script[1024];
    setenv("BEAMRATE", getenv("MPIRUN"), 1);
    snprintf(script, sizeof script,
             "if [ \"$OMPI_COMM_WORLD_RANK\" = 2 ]; then (while [ -d /proc/$$ ]; do "
             "if cat /proc/$$/task/*/comm 2>&- | grep -qx march; then %s; exit; fi; sleep 0.02; "
             "done) & fi; exec '%s' %s %s",
             deed, getenv("PROGRAM"), hours, folder);
    const char *const word[] = {
        "--oversubscribe", "--timeout", "900", "-n", "4", "sh", "-c", script, NULL};
    cli_run(word, &(struct cli_circumstances){.errors = "errors"}, outcome);
    snprintf(script, sizeof script, "%s/example2.csv", folder);
    assert_false(cli_is_there(script));
}

static size_t count(const char *text, const char *part)
{
    size_t found = 0;
    for (const char *at = text; (at = strstr(at, part)); at += strlen(part))
        found++;
    return found;
}

/* ---- the same bits ---- */

/* The files of one process and of many ranks, without times, dates and the command: lines of JSON,
 * or the column of a CSV file whose heading says so. */
static void expect_same_file(const char *name, const char *extension)
{
    static const char drop[] =
        "FILENAME ~ /json$/ { if (!/seconds|date|command|threads/) print; next }"
        "FNR == 1 { for (i = 1; i <= NF; i++) if ($i == \"seconds [s]\") c = i }"
        "{ if (c) $c = \"\"; print }";
    char script[1024];
    snprintf(script, sizeof script,
             "cd '%s' && for d in one many; do awk -F, '%s' $d/%s.%s >$d.seen || exit; done && "
             "test $(wc -c <one.seen) -gt 100 && cmp one.seen many.seen",
             cli_folder(), drop, name, extension);
    if (system(script) != 0)
        fail_msg("%s.%s is another one", name, extension);
}

static void test_same_bits(void **state)
{
    (void)state;
    static const struct {
        const char *line, *name[3];
    } rows[] = {
        {"tables --n 10,20,40 --k 0.02,0.01,0.005 --reference fine:160,1e-3 --norm l2,energy",
         {"table1", "table2", "table2-energy"}},
        {"study example3 --n 10,15,40 --k 0.02,0.01,0.005", {"example3"}}, /* slices */
    };
    static const int ranks[] = {2, 8}, threads[] = {2, 1};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        for (size_t j = 0; j < 2; j++) {
            char line[512];
            snprintf(line, sizeof line, "%s --no-plots --out one --threads 1", rows[i].line);
            if (j == 0)
                run(0, line, &out);
            snprintf(line, sizeof line, "%s --no-plots --out many --threads %d", rows[i].line,
                     threads[j]);
            run(ranks[j], line, &other);
            expect_exit(&out, 0);
            expect_exit(&other, 0);
            assert_int_equal(count(other.output, "Written to"), 1);
            for (size_t f = 0; f < 3 && rows[i].name[f]; f++) {
                expect_same_file(rows[i].name[f], "csv");
                expect_same_file(rows[i].name[f], "json");
            }
        }
}

/* The verdicts and orders: what stands before and after them has times. */
static void test_check(void **state)
{
    (void)state;
    static const struct {
        const char *line;
        int ranks, exit_code;
    } rows[] = {{"check example3 --quiet --markdown -", 3, 0},
                {"check example1 --contact implicit --quiet --markdown -", 2, 1}};
    for (size_t i = 0; i < 2; i++) {
        run(0, rows[i].line, &out);
        expect_exit(&out, rows[i].exit_code);
        run(rows[i].ranks, rows[i].line, &other);
        expect_exit(&other, rows[i].exit_code);
        assert_int_equal(count(cli_read("errors"), "beamrate:"), rows[i].exit_code);
        const char *begin = strstr(out.output, "## Verdicts"),
                   *end = strstr(out.output, "\nbeamrate "),
                   *same = strstr(other.output, "## Verdicts");
        assert_true(begin && end > begin + 100 && same);
        assert_int_equal(count(other.output, "## All orders"), 1);
        if (i == 0 && strncmp(begin, same, (size_t)(end - begin)) != 0)
            fail_msg("%s\nis not\n%s", out.output, other.output);
    }
}

/* Every command works among ranks, or is refused with its reason. */
static void test_all_commands(void **state)
{
    (void)state;
    static const char disturb[] = "2 ranks, which disturb each other's times";
    static const struct {
        const char *line;
        int exit_code;
        const char *says; /* of the output, or of standard error after a refusal */
    } rows[] = {
        {"tables --n 10,20 --k 0.02,0.01 --reference fine:40,5e-3", 0, "Table 2"},
        {"study example2 --n 10,20 --k 0.1,0.05 --set title=Other", 0, "with title=Other"},
        {"check example3 --json -", 0, "beamrate check"},
        {"check runs.yaml --trust", 2, disturb},
        {"orders errors.csv", 2, disturb},
        {"run example2 --n 40 --k 0.01", 0, "Example 2"},
        {"run example2 --n 10 --k 0.1 --set title=Other", 0, "with title=Other"},
        {"trade example2", 2, disturb},
        {"extremes floors", 2, "found 2 ranks, expected one"},
        {"figures --quiet --out figures", 0, ""},
        {"scenes", 0, "example2 "},
        {"completions bash", 0, "beamrate"},
        {"help", 0, "Commands:"},
    };
    cli_write_file("errors.csv", "n,e\n1,1\n2,.25\n4,.0625\n8,.015625\n");
    cli_write_file("runs.yaml", "run: touch ran.{n}\nn: 1,2,4,8\nread: {x: x=(.*)}\n"
                                "verify: {x: h 2 +- 1}\n");
    run(0, "help", &out);
    char *commands = strstr(out.output, "\nCommands:\n"), *rest;
    assert_non_null(commands);
    *strstr(commands, "\n\n") = '\0'; /* the last is the end of the list */
    for (char *line = strtok_r(strchr(commands + 1, '\n'), "\n", &rest); line;
         line = strtok_r(NULL, "\n", &rest)) {
        bool tried = false;
        const size_t length = strcspn(line + 2, " ");
        for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
            tried |= strncmp(rows[i].line, line + 2, length) == 0;
        if (!tried)
            fail_msg("not tried among ranks: %s", line);
    }
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        run(2, rows[i].line, &other);
        if (other.exit_code != rows[i].exit_code)
            fail_msg("%s: exit code %d\n%s", rows[i].line, other.exit_code, cli_read("errors"));
        if (!strstr(rows[i].exit_code ? cli_read("errors") : other.output, rows[i].says))
            fail_msg("%s: found\n%s\n%s", rows[i].line, other.output, cli_read("errors"));
    }
    assert_true(cli_is_there("figures/claims.csv"));
    setenv("FOLDER", cli_folder(), 1);
    run(0, "run example3 --n 40 --k 0.01 --quiet --json one.json", &out);
    run(3, "run example3 --n 40 --k 0.01 --quiet --json many.json", &other);
    expect_exit(&other, 0);
    assert_int_equal(
        system("cd \"$FOLDER\" && for f in one many; do grep -vE 'seconds|command|date|"
               "wall|set_up|march|per_' $f.json >$f.seen; done; cmp one.seen many.seen"),
        0);
}

/* ---- one voice ---- */

static void test_bad_input(void **state)
{
    (void)state;
    static const char *const rows[] = {
        "study nowhere", "study example1 --n 10 --k .1 --reference fine:100,.04 --out none",
        "study example1 --out /proc/nowhere", "--version"};
    for (size_t i = 0; i < 4; i++) {
        run(3, rows[i], &out);
        expect_exit(&out, i < 3 ? 2 : 0);
        assert_int_equal(
            count(i < 3 ? cli_read("errors") : out.output, i < 3 ? "beamrate:" : "beamrate "), 1);
    }
    assert_false(cli_is_there("none"));
}

/* One rank alone cannot read the scene. */
static void test_other_files(void **state)
{
    (void)state;
    setenv("BEAMRATE", getenv("MPIRUN"), 1);
    char script[512];
    cli_write_file("scene.yaml", "title: x\nlength: 1 m\nduration: 1 s\ndensity: 1 kg/m\n"
                                 "axial: {stiffness: 1000 N, viscosity: 1 N s, load: 'x [N/m]'}\n");
    cli_write_file("other.yaml",
                   "title: x\nlength: 1 m\nduration: 1 s\ndensity: 1 kg/m\n"
                   "axial: {stiffness: 1000 N, viscosity: 1 N s, load: 'x^2 [N/m]'}\n");
    static const struct {
        const char *name, *message;
        int code;
    } rows[] = {{"other.yaml", "rank 1 was asked for other studies than rank 0", 2},
                {"none.yaml", "rank 1: 'none.yaml' is neither a file nor a bundled scene", 2}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        snprintf(
            script, sizeof script,
            "f=scene.yaml; [ $OMPI_COMM_WORLD_RANK = 0 ] || f=%s; exec '%s' study $f --out mixed",
            rows[i].name, getenv("PROGRAM"));
        const char *const word[] = {"--oversubscribe", "-n", "2", "sh", "-c", script, NULL};
        cli_run(word, &(struct cli_circumstances){.errors = "errors"}, &out);
        expect_exit(&out, rows[i].code);
        expect_error(rows[i].message);
        assert_false(cli_is_there("mixed"));
    }
}

/* ---- ranks that die ---- */

static void test_killed(void **state)
{
    (void)state;
    run_with("kill -KILL $$", "killed",
             &out); /* mpirun then kills rank 0: the folder may be left */
    assert_true(out.exit_code > 0);
    expect_error("rank 2");
}

/* As where a machine hangs, or a launcher does not see that a rank is gone. */
static void test_silent(void **state)
{
    (void)state;
    static const char *const seconds[] = {"1.5", "15", "150"}; /* a loaded machine wants more */
    for (int i = 0; i < 3 && (i == 0 || !strstr(cli_read("errors"), "rank 2 has not")); i++) {
        setenv("BEAMRATE_SILENCE", seconds[i], 1);
        run_with("kill -STOP $$", "silent", &out);
    }
    unsetenv("BEAMRATE_SILENCE");
    if (!strstr(cli_read("errors"), "libopen-rte")) /* mpirun itself may crash when all ends so */
        expect_exit(&out, 3);
    expect_error("rank 2 has not been heard from");
    assert_false(cli_is_there("silent"));
}

/* A rank that is told to end, and mpirun, too. */
static void test_interrupted(void **state)
{
    (void)state;
    run_with("kill -TERM $$", "ended", &out);
    assert_true(out.exit_code != 0);
    assert_int_equal(count(cli_read("errors"), "interrupted; no file is half written"), 1);
    assert_false(cli_is_there("ended"));
    unsetenv(KILL_AFTER);
    run_with("kill -INT $PPID", "ended", &out);
    setenv(KILL_AFTER, "0", 1);
    assert_true(out.exit_code != 0);
}

/* Where a launcher is there, but MPI knows nothing of it. */
static void test_not_joined(void **state)
{
    (void)state;
    setenv("SLURM_STEP_NUM_TASKS", "4", 1);
    setenv("SLURM_PROCID", "0", 1);
    run(0, "study example1 --out alone", &out);
    unsetenv("SLURM_STEP_NUM_TASKS");
    unsetenv("SLURM_PROCID");
    expect_exit(&out, 2);
    expect_error("started by srun (Slurm) as one of 4 processes, but ");
    assert_false(cli_is_there("alone"));
}

static void test_under_mpirun(void **state)
{
    (void)state;
    SKIP("no mpirun, or a program without MPI");
}

int main(void)
{
    /* In a container one is root; on a desktop a rank may not have a core of its own. */
    setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 1);
    setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 1);
    setenv(KILL_AFTER, "0", 1);
    const struct CMUnitTest with_mpi[] = {
        cmocka_unit_test(test_same_bits),    cmocka_unit_test(test_check),
        cmocka_unit_test(test_all_commands), cmocka_unit_test(test_bad_input),
        cmocka_unit_test(test_other_files),  cmocka_unit_test(test_killed),
        cmocka_unit_test(test_silent),       cmocka_unit_test(test_interrupted),
        cmocka_unit_test(test_not_joined),
    };
    const struct CMUnitTest without[] = {cmocka_unit_test(test_not_joined),
                                         cmocka_unit_test(test_under_mpirun)};
    return getenv("MPIRUN") ? cmocka_run_group_tests(with_mpi, cli_make_folder, cli_remove_folder)
                            : cmocka_run_group_tests(without, cli_make_folder, cli_remove_folder);
}
