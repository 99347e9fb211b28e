/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The benchmark: meson test --benchmark -C build/release
 *     bench [FILE]              runs it and writes its rows to FILE, or to $BEAMRATE_BENCHMARK
 *     bench --compare OLD NEW   prints the rows of two such files beside each other
 * It prints times and writes them, and fails on wrong results only. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/provenance.h"
#include "tests/bench/bench.h"

static struct bench_limits limits;
static struct bench bench = {.limits = &limits};

static int set_up(void **state)
{
    bench.rows = json_array();
    *state = &bench;
    return bench.rows ? 0 : -1;
}

static int report(enum br_status status, const struct br_error *err)
{
    if (status)
        fprintf(stderr, "bench: %s\n", err->message);
    return br_status_exit_code(status);
}

/* Whether the file can be written, before the long work. */
static enum br_status check_path(const char *path, struct br_error *err)
{
    FILE *file = path ? fopen(path, "a") : NULL;
    if (file)
        fclose(file);
    return path && !file ? br_fail(err, BR_BAD_INPUT, "%s: %s", path, strerror(errno)) : BR_OK;
}

static enum br_status write_to(const char *path, struct br_error *err)
{
    const enum br_status status = path ? bench_write(&bench, path, err) : BR_OK;
    if (path && !status)
        printf("\n%s was written; bench --compare OLD NEW shows two of them\n", path);
    return status;
}

int main(int argc, const char **argv)
{
    struct br_error err = {0};
    if (argc == 4 && strcmp(argv[1], "--compare") == 0)
        return report(bench_compare(argv[2], argv[3], &err), &err);
    if (argc > 2 || (argc == 2 && argv[1][0] == '-')) {
        fprintf(stderr, "usage: bench [FILE] | bench --compare OLD NEW\n");
        return br_status_exit_code(BR_BAD_INPUT);
    }
    const char *variable = getenv("BEAMRATE_BENCHMARK");
    const char *path = variable && *variable ? variable : argc == 2 ? argv[1] : NULL;
    if (check_path(path, &err))
        return report(err.status, &err);
    if (br_remember_command_line(argc, argv, &err))
        return report(err.status, &err);
    const struct CMUnitTest sections[] = {
        cmocka_unit_test(bench_accuracy),    cmocka_unit_test(bench_machine),
        cmocka_unit_test(bench_speed),       cmocka_unit_test(bench_loads),
        cmocka_unit_test(bench_expressions), cmocka_unit_test(bench_models),
        cmocka_unit_test(bench_peers),       cmocka_unit_test(bench_errors),
    };
    const int failed = cmocka_run_group_tests(sections, set_up, NULL);
    const enum br_status status = write_to(path, &err);
    json_decref(bench.rows);
    return failed ? 1 : report(status, &err);
}
