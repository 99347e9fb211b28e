/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tests the checks themselves: the program is built with one planted bug after the other, and a
 * command that passes without the bug must end with exit code 1. A check of one scene is a part of
 * `beamrate check --all`, and cheaper. If no command can detect a bug, as one in a reference, a
 * test program must: it is built with the bug, and must fail. By default only a sample is planted:
 * the first bug of each command or test program that must detect it, of each folder, and of each
 * kind. usage: test_planted [SHARD SHARDS | NAME]: one of several shares, which can run side by
 * side, or one bug; without words, only whether each can be planted. */
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/planted_bugs.h"
#include "tests/support.h"

static char folder[] = "/tmp/br_planted_XXXXXX";
static char *commands; /* by which ninja builds the programs, a line each */

static const char *environment(const char *name)
{
    const char *value = getenv(name);
    if (!value || !*value)
        fail_msg("%s is not set: run this by 'meson test'", name);
    return value;
}

static char *read_all(FILE *in)
{
    size_t size = 0, room = 1 << 16;
    char *text = malloc(room);
    for (size_t got; text && (got = fread(text + size, 1, room - size - 1, in)) > 0;) {
        size += got;
        if (room - size < 2 && !(text = realloc(text, room *= 2)))
            break;
    }
    assert_non_null(text);
    text[size] = '\0';
    return text;
}

/* Runs a command; returns its exit code, or 128 and its signal; its output goes to the log in the
 * folder. */
__attribute__((format(printf, 1, 2))) static int run(const char *format, ...)
{
    FREED char *command = NULL;
    va_list args;
    va_start(args, format);
    assert_true(vasprintf(&command, format, args) > 0);
    va_end(args);
    const int status = system(command);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

/* A copy of the first of the build's commands that contains a word, beginning at `from`. */
static char *command_with(const char *from, const char *word)
{
    const char *at = strstr(from, word);
    if (!at)
        fail_msg("the build has no command with '%s'", word);
    const char *begin = at;
    while (begin > commands && begin[-1] != '\n')
        begin--;
    return strndup(begin, strcspn(begin, "\n"));
}

/* Whether a test program must detect the bug, instead of a command. */
static bool is_for_a_test(const struct planted_bug *bug)
{
    return strncmp(bug->command, "tests/", strlen("tests/")) == 0;
}

/* If the bug names one test of a test program, only that test is run: code in the planted source
 * selects it before main begins. */
static void choose_test(const struct planted_bug *bug, FILE *source)
{
    const char *blank = strchr(bug->command, ' ');
    if (is_for_a_test(bug) && blank)
        fprintf(source,
                "\nextern void cmocka_set_test_filter(const char *);\n"
                "__attribute__((constructor)) static void br_planted_test(void)\n"
                "{\n    cmocka_set_test_filter(\"%s\");\n}\n",
                blank + 1);
}

/* Writes the source with the bug. Fails if the text is not in the source exactly once. */
static void plant(const struct planted_bug *bug)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%s", environment("BEAMRATE_SOURCE"), bug->file);
    FILE *in = fopen(path, "r");
    assert_non_null(in);
    FREED char *source = read_all(in);
    fclose(in);
    char *at = strstr(source, bug->text);
    if (!at || strstr(at + 1, bug->text))
        fail_msg("%s: the text to replace stands %s in %s:\n%s", bug->name,
                 at ? "more than once" : "no more", bug->file, bug->text);
    snprintf(path, sizeof path, "%s/bug.c", folder);
    FILE *out = fopen(path, "w");
    assert_non_null(out);
    fprintf(out, "%.*s%s%s", (int)(at - source), source, bug->instead, at + strlen(bug->text));
    choose_test(bug, out);
    assert_int_equal(fclose(out), 0);
}

/* Compiles the planted source as the build would by one of its commands, but with little
 * optimisation, which is quicker; returns the end of the command. */
static const char *compile(const struct planted_bug *bug, const char *from, int number)
{
    char word[256];
    snprintf(word, sizeof word, "/%s\n", bug->file);
    const char *at = strstr(from, word);
    if (!at)
        return NULL;
    char *command = command_with(at, word), *tail = strstr(command, " -MD ");
    assert_non_null(tail);
    *tail = '\0';
    if (run("cd '%s' && %s -w -O1 -o %s/bug%d.o -c %s/bug.c >%s/log 2>&1",
            environment("BEAMRATE_BUILD"), command, folder, number, folder, folder) != 0)
        fail_msg("%s does not compile: see %s/log", bug->name, folder);
    free(command);
    return at + 1;
}

/* The row of the golden outputs that must detect the bug; NULL: a command or test program must. */
static const char *golden_row(const struct planted_bug *bug)
{
    const size_t size = strlen("golden ");
    return strncmp(bug->command, "golden ", size) == 0 ? bug->command + size : NULL;
}

/* Writes " -o PROGRAM ", which is only in the command that links the program: the test program, or
 * the program of the bug's command. */
static void output_of(const struct planted_bug *bug, char output[256])
{
    const char *program = is_for_a_test(bug) ? bug->command
                          : golden_row(bug)  ? "tests/beamrate-golden"
                                             : "cli/beamrate";
    snprintf(output, 256, " -o %.*s ", (int)strcspn(program, " "), program);
}

/* Compiles the source as often as the build does (for several instruction sets, perhaps), and links
 * the objects before the libraries, so that they replace the right ones. */
static void build(const struct planted_bug *bug)
{
    int objects = 0;
    run("rm -f %s/bug*.o", folder);
    for (const char *at = commands; (at = compile(bug, at, objects)) != NULL;)
        objects++;
    if (objects == 0)
        fail_msg("the build has no command for %s", bug->file);
    char output[256];
    output_of(bug, output);
    char *link = command_with(commands, output), *rest = strstr(link, output);
    *rest = '\0';
    rest += strlen(output);
    const char *linker = getenv("QUICK_LINKER");
    if (run("cd '%s' && %s %s -o %s/planted %s/bug*.o %s >%s/log 2>&1",
            environment("BEAMRATE_BUILD"), link, linker ? linker : "", folder, folder, rest,
            folder) != 0)
        fail_msg("%s does not link: see %s/log", bug->name, folder);
    free(link);
}

/* The exit code of a command of a program; 128 and more for one that takes too much processor time.
 */
static int run_beamrate(const char *program, const char *command)
{
    const bool takes_threads = strncmp(command, "run ", 4) != 0;
    return run("ulimit -t 120; BEAMRATE_DATA='%s' '%s' %s --quiet%s >%s/log 2>&1",
               environment("BEAMRATE_SOURCE"), program, command,
               takes_threads ? " --threads 1" : "", folder);
}

/* Called once for each command. Checks are not run here: another test runs `check --all`. */
static void sound_program_passes(const char *command)
{
    static const char *passed[PLANTED_BUGS];
    static size_t count;
    for (size_t i = 0; i < count; i++)
        if (strcmp(passed[i], command) == 0)
            return;
    const int code = run_beamrate(environment("BEAMRATE"), command);
    if (code != 0)
        fail_msg("beamrate %s: exit code %d without a bug, expected 0", command, code);
    passed[count++] = command;
}

static void a_command_sees(const struct planted_bug *bug)
{
    char program[64];
    snprintf(program, sizeof program, "%s/planted", folder);
    if (strncmp(bug->command, "check ", strlen("check ")) != 0)
        sound_program_passes(bug->command);
    const int code = run_beamrate(program, bug->command);
    if (code != 1)
        fail_msg("%s: beamrate %s: exit code %d, expected 1: a verdict failed", bug->name,
                 bug->command, code);
}

/* cmocka aborts the program at the first failing test, which saves time. A program that crashes or
 * takes too long does not count as failing. That the test passes without the bug is another test.
 */
static void a_test_sees(const struct planted_bug *bug)
{
    const int code = run("ulimit -c 0; ulimit -t 120; env -u BR_TEST_LONG CMOCKA_TEST_ABORT=1 "
                         "CMOCKA_MESSAGE_OUTPUT=stdout %s/planted >%s/log 2>&1",
                         folder, folder);
    if (code != 128 + SIGABRT || run("grep -q 'error: Failure!' %s/log", folder) != 0)
        fail_msg("%s: %s: exit code %d, expected one of its tests to fail", bug->name, bug->command,
                 code);
}

/* The exit code is 1 if an output differs. That none differs without the bug is another test. */
static void golden_outputs_see(const struct planted_bug *bug)
{
    const char *source = environment("BEAMRATE_SOURCE");
    const int code = run("ulimit -t 120; BEAMRATE_DATA='%s' BEAMRATE=%s/planted "
                         "'%s/tests/golden/run.sh' %s >%s/log 2>&1",
                         source, folder, source, golden_row(bug), folder);
    if (code != 1)
        fail_msg("%s: %s: exit code %d, expected 1: another output", bug->name, bug->command, code);
}

static void bug_is_caught(void **state)
{
    const struct planted_bug *bug = *state;
    if (br_test_quick())
        SKIP("too long for this run");
    plant(bug);
    build(bug);
    if (is_for_a_test(bug))
        a_test_sees(bug);
    else if (golden_row(bug))
        golden_outputs_see(bug);
    else
        a_command_sees(bug);
}

/* Includes bugs that are not planted by default. */
static void all_can_be_planted(void **state)
{
    (void)state;
    for (size_t i = 0; i < PLANTED_BUGS; i++) {
        const struct planted_bug *bug = &planted_bugs[i];
        char output[256];
        plant(bug);
        output_of(bug, output);
        free(command_with(commands, output));
    }
}

/* Whether texts are the same up to this letter, or their end. */
static bool same_up_to(char letter, const char *a, const char *b)
{
    const char *end = strrchr(a, letter), *other = strrchr(b, letter);
    const size_t size = end ? (size_t)(end - a) : strlen(a);
    return size == (other ? (size_t)(other - b) : strlen(b)) && strncmp(a, b, size) == 0;
}

/* Whether it is the first that its command or test program must detect, the first of its folder, or
 * the first of its kind. */
static bool is_in_sample(size_t bug)
{
    bool command = true, place = true, kind = true;
    for (size_t i = 0; i < bug; i++) {
        const struct planted_bug *a = &planted_bugs[i], *b = &planted_bugs[bug];
        const size_t word = strcspn(b->command, " ");
        command &= strncmp(a->command, b->command, word) != 0 || !strchr(" ", a->command[word]);
        place &= !same_up_to('/', a->file, b->file);
        kind &= strcmp(a->kind, b->kind) != 0;
    }
    return command || place || kind;
}

static int read_commands(void **state)
{
    (void)state;
    char command[4096];
    snprintf(command, sizeof command, "'%s' -C '%s' -t commands", environment("NINJA"),
             environment("BEAMRATE_BUILD"));
    FILE *ninja = popen(command, "r");
    assert_non_null(ninja);
    commands = read_all(ninja);
    assert_int_equal(pclose(ninja), 0);
    assert_non_null(mkdtemp(folder));
    return 0;
}

static int clean_up(void **state)
{
    (void)state;
    free(commands);
    return run("rm -rf '%s'", folder);
}

int main(int argc, char **argv)
{
    const char *name = argc == 2 ? argv[1] : NULL;
    const size_t shard = argc == 3 ? strtoul(argv[1], NULL, 10) : 0;
    const size_t shards = argc == 3 ? strtoul(argv[2], NULL, 10) : 0;
    static struct CMUnitTest tests[1 + PLANTED_BUGS] = {cmocka_unit_test(all_can_be_planted)};
    size_t count = argc == 1, chosen = 0;
    for (size_t i = 0; i < PLANTED_BUGS && argc > 1; i++)
        if (name ? strcmp(planted_bugs[i].name, name) == 0
                 : (br_test_long() || is_in_sample(i)) && chosen++ % shards == shard)
            tests[count++] = (struct CMUnitTest){planted_bugs[i].name, bug_is_caught, NULL, NULL,
                                                 (void *)&planted_bugs[i]};
    return _cmocka_run_group_tests("planted", tests, count, read_commands, clean_up);
}
