/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A thread that marches one group of units after the other, so that the main thread, the only one
 * that may call MPI, can answer messages meanwhile. */
#ifndef BR_STUDY_RANKS_BENCH_THREAD_H
#define BR_STUDY_RANKS_BENCH_THREAD_H

#include <pthread.h>
#include <stdatomic.h>

#include "study/ranks/unit_march.h"

enum br_bench_state { BR_BENCH_IDLE, BR_BENCH_WORKING, BR_BENCH_DONE, BR_BENCH_ENDING };

struct br_work_bench {
    /* in */
    const struct br_study *studies;
    const struct br_units *units;
    int threads;
    /* out, while the state is BR_BENCH_DONE */
    size_t group;
    struct br_parcel parcel; /* owned */
    struct br_error failure; /* status BR_OK: none */
    /* its own */
    atomic_bool stopped;
    _Atomic double fraction; /* of the group, that is done */
    pthread_t thread;
    pthread_mutex_t lock;
    pthread_cond_t changed;
    enum br_bench_state state;
};

/* Starts the thread; the fields above `group` are set. Fails with BR_NO_MEMORY; end it only if this
 * went well. */
enum br_status br_bench_start(struct br_work_bench *bench, struct br_error *err);

/* Gives a group to an idle bench. */
void br_bench_give(struct br_work_bench *bench, size_t group);

/* Its state; waits for it to be done, at most for so many seconds. */
enum br_bench_state br_bench_wait(struct br_work_bench *bench, double seconds);

/* Takes what a bench that is done has made: it is idle then. */
struct br_parcel br_bench_take(struct br_work_bench *bench);

/* Makes it stop soon, waits for that, and releases all. */
void br_bench_end(struct br_work_bench *bench);

#endif
