/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/exact/inside.h"

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
            "two solutions still differ after the most work that is allowed, about 20 s of a core");
    return BR_OK;
}

/* ---- the march ---- */

/* A switching function this far below zero, of the largest value so far, is round-off. */
static const double dead_band = 1e-13;

/* Largest values so far: L2 norms over the beam, and the tip's. */
enum { DISPLACEMENT, VELOCITY, TIP_DISPLACEMENT, TIP_VELOCITY, FORCE, VALUES };
struct scale {
    double of[VALUES];
};

/* The value that a phase's switching function monitors. */
static const int monitored[] = {
    [BR_FREE] = FORCE,  [BR_OPEN] = TIP_DISPLACEMENT, [BR_CLOSED] = TIP_DISPLACEMENT,
    [BR_STICK] = FORCE, [BR_SLIP_UP] = TIP_VELOCITY,  [BR_SLIP_DOWN] = TIP_VELOCITY,
};

struct march {
    const struct br_march_options *options;
    struct br_stepper *s;
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
    const struct br_stepper *s = m->s;
    const struct br_oscillators *f = s->field;
    const struct br_tip_state end = br_tip_at(&s->tip, 1);
    const double now[VALUES] = {br_oscillators_norm(f, s->q),
                                br_oscillators_norm(f, s->series), /* its mean */
                                fabs(end.displacement), fabs(end.velocity), fabs(end.force)};
    struct scale scale = m->scale;
    for (size_t i = 0; i < VALUES; i++)
        scale.of[i] = larger(scale.of[i], now[i]);
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
    return 10 * DBL_EPSILON * scale->of[VELOCITY] / sqrt(m->s->field->length) / response;
}

/* The trial step's error over the allowed one: the last two coefficients of its polynomials. */
static double step_error(const struct march *m, const struct scale *scale)
{
    const struct br_stepper *s = m->s;
    const size_t width = s->system.width;
    const double last = br_oscillators_norm(s->field, s->series + (S - 1) * width);
    const double before = br_oscillators_norm(s->field, s->series + (S - 2) * width);
    const double velocity = larger(last, before / 8);
    const double force = larger(fabs(s->tip.force[S - 1]), fabs(s->tip.force[S - 2]) / 8);
    const double noise = 10 * (DBL_EPSILON * s->free_size + s->load_noise) / m->options->tolerance;
    double error = ratio(velocity * s->tip.length,
                         scale->of[DISPLACEMENT] + (velocity + noise) * s->tip.length);
    error = larger(error, ratio(velocity, scale->of[VELOCITY] + noise));
    if (s->phase == BR_CLOSED || s->phase == BR_STICK) /* elsewhere the force is given */
        error = larger(
            error, ratio(force, scale->of[FORCE] + force_noise(m, scale) / m->options->tolerance));
    return error / m->options->tolerance;
}

static double switching_at(const struct march *m, double theta)
{
    const struct br_tip_step *tip = &m->s->tip;
    const struct br_tip_state state = br_tip_at(tip, theta);
    return br_law_at(m->s->law, tip->start + theta * tip->length, &state).switching;
}

/* The first sample, of SAMPLES over the trial step, at which its phase is over;
 * 0 for none. */
static size_t first_violation(const struct march *m, const struct scale *scale)
{
    const double lowest = -dead_band * scale->of[monitored[m->s->phase]];
    for (size_t i = 1; i <= SAMPLES; i++)
        if (switching_at(m, (double)i / SAMPLES) < lowest)
            return i;
    return 0;
}

static double switching_after(double h, void *march)
{
    struct march *m = march;
    if (!m->status)
        m->status = br_stepper_try(m->s, h, m->err);
    return m->status ? 0 : switching_at(m, 1);
}

/* Shortens the trial step to the root of its switching function, between `low` and `high`.
 * The switching function is that at the end of a step, which is far more accurate than the
 * inside of the polynomial. Returns the step's length. */
static double locate(struct march *m, double low, double high)
{
    if (!(low > 0))
        low = fmin(high, m->options->first_step) / 16;
    const double at_low = switching_after(low, m), at_high = switching_after(high, m);
    if (m->status || !(at_low > 0) || !(at_high < 0))
        return at_low > 0 ? high : low;
    gsl_root_fsolver *solver = gsl_root_fsolver_alloc(gsl_root_fsolver_brent);
    if (!solver) {
        m->status = br_no_memory(m->err, "a root");
        return low;
    }
    gsl_function f = {switching_after, m};
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
static enum br_status append(struct br_history *track, const struct br_stepper *s,
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
    const struct br_stepper *s = m->s;
    if (!m->status)
        m->status = append(m->track, s, m->err);
    m->scale = trial_scale(m);
    m->track->free_velocity =
        larger(m->track->free_velocity, s->free_size / sqrt(s->field->length));
    m->track->impulse += s->impulse;
    m->track->blurred += gsl_pow_2(s->blur * s->impulse);
    br_stepper_accept(m->s, time);
    m->scale.of[DISPLACEMENT] =
        larger(m->scale.of[DISPLACEMENT], br_oscillators_norm(s->field, s->q));
    m->fresh = false;
    m->at_once = 0;
}

/* The trial step ends where its switching function vanishes: how exactly, s. */
static double time_error(const struct march *m)
{
    const double h = m->s->tip.length, slope = switching_at(m, 0.75) / (0.25 * h);
    const struct scale scale = trial_scale(m);
    return dead_band * scale.of[monitored[m->s->phase]] / fabs(slope) +
           2 * DBL_EPSILON * (m->s->time + h);
}

/* The phase ends at sample i of the trial step; at once, if it is the first one
 * of the phase's first step. A slip that ends at once with a velocity is shorter than any step:
 * then nothing is at rest yet, and the phase that follows stops the tip, as its force does. */
static void end_phase(struct march *m, size_t i)
{
    struct br_stepper *s = m->s;
    bool at_rest = true;
    const double h = s->tip.length;
    const struct br_tip_state over = br_tip_at(&s->tip, (double)i / SAMPLES);
    double error = 0;
    if (m->fresh && i == 1) {
        at_rest = s->tip_velocity == 0;
        if (++m->at_once > MAX_PHASES_AT_ONCE)
            m->status = br_fail(m->err, BR_NOT_FINITE,
                                "the tip's phase at %.17g s cannot be determined", s->time);
    } else {
        const double root = locate(m, h * (double)(i - 1) / SAMPLES, h * (double)i / SAMPLES);
        if (!m->status)
            m->status = br_stepper_try(s, root, m->err);
        error = time_error(m);
        accept(m, s->time + root);
    }
    if (at_rest)
        br_stepper_settle(s);
    enter(m, br_law_at(s->law, s->time, &over).next, error);
}

/* The longest step that skips no detail of the data. */
static double reach(const struct march *m)
{
    double most = INFINITY;
    for (size_t i = 0; i < 2; i++)
        if (m->options->data_mesh[i])
            most = fmin(most, br_data_mesh_reach(m->options->data_mesh[i], m->s->time));
    return fmax(most, m->options->first_step);
}

/* Relative change of a load, within its cells, by half a unit in the last place of t. */
static double blur(const struct march *m, double h)
{
    const double t = m->s->time + h / 2;
    double cell = INFINITY;
    for (size_t i = 0; i < 2; i++)
        if (m->options->data_mesh[i])
            cell = fmin(cell, br_data_mesh_cell(m->options->data_mesh[i], t));
    return DBL_EPSILON * t / cell;
}

/* A step of h, or a little less, that ends on a double, so that steps leave no gaps. */
static double exact_step(const struct br_stepper *s, double h)
{
    double end = s->time + h;
    if (end - s->time > h)
        end = nextafter(end, s->time);
    return end > s->time ? end - s->time : h;
}

/* One step towards `limit`, where the law or the load may change. */
static void step(struct march *m, double limit)
{
    struct br_stepper *s = m->s;
    const double left = limit - s->time, wanted = fmin(m->h, reach(m));
    const bool last = wanted >= left;
    const double h =
        last ? left : exact_step(s, fmin(wanted, fmax(left / 2, m->options->first_step)));
    s->blur = blur(m, h);
    m->status = br_stepper_try(s, h, m->err);
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
            m->status = br_fail(m->err, BR_NOT_FINITE, "more than %zu time steps until %g s",
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
    const struct br_breaks *jump = &m->options->data_mesh[0]->jump;
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
    const struct br_stepper *s = m->s;
    if (s->law->contact && s->time > 0) /* a jump of the load moves nothing */
        return s->phase;
    return br_law_phase(s->law, s->time, s->phase, s->tip_displacement, s->tip_velocity);
}

static void march_all(struct march *m)
{
    const struct br_history *axial = m->s->law->axial;
    const size_t most = 1 + m->options->data_mesh[0]->jump.count + (axial ? axial->entries : 0);
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

enum br_status br_march(const struct br_oscillators *field, const struct br_exact_law *law,
                        const struct br_march_options *options, struct br_store *store,
                        struct br_history **out, struct br_error *err)
{
    struct br_store own = {0};
    struct br_stepper stepper = {.field = field, .law = law};
    struct march m = {.options = options, .s = &stepper, .err = err};
    m.track = *out = br_store_take(store, 1, sizeof *m.track);
    if (!m.track)
        return br_no_memory(err, "the exact solution's steps");
    *m.track =
        (struct br_history){.modes = field->modes.count, .gap = options->gap, .store = store};
    m.status = br_stepper_init(&stepper, options->gap, &own, err);
    if (!m.status)
        march_all(&m);
    br_store_clear(&own);
    return m.status;
}
