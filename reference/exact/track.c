/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/exact/track.h"

#include <math.h>
#include <string.h>

#include "reference/exact/legendre.h"

enum { S = BR_STAGES };

enum br_status br_track_create(struct br_track **out, size_t modes, double gap,
                               struct br_error *err)
{
    *out = br_allocate(1, sizeof **out);
    if (!*out)
        return br_no_memory(err, "the exact solution's steps");
    (*out)->modes = modes;
    (*out)->gap = gap;
    return BR_OK;
}

void br_track_free(struct br_track *track)
{
    if (!track)
        return;
    free(track->tip);
    free(track->displacement);
    free(track->velocity);
    free(track->entry);
    free(track);
}

/* *array moves to a room of `room` records of the given size; `used` are kept. */
static enum br_status move(void *array, size_t used, size_t room, size_t size, struct br_error *err)
{
    void *old, *bigger = br_allocate(room, size);
    if (!bigger)
        return br_no_memory(err, "the exact solution's steps");
    memcpy(&old, array, sizeof old);
    if (used)
        memcpy(bigger, old, used * size);
    free(old);
    memcpy(array, &bigger, sizeof bigger);
    return BR_OK;
}

static enum br_status make_room(struct br_track *track, struct br_error *err)
{
    const size_t n = track->steps, m = track->modes, room = 2 * n + 64;
    if (n < track->step_room)
        return BR_OK;
    enum br_status status = move(&track->tip, n, room, sizeof *track->tip, err);
    if (!status)
        status = move(&track->displacement, n, room, m * sizeof(double), err);
    if (!status)
        status = move(&track->velocity, n, room, m * S * sizeof(double), err);
    if (!status)
        track->step_room = room;
    return status;
}

enum br_status br_track_append(struct br_track *track, const struct br_tip *tip, const double *q,
                               const double *v, struct br_error *err)
{
    const enum br_status status = make_room(track, err);
    if (status)
        return status;
    const size_t n = track->steps++, m = track->modes;
    track->tip[n] = *tip;
    memcpy(&track->displacement[n * m], q, m * sizeof *q);
    memcpy(&track->velocity[n * m * S], v, m * S * sizeof *v);
    return BR_OK;
}

enum br_status br_track_enter(struct br_track *track, const struct br_entry *entry,
                              struct br_error *err)
{
    const size_t n = track->entries;
    if (n && track->entry[n - 1].time == entry->time) {
        track->entry[n - 1].phase = entry->phase;
        return BR_OK;
    }
    if (n == track->entry_room) {
        const enum br_status status = move(&track->entry, n, 2 * n + 16, sizeof *track->entry, err);
        if (status)
            return status;
        track->entry_room = 2 * n + 16;
    }
    track->entry[track->entries++] = *entry;
    return BR_OK;
}

size_t br_track_find(const struct br_track *track, double t)
{
    size_t low = 0, high = track->steps; /* tip[low].start <= t < tip[high].start */
    while (high - low > 1) {
        const size_t middle = low + (high - low) / 2;
        if (track->tip[middle].start <= t)
            low = middle;
        else
            high = middle;
    }
    return low;
}

/* The fraction of a step that is over at t. */
static double fraction(const struct br_tip *tip, double t)
{
    return fmin(fmax((t - tip->start) / tip->length, 0), 1);
}

/* A step's p_k at one moment, and their integrals from its start, over its length. */
struct moment {
    double value[S], integral[S];
};

static struct moment moment_at(double theta)
{
    struct moment at;
    br_legendre_integral(S, theta, at.value, at.integral);
    return at;
}

static struct br_tip_state tip_at(const struct br_tip *tip, const struct moment *at)
{
    return (struct br_tip_state){
        .displacement = tip->displacement + tip->length * br_radau_sum(tip->velocity, at->integral),
        .velocity = br_radau_sum(tip->velocity, at->value),
        .force = br_radau_sum(tip->force, at->value),
        .phase = tip->phase,
    };
}

struct br_tip_state br_tip_at(const struct br_tip *tip, double theta)
{
    const struct moment at = moment_at(theta);
    return tip_at(tip, &at);
}

struct br_tip_state br_track_at(const struct br_track *track, double t, double *q, double *v)
{
    const size_t n = br_track_find(track, t), m = track->modes;
    const struct br_tip *tip = &track->tip[n];
    const struct moment at = moment_at(fraction(tip, t));
    const double *start = &track->displacement[n * m], *series = &track->velocity[n * m * S];
    for (size_t i = 0; q && i < m; i++)
        q[i] = start[i] + tip->length * br_radau_sum(&series[i * S], at.integral);
    for (size_t i = 0; v && i < m; i++)
        v[i] = br_radau_sum(&series[i * S], at.value);
    return tip_at(tip, &at);
}
