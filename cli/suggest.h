/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What option somebody may have meant who mistyped it. */
#ifndef BR_CLI_SUGGEST_H
#define BR_CLI_SUGGEST_H

#include <popt.h>
#include <stddef.h>

#include "solver/status.h"
#include "study/scene/nearest.h"

/* Refuses (BR_BAD_INPUT) an option that popt has refused with `code`, and names the nearest one of
 * the table. */
enum br_status br_bad_option(poptContext context, const struct poptOption *table, int code,
                             struct br_error *err);

#endif
