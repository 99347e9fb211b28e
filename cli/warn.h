/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Warnings on the terminal, before a march begins. */
#ifndef BR_CLI_WARN_H
#define BR_CLI_WARN_H

#include "study/foresee/warnings.h"

/* Prints them to standard error, a line each: "beamrate: warning: ...; ...". */
void br_print_warnings(const struct br_warnings *warnings);

/* The same where several scenes are marched: with the scene's name. */
void br_print_warnings_of(const char *scene, const struct br_warnings *warnings);

#endif
