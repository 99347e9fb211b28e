/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A table a file (RFC 4180): a line of keys, with units in brackets, and a line a row. Numbers have
 * all their digits, what is not there is an empty field, and a text stays on its line. */
#include "study/scene/quote.h"
#include "tables/document.h"

static enum br_status write(FILE *out, const struct br_document *d,
                            const struct br_document_table *t, struct br_error *err)
{
    (void)d, (void)err;
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
            else if (t->column[c].unit)
                fprintf(out, "%s [%s]", t->column[c].key, t->column[c].unit);
            else
                fputs(t->column[c].key, out);
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
