/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Outcomes, and memory. */
#ifndef BR_BASE_STATUS_H
#define BR_BASE_STATUS_H

#include <stdbool.h>
#include <stdlib.h>

enum br_status {
    BR_OK,
    BR_VERDICT, /* a verdict failed */
    BR_BAD_INPUT,
    BR_UNSUPPORTED, /* not in this build */
    BR_NO_MEMORY,
    BR_SINGULAR, /* the system is not positive definite */
    BR_NOT_FINITE,
    BR_IO,
    BR_INTERRUPTED,
};

/* What went wrong, for a person. After anything but BR_OK the object that was
 * being worked on can only be freed. */
struct br_error {
    enum br_status status;
    char message[1024];
};

/* Record a failure: sets err->status and the formatted message (err may be
 * NULL), and returns status, so that callers write
 *     return br_fail(err, BR_BAD_INPUT, "n is %zu, expected at least 1", n); */
__attribute__((format(printf, 3, 4))) enum br_status br_fail(struct br_error *err,
                                                             enum br_status status,
                                                             const char *format, ...);

/* Out of memory, with the name of what was being made. */
enum br_status br_no_memory(struct br_error *err, const char *what);

/* What a failure to open or write a path comes to, by its errno: BR_BAD_INPUT where the path is
 * wrong; where the system fails (a full disk, no memory, a signal), another status. */
enum br_status br_status_of_errno(int reason);

/* The program's exit code: 0 success, 1 a verdict failed, 2 bad input, 3 the computation failed. */
int br_status_exit_code(enum br_status status);

/* calloc with a test hook: br_allocation_fails_at(i) makes the i-th allocation
 * from now on (0 = the next one) fail once; a negative i switches it off. Returns how many would
 * have come before the failure that it replaces; negative: it has happened. */
void *br_allocate(size_t count, size_t size);

/* Like br_allocate, but aligned to a cache line. */
void *br_allocate_aligned(size_t count, size_t size);
long br_allocation_fails_at(long i);

/* Makes room for one more than `count` elements in an array of br_allocate. array: the address of
 * its pointer, in/out; size: bytes of an element. False: no memory; the array is as it was. */
bool br_grow(void *array, size_t count, size_t *room, size_t size);

/* ---- memory with one owner: taken piece by piece, released at once ---- */

struct br_store {
    struct br_store_block *last; /* each block points to the one before it */
    bool failed;                 /* there was no memory for a piece */
};

/* count zeroed things of a size in bytes, at the start of a cache line. NULL if memory is exhausted
 * or was before: a caller that takes several pieces checks `failed` after the last one. */
void *br_store_take(struct br_store *store, size_t count, size_t size);

/* A copy of a text. */
char *br_store_copy(struct br_store *store, const char *text);

/* The array with room for one more than `count`: itself, or a larger copy. NULL as above. */
void *br_store_grow(struct br_store *store, void *array, size_t count, size_t *room, size_t size);
void br_store_clear(struct br_store *store);

#endif
