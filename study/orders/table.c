/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A source of numbers: a table in a file. What a column is, its heading tells. */
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "study/orders/request.h"
#include "study/scene/quote.h"
#include "study/scene/words.h"

/* A table that is made into numbers. Rows and columns count from 1. */
struct source {
    const struct br_orders_request *request;
    const char *path;
    json_t *table;
    size_t rows, columns;
    struct br_numbers *numbers;
    char aside[200]; /* the columns that are not studied, "rate, time" */
};

static json_t *field_at(const struct source *s, size_t row, size_t column)
{
    return json_array_get(json_array_get(s->table, row), column);
}

static const char *heading(const struct source *s, size_t column)
{
    return json_string_value(field_at(s, 0, column));
}

static size_t line_of(const struct source *s, size_t row)
{
    return (size_t)json_integer_value(field_at(s, row, 0));
}

/* ---- headings ---- */

/* Other names of columns of resolutions, as plain() has them. rank: of an axis's columns the least
 * one states the resolution. */
static const struct {
    const char *name, *column;
    int rank;
} synonyms[] = {
    {"h", "h", 0},          {"dx", "h", 0},          {"\xce\x94x", "h", 0},
    {"deltax", "h", 0},     {"meshsize", "h", 0},    {"elementsize", "h", 0},
    {"cellsize", "h", 0},   {"gridsize", "h", 0},    {"gridspacing", "h", 0},
    {"spacing", "h", 0},    {"hmax", "h", 0},        {"n", "n", 1},
    {"nx", "n", 1},         {"nel", "n", 1},         {"nelements", "n", 1},
    {"ncells", "n", 3},     {"cells", "n", 3},       {"elements", "n", 3},
    {"nelem", "n", 3},      {"numelem", "n", 3},     {"numelements", "n", 3},
    {"numberofelements", "n", 3}, {"numberofcells", "n", 3}, {"level", "level", 1},  {"lvl", "level", 1},     {"refinement", "level", 1},
    {"refinements", "level", 1}, {"dofs", "dofs", 2}, {"dof", "dofs", 2},
    {"ndofs", "dofs", 2},   {"ndof", "dofs", 2},     {"numdofs", "dofs", 2},
    {"unknowns", "dofs", 2}, {"degreesoffreedom", "dofs", 2},
    {"k", "k", 0},          {"dt", "dt", 0},         {"\xce\x94t", "dt", 0},
    {"deltat", "dt", 0},    {"timestep", "dt", 0},   {"stepsize", "dt", 0},
    {"tau", "dt", 0},       {"\xcf\x84", "dt", 0},   {"steps", "steps", 1},
    {"nt", "steps", 1},     {"nsteps", "steps", 1},  {"timesteps", "steps", 1},
    {"numsteps", "steps", 1},
};
enum { SYNONYMS = sizeof synonyms / sizeof *synonyms, RANK_OF_CELLS = 3, NOT_ONE = -1 };

/* Columns with one of these words are no errors, unless they are asked for. The first are orders
 * from row to row. */
static const char *const of_runs[] = {
    "rate",   "rates", "eoc", "ooc",  "roc",      "order",   "orders", "slope", "r",
    "ratio",  "red",   "time", "times", "cpu",    "wall",    "walltime", "seconds", "sec",
    "iter",   "iters", "its", "iterations", "cycle", "index", "memory"};
enum { OF_RUNS = sizeof of_runs / sizeof *of_runs, RATES = 9 };

enum { LONGEST_NAME = 200 };

/* The letters and digits of a name, in small letters. */
static void plain(const char *name, char text[LONGEST_NAME])
{
    size_t length = 0;
    for (; *name && length + 1 < LONGEST_NAME; name++)
        if (isalnum((unsigned char)*name) || (unsigned char)*name >= 0x80)
            text[length++] = (char)tolower((unsigned char)*name);
    text[length] = '\0';
}

/* The row of `synonyms` for a heading; NOT_ONE: it is no resolution. */
static int find_synonym(const char *name)
{
    char text[LONGEST_NAME];
    plain(name, text);
    for (int i = 0; i < SYNONYMS; i++)
        if (strcmp(text, synonyms[i].name) == 0)
            return i;
    return NOT_ONE;
}

/* Whether a name has one of the first `count` words of of_runs. */
static bool is_of_run(const char *name, size_t count)
{
    char word[LONGEST_NAME];
    while (*name) {
        size_t length = 0;
        for (; *name && !isalpha((unsigned char)*name); name++)
            continue;
        for (; isalpha((unsigned char)*name) && length + 1 < LONGEST_NAME; name++)
            word[length++] = (char)tolower((unsigned char)*name);
        word[length] = '\0';
        for (size_t i = 0; i < count && length; i++)
            if (strcmp(word, of_runs[i]) == 0)
                return true;
        if (length + 1 == LONGEST_NAME)
            return false;
    }
    return false;
}

/* "n, l2, rate": the headings, for a refusal. */
static const char *list_headings(const struct source *s, char *text, size_t size)
{
    char name[80];
    text[0] = '\0';
    for (size_t i = 1; i <= s->columns; i++)
        if (heading(s, i))
            br_append(text, size, "%s%s", text[0] ? ", " : "",
                      br_quoted(name, sizeof name, &br_for_text, heading(s, i)));
    return text;
}

/* Splits "dt [s]" or "dt (s)" in place, at the last bracket; NULL: there is no unit. */
static char *split_unit(char *heading)
{
    const size_t length = strlen(heading);
    const char last = length ? heading[length - 1] : '\0';
    char *open = last == ']' ? strrchr(heading, '[') : last == ')' ? strrchr(heading, '(') : NULL;
    if (!open || open == heading)
        return NULL;
    heading[length - 1] = '\0';
    char *end = open;
    while (end > heading && isspace((unsigned char)end[-1]))
        end--;
    *end = '\0';
    return open[1] ? open + 1 : NULL;
}

/* ---- numbers ---- */

/* Fortran's exponents are D or Q, or have no letter where they need three digits. */
bool br_table_number(const char *text, double *value)
{
    char number[64];
    size_t length = 0;
    for (; *text && length + 2 < sizeof number; text++) {
        const bool digit = length && (isdigit((unsigned char)number[length - 1]) ||
                                      number[length - 1] == '.');
        const bool exponent = digit && strchr("dDqQ", *text);
        if (digit && (*text == '-' || *text == '+'))
            number[length++] = 'e';
        number[length++] = exponent ? 'e' : *text;
    }
    number[length] = '\0';
    const char *end = *text ? NULL : br_read_number(number, value);
    return end && !*end;
}

/* Reads the number of a field; a missing one is NaN. */
static bool is_number(const json_t *field, double *value)
{
    const char *text = json_string_value(field);
    *value = NAN;
    return br_is_missing(text) || br_table_number(text, value);
}

/* Whether a column has a number; then all its fields must be numbers. Else it is not studied. */
static bool has_number(const struct source *s, size_t column)
{
    double value;
    for (size_t i = 1; i <= s->rows; i++)
        if (is_number(field_at(s, i, column), &value) && !isnan(value))
            return true;
    return false;
}

static enum br_status number_at(const struct source *s, size_t row, size_t column, double *value,
                                struct br_error *err)
{
    const json_t *field = field_at(s, row, column);
    if (is_number(field, value))
        return BR_OK;
    return br_fail(err, BR_BAD_INPUT, "%s:%zu: %s: found '%.40s', expected a number", s->path,
                   line_of(s, row), heading(s, column), json_string_value(field));
}

/* ---- columns ---- */

static void put_aside(struct source *s, const char *name)
{
    char text[80];
    if (name)
        br_append(s->aside, sizeof s->aside, "%s%s", s->aside[0] ? ", " : "",
                  br_quoted(text, sizeof text, &br_for_text, name));
}

/* The column that states the resolution of an axis, and the least rank; 0: there is none. */
static size_t best_of_axis(const struct source *s, enum br_axis axis, int *rank)
{
    size_t best = 0;
    for (size_t i = 1; i <= s->columns; i++) {
        const int row = heading(s, i) ? find_synonym(heading(s, i)) : NOT_ONE;
        if (row == NOT_ONE || br_resolution_column_find(synonyms[row].column)->axis != axis)
            continue;
        if (best && synonyms[row].rank >= *rank)
            continue;
        best = i;
        *rank = synonyms[row].rank;
    }
    return best;
}

static double size_at(const struct source *s, size_t row, size_t column, double *given,
                      struct br_error *err)
{
    const int name = find_synonym(heading(s, column));
    if (number_at(s, row, column, given, err))
        return NAN;
    return br_numbers_z(br_resolution_column_find(synonyms[name].column), *given,
                        s->request->dimension);
}

/* Refuses another column of sizes that contradicts the one that is taken; a constant factor is
 * none. Counts of cells and of unknowns need not agree: they are left aside. */
static enum br_status compare_sizes(struct source *s, enum br_axis axis, size_t column,
                                    struct br_error *err)
{
    double factor = NAN, given;
    for (size_t i = 0; i < s->rows; i++) {
        const struct br_numbers_row *row = &s->numbers->row[i];
        const double z = size_at(s, i + 1, column, &given, err);
        if (err->status)
            return err->status;
        factor = i ? factor : z / row->z[axis];
        if (fabs(z / row->z[axis] / factor - 1) <= 1e-6)
            continue;
        if (synonyms[find_synonym(heading(s, column))].rank < 2)
            return br_fail(err, BR_BAD_INPUT, "%s:%zu: %s: found %g, which contradicts %s", s->path,
                           row->line, heading(s, column), given, s->numbers->column[axis]->name);
        put_aside(s, heading(s, column));
        return BR_OK;
    }
    return BR_OK;
}

/* Takes the sizes of an axis, and says from which column. */
static enum br_status take_sizes(struct source *s, enum br_axis axis, struct br_error *err)
{
    struct br_numbers *numbers = s->numbers;
    char name[80];
    int rank = 0;
    const size_t best = best_of_axis(s, axis, &rank);
    if (!best)
        return BR_OK;
    const struct br_resolution_column *column =
        br_resolution_column_find(synonyms[find_synonym(heading(s, best))].column);
    numbers->column[axis] = column;
    for (size_t i = 0; i < s->rows; i++) {
        struct br_numbers_row *row = &numbers->row[i];
        row->z[axis] = size_at(s, i + 1, best, &row->given[axis], err);
        if (err->status)
            return err->status;
    }
    br_append(numbers->taken, sizeof numbers->taken, "%s%s from column %s",
              numbers->taken[0] ? ", " : "", column->states,
              br_quoted(name, sizeof name, &br_for_text, heading(s, best)));
    if (column->is_volume && s->request->assumed_dimension)
        br_append(numbers->taken, sizeof numbers->taken,
                  ", of a mesh in 2 dimensions (assumed: --dimension 3 makes the orders 1.5 times "
                  "as high, 1 half as high)");
    if (rank == RANK_OF_CELLS)
        br_append(numbers->taken, sizeof numbers->taken,
                  ", counted along one side (if all cells of a mesh are counted, call the column "
                  "dofs)");
    for (size_t i = 1; i <= s->columns; i++) {
        const int row = heading(s, i) && i != best ? find_synonym(heading(s, i)) : NOT_ONE;
        if (row != NOT_ONE && br_resolution_column_find(synonyms[row].column)->axis == axis &&
            compare_sizes(s, axis, i, err))
            return err->status;
    }
    return BR_OK;
}

static enum br_status take_quantity(const struct source *s, size_t position, const char *unit,
                                    struct br_error *err)
{
    struct br_numbers *numbers = s->numbers;
    const size_t index = numbers->quantities;
    const char *name = heading(s, position);
    enum br_status status =
        br_numbers_add_quantity(numbers, name, unit, br_lists(s->request->values, name), err);
    for (size_t i = 0; i < s->rows && !status; i++)
        status = number_at(s, i + 1, position, &numbers->row[i].number[index], err);
    return status;
}

static bool is_studied(const struct source *s, size_t position)
{
    const struct br_orders_request *q = s->request;
    const char *name = heading(s, position);
    if (q->errors || q->values)
        return br_lists(q->errors, name) || br_lists(q->values, name);
    return !is_of_run(name, OF_RUNS) && has_number(s, position);
}

/* Takes the unit out of a heading; *unit (out): in `buffer`, or NULL. */
static enum br_status name_column(struct source *s, size_t position, char **buffer,
                                  const char **unit, struct br_error *err)
{
    *unit = NULL;
    *buffer = heading(s, position) ? strdup(heading(s, position)) : NULL;
    if (!heading(s, position))
        return BR_OK;
    if (!*buffer)
        return br_no_memory(err, "the table");
    *unit = split_unit(*buffer);
    if (json_array_set_new(json_array_get(s->table, 0), position, json_string_nocheck(*buffer)))
        return br_no_memory(err, "the table");
    for (size_t i = 1; i < position; i++)
        if (heading(s, i) && strcmp(*buffer, heading(s, i)) == 0)
            return br_fail(err, BR_BAD_INPUT, "%s:%zu: the column '%s' is there twice", s->path,
                           line_of(s, 0), *buffer);
    return BR_OK;
}

static enum br_status take_column(struct source *s, size_t position, struct br_error *err)
{
    const char *unit;
    char *buffer;
    enum br_status status = name_column(s, position, &buffer, &unit, err);
    const int row = !status && buffer ? find_synonym(buffer) : NOT_ONE;
    if (!status && row != NOT_ONE) {
        char **of_axis = &s->numbers->unit[br_resolution_column_find(synonyms[row].column)->axis];
        if (unit && !*of_axis && !(*of_axis = strdup(unit)))
            status = br_no_memory(err, "the table");
    } else if (!status && buffer && is_studied(s, position))
        status = take_quantity(s, position, unit, err);
    else if (!status)
        put_aside(s, buffer);
    free(buffer);
    return status;
}

/* A table of rates without a mesh has rows that halve it, as programs print their own studies. */
static void halve_by_row(const struct source *s)
{
    struct br_numbers *n = s->numbers;
    bool rates = false;
    for (size_t i = 1; i <= s->columns; i++)
        rates |= heading(s, i) && is_of_run(heading(s, i), RATES);
    if (!rates || n->column[BR_AXIS_SPACE] || n->column[BR_AXIS_TIME])
        return;
    n->column[BR_AXIS_SPACE] = br_resolution_column_find("level");
    for (size_t i = 0; i < s->rows; i++) {
        n->row[i].given[BR_AXIS_SPACE] = (double)i;
        n->row[i].z[BR_AXIS_SPACE] = exp2(-(double)i);
    }
    br_append(n->taken, sizeof n->taken,
              "no column of the mesh, so h is assumed to halve from row to row (a column h or n "
              "states it)");
}

/* Says what was taken for what. */
static void state(const struct source *s)
{
    struct br_numbers *n = s->numbers;
    char name[80];
    for (int values = 0; values < 2; values++)
        for (size_t i = 0, found = 0; i < n->quantities; i++)
            if (n->quantity[i].is_value == values)
                br_append(n->taken, sizeof n->taken, "%s%s",
                          found++ ? ", " : values ? "; values: " : "; errors: ",
                          br_quoted(name, sizeof name, &br_for_text, n->quantity[i].name));
    if (s->aside[0])
        br_append(n->taken, sizeof n->taken, "; left aside: %s", s->aside);
}

static enum br_status take_columns(struct source *s, struct br_error *err)
{
    struct br_numbers *numbers = s->numbers;
    char names[300];
    enum br_status status = br_numbers_make_room(numbers, s->rows, s->columns, err);
    for (size_t i = 0; i < s->rows && !status; i++)
        numbers->row[i].line = line_of(s, i + 1);
    for (size_t i = 1; i <= s->columns && !status; i++)
        status = br_observer_stops(s->request->observer)
                     ? br_fail(err, BR_INTERRUPTED, "interrupted")
                     : take_column(s, i, err);
    for (int axis = 0; axis < BR_AXES && !status; axis++)
        status = take_sizes(s, (enum br_axis)axis, err);
    if (!status)
        status = br_orders_check_lists(s->request, numbers, err);
    if (status)
        return status;
    halve_by_row(s);
    state(s);
    if (!numbers->column[BR_AXIS_SPACE] && !numbers->column[BR_AXIS_TIME])
        return br_fail(err, BR_BAD_INPUT,
                       "%s:%zu: found no column of a resolution among %s, expected h, n or dofs, "
                       "or k, dt or steps, or another name of these ('beamrate help orders')",
                       s->path, line_of(s, 0), list_headings(s, names, sizeof names));
    return numbers->quantities
               ? BR_OK
               : br_fail(err, BR_BAD_INPUT,
                         "%s:%zu: found no column of numbers beside the resolution among %s",
                         s->path, line_of(s, 0), list_headings(s, names, sizeof names));
}

enum br_status br_table_read(const struct br_orders_request *q, struct br_numbers *numbers,
                             struct br_error *err)
{
    static const char byte_order_mark[] = "\xef\xbb\xbf"; /* spreadsheet programs write it first */
    const bool marked = strncmp(q->table, byte_order_mark, strlen(byte_order_mark)) == 0;
    const char *text = q->table + (marked ? strlen(byte_order_mark) : 0);
    struct source s = {.request = q, .path = br_orders_path(q), json_array(), .numbers = numbers};
    err->status = BR_OK;
    enum br_status status =
        text[strspn(text, " \t\r\n")] == '{'
            ? br_fail(
                  err, BR_BAD_INPUT,
                  "%s: found JSON, expected columns separated by commas or tabs; jq makes them: "
                  "jq -r '[.h, .error] | @csv'",
                  s.path)
            : br_table_split(text, s.path, false, q->observer, s.table, err);
    s.rows = json_array_size(s.table) ? json_array_size(s.table) - 1 : 0;
    s.columns = json_array_size(json_array_get(s.table, 0)) - 1;
    if (!status)
        status = take_columns(&s, err);
    json_decref(s.table);
    return status;
}
