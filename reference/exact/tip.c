/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/exact/march.h"

#include <lapacke.h>
#include <math.h>
#include <string.h>

enum { S = BR_STAGES };

double br_law_bound(const struct br_law *law, double t)
{
    switch (law->friction) {
    case BR_TRESCA:
        return law->coefficient;
    case BR_COULOMB:
        return law->coefficient * fmax(br_history_at(law->axial, t, NULL, NULL).displacement, 0);
    case BR_FRICTIONLESS:
        break;
    }
    return 0;
}

/* Whether friction can act just after t. */
static bool friction_acts(const struct br_law *law, double t)
{
    if (!(law->coefficient > 0) || law->friction == BR_FRICTIONLESS)
        return false;
    return law->friction == BR_TRESCA ||
           law->axial->tip[br_history_find(law->axial, t)].phase == BR_CLOSED;
}

enum br_phase br_law_phase(const struct br_law *law, double t, enum br_phase now,
                           double displacement, double velocity)
{
    if (law->contact) {
        if (!law->obstacle)
            return BR_FREE;
        return displacement > 0 || (displacement == 0 && velocity >= 0) ? BR_CLOSED : BR_OPEN;
    }
    if (!friction_acts(law, t))
        return BR_FREE;
    if (now != BR_FREE)
        return now;
    return velocity > 0 ? BR_SLIP_UP : velocity < 0 ? BR_SLIP_DOWN : BR_STICK;
}

enum br_phase br_law_next(const struct br_tip_state *tip)
{
    switch (tip->phase) {
    case BR_OPEN:
        return BR_CLOSED;
    case BR_CLOSED:
        return BR_OPEN;
    case BR_STICK: /* the force is against the slip that it could not hold */
        return tip->force > 0 ? BR_SLIP_UP : BR_SLIP_DOWN;
    case BR_SLIP_UP:
    case BR_SLIP_DOWN:
        return BR_STICK;
    case BR_FREE:
        break;
    }
    return BR_FREE;
}

double br_law_guard(const struct br_law *law, double t, const struct br_tip_state *tip)
{
    switch (tip->phase) {
    case BR_OPEN:
        return -tip->displacement;
    case BR_CLOSED:
        return tip->displacement;
    case BR_STICK:
        return br_law_bound(law, t) - fabs(tip->force);
    case BR_SLIP_UP:
        return tip->velocity;
    case BR_SLIP_DOWN:
        return -tip->velocity;
    case BR_FREE:
        break;
    }
    return INFINITY;
}

double br_law_force_at(const struct br_law *law, double t, const struct br_tip_state *tip)
{
    switch (tip->phase) {
    case BR_CLOSED:
        return law->stiffness * fmax(tip->displacement, 0);
    case BR_SLIP_UP:
        return br_law_bound(law, t);
    case BR_SLIP_DOWN:
        return -br_law_bound(law, t);
    case BR_STICK:
        return tip->force;
    case BR_FREE:
    case BR_OPEN:
        break;
    }
    return 0;
}

/* x = a \ x; a is destroyed */
static enum br_status solve(double a[S][S], double x[S], struct br_error *err)
{
    lapack_int pivot[S];
    const lapack_int info = LAPACKE_dgesv(LAPACK_ROW_MAJOR, S, 1, &a[0][0], S, pivot, x, 1);
    if (info == LAPACK_TRANSPOSE_MEMORY_ERROR || info == LAPACK_WORK_MEMORY_ERROR)
        return br_no_memory(err, "the tip's force");
    if (info < 0) /* LAPACKE looks for NaN */
        return br_fail(err, BR_NOT_FINITE, "the tip's force is not finite");
    return info ? br_fail(err, BR_SINGULAR, "the tip's force is not determined") : BR_OK;
}

/* force = c_H (d + h X (velocity - Z force)), d the tip less the gap */
static enum br_status close(const struct br_law *law, const struct br_radau *radau,
                            const double z[S][S], struct br_tip_step *tip, struct br_error *err)
{
    const double rate = law->stiffness * tip->length;
    double a[S][S] = {{0}};
    for (size_t k = 0; k < S; k++) {
        for (size_t l = 0; l < S; l++)
            for (size_t j = 0; j < S; j++)
                a[k][j] += rate * radau->integral[k][l] * z[l][j];
        a[k][k] += 1;
        tip->force[k] = rate * br_radau_sum(radau->integral[k], tip->velocity);
    }
    tip->force[0] += law->stiffness * tip->displacement;
    return solve(a, tip->force, err);
}

/* force += Z \ velocity, so that nothing is left of it */
static enum br_status stick(const double z[S][S], struct br_tip_step *tip, struct br_error *err)
{
    double a[S][S], change[S];
    memcpy(a, z, sizeof a);
    memcpy(change, tip->velocity, sizeof change);
    const enum br_status status = solve(a, change, err);
    for (size_t k = 0; k < S; k++)
        tip->force[k] += change[k];
    return status;
}

static void slip(const struct br_law *law, const struct br_radau *radau, struct br_tip_step *tip)
{
    const double sign = tip->phase == BR_SLIP_UP ? 1 : -1;
    double bound[S];
    for (size_t j = 0; j < S; j++)
        bound[j] = sign * br_law_bound(law, tip->start + radau->node[j] * tip->length);
    br_radau_fit(radau, bound, tip->force);
}

enum br_status br_law_force(const struct br_law *law, const struct br_radau *radau,
                            const double z[S][S], struct br_tip_step *tip, struct br_error *err)
{
    switch (tip->phase) {
    case BR_CLOSED:
        return close(law, radau, z, tip, err);
    case BR_STICK:
        return stick(z, tip, err);
    case BR_SLIP_UP:
    case BR_SLIP_DOWN:
        slip(law, radau, tip);
        break;
    case BR_FREE:
    case BR_OPEN:
        break;
    }
    return BR_OK;
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

static struct br_tip_state tip_at(const struct br_tip_step *tip, const struct moment *at)
{
    return (struct br_tip_state){
        .displacement = tip->displacement + tip->length * br_radau_sum(tip->velocity, at->integral),
        .velocity = br_radau_sum(tip->velocity, at->value),
        .force = br_radau_sum(tip->force, at->value),
        .phase = tip->phase,
    };
}

struct br_tip_state br_tip_at(const struct br_tip_step *tip, double theta)
{
    const struct moment at = moment_at(theta);
    return tip_at(tip, &at);
}

struct br_tip_state br_history_at(const struct br_history *track, double t, double *q, double *v)
{
    const size_t n = br_history_find(track, t), m = track->modes;
    const struct br_tip_step *tip = &track->tip[n];
    const struct moment at = moment_at(fmin(fmax((t - tip->start) / tip->length, 0), 1));
    double factor[BR_HISTORY_ROWS];
    for (size_t k = 0; k < S; k++)
        factor[k] = tip->length * at.integral[k];
    factor[S] = 1;
    if (q)
        br_combine(1, BR_HISTORY_ROWS, factor, m, tip->values, q);
    if (v)
        br_combine(1, S, at.value, m, tip->values, v);
    return tip_at(tip, &at);
}
