/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reports on their way into an output folder: for each format and report a file, or several. */
#ifndef BR_CLI_DOCUMENTS_H
#define BR_CLI_DOCUMENTS_H

#include "cli/option.h"
#include "cli/picture_files.h"
#include "tables/document.h"

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
