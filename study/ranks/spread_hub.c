/* SPDX-License-Identifier: GPL-3.0-or-later */
/* br_spread on rank 0, which hands out the work. */
#include <stdio.h>
#include <string.h>

#include "study/grid/observer.h"
#include "study/ranks/spread_talk.h"

static const size_t nothing = (size_t)-1;

struct hub {
    struct br_spread_call *call;
    int ranks;
    size_t *working;          /* of each rank: its group, or `nothing` */
    bool *joined;             /* of each rank */
    double *fraction;         /* of each rank: how far its group is */
    struct br_parcel *result; /* of each group; owned */
    size_t next, finished;    /* groups */
    double done, total;       /* ns */
};

static double cost_of(const struct hub *h, size_t group)
{
    const struct br_units *u = &h->call->units;
    double cost = 0;
    for (size_t i = u->first[group]; i < u->first[group + 1]; i++)
        cost += u->unit[i].cost;
    return cost;
}

static enum br_status create(struct hub *h, struct br_error *err)
{
    const size_t ranks = (size_t)h->ranks, groups = h->call->units.groups;
    h->working = br_allocate(ranks, sizeof *h->working);
    h->joined = br_allocate(ranks, sizeof *h->joined);
    h->fraction = br_allocate(ranks, sizeof *h->fraction);
    h->result = br_allocate(groups, sizeof *h->result);
    if (!h->working || !h->joined || !h->fraction || !h->result)
        return br_no_memory(err, "the ranks");
    for (size_t r = 0; r < ranks; r++)
        h->working[r] = nothing;
    h->joined[0] = true;
    for (size_t g = 0; g < groups; g++)
        h->total += cost_of(h, g);
    return BR_OK;
}

static void clear(struct hub *h)
{
    for (size_t g = 0; h->result && g < h->call->units.groups; g++)
        free(h->result[g].bytes);
    free(h->working);
    free(h->joined);
    free(h->fraction);
    free(h->result);
}

/* ---- work ---- */

static enum br_status hand_out(struct hub *h, struct br_error *err)
{
    enum br_status status = BR_OK;
    for (int r = 0; r < h->ranks && h->next < h->call->units.groups && !status; r++) {
        if (!h->joined[r] || h->working[r] != nothing)
            continue;
        h->working[r] = h->next++;
        h->fraction[r] = 0;
        if (r == 0)
            br_bench_give(&h->call->bench, h->working[r]);
        else
            status = br_ranks_send(r, BR_TALK_GIVE, &h->working[r], sizeof *h->working, err);
    }
    return status;
}

static void keep_result(struct hub *h, int rank, struct br_parcel result)
{
    const size_t group = h->working[rank];
    h->result[group] = result;
    h->working[rank] = nothing;
    h->done += cost_of(h, group);
    h->finished++;
}

static void keep_own(struct hub *h)
{
    const struct br_error failure = h->call->bench.failure;
    struct br_parcel result = br_bench_take(&h->call->bench);
    if (!failure.status) {
        keep_result(h, 0, result);
        return;
    }
    free(result.bytes);
    br_talk_stop(h->call, &failure);
}

static enum br_status keep_sent(struct hub *h, const struct br_message *m, struct br_error *err)
{
    size_t group = nothing;
    if (m->size >= sizeof group)
        memcpy(&group, m->bytes, sizeof group);
    if (group == nothing || group != h->working[m->from])
        return br_fail(err, BR_IO, "rank %d sent results that it was not asked for", m->from);
    struct br_parcel result = {.size = m->size - sizeof group};
    result.bytes = br_allocate(result.size, 1);
    if (!result.bytes)
        return br_no_memory(err, "the results");
    memcpy(result.bytes, m->bytes + sizeof group, result.size);
    keep_result(h, m->from, result);
    return BR_OK;
}

/* ---- messages ---- */

static void stop_for(struct hub *h, const struct br_message *m)
{
    const struct br_error said = br_talk_error(m);
    struct br_error why = {0};
    if (said.status)
        br_fail(&why, said.status, "rank %d: %.900s", m->from, said.message);
    else
        br_fail(&why, BR_IO, "rank %d has ended before its time", m->from);
    br_talk_stop(h->call, &why);
}

static enum br_status join(struct hub *h, const struct br_message *m, struct br_error *err)
{
    unsigned long long found = 0;
    if (m->size == sizeof found)
        memcpy(&found, m->bytes, sizeof found);
    h->joined[m->from] = true;
    if (found != h->call->fingerprint)
        return br_fail(err, BR_BAD_INPUT,
                       "rank %d was asked for other studies than rank 0: all must see the same "
                       "scenes, options and program",
                       m->from);
    return BR_OK;
}

static enum br_status heed(struct hub *h, const struct br_message *m, struct br_error *err)
{
    switch (m->kind) {
    case BR_TALK_JOIN:
        return join(h, m, err);
    case BR_TALK_DONE:
        return keep_sent(h, m, err);
    case BR_TALK_LEAVE:
        br_talk()->left[m->from] = true;
        stop_for(h, m);
        return BR_OK;
    case BR_TALK_FAIL:
        stop_for(h, m);
        return BR_OK;
    case BR_TALK_BEAT:
        memcpy(&h->fraction[m->from], m->bytes, sizeof *h->fraction);
        return BR_OK;
    default:
        return br_fail(err, BR_IO, "rank %d sent a message of kind %d", m->from, m->kind);
    }
}

static enum br_status heed_all(struct hub *h, struct br_error *err)
{
    struct br_message m;
    bool came = true;
    enum br_status status = BR_OK;
    while (!status && came) {
        status = br_talk_receive(&m, &came, err);
        if (!status && came)
            status = heed(h, &m, err);
        free(m.bytes);
    }
    return status;
}

/* ---- the call ---- */

static void tell_progress(const struct hub *h)
{
    const struct br_observer *o = h->call->observer;
    double done = h->done;
    if (!o || !o->progress || !(h->total > 0))
        return;
    for (int r = 0; r < h->ranks; r++)
        if (h->working[r] != nothing)
            done += cost_of(h, h->working[r]) *
                    (r == 0 ? atomic_load(&h->call->bench.fraction) : h->fraction[r]);
    o->progress(o->self, done / h->total);
}

static enum br_status look_around(struct hub *h, struct br_error *err)
{
    const struct br_observer *o = h->call->observer;
    enum br_status status = BR_OK;
    if (o && o->stop && o->stop(o->self))
        return br_fail(err, BR_INTERRUPTED, "interrupted");
    const bool due = br_talk_beat_due();
    for (int r = 1; r < h->ranks && due && !status; r++)
        status = br_ranks_send(r, BR_TALK_BEAT, NULL, 0, err);
    if (due)
        tell_progress(h);
    return status ? status : br_talk_listen(1, h->ranks, err);
}

static bool is_complete(const struct hub *h)
{
    bool complete = h->finished == h->call->units.groups;
    for (int r = 0; r < h->ranks; r++)
        complete &= h->joined[r];
    return complete;
}

static enum br_status work(struct hub *h, struct br_error *err)
{
    enum br_status status = BR_OK;
    while (!status && !h->call->stop.status && !is_complete(h)) {
        status = hand_out(h, err);
        if (!status && br_bench_wait(&h->call->bench, br_talk_patience) == BR_BENCH_DONE)
            keep_own(h);
        if (!status)
            status = heed_all(h, err);
        if (!status && !h->call->stop.status)
            status = look_around(h, err);
    }
    if (!status && h->call->stop.status)
        status = br_fail(err, h->call->stop.status, "%s", h->call->stop.message);
    return status;
}

/* Everybody's results to everybody. */
static enum br_status send_all(const struct hub *h, struct br_error *err)
{
    char *bytes = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&bytes, &size);
    for (size_t g = 0; out && g < h->call->units.groups; g++) {
        fwrite(&h->result[g].size, sizeof h->result[g].size, 1, out);
        fwrite(h->result[g].bytes, 1, h->result[g].size, out);
    }
    const bool failed = !out || ferror(out);
    enum br_status status =
        (out && fclose(out) != 0) || failed ? br_no_memory(err, "the results") : BR_OK;
    for (int r = 1; r < h->ranks && !status; r++)
        status = br_ranks_send(r, BR_TALK_ALL, bytes, size, err);
    free(bytes);
    return status;
}

static enum br_status unpack_all(struct hub *h, struct br_error *err)
{
    enum br_status status = BR_OK;
    for (size_t g = 0; g < h->call->units.groups && !status; g++)
        status = br_group_unpack(h->call->studies, &h->call->units, g, &h->result[g], err);
    return status;
}

/* Those that have not joined yet find it waiting for them. */
static void stop_all(const struct hub *h, const struct br_error *why)
{
    for (int r = 1; r < h->ranks; r++)
        if (!br_talk()->left[r])
            br_talk_send_error(r, BR_TALK_STOP, why, NULL);
}

enum br_status br_spread_hub(struct br_spread_call *call, struct br_error *err)
{
    struct hub h = {.call = call, .ranks = br_ranks_size()};
    struct br_error why = {0};
    enum br_status status = create(&h, &why);
    if (!status)
        status = work(&h, &why);
    if (!status)
        status = send_all(&h, &why);
    if (status)
        stop_all(&h, &why);
    else
        status = unpack_all(&h, &why);
    if (status)
        br_fail(err, status, "%s", why.message);
    else if (call->observer && call->observer->progress)
        call->observer->progress(call->observer->self, 1);
    clear(&h);
    return status;
}
