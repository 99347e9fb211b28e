/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "orders/library/library.h"

#include <gsl/gsl_errno.h>
#include <pthread.h>
#include <stdio.h>

const char *beamrate_version(void)
{
    return BEAMRATE_VERSION;
}

/* GSL has one error handler for all threads, and the default one ends the process. So the first
 * call removes the handler, and the last call that ends restores it. Changes that functions of the
 * program make to the handler in between have no effect. */
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static size_t calls_now;
static gsl_error_handler_t *their_handler;

void br_call_begin(struct br_call *call)
{
    *call = (struct br_call){.err = {0}};
    pthread_mutex_lock(&lock);
    if (calls_now++ == 0)
        their_handler = gsl_set_error_handler_off();
    pthread_mutex_unlock(&lock);
    call->locale = uselocale(newlocale(LC_ALL_MASK, "C", (locale_t)0)); /* never fails: static */
}

static enum beamrate_status status_of(enum br_status status)
{
    switch (status) {
    case BR_OK:
        return BEAMRATE_OK;
    case BR_BAD_INPUT:
        return BEAMRATE_BAD_INPUT;
    case BR_NO_MEMORY:
        return BEAMRATE_NO_MEMORY;
    default:
        return BEAMRATE_IO;
    }
}

enum beamrate_status br_call_end(struct br_call *call, enum br_status status,
                                 struct beamrate_error *err)
{
    uselocale(call->locale);
    pthread_mutex_lock(&lock);
    if (--calls_now == 0)
        gsl_set_error_handler(their_handler);
    pthread_mutex_unlock(&lock);
    if (err) {
        err->status = status_of(status);
        snprintf(err->message, sizeof err->message, "%s", status ? call->err.message : "");
    }
    return status_of(status);
}

bool br_handle_is(const void *handle, enum br_handle kind)
{
    return handle && *(const enum br_handle *)handle == kind;
}

enum br_status br_handle_check(const struct beamrate_orders *orders, struct br_error *err)
{
    return br_handle_is(orders, BR_HANDLE_ORDERS)
               ? BR_OK
               : br_fail(err, BR_BAD_INPUT, "orders: found %s, expected a handle of kind 'orders'",
                         orders ? "something else" : "NULL");
}
