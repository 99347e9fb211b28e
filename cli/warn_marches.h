/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Warnings of the many marches of a command, scene by scene, before they begin: what is cheap to
 * tell of each. On standard error. */
#ifndef BR_CLI_WARN_MARCHES_H
#define BR_CLI_WARN_MARCHES_H

#include "study/trade/plan.h"
#include "study/trade/split.h"
#include "study/trade/trade.h"
#include "study/verify/check.h"

/* The cells of studies. Fails with BR_BAD_INPUT or BR_NO_MEMORY where one is refused. */
enum br_status br_warn_of_studies(const struct br_study *studies, size_t count,
                                  struct br_error *err);

/* The marches of checks, and the trials of a trade; one that is refused is a result of theirs. */
void br_warn_of_checks(const struct br_check *checks, size_t count);
void br_warn_of_trade(const struct br_trade *trade);

/* The trial that a plan has chosen, if there is one. */
void br_warn_of_plan(const struct br_plan *plan);

/* The runs of `trade --split`, and the paper's examples as `figures` marches them. They fail as
 * br_warn_of_studies does. */
enum br_status br_warn_of_splits(const struct br_split *splits, size_t count, struct br_error *err);
enum br_status br_warn_of_paper(struct br_error *err);

#endif
