/* SPDX-License-Identifier: GPL-3.0-or-later */
/* beamrate trade SCENE --split: where the error of each of some runs comes from. */
#ifndef BR_CLI_TRADE_SPLIT_H
#define BR_CLI_TRADE_SPLIT_H

#include "cli/option.h"

/* Splits the errors of all runs of the first scene, shows and writes them. Fails with BR_BAD_INPUT,
 * naming the option; BR_NOT_FINITE where a run fails or nobody can promise a solution: nothing is
 * written then. */
enum br_status br_trade_split(const struct br_options *options, struct br_error *err);

#endif
