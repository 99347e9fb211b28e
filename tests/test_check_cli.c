/* SPDX-License-Identifier: GPL-3.0-or-later */
/* beamrate check as a CI job meets it: exit codes, messages, reports. */
#include <fcntl.h>
#include <jansson.h>
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli_driver.h"
#include "reference/judge.h"
#include "solver/linear/riccati/kernel.h"
#include "support.h"

/* A scene that takes no time, with its verify part; lines 11 to 13. */
#define SCENE                       \
    "title: T & <\"pull\"> | ]]>\n" \
    "length: 1 m\n"                 \
    "duration: 1 s\n"               \
    "density: 1 kg/m\n"             \
    "axial:\n"                      \
    "  stiffness: 1 N\n"            \
    "  viscosity: 1 N s\n"          \
    "  load: sin(x)*(1 + t) [N/m]\n"
#define SPACE                      \
    "verify:\n"                    \
    "  space:\n"                   \
    "    n: 10, 20, 40, 80, 160\n" \
    "    k: 0.1 s\n"

#define SLOW                              \
    "title: slow\n"                       \
    "length: 2 m\n"                       \
    "duration: 1 s\n"                     \
    "density: 1 kg/m\n"                   \
    "axial:\n"                            \
    "  stiffness: 1 N\n"                  \
    "  viscosity: 0.1 N s\n"              \
    "  load: sin(50*t*x) [N/m]\n"         \
    "verify:\n"                           \
    "  joint:\n"                          \
    "    n: 2, 4, 8, 16\n"                \
    "    k: 0.1, 0.05, 0.025, 0.0125 s\n" \
    "    l2: 1 +- 0.9\n"

static void test_verdicts(void **state)
{
    (void)state;
    cli_write_file("good.yaml", SCENE SPACE "    l2: 2 +- 0.1\n");
    cli_write_file("bad.yaml", SCENE SPACE "    l2: 3 +- 0.1\n");
    cli_write_file("plain.yaml", SCENE);
    cli_expect("check good.yaml", NULL, 0, "1 order in 1 scene: 1 PASS, 0 FAIL, 0 INCONCLUSIVE");
    cli_expect("check bad.yaml", NULL, 1, "lies below the band, 2.9 to 3.1");
    cli_expect("check bad.yaml --quiet", NULL, 1, "1 of 1 orders do not pass");
    cli_expect("check good.yaml bad.yaml", NULL, 1, "1 PASS, 1 FAIL");
    cli_expect("check plain.yaml", NULL, 0,
               "plain.yaml has no verify part; these are the defaults");
    cli_expect("check bad.yaml plain.yaml good.yaml --fail-fast", NULL, 1,
               "stopped at the first scene that failed");
    cli_expect("check good.yaml --contact implicit --solver umfpack --threads 2", NULL, 0, "PASS");
    cli_expect("check good.yaml --solver riccati --kernel portable --json k.json", NULL, 0, "PASS");
    assert_true(cli_file_contains("k.json", "\"kernel\": \"portable\""));
    cli_expect("help methods", NULL, 0, "\n  portable        available here\n");
}

/* Error of the finest mesh in a check's JSON. */
static double last_error(const char *name)
{
    char path[512];
    cli_path(name, path);
    json_t *root = json_load_file(path, 0, NULL);
    assert_non_null(root);
    const json_t *points = json_object_get(json_object_get(root, "tables"), "points");
    const json_t *last = json_array_get(points, json_array_size(points) - 1);
    const double value = json_real_value(json_object_get(last, "error"));
    json_decref(root);
    return value;
}

/* Verdicts hold whichever way the marches round; their last digits do not. */
static void test_rounding(void **state)
{
    (void)state;
    cli_write_file("good.yaml", SCENE SPACE "    l2: 2 +- 0.1\n");
    cli_expect("check good.yaml --json nearest.json", NULL, 0, "1 PASS");
    cli_expect("check good.yaml --rounding up --json up.json", NULL, 0, "1 PASS");
    cli_expect("check good.yaml --rounding zero --json zero.json", NULL, 0, "1 PASS");
    const double nearest = last_error("nearest.json"), up = last_error("up.json");
    assert_true(nearest > 0);
    assert_true(up != nearest);
    assert_true(up != last_error("zero.json"));
    assert_true(fabs(up / nearest - 1) < 1e-6);
}

/* A scene that cannot be verified is an error, and the verdicts on the others are not lost. */
static void test_refusals(void **state)
{
    (void)state;
    cli_write_file("good.yaml", SCENE SPACE "    l2: 2 +- 0.1\n");
    cli_write_file("beyond.yaml", "title: T\nlength: 1 m\nduration: 1 s\ndensity: 0 kg/m\n"
                                  "axial:\n  stiffness: 1 N\n  viscosity: 0 N s\n  load: x [N/m]\n"
                                  "verify:\n  joint:\n    n: 10, 20, 40, 80\n"
                                  "    k: 0.5, 0.25, 0.125, 0.0625 s\n    l2: 1 +- .1\n");
    cli_expect("check good.yaml beyond.yaml --junit b.xml --tap b.tap", NULL, 2,
               "1 PASS, 0 FAIL, 0 INCONCLUSIVE, 1 cannot be verified");
    assert_true(cli_file_contains("b.xml", "tests=\"2\" failures=\"0\" errors=\"1\""));
    assert_true(cli_file_contains("b.tap", "1..2\nok 1 - good, space l2 total: PASS\n"));
    assert_true(cli_file_contains("b.tap", "\nnot ok 2 - beyond, verify: ERROR\n"));
}

/* A JSON that is none of a check's. */
static void test_strange_baselines(void **state)
{
    (void)state;
    cli_write_file("good.yaml", SCENE SPACE "    l2: 2 +- 0.1\n");
    static const char *const texts[] = {
        "{}",
        "[]",
        "{\"format\": \"beamrate check 9\", \"scenes\": []}",
        "{\"format\": \"beamrate check\", \"version\": 9, \"tables\": {\"scenes\": []}}",
        "{\"format\": \"beamrate check\", \"version\": 2, \"scenes\": []}",
        "{\"format\": \"beamrate check\", \"version\": 2, \"tables\": {\"scenes\": [3]}}",
        "{\"format\": \"beamrate check\", \"version\": 2, \"tables\": {\"orders\": "
        "[{\"scene\": \"a\"}], \"scenes\": [{\"scene\": \"a\", \"seconds\": 1, "
        "\"element_steps\": 1}]}}",
        "{\"format\": \"beamrate check 1\"}",
        "{\"format\": \"beamrate check 1\", \"scenes\": [3]}",
        "{\"format\": \"beamrate check 1\", \"scenes\": [{\"scene\": \"a\", \"seconds\": 1, "
        "\"element_steps\": 1}]}",
        "{\"format\": \"beamrate check 1\", \"scenes\": [{\"scene\": \"a\", \"seconds\": 1, "
        "\"element_steps\": 1, \"cases\": [{}]}]}",
        "{\"format\": \"beamrate check 1\", \"scenes\": [{\"scene\": \"a\", \"seconds\": 1, "
        "\"element_steps\": -1, \"cases\": []}]}",
        "{\"format\": \"beamrate check 1\", \"scenes\": [{\"scene\": \"a\", \"seconds\": 1, "
        "\"element_steps\": 1, \"cases\": []}, {\"scene\": \"a\", \"seconds\": 1, "
        "\"element_steps\": 1, \"cases\": []}]}",
    };
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        cli_write_file("old.json", texts[i]);
        cli_expect("check good.yaml --compare old.json", NULL, 2, "old.json: ");
    }
    cli_write_file("old.json", "{\"format\": \"beamrate check 1\", \"scenes\": []}");
    cli_expect("check good.yaml --compare old.json", NULL, 2,
               "none of these scenes is in the earlier check");
}

static char *contents(const char *name)
{
    char path[512];
    static char text[1 << 16];
    cli_path(name, path);
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    text[fread(text, 1, sizeof text - 1, file)] = '\0';
    fclose(file);
    return text;
}

/* Every tag that opens closes, in the right order, and no text holds a bare & or <. */
static void check_xml(const char *text)
{
    char stack[32][64];
    size_t depth = 0;
    const char *at = strstr(text, "?>");
    assert_non_null(at);
    for (at += 2; *at; at++) {
        if (*at == '&')
            assert_true(strncmp(at, "&amp;", 5) == 0 || strncmp(at, "&lt;", 4) == 0 ||
                        strncmp(at, "&gt;", 4) == 0 || strncmp(at, "&quot;", 6) == 0);
        if (*at != '<')
            continue;
        const size_t length = strcspn(at + 1, " />\n");
        const char *end = strchr(at, '>');
        assert_non_null(end);
        if (at[1] == '/') {
            assert_true(depth > 0);
            depth--;
            assert_memory_equal(stack[depth], at + 2, strlen(stack[depth]));
        } else if (end[-1] != '/') {
            assert_true(depth < 32 && length < 64);
            snprintf(stack[depth++], 64, "%.*s", (int)length, at + 1);
        }
        at = end;
    }
    assert_int_equal(depth, 0);
}

/* A scene whose name is markup. */
static void test_reports(void **state)
{
    (void)state;
    cli_write_file("a & <b> \"c\".yaml", SCENE SPACE "    l2: 3 +- 0.1, at most 1 m^(3/2)\n");
    cli_write_file("good.yaml", SCENE SPACE "    l2: 2 +- 0.1\n    tip: 2 +- 0.5\n");
    char *const line[] = {
        "check", "a & <b> \"c\".yaml", "good.yaml", "--junit", "r.xml", "--json", "r.json", "--tap",
        "r.tap", "--markdown",         "r.md",      NULL};
    struct cli_outcome *out = calloc(1, sizeof *out);
    assert_non_null(out);
    cli_run((const char *const *)line, NULL, out);
    assert_int_equal(out->exit_code, 1);
    free(out);

    const char *xml = contents("r.xml");
    check_xml(xml);
    assert_non_null(strstr(xml, "\n  file: a &amp; &lt;b&gt; &quot;c&quot;.yaml\n"));
    assert_null(strstr(xml, "<propert")); /* the schemas have none in a test case */
    assert_non_null(strstr(contents("r.md"), "- **FAIL** a \\_ \\_b\\_ \\_c\\_, space l2 total"));
}

/* A report on standard output stands there alone. */
static void test_standard_output(void **state)
{
    (void)state;
    cli_write_file("good.yaml", SCENE SPACE "    l2: 2 +- 0.1\n");
    struct cli_outcome *out = calloc(1, sizeof *out);
    assert_non_null(out);
    cli_run_line("check good.yaml --tap -", NULL, out);
    assert_int_equal(out->exit_code, 0);
    assert_int_equal(strncmp(out->output, "TAP version 14\n", 15), 0);
    assert_null(strstr(out->output, "scene   "));
    free(out);
    cli_expect("check good.yaml --tap /dev/null", NULL, 0, "PASS");
    struct stat info;
    assert_int_equal(stat("/dev/null", &info), 0);
    assert_true(S_ISCHR(info.st_mode)); /* it was written to, not replaced */
}

/* A symbolic link is followed, not replaced; one to nothing is refused. */
static void test_links(void **state)
{
    (void)state;
    char link[512];
    struct stat info;
    cli_write_file("good.yaml", SCENE SPACE "    l2: 2 +- 0.1\n");
    cli_write_file("behind.json", "old\n");
    cli_path("link.json", link);
    assert_int_equal(symlink("behind.json", link), 0);
    cli_expect("check good.yaml --json link.json", NULL, 0, "PASS");
    assert_int_equal(lstat(link, &info), 0);
    assert_true(S_ISLNK(info.st_mode));
    assert_true(cli_file_contains("behind.json", "\"tally\""));
    cli_path("dangling.json", link);
    assert_int_equal(symlink("nowhere.json", link), 0);
    cli_expect("check good.yaml --json dangling.json", NULL, 2, "cannot write 'dangling.json'");
}

/* A report is written whole or not at all, and an old one stays until then. */
static void test_whole_files(void **state)
{
    (void)state;
    cli_write_file("good.yaml", SCENE SPACE "    l2: 2 +- 0.1\n");
    cli_write_file("kept.json", "old\n");
    const size_t files = cli_count_files(".");
    cli_expect("check good.yaml --json kept.json", &(struct cli_circumstances){.file_size = 1200},
               3, "kept.json could not be written whole");
    assert_string_equal(contents("kept.json"), "old\n");
    cli_expect("check nowhere --json kept.json", NULL, 2, "nowhere");
    cli_expect("check example4 --json kept.json",
               &(struct cli_circumstances){.interrupt_after = 50}, -2, "interrupted");
    assert_string_equal(contents("kept.json"), "old\n");
    assert_int_equal(cli_count_files("."), files);
}

static void test_compare(void **state)
{
    (void)state;
    cli_write_file("good.yaml", SCENE SPACE "    l2: 2 +- 0.1\n    tip: 2 +- 0.5\n");
    cli_expect("check good.yaml --json old.json", NULL, 0, "2 PASS");
    cli_expect("check good.yaml --compare old.json", NULL, 0, "0 serious");
    cli_expect("check good.yaml --solver umfpack --json other.json", NULL, 0, "2 PASS");
    cli_expect("check good.yaml --solver umfpack --scaling sum --refinement 2 --compare other.json",
               NULL, 0, "scaling none before, sum now");
    cli_expect("check good.yaml --solver umfpack --scaling sum --refinement 2 --compare other.json",
               NULL, 0, "refinement 0 before, 2 now");
    /* twice the load: the orders stay, the constants double */
    cli_write_file("good.yaml", "title: T\nlength: 1 m\nduration: 1 s\ndensity: 1 kg/m\n"
                                "axial:\n  stiffness: 1 N\n  viscosity: 1 N s\n"
                                "  load: 2.1*sin(x)*(1 + t) [N/m]\n" SPACE
                                "    l2: 2 +- 0.1\n    tip: 2 +- 0.5\n");
    cli_expect("check good.yaml --compare old.json", NULL, 1, "2 serious");
    cli_expect("check good.yaml --compare old.json", NULL, 1,
               "serious   good space l2 total: constant");
    cli_write_file("good.yaml", SCENE SPACE "    l2: 2 +- 0.1\n");
    cli_expect("check good.yaml --compare old.json", NULL, 1, "good space tip total: gone");
    cli_expect("check good.yaml --compare old.json --json old.json", NULL, 2,
               "--json would replace what it is compared with");
    cli_expect("check good.yaml ./good.yaml --compare old.json", NULL, 2,
               "two scenes are called good");
}

/* All bundled scenes pass; those that this build cannot check are named. */
static void test_all(void **state)
{
    (void)state;
    if (br_test_quick())
        skip();
    cli_expect("check --all", NULL, 0, "0 FAIL, 0 INCONCLUSIVE");
    char path[512];
    cli_path("study", path);
    assert_int_equal(mkdir(path, 0777), 0);
    cli_expect("check --all", &(struct cli_circumstances){.data = cli_folder()}, 2,
               "the bundled scenes: ");
    cli_path("study/scenes", path);
    assert_int_equal(mkdir(path, 0777), 0);
    cli_expect("check --all", &(struct cli_circumstances){.data = cli_folder()}, 1,
               "no order was checked");
}

/* ---- provenance ---- */

/* It is kept whole, however long. */
static void test_long_command_line(void **state)
{
    (void)state;
    enum { SCENES = 6 };
    static struct cli_outcome out;
    char name[SCENES][900], path[512];
    const char *word[CLI_MOST_WORDS] = {"check", "--json", "long.json"};
    char expected[SCENES * sizeof name[0] + 100] = "";
    for (int i = 0; i < SCENES; i++) {
        for (size_t j = 0; j < sizeof name[i] - 20; j += 2)
            strcpy(name[i] + j, "./");
        sprintf(name[i] + strlen(name[i]), "long%d.yaml", i);
        cli_write_file(strrchr(name[i], '/') + 1, SCENE SPACE "    l2: 2 +- 0.1\n");
        word[3 + i] = name[i];
        strcat(strcat(expected, " "), name[i]);
    }
    cli_run(word, NULL, &out);
    assert_int_equal(out.exit_code, 0);
    cli_path("long.json", path);
    json_t *root = json_load_file(path, 0, NULL);
    const char *line =
        json_string_value(json_object_get(json_object_get(root, "provenance"), "command_line"));
    assert_non_null(line);
    assert_string_equal(line + strlen(line) - strlen(expected), expected);
    json_decref(root);
}

/* ---- a terminal ---- */

struct terminal {
    int end;
    char shown[1 << 16];
};

/* Keeps what a terminal shows, until nobody writes to it any more. */
static void *watch_terminal(void *self)
{
    struct terminal *t = self;
    size_t used = 0;
    for (ssize_t got; (got = read(t->end, t->shown + used, sizeof t->shown - 1 - used)) > 0;)
        used += (size_t)got;
    return NULL;
}

/* The load is one of x and t, which the exact reference approximates first, for long. */
static void test_waiting(void **state)
{
    (void)state;
    static struct terminal terminal;
    static struct cli_outcome out;
    static const char what[] =
        "checking [........................................] 0 %, exact reference: ";
    char name[64];
    pthread_t reader;
    cli_write_file("slow.yaml", SLOW);
    terminal.end = posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
    assert_true(terminal.end >= 0 && grantpt(terminal.end) == 0 && unlockpt(terminal.end) == 0);
    assert_int_equal(ptsname_r(terminal.end, name, sizeof name), 0);
    const int open_meanwhile = open(name, O_RDWR | O_NOCTTY | O_CLOEXEC);
    assert_int_equal(pthread_create(&reader, NULL, watch_terminal, &terminal), 0);
    cli_run_line("check slow.yaml", &(struct cli_circumstances){.errors = name}, &out);
    close(open_meanwhile);
    assert_int_equal(pthread_join(reader, NULL), 0);
    close(terminal.end);
    const char *first = strstr(terminal.shown, what);
    assert_non_null(first);
    const char *second = strstr(first + 1, what);
    if (!second || !(atof(second + strlen(what)) > atof(first + strlen(what))))
        fail_msg("nothing moves: %s", terminal.shown);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_long_command_line),
        cmocka_unit_test(test_waiting),
        cmocka_unit_test(test_verdicts),
        cmocka_unit_test(test_rounding),
        cmocka_unit_test(test_refusals),
        cmocka_unit_test(test_strange_baselines),
        cmocka_unit_test(test_reports),
        cmocka_unit_test(test_standard_output),
        cmocka_unit_test(test_whole_files),
        cmocka_unit_test(test_compare),
        cmocka_unit_test(test_links),
        cmocka_unit_test(test_all),
    };
    return cmocka_run_group_tests(tests, cli_make_folder, cli_remove_folder);
}
