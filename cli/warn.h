/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Warnings on the terminal (standard error), before marches begin. */
#ifndef BR_CLI_WARN_H
#define BR_CLI_WARN_H

#include "study/foresee/warnings.h"
#include "study/trade/split.h"
#include "study/trade/trial.h"
#include "study/verify/check.h"

/* Prints them, a line each: "beamrate: warning: ...; ...", with the scene's name where it is not
 * "". */
void br_print_warnings(const char *scene, const struct br_warnings *warnings);

/* What is cheap to tell of the many marches of a command, scene by scene. Of the cells of studies,
 * the runs of `trade --split`, and the paper's examples as `figures` marches them: fails with
 * BR_BAD_INPUT or BR_NO_MEMORY where one is refused. */
enum br_status br_warn_of_studies(const struct br_study *studies, size_t count,
                                  struct br_error *err);
enum br_status br_warn_of_splits(const struct br_split *splits, size_t count, struct br_error *err);
enum br_status br_warn_of_paper(struct br_error *err);

/* The same of the marches of checks, and of trials of a scene; a march that is refused is a result
 * of theirs. */
void br_warn_of_checks(const struct br_check *checks, size_t count);
void br_warn_of_trials(const struct br_scene *scene, const struct br_trial *trials, size_t count);

#endif
