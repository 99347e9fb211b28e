/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A report read back as a program reads it, in JSON: what stands under a key, "tables.trials.0.n",
 * is what belongs there. That CSV and the formats for people have the same cells is tested of the
 * document itself (test_document.c). */
#ifndef BR_TESTS_DOCUMENT_READER_H
#define BR_TESTS_DOCUMENT_READER_H

#include <jansson.h>

#include "support.h"
#include "tables/document.h"

extern const struct br_provenance br_made_provenance;

/* A key with the number, count or truth (0, 1) that belongs to it; NAN: nothing does. */
struct expected {
    const char *key;
    double value;
};

/* What a format prints; to be freed. */
char *printed(const struct br_document *d, const struct br_document_format *format);

/* Prints and clears the document; the JSON is to be released. */
json_t *read_back(struct br_document *d);

/* The value at a path, which must be there; NULL or "": the root. */
const json_t *at_path(const json_t *root, const char *path);

/* Numbers to the last bit, and texts, both under an object's path; pairs end with NULL. */
void numbers_are(const json_t *root, const char *path, const struct expected *e, size_t count);
#define NUMBERS(root, path, rows) numbers_are(root, path, rows, sizeof(rows) / sizeof *(rows))
void texts_are(const json_t *root, const char *path, const char *const pairs[]);
#define TEXTS(root, path, ...) texts_are(root, path, (const char *const[]){__VA_ARGS__, NULL})

/* One of the answers is that sentence. */
void answers(const json_t *root, const char *sentence);

#endif
