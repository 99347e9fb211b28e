/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Ranks by MPI. No rank hands out work: each takes the number of its next batch from a counter that
 * they share, and when there is none left, all gather the results of all. No bit of the results
 * depends on which rank marches what.
 *
 * The counter is in a window of integers in the memory of rank 0, which the others access by
 * one-sided operations. There, too, each rank counts its heartbeats and writes how much it has
 * done; a rank without heartbeats is taken for dead. A failure is a mark in the window that ends
 * the marches; then all ranks exchange reports and learn of it.
 *
 * Only the main thread calls MPI: another thread marches. The main thread never waits within MPI,
 * where a dead rank could block it: it tests whether an operation is done, and watches the others.
 */
#include <errno.h>
#include <limits.h>
#include <math.h>
#include <mpi.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdint.h>
#include <string.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/quote.h"
#include "base/text.h"
#include "study/grid/batches.h"
#include "study/grid/sweep.h"
#include "study/ranks/ranks.h"

static const double beat_every = 0.25;    /* s */
static const double default_timeout = 60; /* s without a heartbeat; $BEAMRATE_SILENCE replaces it */
static const double longest_gap = 0.05;   /* s between two watches of a process that runs */

/* The window: the number of the next batch, a mark of failure, and two numbers of each rank. */
enum { NEXT_BATCH, FAILED, OF_RANKS };
enum { BEATS, DONE, NUMBERS }; /* DONE: work since the start, ns */

/* What a rank reports to all. */
struct report {
    struct br_error failure;  /* status BR_OK: none */
    unsigned long long asked; /* the fingerprint of a call's studies */
    size_t bytes;             /* of its results */
    bool ends;                /* its program ends */
};

static struct {
    int rank, size, threads, most_threads;
    bool joined; /* all below is set */
    MPI_Comm comm;
    MPI_Win window;
    struct br_store store; /* of the arrays below */
    struct report *report; /* of each rank, at the last exchange */
    int *bytes, *offset;   /* of each rank's results */

    int64_t *snapshot;      /* the window as it was read last */
    int64_t mine[NUMBERS];  /* this rank's numbers as they are written */
    MPI_Request request[3]; /* of sending, of reading, and of the mark */
    bool sending, marked;   /* whether those have begun */
    int64_t *known_beats;   /* of each rank */
    double *since_beat;     /* of each rank, s since the last heartbeat */
    double watched, beat;   /* times of the last watch and heartbeat, s */

    const struct br_observer *observer; /* of the call; may be NULL */
    double before, total;               /* the job's work before this call, and of it, ns */
    double done;                        /* by this rank since the start, ns */
    size_t drawn_before;                /* drawn in the calls before */
    bool waits;                         /* for rank 0's end, however long it takes */
    bool interrupted;                   /* this rank was asked to stop */
    bool fails;                         /* this rank has failed, or was asked to stop */
    bool failed;                        /* some rank has failed */
    bool lost;                          /* some rank is not heard from any more */
    bool over;                          /* all know that the job has come to its end */
} job = {.size = 1};

int br_ranks_size(void)
{
    return job.size;
}

bool br_ranks_first(void)
{
    return job.rank == 0;
}

/* ---- the window ---- */

/* The pause of the main thread between two watches. */
static void pause_briefly(void)
{
    nanosleep(&(struct timespec){.tv_nsec = 1000000}, NULL);
}

static double beat_timeout(void)
{
    const char *text = getenv("BEAMRATE_SILENCE");
    const double given = text ? atof(text) : 0;
    return given > 0 ? given : default_timeout;
}

/* How many ranks this one watches, from 0 on: rank 0 watches all, the others watch rank 0. */
static int ranks_watched(void)
{
    return job.rank == 0 ? job.size : 1;
}

static int number_of(int rank, int number)
{
    return OF_RANKS + rank * NUMBERS + number;
}

/* Starts to send a heartbeat and to read the window. Neither is done when this returns. */
static void send_heartbeat(void)
{
    const int words = number_of(ranks_watched(), 0);
    job.mine[BEATS]++;
    job.mine[DONE] = (int64_t)job.done;
    job.sending = true;
    MPI_Raccumulate(job.mine, NUMBERS, MPI_INT64_T, 0, number_of(job.rank, 0), NUMBERS, MPI_INT64_T,
                    MPI_REPLACE, job.window, &job.request[0]);
    MPI_Rget_accumulate(NULL, 0, MPI_INT64_T, job.snapshot, words, MPI_INT64_T, 0, 0, words,
                        MPI_INT64_T, MPI_NO_OP, job.window, &job.request[1]);
}

/* Marks a failure, so that all ranks end their marches. */
static void mark_failed(void)
{
    static const int64_t one = 1;
    job.marked = true;
    MPI_Raccumulate(&one, 1, MPI_INT64_T, 0, FAILED, 1, MPI_INT64_T, MPI_REPLACE, job.window,
                    &job.request[2]);
}

static void read_window(void)
{
    double done = 0;
    job.sending = false;
    job.failed |= job.snapshot[FAILED] != 0;
    for (int r = 0; r < ranks_watched(); r++) {
        const int64_t beats = job.snapshot[number_of(r, BEATS)];
        if (beats != job.known_beats[r])
            job.since_beat[r] = 0;
        job.known_beats[r] = beats;
        done += (double)job.snapshot[number_of(r, DONE)];
    }
    const struct br_observer *o = job.observer;
    if (job.rank == 0 && o && o->progress && job.total > 0)
        o->progress(o->self, fmax(0, done - job.before) / job.total);
}

/* To be called again and again: sends heartbeats, reads the window, and checks whether to stop.
 * Fails with BR_IO where a rank has sent no heartbeat for too long. Only the time in which this
 * process was running counts, so that a suspended job can go on. */
static enum br_status watch(struct br_error *err)
{
    const double now = br_seconds(), passed = fmin(now - job.watched, longest_gap);
    enum br_status status = BR_OK;
    int flag, idle;
    job.watched = now;
    /* lets MPI serve the others */
    MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, job.comm, &flag, MPI_STATUS_IGNORE);
    MPI_Testall(3, job.request, &idle, MPI_STATUSES_IGNORE);
    if (idle && job.sending)
        read_window();
    if (idle && now - job.beat >= beat_every) {
        job.beat = now;
        send_heartbeat();
    }
    job.interrupted |= br_observer_stops(job.observer);
    if ((job.interrupted || job.fails) && !job.marked)
        mark_failed();
    for (int r = 0; r < ranks_watched() && !job.waits && !status; r++) {
        job.since_beat[r] += passed;
        if (r != job.rank && job.since_beat[r] >= beat_timeout())
            status = br_fail(err, BR_IO, "rank %d has not been heard from for %g s: is it gone?", r,
                             job.since_beat[r]);
    }
    job.lost |= status != BR_OK;
    job.fails |= job.lost;
    return status;
}

/* Restarts all timeouts after a time without watching. */
static void start_watching(void)
{
    job.watched = br_seconds();
    for (int r = 0; r < job.size; r++)
        job.since_beat[r] = 0;
}

/* Waits until an operation is done; fails as watch does. */
static enum br_status await(MPI_Request *request, struct br_error *err)
{
    enum br_status status = BR_OK;
    int done = 0;
    MPI_Test(request, &done, MPI_STATUS_IGNORE);
    while (!done && !status) {
        pause_briefly();
        status = watch(err);
        MPI_Test(request, &done, MPI_STATUS_IGNORE);
    }
    return status;
}

/* Takes the number of a batch that no other rank gets: as MPI_Fetch_and_op, but this rank can watch
 * while it waits. */
static enum br_status draw_batch(size_t *batch, struct br_error *err)
{
    static const int64_t one = 1;
    static int64_t drawn; /* outlives an operation that is not done when a rank is lost */
    MPI_Request request;
    MPI_Rget_accumulate(&one, 1, MPI_INT64_T, &drawn, 1, MPI_INT64_T, 0, NEXT_BATCH, 1, MPI_INT64_T,
                        MPI_SUM, job.window, &request);
    const enum br_status status = await(&request, err);
    *batch = (size_t)drawn - job.drawn_before;
    return status;
}

/* ---- reports ---- */

/* Fails where a report has a failure, a program that ends early, or other studies. */
static enum br_status check_reports(struct br_error *err)
{
    const struct report *first = &job.report[0], *own = &job.report[job.rank];
    for (int r = 0; r < job.size; r++)
        if (job.report[r].failure.status)
            return r == job.rank ? br_fail(err, own->failure.status, "%s", own->failure.message)
                                 : br_fail(err, job.report[r].failure.status, "rank %d: %.900s", r,
                                           job.report[r].failure.message);
    for (int r = 0; r < job.size; r++)
        if (job.report[r].ends != own->ends)
            return br_fail(err, BR_IO, "rank %d ended too early", own->ends ? job.rank : r);
    for (int r = 0; r < job.size; r++)
        if (job.report[r].asked != first->asked)
            return br_fail(err, BR_BAD_INPUT,
                           "rank %d was asked for other studies than rank 0: all must see the same "
                           "scenes, options and program",
                           r);
    return BR_OK;
}

/* Exchanges the reports of all ranks. Fails on all ranks if one has failed; then the job is
 * over. */
static enum br_status exchange_reports(struct report report, struct br_error *err)
{
    MPI_Request request;
    if (!report.failure.status && !report.ends && job.interrupted)
        br_fail(&report.failure, BR_INTERRUPTED, "interrupted");
    MPI_Iallgather(&report, sizeof report, MPI_BYTE, job.report, sizeof report, MPI_BYTE, job.comm,
                   &request);
    enum br_status status = await(&request, err);
    if (status)
        return status;
    status = check_reports(err);
    job.over = status || report.ends;
    return status;
}

/* ---- a call ---- */

struct call {
    struct br_study *studies;
    size_t count;
    struct br_batches batches;
    int threads;
    struct report report; /* of this rank */
    FILE *results;        /* into its own bytes */
    char *own, *all;      /* of all ranks, one after the other */
    size_t size;          /* of these */

    /* the batch that another thread marches */
    size_t batch;
    atomic_bool stopped;
    _Atomic double fraction;
    struct br_error failure;
};

static void keep_fraction(void *self, double fraction)
{
    struct call *c = self;
    atomic_store(&c->fraction, fraction);
}

static bool is_stopped(void *self)
{
    struct call *c = self;
    return atomic_load(&c->stopped);
}

static void *march(void *self)
{
    struct call *c = self;
    const struct br_observer observer = {.progress = keep_fraction, .stop = is_stopped, .self = c};
    pthread_setname_np(pthread_self(), "march"); /* distinguishes it from MPI's threads */
    br_batch_march(c->studies, c->count, &c->batches, c->batch, c->threads, &observer, c->results,
                   &c->failure);
    return NULL;
}

/* Marches a batch by another thread while the main thread watches and gets the signals. A failure
 * of other ranks is not a failure of this one. */
static enum br_status march_batch(struct call *c, size_t batch, struct br_error *err)
{
    const double before = job.done, cost = c->batches.cost[batch];
    enum br_status status = BR_OK;
    pthread_t thread;
    sigset_t all, old;
    c->batch = batch;
    atomic_store(&c->fraction, 0);
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &old);
    const int failure = pthread_create(&thread, NULL, march, c);
    pthread_sigmask(SIG_SETMASK, &old, NULL);
    if (failure)
        return br_no_memory(err, "the thread that marches");
    while (pthread_tryjoin_np(thread, NULL) == EBUSY) {
        /* after a failure, too: the others must not take this rank for dead meanwhile */
        const enum br_status now = watch(status ? NULL : err);
        status = status ? status : now;
        if (status || job.interrupted || job.failed)
            atomic_store(&c->stopped, true);
        job.done = before + cost * atomic_load(&c->fraction);
        pause_briefly();
    }
    job.done = before + cost;
    if (!status && c->failure.status && !(job.failed && c->failure.status == BR_INTERRUPTED))
        status = br_fail(err, c->failure.status, "%s", c->failure.message);
    return status;
}

static enum br_status march_all(struct call *c, struct br_error *err)
{
    size_t batch = 0;
    enum br_status status = draw_batch(&batch, err);
    while (!status && batch < c->batches.count && !job.interrupted && !job.failed) {
        status = march_batch(c, batch, err);
        if (!status)
            status = draw_batch(&batch, err);
    }
    return status;
}

/* Gathers the results of all ranks. */
static enum br_status gather(struct call *c, struct br_error *err)
{
    MPI_Request request;
    enum br_status status = exchange_reports(c->report, err);
    if (status)
        return status;
    for (int r = 0; r < job.size; c->size += job.report[r++].bytes) {
        if (job.report[r].bytes > INT_MAX - c->size)
            return br_fail(err, BR_IO, "the results of all ranks are beyond 2 GiB");
        job.bytes[r] = (int)job.report[r].bytes;
        job.offset[r] = (int)c->size;
    }
    if (!(c->all = br_allocate(c->size + 1, 1)))
        br_no_memory(&c->report.failure, "the results");
    status = exchange_reports(c->report, err);
    if (status)
        return status;
    MPI_Iallgatherv(c->own, (int)c->report.bytes, MPI_BYTE, c->all, job.bytes, job.offset, MPI_BYTE,
                    job.comm, &request);
    return await(&request, err);
}

/* Marches batches, then gathers all results. A failure of this rank goes into its report. */
static enum br_status share(struct call *c, struct br_error *err)
{
    struct br_error *failure = &c->report.failure;
    c->results = br_text_open(&c->own, &c->report.bytes);
    enum br_status status = exchange_reports(c->report, err);
    if (!status && c->results)
        march_all(c, failure);
    if ((!c->results || fclose(c->results) != 0) && !failure->status)
        br_no_memory(failure, "the results");
    job.fails |= failure->status != BR_OK;
    if (!status && job.lost)
        status = br_fail(err, failure->status, "%s", failure->message);
    if (!status)
        status = gather(c, err);
    if (!status)
        status = br_batches_read(c->studies, c->count, &c->batches, c->all, c->size, err);
    if (!job.lost) { /* else MPI may still be using them */
        free(c->own);
        free(c->all);
    }
    return status;
}

static enum br_status march_together(struct br_study *studies, size_t count, int threads,
                                     const struct br_observer *observer, struct br_error *err)
{
    struct call c = {.studies = studies, .count = count};
    const int each = threads > 0 ? threads : job.most_threads;
    if (job.over)
        return br_fail(err, BR_IO, "the ranks share no work after a failure");
    c.threads = threads > 0 ? threads : job.threads;
    br_batches_create(&c.batches, studies, count, job.size, each, &c.report.failure);
    c.report.asked = br_studies_fingerprint(studies, count) + (unsigned)each;
    job.observer = observer;
    job.total = 0;
    for (size_t i = 0; i < c.batches.count; i++)
        job.total += c.batches.cost[i];
    start_watching();
    const enum br_status status = share(&c, err);
    job.observer = NULL;
    job.before += job.total;
    job.drawn_before += c.batches.count + (size_t)job.size; /* each rank has drawn one too many */
    br_batches_clear(&c.batches);
    if (!status && observer && observer->progress && job.rank == 0)
        observer->progress(observer->self, 1);
    return status;
}

/* ---- beginning and end ---- */

/* Prints why, and ends all ranks. Only ranks 0 and 1 call MPI_Abort: mpirun was seen to crash when
 * several ranks did. That soon ends the other ranks; where the launcher was told to carry on, they
 * end by themselves. */
_Noreturn static void abort_job(const char *why)
{
    br_print(stderr, &br_for_text, "beamrate: rank %d of %d: %s\n", job.rank, job.size, why);
    fflush(NULL);
    if (job.rank <= 1)
        MPI_Abort(MPI_COMM_WORLD, br_status_exit_code(BR_IO));
    else
        sleep(5);
    _Exit(br_status_exit_code(BR_IO));
}

/* Handles an error of any MPI function. */
static void abort_on_error(int code)
{
    char text[MPI_MAX_ERROR_STRING + 8] = "MPI: ";
    int length;
    MPI_Error_string(code, text + strlen(text), &length);
    abort_job(text);
}

static void abort_on_rank_error(MPI_Comm *comm, int *code, ...)
{
    (void)comm;
    abort_on_error(*code);
}

static void abort_on_window_error(MPI_Win *window, int *code, ...)
{
    (void)window;
    abort_on_error(*code);
}

/* The cores that this rank may use, shared with the ranks of its machine that may use the same. */
static enum br_status count_threads(struct br_error *err)
{
    MPI_Comm machine;
    cpu_set_t mine;
    int here, users = 0;
    CPU_ZERO(&mine);
    if (sched_getaffinity(0, sizeof mine, &mine) < 0)
        CPU_SET(0, &mine);
    MPI_Comm_split_type(job.comm, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
    MPI_Comm_size(machine, &here);
    cpu_set_t *mask = br_allocate((size_t)here, sizeof *mask);
    if (!mask)
        return br_no_memory(err, "the ranks");
    MPI_Allgather(&mine, sizeof mine, MPI_BYTE, mask, sizeof mine, MPI_BYTE, machine);
    for (int r = 0; r < here; r++)
        users += CPU_EQUAL(&mask[r], &mine) != 0;
    free(mask);
    MPI_Comm_free(&machine);
    job.threads = CPU_COUNT(&mine) > users ? CPU_COUNT(&mine) / users : 1;
    MPI_Allreduce(&job.threads, &job.most_threads, 1, MPI_INT, MPI_MAX, job.comm);
    return BR_OK;
}

static enum br_status create_window(struct br_error *err)
{
    const size_t ranks = (size_t)job.size, words = (size_t)number_of(job.size, 0);
    job.report = br_store_take(&job.store, ranks, sizeof *job.report);
    job.bytes = br_store_take(&job.store, ranks, sizeof *job.bytes);
    job.offset = br_store_take(&job.store, ranks, sizeof *job.offset);
    job.snapshot = br_store_take(&job.store, words, sizeof *job.snapshot);
    job.known_beats = br_store_take(&job.store, ranks, sizeof *job.known_beats);
    job.since_beat = br_store_take(&job.store, ranks, sizeof *job.since_beat);
    if (job.store.failed)
        return br_no_memory(err, "the ranks");
    MPI_Errhandler handler;
    const MPI_Aint size = job.rank == 0 ? (MPI_Aint)(words * sizeof *job.snapshot) : 0;
    int64_t *memory;
    job.request[0] = job.request[1] = job.request[2] = MPI_REQUEST_NULL;
    MPI_Win_allocate(size, sizeof *memory, MPI_INFO_NULL, job.comm, &memory, &job.window);
    MPI_Win_create_errhandler(abort_on_window_error, &handler);
    MPI_Win_set_errhandler(job.window, handler);
    MPI_Errhandler_free(&handler);
    if (job.rank == 0)
        memset(memory, 0, (size_t)size);
    MPI_Barrier(job.comm);
    MPI_Win_lock_all(MPI_MODE_NOCHECK, job.window);
    job.joined = true;
    return BR_OK;
}

static enum br_status join(const struct br_launch *launch, struct br_error *err)
{
    int provided, found;
    MPI_Errhandler handler;
    MPI_Init_thread(NULL, NULL, MPI_THREAD_FUNNELED, &provided);
    MPI_Comm_size(MPI_COMM_WORLD, &found);
    job.rank = launch->rank; /* so that only one of them prints why they end */
    if (provided < MPI_THREAD_FUNNELED)
        return br_fail(err, BR_UNSUPPORTED, "this MPI library allows no threads beside it");
    if (found != launch->size)
        return br_fail(err, BR_BAD_INPUT,
                       "started by %s as one of %d processes, but the MPI library of this build "
                       "knows of %d: start it with the mpirun of that library, or with srun "
                       "--mpi=pmix",
                       launch->launcher, launch->size, found);
    job.size = found;
    MPI_Comm_rank(MPI_COMM_WORLD, &job.rank);
    MPI_Comm_create_errhandler(abort_on_rank_error, &handler);
    MPI_Comm_set_errhandler(MPI_COMM_WORLD, handler);
    MPI_Errhandler_free(&handler);
    MPI_Comm_dup(MPI_COMM_WORLD, &job.comm); /* of this program's own, with the same handler */
    enum br_status status = count_threads(err);
    if (!status && !(status = create_window(err)))
        br_engine_set(march_together);
    return status;
}

enum br_status br_ranks_start(struct br_error *err)
{
    const struct br_launch launch = br_launch_read();
    return launch.size == 1 ? BR_OK : join(&launch, err);
}

static void leave(void)
{
    int begun = 0;
    MPI_Initialized(&begun);
    if (job.joined) {
        MPI_Waitall(3, job.request, MPI_STATUSES_IGNORE);
        MPI_Win_unlock_all(job.window);
        MPI_Win_free(&job.window);
        MPI_Comm_free(&job.comm);
    }
    if (begun)
        MPI_Finalize();
    br_store_clear(&job.store);
}

enum br_status br_ranks_end(enum br_status status, struct br_error *err)
{
    if (job.size > 1) {
        struct report report = {.ends = true};
        if (status)
            br_fail(&report.failure, status, "%s", err->message);
        if (!job.joined || job.lost)
            abort_job(err->message);
        job.waits = job.rank > 0; /* rank 0 may be writing for long */
        start_watching();
        if (!job.over)
            status = exchange_reports(report, err);
        if (job.lost)
            abort_job(err->message);
    }
    leave();
    return br_ranks_first() ? status : BR_OK;
}
