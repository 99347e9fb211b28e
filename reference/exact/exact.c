/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/exact/inside.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

/* ---- two solutions ---- */

/* The error estimate is this multiple of the distance of two solutions, since either may be the
 * worse one. */
static const double safety = 2;

/* Velocity and force are not compared for this share of T after an event, a jump of the data or a
 * load pulse that is as short. */
static const double layer = 1e-6;

/* Times of a step at which solutions are compared: its start, where velocities are least accurate,
 * and some of its nodes, where displacements are. */
static const double inside[] = {0, 0.0913, 0.3719, 0.5452, 0.8556};
enum { INSTANTS = sizeof inside / sizeof *inside };

/* One field of two solutions, the finer one first, with room for their values at one time.
 *
 * The elements are the same, and the finer solution has at least as many polynomials on each: the
 * other one's modes are sums of its modes. Both are compared in these. */
struct pair {
    const struct br_data_mesh *data_mesh;
    const struct br_oscillators *field[2];
    const struct br_exact_law *law[2];
    const struct br_history *track[2];
    double *bridge;         /* modes of the other one x those of the finer one */
    struct br_history step; /* one step of the other one, in the finer one's modes */
    struct br_tip_step tip; /* of that step */
    size_t translated;      /* its number */
    double *q[2], *v[2];    /* modes of the finer one */
    struct br_store store;
};

/* bridge = U_1' U_0, the energy's products of the modes: the derivatives' coefficients on each
 * element, of which the finer ones begin with the others. */
static void build_bridge(struct pair *p, double *row, double *turned)
{
    const struct br_modes *fine = &p->field[0]->modes, *coarse = &p->field[1]->modes;
    const size_t m = fine->count;
    for (size_t i = 0; i < m; i++)
        for (size_t k = 0; k < m; k++)
            turned[k * m + i] = fine->curve[i * m + k];
    for (size_t i = 0; i < coarse->count; i++)
        for (size_t e = 0; e < fine->spectral.count; e++)
            memcpy(&row[i * m + br_spectral_at(&fine->spectral, e, 0)],
                   &coarse->curve[i * coarse->count + br_spectral_at(&coarse->spectral, e, 0)],
                   coarse->spectral.terms[e] * sizeof *row);
    br_combine(coarse->count, m, row, m, turned, p->bridge);
}

static enum br_status pair_init(struct pair *p, const struct br_exact_solution *const solution[2],
                                size_t which, struct br_error *err)
{
    const size_t m = solution[0]->field[which]->modes.count;
    const size_t other = solution[1]->field[which]->modes.count * m;
    for (size_t i = 0; i < 2; i++) {
        p->field[i] = solution[i]->field[which];
        p->law[i] = &solution[i]->law[which];
        p->track[i] = solution[i]->track[which];
        p->q[i] = br_store_take(&p->store, m, sizeof(double));
        p->v[i] = br_store_take(&p->store, m, sizeof(double));
    }
    p->step = (struct br_history){.modes = m, .steps = 1, .tip = &p->tip};
    p->tip.values = br_store_take(&p->store, BR_HISTORY_ROWS * m, sizeof(double));
    p->translated = SIZE_MAX;
    p->bridge = br_store_take(&p->store, other, sizeof(double));
    double *row = br_store_take(&p->store, other, sizeof *row);
    double *turned = br_store_take(&p->store, m * m, sizeof *turned);
    if (p->store.failed)
        return br_no_memory(err, "the comparison of two solutions");
    build_bridge(p, row, turned);
    return BR_OK;
}

/* The other solution's values at t, in the finer one's modes. */
static struct br_tip_state other_at(struct pair *p, double t)
{
    const struct br_history *track = p->track[1];
    const size_t n = br_history_find(track, t);
    if (n != p->translated) {
        double *values = p->tip.values;
        br_combine(BR_HISTORY_ROWS, track->modes, track->tip[n].values, p->step.modes, p->bridge,
                   values);
        p->tip = track->tip[n];
        p->tip.values = values;
        p->translated = n;
    }
    return br_history_at(&p->step, t, p->q[1], p->v[1]);
}

/* *most becomes the larger one; NaN counts as infinite. */
static void grow(double *most, double value)
{
    if (!(value <= *most))
        *most = isnan(value) ? INFINITY : value;
}

static bool in_layer(const struct br_history *track, double t, double width)
{
    for (size_t i = 0; i < track->entries && track->entry[i].time - width <= t; i++)
        if (t <= track->entry[i].time + width)
            return true;
    return false;
}

/* Whether velocities and forces are compared at t. */
static bool is_smooth(const struct pair *p, double t, double duration)
{
    return t == duration || (!in_layer(p->track[0], t, layer * duration) &&
                             !in_layer(p->track[1], t, layer * duration) &&
                             !br_data_mesh_is_sharp(p->data_mesh, t, layer * duration));
}

static void compare_at(struct pair *p, double t, double duration, struct br_exact_report *report)
{
    struct br_tip_state tip[2] = {br_history_at(p->track[0], t, p->q[0], p->v[0]), other_at(p, t)};
    for (size_t i = 0; i < 2; i++)
        tip[i].force = br_law_at(p->law[i], t, &tip[i]).force;
    const struct br_oscillators *field = p->field[0];
    const size_t m = field->modes.count, degree = field->modes.degree;
    const double length = field->length, norm = 1 / sqrt(length);
    const double strain = pow(length, -(double)degree);
    struct br_exact_size *largest = &report->largest, *error = &report->error;
    grow(&largest->displacement, norm * br_oscillators_norm(field, p->q[0]));
    grow(&largest->displacement, fabs(tip[0].displacement + p->track[0]->gap));
    grow(&largest->velocity, norm * br_oscillators_norm(field, p->v[0]));
    grow(&largest->velocity, fabs(tip[0].velocity));
    grow(&largest->force, fabs(tip[0].force));
    grow(&largest->strain_rate, br_norm(m, NULL, p->v[0]) * strain);
    for (size_t i = 0; i < m; i++) {
        p->q[1][i] -= p->q[0][i];
        p->v[1][i] -= p->v[0][i];
    }
    grow(&error->displacement, safety * norm * br_oscillators_norm(field, p->q[1]));
    grow(&error->displacement, safety * fabs(tip[0].displacement - tip[1].displacement));
    if (!is_smooth(p, t, duration))
        return;
    grow(&error->velocity, safety * norm * br_oscillators_norm(field, p->v[1]));
    grow(&error->strain_rate, safety * br_norm(m, NULL, p->v[1]) * strain);
    grow(&error->velocity, safety * fabs(tip[0].velocity - tip[1].velocity));
    grow(&error->force, safety * fabs(tip[0].force - tip[1].force));
}

static bool same_phases(const struct br_history *a, const struct br_history *b)
{
    if (a->entries != b->entries)
        return false;
    for (size_t i = 0; i < a->entries; i++)
        if (a->entry[i].phase != b->entry[i].phase)
            return false;
    return true;
}

/* The time of instant i of a history; infinite behind the last one. */
static double instant_time(const struct br_history *track, size_t i)
{
    const struct br_tip_step *tip = &track->tip[i / INSTANTS];
    return i < track->steps * INSTANTS ? tip->start + inside[i % INSTANTS] * tip->length : INFINITY;
}

/* Work of the comparisons in a step; a translated step serves those in two. */
static double step_work(const struct pair *p)
{
    const double a = (double)p->field[0]->modes.count, b = (double)p->field[1]->modes.count;
    return 3e-4 * a * b + 0.035 * a;
}

/* Compares at each step of either solution, in order of time. A comparison that has begun is
 * completed even if no work is left for it, but not where `stop` ends it. */
static enum br_status compare_field(struct pair *p, double duration, struct br_effort *effort,
                                    struct br_exact_report *report, struct br_error *err)
{
    struct br_error spent;
    size_t at[2] = {0, 0};
    if (!same_phases(p->track[0], p->track[1])) {
        report->error = (struct br_exact_size){INFINITY, INFINITY, INFINITY, INFINITY};
        return BR_OK;
    }
    for (;;) {
        const double t[2] = {instant_time(p->track[0], at[0]), instant_time(p->track[1], at[1])};
        const size_t first = t[1] < t[0];
        if (isinf(t[first]))
            break;
        compare_at(p, t[first], duration, report);
        if (++at[first] % INSTANTS == 0 &&
            br_effort_spend(effort, step_work(p), &spent) == BR_INTERRUPTED)
            return br_fail(err, BR_INTERRUPTED, "%s", spent.message);
    }
    compare_at(p, duration, duration, report);
    return BR_OK;
}

/* Fills exact->report with the size of exact->solution and its distance to another, infinite where
 * their events differ. Its work counts. Fails with BR_NO_MEMORY or BR_INTERRUPTED. */
static enum br_status compare(struct br_exact *exact, const struct br_exact_solution *other,
                              const struct br_data_mesh data_mesh[BR_FIELDS],
                              struct br_effort *effort, struct br_error *err)
{
    enum br_status status = BR_OK;
    for (size_t which = 0; which < BR_FIELDS && !status; which++) {
        struct br_exact_report *report = &exact->report[which];
        *report = (struct br_exact_report){0};
        if (!exact->solution->track[which])
            continue;
        struct pair p = {.data_mesh = &data_mesh[which]};
        report->modes = exact->solution->field[which]->modes.count;
        report->steps = exact->solution->track[which]->steps;
        exact->noise[which] = 1e-13 * exact->solution->track[which]->free_velocity;
        const struct br_exact_solution *const both[2] = {exact->solution, other};
        status = pair_init(&p, both, which, err);
        if (!status)
            status = compare_field(&p, exact->duration, effort, report, err);
        br_store_clear(&p.store);
    }
    return status;
}

static int by_time(const void *a, const void *b)
{
    const struct br_exact_event *x = a, *y = b;
    if (x->time != y->time)
        return x->time < y->time ? -1 : 1;
    return (int)x->field - (int)y->field;
}

/* Fills exact->event from exact->solution, with error bars from another that has the same events.
 * Fails with BR_NO_MEMORY. */
static enum br_status list_events(struct br_exact *exact, const struct br_exact_solution *other,
                                  struct br_error *err)
{
    size_t room = 0;
    for (enum br_field_kind which = 0; which < BR_FIELDS; which++)
        if (exact->solution->track[which])
            room += exact->solution->track[which]->entries;
    exact->event = br_allocate(room, sizeof *exact->event);
    if (!exact->event)
        return br_no_memory(err, "the events");
    for (enum br_field_kind which = 0; which < BR_FIELDS; which++) {
        const struct br_history *track = exact->solution->track[which];
        for (size_t i = 0; track && i < track->entries; i++) {
            const double t = track->entry[i].time, t2 = other->track[which]->entry[i].time;
            /* no event: a phase continues through an event of the other field */
            if (i == 0 || track->entry[i].phase != track->entry[i - 1].phase)
                exact->event[exact->events++] = (struct br_exact_event){
                    .time = t,
                    .error = fmax(safety * fabs(t - t2) + track->entry[i].error,
                                  1e-13 * exact->duration), /* what rounding does */
                    .field = which,
                    .phase = track->entry[i].phase,
                };
        }
    }
    qsort(exact->event, exact->events, sizeof *exact->event, by_time);
    for (size_t i = 1; i < exact->events; i++) /* errors never fall: agreement may be luck */
        grow(&exact->event[i].error, exact->event[i - 1].error);
    return BR_OK;
}

/* ---- the search for two that agree ---- */

enum { FIRST_MODES = 12, LEAST_MODES = 18 };

/* Some 20 seconds of a core, see br_effort. */
static const double most_work = 1.4e7;

static struct br_exact_options with_defaults(const struct br_exact_options *options)
{
    struct br_exact_options o = options ? *options : (struct br_exact_options){0};
    o.tolerance = o.tolerance != 0 ? o.tolerance : 1e-10;
    o.acceptable = o.acceptable != 0 ? o.acceptable : o.tolerance;
    o.max_modes = o.max_modes ? o.max_modes : 256;
    o.max_steps = o.max_steps ? o.max_steps : 20000;
    return o;
}

static enum br_status check(const struct br_scene *scene, const struct br_exact_options *o,
                            struct br_error *err)
{
    if (!(o->tolerance >= 2e-11 && o->tolerance <= 1e-3))
        return br_fail(err, BR_BAD_INPUT, "the tolerance is %g, expected 2e-11 to 1e-3",
                       o->tolerance);
    if (!(o->acceptable >= o->tolerance && o->acceptable <= 1e-3))
        return br_fail(err, BR_BAD_INPUT, "the acceptable tolerance is %g, expected %g to 1e-3",
                       o->acceptable, o->tolerance);
    if (o->max_modes < LEAST_MODES || o->max_modes > 1000)
        return br_fail(err, BR_BAD_INPUT, "at most %zu modes are allowed, expected %d to 1000",
                       o->max_modes, LEAST_MODES);
    const enum br_status status = br_scene_check(scene, err);
    if (status)
        return status;
    if (!br_law_is_known(&scene->friction))
        return br_fail(err, BR_BAD_INPUT,
                       "the exact solution does not know the scene's law of friction, expected "
                       "another reference, as --reference fine:N,K");
    const bool still = (scene->axial.modelled && !(scene->axial.viscosity > 0)) ||
                       (scene->bending.modelled && !(scene->bending.viscosity > 0));
    if (still && !(scene->density > 0))
        return br_fail(err, BR_BAD_INPUT,
                       "without density and viscosity the velocity is not "
                       "determined, expected at least one of them");
    return BR_OK;
}

/* The largest error over what is allowed; 0 / 0 counts as 0 */
static double badness(const struct br_exact *exact, const struct br_exact_options *o)
{
    const double rate_tolerance = 10 * o->tolerance;
    double worst = 0;
    for (size_t i = 0; i < BR_FIELDS; i++) {
        const struct br_exact_size *e = &exact->report[i].error, *l = &exact->report[i].largest;
        const double error[] = {e->displacement, e->velocity, e->force};
        const double allowed[] = {
            o->tolerance * l->displacement + exact->noise[i] * exact->duration,
            rate_tolerance * l->velocity + exact->noise[i], rate_tolerance * l->force};
        for (size_t j = 0; j < 3; j++)
            if (error[j] != 0 && !(error[j] / allowed[j] <= worst))
                worst = error[j] / allowed[j];
    }
    return worst;
}

/* size = factor size + share of */
static void add_to_size(struct br_exact_size *size, double factor, double share,
                        const struct br_exact_size *of)
{
    size->displacement = factor * size->displacement + share * of->displacement;
    size->velocity = factor * size->velocity + share * of->velocity;
    size->force = factor * size->force + share * of->force;
    size->strain_rate = factor * size->strain_rate + share * of->strain_rate;
}

static enum br_status refuse(const struct br_exact *exact, double worst,
                             const struct br_error *cause, struct br_error *err)
{
    if (cause->status)
        return br_fail(err, BR_NOT_FINITE, "%s", cause->message);
    if (isinf(worst))
        return br_fail(err, BR_NOT_FINITE, "the events still change with the number of modes");
    return br_fail(
        err, BR_NOT_FINITE,
        "with %zu axial and %zu bending modes the error estimate is %.2g times the limit",
        exact->report[0].modes, exact->report[1].modes, worst);
}

/* The search for two solutions that agree. */
struct search {
    struct br_exact *exact;
    const struct br_scene *scene;
    const struct br_exact_options *o;
    struct br_data_mesh data_mesh[BR_FIELDS];
    struct br_effort effort;
    size_t round, modes; /* of the next solution */
    struct br_exact_solution *before;
    double missed;              /* the largest of the data meshes */
    double worst, worst_before; /* of the last two pairs, infinite where unknown */
    struct br_error cause;      /* why it is unknown */
};

/* ---- one solution ---- */

static struct br_exact_law law_of(const struct br_scene *s, enum br_field_kind which,
                                  const struct br_history *axial)
{
    if (which == BR_AXIAL)
        return (struct br_exact_law){
            .contact = true,
            .obstacle = s->contact.modelled,
            .stiffness = s->contact.modelled ? br_contact_stiffness(&s->contact) : 0,
        };
    return (struct br_exact_law){
        .friction = s->friction,
        .axial = br_law_follows(&s->friction) ? axial : NULL,
    };
}

static void solution_free(struct br_exact_solution *s)
{
    if (!s)
        return;
    br_store_clear(&s->store);
    free(s);
}

static size_t count_modes(const struct search *s, size_t which, size_t modes)
{
    size_t count = 0;
    for (size_t e = 0; e + 1 < s->data_mesh[which].end[BR_X].count; e++)
        count += br_data_mesh_terms(&s->data_mesh[which], e, modes);
    return count;
}

/* Solves one field. Every second solution has finer steps, so that consecutive ones differ in time
 * as well as in space. A singular value decomposition is most of the cost of its modes. The cause
 * of a failure is in s->cause. */
static enum br_status solve(struct search *s, enum br_field_kind which,
                            struct br_exact_solution *into)
{
    const bool finer = s->round % 2;
    const struct br_scene *scene = s->scene;
    const struct br_data_mesh *data_mesh = &s->data_mesh[which];
    struct br_exact_law *law = &into->law[which];
    *law = law_of(scene, which, into->track[BR_AXIAL]);
    const struct br_march_options options = {
        .duration = scene->duration,
        .gap = law->obstacle ? scene->contact.gap : 0,
        .tolerance = s->o->tolerance * (finer ? 0.1 : 0.4),
        .first_step = scene->duration * (finer ? 2e-13 : 1e-12),
        .max_steps = s->o->max_steps,
        .data_mesh = {data_mesh, law->axial ? &s->data_mesh[BR_AXIAL] : NULL},
        .effort = &s->effort,
    };
    const double count = (double)count_modes(s, which, s->modes);
    enum br_status status = br_effort_spend(&s->effort, 2e-3 * count * count * count, &s->cause);
    if (!status)
        status = br_oscillators_create(&into->field[which], scene, data_mesh, s->modes,
                                       &into->store, &s->cause);
    if (!status)
        status = br_march(into->field[which], law, &options, &into->store, &into->track[which],
                          &s->cause);
    return status;
}

/* ---- solutions until two agree ---- */

/* Finds the next solution and its distance from the last one. If it fails, more modes may help; if
 * no work is left, the last pair stays. */
static enum br_status next_round(struct search *s)
{
    struct br_exact *exact = s->exact;
    struct br_exact_solution *next = br_allocate(1, sizeof *next);
    enum br_status status = BR_OK;
    s->cause = (struct br_error){0};
    if (!next)
        return br_no_memory(&s->cause, "the exact solution");
    for (enum br_field_kind which = 0; which < BR_FIELDS && !status; which++)
        if (s->scene->field[which].modelled)
            status = solve(s, which, next);
    if (status) {
        solution_free(next);
        return status == BR_NOT_FINITE ? BR_OK : status;
    }
    solution_free(s->before);
    s->before = exact->solution;
    exact->solution = next;
    if (!s->before)
        return BR_OK;
    status = compare(exact, s->before, s->data_mesh, &s->effort, &s->cause);
    s->worst_before = s->worst;
    s->worst = badness(exact, s->o);
    return status;
}

/* Whether the work that was allowed is done. */
static bool is_spent(const struct search *s)
{
    return s->effort.done > s->effort.most;
}

/* Modes of the next round, 0 if there may be none: on several elements six times as many as on one
 * are allowed. */
static size_t next_modes(const struct search *s)
{
    const size_t most = s->o->max_modes, more = s->modes * 3 / 2;
    const size_t next = !s->modes ? FIRST_MODES : more < most ? more : most;
    for (enum br_field_kind which = 0; which < BR_FIELDS; which++)
        if (count_modes(s, which, next) > 6 * most)
            return 0;
    return s->modes == most || is_spent(s) ? 0 : next;
}

/* Whether the last pair nearly has the wanted accuracy, and more modes do not help: the steps' own
 * errors are left. */
static bool is_stuck(const struct search *s)
{
    return s->worst <= fmin(10, s->o->acceptable / s->o->tolerance) &&
           s->worst > 0.5 * s->worst_before && s->worst < 2 * s->worst_before;
}

/* Times the tolerance: an error that nearly has the wanted accuracy. */
enum { NEAR = 100 };

/* Whether the last pair is accepted without the wanted accuracy: it nearly has it, or the distances
 * shrink, and the expected rest is added to the estimate. */
static bool is_acceptable(struct search *s)
{
    const double slow = 0.8, ratio = s->worst / s->worst_before;
    if (!(s->worst <= s->o->acceptable / s->o->tolerance) || (s->cause.status && !is_spent(s)))
        return false;
    if (s->worst <= NEAR)
        return true;
    for (size_t i = 0; i < BR_FIELDS && ratio <= slow; i++)
        add_to_size(&s->exact->report[i].error, 1 / (1 - ratio), 0, &s->exact->report[i].largest);
    return ratio <= slow;
}

/* The longest time in which a velocity makes a displacement of the field: T, or one over the lowest
 * frequency, s. */
static double swing(const struct search *s, size_t which)
{
    const struct br_oscillators *field = s->exact->solution->field[which];
    double heaviest = 0;
    for (size_t i = 0; i < field->modes.count; i++)
        heaviest = fmax(heaviest, field->mass[i]);
    return fmin(s->scene->duration, sqrt(heaviest / field->stiffness));
}

/* Adds what the distance of solutions does not show: relative errors by intervals too narrow to be
 * examined and by remainders of proofs, and the rounding of the stages' times, independent of each
 * other, where the load changes fast. That is an error of the loads' velocity: where loads cancel,
 * more than a share of what they leave. */
static void add_unproved(const struct search *s, size_t which)
{
    struct br_exact_report *report = &s->exact->report[which];
    const struct br_history *track = s->exact->solution->track[which];
    const double rounding = 3 * 0.29; /* of a unit: three times its rms */
    const double change = 0.25;       /* of a load over a cell: rms */
    double velocity = 0, share = 0;   /* m^(3/2)/s; of the velocity by the loads */
    if (track && track->impulse > 0) {
        velocity = rounding * change * sqrt(track->blurred / BR_STAGES);
        share = velocity / track->impulse;
    }
    add_to_size(&report->error, 1, s->missed + s->data_mesh[which].proved + share,
                &report->largest);
    if (velocity > 0)
        report->error.displacement =
            fmax(report->error.displacement, velocity / sqrt(s->scene->length) * swing(s, which));
}

/* No error is stated below what rounding does to a solution: distances below it are those of one
 * BLAS. */
static void raise_to_rounding(struct br_exact_report *report)
{
    const double displacements = 1e-13, rates = 100 * displacements; /* relative */
    const struct br_exact_size *largest = &report->largest;
    struct br_exact_size *error = &report->error;
    error->displacement = fmax(error->displacement, displacements * largest->displacement);
    error->velocity = fmax(error->velocity, rates * largest->velocity);
    error->force = fmax(error->force, rates * largest->force);
    error->strain_rate = fmax(error->strain_rate, rates * largest->strain_rate);
}

/* The largest relative error that the report states, that of velocities over ten. The noise counts
 * only where a force at the tip cancels the motion. */
static double stated_error(const struct br_exact *exact)
{
    const double cancelled = 1e7; /* times the noise: a millionth of the free velocity */
    double most = 0;
    for (size_t i = 0; i < BR_FIELDS; i++) {
        const struct br_exact_size *e = &exact->report[i].error, *l = &exact->report[i].largest;
        if (l->velocity < cancelled * exact->noise[i])
            continue;
        const double relative[] = {e->displacement / l->displacement,
                                   e->velocity / l->velocity / 10};
        for (size_t j = 0; j < 2; j++)
            if (l->velocity > 0 && !(relative[j] <= most))
                most = relative[j];
    }
    return most;
}

/* Makes solutions with more and more modes until two agree. */
static enum br_status refine(struct search *s, struct br_error *err)
{
    const double enough = fmax(1, s->missed / s->o->tolerance);
    enum br_status status = BR_OK;
    s->modes = next_modes(s);
    if (!s->modes)
        return br_fail(err, BR_NOT_FINITE, "the loads and initial data need %zu and %zu elements",
                       s->data_mesh[0].end[BR_X].count, s->data_mesh[1].end[BR_X].count);
    for (; !status && s->modes && !(s->worst <= enough) && !is_stuck(s); s->round++) {
        status = next_round(s);
        s->modes = next_modes(s);
    }
    if (status)
        return br_fail(err, status, "%s", s->cause.message);
    if (!(s->worst <= enough) && !is_acceptable(s))
        return refuse(s->exact, s->worst, &s->cause, err);
    for (size_t i = 0; i < BR_FIELDS; i++) {
        add_unproved(s, i);
        raise_to_rounding(&s->exact->report[i]);
    }
    if (!(stated_error(s->exact) <= fmax(s->o->acceptable, NEAR * s->o->tolerance)))
        return br_fail(err, BR_NOT_FINITE,
                       "its own relative error would be %.2g, expected at most "
                       "%g; the load changes faster than times in double precision can resolve",
                       stated_error(s->exact), s->o->acceptable);
    return list_events(s->exact, s->before, err);
}

static enum br_status mesh_data(struct search *s, struct br_error *err)
{
    enum br_status status = BR_OK;
    for (enum br_field_kind which = 0; which < BR_FIELDS && !status; which++) {
        if (!s->scene->field[which].modelled)
            continue;
        status = br_data_mesh_init(&s->data_mesh[which], s->scene, which, err);
        s->missed = fmax(s->missed, s->data_mesh[which].missed);
    }
    if (!status && !(s->missed <= s->o->acceptable))
        status =
            br_fail(err, BR_NOT_FINITE,
                    "a share of %.2g of a load may lie in places too narrow to resolve", s->missed);
    return status;
}

enum br_status br_exact_create(struct br_exact **out, const struct br_scene *scene,
                               const struct br_exact_options *options, struct br_error *err)
{
    *out = NULL;
    const struct br_exact_options o = with_defaults(options);
    enum br_status status = check(scene, &o, err);
    if (status)
        return status;
    struct search s = {
        .exact = br_allocate(1, sizeof *s.exact),
        .scene = scene,
        .o = &o,
        .effort = {.most = most_work, .who = &o},
        .worst = INFINITY,
        .worst_before = INFINITY,
    };
    if (!s.exact)
        return br_no_memory(err, "the exact solution");
    s.exact->duration = scene->duration;
    status = mesh_data(&s, err);
    if (!status)
        status = refine(&s, err);
    solution_free(s.before);
    for (enum br_field_kind which = 0; which < BR_FIELDS; which++)
        br_data_mesh_clear(&s.data_mesh[which]);
    if (!status)
        *out = s.exact;
    else
        br_exact_free(s.exact);
    if (status != BR_NOT_FINITE)
        return status;
    const struct br_error cause = *err;
    return br_fail(err, status,
                   "no exact solution: %.800s; 'beamrate study --reference fine:N,K' needs none",
                   cause.message);
}

void br_exact_free(struct br_exact *exact)
{
    if (!exact)
        return;
    solution_free(exact->solution);
    free(exact->event);
    free(exact);
}
