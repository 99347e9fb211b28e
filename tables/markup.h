/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Formats for people: plain text, Markdown, LaTeX, HTML. One function prints any document; a const
 * record has the texts around each piece, and the functions that are special to a format. */
#ifndef BR_TABLES_MARKUP_H
#define BR_TABLES_MARKUP_H

#include "base/quote.h"
#include "tables/document.h"

/* A document that is being printed. */
struct br_markup_page {
    FILE *out;
    const struct br_markup *markup;
    const struct br_document *d;
    const char *folder; /* of drawn pictures; NULL: none */
    int level;          /* of the caption's heading */
    size_t pictures;    /* so far */
    bool terminal;      /* it gets short tables only, and the commands last */
    int columns;        /* of the terminal; 0: not known, or no terminal */
    bool colour;        /* words of verdicts are coloured */
    void *own;          /* the format's */
    struct br_error *err;
    enum br_status status; /* of all until now; after a failure the rest is left out */
};

struct br_around {
    const char *before, *after; /* NULL: nothing */
};

struct br_markup {
    const struct br_quoting *quoting, *of_lines; /* of texts; of lines to be copied */
    struct br_around heading, answers, answer, note, facts, fact, lines, line, verdicts, verdict,
        head, cell, row, rows;                   /* of a heading %d is the level */
    const char *label, *command, *detail, *mark; /* %s is the text */
    const char *word;                            /* of a verdict: %s is the word, once or twice */
    /* NULL: nothing. */
    const char *gap;     /* before a block of another kind than the last */
    const char *between; /* two cells */
    /* A table up to its first heading; text between its head and `rows`; text behind its rows (the
     * last two may be NULL: nothing). Or `table` prints all of it. */
    void (*open_table)(const struct br_markup_page *p, const struct br_document_table *t,
                       int level);
    void (*open_rows)(const struct br_markup_page *p, const struct br_document_table *t);
    void (*close_table)(const struct br_markup_page *p, const struct br_document_table *t);
    void (*table)(struct br_markup_page *p, const struct br_document_table *t);
    void (*picture)(struct br_markup_page *p, const struct br_block *b);
    bool picture_first; /* the first picture stands below the answers */
    /* NULL: nothing. */
    void (*begin)(const struct br_markup_page *p);
    void (*end)(const struct br_markup_page *p);
    /* NULL: printed as any text, between the texts around it. */
    void (*title)(const struct br_markup_page *p, int level, const char *text);
    void (*paragraph)(const struct br_markup_page *p, const char *text);
    void (*number)(FILE *out, const char *text);
    void (*unit)(FILE *out, const char *unit);
    const char *const *classes; /* for %s in head and cell, as br_markup_columns; NULL: none */
};

/* Prints by a format, texts as they are quoted here. */
#define br_markup_put(p, ...) br_print((p)->out, (p)->markup->quoting, __VA_ARGS__)
/* Prints the word of a verdict, if the first `bytes` bytes of the text are one; else nothing, and
 * returns false. */
bool br_markup_word(const struct br_markup_page *p, const char *text, size_t bytes);
void br_markup_heading(const struct br_markup_page *p, int level, const char *text);

/* Prints lines to be copied. */
void br_markup_lines(const struct br_markup_page *p, const char *lines);

/* Prints one of three words for each column that people see: numbers, texts, wrapped texts. */
void br_markup_columns(const struct br_markup_page *p, const struct br_document_table *t,
                       const char *const word[3]);

/* Prints "2 PASS, 1 FAIL": the verdicts of each kind. */
void br_markup_tally(const struct br_markup_page *page);

/* The head is the caption, the answers and the verdicts; the body is all else, if there is any. */
bool br_markup_has_body(const struct br_markup_page *page);
void br_markup_head(const struct br_markup_page *page);
void br_markup_body(struct br_markup_page *page);
enum br_status br_markup_print(struct br_markup_page *page);

#endif
