/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <string.h>

#include "solver/march_state.h"

/* ---- initial data ---- */

static enum br_status set_initial(struct br_field_march *fm, const struct br_scene_field *data,
                                  struct br_error *err)
{
    if (br_function_is_zero(&data->displacement) && br_function_is_zero(&data->velocity))
        return BR_OK; /* a solver starts at rest */
    const size_t size = br_field_size(&fm->field);
    double *nodal = br_allocate(2 * size, sizeof *nodal);
    if (!nodal)
        return br_no_memory(err, "the initial data");
    enum br_status status =
        br_interpolate(&fm->field, &data->displacement, &data->displacement_slope, nodal, err);
    if (!status)
        status =
            br_interpolate(&fm->field, &data->velocity, &data->velocity_slope, nodal + size, err);
    for (size_t i = 0; i < size && !status; i++)
        fm->started_with =
            fmax(fm->started_with, fmax(fabs(nodal[i]), fm->field.k * fabs(nodal[size + i])));
    if (!status && !(fm->started_with <= br_most_size))
        status = br_fail(err, BR_NOT_FINITE,
                         "the %s initial data are as large as %g m, expected at most %g m",
                         br_field_names[fm->field.kind], fm->started_with, br_most_size);
    if (!status)
        fm->solver->set(fm->state, nodal, nodal + size);
    free(nodal);
    return status;
}

/* ---- what a scheme keeps ---- */

/* Whether Z is the state at the start of the step. */
static bool starts_now(const struct br_stage *stage)
{
    for (int i = 0; i < BR_KNOWN; i++)
        if (stage->weight[i] != (i == BR_NOW))
            return false;
    return true;
}

/* Which states the steps of a scheme use. */
static void find_needed(const struct br_time_scheme *scheme, bool needed[BR_KNOWN])
{
    for (size_t since = 0; since < 3; since++) {
        struct br_stages s;
        br_time_scheme_step(scheme, since, &s);
        for (int known = 0; known < BR_KNOWN; known++) {
            needed[known] |= s.error[known] != 0;
            for (int i = 0; i < s.count; i++)
                needed[known] |= s.stage[i].weight[known] != 0 && (i > 0 || !starts_now(s.stage));
        }
    }
    needed[BR_NOW] |= scheme->adaptive; /* rejected steps return to it */
    needed[BR_NOW] |= needed[BR_BEFORE];
}

int br_time_scheme_kept(const struct br_time_scheme *scheme)
{
    bool needed[BR_KNOWN] = {false};
    int kept = 0;
    if (scheme->form[2])
        find_needed(scheme, needed);
    for (int i = 0; i < BR_KNOWN; i++)
        kept += needed[i];
    return kept;
}

static double passes(const double weight[BR_KNOWN])
{
    const double a_state = 0.2; /* as measured */
    double sum = 1;
    for (int i = 0; i < BR_KNOWN; i++)
        sum += weight[i] != 0 ? a_state : 0;
    return sum;
}

double br_time_scheme_sums(const struct br_time_scheme *scheme)
{
    struct br_stages s;
    bool needed[BR_KNOWN] = {false};
    double sum = 0;
    find_needed(scheme, needed);
    br_time_scheme_step(scheme, 2, &s);
    for (int i = 0; i < s.count; i++)
        if (i > 0 || !starts_now(&s.stage[i]))
            sum += passes(s.stage[i].weight);
    if (needed[BR_RATE]) /* which the end of the step computes */
        sum += passes(s.stage[s.count - 1].weight);
    return sum / s.count;
}

enum br_status br_field_march_create(struct br_field_march *fm, const struct br_scene *s,
                                     const struct br_field *field, const struct br_method *method,
                                     struct br_error *err)
{
    fm->modelled = s->field[field->kind].modelled;
    fm->field = *field;
    if (!fm->modelled)
        return BR_OK;
    const struct br_linear_solver *row = br_method_solver(method, field);
    fm->solver = br_linear_solver_for(row, field);
    enum br_status status = fm->solver->create(field, method->kernel, &fm->state, err);
    if (!status)
        status = br_step_load_init(&fm->load, s, field, err);
    bool needed[BR_KNOWN] = {false};
    find_needed(method->scheme, needed);
    for (int i = 0; i < BR_KNOWN; i++)
        if (needed[i])
            fm->buffer[i] = ++fm->kept;
    if (!status && fm->kept)
        status = fm->solver->keep(fm->state, fm->kept, err);
    return status ? status : set_initial(fm, &s->field[field->kind], err);
}

void br_field_march_clear(struct br_field_march *fm)
{
    if (fm->solver)
        fm->solver->free(fm->state);
    br_step_load_clear(&fm->load);
}

/* ---- a step ---- */

/* Copies a kept state into the solver's, or the solver's into a kept one. */
static void copy(struct br_field_march *fm, size_t from, size_t into)
{
    double weight[BR_MOST_STATES] = {0};
    weight[from] = 1;
    fm->solver->combine(fm->state, into, (from > into ? from : into) + 1, weight);
}

void br_field_march_keep(struct br_field_march *fm, int known)
{
    if (fm->buffer[known])
        copy(fm, 0, fm->buffer[known]);
}

void br_field_march_recall(struct br_field_march *fm, int known)
{
    copy(fm, fm->buffer[known], 0);
}

/* Adds `factor` times the weights to the weights by the solver's index. */
static void add_weights(const struct br_field_march *fm, double factor,
                        const double weight[BR_KNOWN], double by_buffer[BR_MOST_STATES])
{
    for (int i = 0; i < BR_KNOWN; i++)
        if (weight[i] != 0)
            by_buffer[fm->buffer[i]] +=
                factor * weight[i] * (i == BR_RATE ? fm->field.k / fm->rate_tau : 1);
}

enum br_status br_field_march_start_stage(struct br_field_march *fm, const struct br_stages *stages,
                                          int i, double k, struct br_error *err)
{
    const struct br_stage *stage = &stages->stage[i];
    const double tau = stage->gamma * k;
    if (tau != fm->field.k) {
        fm->counts.set_ups++;
        fm->field.k = tau;
        const enum br_status status = fm->solver->set_step(fm->state, tau, err);
        if (status)
            return status;
    }
    if (i == 0 && starts_now(stage)) {
        br_field_march_keep(fm, BR_NOW);
        return BR_OK;
    }
    /* The solver's state becomes a kept one, without a copy. */
    fm->solver->exchange(fm->state, 0, fm->buffer[i == 0 ? BR_NOW : BR_STAGE + i - 1]);
    double by_buffer[BR_MOST_STATES] = {0};
    add_weights(fm, 1, stage->weight, by_buffer);
    fm->solver->combine(fm->state, 0, fm->kept + 1, by_buffer);
    return BR_OK;
}

/* The largest nodal force of a load whose vector is zero: the load may be so small that its
 * products with h underflow. */
static long double lost_force(const struct br_field_march *fm, double t)
{
    const struct br_step_load *load = &fm->load;
    double most = 0; /* the vector of a sum contains the factors */
    for (size_t i = 0; i < load->terms; i++)
        most = fmax(most, br_load_peak(&fm->field, &load->functions.term[i].space, t) *
                              (load->sum ? fabs(load->factor[i]) : 1));
    return (long double)most * fm->field.h;
}

/* The largest of some magnitudes; NaN is ignored. In lanes, so that the compiler uses vectors. */
static double largest_of(const double *value, size_t size)
{
    enum { LANES = 8 };
    double most[LANES] = {0};
    for (size_t i = 0; i < size / LANES * LANES; i += LANES)
        for (size_t l = 0; l < LANES; l++)
            most[l] = fabs(value[i + l]) > most[l] ? fabs(value[i + l]) : most[l];
    for (size_t i = size / LANES * LANES; i < size; i++)
        most[0] = fabs(value[i]) > most[0] ? fabs(value[i]) : most[0];
    for (size_t l = 1; l < LANES; l++)
        most[0] = most[l] > most[0] ? most[l] : most[0];
    return most[0];
}

/* Updates the largest nodal force, for br_march_check_range. */
static void record_load(struct br_field_march *fm, double t)
{
    const struct br_drive *drive = &fm->load.drive;
    if (drive->vector && drive->changed) {
        const double most = largest_of(drive->vector, br_field_size(&fm->field));
        fm->load_size = most > 0 ? most : lost_force(fm, t);
    }
    const long double force[] = {fm->load_size * fabs(drive->factor), fabs(drive->tip[0]),
                                 fabs(drive->tip[1])};
    for (int i = 0; i < 3; i++) /* fmaxl would be a call in every step */
        if (force[i] > fm->moved_by)
            fm->moved_by = force[i];
}

enum br_status br_field_march_predict(struct br_field_march *fm, double t, double *velocity,
                                      struct br_error *err)
{
    const enum br_status status = br_step_load_update(&fm->load, &fm->field, t, err);
    if (status)
        return status;
    record_load(fm, t);
    if (!(fm->moved_by <= br_most_size))
        return br_fail(err, BR_NOT_FINITE,
                       "the %s load at t = %g s has a nodal force of %Lg N, "
                       "expected at most %g",
                       br_field_names[fm->field.kind], t, fm->moved_by, br_most_size);
    fm->counts.stages++;
    const enum br_status predicted = fm->solver->predict(fm->state, &fm->load.drive, velocity, err);
    fm->load.drive.changed = false;
    return predicted;
}

void br_field_march_accept(struct br_field_march *fm, const struct br_stages *stages, bool switched)
{
    static const int history[] = {BR_NOW, BR_BEFORE, BR_BEFORE_THAT};
    if (fm->buffer[BR_RATE] && !switched) { /* tau Y' = Y - Z of the last stage */
        double by_buffer[BR_MOST_STATES] = {1};
        add_weights(fm, -1, stages->stage[stages->count - 1].weight, by_buffer);
        fm->solver->combine(fm->state, fm->buffer[BR_RATE], fm->kept + 1, by_buffer);
        fm->rate_tau = fm->field.k;
    }
    for (int i = 2; i > 0; i--) { /* the next step's start overwrites the oldest */
        size_t *newer = &fm->buffer[history[i - 1]], *older = &fm->buffer[history[i]], old = *older;
        if (old) {
            *older = *newer;
            *newer = old;
        }
    }
    fm->since = switched ? 0 : fm->since + 1;
    fm->counts.steps++;
}

/* The strain that a strain rate of 1/s leads to without loads, s, in the lowest mode, which swings
 * or creeps. */
static double reach_of_rate(const struct br_field *f)
{
    const double number = br_field_lowest_mode(f);
    if (f->density == 0)
        return 0; /* a rate that inertia does not keep leads nowhere */
    const double swing = f->stiffness > 0 ? sqrt(f->density / (f->stiffness * number)) : INFINITY;
    const double creep = f->viscosity > 0 ? f->density / (f->viscosity * number) : INFINITY;
    return fmin(swing, creep);
}

void br_field_march_estimate(struct br_field_march *fm, const struct br_stages *stages,
                             double *error, double *state)
{
    const int last = BR_STAGE + stages->count - 1; /* which is still the solver's state */
    /* In the first step after a start a moving tip may have come to stick: that jump of the rate is
     * no error, and shorter steps would not reduce it. */
    const double reach = fm->since > 0 ? reach_of_rate(&fm->field) : 0;
    double size[2], by_buffer[BR_MOST_STATES] = {0}, weight[BR_KNOWN];
    memcpy(weight, stages->error, sizeof weight);
    by_buffer[0] = weight[last];
    weight[last] = 0;
    add_weights(fm, 1, weight, by_buffer);
    fm->solver->combine(fm->state, fm->buffer[last], fm->kept + 1, by_buffer);
    fm->solver->size(fm->state, fm->buffer[last], size);
    *error = fmax(size[0], reach > 0 ? reach * size[1] : 0);
    fm->solver->size(fm->state, 0, size);
    *state = size[0];
}
