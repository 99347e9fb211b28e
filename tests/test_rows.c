/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tests the program as a user runs it, by the rows of a file, in their order. Each command is a
 * process of its own; each test has its own folder. usage: test_rows FILE, whose lines are # REMARK
 *   = NAME                      a test begins
 *   @ FILE | TEXT               the file is written
 *   COMMAND | CODE | MESSAGE    runs `beamrate COMMAND`: its exit code, a part of its output
 *   $ COMMAND | CODE            runs a line of sh, where $BEAMRATE is the program
 *   needs PROGRAM ...           the rest of the test is skipped where one cannot run
 *   with NAME=VALUE ...         circumstances of the next command, see set_circumstance
 *   says TEXT, silent TEXT      whether the last command has printed the text
 *   has FILE | TEXT, lacks FILE | TEXT
 *   there FILE ..., gone FILE ...
 *   files FOLDER | COUNT
 * In commands of the program, single blanks separate words, and '' is an empty word. In texts, \n
 * is a line's end, and " ... " any text. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>

#include "cli_driver.h"
#include "support.h"

enum { MOST_TESTS = 64, MOST_ROW = 4096 };

/* A test, with its rows of the file. */
struct test {
    char name[64];
    char **row;
    size_t rows, first; /* first: line of the first row, from 1 on */
};

static struct cli_outcome out;
static struct cli_circumstances circumstances;

static void set_circumstance(char *pair)
{
    static char path[600], errors[64];
    char *value = strchr(pair, '=');
    assert_non_null(value);
    *value++ = '\0';
    if (strcmp(pair, "size") == 0) /* of a file, bytes */
        circumstances.file_size = strtoul(value, NULL, 10);
    else if (strcmp(pair, "interrupt") == 0) /* ms */
        circumstances.interrupt_after = atoi(value);
    else if (strcmp(pair, "programs") == 0) { /* programs in this folder precede the system's */
        snprintf(path, sizeof path, "%s/%s:/usr/bin:/bin", cli_folder(), value);
        circumstances.path = path;
    } else if (strcmp(pair, "errors") == 0) { /* a file for standard error */
        snprintf(errors, sizeof errors, "%s", value);
        circumstances.errors = errors;
    } else if (strcmp(pair, "path") == 0) /* empty: no other program is found */
        circumstances.path = "/nowhere";
    else if (strcmp(pair, "data") == 0) /* "here": only the folder has scenes */
        circumstances.data = cli_folder();
    else
        fail_msg("no circumstance '%s'", pair);
}

/* Whether the text contains the part; where the part has " ... ", any text may stand. */
static bool contains(const char *text, const char *part)
{
    const char *dots = strstr(part, " ... ");
    const size_t length = dots ? (size_t)(dots - part) : strlen(part);
    const char *at = memmem(text, strlen(text), part, length);
    return at && (!dots || contains(at + length, dots + strlen(" ... ")));
}

static void check_text(const char *where, const char *text, const char *part, bool expected)
{
    if (contains(text, part) != expected)
        fail_msg("%s %s '%s':\n%s", where, expected ? "lacks" : "has", part, text);
}

/* Returns the shell's exit code; its output goes to out.output. */
static int run_shell(const char *line) /* awk takes decimal commas from the locale */
{
    char command[MOST_ROW + 100];
    snprintf(command, sizeof command, "exec 2>&1; export LC_ALL=C; cd '%s'; %s", cli_folder(),
             line);
    FILE *pipe = popen(command, "r");
    assert_non_null(pipe);
    out.output[fread(out.output, 1, sizeof out.output - 1, pipe)] = '\0';
    const int status = pclose(pipe);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

/* Runs a row's command. A refusal of an option must come before all warnings. */
static void run_command(char *row)
{
    char *code = br_test_part(row), *message = br_test_unescape(br_test_part(code)), *end;
    const long expected = strtol(code, &end, 10);
    if (end == code || *end)
        fail_msg("'%s' is no exit code", code);
    if (row[0] == '$')
        out.exit_code = run_shell(row + 2);
    else
        cli_run_line(row, &circumstances, &out);
    circumstances = (struct cli_circumstances){0};
    if (out.exit_code != expected)
        fail_msg("exit code %d, expected %ld; it said:\n%s", out.exit_code, expected, out.output);
    check_text("the output", out.output, message, true);
    if (out.exit_code == 2 && strstr(message, "--"))
        check_text("the refusal", out.output, "beamrate: warning: ", false);
}

static void check_count(const char *folder, const char *count)
{
    const size_t expected = strtoul(count, NULL, 10), found = cli_count_files(folder);
    if (found != expected)
        fail_msg("%zu files in %s, expected %zu", found, folder, expected);
}

/* Whether the rest of a test can run. gnuplot is that of $GNUPLOT: the build may have left one out
 * that does not run. */
static bool has_needs(char *programs)
{
    char *rest, command[128];
    for (char *word = strtok_r(programs, " ", &rest); word; word = strtok_r(NULL, " ", &rest)) {
        snprintf(command, sizeof command, "command -v %s >/dev/null", word);
        if (strcmp(word, "gnuplot") == 0 ? !getenv("GNUPLOT") : system(command) != 0) {
            print_message("# skipped: %s is not installed\n", word);
            return false;
        }
    }
    return true;
}

/* Handles each word of a row: sets a circumstance, or checks whether a file exists. */
static void take_words(char *words, bool are_files, bool there)
{
    char *rest;
    for (char *word = strtok_r(words, " ", &rest); word; word = strtok_r(NULL, " ", &rest))
        if (!are_files)
            set_circumstance(word);
        else if (cli_is_there(word) != there)
            fail_msg("%s is %s", word, there ? "not there" : "there");
}

static void run_row(char *row)
{
    enum what { WRITE, WITH, OUTPUT, CONTENTS, FILES, COUNT, COMMAND };
    static const struct {
        const char *begin;
        enum what what;
        bool expected;
    } kinds[] = {
        {"@ ", WRITE, true},        {"with ", WITH, true},    {"says ", OUTPUT, true},
        {"silent ", OUTPUT, false}, {"has ", CONTENTS, true}, {"lacks ", CONTENTS, false},
        {"there ", FILES, true},    {"gone ", FILES, false},  {"files ", COUNT, true},
        {"", COMMAND, true},
    };
    size_t k = 0;
    while (strncmp(row, kinds[k].begin, strlen(kinds[k].begin)) != 0)
        k++;
    const enum what what = kinds[k].what;
    const bool expected = kinds[k].expected;
    char *rest = row + strlen(kinds[k].begin);
    if (what == COMMAND) {
        run_command(rest);
        return;
    }
    const bool parted = what == WRITE || what == CONTENTS || what == COUNT;
    char *text = br_test_unescape(parted ? br_test_part(rest) : rest);
    if (what == WRITE)
        cli_write_file(rest, text);
    else if (what == OUTPUT)
        check_text("the output", out.output, text, expected);
    else if (what == CONTENTS)
        check_text(rest, cli_read(rest), text, expected);
    else if (what == COUNT)
        check_count(rest, text);
    else
        take_words(rest, what == FILES, expected);
}

static void test_rows(void **state)
{
    const struct test *t = *state;
    circumstances = (struct cli_circumstances){0}; /* a test that failed may have left some */
    for (size_t i = 0; i < t->rows; i++) {
        if (*t->row[i] == '#' || !*t->row[i])
            continue;
        print_message("# line %zu: %.100s\n", t->first + i, t->row[i]);
        if (strncmp(t->row[i], "needs ", 6) != 0)
            run_row(t->row[i]);
        else if (!has_needs(t->row[i] + 6))
            return;
    }
}

/* Reads the rows of the file, by tests; returns the number of tests. */
static size_t read_tests(const char *path, struct test *test)
{
    static char *row[MOST_ROW];
    FREED char *line = NULL;
    size_t room = 0, rows = 0, tests = 0;
    FILE *file = fopen(path, "r");
    if (!file)
        return 0;
    for (; getline(&line, &room, file) >= 0 && rows < MOST_ROW; rows++) {
        line[strcspn(line, "\n")] = '\0';
        if (strncmp(line, "= ", 2) == 0 && tests < MOST_TESTS) {
            test[tests] = (struct test){.row = &row[rows + 1], .first = rows + 2};
            snprintf(test[tests++].name, sizeof test->name, "%s", line + 2);
        } else if (tests > 0)
            test[tests - 1].rows++;
        row[rows] = strdup(line);
    }
    fclose(file);
    return tests;
}

int main(int argc, char **argv)
{
    static struct test test[MOST_TESTS];
    struct CMUnitTest tests[MOST_TESTS];
    const size_t count = argc == 2 ? read_tests(argv[1], test) : 0;
    for (size_t i = 0; i < count; i++)
        tests[i] = (struct CMUnitTest){
            .name = test[i].name, .test_func = test_rows, .initial_state = &test[i]};
    return count ? _cmocka_run_group_tests("rows", tests, count, cli_make_folder, cli_remove_folder)
                 : 99;
}
