/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The options of `extremes`. */
#ifndef BR_CLI_EXTREMES_OPTIONS_H
#define BR_CLI_EXTREMES_OPTIONS_H

#include "cli/extremes_part.h"

enum { BR_EXTREMES_MOST = 16 };

/* As given; NULL: not given. */
struct br_extremes_options {
    char *n, *k, *cases, *seed, *rounding, *threads, *out, *format;
    int no_plots, resume, quiet, help;
    const struct br_extremes_part *part[BR_EXTREMES_MOST]; /* parts, in the registry's order */
    size_t parts;
};

/* What they say. */
struct br_extremes_wish {
    size_t *n; /* n_count; owned */
    double *k; /* k_count, s; owned */
    size_t n_count, k_count, cases;
    uint64_t seed;
    int rounding, threads;
};

/* Parses argv; with --help it prints the help and sets options->help. Fails with BR_BAD_INPUT.
 * Clear the options even then. */
enum br_status br_extremes_options_parse(int argc, const char **argv,
                                         struct br_extremes_options *options, struct br_error *err);
void br_extremes_options_clear(struct br_extremes_options *options);

/* Checks the options and reads the lists. Fails with BR_BAD_INPUT, naming the option, what was
 * found and what was expected, and where no chosen part heeds an option. Clear the wish even then.
 */
enum br_status br_extremes_wish_read(const struct br_extremes_options *options,
                                     struct br_extremes_wish *wish, struct br_error *err);
void br_extremes_wish_clear(struct br_extremes_wish *wish);

#endif
