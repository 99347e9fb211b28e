/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reports and pictures on their way into an output folder: for each format and report a file, or
 * several; scripts and data of pictures, rendered while other files are written. A picture that
 * fails costs no table and no exit code: a warning says which, and why. */
#ifndef BR_CLI_DOCUMENTS_H
#define BR_CLI_DOCUMENTS_H

#include "cli/option.h"
#include "cli/output.h"
#include "plots/figure.h"
#include "plots/render.h"
#include "tables/document.h"

/* ---- pictures ---- */

/* Begins with its output, the rest zeros. */
struct br_picture_files {
    const struct br_output *output;
    struct br_gnuplot at_work[8]; /* side by side, in order */
    size_t count;
    bool missing; /* gnuplot */
    bool said;    /* that it is */
};

/* Writes a figure's data and script to the output and starts gnuplot on it, where there is one.
 * Fails as br_figure_check, or with BR_IO, BR_INTERRUPTED. Finish the files even then. */
enum br_status br_picture_files_draw(struct br_picture_files *files, const struct br_figure *figure,
                                     struct br_error *err);

/* Warns of a picture that gnuplot has not drawn (what: its name). Fails with BR_INTERRUPTED where
 * that is why. */
enum br_status br_picture_failed(const struct br_error *why, const char *what,
                                 struct br_error *err);

/* Waits for all pictures, and says once where gnuplot is missing. May be called again. Fails with
 * BR_INTERRUPTED. */
enum br_status br_picture_files_finish(struct br_picture_files *files, struct br_error *err);

/* ---- reports ---- */

/* Writes `count` documents in the formats of --format into the open output of their pictures,
 * as NAME.EXTENSION, and formats that have a table a file as NAME.EXTENSION (its main table) and
 * NAME-TABLE.EXTENSION. report.html has all of them, so it waits for the pictures. Fails as
 * br_document_print, br_output_file or br_picture_files_finish do, or with BR_IO. */
enum br_status br_documents_write(struct br_picture_files *pictures,
                                  const struct br_options *options,
                                  const struct br_document *documents, size_t count,
                                  struct br_error *err);

/* The same of one document in one format. */
enum br_status br_documents_write_as(const struct br_output *output,
                                     const struct br_document_format *format,
                                     const struct br_document *document, struct br_error *err);

/* report.html alone, of at least one document, with the pictures that are drawn by now. */
enum br_status br_documents_write_page(const struct br_output *output,
                                       const struct br_document *documents, size_t count,
                                       struct br_error *err);

/* Shows them on standard output, with an empty line between two. */
enum br_status br_documents_show(const struct br_document *documents, size_t count,
                                 struct br_error *err);

#endif
