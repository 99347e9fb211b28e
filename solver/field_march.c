/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <string.h>

#include "solver/march_state.h"

/* ---- initial data ---- */

static enum br_status set_initial(struct br_field_march *part,
                                  const struct br_function *displacement,
                                  const struct br_function *displacement_slope,
                                  const struct br_function *velocity,
                                  const struct br_function *velocity_slope, struct br_error *err)
{
    if (br_function_is_zero(displacement) && br_function_is_zero(velocity))
        return BR_OK; /* a solver starts at rest */
    const size_t size = br_field_size(&part->field);
    double *nodal = br_allocate(2 * size, sizeof *nodal);
    if (!nodal)
        return br_no_memory(err, "the initial data");
    enum br_status status =
        br_interpolate(&part->field, displacement, displacement_slope, nodal, err);
    if (!status)
        status = br_interpolate(&part->field, velocity, velocity_slope, nodal + size, err);
    for (size_t i = 0; i < size && !status; i++)
        part->started_with =
            fmax(part->started_with, fmax(fabs(nodal[i]), part->field.k * fabs(nodal[size + i])));
    if (!status && !(part->started_with <= br_most_size))
        status = br_fail(
            err, BR_NOT_FINITE, "the %s initial data are as large as %g m, expected at most %g m",
            part->field.kind == BR_AXIAL ? "axial" : "bending", part->started_with, br_most_size);
    if (!status)
        part->solver->set(part->state, nodal, nodal + size);
    free(nodal);
    return status;
}

/* ---- what a scheme keeps ---- */

/* Whether Z is the state that the step begins with. */
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
    needed[BR_NOW] |= scheme->adaptive; /* to go back to */
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
    if (needed[BR_RATE]) /* which the end of the step makes */
        sum += passes(s.stage[s.count - 1].weight);
    return sum / s.count;
}

enum br_status br_field_march_create(struct br_field_march *part, const struct br_scene *s,
                                     const struct br_field *field, const struct br_method *method,
                                     struct br_error *err)
{
    const bool axial = field->kind == BR_AXIAL;
    part->modelled = axial ? s->axial.modelled : s->bending.modelled;
    part->field = *field;
    if (!part->modelled)
        return BR_OK;
    const struct br_linear_solver *row = br_method_solver(method, field);
    part->solver = br_linear_solver_for(row, field);
    enum br_status status = part->solver->create(row, field, &method->linear, &part->state, err);
    if (!status)
        status = br_step_load_init(&part->load, s, field, err);
    bool needed[BR_KNOWN] = {false};
    find_needed(method->scheme, needed);
    for (int i = 0; i < BR_KNOWN; i++)
        if (needed[i])
            part->slot[i] = ++part->kept;
    if (!status && part->kept)
        status = part->solver->keep(part->state, part->kept, err);
    if (status)
        return status;
    if (axial)
        return set_initial(part, &s->axial.displacement, NULL, &s->axial.velocity, NULL, err);
    return set_initial(part, &s->bending.displacement, &s->bending.displacement_slope,
                       &s->bending.velocity, &s->bending.velocity_slope, err);
}

void br_field_march_clear(struct br_field_march *part)
{
    if (part->solver)
        part->solver->free(part->state);
    br_step_load_clear(&part->load);
}

/* ---- a step ---- */

/* Copies a slot's state into the solver's, or the other way round. */
static void copy(struct br_field_march *part, size_t from, size_t into)
{
    double weight[BR_MOST_STATES] = {0};
    weight[from] = 1;
    part->solver->combine(part->state, into, (from > into ? from : into) + 1, weight);
}

void br_field_march_keep(struct br_field_march *part, int known)
{
    if (part->slot[known])
        copy(part, 0, part->slot[known]);
}

void br_field_march_recall(struct br_field_march *part, int known)
{
    copy(part, part->slot[known], 0);
}

/* Adds `factor` times the weights to those by slot. */
static void add_weights(const struct br_field_march *part, double factor,
                        const double weight[BR_KNOWN], double by_slot[BR_MOST_STATES])
{
    for (int i = 0; i < BR_KNOWN; i++)
        if (weight[i] != 0)
            by_slot[part->slot[i]] +=
                factor * weight[i] * (i == BR_RATE ? part->field.k / part->rate_tau : 1);
}

enum br_status br_field_march_start_stage(struct br_field_march *part,
                                          const struct br_stages *stages, int i, double k,
                                          struct br_error *err)
{
    const struct br_stage *stage = &stages->stage[i];
    const double tau = stage->gamma * k;
    if (tau != part->field.k) {
        part->counts.set_ups++;
        part->field.k = tau;
        const enum br_status status = part->solver->set_step(part->state, tau, err);
        if (status)
            return status;
    }
    if (i == 0 && starts_now(stage)) {
        br_field_march_keep(part, BR_NOW);
        return BR_OK;
    }
    /* What the solver has becomes a state that is kept, without a copy. */
    part->solver->exchange(part->state, 0, part->slot[i == 0 ? BR_NOW : BR_STAGE + i - 1]);
    double by_slot[BR_MOST_STATES] = {0};
    add_weights(part, 1, stage->weight, by_slot);
    part->solver->combine(part->state, 0, part->kept + 1, by_slot);
    return BR_OK;
}

/* The largest nodal force of a load whose vector is zero: the load may be so small that its
 * products with h are lost. */
static long double lost_force(const struct br_field_march *part, double t)
{
    enum { PLACES = 64 };
    const struct br_step_load *load = &part->load;
    double x[PLACES], value[PLACES], most = 0;
    for (int i = 0; i < PLACES; i++)
        x[i] = (i + 0.5) / PLACES * (double)part->field.n * part->field.h;
    for (size_t term = 0; term < load->terms; term++) {
        br_function_evaluate(&load->functions.term[term].space, PLACES, x, t, value);
        for (int i = 0; i < PLACES; i++) /* a sum has the factors in its vector */
            most = fmax(most, fabs(value[i]) * (load->sum ? fabs(load->factor[term]) : 1));
    }
    return (long double)most * part->field.h;
}

/* The largest of some magnitudes; NaN is none. In lanes, which the compiler finds. */
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

/* What the largest force is, for br_march_check_range. */
static void see_load(struct br_field_march *part, double t)
{
    const struct br_drive *drive = &part->load.drive;
    if (drive->vector && drive->changed) {
        const double most = largest_of(drive->vector, br_field_size(&part->field));
        part->load_size = most > 0 ? most : lost_force(part, t);
    }
    const long double force[] = {part->load_size * fabs(drive->factor), fabs(drive->tip[0]),
                                 fabs(drive->tip[1])};
    for (int i = 0; i < 3; i++) /* fmaxl would be a call in every step */
        if (force[i] > part->moved_by)
            part->moved_by = force[i];
}

enum br_status br_field_march_predict(struct br_field_march *part, double t, double *velocity,
                                      struct br_error *err)
{
    const enum br_status status = br_step_load_update(&part->load, &part->field, t, err);
    if (status)
        return status;
    see_load(part, t);
    if (!(part->moved_by <= br_most_size))
        return br_fail(err, BR_NOT_FINITE,
                       "the %s load at t = %g s has a nodal force of %Lg N, "
                       "expected at most %g",
                       part->field.kind == BR_AXIAL ? "axial" : "bending", t, part->moved_by,
                       br_most_size);
    part->counts.stages++;
    const enum br_status predicted =
        part->solver->predict(part->state, &part->load.drive, velocity, err);
    part->load.drive.changed = false;
    return predicted;
}

void br_field_march_accept(struct br_field_march *part, const struct br_stages *stages,
                           bool switched)
{
    static const int history[] = {BR_NOW, BR_BEFORE, BR_BEFORE_THAT};
    if (part->slot[BR_RATE] && !switched) { /* tau Y': what its last stage has added to its start */
        double by_slot[BR_MOST_STATES] = {1};
        add_weights(part, -1, stages->stage[stages->count - 1].weight, by_slot);
        part->solver->combine(part->state, part->slot[BR_RATE], part->kept + 1, by_slot);
        part->rate_tau = part->field.k;
    }
    for (int i = 2; i > 0; i--) { /* the oldest makes room for what begins the next step */
        size_t *newer = &part->slot[history[i - 1]], *older = &part->slot[history[i]], old = *older;
        if (old) {
            *older = *newer;
            *newer = old;
        }
    }
    part->since = switched ? 0 : part->since + 1;
    part->counts.steps++;
}

/* The strain that a strain rate of 1/s leads to without loads, s: that of the lowest mode, which
 * swings or creeps there. */
static double reach_of_rate(const struct br_field *f)
{
    const double number = br_field_lowest_mode(f);
    if (f->density == 0)
        return 0; /* a rate that inertia does not keep leads nowhere */
    const double swing = f->stiffness > 0 ? sqrt(f->density / (f->stiffness * number)) : INFINITY;
    const double creep = f->viscosity > 0 ? f->density / (f->viscosity * number) : INFINITY;
    return fmin(swing, creep);
}

void br_field_march_estimate(struct br_field_march *part, const struct br_stages *stages,
                             double *error, double *state)
{
    const int last = BR_STAGE + stages->count - 1; /* which the solver still has */
    /* A start may have a tip that moves and now sticks: that is no error, and no step is shorter.
     */
    const double reach = part->since > 0 ? reach_of_rate(&part->field) : 0;
    double size[2], by_slot[BR_MOST_STATES] = {0}, weight[BR_KNOWN];
    memcpy(weight, stages->error, sizeof weight);
    by_slot[0] = weight[last];
    weight[last] = 0;
    add_weights(part, 1, weight, by_slot);
    part->solver->combine(part->state, part->slot[last], part->kept + 1, by_slot);
    part->solver->size(part->state, part->slot[last], size);
    *error = fmax(size[0], reach > 0 ? reach * size[1] : 0);
    part->solver->size(part->state, 0, size);
    *state = size[0];
}
