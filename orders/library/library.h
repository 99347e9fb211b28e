/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the files of the library share: handles, and the beginning and end of each call. */
#ifndef BR_STUDY_LIBRARY_LIBRARY_H
#define BR_STUDY_LIBRARY_LIBRARY_H

#include <locale.h>

#include "orders/library/beamrate.h"
#include "orders/orders.h"

/* Each handle begins with its kind, so that a handle of another kind is refused. */
enum br_handle { BR_HANDLE_CHECK = 0x6272, BR_HANDLE_ORDERS };
bool br_handle_is(const void *handle, enum br_handle kind); /* false for NULL */

/* The same of orders, with a message. */
enum br_status br_handle_check(const struct beamrate_orders *orders, struct br_error *err);

struct beamrate_orders {
    enum br_handle kind;
    struct br_numbers numbers;
    struct br_orders orders;
    char *report; /* the last one; owned */
};

/* The state of a call. During the call GSL returns its errors, and numbers are read and written as
 * in the locale "C". */
struct br_call {
    locale_t locale;     /* of the thread before the call */
    struct br_error err; /* the error of the call */
};

void br_call_begin(struct br_call *call);

/* Returns the status in the caller's numbers, and fills *err (out; may be NULL). */
enum beamrate_status br_call_end(struct br_call *call, enum br_status status,
                                 struct beamrate_error *err);

#endif
