/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/status.h"

#include <errno.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>

enum br_status br_fail(struct br_error *err, enum br_status status, const char *format, ...)
{
    if (err) {
        va_list args;
        va_start(args, format);
        vsnprintf(err->message, sizeof err->message, format, args);
        va_end(args);
        err->status = status;
    }
    return status;
}

enum br_status br_no_memory(struct br_error *err, const char *what)
{
    return br_fail(err, BR_NO_MEMORY, "out of memory for %s", what);
}

enum br_status br_status_of_errno(int reason)
{
    static const int wrong_path[] = {ENOENT, ENOTDIR, EISDIR, EACCES, EPERM, ELOOP,  ENAMETOOLONG,
                                     EEXIST, EINVAL,  ENXIO,  ENODEV, EBUSY, ETXTBSY};
    for (size_t i = 0; i < sizeof wrong_path / sizeof *wrong_path; i++)
        if (reason == wrong_path[i])
            return BR_BAD_INPUT;
    return reason == ENOMEM ? BR_NO_MEMORY : reason == EINTR ? BR_INTERRUPTED : BR_IO;
}

int br_status_exit_code(enum br_status status)
{
    switch (status) {
    case BR_OK:
        return 0;
    case BR_VERDICT:
        return 1;
    case BR_BAD_INPUT:
    case BR_UNSUPPORTED:
        return 2;
    default:
        return 3;
    }
}

static atomic_long until_failure = -1;

long br_allocation_fails_at(long i)
{
    return atomic_exchange(&until_failure, i);
}

static bool fails_now(void)
{
    return atomic_load(&until_failure) >= 0 && atomic_fetch_sub(&until_failure, 1) == 0;
}

void *br_allocate(size_t count, size_t size)
{
    return fails_now() ? NULL : calloc(count ? count : 1, size);
}

void *br_allocate_aligned(size_t count, size_t size)
{
    enum { LINE = 64, HUGE_PAGE = 2 << 20 };
    if (fails_now() || (size && count > (SIZE_MAX - HUGE_PAGE) / size))
        return NULL;
    const size_t wanted = count * size, unit = wanted >= HUGE_PAGE ? HUGE_PAGE : LINE;
    const size_t bytes = (wanted + unit) / unit * unit;
    void *p = aligned_alloc(unit, bytes);
    if (!p)
        return NULL;
    if (unit == HUGE_PAGE) /* fewer TLB misses; a refusal does no harm */
        madvise(p, bytes, MADV_HUGEPAGE);
    return memset(p, 0, bytes);
}

bool br_grow(void *array, size_t count, size_t *room, size_t size)
{
    void **old = array;
    if (count < *room)
        return true;
    const size_t more = 2 * *room + 8;
    void *larger = br_allocate(more, size);
    if (!larger)
        return false;
    if (count)
        memcpy(larger, *old, count * size);
    free(*old);
    *old = larger;
    *room = more;
    return true;
}

/* ---- memory with one owner ---- */

struct br_store_block {
    struct br_store_block *before;
};

enum { LINE = 64 }; /* bytes from a block's start to its data */

void *br_store_take(struct br_store *store, size_t count, size_t size)
{
    const bool fits = !store->failed && count <= (SIZE_MAX - LINE) / size;
    struct br_store_block *block = fits ? br_allocate_aligned(LINE + count * size, 1) : NULL;
    store->failed = !block;
    if (!block)
        return NULL;
    block->before = store->last;
    store->last = block;
    return (char *)block + LINE;
}

char *br_store_copy(struct br_store *store, const char *text)
{
    char *copy = br_store_take(store, strlen(text) + 1, 1);
    return copy ? strcpy(copy, text) : NULL;
}

void *br_store_grow(struct br_store *store, void *array, size_t count, size_t *room, size_t size)
{
    if (count < *room)
        return array;
    const size_t more = 2 * *room + 32;
    void *bigger = br_store_take(store, more, size);
    if (!bigger)
        return NULL;
    if (count)
        memcpy(bigger, array, count * size);
    *room = more;
    return bigger;
}

void br_store_clear(struct br_store *store)
{
    while (store->last) {
        struct br_store_block *block = store->last;
        store->last = block->before;
        free(block);
    }
    store->failed = false;
}
