/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the command line of `run` says of a scene. */
#ifndef BR_CLI_RUN_H
#define BR_CLI_RUN_H

#include "cli/option.h"
#include "study/run/run.h"

struct br_run_plan {
    struct br_method method;
    size_t n, steps, stride;
    unsigned wanted; /* see study/run/run.h */
    size_t *level;   /* levels, ascending; owned; the output times */
    size_t levels;
};

/* Checks the options against the scene. Fails with BR_BAD_INPUT, naming the option, what was found
 * and what was expected; clear the plan even then. */
enum br_status br_run_plan_make(const struct br_options *options, const struct br_scene *scene,
                                struct br_run_plan *plan, struct br_error *err);
void br_run_plan_clear(struct br_run_plan *plan);

#endif
