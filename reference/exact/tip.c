/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/exact/inside.h"

#include <math.h>

enum { S = BR_STAGES };

static double tresca(const struct br_friction *f, double depth)
{
    (void)depth;
    return f->coefficient;
}

static double coulomb(const struct br_friction *f, double depth)
{
    return f->coefficient * depth;
}

/* By law: the bound at the depth (u(L) - g)_+, which is smooth for depths above 0, and whether it
 * depends on it: then it is 0 at 0. */
static const struct {
    double (*bound)(const struct br_friction *friction, double depth);
    bool follows;
} laws[BR_FRICTION_LAWS] = {[BR_TRESCA] = {tresca, false}, [BR_COULOMB] = {coulomb, true}};

bool br_law_is_known(const struct br_friction *friction)
{
    return friction->law == BR_FRICTIONLESS || laws[friction->law].bound;
}

bool br_law_follows(const struct br_friction *friction)
{
    return laws[friction->law].follows;
}

double br_law_bound(const struct br_exact_law *law, double t)
{
    if (law->friction.law == BR_FRICTIONLESS)
        return 0;
    const double depth =
        law->axial ? fmax(br_history_at(law->axial, t, NULL, NULL).displacement, 0) : 0;
    return laws[law->friction.law].bound(&law->friction, depth);
}

enum br_phase br_law_phase(const struct br_exact_law *law, double t, enum br_phase now,
                           double displacement, double velocity)
{
    if (law->contact) {
        if (!law->obstacle)
            return BR_FREE;
        return displacement > 0 || (displacement == 0 && velocity >= 0) ? BR_CLOSED : BR_OPEN;
    }
    if (law->friction.law == BR_FRICTIONLESS ||
        laws[law->friction.law].bound(&law->friction, 1) == 0)
        return BR_FREE; /* no bound at a depth of 1 m: at none */
    if (law->axial && law->axial->tip[br_history_find(law->axial, t)].phase != BR_CLOSED)
        return BR_FREE;
    if (now != BR_FREE)
        return now;
    return velocity > 0 ? BR_SLIP_UP : velocity < 0 ? BR_SLIP_DOWN : BR_STICK;
}

struct br_law_state br_law_at(const struct br_exact_law *law, double t,
                              const struct br_tip_state *tip)
{
    const double force = tip->force, pressed = fmax(tip->displacement, 0);
    /* a force beyond the bound opposes the slip that follows */
    const enum br_phase slip = force > 0 ? BR_SLIP_UP : BR_SLIP_DOWN;
    switch (tip->phase) {
    case BR_OPEN:
        return (struct br_law_state){0, -tip->displacement, BR_CLOSED};
    case BR_CLOSED:
        return (struct br_law_state){law->stiffness * pressed, tip->displacement, BR_OPEN};
    case BR_STICK:
        return (struct br_law_state){force, br_law_bound(law, t) - fabs(force), slip};
    case BR_SLIP_UP:
        return (struct br_law_state){br_law_bound(law, t), tip->velocity, BR_STICK};
    case BR_SLIP_DOWN:
        return (struct br_law_state){-br_law_bound(law, t), -tip->velocity, BR_STICK};
    case BR_FREE:
        break;
    }
    return (struct br_law_state){0, INFINITY, BR_FREE};
}

/* ---- the history ---- */

size_t br_history_find(const struct br_history *track, double t)
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

struct br_tip_state br_tip_at(const struct br_tip_step *tip, double theta)
{
    double value[S], integral[S]; /* of the p_k, from the step's start and over its length */
    br_legendre_integral(S, theta, value, integral);
    return (struct br_tip_state){
        .displacement = tip->displacement + tip->length * br_radau_sum(tip->velocity, integral),
        .velocity = br_radau_sum(tip->velocity, value),
        .force = br_radau_sum(tip->force, value),
        .phase = tip->phase,
    };
}

struct br_tip_state br_history_at(const struct br_history *track, double t, double *q, double *v)
{
    const struct br_tip_step *tip = &track->tip[br_history_find(track, t)];
    const double theta = fmin(fmax((t - tip->start) / tip->length, 0), 1);
    double value[S], factor[BR_HISTORY_ROWS] = {[S] = 1};
    br_legendre_integral(S, theta, value, factor);
    for (size_t k = 0; k < S; k++)
        factor[k] *= tip->length;
    if (q)
        br_combine(1, BR_HISTORY_ROWS, factor, track->modes, tip->values, q);
    if (v)
        br_combine(1, S, value, track->modes, tip->values, v);
    return br_tip_at(tip, theta);
}
