/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Long work shows itself on stderr: a bar with the time left on a terminal, a
 * plain line every tenth, but no more than one a second, elsewhere, nothing when quiet. So does the
 * wait for an exact reference, once a second elsewhere. */
#ifndef BR_CLI_PROGRESS_H
#define BR_CLI_PROGRESS_H

#include "study/grid/observer.h"
#include "study/grid/study.h"

/* An observer that shows progress and stops when a signal has come. One run at a time. */
const struct br_observer *br_progress_start(const char *what, bool quiet);

/* Clears the bar. */
void br_progress_end(void);

/* The status of work that has ended; BR_INTERRUPTED where that is BR_OK and a signal has come. */
enum br_status br_progress_result(enum br_status status, struct br_error *err);

#endif
