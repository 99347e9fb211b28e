/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/provenance.h"
#include "tables/json_value.h"
#include "tests/bench/bench.h"

static json_t *add_row(struct bench *b, const char *format, va_list arguments)
{
    char name[256];
    vsnprintf(name, sizeof name, format, arguments);
    json_t *row = json_object();
    json_object_set_new(row, "name", json_string(name));
    json_array_append_new(b->rows, row);
    return row;
}

void bench_record(struct bench *b, const char *unit, const struct bench_time *t, const char *name,
                  ...)
{
    va_list arguments;
    va_start(arguments, name);
    json_t *row = add_row(b, name, arguments);
    va_end(arguments);
    json_object_set_new(row, "unit", json_string(unit));
    json_object_set_new(row, "value", br_json_number(t->median));
    json_object_set_new(row, "min", br_json_number(t->least));
    json_object_set_new(row, "max", br_json_number(t->most));
}

void bench_record_value(struct bench *b, const char *unit, double value, const char *name, ...)
{
    va_list arguments;
    va_start(arguments, name);
    json_t *row = add_row(b, name, arguments);
    va_end(arguments);
    json_object_set_new(row, "unit", json_string(unit));
    json_object_set_new(row, "value", br_json_number(value));
}

void bench_record_skipped(struct bench *b, const char *reason, const char *name, ...)
{
    va_list arguments;
    va_start(arguments, name);
    json_t *row = add_row(b, name, arguments);
    va_end(arguments);
    json_object_set_new(row, "skipped", json_string(reason));
}

enum br_status bench_write(const struct bench *b, const char *path, struct br_error *err)
{
    struct br_provenance p;
    br_provenance_fill(&p, 1);
    json_t *root = json_pack("{s:{s:s, s:s, s:s, s:s, s:s, s:s}, s:O}", "provenance", "version",
                             p.version, "commit", p.commit, "compiler", p.compiler, "flags",
                             p.flags, "machine", p.machine, "date", p.date, "rows", b->rows);
    const int failed = json_dump_file(root, path, JSON_INDENT(1) | JSON_REAL_PRECISION(6));
    json_decref(root);
    return failed ? br_fail(err, BR_BAD_INPUT, "%s: cannot be written", path) : BR_OK;
}
