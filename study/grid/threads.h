/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How many threads work is done on. */
#ifndef BR_STUDY_GRID_THREADS_H
#define BR_STUDY_GRID_THREADS_H

#ifdef _OPENMP
#include <omp.h>
#endif

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

#endif
