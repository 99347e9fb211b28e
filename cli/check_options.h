/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The command line of `check`. */
#ifndef BR_CLI_CHECK_OPTIONS_H
#define BR_CLI_CHECK_OPTIONS_H

#include "cli/method_options.h"

enum { BR_MOST_CHECK_FORMATS = 8 };

struct br_check_options {
    char *file[BR_MOST_CHECK_FORMATS]; /* by br_check_formats; NULL: not given */
    struct br_method_options method;   /* instead of what the scenes say */
    char *compare, *threads, *rounding;
    int all, fail_fast, quiet, help;
    char **scene; /* scenes; owned */
    size_t scenes;

    int thread_count;  /* 0: all cores */
    int rounding_mode; /* of the marches, as fesetround takes it */
};

/* Parses and checks argv (argv[0] is "beamrate check"). With --help it prints the help and sets
 * options->help. Fails with BR_BAD_INPUT; clear the options even then. */
enum br_status br_check_options_parse(int argc, const char **argv, struct br_check_options *options,
                                      struct br_error *err);
void br_check_options_clear(struct br_check_options *options);

#endif
