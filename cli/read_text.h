/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef BR_READ_TEXT_H
#define BR_READ_TEXT_H

#include "solver/status.h"

/* A file's text, up to 1 MB, owned by the caller. Fails with BR_BAD_INPUT or BR_NO_MEMORY. */
enum br_status br_read_text(const char *path, char **text, struct br_error *err);

#endif
