/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every example that the program's help and the README print works as it stands. $BEAMRATE is the
 * program. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli_driver.h"
#include "support.h"

enum { MOST_EXAMPLES = 128, MOST_LINE = 512 };

static struct {
    char line[MOST_LINE];
    const char *origin;
} example[MOST_EXAMPLES];
static size_t examples;

static char *read_source(const char *relative)
{
    char path[1024];
    snprintf(path, sizeof path, "%s/%s", getenv("BEAMRATE_DATA"), relative);
    FILE *file = fopen(path, "r");
    if (!file)
        fail_msg("%s is not there", path);
    static char text[1 << 18];
    const size_t length = fread(text, 1, sizeof text - 1, file);
    assert_true(length > 0 && length < sizeof text - 1);
    text[length] = '\0';
    fclose(file);
    return text;
}

/* ---- what is printed ---- */

static bool begins(const char *text, const char *with)
{
    return strncmp(text, with, strlen(with)) == 0;
}

static bool is_example(const char *line)
{
    return begins(line, "beamrate ") || begins(line, "$beamrate ") || begins(line, "mpirun ");
}

/* Once each: some are printed in several places. */
static void keep(const char *line, const char *origin)
{
    for (size_t i = 0; i < examples; i++)
        if (strcmp(example[i].line, line) == 0)
            return;
    assert_true(examples < MOST_EXAMPLES);
    snprintf(example[examples].line, MOST_LINE, "%s", line);
    example[examples++].origin = origin;
}

/* Lines of a text that are examples; one that ends with a backslash goes on in the next. */
static void collect(char *text, const char *origin)
{
    char whole[MOST_LINE] = "";
    for (char *line = strtok(text, "\n"); line; line = strtok(NULL, "\n")) {
        line += strspn(line, " ");
        if (!*whole && !is_example(line))
            continue;
        const size_t used = strlen(whole);
        snprintf(whole + used, sizeof whole - used, "%s", line);
        char *end = strrchr(whole, '\\');
        if (end && !end[1]) {
            *end = '\0';
            continue;
        }
        char *remark = strstr(whole, " # "); /* else it would swallow what is added to the line */
        if (remark)
            *remark = '\0';
        keep(whole, origin);
        whole[0] = '\0';
    }
}

/* The parts of a text between two lines. */
static void collect_between(char *text, const char *from, const char *to, const char *origin)
{
    for (char *at = text; (at = strstr(at, from));) {
        char *begin = at + strlen(from), *end = strstr(begin, to);
        assert_non_null(end);
        char *part = strndup(begin, (size_t)(end - begin));
        collect(part, origin);
        free(part);
        at = end + 1;
    }
}

/* The commands that the help lists. */
static size_t list_commands(char name[16][32])
{
    static struct cli_outcome out;
    cli_run_line("--help", NULL, &out);
    char *line = strstr(out.output, "Commands:\n");
    assert_non_null(line);
    size_t count = 0;
    for (line = strchr(line, '\n') + 1; begins(line, "  ") && count < 16;
         line = strchr(line, '\n') + 1)
        sscanf(line, "%31s", name[count++]);
    return count;
}

static void collect_helps(void)
{
    static struct cli_outcome out;
    static char name[16][32];
    const size_t commands = list_commands(name);
    assert_true(commands >= 5);
    cli_run_line("--help", NULL, &out);
    collect(out.output, "--help");
    for (size_t i = 0; i < commands; i++) {
        char line[64];
        snprintf(line, sizeof line, "%.31s --help", name[i]);
        cli_run_line(line, NULL, &out);
        assert_int_equal(out.exit_code, 0);
        if (!strstr(out.output, "\n  beamrate "))
            fail_msg("%s --help has no example", name[i]);
        collect(out.output, name[i]);
    }
}

/* ---- running them ---- */

/* What makes a long example short: words for a command that does not say its own. */
static const struct {
    const char *command, *unless, *or_unless, *words;
} shorter[] = {
    {"beamrate tables", " --n", " -n ", " --n 5,10 --k 0.1,0.05 --reference fine:20,0.05"},
    {" --split", " --n", " -n ", " --n 10"},
    {"beamrate trade", " --n", " -n ", " --n 10 --k 0.1,0.05 --methods euler,bdf2 --repeats 1"},
    {"beamrate plan", " --methods", " --methods",
     " --methods euler+implicit,adaptive+p2 --repeats 1"},
    {"beamrate extremes", " --cases 10 ", " --cases 10 ", " --help"}, /* the others take minutes */
};

static const char *shorten(const char *line)
{
    for (size_t i = 0; i < sizeof shorter / sizeof *shorter; i++)
        if (strstr(line, shorter[i].command) && !strstr(line, shorter[i].unless) &&
            !strstr(line, shorter[i].or_unless))
            return shorter[i].words;
    return "";
}

static int shell(const char *format, const char *words)
{
    char command[2048];
    snprintf(command, sizeof command, format, cli_folder(), words);
    const int status = system(command);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/* A folder with what the examples take for granted, and few scenes for --all. */
static void prepare(void)
{
    assert_int_equal(
        shell("cd '%s' && mkdir bin files few && ln -s \"%s\" bin/beamrate", getenv("BEAMRATE")),
        0);
    assert_int_equal(shell("cd '%s/few' && mkdir -p study/scenes && cd study/scenes && "
                           "cp '%s'/study/scenes/example[23].yaml .",
                           getenv("BEAMRATE_DATA")),
                     0);
    assert_int_equal(shell("cd '%s/files' && ../bin/beamrate scenes %s >my_scene.yaml && "
                           "../bin/beamrate check my_scene.yaml --quiet --json old.json && "
                           "cp old.json orders-of-last-month.json",
                           "example3"),
                     0);
}

/* In a copy of the folder; a scene that is to be made is not there yet. */
static void run_example(size_t i)
{
    char line[2 * MOST_LINE];
    const char *text = example[i].line;
    if (begins(text, "mpirun ")) {
        print_message("# %s: left to test_ranks: %s\n", example[i].origin, text);
        return;
    }
    snprintf(line, sizeof line, "%s%s%s%s", strstr(text, "--new") ? "rm my_scene.yaml; " : "",
             strstr(text, "--all") ? "BEAMRATE_DATA=$PWD/../few " : "", text, shorten(text));
    setenv("EXAMPLE", line, 1);
    const int code =
        shell("cd '%s' && rm -rf here && cp -r files here && cd here && beamrate=beamrate "
              "PATH=\"$PWD/../bin:$PATH\" sh -c \"$EXAMPLE\" >../output 2>&1 </dev/null%s",
              "");
    if (code != 0) {
        shell("cat '%s/output' >&2%s", "");
        fail_msg("%s: exit code %d: %s", example[i].origin, code, line);
    }
}

static void test_examples(void **state)
{
    (void)state;
    examples = 0;
    collect_helps();
    collect_between(read_source("README.md"), "```sh\n", "```", "README.md");
    assert_true(examples > 20);
    prepare();
    for (size_t i = 0; i < examples; i++)
        run_example(i);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_examples)};
    return cmocka_run_group_tests(tests, cli_make_folder, cli_remove_folder);
}
