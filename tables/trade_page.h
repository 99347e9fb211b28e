/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a trade says, as pages of text cells, so that all formats say the same. */
#ifndef BR_TABLES_TRADE_PAGE_H
#define BR_TABLES_TRADE_PAGE_H

#include "study/trade/trade.h"
#include "tables/sheet.h"

/* One scene's trade, with what is needed to repeat it. All borrowed. */
struct br_trade_page {
    const char *name;    /* of the files, and of the scene in summaries */
    const char *caption; /* one line */
    const struct br_trade *trade;
    const struct br_provenance *provenance;
};

/* One scene's trade as a page: the cheapest way to each error, seconds of each method to these, all
 * trials; and the cheapest ways of several scenes. Both borrow all. */
void br_trade_fill(const struct br_trade_page *trade, struct br_page *page);
void br_trade_fill_summary(const struct br_trade_page *trade, size_t scenes, struct br_page *page);

/* What was measured and how, and how the trials ended that did not come to a good end. */
void br_say_trade(const struct br_trade_page *page, const struct br_writer *writer);
void br_say_trade_ends(const struct br_trade_page *page, const struct br_writer *writer);

#endif
