/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A loop whose turns are shared by threads, with progress, interruption and the first failure. */
#ifndef BR_STUDY_GRID_EACH_H
#define BR_STUDY_GRID_EACH_H

#include <stddef.h>
#ifdef _OPENMP
#include <omp.h>
#endif

#include "solver/status.h"
#include "study/grid/observer.h"

/* `wanted`, or where that is 0 one for each core; 1 in a build without OpenMP. */
static inline int br_threads(int wanted)
{
#ifdef _OPENMP
    return wanted > 0 ? wanted : omp_get_num_procs();
#else
    (void)wanted;
    return 1;
#endif
}

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
