/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The option --rounding, the same in every command that has it. */
#ifndef BR_CLI_ROUNDING_OPTION_H
#define BR_CLI_ROUNDING_OPTION_H

#include "solver/status.h"

/* The modes' names, one after another, with spaces between them. */
const char *br_rounding_words(void);

/* Reads a mode's name; *mode as fesetround takes it. text NULL: not given, to nearest. Fails with
 * BR_BAD_INPUT. */
enum br_status br_read_rounding(const char *text, int *mode, struct br_error *err);

#endif
