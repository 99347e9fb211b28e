/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The command line of `check`. */
#ifndef BR_CHECK_OPTIONS_H
#define BR_CHECK_OPTIONS_H

#include "study/check.h"

enum { BR_MOST_CHECK_FORMATS = 8 };

struct br_check_options {
    char *file[BR_MOST_CHECK_FORMATS]; /* by the registry of emitters; NULL: not given */
    char *compare, *solver, *kernel, *contact, *friction, *threads;
    int all, fail_fast, quiet, help;
    char **scene; /* scenes; owned */
    size_t scenes;

    struct br_check_method method; /* what solver, kernel, contact and friction name */
    int thread_count;              /* 0: all cores */
};

/* Parses and checks argv (argv[0] is "beamrate check"). With --help it prints the help and sets
 * options->help. Fails with BR_BAD_INPUT; clear the options even then. */
enum br_status br_check_options_parse(int argc, const char **argv, struct br_check_options *options,
                                      struct br_error *err);
void br_check_options_clear(struct br_check_options *options);

#endif
