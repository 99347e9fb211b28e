/* SPDX-License-Identifier: GPL-3.0-or-later */
/* --format LIST: names of the rows of br_document_formats (tables/document.h). */
#ifndef BR_CLI_FORMATS_H
#define BR_CLI_FORMATS_H

#include <stdbool.h>

#include "solver/status.h"

/* Fails with BR_BAD_INPUT where a name is none of them; NULL: not given. */
enum br_status br_formats_check(const char *list, struct br_error *err);

/* Whether a format is in the list; NULL: all are. */
bool br_format_wanted(const char *list, const char *name);

#endif
