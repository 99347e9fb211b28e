/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where a scene may come from: it is read once, and what is parsed is what is kept. */
#include <jansson.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "cli_driver.h"
#include "solver/clock.h"
#include "support.h"

/* Runs a line of bash in the working folder; returns its exit code. */
static int shell(const char *line)
{
    char command[1024];
    snprintf(command, sizeof command, "cd '%s' && exec bash -c \"%s\" > said 2>&1", cli_folder(),
             line);
    const int status = system(command);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

static void write_scene(void)
{
    static struct cli_outcome out;
    cli_run_line("scenes example1", NULL, &out);
    assert_int_equal(out.exit_code, 0);
    cli_write_file("scene.yaml", out.output);
}

/* The scene in the set is the whole file. */
static void expect_kept(const char *name)
{
    char path[512];
    cli_path(name, path);
    json_t *root = json_load_file(path, 0, NULL);
    assert_non_null(root);
    const json_t *text = json_object_get(json_object_get(root, "provenance"), "scene_text");
    if (!text)
        fail_msg("%s: no text of the scene", name);
    assert_string_equal(json_string_value(text), cli_read("scene.yaml"));
    json_decref(root);
}

#define RUN "--n 4 --k 0.1 --quiet --out "

static void test_streams(void **state)
{
    (void)state;
    write_scene();
    assert_int_equal(shell("cat scene.yaml | $BEAMRATE run - " RUN "pipe"), 0);
    expect_kept("pipe/summary.json");
    assert_int_equal(shell("$BEAMRATE run - " RUN "file < scene.yaml"), 0);
    expect_kept("file/summary.json");
    assert_int_equal(shell("$BEAMRATE run <(cat scene.yaml) " RUN "sub"), 0);
    expect_kept("sub/summary.json");
    assert_int_equal(shell("mkfifo fifo; cat scene.yaml > fifo & $BEAMRATE run fifo " RUN "fifos"),
                     0);
    expect_kept("fifos/summary.json");
    assert_int_equal(shell("cat scene.yaml | $BEAMRATE study - --no-plots " RUN "study"), 0);
    expect_kept("study/stdin.json");
    assert_int_equal(shell("cat scene.yaml | $BEAMRATE trade - --split --no-plots " RUN "split"),
                     0);
    expect_kept("split/stdin-split.json");
    assert_int_equal(shell("$BEAMRATE run - " RUN "none < /dev/null"), 2);
    assert_true(cli_file_contains("said", "/dev/stdin:1: scene: the file is empty"));
}

/* Refused, and not cut. */
static void test_long(void **state)
{
    (void)state;
    write_scene();
    assert_int_equal(shell("(cat scene.yaml; yes '# a remark' | head -c 1100000) > long.yaml"), 0);
    cli_expect("run long.yaml --n 4", NULL, 2, "long.yaml: found more than 1048576 bytes");
    assert_int_equal(shell("(cat scene.yaml; yes '# a remark' | head -c 1000000) > most.yaml"), 0);
    cli_expect("run most.yaml --n 4 --k 0.1 --quiet", NULL, 0, "");
    assert_int_equal(shell("printf 'title: a\\\\nlength: \\\\000 1 m' > zero.yaml"), 0);
    cli_expect("run zero.yaml --n 4", NULL, 2, "zero.yaml:2: found a zero byte, expected text");
    assert_int_equal(shell("mkdir folder.yaml"), 0);
    cli_expect("run folder.yaml --n 4", NULL, 2, "folder.yaml: Is a directory");
}

/* Deep nesting takes libyaml minutes: it is refused before. */
static void test_deep(void **state)
{
    (void)state;
    const double start = br_seconds();
    assert_int_equal(shell("(echo 'title: a'; printf 'length: '; printf '[%.0s' {1..100000}) "
                           "> flow.yaml"),
                     0);
    assert_int_equal(shell("printf -- '- %.0s' {1..100000} > block.yaml"), 0);
    assert_int_equal(shell("printf -- '{a: %.0s' {1..100000} > map.yaml"), 0);
    cli_expect("run flow.yaml", NULL, 2, "flow.yaml:2: scene: found lists or mappings nested");
    cli_expect("check block.yaml", NULL, 2, "block.yaml:1: scene: found lists or mappings nested");
    cli_expect("study map.yaml", NULL, 2, "map.yaml:1: scene: found lists or mappings nested");
    AT_MOST(br_seconds() - start, 10);
}

/* A pipe that nobody writes to: the first signal ends it. */
static void test_signal(void **state)
{
    (void)state;
    static struct cli_outcome out;
    assert_int_equal(shell("mkfifo silent"), 0);
    cli_run_line("run silent", &(struct cli_circumstances){.interrupt_after = 300}, &out);
    assert_int_equal(out.exit_code, -SIGINT);
    assert_non_null(strstr(out.output, "interrupted"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_streams),
        cmocka_unit_test(test_long),
        cmocka_unit_test(test_deep),
        cmocka_unit_test(test_signal),
    };
    return cmocka_run_group_tests(tests, cli_make_folder, cli_remove_folder);
}
