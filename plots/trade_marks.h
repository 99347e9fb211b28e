/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the data and the script of a work-precision diagram share. */
#ifndef BR_PLOTS_TRADE_MARKS_H
#define BR_PLOTS_TRADE_MARKS_H

#include "plots/trade.h"

/* Points that are marked besides the curves; each is a block of data. */
enum { BR_TRADE_MARKS = 4 };
struct br_trade_mark {
    const char *title, *pen; /* in the key; for gnuplot */
    bool (*has)(const struct br_trial *trial);
};
extern const struct br_trade_mark br_trade_marks[BR_TRADE_MARKS];

/* Whether a trial has a place in the picture. */
bool br_trade_is_drawn(const struct br_trade_picture *picture, const struct br_trial *trial);

/* How many points of a picture have a mark. */
size_t br_trade_count_marked(const struct br_trade_picture *picture, const struct br_trade *trade,
                             const struct br_trade_mark *mark);

#endif
