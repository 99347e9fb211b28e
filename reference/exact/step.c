/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/exact/march.h"

#include <cblas.h>
#include <float.h>
#include <lapacke.h>
#include <math.h>
#include <string.h>

enum { S = BR_STAGES };

enum br_status br_stepper_init(struct br_stepper *s, double gap, struct br_store *store,
                               struct br_error *err)
{
    const struct br_oscillators *field = s->field;
    const size_t m = field->modes.count;
    s->to = INFINITY;
    s->tip_displacement = field->tip_displacement - gap;
    s->tip_velocity = field->tip_velocity;
    s->q = br_store_take(store, m, sizeof *s->q);
    s->v = br_store_take(store, m, sizeof *s->v);
    s->series = br_store_take(store, m * S, sizeof *s->series);
    s->response = br_store_take(store, m * S * S, sizeof *s->response);
    s->load = br_store_take(store, m * S, sizeof *s->load);
    if (store->failed)
        return br_no_memory(err, "a time step");
    memcpy(s->q, field->displacement, m * sizeof *s->q);
    memcpy(s->v, field->velocity, m * sizeof *s->v);
    return br_radau_init(&s->radau, err);
}

/* r = (mass/h + damping X + stiffness h X^2) \ X, the velocity's response to a
 * force. Both sides are polynomials in X and commute, so that LAPACK may take
 * the rows for columns. */
static enum br_status respond_mode(const struct br_stepper *s, double mass, double *r,
                                   struct br_error *err)
{
    double a[S][S];
    lapack_int pivot[S];
    const struct br_radau *radau = &s->radau;
    for (size_t k = 0; k < S; k++)
        for (size_t j = 0; j < S; j++) {
            double square = 0;
            for (size_t l = k ? k - 1 : 0; l < S && l < k + 2; l++) /* X is tridiagonal */
                square += radau->integral[k][l] * radau->integral[l][j];
            a[k][j] = s->field->damping * radau->integral[k][j] +
                      s->field->stiffness * s->length * square + (k == j ? mass / s->length : 0);
        }
    memcpy(r, radau->integral, sizeof radau->integral);
    const lapack_int info = LAPACKE_dgesv_work(LAPACK_COL_MAJOR, S, S, &a[0][0], S, pivot, r, S);
    return info ? br_fail(err, BR_SINGULAR, "a mode has no mass, damping or stiffness") : BR_OK;
}

static enum br_status respond(struct br_stepper *s, double h, struct br_error *err)
{
    if (h == s->length)
        return BR_OK;
    const struct br_oscillators *f = s->field;
    double *z = &s->tip_response[0][0];
    double square = 0;
    memset(z, 0, sizeof s->tip_response);
    s->length = h;
    for (size_t i = 0; i < f->modes.count; i++) {
        double *r = &s->response[i * S * S];
        const enum br_status status = respond_mode(s, f->mass[i], r, err);
        if (status)
            return status;
        for (size_t k = 0; k < S * S; k++)
            z[k] += f->modes.tip[i] * f->modes.tip[i] * r[k];
        const double size = f->modes.size[i], gain = size * size * r[0];
        square += gain * gain;
    }
    s->noise_response = sqrt(f->length * square);
    return BR_OK;
}

/* out = load - damping v - stiffness (q + h X v), with the state's v all along
 * the step, so that what remains to be found is small */
static void residual(const struct br_stepper *s, size_t i, double out[S])
{
    const struct br_oscillators *f = s->field;
    const double reach = f->stiffness * s->length * s->v[i];
    double value[S];
    for (size_t j = 0; j < S; j++)
        value[j] = s->load[j * f->modes.count + i];
    br_radau_fit(&s->radau, value, out);
    out[0] -= f->damping * s->v[i] + f->stiffness * s->q[i] + reach * s->radau.integral[0][0];
    out[1] -= reach * s->radau.integral[1][0];
}

/* Sum of the modes' tip values. */
static double tip_sum(const struct br_stepper *s, const double *q)
{
    return cblas_ddot((int)s->field->modes.count, s->field->modes.tip, 1, q, 1);
}

/* The velocity that the tip's series starts from. A tip that sticks is held by
 * what the modes add up to, lest their rounding errors add up over the steps. */
static double tip_start(const struct br_stepper *s)
{
    return s->phase == BR_STICK ? tip_sum(s, s->v) : s->tip_velocity;
}

/* series = v + response (residual - tip force); the tip's velocity follows. */
static void move(struct br_stepper *s)
{
    const struct br_oscillators *f = s->field;
    double tip[S] = {tip_start(s)};
    for (size_t i = 0; i < f->modes.count; i++) {
        double r[S];
        residual(s, i, r);
        for (size_t k = 0; k < S; k++)
            r[k] -= f->modes.tip[i] * s->tip.force[k];
        for (size_t k = 0; k < S; k++) {
            const double gain = br_radau_sum(&s->response[(i * S + k) * S], r);
            s->series[i * S + k] = gain + (k ? 0 : s->v[i]);
            tip[k] += f->modes.tip[i] * gain;
        }
    }
    memcpy(s->tip.velocity, tip, sizeof tip);
}

/* The velocity that the largest of the stages' loads alone give in the step, in L2. */
static double impulse(const struct br_stepper *s)
{
    const size_t m = s->field->modes.count;
    double sum = 0;
    for (size_t i = 0; i < m; i++) {
        double most = 0;
        for (size_t j = 0; j < S; j++)
            most = fmax(most, fabs(s->load[j * m + i]));
        const double part = s->field->modes.size[i] * s->response[i * S * S] * most;
        sum += part * part;
    }
    return sqrt(s->field->length * sum);
}

enum br_status br_stepper_try(struct br_stepper *s, double h, struct br_error *err)
{
    const size_t m = s->field->modes.count;
    enum br_status status = respond(s, h, err);
    s->work += br_oscillators_work(s->field);
    s->load_noise = 0;
    for (size_t j = 0; j < S && !status; j++) {
        double size;
        const double t = fmin(fmax(s->time + s->radau.node[j] * h, s->from), s->to);
        status = br_oscillators_load(s->field, t, &s->load[j * m], &size, err);
        s->load_noise = fmax(s->load_noise, DBL_EPSILON * size * s->noise_response);
    }
    if (status)
        return status;
    s->impulse = impulse(s);
    s->load_noise += s->blur * s->impulse;
    s->tip = (struct br_tip_step){
        .start = s->time, .length = h, .phase = s->phase, .displacement = s->tip_displacement};
    move(s); /* as if the tip were free */
    s->free_size = br_oscillators_norm(s->field, s->series, S);
    for (int round = 0; round < (s->phase == BR_STICK ? 2 : 1) && !status; round++) {
        status = br_law_force(s->law, &s->radau, s->tip_response, &s->tip, err);
        move(s);
    }
    if (s->phase == BR_STICK)
        memset(s->tip.velocity, 0, sizeof s->tip.velocity);
    return status;
}

void br_stepper_accept(struct br_stepper *s, double time)
{
    for (size_t i = 0; i < s->field->modes.count; i++) {
        s->q[i] += s->tip.length * s->series[i * S]; /* the other p_k have no mean */
        s->v[i] = br_radau_sum(&s->series[i * S], s->radau.end);
    }
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
