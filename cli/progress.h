/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Long work shows itself on stderr: a bar with the time left on a terminal, a
 * plain line every tenth, but no more than one a second, elsewhere, nothing when quiet. So does the
 * wait for an exact reference, once a second elsewhere. Ctrl-C and the like end it cleanly: marches
 * stop, nothing is left behind. */
#ifndef BR_CLI_PROGRESS_H
#define BR_CLI_PROGRESS_H

#include "study/grid/observer.h"
#include "study/grid/study.h"

/* Catches SIGINT and SIGTERM; a file size limit then fails the write instead. */
void br_signals_install(void);

/* Whether one has come. */
bool br_signals_caught(void);

/* Ends the program as the caught signal would have. */
void br_signals_raise_again(void);

/* An observer that shows progress and stops when a signal has come. One run at a time. */
const struct br_observer *br_progress_start(const char *what, bool quiet);

/* From now on it is told of part i of so many like ones, from 0 on. */
void br_progress_part(size_t i, size_t parts);

/* Clears the bar. */
void br_progress_end(void);

/* The status of work that has ended; BR_INTERRUPTED where that is BR_OK and a signal has come. */
enum br_status br_progress_result(enum br_status status, struct br_error *err);

#endif
