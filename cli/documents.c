/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/documents.h"

#include <string.h>

#include "cli/signals.h"
#include "study/scene/quote.h"

/* ---- pictures ---- */

enum br_status br_picture_failed(const struct br_error *why, const char *what, struct br_error *err)
{
    if (br_signals_caught()) /* Ctrl-C ends gnuplot, too: that is no failure of its own */
        return br_fail(err, BR_INTERRUPTED, "interrupted");
    fprintf(stderr, "beamrate: warning: ");
    br_quote(stderr, &br_for_text, what);
    fprintf(stderr, " is not drawn: ");
    br_quote(stderr, &br_for_text, why->message);
    fprintf(stderr, "; its script (*.gp), its data and all tables are kept\n");
    return BR_OK;
}

static enum br_status end_oldest(struct br_picture_files *f, struct br_error *err)
{
    struct br_error why = {0};
    struct br_gnuplot oldest = f->at_work[0];
    memmove(f->at_work, f->at_work + 1, --f->count * sizeof *f->at_work);
    return br_gnuplot_end_figure(&oldest, &why) ? br_picture_failed(&why, oldest.script, err)
                                                : BR_OK;
}

static enum br_status render(struct br_picture_files *f, const char *script, struct br_error *err)
{
    struct br_error why = {0};
    enum br_status status = BR_OK;
    if (f->missing)
        return BR_OK;
    if (f->count == sizeof f->at_work / sizeof *f->at_work)
        status = end_oldest(f, err);
    if (status)
        return status;
    if (!br_gnuplot_start(&f->at_work[f->count], f->output->staging, script, NULL, &f->missing,
                          &why)) {
        f->count++;
        return BR_OK;
    }
    return f->missing ? BR_OK : br_picture_failed(&why, script, err);
}

enum br_status br_picture_files_draw(struct br_picture_files *f, const struct br_figure *figure,
                                     struct br_error *err)
{
    char name[BR_SCRIPT_NAME + 8];
    if (br_figure_check(figure, err))
        return err->status;
    for (int script = 0; script < 2; script++) {
        FILE *file;
        BR_SAY(name, "%s%s", figure->stem, script ? ".gp" : ".dat");
        enum br_status status = br_output_file(f->output, name, &file, err);
        if (status)
            return status;
        script ? br_figure_write_script(file, figure) : br_figure_write_data(file, figure);
        status = br_output_close(file, name, err);
        if (status)
            return status;
    }
    return render(f, name, err);
}

enum br_status br_picture_files_finish(struct br_picture_files *f, struct br_error *err)
{
    enum br_status status = BR_OK;
    while (f->count)
        if (end_oldest(f, err))
            status = BR_INTERRUPTED;
    if (br_signals_caught())
        status = br_fail(err, BR_INTERRUPTED, "interrupted");
    if (!status && f->missing && !f->said) {
        f->said = true;
        fprintf(stderr, "beamrate: gnuplot is not installed: the pictures are written as scripts "
                        "(*.gp) and data, but not rendered\n");
    }
    return status;
}

/* ---- reports ---- */

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
