/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/orders/request.h"

#include <math.h>
#include <string.h>

#include "study/scene/quote.h"
#include "study/scene/words.h"

struct br_orders_request br_orders_request_default(void)
{
    return (struct br_orders_request){.dimension = 2, .assumed_dimension = true, .formal = 2, .seconds = BR_PROGRAM_SECONDS};
}

void br_orders_request_clear(struct br_orders_request *r)
{
    for (size_t i = 0; i < r->readings; i++) {
        free((char *)r->reading[i].name);
        free((char *)r->reading[i].what);
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

enum br_status br_orders_read(const struct br_orders_request *r, struct br_numbers *numbers,
                              struct br_error *err)
{
    *numbers = (struct br_numbers){0};
    if (!r->command && !r->table)
        return br_fail(err, BR_BAD_INPUT, "%s: found neither a table nor a command", r->path);
    const enum br_status status = (r->command ? br_program_run : br_table_read)(r, numbers, err);
    numbers->observer = r->observer;
    return status ? status : br_numbers_check(numbers, br_orders_path(r), err);
}

/* Refuses a name of a list that is not the name of a quantity. */
static enum br_status check_list(const struct br_orders_request *r, const char *option,
                                 const char *list, const struct br_numbers *numbers,
                                 struct br_error *err)
{
    const char *name, *path = br_orders_path(r);
    size_t length;
    while (list) {
        list = br_list_next(list, &name, &length);
        bool found = false;
        for (size_t i = 0; i < numbers->quantities; i++)
            found |= strlen(numbers->quantity[i].name) == length &&
                     memcmp(numbers->quantity[i].name, name, length) == 0;
        char word[8];
        snprintf(word, sizeof word, "%.*s", (int)length, name);
        if (!found && br_resolution_column_find(word))
            return br_fail(err, BR_BAD_INPUT, "%s: %s: '%s' is a resolution, expected numbers",
                           path, option, word);
        if (!found)
            return br_fail(err, BR_BAD_INPUT,
                           r->command ? "%s: %s: nothing of the name '%.*s' is read"
                                      : "%s: %s: there is no column '%.*s'",
                           path, option, (int)length, name);
    }
    return BR_OK;
}

enum br_status br_orders_check_lists(const struct br_orders_request *r,
                                     const struct br_numbers *numbers, struct br_error *err)
{
    if (check_list(r, "--error", r->errors, numbers, err) ||
        check_list(r, "--value", r->values, numbers, err))
        return err->status;
    for (size_t i = 0; i < numbers->quantities; i++)
        if (numbers->quantity[i].is_value && br_lists(r->errors, numbers->quantity[i].name))
            return br_fail(err, BR_BAD_INPUT, "%s: '%s' is given as an error and as a value",
                           br_orders_path(r), numbers->quantity[i].name);
    return BR_OK;
}

/* ---- items ---- */

enum br_status br_orders_request_axis(struct br_orders_request *r, const char *column,
                                      const char *list, struct br_error *err)
{
    const struct br_resolution_column *c = br_resolution_column_find(column);
    double *given = NULL;
    size_t count;
    if (r->axis[c->axis].column)
        return br_fail(err, BR_BAD_INPUT, "%s and %s are given, expected one of the two",
                       r->axis[c->axis].column->name, column);
    enum br_status status = br_read_numbers(column, list, &given, &count, err);
    for (size_t i = 0; i < count && !status; i++) /* all whole numbers below 2^53 are doubles */
        if (!c->is_size && !(given[i] == floor(given[i]) && given[i] < 0x1p53))
            status = br_fail(err, BR_BAD_INPUT, "%s: found %g, expected a whole number above 0",
                             column, given[i]);
    r->axis[c->axis] = (struct br_program_axis){c, given, count};
    return status;
}

enum br_status br_orders_request_reading(struct br_orders_request *r, const char *name,
                                         const char *what, struct br_error *err)
{
    static const struct {
        const char *prefix;
        enum br_reading_kind kind;
    } kinds[] = {{"json:", BR_READING_JSON}, {"csv:", BR_READING_CSV}};
    struct br_reading reading = {.kind = BR_READING_REGEX};
    if (br_not_utf8(name))
        return br_fail(err, BR_BAD_INPUT, "found the name '%s', expected text in UTF-8", name);
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
        if (strncmp(what, kinds[i].prefix, strlen(kinds[i].prefix)) == 0) {
            reading.kind = kinds[i].kind;
            what += strlen(kinds[i].prefix);
        }
    for (size_t i = 0; i < r->readings; i++)
        if (strcmp(r->reading[i].name, name) == 0)
            return br_fail(err, BR_BAD_INPUT, "%s is read twice", name);
    struct br_reading *more = br_allocate(r->readings + 1, sizeof *more);
    if (!more)
        return br_no_memory(err, "what is read");
    if (r->readings)
        memcpy(more, r->reading, r->readings * sizeof *more);
    free((struct br_reading *)r->reading);
    r->reading = more;
    reading.name = strdup(name);
    reading.what = strdup(what);
    more[r->readings++] = reading;
    return reading.name && reading.what ? BR_OK : br_no_memory(err, "what is read");
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
    for (size_t i = 0; i < r->readings; i++) {
        add_text(&sum, r->reading[i].name);
        add_text(&sum, r->reading[i].what);
    }
    for (size_t i = 0; i < r->expectations; i++) {
        const struct br_order_expectation *e = &r->expectation[i];
        snprintf(text, sizeof text, "%s %s %.17g %.17g %.17g", e->quantity,
                 br_axis_letters[e->axis], e->order, e->tolerance, e->down_to);
        add_text(&sum, text);
    }
    br_sha256_end(&sum, digest);
    snprintf(problem, 40, "%.32s", digest);
}
