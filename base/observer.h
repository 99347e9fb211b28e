/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Progress and interruption of whatever takes long. */
#ifndef BR_BASE_OBSERVER_H
#define BR_BASE_OBSERVER_H

#include <stdbool.h>

#include "base/status.h"

/* How a long run reports its progress and is stopped. May be called from any thread. */
struct br_observer {
    void (*progress)(void *self, double fraction); /* of the whole work, 0 to 1 */
    bool (*stop)(void *self);                      /* true: give up soon */
    void *self;
    /* reports the share of its work limit that an exact reference has used so far; may be NULL */
    void (*preparing)(void *self, double share);
    void (*warn)(void *self, const char *what); /* of what is left behind; may be NULL */
};

/* Whether the observer asks to stop; false for NULL. */
bool br_observer_stops(const struct br_observer *observer);

/* Then fails with BR_INTERRUPTED. */
enum br_status br_observer_check(const struct br_observer *observer, struct br_error *err);

/* Sets the function that says whether work without an observer must end; NULL, as at first: never.
 */
void br_stop_when(bool (*stop)(void));
bool br_must_stop(void);

/* A share of a longer work: its progress is `from` to `from` + `length` of the whole's. */
struct br_observer_share {
    const struct br_observer *whole; /* borrowed; NULL: nobody */
    double from, length;
};

/* The share's own observer; it borrows the share. */
struct br_observer br_observer_of(struct br_observer_share *share);

#endif
