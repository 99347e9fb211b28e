/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A table a file (RFC 4180): a line of keys, with units in brackets, and a line a row. Numbers have
 * all their digits, what is not there is an empty field, and a text stays on its line. */
#include "study/scene/quote.h"
#include "tables/document.h"

static void print_head(FILE *out, const struct br_document_table *t)
{
    const char *separator = "";
    for (size_t c = 0; c < t->columns; c++) {
        if (!br_for_programs(t->column[c].flags))
            continue;
        fprintf(out, "%s%s", separator, t->column[c].key);
        if (t->column[c].unit)
            fprintf(out, " [%s]", t->column[c].unit);
        separator = ",";
    }
    fputc('\n', out);
}

static enum br_status write(FILE *out, const struct br_document *d,
                            const struct br_document_table *t, struct br_error *err)
{
    (void)d, (void)err;
    print_head(out, t);
    for (size_t r = 0; r < t->rows; r++) {
        const char *separator = "";
        for (size_t c = 0; c < t->columns; c++) {
            if (!br_for_programs(t->column[c].flags))
                continue;
            fputs(separator, out);
            br_document_print_value(out, &br_for_csv, "", &br_document_cell_at(t, r, c)->value);
            separator = ",";
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
    .write = write,
};
