/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a trade says, as sheets of text cells that every format prints in its own way, so that all
 * formats say the same. */
#ifndef BR_TRADE_PAGE_H
#define BR_TRADE_PAGE_H

#include "study/trade.h"
#include "tables/emitter.h"
#include "tables/sentences.h"

/* One scene's trade, with what is needed to repeat it. All borrowed. */
struct br_trade_page {
    const char *name;    /* of the files, and of the scene in summaries */
    const char *caption; /* one line */
    const struct br_trade *trade;
    const struct br_provenance *provenance;
};

/* A table of text, of one page or, for the summary, of several. */
struct br_sheet;
struct br_sheet_view {
    const struct br_sheet *sheet;
    const struct br_trade_page *page; /* pages */
    size_t pages;
};

struct br_sheet {
    const char *name; /* as in JSON */
    const char *title;
    size_t columns;
    size_t (*rows)(const struct br_sheet_view *view);
    /* The heading of a column, and whether its cells are numbers. */
    const char *(*heading)(size_t column, bool *number);
    /* A cell's text (out); "-": nothing. */
    void (*cell)(const struct br_sheet_view *view, size_t row, size_t column, char *text,
                 size_t size);
};

/* The cheapest way to each error; of several pages with their names. */
extern const struct br_sheet br_sheet_cheapest, br_sheet_summary;
/* Seconds of each method to each error; all trials. */
extern const struct br_sheet br_sheet_methods, br_sheet_trials;

enum { BR_SHEET_CELL = 128 };

/* The sheets of one page, in order; NULL-terminated. */
extern const struct br_sheet *const br_trade_sheets[];

/* What was measured and how, and how the trials ended that did not come to a good end. */
void br_say_trade(const struct br_trade_page *page, const struct br_writer *writer);
void br_say_trade_ends(const struct br_trade_page *page, const struct br_writer *writer);

#endif
