/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A source of numbers: a table in a file. What a column is, its heading tells. */
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "study/base/quote.h"
#include "study/base/words.h"
#include "study/orders/request.h"

struct column {
    const char *shown; /* the heading in the file; NULL: there is none */
    char *name, *unit; /* without its unit, or as --column names it; owned, and within it or NULL */
    const struct br_resolution_column *size; /* NULL: it states no resolution */
    int rank; /* of an axis's columns the least one states the resolution */
};

/* A table that is made into numbers. Rows and columns count from 1. */
struct source {
    const struct br_orders_request *request;
    const char *path;
    json_t *table;
    size_t rows, columns;
    struct column *column; /* owned */
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

enum { BY_NAME = -1, OF_UNKNOWNS = 2, OF_CELLS };

/* The names of columns of resolutions, as plain() has them, in words. */
static const struct {
    const char *column, *names;
    int rank;
} synonyms[] = {
    {"h", " h dx \xce\x94x deltax meshsize elementsize cellsize gridsize gridspacing spacing hmax ",
     0},
    {"n", " n nx nel nelements resolution cellsperside elementsperside intervals 1h 1dx ", 1},
    {"level", " level lvl reflevel refinement refinements ", 1},
    {"dofs", " dofs dof ndofs ndof numdofs unknowns degreesoffreedom ", OF_UNKNOWNS},
    {"cells", " ncells cells elements nelem numelem numelements numberofelements numberofcells ",
     OF_CELLS},
    {"k", " k ", 0},
    {"dt", " dt \xce\x94t deltat timestep timestepsize stepsize tau \xcf\x84 ", 0},
    {"steps", " steps nt nsteps timesteps numsteps ", 1},
};
enum { SYNONYMS = sizeof synonyms / sizeof *synonyms };

/* Columns with one of these words are no errors, unless they are asked for. The first are orders
 * from row to row. */
static const char *const of_runs[] = {
    "rate",  "rates", "eoc",  "ooc",        "roc",   "order", "orders",   "slope",   "r",
    "ratio", "red",   "time", "times",      "cpu",   "wall",  "walltime", "seconds", "sec",
    "iter",  "iters", "its",  "iterations", "cycle", "index", "memory"};
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

/* Sets the resolution that a column states by its name. */
static void find_size(struct column *c)
{
    char text[LONGEST_NAME], word[LONGEST_NAME + 2];
    plain(c->name, text);
    snprintf(word, sizeof word, " %s ", text);
    for (size_t i = 0; i < SYNONYMS && !c->size && *text; i++)
        if (strstr(synonyms[i].names, word)) {
            c->size = br_resolution_column_find(synonyms[i].column);
            c->rank = synonyms[i].rank;
        }
}

/* Whether a name has one of the first `count` words of of_runs. */
static bool is_of_run(const char *name, size_t count)
{
    static const char letters[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ";
    for (size_t length; *(name += strcspn(name, letters)); name += length) {
        length = strspn(name, letters);
        for (size_t i = 0; i < count; i++)
            if (strlen(of_runs[i]) == length && strncasecmp(of_runs[i], name, length) == 0)
                return true;
    }
    return false;
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

/* Copies a number with "e" before each exponent: of Fortran, D or Q, or no letter where it needs
 * three digits; of LaTeX, $1.5 \times 10^{-3}$. Returns the end of what is copied. */
static const char *with_exponent(const char *text, char *number, size_t size)
{
    static const char *const powers[] = {"\\times10^", "\\cdot10^", "\u00d710^", "x10^", "*10^"};
    const char *const ignored = strchr(text, '\\') ? "${} " : "${}";
    size_t length = 0;
    char *const all = number;
    for (; *text && length + 2 < size; text++)
        if (!strchr(ignored, *text))
            all[length++] = *text;
    all[length] = '\0';
    for (size_t i = 0; i < sizeof powers / sizeof *powers; i++) {
        char *power = strstr(all, powers[i]);
        if (power && power > all) {
            *power = 'e';
            memmove(power + 1, power + strlen(powers[i]), strlen(power + strlen(powers[i])) + 1);
        }
    }
    for (char *c = all + 1; length && *c; c++) {
        const bool digit = isdigit((unsigned char)c[-1]) || c[-1] == '.';
        if (digit && strchr("dDqQ", *c))
            *c = 'e';
        if (digit && (*c == '-' || *c == '+')) {
            memmove(c + 1, c, strlen(c) + 1);
            *c = 'e';
        }
    }
    return text;
}

bool br_table_number(const char *text, double *value)
{
    char number[72];
    double second;
    const char *end =
        *with_exponent(text, number, sizeof number - 4) ? NULL : br_read_number(number, value);
    if (!end || !*end)
        return end;
    if (strcmp(end, "%") == 0 || strcmp(end, " %") == 0) {
        *value /= 100;
        return true;
    }
    const bool times = *end == 'x' || strncmp(end, "\xc3\x97", 2) == 0;
    const char sign = *end;
    end += *end == 'x' || !times ? 1 : 2;
    end = strchr("/^x\xc3", sign) ? br_read_number(end, &second) : NULL;
    if (times) /* "8x8", "8x8x8": of a mesh */
        return end && second == *value && (!*end || *end == sign) &&
               (!*end || br_table_number(end + 1 + (sign != 'x'), &second)) && second == *value;
    *value = sign == '/' ? *value / second : pow(*value, second);
    return end && !*end && isfinite(*value);
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
    return br_fail(err, BR_BAD_INPUT, "%s:%zu: %s: found '%.40s', expected a number%s", s->path,
                   line_of(s, row), s->column[column].name, json_string_value(field),
                   s->column[column].size ? "" : ", or nan where it is missing");
}

/* ---- columns ---- */

static void put_aside(struct source *s, const char *name)
{
    char text[80];
    if (name)
        br_append(s->aside, sizeof s->aside, "%s%s", s->aside[0] ? ", " : "",
                  br_quoted(text, sizeof text, &br_for_text, name));
}

/* Refuses the table. The message lists its headings, and says how to name columns. word: an unknown
 * heading; NULL: none. */
static enum br_status refuse_columns(const struct source *s, const char *why, const char *word,
                                     struct br_error *err)
{
    enum { MOST = 64 };
    const char *headings[MOST];
    size_t count = 0;
    char names[300] = "", name[80], first[80] = "", suggestion[BR_SUGGESTION] = "";
    const bool none = heading(s, 1) && strcmp(heading(s, 1), "1") == 0;
    for (size_t i = 1; i <= s->columns && !none; i++)
        if (heading(s, i)) {
            br_quoted(name, sizeof name, &br_for_text, heading(s, i));
            br_append(names, sizeof names, "%s%s", names[0] ? ", " : "", name);
            if (!*first)
                strcpy(first, name);
            if (count < MOST)
                headings[count++] = heading(s, i);
        }
    if (word)
        br_suggestion(word, headings, count, suggestion);
    return br_fail(err, BR_BAD_INPUT,
                   none ? "%s:%zu: %s: there is no heading; --column 1=h,2=error names columns%s%s"
                        : "%s:%zu: %s among %s; --column '%s=h' says what a column is (h, n, dofs, "
                          "cells, level, k, dt or steps)%s",
                   s->path, line_of(s, 0), why, names, first, suggestion);
}

/* Names a column as an item of --column says: its heading or position, '=', its name or what it
 * states. */
static enum br_status rename_column(struct source *s, const char *item, size_t length,
                                    struct br_error *err)
{
    const char *equals = item + length;
    while (equals > item && *equals != '=')
        equals--;
    const size_t size = (size_t)(equals - item), rest = length - size;
    size_t found = 0;
    if (!size || rest < 2)
        return br_fail(err, BR_BAD_INPUT,
                       "--column: found '%.*s', expected COLUMN=NAME, as in dx=h or 1=h",
                       (int)length, item);
    for (size_t i = 1; i <= s->columns && !found; i++)
        if (s->column[i].name && strlen(s->column[i].name) == size &&
            memcmp(s->column[i].name, item, size) == 0)
            found = i;
    const unsigned long position = strtoul(item, NULL, 10);
    if (!found && strspn(item, "0123456789") == size && position > 0 && position <= s->columns)
        found = position;
    if (!found) {
        char why[120], word[60];
        snprintf(word, sizeof word, "%.*s", size < 59 ? (int)size : 59, item);
        snprintf(why, sizeof why, "--column: found no column '%s'", word);
        return refuse_columns(s, why, word, err);
    }
    struct column *c = &s->column[found];
    char *name = strndup(equals + 1, rest - 1);
    if (!name)
        return br_no_memory(err, "the table");
    c->size = br_resolution_column_find(name);
    c->rank = BY_NAME;
    if (c->size && c->name) { /* it keeps its name and its unit */
        free(name);
        return BR_OK;
    }
    free(c->name);
    *c = (struct column){c->shown, name, NULL, c->size, BY_NAME};
    return BR_OK;
}

/* Takes the names and units out of the headings, and finds what they state. */
static enum br_status name_columns(struct source *s, struct br_error *err)
{
    for (size_t i = 1; i <= s->columns; i++) {
        struct column *c = &s->column[i];
        c->shown = heading(s, i);
        if (!c->shown)
            continue;
        const size_t digits = strspn(c->shown, "0123456789"); /* gnuplot: "1:n" */
        const bool counted = digits && c->shown[digits] == ':' && c->shown[digits + 1];
        const char *text = c->shown + (counted ? digits + 1 : 0);
        if (!(c->name = strdup(text)))
            return br_no_memory(err, "the table");
        c->unit = split_unit(c->name);
        find_size(c);
        for (size_t j = 1; j <= s->columns && c->unit && !c->size; j++)
            if (j != i && heading(s, j) &&
                strncmp(heading(s, j), text, (size_t)(c->unit - c->name)) == 0) {
                strcpy(c->name, text); /* "L2(u)", "L2(p)": no units */
                c->unit = NULL;
            }
    }
    const char *item;
    size_t length;
    for (const char *list = s->request->columns; list;) {
        list = br_list_next(list, &item, &length);
        if (rename_column(s, item, length, err))
            return err->status;
    }
    return BR_OK;
}

/* The column that states the resolution of an axis; 0: there is none. */
static size_t best_of_axis(const struct source *s, enum br_axis axis)
{
    size_t best = 0;
    for (size_t i = 1; i <= s->columns; i++)
        if (s->column[i].size && s->column[i].size->axis == axis &&
            (!best || s->column[i].rank < s->column[best].rank))
            best = i;
    return best;
}

static double size_at(const struct source *s, size_t row, size_t column, double *given,
                      struct br_error *err)
{
    const struct column *c = &s->column[column];
    if (number_at(s, row, column, given, err))
        return NAN;
    return br_numbers_z(c->size, *given, br_orders_dimension(s->request, c->size));
}

/* Refuses another column of sizes that contradicts the one that is taken; a constant factor is
 * none, nor are sizes of three printed digits. Counts of cells and of unknowns need not agree: they
 * are left aside. */
static enum br_status compare_sizes(struct source *s, enum br_axis axis, size_t column,
                                    struct br_error *err)
{
    const struct column *c = &s->column[column];
    double factor = NAN, given;
    for (size_t i = 0; i < s->rows; i++) {
        const struct br_numbers_row *row = &s->numbers->row[i];
        const double z = size_at(s, i + 1, column, &given, err);
        if (err->status)
            return err->status;
        factor = i ? factor : z / row->z[axis];
        if (fabs(z / row->z[axis] / factor - 1) <= 5e-3)
            continue;
        if (!c->size->is_volume && s->column[best_of_axis(s, axis)].rank != BY_NAME)
            return br_fail(err, BR_BAD_INPUT, "%s:%zu: %s: found %g, which contradicts %s", s->path,
                           row->line, c->name, given, s->numbers->column[axis]->name);
        put_aside(s, c->name);
        return BR_OK;
    }
    return BR_OK;
}

/* Takes the sizes of an axis, and says from which column. */
static enum br_status take_sizes(struct source *s, enum br_axis axis, struct br_error *err)
{
    struct br_numbers *numbers = s->numbers;
    char name[80];
    const size_t best = best_of_axis(s, axis);
    const struct column *c = &s->column[best];
    if (!best)
        return BR_OK;
    bool counted = s->request->assumed_dimension || axis == BR_AXIS_TIME;
    for (size_t i = 1; i <= s->columns; i++)
        counted |= s->column[i].size && s->column[i].size->is_volume;
    if (!counted)
        return refuse_columns(s, "--dimension: found no numbers of unknowns or cells", NULL, err);
    numbers->column[axis] = c->size;
    for (size_t i = 0; i < s->rows; i++) {
        struct br_numbers_row *row = &numbers->row[i];
        row->z[axis] = size_at(s, i + 1, best, &row->given[axis], err);
        if (err->status)
            return err->status;
    }
    if (c->unit && !(numbers->unit[axis] = strdup(c->unit)))
        return br_no_memory(err, "the table");
    br_append(numbers->taken, sizeof numbers->taken, "%s%s from column %s",
              numbers->taken[0] ? ", " : "", c->size->states,
              br_quoted(name, sizeof name, &br_for_text, c->name));
    if (axis == BR_AXIS_SPACE) {
        numbers->dimension = br_orders_dimension(s->request, c->size);
        numbers->assumed = c->size->is_volume && s->request->assumed_dimension;
        if (c->size->is_volume)
            br_append(numbers->taken, sizeof numbers->taken, ", d = %g%s", numbers->dimension,
                      numbers->assumed ? " assumed" : "");
    }
    for (size_t i = 1; i <= s->columns; i++)
        if (i != best && s->column[i].size && s->column[i].size->axis == axis &&
            compare_sizes(s, axis, i, err))
            return err->status;
    return BR_OK;
}

static enum br_status take_quantity(const struct source *s, size_t position, struct br_error *err)
{
    struct br_numbers *numbers = s->numbers;
    const struct column *c = &s->column[position];
    const size_t index = numbers->quantities;
    for (size_t i = 0; i < index; i++)
        if (strcmp(c->name, numbers->quantity[i].name) == 0)
            return br_fail(err, BR_BAD_INPUT, "%s:%zu: the column '%s' is there twice", s->path,
                           line_of(s, 0), c->name);
    enum br_status status = br_numbers_add_quantity(numbers, c->name, c->unit,
                                                    br_lists(s->request->values, c->name), err);
    for (size_t i = 0; i < s->rows && !status; i++)
        status = number_at(s, i + 1, position, &numbers->row[i].number[index], err);
    return status;
}

/* Whether a column has whole numbers that grow as the mesh gets finer, or the steps shorter: a
 * count, a level or a degree, no error. */
static bool counts(const struct source *s, size_t column)
{
    const enum br_axis axis = s->numbers->column[BR_AXIS_SPACE] ? BR_AXIS_SPACE : BR_AXIS_TIME;
    double before = NAN, value;
    for (size_t i = 1; i <= s->rows; i++) {
        const double *z = &s->numbers->row[i - 1].z[axis];
        if (!is_number(field_at(s, i, column), &value) || value != floor(value) ||
            (i > 1 && !((value - before) * (s->numbers->row[i - 2].z[axis] - *z) > 0)))
            return false;
        before = value;
    }
    return s->rows > 2;
}

static bool is_studied(const struct source *s, size_t position)
{
    const struct br_orders_request *q = s->request;
    const struct column *c = &s->column[position];
    if (!c->name || c->size)
        return false;
    if (q->errors || q->values)
        return br_lists(q->errors, c->name) || br_lists(q->values, c->name);
    return c->rank == BY_NAME ||
           (!is_of_run(c->name, OF_RUNS) && has_number(s, position) && !counts(s, position));
}

/* A table of rates without a mesh has rows that halve it, as programs print their own studies. */
static void halve_by_row(const struct source *s)
{
    struct br_numbers *n = s->numbers;
    bool rates = false;
    for (size_t i = 1; i <= s->columns; i++)
        rates |= s->column[i].name && is_of_run(s->column[i].name, RATES);
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
                          found++  ? ", "
                          : values ? "; values: "
                                   : "; errors: ",
                          br_quoted(name, sizeof name, &br_for_text, n->quantity[i].name));
    if (s->aside[0])
        br_append(n->taken, sizeof n->taken, "; left aside: %s", s->aside);
}

static enum br_status check_lists(const struct source *s, struct br_error *err)
{
    const char **known = br_allocate(s->columns + 1, sizeof *known);
    size_t count = 0;
    for (size_t i = 1; i <= s->columns && known; i++)
        if (s->column[i].name && !s->column[i].size)
            known[count++] = s->column[i].name;
    const enum br_status status =
        known ? br_orders_check_lists(s->request, s->numbers, known, count, err)
              : br_no_memory(err, "the table");
    free(known);
    return status;
}

/* MOOSE writes a row of zeros before the first solution. */
static void drop_zeros(struct source *s)
{
    bool zeros = s->columns > 2 && s->rows > 0;
    double value;
    for (size_t i = 1; i <= s->columns; i++)
        zeros = zeros && is_number(field_at(s, 1, i), &value) && value == 0;
    if (!zeros)
        return;
    json_array_remove(s->table, 1);
    s->rows--;
    put_aside(s, "a first row of zeros");
}

static enum br_status take_columns(struct source *s, struct br_error *err)
{
    struct br_numbers *numbers = s->numbers;
    drop_zeros(s);
    s->column = br_allocate(s->columns + 1, sizeof *s->column);
    enum br_status status = s->column ? br_numbers_make_room(numbers, s->rows, s->columns, err)
                                      : br_no_memory(err, "the table");
    for (size_t i = 0; i < s->rows && !status; i++)
        numbers->row[i].line = line_of(s, i + 1);
    if (!status)
        status = name_columns(s, err);
    for (int axis = 0; axis < BR_AXES && !status; axis++)
        status = take_sizes(s, (enum br_axis)axis, err);
    if (!status)
        halve_by_row(s);
    for (size_t i = 1; i <= s->columns && !status; i++)
        if (br_observer_stops(s->request->observer))
            status = br_fail(err, BR_INTERRUPTED, "interrupted");
        else if (is_studied(s, i))
            status = take_quantity(s, i, err);
        else if (!s->column[i].size)
            put_aside(s, s->column[i].name);
    if (!status)
        status = check_lists(s, err);
    if (status)
        return status;
    state(s);
    if (!numbers->column[BR_AXIS_SPACE] && !numbers->column[BR_AXIS_TIME])
        return refuse_columns(s, "found no column of a resolution", NULL, err);
    return numbers->quantities
               ? BR_OK
               : refuse_columns(s, "found no column of numbers beside the resolution", NULL, err);
}

enum br_status br_table_read(const struct br_orders_request *q, struct br_numbers *numbers,
                             struct br_error *err)
{
    static const char byte_order_mark[] = "\xef\xbb\xbf"; /* spreadsheet programs write it first */
    const bool marked = strncmp(q->table, byte_order_mark, strlen(byte_order_mark)) == 0;
    const char *text = q->table + (marked ? strlen(byte_order_mark) : 0);
    struct source s = {
        .request = q, .path = br_orders_path(q), .table = json_array(), .numbers = numbers};
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
    s.columns = json_array_size(s.table) ? json_array_size(json_array_get(s.table, 0)) - 1 : 0;
    if (!status)
        status = take_columns(&s, err);
    for (size_t i = 1; i <= s.columns && s.column; i++)
        free(s.column[i].name);
    free(s.column);
    json_decref(s.table);
    return status;
}
