/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/documents.h"

enum { NAME = 600 };

/* One file: of all, or of one table. */
static enum br_status write_file(const struct br_output *output, const struct br_document_format *f,
                                 const struct br_document *d, const struct br_document_table *table,
                                 struct br_error *err)
{
    char name[NAME];
    FILE *file;
    const bool main = !table || table->flags & BR_MAIN;
    snprintf(name, sizeof name, "%.400s%s%.100s%s", d->name, main ? "" : "-",
             main ? "" : table->key, f->extension);
    enum br_status status = br_output_file(output, name, &file, err);
    if (status)
        return status;
    status = br_document_print(file, f, d, table, err);
    const enum br_status closed = br_output_close(file, name, status ? NULL : err);
    return status ? status : closed;
}

enum br_status br_documents_write_as(const struct br_output *output,
                                     const struct br_document_format *f,
                                     const struct br_document *d, struct br_error *err)
{
    enum br_status status = br_document_status(d, err);
    if (!f->by_table)
        return status ? status : write_file(output, f, d, NULL, err);
    size_t block = 0;
    for (const struct br_document_table *t; !status && (t = br_document_next_table(d, &block));)
        status = write_file(output, f, d, t, err);
    return status;
}

enum br_status br_documents_write_page(const struct br_output *output,
                                       const struct br_document *documents, size_t count,
                                       struct br_error *err)
{
    FILE *file;
    enum br_status status = br_output_file(output, BR_PAGE, &file, err);
    if (status)
        return status;
    status = br_document_print_page(file, documents, count, output->staging, err);
    const enum br_status closed = br_output_close(file, BR_PAGE, status ? NULL : err);
    return status ? status : closed;
}

enum br_status br_documents_write(struct br_picture_files *pictures,
                                  const struct br_options *options,
                                  const struct br_document *documents, size_t count,
                                  struct br_error *err)
{
    enum br_status status = BR_OK;
    for (const struct br_document_format *const *f = br_document_formats; *f; f++)
        for (size_t i = 0; i < count && !status; i++)
            if (*f != &br_document_html && br_format_wanted(options, (*f)->name))
                status = br_documents_write_as(pictures->output, *f, &documents[i], err);
    if (status || !count || !br_format_wanted(options, br_document_html.name))
        return status;
    status = br_picture_files_finish(pictures, err);
    return status ? status : br_documents_write_page(pictures->output, documents, count, err);
}

enum br_status br_documents_show(const struct br_document *documents, size_t count,
                                 struct br_error *err)
{
    enum br_status status = BR_OK;
    for (size_t i = 0; i < count && !status; i++) {
        status = br_document_show(stdout, &documents[i], err);
        putchar('\n');
    }
    fflush(stdout); /* before what follows fails; that this did is found at the end */
    return status;
}
