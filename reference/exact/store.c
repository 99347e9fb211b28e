/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/exact/store.h"

#include <stdint.h>

struct br_block {
    struct br_block *before;
};

enum { LINE = 64 }; /* bytes: what was taken begins so far behind its block */

void *br_store_take(struct br_store *store, size_t count, size_t size)
{
    const bool fits = !store->failed && count <= (SIZE_MAX - LINE) / size;
    struct br_block *block = fits ? br_allocate_aligned(LINE + count * size, 1) : NULL;
    store->failed = !block;
    if (!block)
        return NULL;
    block->before = store->last;
    store->last = block;
    return (char *)block + LINE;
}

void br_store_clear(struct br_store *store)
{
    while (store->last) {
        struct br_block *block = store->last;
        store->last = block->before;
        free(block);
    }
    store->failed = false;
}
