/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pages of tables and sentences, whatever they are of: what is said stands here once, and every
 * format prints it in its own way. Emitters compute nothing. */
#ifndef BR_TABLES_SHEET_H
#define BR_TABLES_SHEET_H

#include "tables/document.h"
#include "tables/sentences.h"

enum { BR_CELL = 160 };

/* A table of text cells. */
struct br_table {
    const char *name; /* one word, as in JSON and in the names of CSV files */
    const char *title;
    size_t columns, rows;
    bool only_in_files; /* too long for a terminal */
    const void *self;   /* borrowed */
    /* The heading of a column, and whether its cells are numbers. */
    const char *(*heading)(const void *self, size_t column, bool *number);
    /* A cell's text (out), plain; "-": nothing. */
    void (*cell)(const void *self, size_t row, size_t column, char text[BR_CELL]);
};

enum { BR_PAGE_TABLES = 8 };

/* What has been found, with what is needed to repeat it. All borrowed. */
struct br_page {
    const char *name;    /* of the files */
    const char *caption; /* one line */
    struct br_table table[BR_PAGE_TABLES];
    size_t tables;
    const void *self;
    /* Before the tables, the verdict first; and below them. Either may be NULL. */
    void (*say)(const void *self, const struct br_writer *writer);
    void (*say_notes)(const void *self, const struct br_writer *writer);
    const char *notes_title; /* where a format has headings; NULL: none */
    size_t notes_shown;      /* on a terminal; 0: all */
    const struct br_provenance *provenance;
};

struct br_page_emitter {
    const char *name;      /* as on the command line */
    const char *extension; /* of its file, with the dot */
    /* Fails with BR_NO_MEMORY only: write errors stay in `out`. */
    enum br_status (*emit)(FILE *out, const struct br_page *page, struct br_error *err);
};

extern const struct br_page_emitter br_page_text, br_page_csv, br_page_markdown, br_page_latex,
    br_page_json;

/* NULL-terminated; the first is the terminal's. */
extern const struct br_page_emitter *const br_page_emitters[];
const struct br_page_emitter *br_page_emitter_find(const char *name);

/* For a terminal: as the first, without long tables and without notes beyond
 * notes_shown. Fails with BR_NO_MEMORY. */
enum br_status br_page_show(FILE *out, const struct br_page *page, struct br_error *err);

#endif
