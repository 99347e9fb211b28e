/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The march that the options of `run` ask for (run_plan.c). */
#ifndef BR_CLI_BEAM_RUN_H
#define BR_CLI_BEAM_RUN_H

#include "cli/beam/session.h"
#include "study/run/run.h"

struct br_run_plan {
    struct br_opened_scene opened;
    struct br_scene marched;       /* borrows from `opened` */
    struct br_run_request request; /* without outputs */
    size_t *level;                 /* the request's levels; owned */
};

/* Checks the options against the open scene. Fails with BR_BAD_INPUT, naming the option, what was
 * found and what was expected; clear the plan even then. */
enum br_status br_run_plan_make(struct br_run_plan *plan, const struct br_options *options,
                                struct br_error *err);
void br_run_plan_clear(struct br_run_plan *plan);

#endif
