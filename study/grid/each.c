/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/grid/each.h"

#include <stdatomic.h>
#include <stdint.h>

struct loop {
    const struct br_each *each;
    atomic_bool over;
    /* under the lock */
    double done, all;
    size_t failed; /* the turn */
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
    if (o && o->stop && o->stop(o->self))
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
