/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Time on the wall, and of one thread, for reports of cost. */
#ifndef BR_BASE_CLOCK_H
#define BR_BASE_CLOCK_H

#include <time.h>

/* Seconds since some moment; only differences mean anything. */
static inline double br_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Seconds of processor time of this thread. */
static inline double br_thread_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

#endif
