/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The benchmark: meson test --benchmark -C build/release
 *     bench [FILE]   runs it and writes its rows to FILE, or to $BEAMRATE_BENCHMARK
 * It prints times and writes them, and fails on wrong results only. */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/provenance.h"
#include "tables/json_value.h"
#include "tests/bench/bench.h"

static json_t *rows;

/* ---- rows ---- */

json_t *bench_row(const char *format, ...)
{
    char name[256];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(name, sizeof name, format, arguments);
    va_end(arguments);
    json_t *row = json_object();
    json_object_set_new(row, "name", json_string(name));
    json_array_append_new(rows, row);
    return row;
}

/* What is not finite is null. */
static json_t *number(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

void bench_put(json_t *row, const char *unit, double value)
{
    json_object_set_new(row, "unit", json_string(unit));
    json_object_set_new(row, "value", number(value));
}

void bench_put_time(json_t *row, const char *unit, const struct bench_time *t)
{
    bench_put(row, unit, t->median);
    json_object_set_new(row, "min", number(t->least));
    json_object_set_new(row, "max", number(t->most));
}

void bench_put_skipped(json_t *row, const char *reason)
{
    json_object_set_new(row, "skipped", json_string(reason));
}

static enum br_status write_to(const char *path, struct br_error *why)
{
    struct br_provenance p;
    br_provenance_fill(&p, 1);
    json_t *root = json_pack("{s:{s:s, s:s, s:s, s:s, s:s, s:s}, s:O}", "provenance", "version",
                             p.version, "commit", p.commit, "compiler", p.compiler, "flags",
                             p.flags, "machine", p.machine, "date", p.date, "rows", rows);
    const int failed = json_dump_file(root, path, JSON_INDENT(1) | JSON_REAL_PRECISION(6));
    json_decref(root);
    if (failed)
        return br_fail(why, BR_BAD_INPUT, "%s: cannot be written", path);
    printf("\n%s was written\n", path);
    return BR_OK;
}

/* ---- the program ---- */

static int set_up(void **state)
{
    (void)state;
    rows = json_array();
    return rows ? 0 : -1;
}

static int report(enum br_status status, const struct br_error *why)
{
    if (status)
        fprintf(stderr, "bench: %s\n", why->message);
    return br_status_exit_code(status);
}

/* Whether the file can be written, before the long work. */
static enum br_status check_path(const char *path, struct br_error *why)
{
    FILE *file = path ? fopen(path, "a") : NULL;
    if (file)
        fclose(file);
    return path && !file ? br_fail(why, BR_BAD_INPUT, "%s: %s", path, strerror(errno)) : BR_OK;
}

int main(int argc, const char **argv)
{
    if (argc > 2 || (argc == 2 && argv[1][0] == '-')) {
        fprintf(stderr, "usage: bench [FILE]\n");
        return br_status_exit_code(BR_BAD_INPUT);
    }
    const char *variable = getenv("BEAMRATE_BENCHMARK");
    const char *path = variable && *variable ? variable : argc == 2 ? argv[1] : NULL;
    if (check_path(path, &err) || br_remember_command_line(argc, argv, &err))
        return report(err.status, &err);
    const struct CMUnitTest sections[] = {
        cmocka_unit_test(bench_speed),
        cmocka_unit_test(bench_loads),
    };
    const int failed = cmocka_run_group_tests(sections, set_up, NULL);
    const enum br_status status = path ? write_to(path, &err) : BR_OK;
    json_decref(rows);
    return failed ? 1 : report(status, &err);
}
