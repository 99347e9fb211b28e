/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scenes from strangers: names of files, titles and remarks that would be commands, markup or
 * control characters, through every command that takes a scene. Nothing is run, nothing reaches a
 * terminal or a text raw, and what is written is well formed. */
#include <ctype.h>
#include <ftw.h>
#include <jansson.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/clock.h"
#include "cli_driver.h"
#include "support.h"

/* name: of the file, as bytes; text: within YAML's double quotes. */
static const struct stranger {
    const char *name, *text;
} strangers[] = {
    {"'.system('touch MARK').'", "5'' beam"},
    {"'; system(\"touch MARK\"); '", "'; system(\\\"touch MARK\\\"); '"},
    {"<touch MARK", "''; system(\\\"touch MARK\\\"); ''"},
    {"|touch MARK", "' ''' '''' }} ; system('touch MARK'); # {"},
    {"`touch MARK`", "`touch MARK` \\\"`touch MARK`\\\" @stem \\\\"},
    {"$(touch MARK)", "a\\nsystem('touch MARK')\\n#\\n! touch MARK\\n\\\\"},
    {"\\input{MARK}", "\\\\input{/etc/passwd} \\\\write18{touch MARK} $x_1^2$ 5% & # ~"},
    {"<td><script>", "</td><script>alert(1)</script> <img src=x onerror=y> [a](b) | c"},
    {"]]>&amp;", "]]> <!-- &lt; &#x1b; <![CDATA["},
    {"=1+1", "=cmd|' /C calc'!A0"},
    {"-@+x", "--out=MARK @SUM(1) +1,\\\"2\\\""},
    {"a\nb\x1b[2J\xe2\x80\xae\xc2\x9b\x7f", "\\e[31m\\u202eabc\\u2066\\x85\\x9b\\a\\r\\x7f\\u200f"},
    {"100%s%n%d", "%s%n%d %99999d {/Symbol a}_b^c"},
    {"latin \xe4\xff", "Tr\xc3\xa4ger"},
};
enum { STRANGERS = sizeof strangers / sizeof *strangers };

static void write_scene(const struct stranger *s)
{
    char file[300], scene[4096];
    snprintf(file, sizeof file, "%s.yaml", s->name);
    snprintf(scene, sizeof scene,
             "title: \"%s\"\nremark: \"%s\"\nlength: 1 m\nduration: 1 s\ndensity: 1 kg/m\n"
             "axial:\n  stiffness: 1 N\n  viscosity: 1 N s\n  solution: t*x*(2 - x) [m]\n"
             "verify:\n  space:\n    n: 2, 4, 8, 16, 32\n    k: 0.5 s\n    l2: 1 +- 0.1\n",
             s->text, s->text);
    cli_write_file(file, scene);
}

/* ---- what is looked for ---- */

/* A byte or character that a terminal obeys; NULL: there is none. */
static const char *obeyed(const char *text)
{
    static const char *const marks[] = {"\xe2\x80\xae", "\xe2\x81\xa6", "\xe2\x80\x8f", "\xc2\x85",
                                        "\xc2\x9b",     "\xe4",         "\xff"};
    for (const char *c = text; *c; c++)
        if ((iscntrl((unsigned char)*c) && *c != '\n') || *c == '\x7f')
            return c;
    for (size_t i = 0; i < sizeof marks / sizeof *marks; i++)
        if (strstr(text, marks[i]))
            return strstr(text, marks[i]);
    return NULL;
}

static bool ends_with(const char *path, const char *ending)
{
    const size_t length = strlen(path), size = strlen(ending);
    return length >= size && strcmp(path + length - size, ending) == 0;
}

static const char *contents(const char *path)
{
    static char text[1 << 18];
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    text[fread(text, 1, sizeof text - 1, file)] = '\0';
    fclose(file);
    return text;
}

/* HTML of a title; in Markdown it is none behind a backslash, or between backticks. */
static bool has_markup(const char *text)
{
    for (const char *c = strchr(text, '<'); c; c = strchr(c + 1, '<'))
        if ((strncmp(c, "</td", 4) == 0 || strncmp(c, "<img", 4) == 0) &&
            (c == text || c[-1] != '\\'))
            return true;
    return false;
}

static size_t files_read;

static int check_file(const char *path, const struct stat *info, int kind, struct FTW *place)
{
    static const char *const binary[] = {".png", ".svg", ".pdf", ".yaml"};
    (void)info;
    if (strncmp(path + place->base, "MARK", 4) == 0)
        fail_msg("%s: something was run", path);
    if (kind != FTW_F || strstr(path, "/.cache/")) /* cached work is not for people */
        return 0;
    for (size_t i = 0; i < sizeof binary / sizeof *binary; i++)
        if (ends_with(path, binary[i]))
            return 0;
    files_read++;
    const char *text = contents(path), *bad = obeyed(text);
    json_error_t problem;
    json_t *json = NULL;
    if (bad && !ends_with(path, ".json"))
        fail_msg("%s: byte %zu is 0x%02x", path, (size_t)(bad - text), (unsigned char)*bad);
    if (ends_with(path, ".json") && !(json = json_loads(text, 0, &problem)))
        fail_msg("%s: %s", path, problem.text);
    json_decref(json);
    if (ends_with(path, ".tex"))
        assert_true(!strstr(text, "\\input") && !strstr(text, "\\write"));
    if (ends_with(path, ".md") || ends_with(path, ".xml"))
        assert_false(has_markup(text));
    if (ends_with(path, ".html"))
        assert_true(!strstr(text, "<img") && !strstr(text, "<script"));
    return 0;
}

static void look_at_all(void)
{
    assert_int_equal(nftw(cli_folder(), check_file, 8, FTW_PHYS), 0);
}

/* ---- every command ---- */

/* SCENE stands for its file. */
static const struct {
    const char *line;
    int exit_code;
} commands[] = {
    {"run SCENE --n 2 --k 0.5 --out run --json run.json", 0},
    {"study SCENE --n 2,4 --k 0.5,0.25 --reference mms --out study", 0},
    {"check SCENE --junit c.xml --json c.json --markdown c.md", 1},
    {"trade SCENE --methods euler --n 2 --k 0.5,0.25 --reference mms --out trade", 0},
    {"trade SCENE --split --methods euler --n 2 --k 0.5,0.25 --out split", 0},
    {"scenes SCENE", 0},
    {"run SCENE --n 2 --k 3", 2},
    {"study SCENE.no", 2},
    /* takes long */
    {"trade SCENE --error 0.3 --methods euler --reference mms --out goal", 0},
};

#define COMMANDS (sizeof commands / sizeof *commands)

static void run_command(const struct stranger *s, size_t command, const char *path)
{
    const char *line = commands[command].line;
    static struct cli_outcome out;
    char copy[256], file[300];
    const char *word[CLI_MOST_WORDS + 1];
    int count = 0;
    snprintf(copy, sizeof copy, "%s", line);
    snprintf(file, sizeof file, "./%s.yaml%s", s->name, strstr(line, "SCENE.no") ? ".no" : "");
    for (char *w = strtok(copy, " "); w; w = strtok(NULL, " "))
        word[count++] = strncmp(w, "SCENE", 5) == 0 ? file : w;
    word[count] = NULL;
    cli_run(word, &(struct cli_circumstances){.path = path}, &out);
    if (out.exit_code != commands[command].exit_code)
        fail_msg("%s of '%s': exit code %d: %s", line, s->name, out.exit_code, out.output);
    const char *bad = obeyed(out.output);
    if (bad)
        fail_msg("%s of '%s': byte 0x%02x in: %s", line, s->name, (unsigned char)*bad, out.output);
    assert_null(strstr(out.output, "is not drawn"));
    look_at_all();
}

/* Pictures and plans take most of the time: in the short test some scenes go without. */
TEST(test_every_command)
{
    for (size_t i = 0; i < STRANGERS; i++) {
        const bool drawn = i < 1 || br_test_long(), planned = i % 5 == 0 || br_test_long();
        write_scene(&strangers[i]);
        for (size_t c = 0; c < COMMANDS - (size_t)!planned; c++)
            run_command(&strangers[i], c, drawn ? NULL : "/nonexistent");
    }
    assert_true(files_read > 100);
}

TEST(test_xml)
{
    char path[512], command[600];
    if (system("command -v xmllint >/dev/null") != 0)
        SKIP("xmllint is not installed");
    cli_path("c.xml", path);
    snprintf(command, sizeof command, "xmllint --noout '%s'", path);
    assert_int_equal(system(command), 0);
}

/* Every script that was left is one that gnuplot takes without a word; as SVG alone, which is
 * quick. Those of -h and -work are as -k and -schemes. */
TEST(test_scripts)
{
    static const char draw[] =
        "cd '%s' && said=$(find . -name '*.gp' ! -name '*-h.*' ! -name '*-work.*' -execdir sh -c "
        "'sed s/svg.png.pdf/svg/ \"$1\" | \"$GNUPLOT\" --default-settings 2>&1 || echo \"$1\"' "
        "sh {} \\;) && test -z \"$said\" || { echo \"$said\"; false; }";
    char command[1024];
    if (!getenv("GNUPLOT"))
        SKIP("gnuplot is not installed");
    snprintf(command, sizeof command, draw, cli_folder());
    assert_int_equal(system(command), 0);
    look_at_all();
}

/* A name as long as a file's may be: what is written for it has names that the disk takes. */
TEST(test_long)
{
    char name[256], title[1200];
    memset(name, 'n', 240);
    memset(title, '\'', 1100);
    name[240] = title[1100] = '\0';
    const struct stranger s = {name, title};
    write_scene(&s);
    for (size_t c = 0; c < 5; c++)
        run_command(&s, c, c == 1 ? NULL : "/nonexistent");
}

AROUND_TESTS(cli_make_folder, cli_remove_folder)
