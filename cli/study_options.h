/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The options that `study` and `tables` share. */
#ifndef BR_CLI_STUDY_OPTIONS_H
#define BR_CLI_STUDY_OPTIONS_H

#include <popt.h>
#include <stdio.h>

#include "cli/method_options.h"
#include "study/grid/study.h"

/* As given, before they are checked; NULL: not given. */
struct br_study_options {
    char *n, *k, *reference, *norm;
    struct br_method_options method;
    char *reference_solver, *threads;
    char *out, *format;
    int quiet, no_plots, help;
};

/* What the options say. */
struct br_study_request {
    size_t *n; /* n_count; owned */
    double *k; /* k_count, s; owned */
    size_t n_count, k_count;
    const struct br_judge *judge; /* NULL: not said */
    const struct br_norm *norm[BR_MOST_NORMS];
    size_t norms;
    size_t reference_n;
    double reference_k; /* s */
    struct br_method method, reference_method;
    int threads; /* 0: all cores */
};

/* Parses argv (argv[0] is "beamrate COMMAND") into options, over the defaults that they
 * hold, and *argument, the one word that is no option (NULL: none is wanted). With
 * --help it prints the help and sets options->help. Fails with BR_BAD_INPUT. */
enum br_status br_study_options_parse(int argc, const char **argv, const char *usage,
                                      struct br_study_options *options, char **argument,
                                      struct br_error *err);
void br_study_options_clear(struct br_study_options *options);

/* Checks the options and reads the lists. Fails with BR_BAD_INPUT, naming the option,
 * what was found and what was expected. */
enum br_status br_study_request_read(const struct br_study_options *options,
                                     struct br_study_request *request, struct br_error *err);
void br_study_request_clear(struct br_study_request *request);

#endif
