/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/each.h"

#include <locale.h>
#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <stdint.h>
#include <unistd.h>

/* ---- observers ---- */

bool br_observer_stops(const struct br_observer *o)
{
    return o && o->stop && o->stop(o->self);
}

enum br_status br_observer_check(const struct br_observer *o, struct br_error *err)
{
    return br_observer_stops(o) ? br_fail(err, BR_INTERRUPTED, "interrupted") : BR_OK;
}

static bool (*must_stop)(void);

void br_stop_when(bool (*stop)(void))
{
    must_stop = stop;
}

bool br_must_stop(void)
{
    return must_stop && must_stop();
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

static void warn_of_share(void *self, const char *what)
{
    const struct br_observer_share *share = self;
    share->whole->warn(share->whole->self, what);
}

struct br_observer br_observer_of(struct br_observer_share *share)
{
    const struct br_observer none = {0}, *whole = share->whole ? share->whole : &none;
    return (struct br_observer){.progress = whole->progress ? report_share : NULL,
                                .stop = stop_share,
                                .self = share,
                                .preparing = whole->preparing ? prepare_share : NULL,
                                .warn = whole->warn ? warn_of_share : NULL};
}

/* ---- threads ---- */

struct team {
    void (*work)(void *self);
    void *self;
    locale_t locale; /* of the caller: messages are the same from all threads */
};

/* Memory that the C library allocates when a thread begins, not later, when it would end the
 * process if there were none. */
static _Thread_local __attribute__((tls_model("initial-exec"))) bool in_a_team;

int br_threads(int wanted)
{
    cpu_set_t cores;
    if (wanted <= 0)
        wanted = sched_getaffinity(0, sizeof cores, &cores) == 0
                     ? CPU_COUNT(&cores)
                     : (int)sysconf(_SC_NPROCESSORS_ONLN);
    return wanted < 1 ? 1 : wanted > BR_MOST_THREADS ? BR_MOST_THREADS : wanted;
}

static void *join_team(void *self)
{
    const struct team *t = self;
    in_a_team = true;
    uselocale(t->locale);
    t->work(t->self);
    return NULL;
}

void br_team(int threads, void (*work)(void *self), void *self)
{
    const bool alone = in_a_team;
    const int others = alone ? 0 : threads - 1;
    struct team team = {work, self, uselocale((locale_t)0)};
    pthread_t thread[BR_MOST_THREADS];
    int count = 0;
    while (count < others && pthread_create(&thread[count], NULL, join_team, &team) == 0)
        count++;
    in_a_team = true;
    work(self);
    in_a_team = alone;
    while (count > 0)
        pthread_join(thread[--count], NULL);
}

/* ---- loops ---- */

struct loop {
    const struct br_each *each;
    atomic_size_t next; /* turn that nobody has begun */
    atomic_bool over;
    pthread_mutex_t lock;
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
    if (!br_observer_check(o, &failure))
        failure.status = e->turn(e->self, i, &failure);
    pthread_mutex_lock(&l->lock);
    if (failure.status && i < l->failed) {
        l->failed = i;
        l->failure = failure;
        atomic_store(&l->over, true);
    }
    l->done += work_of(e, i);
    if (o && o->progress)
        o->progress(o->self, l->done / l->all);
    pthread_mutex_unlock(&l->lock);
}

static void take_turns(void *self)
{
    struct loop *l = self;
    size_t i;
    while (!atomic_load(&l->over) && (i = atomic_fetch_add(&l->next, 1)) < l->each->count)
        take_turn(l, i);
}

enum br_status br_each(const struct br_each *each, struct br_error *err)
{
    struct loop l = {.each = each, .lock = PTHREAD_MUTEX_INITIALIZER, .failed = SIZE_MAX};
    const int threads = br_threads(each->threads);
    for (size_t i = 0; i < each->count; i++)
        l.all += work_of(each, i);
    br_team(each->count < (size_t)threads ? (int)each->count : threads, take_turns, &l);
    if (l.failed == SIZE_MAX)
        return BR_OK;
    return br_fail(err, l.failure.status, "%s", l.failure.message);
}
