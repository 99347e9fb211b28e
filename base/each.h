/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Threads that share work, and a loop that they share, with progress, interruption and the first
 * failure. */
#ifndef BR_BASE_EACH_H
#define BR_BASE_EACH_H

#include <stddef.h>

#include "base/observer.h"
#include "base/status.h"

enum { BR_MOST_THREADS = 1024 };

/* `wanted`, at most BR_MOST_THREADS; or where that is 0 one for each core. */
int br_threads(int wanted);

/* Calls work(self) in up to `threads` threads at once (of br_threads, or fewer), one of which is
 * the caller's, and returns when all calls have. Where the system has no thread or no memory for
 * one left, there are fewer; within the work of another team there is one. Nothing fails, and no
 * thread outlives the call. */
void br_team(int threads, void (*work)(void *self), void *self);

struct br_each {
    size_t count;                       /* turns */
    int threads;                        /* 0: all cores */
    const struct br_observer *observer; /* of the whole loop; may be NULL */
    /* Does turn i, on any thread, while other turns run. */
    enum br_status (*turn)(void *self, size_t i, struct br_error *err);
    /* The work of turn i, for progress; NULL: all turns cost the same. */
    double (*work)(const void *self, size_t i);
    void *self;
};

/* Begins turns 0, 1, ... in that order, and no more after a failure or when the observer stops the
 * loop. Fails as the turn of the lowest number that failed, or with BR_INTERRUPTED. */
enum br_status br_each(const struct br_each *each, struct br_error *err);

#endif
