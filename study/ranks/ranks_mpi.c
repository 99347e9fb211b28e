/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <mpi.h>
#include <sched.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "study/ranks/launcher.h"
#include "study/ranks/ranks.h"
#include "study/scene/quote.h"

/* What is being sent: a list, since nobody waits. */
struct parcel {
    struct parcel *next;
    MPI_Request request;
    char bytes[];
};

static struct {
    int rank, size, threads, most_threads;
    MPI_Comm comm; /* of this program's own, so that errors come back to it */
    struct parcel *outbox;
} ranks = {.size = 1};

static enum br_status check(int code, const char *what, struct br_error *err)
{
    char text[MPI_MAX_ERROR_STRING];
    int length = 0;
    if (code == MPI_SUCCESS)
        return BR_OK;
    MPI_Error_string(code, text, &length);
    return br_fail(err, BR_IO, "MPI, %s: %.*s", what, length, text);
}

/* ---- threads ---- */

/* Each core that this rank may use is worth 1 over the ranks of this machine that may use it. */
static int share_of_cores(const cpu_set_t *mask, int ranks_here, int me)
{
    double share = 0;
    for (size_t core = 0; core < CPU_SETSIZE; core++) {
        int users = 0;
        for (int r = 0; r < ranks_here; r++)
            users += CPU_ISSET(core, &mask[r]) != 0;
        if (CPU_ISSET(core, &mask[me]))
            share += 1.0 / users;
    }
    return share >= 1 ? (int)(share + 1e-6) : 1;
}

static enum br_status count_threads(struct br_error *err)
{
    MPI_Comm machine = MPI_COMM_NULL;
    int here = 1, me = 0;
    enum br_status status =
        check(MPI_Comm_split_type(ranks.comm, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine),
              "the ranks of this machine", err);
    if (status)
        return status;
    MPI_Comm_size(machine, &here);
    MPI_Comm_rank(machine, &me);
    cpu_set_t *mask = br_allocate((size_t)here, sizeof *mask), mine;
    CPU_ZERO(&mine);
    if (!mask)
        status = br_no_memory(err, "the ranks");
    else if (sched_getaffinity(0, sizeof mine, &mine) < 0)
        CPU_SET(0, &mine);
    if (!status)
        status =
            check(MPI_Allgather(&mine, sizeof mine, MPI_BYTE, mask, sizeof mine, MPI_BYTE, machine),
                  "the ranks of this machine", err);
    if (!status)
        ranks.threads = share_of_cores(mask, here, me);
    if (!status)
        status = check(
            MPI_Allreduce(&ranks.threads, &ranks.most_threads, 1, MPI_INT, MPI_MAX, ranks.comm),
            "the threads of the ranks", err);
    free(mask);
    MPI_Comm_free(&machine);
    return status;
}

/* ---- beginning and end ---- */

static enum br_status join(const struct br_launch *launch, struct br_error *err)
{
    int provided = 0;
    ranks.comm = MPI_COMM_NULL;
    enum br_status status =
        check(MPI_Init_thread(NULL, NULL, MPI_THREAD_FUNNELED, &provided), "the start", err);
    if (status)
        return status;
    MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
    status = check(MPI_Comm_dup(MPI_COMM_WORLD, &ranks.comm), "the start", err);
    if (status)
        return status;
    MPI_Comm_set_errhandler(ranks.comm, MPI_ERRORS_RETURN);
    MPI_Comm_size(ranks.comm, &ranks.size);
    MPI_Comm_rank(ranks.comm, &ranks.rank);
    if (provided < MPI_THREAD_FUNNELED)
        return br_fail(err, BR_UNSUPPORTED, "this MPI library allows no threads beside it");
    if (ranks.size == launch->size)
        return count_threads(err);
    const int found = ranks.size;
    ranks.size = 1;
    ranks.rank = launch->rank; /* so that only one of them says why they end */
    return br_fail(err, BR_BAD_INPUT,
                   "started by %s as one of %d processes, but the MPI library of this build knows "
                   "of %d: start it with the mpirun of that library, or with srun --mpi=pmix",
                   launch->launcher, launch->size, found);
}

enum br_status br_ranks_start(struct br_error *err)
{
    const struct br_launch launch = br_launch_read();
    return launch.size == 1 ? BR_OK : join(&launch, err);
}

void br_ranks_leave(void)
{
    int begun = 0, ended = 0;
    MPI_Initialized(&begun);
    MPI_Finalized(&ended);
    if (!begun || ended)
        return;
    if (ranks.comm != MPI_COMM_NULL)
        MPI_Comm_free(&ranks.comm);
    MPI_Finalize();
}

/* One rank alone asks for it: mpirun was seen to crash when several did at once. The others
 * are ended by that soon, or, where the launcher was told to carry on, end by themselves. */
void br_ranks_abort(const char *why)
{
    if (why) {
        fprintf(stderr, "beamrate: rank %d of %d: ", ranks.rank, ranks.size);
        br_quote(stderr, &br_for_text, why);
        fputc('\n', stderr);
    }
    fflush(NULL);
    if (why && ranks.rank <= 1)
        MPI_Abort(MPI_COMM_WORLD, br_status_exit_code(BR_IO));
    else
        sleep(5);
    _Exit(br_status_exit_code(BR_IO));
}

int br_ranks_rank(void)
{
    return ranks.rank;
}

int br_ranks_size(void)
{
    return ranks.size;
}

bool br_ranks_first(void)
{
    return ranks.rank == 0;
}

int br_ranks_threads(void)
{
    return ranks.threads;
}

int br_ranks_most_threads(void)
{
    return ranks.most_threads;
}

/* ---- messages ---- */

/* Forgets what has left. */
static enum br_status clean_outbox(struct br_error *err)
{
    for (struct parcel **at = &ranks.outbox; *at;) {
        struct parcel *p = *at;
        int sent = 0;
        const enum br_status status =
            check(MPI_Test(&p->request, &sent, MPI_STATUS_IGNORE), "sending", err);
        if (status)
            return status;
        if (!sent) {
            at = &p->next;
            continue;
        }
        *at = p->next;
        free(p);
    }
    return BR_OK;
}

bool br_ranks_sent(void)
{
    return clean_outbox(NULL) || !ranks.outbox; /* what cannot be sent is not waited for */
}

enum br_status br_ranks_send(int to, int kind, const void *bytes, size_t size, struct br_error *err)
{
    if (size > (size_t)1 << 30)
        return br_fail(err, BR_IO, "a message of %zu bytes, expected at most 1 GiB", size);
    struct parcel *p = br_allocate(1, sizeof *p + size);
    if (!p)
        return br_no_memory(err, "a message");
    if (size)
        memcpy(p->bytes, bytes, size);
    const enum br_status status =
        check(MPI_Isend(p->bytes, (int)size, MPI_BYTE, to, kind, ranks.comm, &p->request),
              "sending", err);
    if (status) {
        free(p);
        return status;
    }
    p->next = ranks.outbox;
    ranks.outbox = p;
    return BR_OK;
}

enum br_status br_ranks_receive(struct br_message *m, bool *came, struct br_error *err)
{
    MPI_Message handle;
    MPI_Status info;
    int flag = 0, size = 0;
    *came = false;
    *m = (struct br_message){0};
    enum br_status status = clean_outbox(err);
    if (!status)
        status = check(MPI_Improbe(MPI_ANY_SOURCE, MPI_ANY_TAG, ranks.comm, &flag, &handle, &info),
                       "receiving", err);
    if (status || !flag)
        return status;
    MPI_Get_count(&info, MPI_BYTE, &size);
    m->from = info.MPI_SOURCE;
    m->kind = info.MPI_TAG;
    m->size = (size_t)size;
    m->bytes = br_allocate(m->size + 1, 1);
    if (!m->bytes)
        return br_no_memory(err, "a message");
    *came = true;
    return check(MPI_Mrecv(m->bytes, size, MPI_BYTE, &handle, MPI_STATUS_IGNORE), "receiving", err);
}
