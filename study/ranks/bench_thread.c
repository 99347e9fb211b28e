/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/ranks/bench_thread.h"
#include "study/grid/observer.h"

#include <signal.h>
#include <time.h>

static void keep_fraction(void *self, double fraction)
{
    struct br_work_bench *bench = self;
    atomic_store(&bench->fraction, fraction);
}

static bool is_stopped(void *self)
{
    struct br_work_bench *bench = self;
    return atomic_load(&bench->stopped);
}

/* Waits for work; false: there will be none. */
static bool wait_for_work(struct br_work_bench *bench)
{
    pthread_mutex_lock(&bench->lock);
    while (bench->state != BR_BENCH_WORKING && bench->state != BR_BENCH_ENDING)
        pthread_cond_wait(&bench->changed, &bench->lock);
    const bool work = bench->state == BR_BENCH_WORKING;
    pthread_mutex_unlock(&bench->lock);
    return work;
}

/* Nobody can have ended it: br_bench_end waits for the work. */
static void set_state(struct br_work_bench *bench, enum br_bench_state state)
{
    pthread_mutex_lock(&bench->lock);
    bench->state = state;
    pthread_cond_broadcast(&bench->changed);
    pthread_mutex_unlock(&bench->lock);
}

static void *work(void *self)
{
    struct br_work_bench *bench = self;
    const struct br_observer observer = {
        .progress = keep_fraction, .stop = is_stopped, .self = bench};
    pthread_setname_np(pthread_self(), "march"); /* tells it from MPI's own threads */
    while (wait_for_work(bench)) {
        br_group_march(bench->studies, bench->units, bench->group, bench->threads, &observer,
                       &bench->parcel, &bench->failure);
        set_state(bench, BR_BENCH_DONE);
    }
    return NULL;
}

enum br_status br_bench_start(struct br_work_bench *bench, struct br_error *err)
{
    sigset_t all, old;
    pthread_condattr_t monotonic;
    bench->state = BR_BENCH_IDLE;
    pthread_mutex_init(&bench->lock, NULL);
    pthread_condattr_init(&monotonic);
    pthread_condattr_setclock(&monotonic, CLOCK_MONOTONIC);
    pthread_cond_init(&bench->changed, &monotonic);
    pthread_condattr_destroy(&monotonic);
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &old); /* signals wake the main thread */
    const int failure = pthread_create(&bench->thread, NULL, work, bench);
    pthread_sigmask(SIG_SETMASK, &old, NULL);
    return failure ? br_no_memory(err, "the thread that marches") : BR_OK;
}

void br_bench_give(struct br_work_bench *bench, size_t group)
{
    bench->group = group;
    bench->failure = (struct br_error){0};
    atomic_store(&bench->fraction, 0);
    set_state(bench, BR_BENCH_WORKING);
}

enum br_bench_state br_bench_wait(struct br_work_bench *bench, double seconds)
{
    struct timespec until;
    clock_gettime(CLOCK_MONOTONIC, &until);
    const long nanoseconds = until.tv_nsec + (long)(seconds * 1e9);
    until.tv_sec += nanoseconds / 1000000000;
    until.tv_nsec = nanoseconds % 1000000000;
    pthread_mutex_lock(&bench->lock);
    int late = 0;
    while (bench->state != BR_BENCH_DONE && !late)
        late = pthread_cond_timedwait(&bench->changed, &bench->lock, &until);
    const enum br_bench_state state = bench->state;
    pthread_mutex_unlock(&bench->lock);
    return state;
}

struct br_parcel br_bench_take(struct br_work_bench *bench)
{
    const struct br_parcel parcel = bench->parcel;
    bench->parcel = (struct br_parcel){0};
    set_state(bench, BR_BENCH_IDLE);
    return parcel;
}

void br_bench_end(struct br_work_bench *bench)
{
    atomic_store(&bench->stopped, true);
    pthread_mutex_lock(&bench->lock);
    while (bench->state == BR_BENCH_WORKING)
        pthread_cond_wait(&bench->changed, &bench->lock);
    bench->state = BR_BENCH_ENDING;
    pthread_cond_broadcast(&bench->changed);
    pthread_mutex_unlock(&bench->lock);
    pthread_join(bench->thread, NULL);
    pthread_mutex_destroy(&bench->lock);
    pthread_cond_destroy(&bench->changed);
    free(bench->parcel.bytes);
    bench->parcel = (struct br_parcel){0};
}
