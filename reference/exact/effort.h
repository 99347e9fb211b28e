/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How much work an exact solution may take, who may end it, and who is told. */
#ifndef BR_REFERENCE_EXACT_EFFORT_H
#define BR_REFERENCE_EXACT_EFFORT_H

#include <stdbool.h>

#include "solver/status.h"

struct br_effort {
    double done, most;        /* units of about a microsecond: counted, not measured */
    bool (*stop)(void *self); /* true: give up; NULL: never */
    void *stop_self;
    void (*progress)(void *self, double fraction); /* of the most work; NULL: nobody is told */
    void *progress_self;
};

/* Fails with BR_INTERRUPTED, or BR_NOT_FINITE where no work is left. */
static inline enum br_status br_effort_spend(struct br_effort *effort, double work,
                                             struct br_error *err)
{
    effort->done += work;
    if (effort->stop && effort->stop(effort->stop_self))
        return br_fail(err, BR_INTERRUPTED, "interrupted");
    if (effort->progress)
        effort->progress(effort->progress_self, effort->done / effort->most);
    if (!(effort->done <= effort->most))
        return br_fail(
            err, BR_NOT_FINITE,
            "more work than is allowed, some 20 s of a core, does not make two solutions agree");
    return BR_OK;
}

#endif
