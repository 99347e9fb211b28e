/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What somebody may have meant who mistyped a name. */
#ifndef BR_SUGGEST_H
#define BR_SUGGEST_H

#include <popt.h>
#include <stddef.h>

#include "solver/status.h"

/* The nearest of count names, by the number of letters that differ; NULL: none is near. */
const char *br_nearest(const char *word, const char *const *names, size_t count);

/* Refuses (BR_BAD_INPUT) an option that popt has refused with `code`, and names the nearest one of
 * the table. */
enum br_status br_bad_option(poptContext context, const struct poptOption *table, int code,
                             struct br_error *err);

#endif
