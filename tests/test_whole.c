/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A set of results is the old one or the new one, wherever the program is ended. */
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "cli/output.h"
#include "cli_driver.h"
#include "solver/clock.h"
#include "support.h"

static struct cli_outcome out;

/* Two commands whose sets share some names, and not all; the second one draws, too, where everything
 * is tested. */
static const char old_line[] = "study summary.yaml --n 4 --k 0.1 --no-plots --quiet --out set",
                  drawn_line[] = "run example1 --n 4 --k 0.1 --quiet --out set",
                  *new_line = "run example1 --n 4 --k 0.1 --no-plots --quiet --out set";

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

/* Whether a file of the set has the size and the time that a line of its list says. */
static bool is_as_listed(const char *line, char name[256])
{
    long long size, time;
    char path[512], place[300];
    struct stat info;
    assert_int_equal(sscanf(line, "%*u %lld %lld %255[^\n]", &size, &time, name), 3);
    snprintf(place, sizeof place, "set/%s", name);
    cli_path(place, path);
    return stat(path, &info) == 0 && info.st_size == size &&
           info.st_mtim.tv_sec * 1000000000LL + info.st_mtim.tv_nsec == time;
}

/* The command that wrote the set, which must be whole and alone in the folder: s or r; d: it is
 * decided for the new set, but that is not in place. */
static char set_that_is_there(void)
{
    char path[512], line[400], name[256], which = '?';
    size_t count = 0;
    if (cli_is_there("set/.beamrate-new/.beamrate-set"))
        return 'd';
    cli_path("set/.beamrate-set", path);
    FILE *list = fopen(path, "r");
    assert_non_null(list);
    assert_non_null(fgets(line, sizeof line, list));
    for (; fgets(line, sizeof line, list); count++) {
        if (!is_as_listed(line, name))
            fail_msg("not as the list says: %s", line);
        if (strcmp(name, "history.csv") == 0 || strcmp(name, "summary.csv") == 0)
            which = *name == 'h' ? 'r' : 's';
    }
    fclose(list);
    const size_t hidden = (size_t)cli_is_there("set/.beamrate-new") +
                          cli_is_there("set/.beamrate-lock");
    if (cli_count_files("set") != count + hidden) {
        shell("ls -lA set; cat set/.beamrate-set");
        fail_msg("%zu files, and %zu listed", cli_count_files("set") - hidden, count);
    }
    return which;
}

/* The first thing that the next command does. */
static enum br_status open_folder(void)
{
    struct br_error err;
    char path[512];
    cli_path("set", path);
    struct br_output output = {.waits = true}; /* until a killed program is gone */
    const enum br_status status = br_output_open(&output, path, &err);
    br_output_discard(&output);
    return status;
}

/* ---- ended anywhere ---- */

static void make_old(void)
{
    if (cli_is_there("old")) {
        shell("rm -rf set && cp -a old set");
        return;
    }
    clear_set();
    cli_expect(old_line, NULL, 0, "");
    assert_int_equal(set_that_is_there(), 's');
    shell("cp -a set old");
}

/* Applies the fault to call n = 1, 1 + every, ..., until no call n is reached. Each time the folder
 * has the old set, the new one, or the decision for it; the next command finishes that. */
static size_t try_everywhere(const char *what, long every)
{
    size_t old = 0, new = 0, decided = 0;
    const bool killed = strcmp(what, "kill") == 0;
    long n = 1;
    for (;; n += every) {
        make_old();
        if (!run_with(new_line, "disk", n, what))
            break;
        const char before = set_that_is_there();
        assert_int_equal(open_folder(), BR_OK);
        const char after = set_that_is_there();
        if (after != (before == 's' ? 's' : 'r'))
            fail_msg("disk %ld %s: %c, then %c: %s", n, what, before, after, out.output);
        if (!killed && out.exit_code != 3 && (out.exit_code != 0 || after != 'r'))
            fail_msg("disk %ld %s: exit code %d: %s", n, what, out.exit_code, out.output);
        assert_false(cli_is_there("set/.beamrate-new") || cli_is_there("set/.beamrate-lock"));
        *(before == 's' ? &old : before == 'r' ? &new : &decided) += 1;
    }
    assert_int_equal(set_that_is_there(), 'r');
    print_message("# %s, %ld calls: %zu left the old set, %zu the new one, %zu the decision\n",
                  what, n - 1, old, new, decided);
    return old * new * decided;
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
        if (out.exit_code != -SIGTERM || !strstr(out.output, said) || cli_is_there("set/.beamrate-new"))
            fail_msg("disk %ld stop: exit code %d: %s", n, out.exit_code, out.output);
        *(written ? &late : &in_time) += 1;
    }
    print_message("# stop: %zu in time, %zu late\n", in_time, late);
    assert_true(in_time > 0 && late > 0);
}

/* Killed at any time, and not only at a call that changes the folder. */
TEST(test_killed_at_random)
{
    const int kills = br_test_long() ? 160 : 40;
    char command[600];
    size_t old = 0, new = 0, decided = 0;
    make_old();
    const double start = br_seconds();
    cli_expect(new_line, NULL, 0, "");
    const double last = 1.3 * (br_seconds() - start);
    for (int i = 0; i < kills; i++) {
        make_old();
        snprintf(command, sizeof command, "timeout -s KILL %.4f \"$BEAMRATE\" %s 2>&1 || true",
                 last * (i + 1) / kills, new_line);
        shell(command);
        const char before = set_that_is_there();
        assert_int_equal(open_folder(), BR_OK);
        assert_int_equal(set_that_is_there(), before == 's' ? 's' : 'r');
        *(before == 's' ? &old : before == 'r' ? &new : &decided) += 1;
    }
    print_message("# kill at any time: %zu left the old set, %zu the new one, %zu the decision\n",
                  old, new, decided);
    assert_true(old > 0);
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
    for (int i = 0; i < 1000 && !cli_is_there("set/.beamrate-new"); i++)
        usleep(5000);
    cli_expect(new_line, NULL, 2, "in use by process");
    assert_int_equal(waitpid(first, &ending, 0), first);
    assert_int_equal(ending, 0);
    assert_int_equal(set_that_is_there(), 'r');
    assert_false(cli_is_there("set/.beamrate-new") || cli_is_there("set/.beamrate-lock"));
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
    set_that_is_there();
}

/* Both make the folder, and one is refused or begins when the other has ended. */
TEST(test_pairs_in_a_new_folder)
{
    size_t refused = 0;
    for (int i = 0; i < (br_test_long() ? 200 : 40); i++) {
        int ending[2];
        pid_t child[2];
        shell("rm -rf set");
        for (int j = 0; j < 2; j++) {
            child[j] = fork();
            assert_true(child[j] >= 0);
            if (!child[j]) {
                cli_run_line(j ? old_line : new_line, NULL, &out);
                _exit(out.exit_code);
            }
        }
        for (int j = 0; j < 2; j++) {
            assert_int_equal(waitpid(child[j], &ending[j], 0), child[j]);
            assert_true(WIFEXITED(ending[j]));
            ending[j] = WEXITSTATUS(ending[j]);
            assert_true(ending[j] == 0 || ending[j] == 2);
        }
        if (ending[0] && ending[1])
            fail_msg("pair %d: both are refused", i);
        refused += ending[0] || ending[1];
        assert_true(strchr("rs", set_that_is_there()));
    }
    print_message("# in a new folder one was refused in %zu pairs\n", refused);
}

static int make_folder(void **state)
{
    new_line = br_test_long() ? drawn_line : new_line;
    if (cli_make_folder(state))
        return -1;
    cli_run_line("scenes example1", NULL, &out);
    cli_write_file("summary.yaml", out.output);
    return 0;
}

AROUND_TESTS(make_folder, cli_remove_folder)
