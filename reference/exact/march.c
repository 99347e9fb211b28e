/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/exact/march.h"

#include <cblas.h>
#include <float.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_roots.h>
#include <math.h>
#include <string.h>

enum { S = BR_STAGES, SAMPLES = 24, MAX_ROOT_STEPS = 60, MAX_PHASES_AT_ONCE = 4 };

enum br_status br_effort_spend(struct br_effort *effort, double work, struct br_error *err)
{
    const struct br_exact_options *who = effort->who;
    effort->done += work;
    if (who->stop && who->stop(who->stop_self))
        return br_fail(err, BR_INTERRUPTED, "interrupted");
    if (who->progress)
        who->progress(who->stop_self, fmin(effort->done / effort->most, 1));
    if (!(effort->done <= effort->most))
        return br_fail(
            err, BR_NOT_FINITE,
            "more work than is allowed, some 20 s of a core, does not make two solutions agree");
    return BR_OK;
}

/* ---- one step ----
 *
 * A step's velocity is the series v + r, and each mode's r = X x, where
 *     (mass/h + damping X + stiffness h X^2) x = rest - tip force. */

/* A field at one time. The tip's own values are carried along by increments,
 * and set when an event fixes them: summed over modes they would lose what is
 * small just after an event. */
struct stepper {
    const struct br_oscillators *field; /* borrowed */
    const struct br_law *law;           /* borrowed */
    struct br_radau radau;

    double time;     /* s */
    double from, to; /* s: the load is taken between these, where it does not jump */
    double blur;     /* of the load: what the rounding of t does to it, relative */
    enum br_phase phase;
    double *q, *v;                         /* modes: m, m/s */
    double tip_displacement, tip_velocity; /* less the gap, m, m/s */

    struct br_tip_step tip; /* the last trial step */
    double *series;         /* BR_STAGES x width of the modes: its velocity, m/s */
    double free_size;       /* m^(3/2)/s: mean velocity in L2 as if the tip were free: where a tip
                               force cancels it, its round-off is what remains */

    double work; /* of the trial steps, see br_effort; whoever reads it sets it to zero */

    double length;                 /* s, of the step that the responses are for */
    struct br_stage_system system; /* of this length, over stiffness h */
    double *gain;      /* width: mean velocity in a step over a constant force, m/(N s) */
    double tip_length; /* s, of the step that this is for: only phases that need it have it */
    double tip_response[BR_STAGES][BR_STAGES]; /* velocity over force, m/(N s) */
    double *load;                              /* BR_STAGES x width, at the stages, N */
    double *rest;          /* the same size: series of what the state leaves of it, N */
    double load_noise;     /* m^(3/2)/s: what a load's round-off may do to the velocity, in L2 */
    double impulse;        /* m^(3/2)/s: velocity that the loads alone give in the step, in L2 */
    double noise_response; /* the same of a load of 1 N of every shape */
};

/* s: in, with its field and law, all else zero; gap in m. Starts at t = 0. Fails with BR_NO_MEMORY.
 */
static enum br_status stepper_init(struct stepper *s, double gap, struct br_store *store,
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
static double tip_sum(const struct stepper *s, const double *x)
{
    return br_sum_products(s->system.width, s->field->modes.tip, x);
}

/* ---- responses ---- */

/* 1 / (stiffness h), by which the equations are multiplied. Without stiffness one that does not
 * count takes its place. */
static double weight(const struct stepper *s)
{
    return 1 / (s->field->stiffness * s->length + 1e-30 * s->field->damping);
}

/* Sums over the modes of tip^2 times the responses to a force's coefficients j, for phases that
 * need them: those below the diagonal, X' is X with changed signs of k + j. */
static void respond_tip(struct stepper *s)
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

static void respond(struct stepper *s, double h)
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
static void set_rest(struct stepper *s)
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

/* The velocity that the tip's series starts from. A tip that sticks is held by
 * what the modes add up to, lest their rounding errors add up over the steps. */
static double tip_start(const struct stepper *s)
{
    return s->phase == BR_STICK ? tip_sum(s, s->v) : s->tip_velocity;
}

/* series = v + response (rest - tip force); the tip's velocity follows. */
static void move(struct stepper *s)
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
static double impulse(struct stepper *s)
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

/* Sets tip and series to a step of length h from the current state, which stays.
 * Fails with BR_NO_MEMORY, BR_SINGULAR or BR_NOT_FINITE. */
static enum br_status stepper_try(struct stepper *s, double h, struct br_error *err)
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
        status = br_law_force(s->law, &s->radau, s->tip_response, &s->tip, err);
        move(s);
    }
    if (s->phase == BR_STICK)
        memset(s->tip.velocity, 0, sizeof s->tip.velocity);
    return status;
}

/* Moves the state to the end of the last trial step, called `time`. */
static void stepper_accept(struct stepper *s, double time)
{
    for (size_t i = 0; i < s->system.width; i++)
        s->q[i] += s->tip.length * s->series[i]; /* the other p_k have no mean */
    br_combine(1, S, s->radau.end, s->system.width, s->series, s->v);
    s->tip_displacement += s->tip.length * s->tip.velocity[0];
    s->tip_velocity = br_radau_sum(s->tip.velocity, s->radau.end);
    s->time = time;
}

/* Sets exactly what the end of the state's phase fixes: the tip's displacement
 * where a contact opens or closes, its velocity where a slip ends. */
static void stepper_settle(struct stepper *s)
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

/* ---- the march ---- */

/* A guard this far below zero, of the largest value so far, is round-off. */
static const double dead_band = 1e-13;

/* Largest values so far. */
struct scale {
    double displacement, velocity; /* L2 norms over the beam */
    double tip_displacement, tip_velocity, force;
};

struct march {
    const struct br_march_options *options;
    struct stepper *s;
    struct br_history *track;
    struct scale scale; /* of the accepted steps */
    double h;           /* s, the next step's length */
    bool fresh;         /* the next step is the first of a phase */
    size_t at_once;     /* phases begun at the present time */
    enum br_status status;
    struct br_error *err;
};

static double larger(double a, double b)
{
    return isnan(a) || a >= b ? a : b; /* NaN wins */
}

/* The scale with the trial step's end. */
static struct scale trial_scale(const struct march *m)
{
    const struct stepper *s = m->s;
    const struct br_oscillators *f = s->field;
    const struct br_tip_state end = br_tip_at(&s->tip, 1);
    struct scale scale = m->scale;
    scale.displacement = larger(scale.displacement, br_oscillators_norm(f, s->q));
    scale.velocity = larger(scale.velocity, br_oscillators_norm(f, s->series)); /* its mean */
    scale.tip_displacement = larger(scale.tip_displacement, fabs(end.displacement));
    scale.tip_velocity = larger(scale.tip_velocity, fabs(end.velocity));
    scale.force = larger(scale.force, fabs(end.force));
    return scale;
}

static double ratio(double error, double scale)
{
    return error == 0 ? 0 : error / scale;
}

/* The force over a very short step cannot be known better than the velocity's
 * round-off over the velocity's response to it. */
static double force_noise(const struct march *m, const struct scale *scale)
{
    const double response = fabs(m->s->tip_response[S - 1][S - 1]);
    return 10 * DBL_EPSILON * scale->velocity / sqrt(m->s->field->length) / response;
}

/* What the trial step leaves unresolved, over what is allowed: the last two
 * coefficients of its polynomials. */
static double step_error(const struct march *m, const struct scale *scale)
{
    const struct stepper *s = m->s;
    const size_t width = s->system.width;
    const double last = br_oscillators_norm(s->field, s->series + (S - 1) * width);
    const double before = br_oscillators_norm(s->field, s->series + (S - 2) * width);
    const double velocity = larger(last, before / 8);
    const double force = larger(fabs(s->tip.force[S - 1]), fabs(s->tip.force[S - 2]) / 8);
    const double noise = 10 * (DBL_EPSILON * s->free_size + s->load_noise) / m->options->tolerance;
    double error =
        ratio(velocity * s->tip.length, scale->displacement + (velocity + noise) * s->tip.length);
    error = larger(error, ratio(velocity, scale->velocity + noise));
    if (s->phase == BR_CLOSED || s->phase == BR_STICK) /* elsewhere the force is given */
        error = larger(error,
                       ratio(force, scale->force + force_noise(m, scale) / m->options->tolerance));
    return error / m->options->tolerance;
}

static double guard_at(const struct march *m, double theta)
{
    const struct br_tip_step *tip = &m->s->tip;
    const struct br_tip_state state = br_tip_at(tip, theta);
    return br_law_at(m->s->law, tip->start + theta * tip->length, &state).guard;
}

static double guard_scale(enum br_phase phase, const struct scale *scale)
{
    switch (phase) {
    case BR_OPEN:
    case BR_CLOSED:
        return scale->tip_displacement;
    case BR_STICK:
        return scale->force;
    case BR_SLIP_UP:
    case BR_SLIP_DOWN:
        return scale->tip_velocity;
    case BR_FREE:
        break;
    }
    return 0;
}

/* The first sample, of SAMPLES over the trial step, at which its phase is over;
 * 0 for none. */
static size_t first_violation(const struct march *m, const struct scale *scale)
{
    const double lowest = -dead_band * guard_scale(m->s->phase, scale);
    for (size_t i = 1; i <= SAMPLES; i++)
        if (guard_at(m, (double)i / SAMPLES) < lowest)
            return i;
    return 0;
}

static double guard_after(double h, void *march)
{
    struct march *m = march;
    if (!m->status)
        m->status = stepper_try(m->s, h, m->err);
    return m->status ? 0 : guard_at(m, 1);
}

/* Shortens the trial step to the root of its guard, between `low` and `high`.
 * The guard is that at the end of a step, which is far more accurate than the
 * inside of the polynomial. Returns the step's length. */
static double locate(struct march *m, double low, double high)
{
    if (!(low > 0))
        low = fmin(high, m->options->first_step) / 16;
    const double at_low = guard_after(low, m), at_high = guard_after(high, m);
    if (m->status || !(at_low > 0) || !(at_high < 0))
        return at_low > 0 ? high : low;
    gsl_root_fsolver *solver = gsl_root_fsolver_alloc(gsl_root_fsolver_brent);
    if (!solver) {
        m->status = br_no_memory(m->err, "a root");
        return low;
    }
    gsl_function f = {guard_after, m};
    gsl_root_fsolver_set(solver, &f, low, high);
    for (int i = 0; i < MAX_ROOT_STEPS && !m->status; i++) {
        gsl_root_fsolver_iterate(solver);
        low = gsl_root_fsolver_x_lower(solver);
        high = gsl_root_fsolver_x_upper(solver);
        if (high - low <= 2 * DBL_EPSILON * high)
            break;
    }
    const double root = gsl_root_fsolver_root(solver);
    gsl_root_fsolver_free(solver);
    return root;
}

/* A phase begins; one at the time of the last one replaces it. */
static void enter(struct march *m, enum br_phase phase, double error)
{
    struct br_history *track = m->track;
    const size_t n = track->entries;
    m->s->phase = phase;
    m->h = m->options->first_step;
    m->fresh = true;
    if (m->status)
        return;
    if (n && track->entry[n - 1].time == m->s->time) {
        track->entry[n - 1].phase = phase;
        return;
    }
    struct br_entry *all =
        br_store_grow(track->store, track->entry, n, &track->entry_room, sizeof *all);
    if (!all) {
        m->status = br_no_memory(m->err, "the exact solution's steps");
        return;
    }
    all[n] = (struct br_entry){m->s->time, error, phase};
    track->entry = all;
    track->entries++;
}

/* Keeps the trial step. */
static enum br_status append(struct br_history *track, const struct stepper *s,
                             struct br_error *err)
{
    const size_t n = track->steps, m = track->modes;
    struct br_tip_step *all =
        br_store_grow(track->store, track->tip, n, &track->step_room, sizeof *all);
    double *values = br_store_take(track->store, BR_HISTORY_ROWS * m, sizeof *values);
    if (!values)
        return br_no_memory(err, "the exact solution's steps");
    for (size_t k = 0; k < S; k++)
        memcpy(&values[k * m], &s->series[k * s->system.width], m * sizeof *values);
    memcpy(&values[S * m], s->q, m * sizeof *values);
    all[n] = s->tip;
    all[n].values = values;
    track->tip = all;
    track->steps++;
    return BR_OK;
}

static void accept(struct march *m, double time)
{
    const struct stepper *s = m->s;
    if (!m->status)
        m->status = append(m->track, s, m->err);
    m->scale = trial_scale(m);
    m->track->free_velocity =
        larger(m->track->free_velocity, s->free_size / sqrt(s->field->length));
    m->track->impulse += s->impulse;
    m->track->blurred += gsl_pow_2(s->blur * s->impulse);
    stepper_accept(m->s, time);
    m->scale.displacement = larger(m->scale.displacement, br_oscillators_norm(s->field, s->q));
    m->fresh = false;
    m->at_once = 0;
}

/* The trial step ends where its guard vanishes: how exactly, s. */
static double time_error(const struct march *m)
{
    const double h = m->s->tip.length, slope = guard_at(m, 0.75) / (0.25 * h);
    const struct scale scale = trial_scale(m);
    return dead_band * guard_scale(m->s->phase, &scale) / fabs(slope) +
           2 * DBL_EPSILON * (m->s->time + h);
}

/* The phase ends at sample i of the trial step; at once, if it is the first one
 * of the phase's first step. A slip that ends at once with a velocity is shorter than any step:
 * then nothing is at rest yet, and the phase that follows stops the tip, as its force does. */
static void end_phase(struct march *m, size_t i)
{
    struct stepper *s = m->s;
    bool at_rest = true;
    const double h = s->tip.length;
    const struct br_tip_state over = br_tip_at(&s->tip, (double)i / SAMPLES);
    double error = 0;
    if (m->fresh && i == 1) {
        at_rest = s->tip_velocity == 0;
        if (++m->at_once > MAX_PHASES_AT_ONCE)
            m->status =
                br_fail(m->err, BR_NOT_FINITE, "the tip's phase at %.17g s is undecided", s->time);
    } else {
        const double root = locate(m, h * (double)(i - 1) / SAMPLES, h * (double)i / SAMPLES);
        if (!m->status)
            m->status = stepper_try(s, root, m->err);
        error = time_error(m);
        accept(m, s->time + root);
    }
    if (at_rest)
        stepper_settle(s);
    enter(m, br_law_at(s->law, s->time, &over).next, error);
}

/* How long a step may be, lest it overlook something that the data do. */
static double reach(const struct march *m)
{
    double most = INFINITY;
    for (size_t i = 0; i < 2; i++)
        if (m->options->outline[i])
            most = fmin(most, br_outline_reach(m->options->outline[i], m->s->time));
    return fmax(most, m->options->first_step);
}

/* What half a unit in the last place of t does to a load that changes within its cells. */
static double blur(const struct march *m, double h)
{
    const double t = m->s->time + h / 2;
    double cell = INFINITY;
    for (size_t i = 0; i < 2; i++)
        if (m->options->outline[i])
            cell = fmin(cell, br_outline_cell(m->options->outline[i], t));
    return DBL_EPSILON * t / cell;
}

/* A step of h, or a little less, that ends on a number, so that steps leave nothing out between
 * them. */
static double exact_step(const struct stepper *s, double h)
{
    double end = s->time + h;
    if (end - s->time > h)
        end = nextafter(end, s->time);
    return end > s->time ? end - s->time : h;
}

/* One step towards `limit`, where the law or the load may change. */
static void step(struct march *m, double limit)
{
    struct stepper *s = m->s;
    const double left = limit - s->time, wish = fmin(m->h, reach(m));
    const bool last = wish >= left;
    const double h =
        last ? left : exact_step(s, fmin(wish, fmax(left / 2, m->options->first_step)));
    s->blur = blur(m, h);
    m->status = stepper_try(s, h, m->err);
    if (m->status)
        return;
    const struct scale scale = trial_scale(m);
    const double error = step_error(m, &scale);
    if (!isfinite(error)) {
        m->status = br_fail(m->err, BR_NOT_FINITE, "not finite after %.17g s", s->time);
        return;
    }
    const double factor = fmin(0.9 * pow(error, -1.0 / (S - 1)), 2);
    if (error > 1 && h > m->options->first_step) {
        m->h = fmax(h * fmax(factor, 0.2), m->options->first_step);
        return;
    }
    const size_t over = first_violation(m, &scale);
    if (over) {
        end_phase(m, over);
        return;
    }
    accept(m, last ? limit : s->time + h);
    if (!last)
        m->h = factor > 1.2 ? h * factor : h;
}

/* Marches to `limit`. */
static void march_to(struct march *m, double limit)
{
    while (!m->status && m->s->time < limit) {
        if (m->track->steps >= m->options->max_steps)
            m->status = br_fail(m->err, BR_NOT_FINITE, "more than %zu time steps until %.17g s",
                                m->options->max_steps, m->s->time);
        else
            step(m, limit);
        if (!m->status)
            m->status = br_effort_spend(m->options->effort, m->s->work, m->err);
        m->s->work = 0;
    }
}

/* A time at which the law or the load may change, and how well it is known. */
struct change {
    struct br_interval at;
    double error;
};

static int by_time(const void *a, const void *b)
{
    const struct change *x = a, *y = b;
    return (x->at.low > y->at.low) - (x->at.low < y->at.low);
}

/* change (out): t = 0, jumps of the load, and phases of the field that this one depends on, in
 * order of time; those that no step fits between are one. Returns their number. */
static size_t list_changes(const struct march *m, struct change *change)
{
    const struct br_breaks *jump = &m->options->outline[0]->jump;
    const struct br_history *axial = m->s->law->axial;
    size_t count = 1, kept = 0;
    change[0] = (struct change){{0, 0}, 0};
    for (size_t i = 0; i < jump->count; i++)
        change[count++] = (struct change){jump->at[i], 0};
    for (size_t i = 1; axial && i < axial->entries; i++)
        change[count++] =
            (struct change){{axial->entry[i].time, axial->entry[i].time}, axial->entry[i].error};
    qsort(change, count, sizeof *change, by_time);
    for (size_t i = 1; i < count; i++) {
        struct change *last = &change[kept];
        if (change[i].at.low - last->at.high > 4 * DBL_EPSILON * last->at.high) {
            change[++kept] = change[i];
            continue;
        }
        last->at.high = fmax(last->at.high, change[i].at.high);
        last->error = fmax(last->error, change[i].error);
    }
    return kept + 1;
}

/* The phase in which the march goes on after a change. */
static enum br_phase phase_now(const struct march *m)
{
    const struct stepper *s = m->s;
    if (s->law->contact && s->time > 0) /* a jump of the load moves nothing */
        return s->phase;
    return br_law_phase(s->law, s->time, s->phase, s->tip_displacement, s->tip_velocity);
}

static void march_all(struct march *m)
{
    const struct br_history *axial = m->s->law->axial;
    const size_t most = 1 + m->options->outline[0]->jump.count + (axial ? axial->entries : 0);
    struct change *change = br_allocate(most, sizeof *change);
    if (!change)
        m->status = br_no_memory(m->err, "the exact solution");
    const size_t count = change ? list_changes(m, change) : 0;
    for (size_t i = 0; i < count && !m->status; i++) {
        const bool last = i + 1 == count;
        m->s->from = change[i].at.high;
        m->s->to = last ? m->options->duration : change[i + 1].at.low;
        enter(m, phase_now(m), change[i].error);
        march_to(m, last ? m->options->duration : change[i + 1].at.high);
    }
    free(change);
}

enum br_status br_march(const struct br_oscillators *field, const struct br_law *law,
                        const struct br_march_options *options, struct br_store *store,
                        struct br_history **out, struct br_error *err)
{
    struct br_store own = {0};
    struct stepper stepper = {.field = field, .law = law};
    struct march m = {.options = options, .s = &stepper, .err = err};
    m.track = *out = br_store_take(store, 1, sizeof *m.track);
    if (!m.track)
        return br_no_memory(err, "the exact solution's steps");
    *m.track =
        (struct br_history){.modes = field->modes.count, .gap = options->gap, .store = store};
    m.status = stepper_init(&stepper, options->gap, &own, err);
    if (!m.status)
        march_all(&m);
    br_store_clear(&own);
    return m.status;
}
