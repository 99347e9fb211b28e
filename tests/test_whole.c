/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A set of results is the old one or the new one, wherever the program is ended. */
#include <errno.h>
#include <fcntl.h>
#include <jansson.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "cli/output.h"
#include "cli_driver.h"
#include "support.h"

static struct cli_outcome out;

/* Two commands whose sets share some names, and not all. */
static const char old_line[] = "study summary.yaml --n 4 --k 0.1 --no-plots --quiet --out set",
                  new_line[] = "run example1 --n 4 --k 0.1 --quiet --out set";

/* Runs a line with a fault; returns whether the call was reached. */
static bool run_with(const char *line, const char *kind, long n, const char *what)
{
    char fault[64], record[512];
    cli_path("reached", record);
    unlink(record);
    snprintf(fault, sizeof fault, "%s %ld %s", kind, n, what);
    setenv("BR_FAULT", fault, 1);
    setenv("BR_FAULT_LOG", record, 1);
    cli_run_line(line, NULL, &out);
    unsetenv("BR_FAULT");
    return cli_is_there("reached");
}

static void shell(const char *line)
{
    char command[1200];
    snprintf(command, sizeof command, "cd '%s' && %s", cli_folder(), line);
    assert_int_equal(system(command), 0);
}

static void clear_set(void)
{
    shell("rm -rf set && mkdir set");
}

/* ---- the reader of a set ---- */

/* Checksums of the folder's files, by another program: lines of sum, blanks, name. */
static const char *sums(void)
{
    static char lines[8192];
    char command[600], path[512];
    cli_path("set", path);
    snprintf(command, sizeof command, "cd '%s' && sha256sum -- *", path);
    FILE *pipe = popen(command, "r");
    assert_non_null(pipe);
    lines[fread(lines, 1, sizeof lines - 1, pipe)] = '\0';
    assert_int_equal(pclose(pipe), 0);
    return lines;
}

/* The command that wrote the set, which must be whole and alone in the folder; '-': no set. */
static char set_that_is_there(void)
{
    char path[512];
    cli_path("set/manifest.json", path);
    json_t *manifest = json_load_file(path, 0, NULL);
    if (!manifest)
        return '-';
    const json_t *set = json_array_get(json_object_get(manifest, "sets"), 0);
    const json_t *files = json_object_get(set, "files");
    assert_int_equal(json_array_size(json_object_get(manifest, "sets")), 1);
    const size_t count = json_array_size(files);
    assert_true(count > 0);
    const char *lines = sums();
    for (size_t i = 0; i < count; i++) {
        const json_t *file = json_array_get(files, i);
        char line[400];
        snprintf(line, sizeof line, "%s  %s\n", json_string_value(json_object_get(file, "sha256")),
                 json_string_value(json_object_get(file, "name")));
        if (!strstr(lines, line))
            fail_msg("not as the manifest says: %s", line);
    }
    const char *command = json_string_value(json_object_get(set, "command"));
    const char which = strstr(command, " study ") ? 's' : 'r';
    const size_t hidden = cli_is_there("set/.beamrate");
    assert_int_equal(cli_count_files("set"), count + hidden);
    json_decref(manifest);
    return which;
}

/* The first thing that the next command does. */
static enum br_status sweep(void)
{
    struct br_error err;
    char path[512];
    cli_path("set", path);
    const int folder = open(path, O_RDONLY | O_DIRECTORY);
    assert_true(folder >= 0);
    const enum br_status status = br_output_sweep(folder, &err);
    close(folder);
    return status;
}

/* ---- ended anywhere ---- */

static void make_old(void)
{
    if (cli_is_there("old")) {
        shell("rm -rf set && cp -r old set");
        return;
    }
    clear_set();
    cli_expect(old_line, NULL, 0, "");
    assert_int_equal(set_that_is_there(), 's');
    shell("cp -r set old");
}

/* Applies the fault to call n = 1, 1 + every, ..., until no call n is reached. Each time the folder
 * has the old set, the new one, or none; after the sweep it has the new one if that was decided. */
static size_t try_everywhere(const char *what, long every)
{
    size_t sets[3] = {0};
    long n = 1;
    for (;; n += every) {
        make_old();
        if (!run_with(new_line, "disk", n, what))
            break;
        const char before = set_that_is_there();
        const bool decided = cli_is_there("set/.beamrate/.manifest");
        assert_int_equal(sweep(), BR_OK);
        const char after = set_that_is_there();
        if (after != (decided || before == 'r' ? 'r' : 's') || (before == '-' && !decided))
            fail_msg("disk %ld %s: %c, then %c: %s", n, what, before, after, out.output);
        if (strcmp(what, "kill") != 0 && out.exit_code == 0 && after != 'r')
            fail_msg("disk %ld %s: exit code 0 without the new set", n, what);
        if (strcmp(what, "kill") != 0 && out.exit_code != 0 && out.exit_code != 3)
            fail_msg("disk %ld %s: exit code %d: %s", n, what, out.exit_code, out.output);
        assert_false(cli_is_there("set/.beamrate"));
        sets[before == 's' ? 0 : before == 'r' ? 1 : 2]++;
    }
    assert_int_equal(set_that_is_there(), 'r');
    print_message("# %s, %ld calls: %zu left the old set, %zu the new one, %zu the decision\n",
                  what, n - 1, sets[0], sets[1], sets[2]);
    return sets[0] * sets[1] * sets[2];
}

TEST(test_killed)
{
    assert_true(try_everywhere("kill", 1) > 0); /* each of the three happened */
}

TEST(test_broken_disk)
{
    assert_true(try_everywhere("fail", br_test_long() ? 1 : 3) > 0);
}

/* The disk fails for good, then is mended. */
TEST(test_dead_disk)
{
    assert_true(try_everywhere("from", br_test_long() ? 1 : 4) > 0);
}

/* A signal always has an effect: it stops the work, or is reported when all is written. */
TEST(test_stopped)
{
    size_t in_time = 0, late = 0;
    for (long n = 1;; n++) {
        make_old();
        if (!run_with(new_line, "disk", n, "stop"))
            break;
        const bool written = set_that_is_there() == 'r';
        const char *said = written ? "interrupted when all was written" : "no file is half written";
        if (out.exit_code != -SIGTERM || !strstr(out.output, said) || cli_is_there("set/.beamrate"))
            fail_msg("disk %ld stop: exit code %d: %s", n, out.exit_code, out.output);
        *(written ? &late : &in_time) += 1;
    }
    print_message("# stop: %zu in time, %zu late\n", in_time, late);
    assert_true(in_time > 0 && late > 0);
}

/* ---- two at once ---- */

static pid_t start_slow(const char *line)
{
    const pid_t child = fork();
    assert_true(child >= 0);
    if (child)
        return child;
    run_with(line, "disk", 0, "slow");
    _exit(out.exit_code);
}

TEST(test_two_at_once)
{
    int ending;
    make_old();
    const pid_t first = start_slow(new_line);
    for (int i = 0; i < 1000 && !cli_is_there("set/.beamrate/.owner"); i++)
        usleep(5000);
    usleep(20000); /* until it has written to the file */
    cli_expect(new_line, NULL, 2, "in use by process");
    assert_int_equal(waitpid(first, &ending, 0), first);
    assert_int_equal(ending, 0);
    assert_int_equal(set_that_is_there(), 'r');
    assert_false(cli_is_there("set/.beamrate"));
}

/* Of commands that start together, in any order, at least one succeeds, and its set is whole. */
TEST(test_many_at_once)
{
    enum { PROGRAMS = 4 };
    pid_t child[PROGRAMS];
    clear_set();
    for (int i = 0; i < PROGRAMS; i++)
        child[i] = start_slow(i % 2 ? old_line : new_line);
    int done = 0;
    for (int i = 0; i < PROGRAMS; i++) {
        int ending;
        assert_int_equal(waitpid(child[i], &ending, 0), child[i]);
        assert_true(WIFEXITED(ending) && (WEXITSTATUS(ending) == 0 || WEXITSTATUS(ending) == 2));
        done += WEXITSTATUS(ending) == 0;
    }
    assert_true(done >= 1);
    assert_true(set_that_is_there() != '-');
}

static int make_folder(void **state)
{
    if (cli_make_folder(state))
        return -1;
    cli_run_line("scenes example1", NULL, &out);
    cli_write_file("summary.yaml", out.output);
    return 0;
}

AROUND_TESTS(make_folder, cli_remove_folder)
