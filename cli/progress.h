/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Progress of long work on stderr. A terminal gets a bar with the time left. Elsewhere a line is
 * printed at each tenth of the work, but at most once a second; and once a second while an exact
 * reference is computed. --quiet: nothing. Ctrl-C, SIGTERM, SIGHUP: marches stop, no file is left.
 */
#ifndef BR_CLI_PROGRESS_H
#define BR_CLI_PROGRESS_H

#include "base/observer.h"
#include "base/status.h"

/* Catches SIGINT, SIGTERM and SIGHUP; a file size limit then fails the write instead. */
void br_signals_install(void);

/* Whether a signal has come. */
bool br_signals_caught(void);

/* Ends the program as the caught signal would have. */
void br_signals_raise_again(void);

/* An observer that shows progress and stops when a signal has come. One run at a time. */
const struct br_observer *br_progress_start(const char *what, bool quiet);

/* Says that the work now begins part i of `parts` equal parts, from 0 on. */
void br_progress_part(size_t i, size_t parts);

/* Clears the bar. */
void br_progress_end(void);

/* The status of work that has ended; BR_INTERRUPTED if that is BR_OK and a signal has come. */
enum br_status br_progress_result(enum br_status status, struct br_error *err);

#endif
