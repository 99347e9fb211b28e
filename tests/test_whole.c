/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A set of results is the old one or the new one, wherever the program is ended. */
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/text.h"
#include "cli/output.h"
#include "cli_driver.h"
#include "faults.h"
#include "support.h"

static struct cli_outcome out;

/* ---- who writes a set ---- */

/* Two commands whose sets share some names, and not all. */
static const char old_line[] = "study summary.yaml --n 4 --k 0.1 --no-plots --quiet --out set",
                  new_line[] = "run example1 --n 4 --k 0.1 --no-plots --quiet --out set";

/* As a command: puts files of these names, each with a word of the set, into it. Returns the exit
 * code. */
static int write_set(const char *folder, char *names)
{
    const char *command = strstr(names, "history.csv") ? "beamrate run" : "beamrate study";
    struct br_output output = {0};
    err.status = BR_OK;
    bool failed = br_output_open(&output, folder, &err) != BR_OK;
    for (char *name = strtok(names, " "); name && !failed; name = strtok(NULL, " ")) {
        FILE *file;
        failed = br_output_file(&output, name, &file, &err) != BR_OK;
        if (!failed)
            failed = fputs(command, file) < 0 || br_output_close(file, name, &err);
    }
    failed = failed || br_output_commit(&output, &err);
    br_output_discard(&output);
    return br_status_exit_code(err.status);
}

/* Lets this program do that in a process of its own. Returns its exit code, or -signal. */
static int write_as_program(const char *names)
{
    char path[512];
    int ending;
    cli_path("set", path);
    const pid_t child = fork();
    assert_true(child >= 0);
    if (!child) {
        setenv("BR_WRITE_SET", names, 1);
        setenv("BR_FOLDER", path, 1);
        dup2(STDERR_FILENO, STDOUT_FILENO); /* cmocka's own lines */
        execl("/proc/self/exe", "test_whole", (char *)NULL);
        _exit(99);
    }
    assert_int_equal(waitpid(child, &ending, 0), child);
    return WIFEXITED(ending) ? WEXITSTATUS(ending) : -WTERMSIG(ending);
}

/* Makes the next program fail, and runs it; whether the call was reached. line NULL: this program
 * itself writes the new set, see write_set; it is quicker, and a planted bug is in it. */
static bool run_with(const char *line, long n, const char *what)
{
    char fault[64], record[512];
    cli_path("reached", record);
    unlink(record);
    snprintf(fault, sizeof fault, "disk %ld %s", n, what);
    setenv("BR_FAULT", fault, 1);
    setenv("BR_FAULT_LOG", record, 1);
    if (line)
        cli_run_line(line, NULL, &out);
    else
        out.exit_code = write_as_program("fields.csv history.csv report.html summary.json");
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

/* What wrote a file: s or r, of the two commands; ?: it does not say. */
static char writer_of(const char *name)
{
    char place[500];
    snprintf(place, sizeof place, "set/%s", name);
    const char *text = cli_read(place);
    return strstr(text, "beamrate study") ? 's' : strstr(text, "beamrate run") ? 'r' : '?';
}

/* The command that wrote the set, which must be whole and alone in the folder: s or r; d: it is
 * decided for the new set, but that is not in place. */
static char set_that_is_there(void)
{
    char path[512], line[400], written[100] = "";
    size_t count = 0;
    if (cli_is_there("set/.beamrate-new/.beamrate-set"))
        return 'd';
    cli_path("set/.beamrate-set", path);
    FILE *list = fopen(path, "r");
    assert_non_null(list);
    assert_non_null(fgets(line, sizeof line, list));
    assert_string_equal(line, "beamrate-set 3\n");
    for (; fgets(line, sizeof line, list); count++) {
        line[strcspn(line, "\n")] = '\0';
        assert_true(count < sizeof written - 1);
        written[count] = writer_of(line);
    }
    fclose(list);
    const char which = cli_is_there("set/history.csv") ? 'r' : 's',
               other = which == 'r' ? 's' : 'r';
    const size_t hidden =
        (size_t)cli_is_there("set/.beamrate-new") + cli_is_there("set/.beamrate-lock");
    if (cli_count_files("set") != count + hidden || !strchr(written, which) ||
        strchr(written, other)) {
        shell("ls -lA set; cat set/.beamrate-set");
        fail_msg("%zu files, and %zu listed, which were written by %s",
                 cli_count_files("set") - hidden, count, written);
    }
    return which;
}

/* The first thing that the next command does. */
static enum br_status open_folder(void)
{
    char path[512];
    cli_path("set", path);
    struct br_output output = {0};
    enum br_status status = br_output_open(&output, path, &err);
    for (int i = 0; i < 10000 && status && strstr(err.message, "in use by"); i++) {
        usleep(10000); /* until a killed program is gone */
        output = (struct br_output){0};
        status = br_output_open(&output, path, &err);
    }
    br_output_discard(&output);
    return status;
}

/* ---- ended anywhere ---- */

static void make_old(void)
{
    clear_set();
    assert_int_equal(write_as_program("report.html summary-fits.csv summary.csv summary.json"), 0);
    assert_int_equal(set_that_is_there(), 's');
}

/* Applies the fault to call n = 1, 2, ..., until no call n is reached. Each time the folder
 * has the old set, the new one, or the decision for it; the next command finishes that. */
static size_t try_everywhere(const char *what)
{
    size_t old = 0, new = 0, decided = 0;
    const bool killed = strcmp(what, "kill") == 0;
    long n = 1;
    for (;; n++) {
        make_old();
        if (!run_with(NULL, n, what))
            break;
        const char before = set_that_is_there();
        assert_int_equal(open_folder(), BR_OK);
        const char after = set_that_is_there();
        if (after != (before == 's' ? 's' : 'r'))
            fail_msg("disk %ld %s: %c, then %c", n, what, before, after);
        if (!killed && out.exit_code != 3 && (out.exit_code != 0 || after != 'r'))
            fail_msg("disk %ld %s: exit code %d", n, what, out.exit_code);
        assert_false(cli_is_there("set/.beamrate-new") || cli_is_there("set/.beamrate-lock"));
        *(before == 's' ? &old : before == 'r' ? &new : &decided) += 1;
    }
    assert_int_equal(set_that_is_there(), 'r');
    print_message("# %s, %ld calls: %zu left the old set, %zu the new one, %zu the decision\n",
                  what, n - 1, old, new, decided);
    return old * new *decided;
}

TEST(test_killed)
{
    assert_true(try_everywhere("kill") > 0); /* each of the three happened */
}

TEST(test_broken_disk)
{
    assert_true(try_everywhere("fail") > 0);
}

/* The disk fails for good, then is mended. */
TEST(test_dead_disk)
{
    assert_true(try_everywhere("from") > 0);
}

/* A signal always has an effect: it stops the work, or is reported when all is written. */
TEST(test_stopped)
{
    size_t in_time = 0, late = 0;
    for (long n = 1;; n++) {
        make_old();
        if (!run_with(new_line, n, "stop"))
            break;
        const bool written = set_that_is_there() == 'r';
        const char *said =
            written ? "interrupted after everything was written" : "no file is half written";
        if (out.exit_code != -SIGTERM || !strstr(out.output, said) ||
            cli_is_there("set/.beamrate-new"))
            fail_msg("disk %ld stop: exit code %d: %s", n, out.exit_code, out.output);
        *(written ? &late : &in_time) += 1;
    }
    print_message("# stop: %zu in time, %zu late\n", in_time, late);
    assert_true(in_time > 0 && late > 0);
}

/* Killed at any time, and not only at a call that changes the folder. */
TEST(test_killed_at_random)
{
    const int kills = br_test_long() ? 160 : 20;
    char command[600];
    size_t old = 0, new = 0, decided = 0;
    make_old();
    const double start = br_seconds();
    cli_expect(new_line, NULL, 0, "");
    const double last = 1.3 * (br_seconds() - start), first = 1e-3; /* before it can do anything */
    for (int i = 0; i < kills; i++) {
        make_old();
        snprintf(command, sizeof command,
                 "{ timeout -s KILL %.4f \"$BEAMRATE\" %s; } >/dev/null 2>&1 || true",
                 first + last * i / kills, new_line);
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

/* Somebody's file at the place of a new one: the new set is beside it, and the old one stays. So do
 * a folder and a link at the place of a file of ours. */
TEST(test_in_way)
{
    make_old();
    shell("echo mine >set/history.csv");
    assert_int_equal(write_as_program("history.csv summary.csv"), 3);
    assert_string_equal(cli_read("set/history.csv"), "mine\n");
    assert_string_equal(cli_read("set/summary.csv"), "beamrate study");
    assert_string_equal(cli_read("set/set-1/summary.csv"), "beamrate run");
    make_old();
    shell("cd set && rm summary.csv summary.json && mkdir summary.csv && ln -s .. summary.json");
    assert_int_equal(write_as_program("history.csv summary.csv"), 3);
    assert_int_equal(write_as_program("history.csv"), 0);
    assert_false(cli_is_there("set/report.html"));
    assert_true(cli_is_there("set/summary.csv") && cli_is_there("set/summary.json"));
}

/* A set takes the place of the one before, whatever its files are called, and of nothing else. */
TEST(test_one_set)
{
    clear_set();
    shell("echo mine >set/notes.csv");
    assert_int_equal(write_as_program("report.csv report.html"), 0);
    assert_int_equal(write_as_program("report.html summary.csv"), 0);
    assert_int_equal(cli_count_files("set"), 3);
    assert_true(cli_is_there("set/summary.csv"));
    assert_string_equal(cli_read("set/notes.csv"), "mine\n");
}

/* ---- two at once ---- */

static const char *removed; /* a file that is removed before the next lock; NULL: none */

int flock(int file, int operation)
{
    if (removed)
        unlink(removed);
    return (int)syscall(SYS_flock, file, operation);
}

/* The program before ends, and removes its lock, while the next one is about to lock that file: a
 * third one may have made another. */
TEST(test_lock_of_a_removed_file)
{
    char path[512], lock[600];
    struct br_output output = {0};
    clear_set();
    cli_path("set", path);
    snprintf(lock, sizeof lock, "%s/.beamrate-lock", path);
    removed = lock;
    assert_int_equal(br_output_open(&output, path, &err), BR_BAD_INPUT);
    assert_non_null(strstr(err.message, "in use by another program"));
    removed = NULL;
    assert_int_equal(br_output_open(&output, path, &err), BR_OK);
    br_output_discard(&output);
}

/* In a process group of its own. */
static pid_t start_with(const char *line, long n, const char *what)
{
    const pid_t child = fork();
    assert_true(child >= 0);
    if (child)
        return child;
    setpgid(0, 0);
    run_with(line, n, what);
    _exit(out.exit_code);
}

/* The n-th allocation of a text in memory fails: nothing is written, or all of it. The texts get
 * shorter, so that some fit again behind one that did not. */
TEST(test_texts_without_memory)
{
    static char expected[70000];
    size_t failures = 0, good = 0;
    for (size_t i = 0, at = 0; i < 3; at += 60000 >> 3 * i++)
        memset(expected + at, "abc"[i], 60000 >> 3 * i);
    for (long n = 1; good < 5; n++) {
        FREED char *text = expected;
        size_t size = 1;
        br_memory_fails_at(n);
        FILE *file = br_text_open(&text, &size);
        for (size_t i = 0, at = 0; i < 3 && file; at += 60000 >> 3 * i++)
            fprintf(file, "%.*s", 60000 >> 3 * i, expected + at);
        const bool written = file && fclose(file) == 0;
        br_memory_fails_at(-1);
        if (written) {
            assert_int_equal(size, strlen(expected));
            assert_true(strcmp(text, expected) == 0);
        } else {
            assert_null(text);
            assert_int_equal(size, 0);
        }
        failures += !written;
        good = written ? good + 1 : 0;
    }
    assert_true(failures >= 4);
}

TEST(test_two_at_once)
{
    int ending;
    make_old();
    shell("rm -f reached");
    const pid_t first = start_with(new_line, 5, "pause");
    while (!cli_is_there("reached"))
        usleep(5000);
    assert_true(cli_is_there("set/.beamrate-new"));
    cli_expect(new_line, NULL, 2, "in use by another program");
    while (waitpid(first, &ending, WNOHANG) == 0) {
        kill(-first, SIGCONT);
        usleep(5000);
    }
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
        child[i] = start_with(i % 2 ? old_line : new_line, 0, "slow");
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
    for (int i = 0; i < (br_test_long() ? 200 : 20); i++) {
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
    char *names = getenv("BR_WRITE_SET");
    if (names)
        _exit(write_set(getenv("BR_FOLDER"), names));
    if (cli_make_folder(state))
        return -1;
    cli_run_line("scenes example1", NULL, &out);
    cli_write_file("summary.yaml", out.output);
    return 0;
}

AROUND_TESTS(make_folder, cli_remove_folder)
