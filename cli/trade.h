/* SPDX-License-Identifier: GPL-3.0-or-later */
/* trade of any programs: study files that run them, and tables with a cost. */
#ifndef BR_CLI_TRADE_H
#define BR_CLI_TRADE_H

#include "cli/session.h"
#include "orders/work.h"

/* Whether a word names a table or a study file, and not a scene. */
bool br_is_trade_source(const char *word);

/* Runs and reads the sources, and writes what a digit costs in them and in others, which are
 * borrowed. Fails as br_study_file_run, br_work_find and br_session_finish; when all is written,
 * with BR_NOT_FINITE where runs have failed. */
enum br_status br_trade_sources(const struct br_options *options, struct br_session *session,
                                const struct br_work_source *other, size_t others,
                                struct br_error *err);

#define BR_TRADE_ABOUT                                                                              \
    "Errors over costs of several programs: study files (.yaml) that run them, and tables with a "  \
    "column of a cost: seconds, cpu, wall, dofs, iterations, memory. All must measure an error of " \
    "one name. The answer is the cheapest program to each power of ten, its size, its cost, and "   \
    "what the next one costs; how costs grow; and what 1e-6 would cost. Times are medians of "      \
    "repeated runs, one at a time."

#endif
