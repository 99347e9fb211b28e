/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Ranks by MPI. Nobody hands out work: each rank draws the number of its next batch from a counter
 * that they share, and when there is none left, all gather the results of all. Which rank marches
 * what does not matter to any bit.
 *
 * The counter stands on a board of whole numbers in the memory of rank 0, which the others reach by
 * one-sided operations. There, too, each rank counts on while it is there, and says how much it has
 * done; who has stopped counting is taken for dead. A failure is a mark on the board that ends the
 * marches; then all meet and learn of it.
 *
 * Only the main thread calls MPI: another one marches. The main thread never waits within MPI,
 * where a dead rank could keep it: it asks whether an operation is done, and watches the others. */
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

#include "solver/clock.h"
#include "study/grid/sweep.h"
#include "study/ranks/batches.h"
#include "study/ranks/ranks.h"
#include "study/scene/quote.h"

static const double beat_every = 0.25;    /* s */
static const double longest_silence = 60; /* s; $BEAMRATE_SILENCE instead */
static const double longest_look = 0.05;  /* s: longer between two looks, and it was not running */

/* The board: a counter, a mark, and two numbers of each rank. */
enum { TICKET, FAILED, OF_RANKS };
enum { BEATS, DONE, NUMBERS }; /* DONE: work since the start, ns */

/* What a rank says where all meet. */
struct word {
    struct br_error failure;  /* status BR_OK: none */
    unsigned long long asked; /* the fingerprint of a call's studies */
    size_t bytes;             /* of its results */
    bool ends;                /* its program does */
};

static struct {
    int rank, size, threads, most_threads;
    bool joined; /* all below is there */
    MPI_Comm comm;
    MPI_Win board;
    struct br_store store; /* of the arrays below */
    struct word *word;     /* of each rank, at the last meeting */
    int *bytes, *place;    /* of each rank's results */

    int64_t *seen;           /* the board as it was read last */
    int64_t mine[NUMBERS];   /* this rank's numbers as they are written */
    MPI_Request request[3];  /* of both, and of the mark */
    bool exchanging, marked; /* whether those have begun */
    int64_t *known_beats;    /* of each rank */
    double *silence;         /* of each rank, s */
    double looked, beat;     /* when, s */

    const struct br_observer *observer; /* of the call; may be NULL */
    double before, total;               /* the job's work before this call, and of it, ns */
    double done;                        /* by this rank since the start, ns */
    size_t tickets;                     /* drawn in the calls before */
    bool waits;                         /* for rank 0's end, however long it takes */
    bool interrupted;                   /* this rank was asked to stop */
    bool fails;                         /* this rank, for that or another reason */
    bool failed;                        /* some rank has */
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

/* ---- the board ---- */

/* The main thread looks around this often. */
static void pause_a_little(void)
{
    nanosleep(&(struct timespec){.tv_nsec = 1000000}, NULL);
}

static double silence_limit(void)
{
    const char *text = getenv("BEAMRATE_SILENCE");
    const double given = text ? atof(text) : 0;
    return given > 0 ? given : longest_silence;
}

/* Rank 0 listens to all, the others to rank 0. */
static int listens_to(void)
{
    return job.rank == 0 ? job.size : 1;
}

static int number_of(int rank, int number)
{
    return OF_RANKS + rank * NUMBERS + number;
}

/* Counts on, and reads the board. Neither has happened when this returns. */
static void exchange(void)
{
    const int words = number_of(listens_to(), 0);
    job.mine[BEATS]++;
    job.mine[DONE] = (int64_t)job.done;
    job.exchanging = true;
    MPI_Raccumulate(job.mine, NUMBERS, MPI_INT64_T, 0, number_of(job.rank, 0), NUMBERS, MPI_INT64_T,
                    MPI_REPLACE, job.board, &job.request[0]);
    MPI_Rget_accumulate(NULL, 0, MPI_INT64_T, job.seen, words, MPI_INT64_T, 0, 0, words,
                        MPI_INT64_T, MPI_NO_OP, job.board, &job.request[1]);
}

/* So that all ranks end their marches. */
static void mark_failed(void)
{
    static const int64_t one = 1;
    job.marked = true;
    MPI_Raccumulate(&one, 1, MPI_INT64_T, 0, FAILED, 1, MPI_INT64_T, MPI_REPLACE, job.board,
                    &job.request[2]);
}

static void read_board(void)
{
    double done = 0;
    job.exchanging = false;
    job.failed |= job.seen[FAILED] != 0;
    for (int r = 0; r < listens_to(); r++) {
        const int64_t beats = job.seen[number_of(r, BEATS)];
        if (beats != job.known_beats[r])
            job.silence[r] = 0;
        job.known_beats[r] = beats;
        done += (double)job.seen[number_of(r, DONE)];
    }
    const struct br_observer *o = job.observer;
    if (job.rank == 0 && o && o->progress && job.total > 0)
        o->progress(o->self, fmax(0, done - job.before) / job.total);
}

/* To be called again and again: keeps the exchange going, and asks whether to stop. Fails with
 * BR_IO where a rank has been silent for too long. Only the time that this process was running
 * counts, so that a job that was suspended as a whole goes on. */
static enum br_status watch(struct br_error *err)
{
    const double now = br_seconds(), passed = fmin(now - job.looked, longest_look);
    enum br_status status = BR_OK;
    int flag, idle;
    job.looked = now;
    /* lets MPI serve the others */
    MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, job.comm, &flag, MPI_STATUS_IGNORE);
    MPI_Testall(3, job.request, &idle, MPI_STATUSES_IGNORE);
    if (idle && job.exchanging)
        read_board();
    if (idle && now - job.beat >= beat_every) {
        job.beat = now;
        exchange();
    }
    job.interrupted |= br_observer_stops(job.observer);
    if ((job.interrupted || job.fails) && !job.marked)
        mark_failed();
    for (int r = 0; r < listens_to() && !job.waits && !status; r++) {
        job.silence[r] += passed;
        if (r != job.rank && job.silence[r] >= silence_limit())
            status = br_fail(err, BR_IO, "rank %d has not been heard from for %g s: is it gone?", r,
                             job.silence[r]);
    }
    job.lost |= status != BR_OK;
    job.fails |= job.lost;
    return status;
}

/* After a while in which nobody watched. */
static void start_watching(void)
{
    job.looked = br_seconds();
    for (int r = 0; r < job.size; r++)
        job.silence[r] = 0;
}

/* Until an operation is done; fails as watch does. */
static enum br_status await(MPI_Request *request, struct br_error *err)
{
    enum br_status status = BR_OK;
    int done = 0;
    MPI_Test(request, &done, MPI_STATUS_IGNORE);
    while (!done && !status) {
        pause_a_little();
        status = watch(err);
        MPI_Test(request, &done, MPI_STATUS_IGNORE);
    }
    return status;
}

/* The number of a batch that nobody else gets: MPI_Fetch_and_op, but that one can watch meanwhile.
 */
static enum br_status draw(size_t *ticket, struct br_error *err)
{
    static const int64_t one = 1;
    static int64_t drawn; /* outlives an operation that is not done when a rank is lost */
    MPI_Request request;
    MPI_Rget_accumulate(&one, 1, MPI_INT64_T, &drawn, 1, MPI_INT64_T, 0, TICKET, 1, MPI_INT64_T,
                        MPI_SUM, job.board, &request);
    const enum br_status status = await(&request, err);
    *ticket = (size_t)drawn - job.tickets;
    return status;
}

/* ---- meetings ---- */

/* What is wrong with what all have said. */
static enum br_status judge_words(struct br_error *err)
{
    const struct word *first = &job.word[0], *own = &job.word[job.rank];
    for (int r = 0; r < job.size; r++)
        if (job.word[r].failure.status)
            return r == job.rank ? br_fail(err, own->failure.status, "%s", own->failure.message)
                                 : br_fail(err, job.word[r].failure.status, "rank %d: %.900s", r,
                                           job.word[r].failure.message);
    for (int r = 0; r < job.size; r++)
        if (job.word[r].ends != own->ends)
            return br_fail(err, BR_IO, "rank %d has ended before its time",
                           own->ends ? job.rank : r);
    for (int r = 0; r < job.size; r++)
        if (job.word[r].asked != first->asked)
            return br_fail(err, BR_BAD_INPUT,
                           "rank %d was asked for other studies than rank 0: all must see the same "
                           "scenes, options and program",
                           r);
    return BR_OK;
}

/* All say something, and hear all. Fails on all alike where one has failed: the job is over then.
 */
static enum br_status meet(struct word word, struct br_error *err)
{
    MPI_Request request;
    if (!word.failure.status && !word.ends && job.interrupted)
        br_fail(&word.failure, BR_INTERRUPTED, "interrupted");
    MPI_Iallgather(&word, sizeof word, MPI_BYTE, job.word, sizeof word, MPI_BYTE, job.comm,
                   &request);
    enum br_status status = await(&request, err);
    if (status)
        return status;
    status = judge_words(err);
    job.over = status || word.ends;
    return status;
}

/* ---- a call ---- */

struct call {
    struct br_study *studies;
    size_t count;
    struct br_batches batches;
    int threads;
    struct word word; /* what this rank says */
    FILE *results;    /* into its own bytes */
    char *own, *all;  /* of all ranks, one behind the other */
    size_t size;      /* of these */

    /* the batch that a thread of its own marches */
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
    pthread_setname_np(pthread_self(), "march"); /* tells it from MPI's own threads */
    br_batch_march(c->studies, c->count, &c->batches, c->batch, c->threads, &observer, c->results,
                   &c->failure);
    return NULL;
}

/* Marches a batch while the main thread watches, which signals wake. That others have failed is not
 * this rank's failure. */
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
        pause_a_little();
    }
    job.done = before + cost;
    if (!status && c->failure.status && !(job.failed && c->failure.status == BR_INTERRUPTED))
        status = br_fail(err, c->failure.status, "%s", c->failure.message);
    return status;
}

static enum br_status march_all(struct call *c, struct br_error *err)
{
    size_t batch = 0;
    enum br_status status = draw(&batch, err);
    while (!status && batch < c->batches.count && !job.interrupted && !job.failed) {
        status = march_batch(c, batch, err);
        if (!status)
            status = draw(&batch, err);
    }
    return status;
}

/* The results of all ranks. */
static enum br_status gather(struct call *c, struct br_error *err)
{
    MPI_Request request;
    enum br_status status = meet(c->word, err);
    if (status)
        return status;
    for (int r = 0; r < job.size; c->size += job.word[r++].bytes) {
        if (job.word[r].bytes > INT_MAX - c->size)
            return br_fail(err, BR_IO, "the results of all ranks are beyond 2 GiB");
        job.bytes[r] = (int)job.word[r].bytes;
        job.place[r] = (int)c->size;
    }
    if (!(c->all = br_allocate(c->size + 1, 1)))
        br_no_memory(&c->word.failure, "the results");
    status = meet(c->word, err);
    if (status)
        return status;
    MPI_Iallgatherv(c->own, (int)c->word.bytes, MPI_BYTE, c->all, job.bytes, job.place, MPI_BYTE,
                    job.comm, &request);
    return await(&request, err);
}

/* All marches, then all results. What goes wrong on this rank is said at the meeting. */
static enum br_status share(struct call *c, struct br_error *err)
{
    struct br_error *failure = &c->word.failure;
    c->results = open_memstream(&c->own, &c->word.bytes);
    enum br_status status = meet(c->word, err);
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

enum br_status br_ranks_lockstep(struct br_study *studies, size_t count, int threads,
                                 const struct br_observer *observer, struct br_error *err)
{
    struct call c = {.studies = studies, .count = count};
    const int each = threads > 0 ? threads : job.most_threads;
    if (job.size == 1)
        return br_lockstep(studies, count, threads, observer, err);
    if (job.over)
        return br_fail(err, BR_IO, "the ranks share no work after a failure");
    c.threads = threads > 0 ? threads : job.threads;
    br_batches_create(&c.batches, studies, count, job.size, each, &c.word.failure);
    c.word.asked = br_studies_fingerprint(studies, count) + (unsigned)each;
    job.observer = observer;
    job.total = 0;
    for (size_t i = 0; i < c.batches.count; i++)
        job.total += c.batches.cost[i];
    start_watching();
    const enum br_status status = share(&c, err);
    job.observer = NULL;
    job.before += job.total;
    job.tickets += c.batches.count + (size_t)job.size; /* each rank has drawn one too many */
    br_batches_clear(&c.batches);
    if (!status && observer && observer->progress && job.rank == 0)
        observer->progress(observer->self, 1);
    return status;
}

/* ---- beginning and end ---- */

/* Ends all ranks at once, after saying why. One rank alone asks for it: mpirun was seen to crash
 * when several did at once. The others are ended by that soon, or, where the launcher was told to
 * carry on, end by themselves. */
_Noreturn static void abort_job(const char *why)
{
    fprintf(stderr, "beamrate: rank %d of %d: ", job.rank, job.size);
    br_quote(stderr, &br_for_text, why);
    fputc('\n', stderr);
    fflush(NULL);
    if (job.rank <= 1)
        MPI_Abort(MPI_COMM_WORLD, br_status_exit_code(BR_IO));
    else
        sleep(5);
    _Exit(br_status_exit_code(BR_IO));
}

/* Of any MPI function. */
static void heed_error(int code)
{
    char text[MPI_MAX_ERROR_STRING + 8] = "MPI: ";
    int length;
    MPI_Error_string(code, text + strlen(text), &length);
    abort_job(text);
}

static void heed_error_of_ranks(MPI_Comm *comm, int *code, ...)
{
    (void)comm;
    heed_error(*code);
}

static void heed_error_of_board(MPI_Win *board, int *code, ...)
{
    (void)board;
    heed_error(*code);
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

static enum br_status create_board(struct br_error *err)
{
    const size_t ranks = (size_t)job.size, words = (size_t)number_of(job.size, 0);
    job.word = br_store_take(&job.store, ranks, sizeof *job.word);
    job.bytes = br_store_take(&job.store, ranks, sizeof *job.bytes);
    job.place = br_store_take(&job.store, ranks, sizeof *job.place);
    job.seen = br_store_take(&job.store, words, sizeof *job.seen);
    job.known_beats = br_store_take(&job.store, ranks, sizeof *job.known_beats);
    job.silence = br_store_take(&job.store, ranks, sizeof *job.silence);
    if (job.store.failed)
        return br_no_memory(err, "the ranks");
    MPI_Errhandler handler;
    const MPI_Aint size = job.rank == 0 ? (MPI_Aint)(words * sizeof *job.seen) : 0;
    int64_t *memory;
    job.request[0] = job.request[1] = job.request[2] = MPI_REQUEST_NULL;
    MPI_Win_allocate(size, sizeof *memory, MPI_INFO_NULL, job.comm, &memory, &job.board);
    MPI_Win_create_errhandler(heed_error_of_board, &handler);
    MPI_Win_set_errhandler(job.board, handler);
    MPI_Errhandler_free(&handler);
    if (job.rank == 0)
        memset(memory, 0, (size_t)size);
    MPI_Barrier(job.comm);
    MPI_Win_lock_all(MPI_MODE_NOCHECK, job.board);
    job.joined = true;
    return BR_OK;
}

static enum br_status join(const struct br_launch *launch, struct br_error *err)
{
    int provided, found;
    MPI_Errhandler handler;
    MPI_Init_thread(NULL, NULL, MPI_THREAD_FUNNELED, &provided);
    MPI_Comm_size(MPI_COMM_WORLD, &found);
    job.rank = launch->rank; /* so that only one of them says why they end */
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
    MPI_Comm_create_errhandler(heed_error_of_ranks, &handler);
    MPI_Comm_set_errhandler(MPI_COMM_WORLD, handler);
    MPI_Errhandler_free(&handler);
    MPI_Comm_dup(MPI_COMM_WORLD, &job.comm); /* of this program's own, with the same handler */
    const enum br_status status = count_threads(err);
    return status ? status : create_board(err);
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
        MPI_Win_unlock_all(job.board);
        MPI_Win_free(&job.board);
        MPI_Comm_free(&job.comm);
    }
    if (begun)
        MPI_Finalize();
    br_store_clear(&job.store);
}

enum br_status br_ranks_end(enum br_status status, struct br_error *err)
{
    if (job.size > 1) {
        struct word word = {.ends = true};
        if (status)
            br_fail(&word.failure, status, "%s", err->message);
        if (!job.joined || job.lost)
            abort_job(err->message);
        job.waits = job.rank > 0; /* rank 0 may be writing for long */
        start_watching();
        if (!job.over)
            status = meet(word, err);
        if (job.lost)
            abort_job(err->message);
    }
    leave();
    return br_ranks_first() ? status : BR_OK;
}
