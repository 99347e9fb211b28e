/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/grid/each.h"

#include <stdatomic.h>
#include <stdint.h>

/* ---- observers ---- */

bool br_observer_stops(const struct br_observer *o)
{
    return o && o->stop && o->stop(o->self);
}

static void report_share(void *self, double fraction)
{
    const struct br_observer_share *share = self;
    share->whole->progress(share->whole->self, share->from + share->length * fraction);
}

static bool stop_share(void *self)
{
    const struct br_observer_share *share = self;
    return br_observer_stops(share->whole);
}

static void prepare_share(void *self, double most)
{
    const struct br_observer_share *share = self;
    share->whole->preparing(share->whole->self, most);
}

struct br_observer br_observer_of(struct br_observer_share *share)
{
    return (struct br_observer){.progress = share->whole->progress ? report_share : NULL,
                                .stop = stop_share,
                                .self = share,
                                .preparing = share->whole->preparing ? prepare_share : NULL};
}

/* ---- loops ---- */

struct loop {
    const struct br_each *each;
    atomic_bool over;
    /* under the lock */
    double done, all;
    size_t failed; /* the lowest turn that failed */
    struct br_error failure;
};

static double work_of(const struct br_each *e, size_t i)
{
    return e->work ? e->work(e->self, i) : 1;
}

static void take_turn(struct loop *l, size_t i)
{
    const struct br_each *e = l->each;
    const struct br_observer *o = e->observer;
    struct br_error failure = {0};
    if (br_observer_stops(o))
        br_fail(&failure, BR_INTERRUPTED, "interrupted");
    else
        failure.status = e->turn(e->self, i, &failure);
#pragma omp critical(each)
    {
        if (failure.status && i < l->failed) {
            l->failed = i;
            l->failure = failure;
            atomic_store(&l->over, true);
        }
        l->done += work_of(e, i);
        if (o && o->progress)
            o->progress(o->self, l->done / l->all);
    }
}

enum br_status br_each(const struct br_each *each, struct br_error *err)
{
    struct loop l = {.each = each, .failed = SIZE_MAX};
    const int threads = br_threads(each->threads);
    (void)threads; /* without OpenMP */
    for (size_t i = 0; i < each->count; i++)
        l.all += work_of(each, i);
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads)
    for (size_t i = 0; i < each->count; i++)
        if (!atomic_load(&l.over))
            take_turn(&l, i);
    if (l.failed == SIZE_MAX)
        return BR_OK;
    return br_fail(err, l.failure.status, "%s", l.failure.message);
}
