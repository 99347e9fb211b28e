/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One step of a field: its velocity is the series v + r, and each mode's r = X x, where
 *     (mass/h + damping X + stiffness h X^2) x = rest - tip force. */
#include "reference/exact/inside.h"

#include <cblas.h>
#include <float.h>
#include <math.h>
#include <string.h>

enum { S = BR_STAGES };

enum br_status br_stepper_init(struct br_stepper *s, double gap, struct br_store *store,
                               struct br_error *err)
{
    const struct br_oscillators *field = s->field;
    const size_t m = field->modes.count, width = s->system.width = field->modes.width;
    s->to = INFINITY;
    s->tip_displacement = field->tip_displacement - gap;
    s->tip_velocity = field->tip_velocity;
    s->q = br_store_take(store, width, sizeof *s->q);
    s->v = br_store_take(store, width, sizeof *s->v);
    s->series = br_store_take(store, width * S, sizeof *s->series);
    s->system.a = br_store_take(store, width, sizeof *s->system.a);
    s->system.pivot = br_store_take(store, 2 * width * S, sizeof *s->system.pivot);
    s->gain = br_store_take(store, width, sizeof *s->gain);
    s->load = br_store_take(store, width * S, sizeof *s->load);
    s->rest = br_store_take(store, width * S, sizeof *s->rest);
    if (store->failed)
        return br_no_memory(err, "a time step");
    memcpy(s->q, field->displacement, m * sizeof *s->q);
    memcpy(s->v, field->velocity, m * sizeof *s->v);
    return br_radau_init(&s->radau, err);
}

/* Sum of the modes' tip values. */
static double tip_sum(const struct br_stepper *s, const double *x)
{
    return br_sum_products(s->system.width, s->field->modes.tip, x);
}

/* ---- responses ---- */

/* 1 / (stiffness h), which multiplies the equations. A negligible one replaces a stiffness of 0. */
static double weight(const struct br_stepper *s)
{
    return 1 / (s->field->stiffness * s->length + 1e-30 * s->field->damping);
}

/* Sums over the modes of tip^2 times the responses to a force's coefficients j, for phases that
 * need them: those below the diagonal, X' is X with changed signs of k + j. */
static void respond_tip(struct br_stepper *s)
{
    const size_t width = s->system.width;
    const double *tip = s->field->modes.tip;
    double *x = s->series;
    if ((s->phase != BR_CLOSED && s->phase != BR_STICK) || s->tip_length == s->length)
        return;
    s->tip_length = s->length;
    for (size_t j = 0; j < S; j++) {
        memset(x + j * width, 0, (S - j) * width * sizeof *x);
        for (size_t i = 0; i < width; i++)
            x[j * width + i] = tip[i] * weight(s);
        br_stage_solve(&s->system, j, x);
        for (size_t k = j; k < S; k++) {
            s->tip_response[k][j] = tip_sum(s, &x[k * width]);
            s->tip_response[j][k] = (k + j) % 2 ? -s->tip_response[k][j] : s->tip_response[k][j];
        }
    }
}

static void respond(struct br_stepper *s, double h)
{
    if (h == s->length)
        return;
    const struct br_oscillators *f = s->field;
    const size_t width = s->system.width;
    double square = 0;
    s->length = h;
    s->system.b = f->damping * weight(s);
    for (size_t i = 0; i < width; i++)
        s->system.a[i] = f->mass[i] / h * weight(s);
    br_stage_factor(&s->system, &s->radau);
    memset(s->series, 0, S * width * sizeof *s->series);
    for (size_t i = 0; i < width; i++)
        s->series[i] = weight(s);
    br_stage_solve(&s->system, 0, s->series);
    memcpy(s->gain, s->series, width * sizeof *s->gain);
    for (size_t i = 0; i < f->modes.count; i++) {
        const double size = f->modes.size[i], gain = size * size * s->gain[i];
        square += gain * gain;
    }
    s->noise_response = sqrt(f->length * square);
}

/* rest = load - damping v - stiffness (q + h X v), with the state's v all along the step, so that
 * what remains to be found is small */
static void set_rest(struct br_stepper *s)
{
    const struct br_oscillators *f = s->field;
    const size_t width = s->system.width;
    br_combine(S, S, &s->radau.to_coefficients[0][0], width, s->load, s->rest);
    for (size_t i = 0; i < width; i++) {
        const double reach = f->stiffness * s->length * s->v[i];
        s->rest[i] -=
            f->damping * s->v[i] + f->stiffness * s->q[i] + reach * s->radau.integral[0][0];
        s->rest[width + i] -= reach * s->radau.integral[1][0];
    }
}

/* The velocity that the tip's series starts from. For a tip that sticks it is the sum over the
 * modes, so that their rounding errors do not add up over the steps. */
static double tip_start(const struct br_stepper *s)
{
    return s->phase == BR_STICK ? tip_sum(s, s->v) : s->tip_velocity;
}

/* series = v + response (rest - tip force); the tip's velocity follows. */
static void move(struct br_stepper *s)
{
    const size_t width = s->system.width;
    const double *tip = s->field->modes.tip, factor = weight(s);
    for (size_t k = 0; k < S; k++) {
        double *x = &s->series[k * width], force = s->tip.force[k];
        for (size_t i = 0; i < width; i++)
            x[i] = (s->rest[k * width + i] - tip[i] * force) * factor;
    }
    br_stage_solve(&s->system, 0, s->series);
    for (size_t k = 0; k < S; k++)
        s->tip.velocity[k] = tip_sum(s, &s->series[k * width]);
    s->tip.velocity[0] += tip_start(s);
    for (size_t i = 0; i < width; i++)
        s->series[i] += s->v[i];
}

/* The velocity that the largest of the stages' loads alone give in the step, in L2. */
static double impulse(struct br_stepper *s)
{
    const size_t width = s->system.width;
    double *most = s->series;
    memset(most, 0, width * sizeof *most);
    for (size_t j = 0; j < S; j++)
        for (size_t i = 0; i < width; i++) {
            const double size = fabs(s->load[j * width + i]);
            most[i] = size > most[i] ? size : most[i];
        }
    for (size_t i = 0; i < width; i++)
        most[i] *= s->gain[i];
    return br_oscillators_norm(s->field, most);
}

/* ---- the force at the tip ---- */

/* x = a \ x; a is destroyed */
static enum br_status solve(double a[S][S], double x[S], struct br_error *err)
{
    switch (br_radau_solve(a, 1, x)) {
    case BR_OK:
        return BR_OK;
    case BR_NOT_FINITE:
        return br_fail(err, BR_NOT_FINITE, "the tip's force is not finite");
    default:
        return br_fail(err, BR_SINGULAR, "the tip's force is not determined");
    }
}

/* force = c_H (d + h X (velocity - Z force)), d the tip less the gap */
static enum br_status close(const struct br_exact_law *law, const struct br_radau *radau,
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

static void slip(const struct br_exact_law *law, const struct br_radau *radau,
                 struct br_tip_step *tip)
{
    const double sign = tip->phase == BR_SLIP_UP ? 1 : -1;
    double bound[S];
    for (size_t j = 0; j < S; j++)
        bound[j] = sign * br_law_bound(law, tip->start + radau->node[j] * tip->length);
    br_radau_fit(radau, bound, tip->force);
}

/* tip->force (in: zero; out): series of the force over a step, from the velocity
 * tip->velocity that the tip has without it, and the velocity's response z (row
 * by row) to the force's coefficients. While the tip sticks, a second call with
 * the velocity that is left improves the force. Fails with BR_SINGULAR
 * or BR_NOT_FINITE. */
static enum br_status set_force(const struct br_exact_law *law, const struct br_radau *radau,
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

/* ---- the step ---- */

enum br_status br_stepper_try(struct br_stepper *s, double h, struct br_error *err)
{
    double size, t[S];
    s->work += br_oscillators_work(s->field);
    respond(s, h);
    respond_tip(s);
    for (size_t j = 0; j < S; j++)
        t[j] = fmin(fmax(s->time + s->radau.node[j] * h, s->from), s->to);
    enum br_status status = br_oscillators_load(s->field, t, s->load, &size, err);
    if (status)
        return status;
    s->impulse = impulse(s);
    s->load_noise = DBL_EPSILON * size * s->noise_response + s->blur * s->impulse;
    s->tip = (struct br_tip_step){
        .start = s->time, .length = h, .phase = s->phase, .displacement = s->tip_displacement};
    set_rest(s);
    move(s); /* as if the tip were free */
    s->free_size = br_oscillators_norm(s->field, s->series);
    for (int round = 0; round < (s->phase == BR_STICK ? 2 : 1) && !status; round++) {
        status = set_force(s->law, &s->radau, s->tip_response, &s->tip, err);
        move(s);
    }
    if (s->phase == BR_STICK)
        memset(s->tip.velocity, 0, sizeof s->tip.velocity);
    return status;
}

void br_stepper_accept(struct br_stepper *s, double time)
{
    for (size_t i = 0; i < s->system.width; i++)
        s->q[i] += s->tip.length * s->series[i]; /* the other p_k have no mean */
    br_combine(1, S, s->radau.end, s->system.width, s->series, s->v);
    s->tip_displacement += s->tip.length * s->tip.velocity[0];
    s->tip_velocity = br_radau_sum(s->tip.velocity, s->radau.end);
    s->time = time;
}

void br_stepper_settle(struct br_stepper *s)
{
    const struct br_modes *modes = &s->field->modes;
    if (s->phase == BR_OPEN || s->phase == BR_CLOSED)
        s->tip_displacement = 0;
    if (s->phase != BR_SLIP_UP && s->phase != BR_SLIP_DOWN)
        return;
    /* Taken out of the modes in the shape of a static load at the tip: as an
     * impulse, the rounding error would make the tip slip again. */
    const double rest = tip_sum(s, s->v) / tip_sum(s, modes->tip);
    cblas_daxpy((int)modes->count, -rest, modes->tip, 1, s->v, 1);
    s->tip_velocity = 0;
}
