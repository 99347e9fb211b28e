/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The command line of `run`. */
#ifndef BR_CLI_RUN_OPTIONS_H
#define BR_CLI_RUN_OPTIONS_H

#include "cli/study_options.h"

/* As given; NULL: not given. */
struct br_run_options {
    char *scene;
    struct br_study_options method; /* those that `study` has too */
    char *fields, *at, *every, *rows, *json, *out, *animate;
    int check, energies, explain, plot, quiet, help;
};

/* What the options say of a scene. */
struct br_run_plan {
    struct br_method method;
    size_t n, steps, stride;
    unsigned wanted; /* see study/run/model.h */
    size_t *level;   /* levels, ascending; owned; the output times */
    size_t levels;
};

/* Parses argv (argv[0] is "beamrate run"). With --help it prints the help and sets options->help.
 * Fails with BR_BAD_INPUT; clear the options even then. */
enum br_status br_run_options_parse(int argc, const char **argv, struct br_run_options *options,
                                    struct br_error *err);
void br_run_options_clear(struct br_run_options *options);

/* Checks the options against the scene. Fails with BR_BAD_INPUT, naming the option, what was found
 * and what was expected; clear the plan even then. */
enum br_status br_run_plan_make(const struct br_run_options *options, const struct br_scene *scene,
                                struct br_run_plan *plan, struct br_error *err);
void br_run_plan_clear(struct br_run_plan *plan);

#endif
