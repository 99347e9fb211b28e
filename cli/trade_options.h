/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The options of `trade`. */
#ifndef BR_CLI_TRADE_OPTIONS_H
#define BR_CLI_TRADE_OPTIONS_H

#include "cli/study_options.h"
#include "study/trade/contender.h"

struct br_trade_options {
    struct br_study_options study; /* n, k, reference, norm, format, threads, out and the like */
    char *methods, *tolerances, *repeats, *time_limit; /* as given; NULL: not given */
    int split;
    char **scene; /* scenes; owned */
    size_t scenes;
};

/* What they say. */
struct br_trade_wish {
    struct br_study_request study;
    struct br_contenders contenders; /* count 0: not said */
    double *tolerance;               /* tolerances; owned */
    size_t tolerances;
    size_t repeats;    /* 0: not said */
    double time_limit; /* s; NaN: not said */
};

/* Parses argv; with --help it prints the help and sets options->study.help. Fails with
 * BR_BAD_INPUT. Clear the options even then. */
enum br_status br_trade_options_parse(int argc, const char **argv, struct br_trade_options *options,
                                      struct br_error *err);
void br_trade_options_clear(struct br_trade_options *options);

/* Checks the options and reads the lists. Fails with BR_BAD_INPUT, naming the option, what was
 * found and what was expected. Clear the wish even then. */
enum br_status br_trade_wish_read(const struct br_trade_options *options,
                                  struct br_trade_wish *wish, struct br_error *err);
void br_trade_wish_clear(struct br_trade_wish *wish);

#endif
