/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the files of the library share: handles, and the beginning and end of each call. */
#ifndef BR_STUDY_LIBRARY_LIBRARY_H
#define BR_STUDY_LIBRARY_LIBRARY_H

#include <locale.h>

#include "orders/library/beamrate.h"
#include "orders/request.h"
#include "orders/work.h"

/* Each handle begins with its kind, so that a handle of another kind is refused. */
enum br_handle { BR_HANDLE_CHECK = 0x6272, BR_HANDLE_ORDERS, BR_HANDLE_TRADE };
bool br_handle_is(const void *handle, enum br_handle kind); /* false for NULL */

/* The same of orders, with a message. */
enum br_status br_handle_check(const struct beamrate_orders *orders, struct br_error *err);

struct beamrate_orders {
    enum br_handle kind;
    struct br_numbers numbers;
    struct br_orders orders;
    char *report; /* the last one; owned */
};

struct beamrate_trade {
    enum br_handle kind;
    struct br_work_source *source; /* count, owned, as all below */
    size_t count;
    struct br_work_precision *works;
    size_t quantities;
    char *report;
};

/* The request of a table; its texts are borrowed, so it is not cleared. Fails with BR_BAD_INPUT. */
enum br_status br_request_of(const struct beamrate_table *table, struct br_orders_request *request,
                             struct br_error *err);

/* The state of a call. During the call GSL returns its errors, and numbers are read and written as
 * in the locale "C". */
struct br_call {
    locale_t locale;     /* of the thread before the call */
    struct br_error err; /* the error of the call */
};

void br_call_begin(struct br_call *call);

/* The body of a call that makes a handle (out) from zeros. `fill` may use *handle and call. If it
 * fails, the call fails. */
#define MAKE_HANDLE(handle, handle_kind, release, fill)                                           \
    struct br_call call;                                                                          \
    br_call_begin(&call);                                                                         \
    if (!(handle))                                                                                \
        return br_call_end(                                                                       \
            &call, br_fail(&call.err, BR_BAD_INPUT, "found NULL, expected a place for a handle"), \
            err);                                                                                 \
    *(handle) = br_allocate(1, sizeof **(handle));                                                \
    if (*(handle))                                                                                \
        (*(handle))->kind = handle_kind;                                                          \
    const enum br_status made = *(handle) ? (fill) : br_no_memory(&call.err, "a handle");         \
    if (made) {                                                                                   \
        release(*(handle));                                                                       \
        *(handle) = NULL;                                                                         \
    }                                                                                             \
    return br_call_end(&call, made, err)

/* Returns the status in the caller's numbers, and fills *err (out; may be NULL). */
enum beamrate_status br_call_end(struct br_call *call, enum br_status status,
                                 struct beamrate_error *err);

#endif
