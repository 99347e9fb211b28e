/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Ctrl-C and the like end a run cleanly: marches stop, nothing is left behind. */
#ifndef BR_CLI_SIGNALS_H
#define BR_CLI_SIGNALS_H

#include <stdbool.h>

/* Catches SIGINT and SIGTERM; a file size limit then fails the write instead. */
void br_signals_install(void);

/* Whether one has come. */
bool br_signals_caught(void);

/* Ends the program as the caught signal would have. */
void br_signals_raise_again(void);

#endif
