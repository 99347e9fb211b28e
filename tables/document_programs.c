/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Formats for programs. */
#include <jansson.h>
#include <string.h>

#include "base/quote.h"
#include "tables/document.h"
#include "tables/json_value.h"

/* ---- JSON, by jansson: the kind of the report, the answer, facts, tables as lists of rows, notes,
 * verdicts, and the provenance. A value that is nothing is null. ---- */

/* A report that is being printed. */
struct page {
    const struct br_document *d;
    struct br_error *err;
    bool lacked;     /* memory */
    char twice[100]; /* a key that has two values; "": none */
};

/* Takes ownership of the value. */
static void put(struct page *p, json_t *object, const char *key, json_t *value)
{
    if (json_object_get(object, key))
        snprintf(p->twice, sizeof p->twice, "%s", key);
    p->lacked |= json_object_set_new(object, key, value) != 0;
}

static void append(struct page *p, json_t *array, json_t *value)
{
    p->lacked |= json_array_append_new(array, value) != 0;
}

static json_t *value_of(const struct br_value *value)
{
    switch (value->kind) {
    case BR_NUMBER:
        return json_real(value->number);
    case BR_COUNT:
        return json_integer(value->count);
    case BR_TRUTH:
        return json_boolean(value->truth);
    case BR_TEXT:
        return br_json_string(value->text);
    default:
        return json_null();
    }
}

/* A key with dots is an object in an object; objects are made as they are needed. */
static void put_fact(struct page *p, json_t *object, const char *key, json_t *value)
{
    char name[100];
    for (const char *dot; (dot = strchr(key, '.')); key = dot + 1) {
        snprintf(name, sizeof name, "%.*s", (int)(dot - key), key);
        if (!json_is_object(json_object_get(object, name)))
            put(p, object, name, json_object());
        object = json_object_get(object, name);
    }
    put(p, object, key, value);
}

static json_t *rows_of(struct page *p, const struct br_document_table *t)
{
    json_t *rows = json_array();
    for (size_t r = 0; r < t->rows; r++) {
        json_t *o = json_object();
        for (size_t c = 0; c < t->columns; c++)
            if (br_for_programs(t->column[c].flags))
                put(p, o, t->column[c].key, value_of(&br_document_cell_at(t, r, c)->value));
        append(p, rows, o);
    }
    return rows;
}

/* The title of a table, and the units of its columns. */
static json_t *columns_of(struct page *p, const struct br_document_table *t)
{
    json_t *o = json_object(), *units = json_object();
    for (size_t c = 0; c < t->columns; c++)
        if (br_for_programs(t->column[c].flags) && t->column[c].unit)
            put(p, units, t->column[c].key, br_json_string(t->column[c].unit));
    put(p, o, "title", br_json_string(t->title));
    put(p, o, "units", units);
    return o;
}

static json_t *verdict(struct page *p, const struct br_document_verdict *v)
{
    json_t *o = json_object(), *details = json_array();
    for (size_t i = 0; i < v->details; i++)
        append(p, details, br_json_string(v->detail[i]));
    put(p, o, "verdict", json_string(br_outcome_names[v->outcome]));
    put(p, o, "group", br_json_string(v->group));
    put(p, o, "name", br_json_string(v->name));
    put(p, o, "message", br_json_string(v->message));
    put(p, o, "file", br_json_string(v->file));
    put(p, o, "line", v->line ? json_integer((json_int_t)v->line) : json_null());
    put(p, o, "seconds", json_real(v->seconds));
    put(p, o, "details", details);
    return o;
}

static json_t *provenance(struct page *p)
{
    const struct br_provenance *from = &p->d->provenance;
    json_t *o = json_object();
    for (const struct br_provenance_text *t = br_provenance_texts; t->key; t++)
        put(p, o, t->key, br_json_string(*(const char *const *)((const char *)from + t->at)));
    put(p, o, "threads", json_integer(from->threads));
    return o;
}

static json_t *root_of(struct page *p)
{
    const struct br_document *d = p->d;
    json_t *root = json_object(), *answer = json_array(), *tables = json_object(),
           *about = json_object(), *notes = json_array(), *pictures = json_array(),
           *verdicts = json_array();
    for (size_t i = 0; i < d->answers; i++)
        append(p, answer, br_json_string(d->answer[i]));
    put(p, root, "format", br_json_string(d->format));
    put(p, root, "version", json_integer(d->version));
    put(p, root, "name", br_json_string(d->name));
    put(p, root, "caption", br_json_string(d->caption));
    put(p, root, "answer", answer);
    for (size_t i = 0; i < d->blocks && !br_document_status(d, p->err); i++) {
        const struct br_block *b = &d->block[i];
        if (b->kind == BR_BLOCK_NOTE) {
            append(p, notes, br_json_string(b->text));
        } else if (b->kind == BR_BLOCK_PICTURE) {
            json_t *picture = json_object();
            put(p, picture, "stem", br_json_string(b->what.key));
            put(p, picture, "caption", br_json_string(b->text));
            append(p, pictures, picture);
        } else if (b->kind == BR_BLOCK_TABLE && br_for_programs(b->table->flags)) {
            put(p, tables, b->table->key, rows_of(p, b->table));
            put(p, about, b->table->key, columns_of(p, b->table));
        } else if (b->kind == BR_BLOCK_FACT || b->kind == BR_BLOCK_COMMAND) {
            if (br_for_programs(b->what.flags))
                put_fact(p, root, b->what.key, value_of(&b->cell.value));
        }
    }
    for (size_t i = 0; i < d->verdicts; i++)
        append(p, verdicts, verdict(p, &d->verdict[i]));
    put(p, root, "tables", tables);
    put(p, root, "about_tables", about);
    put(p, root, "notes", notes);
    put(p, root, "pictures", pictures);
    put(p, root, "verdicts", verdicts);
    put(p, root, "provenance", provenance(p));
    return root;
}

static enum br_status write_json(FILE *out, const struct br_document *d,
                                 const struct br_document_table *table, struct br_error *err)
{
    (void)table;
    struct page p = {.d = d, .err = err};
    json_t *root = root_of(&p);
    const size_t flags = JSON_INDENT(1) | JSON_ENSURE_ASCII | JSON_REAL_PRECISION(17);
    enum br_status status = br_document_status(d, err);
    if (status)
        fputs("null", out); /* of no use: the command ends */
    else if (*p.twice)
        status =
            br_fail(err, BR_IO, "the report %.100s has two values for '%.100s'", d->name, p.twice);
    /* Only memory can lack, as all texts become UTF-8. Not json_dumps: without memory for its
     * buffer, it drops a key. */
    else if (p.lacked || (json_dumpf(root, out, flags) != 0 && !ferror(out)))
        status = br_no_memory(err, "the JSON text");
    fputc('\n', out);
    json_decref(root);
    return status;
}

const struct br_document_format br_document_json = {
    .name = "json",
    .extension = ".json",
    .title = "everything, for programs",
    .write = write_json,
};

/* ---- CSV: one table in a file (RFC 4180): a line of keys, with units in brackets, then a line for
 * each row. Numbers have all their digits, a value that is nothing is an empty field. A heading or
 * text stays on its line; what a spreadsheet would take for a formula begins with a '. ---- */

static enum br_status write_heading(FILE *out, const struct br_column *c, struct br_error *err)
{
    char *heading;
    if (asprintf(&heading, "%s%s%s%s", c->key, c->unit ? " [" : "", c->unit ? c->unit : "",
                 c->unit ? "]" : "") < 0)
        return br_no_memory(err, "a heading");
    br_quote(out, &br_for_csv, heading);
    free(heading);
    return BR_OK;
}

static enum br_status write_csv(FILE *out, const struct br_document *d,
                                const struct br_document_table *t, struct br_error *err)
{
    (void)d;
    for (size_t line = 0; line <= t->rows; line++) { /* the first is the head */
        const char *separator = "";
        for (size_t c = 0; c < t->columns; c++) {
            if (!br_for_programs(t->column[c].flags))
                continue;
            fputs(separator, out);
            separator = ",";
            if (line > 0)
                br_document_print_value(out, &br_for_csv, "",
                                        &br_document_cell_at(t, line - 1, c)->value);
            else if (write_heading(out, &t->column[c], err))
                return err->status;
        }
        fputc('\n', out);
    }
    return BR_OK;
}

const struct br_document_format br_document_csv = {
    .name = "csv",
    .extension = ".csv",
    .title = "for programs: a file a table",
    .by_table = true,
    .write = write_csv,
};
