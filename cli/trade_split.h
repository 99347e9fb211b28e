/* SPDX-License-Identifier: GPL-3.0-or-later */
/* beamrate trade SCENE --split: where the error of each of some runs comes from. */
#ifndef BR_TRADE_SPLIT_H
#define BR_TRADE_SPLIT_H

#include "solver/status.h"

/* Options as given; borrowed; NULL: not given. */
struct br_trade_split_options {
    const char *scene;
    const char *n, *k;      /* lists (100; a thousandth of the duration) */
    const char *methods;    /* names of contenders (the first) */
    const char *tolerances; /* of adaptive ones (theirs) */
    const char *norm, *threads, *format;
    const char *out; /* folder of the results; NULL: the terminal only */
    int quiet, no_plots;
};

/* Splits, shows and writes. Fails with BR_BAD_INPUT, naming the option; BR_NOT_FINITE where a run
 * fails or nobody can promise a solution; nothing is then written. */
enum br_status br_trade_split(const struct br_trade_split_options *options, struct br_error *err);

#endif
