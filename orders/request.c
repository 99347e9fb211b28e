/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "orders/request.h"

#include <math.h>
#include <string.h>

#include "base/quote.h"
#include "base/sha256.h"
#include "base/words.h"

struct br_orders_request br_orders_request_default(void)
{
    return (struct br_orders_request){
        .dimension = 2, .assumed_dimension = true, .seconds = BR_PROGRAM_SECONDS, .repeat = 1};
}

void br_orders_request_clear(struct br_orders_request *r)
{
    for (size_t i = 0; i < r->readings; i++) {
        free((char *)r->reading[i].name);
        free((char *)r->reading[i].what);
        free((char *)r->reading[i].file);
    }
    for (int axis = 0; axis < BR_AXES; axis++)
        free((double *)r->axis[axis].given);
    free(r->path);
    free(r->title);
    free(r->table);
    free(r->table_path);
    free(r->command);
    free(r->folder);
    free(r->errors);
    free(r->columns);
    free(r->where);
    free(r->without);
    free(r->values);
    free((struct br_reading *)r->reading);
    free(r->expectation);
    *r = (struct br_orders_request){0};
}

/* ---- sources ---- */

const char *br_orders_path(const struct br_orders_request *r)
{
    return r->table_path ? r->table_path : r->path;
}

/* Runs the program. A failure names the study file, since a check may have several. */
static enum br_status run_program(const struct br_orders_request *r, struct br_numbers *numbers,
                                  struct br_error *err)
{
    const enum br_status status = br_program_run(r, numbers, err);
    if (!status || !r->folder)
        return status;
    const struct br_error inner = *err;
    return br_fail(err, status, "%s: %.900s", r->path, inner.message);
}

enum br_status br_orders_read(const struct br_orders_request *r, struct br_numbers *numbers,
                              struct br_error *err)
{
    *numbers = (struct br_numbers){0};
    const enum br_status status = (r->command ? run_program : br_table_read)(r, numbers, err);
    numbers->observer = r->observer;
    return status || br_numbers_check(numbers, br_orders_path(r), err) ||
                   br_orders_window(r, numbers, err)
               ? err->status
               : BR_OK;
}

double br_orders_dimension(const struct br_orders_request *r,
                           const struct br_resolution_column *column)
{
    return !r->assumed_dimension ? r->dimension : strcmp(column->name, "cells") == 0 ? 1 : 2;
}

/* Refuses a name that no quantity has. known[count]: the names that one may have meant. */
static enum br_status refuse_name(const struct br_orders_request *r, const char *where,
                                  const char *name, const struct br_numbers *numbers,
                                  const char *const *known, size_t count, struct br_error *err)
{
    char expected[BR_EXPECTED] = "", word[80];
    for (size_t i = 0; i < numbers->lefts; i++)
        if (strcmp(numbers->left[i].what, name) == 0)
            return br_fail(err, BR_BAD_INPUT, "%s: %s: column %s is left aside: %s",
                           br_orders_path(r), where,
                           br_quoted(word, sizeof word, &br_for_text, name), numbers->left[i].why);
    if (count)
        br_expected(name, known, count, expected);
    if (br_resolution_column_find(name))
        return br_fail(err, BR_BAD_INPUT, "%s: %s: '%s' is a resolution, expected numbers",
                       br_orders_path(r), where, name);
    return br_fail(err, BR_BAD_INPUT,
                   r->command ? "%s: %s: nothing of the name '%s' is read%s%s"
                              : "%s: %s: there is no column '%s'%s%s",
                   br_orders_path(r), where, br_quoted(word, sizeof word, &br_for_text, name),
                   count ? ", " : "", expected);
}

/* Refuses a name of a list that is not the name of a quantity. */
static enum br_status check_list(const struct br_orders_request *r, const char *option,
                                 const char *list, const struct br_numbers *numbers,
                                 const char *const *known, size_t count, struct br_error *err)
{
    const char *name;
    size_t length;
    while (list) {
        list = br_list_next(list, &name, &length);
        char word[200];
        snprintf(word, sizeof word, "%.*s", (int)(length < 199 ? length : 199), name);
        bool found = false;
        for (size_t i = 0; i < numbers->quantities; i++)
            found |= strlen(numbers->quantity[i].name) == length &&
                     memcmp(numbers->quantity[i].name, name, length) == 0;
        if (!found)
            return refuse_name(r, option, word, numbers, known, count, err);
    }
    return BR_OK;
}

/* Refuses an expectation that no order of the numbers can meet, and one that another has met. */
static enum br_status check_expectation(const struct br_orders_request *r,
                                        const struct br_numbers *numbers, size_t number,
                                        const char *const *known, size_t count,
                                        struct br_error *err)
{
    struct br_order_expectation e = r->expectation[number];
    struct br_error inner = {0};
    size_t quantity, other;
    if (br_expectation_find(numbers, &e, &quantity, &inner))
        return br_fail(err, inner.status, "%s: %s", br_orders_path(r), inner.message);
    if (quantity == numbers->quantities)
        return refuse_name(r, "what is expected", e.quantity, numbers, known, count, err);
    const char *name = numbers->quantity[quantity].name, *axis = br_axis_letters[e.axis];
    if (!numbers->column[e.axis])
        return br_fail(err, BR_BAD_INPUT,
                       "%s: an order of %s in %s is expected, and there is no resolution of %s",
                       br_orders_path(r), name, axis,
                       e.axis == BR_AXIS_SPACE ? "the mesh" : "the time steps");
    if (numbers->column[e.axis]->is_degree && !e.band.exponential)
        return br_fail(err, BR_BAD_INPUT,
                       "%s: an order of %s is expected, and errors over a degree have none: 'h "
                       "exponential 8 +- 0.5' expects that each degree divides them by 8",
                       br_orders_path(r), name);
    if (numbers->unsettled)
        return br_fail(err, BR_BAD_INPUT, "%s: an order of %s in %s is expected, and %s",
                       br_orders_path(r), name, axis, numbers->unsettled);
    for (size_t i = 0; i < number; i++) {
        struct br_order_expectation f = r->expectation[i];
        if (!br_expectation_find(numbers, &f, &other, &inner) && other == quantity &&
            f.axis == e.axis)
            return br_fail(err, BR_BAD_INPUT, "%s: the order of %s in %s is given twice",
                           br_orders_path(r), name, axis);
    }
    return BR_OK;
}

enum br_status br_orders_check_lists(const struct br_orders_request *r,
                                     const struct br_numbers *numbers, const char *const *known,
                                     size_t count, struct br_error *err)
{
    if (check_list(r, "--error", r->errors, numbers, known, count, err) ||
        check_list(r, "--value", r->values, numbers, known, count, err))
        return err->status;
    for (size_t i = 0; i < numbers->quantities; i++)
        if (numbers->quantity[i].is_value && br_lists(r->errors, numbers->quantity[i].name))
            return br_fail(err, BR_BAD_INPUT, "%s: '%s' is given as an error and as a value",
                           br_orders_path(r), numbers->quantity[i].name);
    for (size_t i = 0; i < r->expectations; i++)
        if (check_expectation(r, numbers, i, known, count, err))
            return err->status;
    return BR_OK;
}

/* ---- items ---- */

/* Writes the numbers of a list as digits, where it has them as tables do: 2^-4, 1/8. Items that are
 * no numbers stay. Returns it, owned; NULL: no memory. */
static char *plain_list(const char *list)
{
    enum { NUMBER = 32 };
    size_t items = 1, length;
    for (const char *at = list; (at = strchr(at, ',')); at++)
        items++;
    char *text = br_allocate(strlen(list) + items * NUMBER + 1, 1), *to = text;
    for (const char *item, *rest = list; text && rest;) {
        char word[64], number[NUMBER];
        struct br_field_number found;
        rest = br_list_next(rest, &item, &length);
        snprintf(word, sizeof word, "%.*s", (int)(length < 63 ? length : 63), item);
        const bool reads =
            length < 63 && br_field_read(word, '.', &found) && isnan(found.deviation);
        const char *shown = reads ? br_shortest(found.value, number, sizeof number) : item;
        const size_t size = reads ? strlen(shown) : length;
        memcpy(to, shown, size);
        to += size;
        *to++ = rest ? ',' : '\0';
    }
    return text;
}

enum br_status br_orders_request_axis(struct br_orders_request *r, const char *column,
                                      const char *list, struct br_error *err)
{
    const struct br_resolution_column *c = br_resolution_column_find(column);
    double *given = NULL;
    size_t count;
    if (r->axis[c->axis].column)
        return br_fail(err, BR_BAD_INPUT, "%s and %s are given, expected one of the two",
                       r->axis[c->axis].column->name, column);
    char *plain = plain_list(list);
    if (!plain)
        return br_no_memory(err, "a list");
    const bool zero = c->is_power && strncmp(plain, "0,", 2) == 0; /* the first level */
    enum br_status status = br_read_numbers(column, plain + (zero ? 2 : 0), &given, &count, err);
    free(plain);
    if (!status && zero && count < BR_MOST_SIZES) {
        memmove(given + 1, given, count++ * sizeof *given);
        given[0] = 0;
    }
    for (size_t i = 0; i < count && !status; i++) /* all whole numbers below 2^53 are doubles */
        if (!c->is_size && !(given[i] == floor(given[i]) && given[i] < 0x1p53))
            status = br_fail(err, BR_BAD_INPUT, "%s: found %g, expected a whole number above 0",
                             column, given[i]);
    r->axis[c->axis] = (struct br_program_axis){c, given, count};
    return status;
}

/* Takes "PATH:". The path stays within the folder of the run. */
static enum br_status take_file(const char **what, const char **file, struct br_error *err)
{
    const char *colon = strchr(*what, ':');
    const size_t length = colon ? (size_t)(colon - *what) : 0;
    if (!length || **what == '/' || strncmp(*what, "../", 3) == 0 || strstr(*what, "/../"))
        return br_fail(err, BR_BAD_INPUT,
                       "found 'file:%.60s', expected file:PATH:REGEX, with a PATH in the folder "
                       "that each run has for itself",
                       *what);
    *file = strndup(*what, length);
    *what = colon + 1;
    return *file ? BR_OK : br_no_memory(err, "what is read");
}

enum br_status br_orders_request_reading(struct br_orders_request *r, const char *name,
                                         const char *what, struct br_error *err)
{
    struct br_reading reading = {.kind = BR_READING_REGEX};
    if (br_not_utf8(name))
        return br_fail(err, BR_BAD_INPUT, "found the name '%s', expected text in UTF-8", name);
    for (size_t i = 0; i < r->readings; i++)
        if (strcmp(r->reading[i].name, name) == 0)
            return br_fail(err, BR_BAD_INPUT, "%s is read twice", name);
    if (!br_grow(&r->reading, r->readings, &r->room, sizeof reading))
        return br_no_memory(err, "what is read");
    reading.complaints = br_takes(&what, "stderr:");
    enum br_status status = !reading.complaints && br_takes(&what, "file:")
                                ? take_file(&what, &reading.file, err)
                                : BR_OK;
    reading.last = br_takes(&what, "last:");
    if (!reading.last)
        reading.kind = br_takes(&what, "json:")  ? BR_READING_JSON
                       : br_takes(&what, "csv:") ? BR_READING_CSV
                                                 : BR_READING_REGEX;
    reading.name = strdup(name);
    reading.what = strdup(what);
    ((struct br_reading *)r->reading)[r->readings++] = reading;
    if (!status && !(reading.name && reading.what))
        status = br_no_memory(err, "what is read");
    return status;
}

/* ---- the problem ---- */

/* NULL counts as an empty text. */
static void add_text(struct br_sha256 *sum, const char *text)
{
    br_sha256_add_text(sum, text ? text : "");
}

void br_orders_problem(const struct br_orders_request *r, char problem[40])
{
    struct br_sha256 sum;
    char digest[BR_SHA256_TEXT], text[200];
    br_sha256_start(&sum);
    add_text(&sum, r->command);
    add_text(&sum, r->errors);
    add_text(&sum, r->values);
    if (r->columns)
        add_text(&sum, r->columns);
    if (r->where)
        add_text(&sum, r->where);
    if (r->finest > 0 || r->without) {
        snprintf(text, sizeof text, "finest %g without ", r->finest);
        add_text(&sum, text);
        add_text(&sum, r->without);
    }
    if (r->repeat > 1) {
        snprintf(text, sizeof text, "repeat %.17g", r->repeat);
        add_text(&sum, text);
    }
    for (size_t i = 0; i < r->readings; i++) {
        add_text(&sum, r->reading[i].name);
        add_text(&sum, r->reading[i].what);
        if (r->reading[i].file || r->reading[i].complaints || r->reading[i].last) {
            snprintf(text, sizeof text, "%d %d %.180s", r->reading[i].complaints,
                     r->reading[i].last, r->reading[i].file ? r->reading[i].file : "");
            add_text(&sum, text);
        }
    }
    for (size_t i = 0; i < r->expectations; i++) {
        const struct br_order_expectation *e = &r->expectation[i];
        const struct br_expectation *b = &e->band;
        snprintf(text, sizeof text, "%s %s %.17g %.17g %.17g", e->quantity,
                 e->axis == BR_AXES ? "" : br_axis_letters[e->axis], b->order, b->tolerance,
                 b->down_to);
        add_text(&sum, text);
        if (b->highest > 0 || !isnan(b->ceiling)) {
            snprintf(text, sizeof text, "%.17g %.17g %.17g", b->highest, b->floor, b->ceiling);
            add_text(&sum, text);
        }
    }
    br_sha256_end(&sum, digest);
    snprintf(problem, 40, "%.32s", digest);
}
