/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Work-precision diagrams of a trade: a registry. Each is a gnuplot script beside its data file;
 * nothing is computed here.
 *
 * A contender's curve joins the trials that none of its own beats; dots are the others. */
#ifndef BR_PLOTS_TRADE_H
#define BR_PLOTS_TRADE_H

#include <stdio.h>

#include "study/trade/trade.h"

struct br_trade_picture {
    const char *name;  /* of the files: <scene>-<name>.gp, .dat, .svg, .png */
    const char *title; /* one line for a person */
    /* Which contenders have a curve. */
    bool (*shows)(const struct br_trade *trade, const struct br_contender *contender);
    const char *label;                            /* of the axis of work, with its unit */
    double (*work)(const struct br_trial *trial); /* along that axis; NaN: not drawn */
};

/* NULL-terminated. */
extern const struct br_trade_picture *const br_trade_pictures[];

/* Whether it has anything to show. */
bool br_trade_picture_applies(const struct br_trade_picture *picture, const struct br_trade *trade);

/* What a picture is drawn from; stem: the files' name without its extension. */
struct br_trade_view {
    const char *caption, *stem;
    const struct br_trade *trade;
};

/* Write the data and the script (out: open files; the caller checks for errors). */
void br_trade_picture_data(FILE *out, const struct br_trade_picture *picture,
                           const struct br_trade_view *view);
void br_trade_picture_script(FILE *out, const struct br_trade_picture *picture,
                             const struct br_trade_view *view);

#endif
