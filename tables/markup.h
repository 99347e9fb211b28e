/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Formats for people: plain text, Markdown, LaTeX, HTML. One walk prints a document; a const record
 * says what stands around each piece, and has functions for what is a format's own. */
#ifndef BR_TABLES_MARKUP_H
#define BR_TABLES_MARKUP_H

#include "study/scene/quote.h"
#include "tables/document.h"

/* A document on its way out. */
struct br_markup_page {
    FILE *out;
    const struct br_markup *markup;
    const struct br_document *d;
    const char *folder; /* of drawn pictures; NULL: none */
    int level;          /* of the caption's heading */
    size_t pictures;    /* so far */
    bool terminal;      /* it gets what is short, and the answer last */
    void *own;          /* the format's */
    struct br_error *err;
    enum br_status status; /* of all until now: what cannot be printed is left out */
};

struct br_around {
    const char *before, *after; /* NULL: nothing */
};

struct br_markup {
    const struct br_quoting *quoting, *of_lines; /* of texts; of what is to be copied */
    struct br_around heading, answers, answer, note, facts, fact, label, command, lines, line,
        verdicts, verdict, detail, head, cell, mark, row, rows;
    const char *word; /* of a verdict: %s is the word, and perhaps again */
    /* NULL: nothing. */
    const char *gap;     /* before a block of another kind than the last */
    const char *between; /* two cells */
    const char *rule;    /* before a row that has a line above it */
    /* A table to its first heading; more between its head and `rows` (NULL: nothing), and behind
     * these; or all of it. */
    void (*open_table)(const struct br_markup_page *p, const struct br_document_table *t,
                       int level);
    void (*open_rows)(const struct br_markup_page *p, const struct br_document_table *t);
    void (*close_table)(const struct br_markup_page *p, const struct br_document_table *t);
    void (*table)(struct br_markup_page *p, const struct br_document_table *t);
    void (*picture)(struct br_markup_page *p, const struct br_block *b);
    /* NULL: nothing. */
    void (*begin)(const struct br_markup_page *p);
    void (*end)(const struct br_markup_page *p);
    /* NULL: as any text, between what stands around it. */
    void (*title)(const struct br_markup_page *p, int level, const char *text);
    void (*paragraph)(const struct br_markup_page *p, const char *text);
    void (*number)(FILE *out, const char *text);
    void (*unit)(FILE *out, const char *unit);
    const char *const *classes; /* for %s in head and cell, as br_markup_columns; NULL: none */
};

/* A text as the format quotes it (NULL: nothing), and between two others. In headings %d is the
 * level. */
void br_markup_text(const struct br_markup_page *p, const char *text);
void br_markup_put(const struct br_markup_page *p, const char *before, const char *text,
                   const char *after);
void br_markup_heading(const struct br_markup_page *p, int level, const char *text);

/* Lines to be copied. */
void br_markup_lines(const struct br_markup_page *p, const char *lines);

/* One of three words for each column that people see: numbers, texts, texts on several lines. */
void br_markup_columns(const struct br_markup_page *p, const struct br_document_table *t,
                       const char *const word[3]);

enum br_status br_markup_print(struct br_markup_page *page);

#endif
