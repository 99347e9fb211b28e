/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The same for programs, by jansson: a table's rows are arrays in the order of its columns; what is
 * not there is null. */
#include <jansson.h>
#include <string.h>

#include "study/scene/number_list.h"
#include "tables/json_value.h"
#include "tables/sheet.h"

static void put(json_t *o, const char *key, json_t *value)
{
    json_object_set_new(o, key, value);
}

static void add_sentence(void *self, const char *text)
{
    json_array_append_new(self, br_json_string(text));
}

static json_t *sentences(const struct br_page *page,
                         void (*say)(const void *, const struct br_writer *))
{
    json_t *list = json_array();
    if (say)
        say(page->self, &(struct br_writer){add_sentence, list});
    return list;
}

enum { MOST_DIGITS = 18 }; /* of a 64-bit integer, any of them */

/* What is not a decimal number stays text, and so does what a double would not hold. */
static json_t *number_of(const char *text)
{
    const size_t sign = *text == '-', length = strlen(text + sign);
    double value;
    if (length == strspn(text + sign, "0123456789") && length > 0)
        return length <= MOST_DIGITS ? json_integer(strtoll(text, NULL, 10)) : br_json_string(text);
    const char *end = strpbrk(text, "xX") ? NULL : br_read_number(text, &value);
    return end && !*end ? json_real(value) : br_json_string(text);
}

static json_t *row_of(const struct br_table *t, size_t row)
{
    char text[BR_CELL];
    bool number;
    json_t *list = json_array();
    for (size_t c = 0; c < t->columns; c++) {
        t->heading(t->self, c, &number);
        t->cell(t->self, row, c, text);
        json_array_append_new(list, strcmp(text, "-") == 0 ? json_null()
                                    : number               ? number_of(text)
                                                           : br_json_string(text));
    }
    return list;
}

static json_t *table_of(const struct br_table *t)
{
    json_t *o = json_object(), *columns = json_array(), *rows = json_array();
    bool number;
    for (size_t c = 0; c < t->columns; c++)
        json_array_append_new(columns, br_json_string(t->heading(t->self, c, &number)));
    for (size_t r = 0; r < t->rows; r++)
        json_array_append_new(rows, row_of(t, r));
    put(o, "name", br_json_string(t->name));
    put(o, "title", br_json_string(t->title));
    put(o, "columns", columns);
    put(o, "rows", rows);
    return o;
}

static enum br_status emit(FILE *out, const struct br_page *page, struct br_error *err)
{
    json_t *root = json_object(), *tables = json_array();
    for (size_t i = 0; i < page->tables; i++)
        json_array_append_new(tables, table_of(&page->table[i]));
    put(root, "name", br_json_string(page->name));
    put(root, "caption", br_json_string(page->caption));
    put(root, "sentences", sentences(page, page->say));
    put(root, "tables", tables);
    put(root, "notes", sentences(page, page->say_notes));
    put(root, "provenance", br_json_provenance(page->provenance));
    char *text = json_dumps(root, JSON_INDENT(1) | JSON_ENSURE_ASCII);
    json_decref(root);
    if (!text)
        return br_no_memory(err, "the JSON text");
    fprintf(out, "%s\n", text);
    free(text);
    return BR_OK;
}

const struct br_page_emitter br_page_json = {"json", ".json", emit};
