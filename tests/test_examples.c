/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every example that the program's help, the README and the pages of docs/ print works as it
 * stands. $BEAMRATE is the program.
 *
 * A block of a page that begins with ```sh is run line by line. One that begins with ```sh long
 * would take minutes: of its lines only the command and the names of the options are tried. */
#include <glob.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli_driver.h"
#include "solver/clock.h"
#include "support.h"

enum { MOST_EXAMPLES = 256, MOST_LINE = 512 };

static struct {
    char line[MOST_LINE];
    char origin[64];
    bool is_long;
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
    return begins(line, "beamrate ") || begins(line, "$beamrate ") || begins(line, "mpirun ") ||
           begins(line, "cc ");
}

/* Once each: some are printed in several places. */
static void keep(char *line, const char *origin, bool is_long)
{
    line += *line == '$'; /* of a variable that holds the program */
    for (size_t end = strlen(line); end > 0 && line[end - 1] == ' ';)
        line[--end] = '\0';
    for (size_t i = 0; i < examples; i++)
        if (strcmp(example[i].line, line) == 0)
            return;
    assert_true(examples < MOST_EXAMPLES);
    snprintf(example[examples].line, MOST_LINE, "%s", line);
    snprintf(example[examples].origin, sizeof example->origin, "%s", origin);
    example[examples++].is_long = is_long;
}

/* Lines of a text that are examples; one that ends with a backslash goes on in the next. */
static void collect(char *text, const char *origin, bool is_long)
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
        keep(whole, origin, is_long);
        whole[0] = '\0';
    }
}

/* The parts of a text between two lines. */
static void collect_between(char *text, const char *from, const char *to, const char *origin,
                            bool is_long)
{
    for (char *at = text; (at = strstr(at, from));) {
        char *begin = at + strlen(from), *end = strstr(begin, to);
        assert_non_null(end);
        char *part = strndup(begin, (size_t)(end - begin));
        collect(part, origin, is_long);
        free(part);
        at = end + 1;
    }
}

/* A block of YAML whose first line is a remark that begins with NAME.yaml is that file. */
static void write_scenes(const char *text)
{
    static const char from[] = "```yaml\n# ";
    for (const char *at = text; (at = strstr(at, from)); at++) {
        char name[64], path[128];
        const char *begin = at + strlen(from), *end = strstr(begin, "```");
        assert_non_null(end);
        if (sscanf(begin, "%50[a-z_].yaml", name) != 1 || !begins(begin + strlen(name), ".yaml"))
            continue;
        snprintf(path, sizeof path, "%s.yaml", name);
        char *scene = strndup(begin - 2, (size_t)(end - begin) + 2);
        cli_write_file(path, scene);
        free(scene);
    }
}

static void collect_page(const char *relative)
{
    char *text = read_source(relative);
    write_scenes(text);
    collect_between(text, "```sh\n", "```", relative, false);
    collect_between(text, "```sh long\n", "```", relative, true);
}

/* README.md and docs/, page by page. */
static void collect_pages(void)
{
    glob_t pages;
    char pattern[1024];
    const char *data = getenv("BEAMRATE_DATA");
    collect_page("README.md");
    snprintf(pattern, sizeof pattern, "%s/docs/*.md", data);
    assert_int_equal(glob(pattern, 0, NULL, &pages), 0);
    assert_true(pages.gl_pathc > 10);
    for (size_t i = 0; i < pages.gl_pathc; i++)
        collect_page(pages.gl_pathv[i] + strlen(data) + 1);
    globfree(&pages);
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
    collect(out.output, "--help", false);
    for (size_t i = 0; i < commands; i++) {
        char line[64];
        snprintf(line, sizeof line, "%.31s --help", name[i]);
        cli_run_line(line, NULL, &out);
        assert_int_equal(out.exit_code, 0);
        if (!strstr(out.output, "\n  beamrate "))
            fail_msg("%s --help has no example", name[i]);
        collect(out.output, name[i], false);
    }
}

/* ---- running them ---- */

/* Words that make an example short, for a line that has a text and neither of two others. Those
 * that the suite runs elsewhere are asked for their help, which reads the options. */
static const struct {
    const char *with, *without[2], *words;
} shorter[] = {
    {"beamrate tables", {" --n ", " -n "}, " --n 5,10 --k 0.1,0.05 --reference fine:20,0.05"},
    {" --split --methods", {" --help", " -h "}, " --help"},
    {" --split", {" --n ", " -n "}, " --n 10"},
    {"beamrate trade", {" --n ", " -n "}, " --n 10 --k 0.1,0.05 --methods euler,bdf2 --repeats 1"},
    {"beamrate plan",
     {" --methods", " --help"},
     " --methods euler+implicit,adaptive+p2 --repeats 1"},
    {"beamrate extremes", {" --help", " -h "}, " --help"},
    {"beamrate figures", {" --help", " -h "}, " --help"},
    {" 1e-4 --check", {" --help", " -h "}, " --help"},
    {" --animate example", {" --n ", " -n "}, " --n 4 --k 0.2"},
    {"beamrate tables", {" --no-plots", " --help"}, " --no-plots"},
    {"beamrate study", {" --no-plots", " --help"}, " --no-plots"},
    {"beamrate trade", {" --no-plots", " --help"}, " --no-plots"},
};

/* Appends them to a line. */
static void shorten(char line[2 * MOST_LINE], bool is_long)
{
    const char *const end = line + 2 * MOST_LINE;
    if (is_long)
        strcat(line, " --help");
    for (size_t i = 0; i < sizeof shorter / sizeof *shorter && !is_long; i++) {
        char *last = line + strlen(line);
        if (strstr(line, shorter[i].with) && !strstr(line, shorter[i].without[0]) &&
            !strstr(line, shorter[i].without[1]))
            snprintf(last, (size_t)(end - last), "%s", shorter[i].words);
    }
}

static int shell(const char *format, const char *words)
{
    char command[2048];
    snprintf(command, sizeof command, format, cli_folder(), words);
    const int status = system(command);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/* The programs of docs/orders/ and what they are studied by; what is trusted stays here. */
static void prepare_orders(void)
{
    char state[600];
    snprintf(state, sizeof state, "%s/state", cli_folder());
    setenv("XDG_STATE_HOME", state, 1);
    assert_int_equal(shell("cd '%s/files' && cp '%s'/docs/orders/* . && "
                           "cc -o poisson poisson.c -lm",
                           getenv("BEAMRATE_DATA")),
                     0);
}

/* A folder with what the examples take for granted, and one scene for --all. */
static void prepare(void)
{
    assert_int_equal(
        shell("cd '%s' && mkdir bin files few && ln -s \"%s\" bin/beamrate", getenv("BEAMRATE")),
        0);
    assert_int_equal(shell("cd '%s/few' && mkdir -p study/scenes && cd study/scenes && "
                           "cp '%s'/study/scenes/example3.yaml .",
                           getenv("BEAMRATE_DATA")),
                     0);
    assert_int_equal(shell("cd '%s/files' && cp ../*.yaml . && "
                           "../bin/beamrate scenes %s >my_scene.yaml && "
                           "../bin/beamrate check my_scene.yaml --quiet --json old.json && "
                           "cp old.json orders-of-last-month.json && ../bin/beamrate study "
                           "example2 -n 4,8,16 -k 0.1,0.05,0.025 --no-plots --quiet",
                           "example3"),
                     0);
    prepare_orders();
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
    snprintf(line, sizeof line, "%s%s%s", strstr(text, "--new") ? "rm my_scene.yaml; " : "",
             strstr(text, "--all") ? "BEAMRATE_DATA=$PWD/../few " : "", text);
    shorten(line, example[i].is_long);
    setenv("EXAMPLE", line, 1);
    const double start = br_seconds();
    const int code =
        shell("cd '%s' && rm -rf here && cp -r files here && cd here && beamrate=beamrate "
              "PATH=\"$PWD/../bin:$PATH\" sh -c \"$EXAMPLE\" >../output 2>&1 </dev/null%s",
              "");
    if (code != 0) {
        shell("cat '%s/output' >&2%s", "");
        fail_msg("%s: exit code %d: %s", example[i].origin, code, line);
    }
    print_message("# %5.2f s, %s: %s\n", br_seconds() - start, example[i].origin, line);
}

TEST(test_examples)
{
    examples = 0;
    collect_helps();
    collect_pages();
    assert_true(examples > 20);
    prepare();
    for (size_t i = 0; i < examples; i++)
        run_example(i);
}

AROUND_TESTS(cli_make_folder, cli_remove_folder)
