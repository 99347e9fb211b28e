/* SPDX-License-Identifier: GPL-3.0-or-later */
/* br_spread on the ranks that are given work. */
#include <stdio.h>
#include <string.h>

#include "study/ranks/spread_talk.h"

struct worker {
    struct br_spread_call *call;
    bool failed; /* and rank 0 has been told */
    bool all;    /* everybody's results are here */
};

/* Rank 0 answers that the call has to stop. */
static enum br_status tell_failure(struct worker *w, const struct br_error *what,
                                   struct br_error *err)
{
    if (w->failed)
        return BR_OK;
    w->failed = true;
    return br_talk_send_error(0, BR_TALK_FAIL, what, err);
}

static enum br_status send_result(struct worker *w, struct br_error *err)
{
    const size_t group = w->call->bench.group;
    const struct br_error failure = w->call->bench.failure;
    struct br_parcel parcel = br_bench_take(&w->call->bench);
    enum br_status status;
    if (failure.status) {
        status = tell_failure(w, &failure, err);
    } else {
        const size_t size = sizeof group + parcel.size;
        char *bytes = br_allocate(size, 1);
        status = bytes ? BR_OK : br_no_memory(err, "the results");
        if (bytes) {
            memcpy(bytes, &group, sizeof group);
            memcpy(bytes + sizeof group, parcel.bytes, parcel.size);
            status = br_ranks_send(0, BR_TALK_DONE, bytes, size, err);
        }
        free(bytes);
    }
    free(parcel.bytes);
    return status;
}

/* The results of all groups, one after the other, each behind its size. */
static enum br_status unpack_all(struct br_spread_call *call, const struct br_message *m,
                                 struct br_error *err)
{
    size_t at = 0;
    enum br_status status = BR_OK;
    for (size_t g = 0; g < call->units.groups && !status; g++) {
        size_t size = 0;
        if (m->size - at >= sizeof size)
            memcpy(&size, m->bytes + at, sizeof size);
        if (m->size - at < sizeof size || m->size - at - sizeof size < size)
            return br_fail(err, BR_IO, "the results of all ranks are cut off");
        struct br_parcel parcel = {.bytes = m->bytes + at + sizeof size, .size = size};
        status = br_group_unpack(call->studies, &call->units, g, &parcel, err);
        at += sizeof size + size;
    }
    return status;
}

static enum br_status heed(struct worker *w, const struct br_message *m, struct br_error *err)
{
    struct br_spread_call *call = w->call;
    struct br_error error = {0};
    size_t group = 0;
    switch (m->kind) {
    case BR_TALK_GIVE:
        memcpy(&group, m->bytes, sizeof group);
        if (!w->failed)
            br_bench_give(&call->bench, group);
        return BR_OK;
    case BR_TALK_STOP:
        error = br_talk_error(m);
        br_talk_stop(call, &error);
        return BR_OK;
    case BR_TALK_ALL:
        w->all = true;
        return unpack_all(call, m, err);
    case BR_TALK_OVER:
        if (m->bytes[0])
            br_ranks_abort(NULL); /* rank 0 says why */
        br_talk()->over = true;
        br_fail(&error, BR_IO, "rank 0 has ended");
        br_talk_stop(call, &error);
        return BR_OK;
    default: /* a beat */
        return BR_OK;
    }
}

/* What comes after the results of all belongs to the next call, or to the end. */
static enum br_status heed_all(struct worker *w, struct br_error *err)
{
    struct br_message m;
    bool came = true;
    enum br_status status = BR_OK;
    while (!status && came && !w->all) {
        status = br_talk_receive(&m, &came, err);
        if (!status && came)
            status = heed(w, &m, err);
        free(m.bytes);
    }
    return status;
}

static enum br_status look_around(struct worker *w, struct br_error *err)
{
    const struct br_observer *o = w->call->observer;
    enum br_status status = BR_OK;
    if (o && o->stop && !w->failed && o->stop(o->self))
        status = tell_failure(w, &(struct br_error){BR_INTERRUPTED, "interrupted"}, err);
    if (!status && br_talk_beat_due()) {
        const double fraction = atomic_load(&w->call->bench.fraction);
        status = br_ranks_send(0, BR_TALK_BEAT, &fraction, sizeof fraction, err);
    }
    return status ? status : br_talk_listen(0, 1, err);
}

enum br_status br_spread_worker(struct br_spread_call *call, struct br_error *err)
{
    struct worker w = {.call = call};
    enum br_status status =
        br_ranks_send(0, BR_TALK_JOIN, &call->fingerprint, sizeof call->fingerprint, err);
    while (!status && !w.all && !call->stop.status) {
        if (br_bench_wait(&call->bench, br_talk_patience) == BR_BENCH_DONE)
            status = send_result(&w, err);
        if (!status)
            status = heed_all(&w, err);
        if (!status)
            status = look_around(&w, err);
    }
    if (!status && call->stop.status)
        status = br_fail(err, call->stop.status, "%s", call->stop.message);
    return status;
}
