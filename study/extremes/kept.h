/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The file in which verdicts are kept as they come, a line each, so that a run that was ended may
 * go on. Its first line tells the program, the seed and the kind of court. */
#ifndef BR_STUDY_EXTREMES_KEPT_H
#define BR_STUDY_EXTREMES_KEPT_H

#include <stdio.h>

#include "study/extremes/map.h"

/* Reads what is there of the wish's cases: verdict[i] and done[i] (out). A last
 * line without an end counts as nothing; the file is then whole, and open for more lines: *file
 * (out), NULL where the wish keeps nothing. Fails with BR_BAD_INPUT where it has the cases of other
 * options, which the message names, and does not touch it; with BR_IO or BR_NO_MEMORY. */
enum br_status br_kept_open(const struct br_extreme_wish *wish, struct br_extreme_verdict *verdict,
                            bool *done, FILE **file, struct br_error *err);

/* Adds a line; whole in the file when it returns. Fails with BR_IO. */
enum br_status br_kept_add(FILE *file, size_t index, const struct br_extreme_verdict *verdict,
                           struct br_error *err);

#endif
