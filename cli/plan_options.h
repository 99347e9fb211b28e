/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The options of `plan`. */
#ifndef BR_CLI_PLAN_OPTIONS_H
#define BR_CLI_PLAN_OPTIONS_H

#include "cli/study_options.h"
#include "study/trade/plan.h"

struct br_plan_options {
    struct br_study_options study; /* reference, norm, format, threads, out, quiet, help */
    char *methods, *error, *seconds, *repeats, *time_limit; /* as given; NULL: not given */
    char *scene;                                            /* owned */
};

/* What they say. */
struct br_plan_wish {
    struct br_study_request study;
    struct br_contenders contenders; /* count 0: not said */
    struct br_plan_goal goal;
    size_t repeats;    /* 0: not said */
    double time_limit; /* s; NaN: not said */
};

/* Parses argv; with --help it prints the help and sets options->study.help. Fails with
 * BR_BAD_INPUT. Clear the options even then. */
enum br_status br_plan_options_parse(int argc, const char **argv, struct br_plan_options *options,
                                     struct br_error *err);
void br_plan_options_clear(struct br_plan_options *options);

/* Checks the options. Fails with BR_BAD_INPUT, naming the option, what was found and what was
 * expected. Clear the wish even then. */
enum br_status br_plan_wish_read(const struct br_plan_options *options, struct br_plan_wish *wish,
                                 struct br_error *err);
void br_plan_wish_clear(struct br_plan_wish *wish);

#endif
