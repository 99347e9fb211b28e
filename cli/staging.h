/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The hidden folders that results are written in before they are moved into place. One that is in
 * use is locked; the lock ends with its program, however that ends. */
#ifndef BR_STAGING_H
#define BR_STAGING_H

#include <stdbool.h>
#include <stddef.h>

/* Makes and locks a hidden folder in `folder`: its path (out, size bytes) and the lock's descriptor
 * (out; -1: the file system has no locks). False: it cannot be made, errno tells why. */
bool br_staging_make(const char *folder, char *path, size_t size, int *lock);

/* Removes the hidden folders in `folder` that nobody uses any more: of a program that was ended by
 * force. Those of other users, and what cannot be removed, stay. */
void br_staging_sweep(const char *folder);

#endif
