/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/ranks/spread_talk.h"

#include <math.h>
#include <string.h>

#include "solver/clock.h"

const double br_talk_patience = 1e-3;
static const double beat_every = 0.25;   /* s */
static const double longest_quiet = 60;  /* s; $BEAMRATE_SILENCE instead */
static const double longest_look = 0.05; /* s: longer between two looks, and it was not running */

static struct br_talk_state state;

struct br_talk_state *br_talk(void)
{
    const size_t ranks = (size_t)br_ranks_size();
    if (!state.left)
        state.left = br_allocate(ranks, sizeof *state.left);
    if (!state.quiet)
        state.quiet = br_allocate(ranks, sizeof *state.quiet);
    return state.left && state.quiet ? &state : NULL;
}

void br_talk_forget(void)
{
    free(state.left);
    free(state.quiet);
    state = (struct br_talk_state){0};
}

void br_talk_stop(struct br_spread_call *call, const struct br_error *why)
{
    if (!call->stop.status)
        call->stop = *why;
}

enum br_status br_talk_send_error(int to, enum br_talk kind, const struct br_error *what,
                                  struct br_error *err)
{
    return br_ranks_send(to, (int)kind, what, sizeof *what, err);
}

struct br_error br_talk_error(const struct br_message *message)
{
    struct br_error error = {BR_IO, "another rank sent an error that is cut off"};
    if (message->size == sizeof error)
        memcpy(&error, message->bytes, sizeof error);
    return error;
}

enum br_status br_talk_receive(struct br_message *message, bool *came, struct br_error *err)
{
    const enum br_status status = br_ranks_receive(message, came, err);
    if (!status && *came)
        state.quiet[message->from] = 0;
    return status;
}

bool br_talk_beat_due(void)
{
    const double now = br_seconds();
    if (now - state.beat < beat_every)
        return false;
    state.beat = now;
    return true;
}

static double quiet_limit(void)
{
    const char *text = getenv("BEAMRATE_SILENCE");
    const double given = text ? atof(text) : 0;
    return given > 0 ? given : longest_quiet;
}

void br_talk_start_listening(void)
{
    state.looked = br_seconds();
    for (int r = 0; r < br_ranks_size(); r++)
        state.quiet[r] = 0;
}

enum br_status br_talk_listen(int first, int last, struct br_error *err)
{
    const double now = br_seconds(), passed = fmin(now - state.looked, longest_look);
    state.looked = now;
    for (int r = first; r < last; r++) {
        state.quiet[r] += passed;
        if (state.left[r] || state.quiet[r] < quiet_limit())
            continue;
        state.lost = true;
        return br_fail(err, BR_IO, "rank %d has not been heard from for %g s: is it gone?", r,
                       state.quiet[r]);
    }
    return BR_OK;
}
