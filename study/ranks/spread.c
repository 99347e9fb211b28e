/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/ranks/spread.h"

#include <time.h>

#include "study/grid/lockstep.h"
#include "study/ranks/fingerprint.h"
#include "study/ranks/spread_talk.h"

/* As in lockstep.c: a study that failed has failed in all its norms. */
static void spread_failures(struct br_study *studies, size_t count)
{
    for (size_t i = 0; i < count; i++)
        for (struct br_study *s = studies[i].next_norm; s; s = s->next_norm)
            s->failure = studies[i].failure;
}

static enum br_status run(struct br_spread_call *call, struct br_error *err)
{
    enum br_status status = br_bench_start(&call->bench, err);
    if (status)
        return status;
    br_talk_start_listening();
    status = br_ranks_first() ? br_spread_hub(call, err) : br_spread_worker(call, err);
    br_bench_end(&call->bench);
    return status;
}

enum br_status br_spread(struct br_study *studies, size_t count, int threads,
                         const struct br_observer *observer, struct br_error *err)
{
    if (br_ranks_size() == 1)
        return br_lockstep(studies, count, threads, observer, err);
    if (!br_talk())
        return br_no_memory(err, "the ranks");
    const int each = threads > 0 ? threads : br_ranks_most_threads();
    struct br_spread_call call = {.studies = studies, .count = count, .observer = observer};
    call.fingerprint = br_studies_fingerprint(studies, count) + (unsigned)each;
    enum br_status status =
        br_units_create(&call.units, studies, count, br_ranks_size(), each, err);
    call.bench.studies = studies;
    call.bench.units = &call.units;
    call.bench.threads = threads > 0 ? threads : br_ranks_threads();
    if (!status)
        status = run(&call, err);
    if (!status)
        spread_failures(studies, count);
    br_units_clear(&call.units);
    return status;
}

/* ---- the end ---- */

static void pause_a_little(void)
{
    nanosleep(&(struct timespec){.tv_nsec = 2000000}, NULL);
}

static void flush(void)
{
    for (int i = 0; i < 500 && !br_ranks_sent(); i++)
        pause_a_little();
}

/* Rank 0 tells the others that it ends, in good order or by an abort. */
static void tell_end(bool aborts)
{
    for (int r = 1; r < br_ranks_size(); r++)
        br_ranks_send(r, BR_TALK_OVER, &aborts, sizeof aborts, NULL);
}

/* Where a rank is lost. Those that are left end by themselves: a launcher that was told to carry on
 * would not end them. */
_Noreturn static void give_up(const char *why)
{
    if (br_ranks_first()) {
        tell_end(true);
        flush();
    }
    br_ranks_abort(why);
}

/* Until every other rank has said how it ended. */
static enum br_status hear_ends(enum br_status status, struct br_error *err)
{
    struct br_talk_state *talk = br_talk();
    for (int left = 1; left < br_ranks_size();) {
        struct br_message m;
        struct br_error failure = {0};
        bool came;
        if (br_talk_receive(&m, &came, &failure) || br_talk_listen(1, br_ranks_size(), &failure))
            give_up(status ? err->message : failure.message);
        if (came && m.kind == BR_TALK_LEAVE) {
            const struct br_error said = br_talk_error(&m);
            talk->left[m.from] = true;
            if (said.status && !status)
                status = br_fail(err, said.status, "rank %d: %.900s", m.from, said.message);
        }
        free(m.bytes);
        for (left = 1; left < br_ranks_size() && talk->left[left];)
            left++;
        if (!came)
            pause_a_little();
    }
    return status;
}

/* Until rank 0 says that it has ended, too: it may be writing for long. */
static void wait_for_over(void)
{
    while (!br_talk()->over) {
        struct br_message m;
        struct br_error failure = {0};
        bool came;
        if (br_talk_receive(&m, &came, &failure))
            br_ranks_abort(failure.message);
        br_talk()->over |= came && m.kind == BR_TALK_OVER;
        if (came && m.kind == BR_TALK_OVER && m.bytes[0])
            br_ranks_abort(NULL); /* rank 0 says why */
        free(m.bytes);
        if (!came)
            pause_a_little();
    }
}

enum br_status br_spread_end(enum br_status status, struct br_error *err)
{
    struct br_error none = {0};
    if (br_ranks_size() > 1) {
        if (!br_talk())
            br_ranks_abort("out of memory for the ranks");
        if (br_talk()->lost)
            give_up(err->message);
        br_talk_start_listening();
        if (br_ranks_first()) {
            tell_end(false);
            status = hear_ends(status, err);
        } else {
            err->status = status;
            br_talk_send_error(0, BR_TALK_LEAVE, status ? err : &none, NULL);
            wait_for_over();
        }
        flush();
    }
    br_talk_forget();
    br_ranks_leave();
    return br_ranks_first() ? status : BR_OK;
}
