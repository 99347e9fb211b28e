/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/extremes/map.h"

#include <errno.h>
#include <math.h>
#include <string.h>

#include "study/extremes/kept.h"
#include "study/extremes/shrink.h"
#include "study/grid/observer.h"
#include "study/grid/threads.h"

struct work {
    const struct br_extreme_wish *wish;
    struct br_extreme_map *map;
    bool *done;
    FILE *kept;
    size_t finished; /* cases, under the lock */
    struct br_error failure;
};

static enum br_status judge(const struct br_extreme_wish *w, const struct br_extreme_case *one,
                            struct br_extreme_verdict *verdict, struct br_error *err)
{
    return (w->judge ? w->judge : br_extreme_judge)(one, &w->court, verdict, err);
}

/* ---- cases ---- */

static bool asked_to_stop(const struct br_extreme_wish *w)
{
    return w->observer && w->observer->stop && w->observer->stop(w->observer->self);
}

static bool given_up(struct work *work)
{
    bool failed;
#pragma omp critical(extreme_map)
    {
        if (!work->failure.status && asked_to_stop(work->wish))
            br_fail(&work->failure, BR_INTERRUPTED, "interrupted");
        failed = work->failure.status != BR_OK;
    }
    return failed;
}

/* Under the lock. */
static void take(struct work *work, size_t i, enum br_status status, const struct br_error *said)
{
    const struct br_observer *observer = work->wish->observer;
    struct br_error err = *said;
    if (!status) {
        work->done[i] = true;
        status = br_kept_add(work->kept, i, &work->map->verdict[i], &err);
    }
    if (status && !work->failure.status)
        work->failure = err;
    work->finished++;
    if (observer && observer->progress)
        observer->progress(observer->self, (double)work->finished / (double)work->map->cases);
}

static void do_case(struct work *work, size_t i)
{
    struct br_error said = {0};
    struct br_extreme_map *m = work->map;
    enum br_status status = BR_OK;
    if (given_up(work))
        return;
    br_extreme_draw(m->seed, i, &m->one[i]);
    if (work->done[i])
        return;
    status = judge(work->wish, &m->one[i], &m->verdict[i], &said);
#pragma omp critical(extreme_map)
    take(work, i, status, &said);
}

static enum br_status do_cases(struct work *work, struct br_error *err)
{
    const int threads = br_threads(work->wish->threads);
    (void)threads; /* without OpenMP */
    for (size_t i = 0; i < work->map->cases; i++)
        work->finished += work->done[i];
    work->map->resumed = work->finished;
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads)
    for (size_t i = 0; i < work->map->cases; i++)
        do_case(work, i);
    if (!work->failure.status)
        return BR_OK;
    return br_fail(err, work->failure.status, "%.1000s", work->failure.message);
}

/* ---- those that are wrong ---- */

static enum br_status ask(void *self, const struct br_extreme_case *one, bool *still,
                          struct br_error *err)
{
    const struct br_extreme_wish *w = self;
    struct br_extreme_verdict verdict;
    if (asked_to_stop(w))
        return br_fail(err, BR_INTERRUPTED, "interrupted");
    const enum br_status status = judge(w, one, &verdict, err);
    *still = !status && verdict.which == BR_EXTREME_WRONG;
    return status;
}

enum { MOST_QUESTIONS = 300 };

static enum br_status write_scene(const struct br_extreme_wish *w, struct br_extreme_shrunk *s,
                                  struct br_error *err)
{
    char text[BR_EXTREME_TEXT], path[4096];
    snprintf(s->file, sizeof s->file, "wrong-%zu.yaml", s->one.index);
    br_extreme_command(&s->one, s->file, s->command);
    if (!w->folder)
        return BR_OK;
    snprintf(path, sizeof path, "%s/%s", w->folder, s->file);
    br_extreme_scene(&s->one, text);
    FILE *file = fopen(path, "w");
    if (!file)
        return br_fail(err, BR_IO, "%.900s: %s", path, strerror(errno));
    fprintf(file, "# Silently wrong: %s\n%s", s->verdict.why, text);
    const bool failed = ferror(file) != 0;
    return fclose(file) == 0 && !failed ? BR_OK
                                        : br_fail(err, BR_IO, "%.900s: %s", path, strerror(errno));
}

static enum br_status shrink(const struct br_extreme_wish *w, struct br_extreme_shrunk *s,
                             struct br_error *err)
{
    const struct br_shrink_question question = {ask, (void *)w, MOST_QUESTIONS};
    enum br_status status = br_shrink(&s->one, &question, err);
    if (!status)
        status = judge(w, &s->one, &s->verdict, err);
    return status ? status : write_scene(w, s, err);
}

static enum br_status shrink_all(struct work *work, struct br_error *err)
{
    struct br_extreme_map *m = work->map;
    const int threads = br_threads(work->wish->threads);
    (void)threads; /* without OpenMP */
    for (size_t i = 0; i < m->cases && m->shrunks < BR_EXTREME_MOST_SHRUNK; i++)
        if (m->verdict[i].which == BR_EXTREME_WRONG)
            m->shrunk[m->shrunks++] =
                (struct br_extreme_shrunk){.one = m->one[i], .verdict = m->verdict[i]};
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads)
    for (size_t i = 0; i < m->shrunks; i++) {
        struct br_error said = {0};
        if (!given_up(work) && shrink(work->wish, &m->shrunk[i], &said)) {
#pragma omp critical(extreme_map)
            work->failure = said;
        }
    }
    if (!work->failure.status)
        return BR_OK;
    return br_fail(err, work->failure.status, "%.1000s", work->failure.message);
}

/* ---- all ---- */

static enum br_status run(struct work *work, struct br_error *err)
{
    struct br_extreme_map *m = work->map;
    enum br_status status = br_kept_open(work->wish, m->verdict, work->done, &work->kept, err);
    if (!status)
        status = do_cases(work, err);
    if (work->kept)
        fclose(work->kept);
    if (status)
        return status;
    for (size_t i = 0; i < m->cases; i++)
        m->count[m->verdict[i].which]++;
    return shrink_all(work, err);
}

enum br_status br_extreme_map_run(const struct br_extreme_wish *wish, struct br_extreme_map *map,
                                  struct br_error *err)
{
    *map = (struct br_extreme_map){.seed = wish->seed, .cases = wish->cases};
    struct work work = {.wish = wish, .map = map};
    map->one = br_allocate(wish->cases, sizeof *map->one);
    map->verdict = br_allocate(wish->cases, sizeof *map->verdict);
    map->shrunk = br_allocate(BR_EXTREME_MOST_SHRUNK, sizeof *map->shrunk);
    work.done = br_allocate(wish->cases, sizeof *work.done);
    enum br_status status = BR_OK;
    if (!map->one || !map->verdict || !map->shrunk || !work.done)
        status = br_no_memory(err, "the map");
    else
        status = run(&work, err);
    free(work.done);
    return status;
}

void br_extreme_map_clear(struct br_extreme_map *map)
{
    free(map->one);
    free(map->verdict);
    free(map->shrunk);
    *map = (struct br_extreme_map){0};
}
