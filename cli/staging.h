/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The hidden folder that results are written in before they are put in place. Who writes in it has
 * locked it; the lock ends with its program, however that ends. Its own files begin with a dot. */
#ifndef BR_CLI_STAGING_H
#define BR_CLI_STAGING_H

#include <stdbool.h>

#include "solver/status.h"

/* What the names of all hidden folders and files begin with. */
#define BR_STAGING_PREFIX ".beamrate"

/* Makes and locks a hidden folder in an open one. BR_OK with folder (out): its descriptor; -1: it
 * is there, and nobody uses it. Fails with BR_BAD_INPUT where it cannot be made, or where another
 * program uses it, which the message names. */
enum br_status br_staging_make(int parent, const char *name, int *folder, struct br_error *err);

/* The descriptor of a hidden folder that this user's program left behind, which is then locked;
 * -1: it is in use, or no such folder. */
int br_staging_take(int parent, const char *name);

/* Removes a locked one with its files, and closes it. */
void br_staging_remove(int parent, const char *name, int folder);

/* Removes a hidden file that nobody is writing. */
void br_staging_remove_file(int parent, const char *name);

#endif
