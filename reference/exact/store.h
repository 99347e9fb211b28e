/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Memory with one owner: taken piece by piece, released at once. */
#ifndef BR_REFERENCE_EXACT_STORE_H
#define BR_REFERENCE_EXACT_STORE_H

#include <stdbool.h>

#include "solver/status.h"

struct br_store {
    struct br_block *last; /* each block points to the one before it */
    bool failed;           /* there was no memory for a piece */
};

/* count zeroed things of a size in bytes, at the start of a cache line. NULL where there is no room
 * or was none before: whoever takes several looks at `failed` after the last of them. */
void *br_store_take(struct br_store *store, size_t count, size_t size);
void br_store_clear(struct br_store *store);

#endif
