/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Prints two files of the benchmark beside each other, without a verdict. */
#include <stdio.h>
#include <string.h>

#include "tests/bench/bench.h"

static json_t *read_file(const char *label, const char *path, struct br_error *err)
{
    json_error_t why = {.text = "found no rows, expected a file of the benchmark"};
    const char *commit, *compiler, *machine, *date;
    json_t *root = json_load_file(path, 0, &why), *rows;
    if (root && json_unpack_ex(root, &why, 0, "{s:{s:s, s:s, s:s, s:s}, s:o}", "provenance",
                               "commit", &commit, "compiler", &compiler, "machine", &machine,
                               "date", &date, "rows", &rows) == 0) {
        printf("%s: %s, %s, %s, %s\n", label, commit, compiler, machine, date);
        return root;
    }
    br_fail(err, BR_BAD_INPUT, "%s:%d: %s", path, why.line, why.text);
    json_decref(root);
    return NULL;
}

static const char *text_of(const json_t *row, const char *key)
{
    const char *text = json_string_value(json_object_get(row, key));
    return text ? text : "";
}

/* The fastest repeat, or the value; 0: neither. */
static double number_of(const json_t *row)
{
    const json_t *least = json_object_get(row, "min");
    return json_number_value(least ? least : json_object_get(row, "value"));
}

static const json_t *row_of(const json_t *root, const char *name)
{
    size_t i;
    json_t *row;
    json_array_foreach(json_object_get(root, "rows"), i, row)
    {
        if (strcmp(text_of(row, "name"), name) == 0)
            return row;
    }
    return NULL;
}

/* A number, or "-" where there is none. */
static void print_number(double x, const char *format)
{
    char text[32] = "-";
    if (x > 0)
        snprintf(text, sizeof text, format, x);
    printf(" %12s", text);
}

static void print_rows(const json_t *old, const json_t *new)
{
    size_t i;
    json_t *row;
    printf("%-48s %-22s %12s %12s %12s\n", "row (the least where there are repeats)", "unit", "old",
           "new", "new/old");
    json_array_foreach(json_object_get(new, "rows"), i, row)
    {
        const char *name = text_of(row, "name");
        const json_t *before = row_of(old, name);
        const double now = number_of(row), then = before ? number_of(before) : 0;
        printf("%-48s %-22s", name, text_of(row, "unit"));
        print_number(then, "%.4g");
        print_number(now, "%.4g");
        print_number(then > 0 ? now / then : 0, "%.2f");
        printf("\n");
    }
    json_array_foreach(json_object_get(old, "rows"), i, row)
    {
        if (!row_of(new, text_of(row, "name")))
            printf("%-48s is gone\n", text_of(row, "name"));
    }
}

enum br_status bench_compare(const char *old_path, const char *new_path, struct br_error *err)
{
    json_t *old = read_file("old", old_path, err);
    json_t *new = old ? read_file("new", new_path, err) : NULL;
    if (new)
        print_rows(old, new);
    json_decref(old);
    json_decref(new);
    return new ? BR_OK : err->status;
}
