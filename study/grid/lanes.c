/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which thread does which batch. No result depends on it. */
#include "base/each.h"
#include "study/grid/study_march.h"

/* The studies of a call, and their progress. */
struct lanes_work {
    struct br_study_march *step;
    size_t count;
    pthread_mutex_t lock; /* of all lanes */
    pthread_cond_t done;  /* a lane has done a batch */
    atomic_size_t finished_batches;
    size_t all_batches;
    const struct br_observer *observer;
};

static void report_progress(struct lanes_work *work, struct br_study_march *l)
{
    if (atomic_load(&l->stopped) || atomic_load(&l->first_failed) <= l->level_count)
        return;
    const size_t done = atomic_fetch_add(&work->finished_batches, 1) + 1;
    if (work->observer && work->observer->progress)
        work->observer->progress(work->observer->self, (double)done / (double)work->all_batches);
}

/* The batches that are to be done: after a failure those up to it, so that it is the first one. */
static size_t last_batch(struct br_study_march *l)
{
    const size_t failed = atomic_load(&l->first_failed);
    if (atomic_load(&l->stopped))
        return 0;
    return failed / l->batch < l->batches ? failed / l->batch + 1 : l->batches;
}

/* Whether a lane's next batch has what it reads, and a buffer that nobody reads any more. */
static bool is_ready(const struct br_study_march *l, size_t lane)
{
    const size_t b = l->lane[lane].done;
    if (l->lane[lane].busy || (lane > BR_LANE_AXIAL && b == l->lane[BR_LANE_AXIAL].done))
        return false;
    if (lane > BR_LANE_BENDING)
        return b < l->lane[BR_LANE_BENDING].done;
    for (size_t reader = lane + 1; reader < BR_LANE_CELLS + l->tasks; reader++)
        if (b == l->lane[reader].done + BR_STUDY_MARCH_BUFFERS)
            return false;
    return true;
}

/* Chooses the ready lane with the earliest batch: *l and *lane (out). Returns whether anything is
 * left to do; *l is NULL if others do it, or have to end before it can begin. */
static bool choose_lane(const struct lanes_work *work, struct br_study_march **l, size_t *lane)
{
    bool left = false;
    *l = NULL;
    for (struct br_study_march *s = work->step; s < work->step + work->count; s++) {
        const size_t end = s->batches ? last_batch(s) : 0;
        for (size_t i = 0; i < BR_LANE_CELLS + s->tasks && end; i++) {
            if (s->lane[i].done >= end)
                continue;
            left = true;
            if (is_ready(s, i) && (!*l || s->lane[i].done < (*l)->lane[*lane].done)) {
                *l = s;
                *lane = i;
            }
        }
    }
    return left;
}

static void do_batch(struct lanes_work *work, struct br_study_march *l, size_t lane, size_t b)
{
    if (lane <= BR_LANE_BENDING)
        br_reference_batch(l, lane == BR_LANE_AXIAL ? BR_AXIAL : BR_BENDING, b);
    if (lane == BR_LANE_BENDING)
        report_progress(work, l);
    if (lane == BR_LANE_SUMS)
        br_sums_batch(l, b);
    if (lane >= BR_LANE_CELLS)
        br_cells_batch(l, b, lane - BR_LANE_CELLS);
}

/* What each thread does. */
static void do_batches(void *self)
{
    struct lanes_work *work = self;
    struct br_study_march *l;
    size_t i = 0;
    pthread_mutex_lock(&work->lock);
    while (choose_lane(work, &l, &i)) {
        if (!l) {
            pthread_cond_wait(&work->done, &work->lock);
            continue;
        }
        struct br_lane *lane = &l->lane[i];
        lane->busy = true;
        pthread_mutex_unlock(&work->lock);
        do_batch(work, l, i, lane->done);
        pthread_mutex_lock(&work->lock);
        lane->busy = false;
        lane->done++;
        pthread_cond_broadcast(&work->done);
    }
    pthread_mutex_unlock(&work->lock);
}

void br_lanes_run(struct br_study_march *step, size_t count, int threads,
                  const struct br_observer *observer)
{
    struct lanes_work work = {.step = step,
                              .count = count,
                              .lock = PTHREAD_MUTEX_INITIALIZER,
                              .done = PTHREAD_COND_INITIALIZER,
                              .observer = observer};
    size_t lanes = 0;
    for (const struct br_study_march *l = step; l < step + count; l++) {
        work.all_batches += l->batches;
        lanes += BR_LANE_CELLS + l->tasks;
    }
    threads = br_threads(threads);
    br_team(lanes < (size_t)threads ? (int)lanes : threads, do_batches, &work);
}
