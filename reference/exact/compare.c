/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "reference/exact/solution.h"

/* The estimate is this many times the distance of two solutions: either may be
 * the worse one, but hardly by less than that. */
static const double safety = 2;

/* After an event, a jump of the data or a blow that is as short, velocity and force are not
 * compared for this part of T. */
static const double layer = 1e-6;

/* Times of a step at which solutions are compared: where it begins, where velocities are at their
 * worst, and some of its nodes, where displacements are. */
static const double inside[] = {0, 0.0913, 0.3719, 0.5452, 0.8556};
enum { INSTANTS = sizeof inside / sizeof *inside };

/* One field of two solutions, the finer one first, with room for their values at one time.
 *
 * The elements are the same, and the finer solution has at least as many polynomials on each: the
 * other one's modes are sums of its modes. Both are compared in these. */
struct pair {
    const struct br_outline *outline;
    const struct br_oscillators *field[2];
    const struct br_law *law[2];
    const struct br_history *track[2];
    double *bridge;         /* modes of the other one x those of the finer one */
    struct br_history step; /* one step of the other one, in the finer one's modes */
    double *values;         /* its values */
    size_t translated;      /* its number */
    double *q[2], *v[2];    /* modes of the finer one */
    struct br_store store;
};

/* bridge = U_1' U_0, the energy's products of the modes: the derivatives' coefficients on each
 * element, of which the finer ones begin with the others. */
static enum br_status build_bridge(struct pair *p, struct br_error *err)
{
    const struct br_modes *fine = &p->field[0]->modes, *coarse = &p->field[1]->modes;
    const size_t m = fine->count;
    double *row = br_allocate(coarse->count * m + m * m, sizeof *row);
    if (!row)
        return br_no_memory(err, "the comparison of two solutions");
    double *turned = row + coarse->count * m;
    for (size_t i = 0; i < m; i++)
        for (size_t k = 0; k < m; k++)
            turned[k * m + i] = fine->curve[i * m + k];
    for (size_t i = 0; i < coarse->count; i++)
        for (size_t e = 0; e < fine->pieces.count; e++)
            memcpy(&row[i * m + br_pieces_at(&fine->pieces, e, 0)],
                   &coarse->curve[i * coarse->count + br_pieces_at(&coarse->pieces, e, 0)],
                   coarse->pieces.terms[e] * sizeof *row);
    br_combine(coarse->count, m, row, m, turned, p->bridge);
    free(row);
    return BR_OK;
}

static enum br_status pair_init(struct pair *p, const struct br_exact_solution *a,
                                const struct br_exact_solution *b, size_t which,
                                struct br_error *err)
{
    const struct br_exact_solution *solution[2] = {a, b};
    for (size_t i = 0; i < 2; i++) {
        p->field[i] = solution[i]->field[which];
        p->law[i] = &solution[i]->law[which];
        p->track[i] = solution[i]->track[which];
        p->q[i] = br_store_take(&p->store, a->field[which]->modes.count, sizeof(double));
        p->v[i] = br_store_take(&p->store, a->field[which]->modes.count, sizeof(double));
    }
    const size_t m = p->field[0]->modes.count;
    p->step = (struct br_history){.modes = m, .steps = 1, .block = &p->values};
    p->values = br_store_take(&p->store, BR_HISTORY_ROWS * m, sizeof(double));
    p->translated = SIZE_MAX;
    p->bridge = br_store_take(&p->store, p->field[1]->modes.count * m, sizeof(double));
    return p->store.failed ? br_no_memory(err, "the comparison of two solutions")
                           : build_bridge(p, err);
}

/* The other solution's values at t, in the finer one's modes. */
static struct br_tip_state other_at(struct pair *p, double t)
{
    const struct br_history *track = p->track[1];
    const size_t n = br_history_find(track, t);
    if (n != p->translated) {
        br_combine(BR_HISTORY_ROWS, track->modes, br_history_values(track, n), p->step.modes,
                   p->bridge, p->values);
        p->step.tip = &track->tip[n];
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
                             !br_outline_is_sharp(p->outline, t, layer * duration));
}

static void compare_at(struct pair *p, double t, double duration, struct br_exact_report *report)
{
    struct br_tip_state tip[2] = {br_history_at(p->track[0], t, p->q[0], p->v[0]), other_at(p, t)};
    for (size_t i = 0; i < 2; i++)
        tip[i].force = br_law_force_at(p->law[i], t, &tip[i]);
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

/* A place in a history: instant `instant` of a step. */
struct cursor {
    size_t step, instant;
};

/* Infinite behind the last one. */
static double cursor_time(const struct br_history *track, const struct cursor *at)
{
    if (at->step == track->steps)
        return INFINITY;
    const struct br_tip_step *tip = &track->tip[at->step];
    return tip->start + inside[at->instant] * tip->length;
}

static void cursor_advance(struct cursor *at)
{
    if (++at->instant == INSTANTS) {
        at->instant = 0;
        at->step++;
    }
}

/* Work of the comparisons in a step; a translated step serves those in two. */
static double step_work(const struct pair *p)
{
    const double a = (double)p->field[0]->modes.count, b = (double)p->field[1]->modes.count;
    return 3e-4 * a * b + 0.035 * a;
}

/* Compares at each step of either solution, in order of time. What is begun is ended, though no
 * work be left for it; but not where somebody stops it. */
static enum br_status compare_field(struct pair *p, double duration, struct br_effort *effort,
                                    struct br_exact_report *report, struct br_error *err)
{
    struct br_error spent;
    struct cursor at[2] = {{0, 0}, {0, 0}};
    if (!same_phases(p->track[0], p->track[1])) {
        report->error = (struct br_exact_size){INFINITY, INFINITY, INFINITY, INFINITY};
        return BR_OK;
    }
    for (;;) {
        const double t[2] = {cursor_time(p->track[0], &at[0]), cursor_time(p->track[1], &at[1])};
        const size_t first = t[1] < t[0];
        if (isinf(t[first]))
            break;
        compare_at(p, t[first], duration, report);
        cursor_advance(&at[first]);
        if (at[first].instant == 0 &&
            br_effort_spend(effort, step_work(p), &spent) == BR_INTERRUPTED)
            return br_fail(err, BR_INTERRUPTED, "%s", spent.message);
    }
    compare_at(p, duration, duration, report);
    return BR_OK;
}

enum br_status br_exact_compare(struct br_exact *exact, const struct br_exact_solution *other,
                                const struct br_outline outline[BR_EXACT_FIELDS],
                                struct br_effort *effort, struct br_error *err)
{
    enum br_status status = BR_OK;
    for (size_t which = 0; which < BR_EXACT_FIELDS && !status; which++) {
        struct br_exact_report *report = &exact->report[which];
        *report = (struct br_exact_report){0};
        if (!exact->solution->track[which])
            continue;
        struct pair p = {.outline = &outline[which]};
        report->modes = exact->solution->field[which]->modes.count;
        report->steps = exact->solution->track[which]->steps;
        exact->noise[which] = 1e-13 * exact->solution->track[which]->free_velocity;
        status = pair_init(&p, exact->solution, other, which, err);
        if (!status)
            status = compare_field(&p, exact->duration, effort, report, err);
        br_store_clear(&p.store);
    }
    return status;
}

/* A phase that goes on through an event of the other field is none. */
static bool is_event(const struct br_history *track, size_t i)
{
    return i == 0 || track->entry[i].phase != track->entry[i - 1].phase;
}

static int by_time(const void *a, const void *b)
{
    const struct br_exact_event *x = a, *y = b;
    if (x->time != y->time)
        return x->time < y->time ? -1 : 1;
    return (int)x->field - (int)y->field;
}

enum br_status br_exact_list_events(struct br_exact *exact, const struct br_exact_solution *other,
                                    struct br_error *err)
{
    size_t room = 0;
    for (size_t which = 0; which < BR_EXACT_FIELDS; which++)
        if (exact->solution->track[which])
            room += exact->solution->track[which]->entries;
    exact->event = br_allocate(room, sizeof *exact->event);
    if (!exact->event)
        return br_no_memory(err, "the events");
    for (size_t which = 0; which < BR_EXACT_FIELDS; which++) {
        const struct br_history *track = exact->solution->track[which];
        for (size_t i = 0; track && i < track->entries; i++) {
            const double t = track->entry[i].time, t2 = other->track[which]->entry[i].time;
            if (is_event(track, i))
                exact->event[exact->events++] = (struct br_exact_event){
                    .time = t,
                    .error = safety * fabs(t - t2) + track->entry[i].error,
                    .field = (enum br_exact_field)which,
                    .phase = track->entry[i].phase,
                };
        }
    }
    qsort(exact->event, exact->events, sizeof *exact->event, by_time);
    for (size_t i = 1; i < exact->events; i++) /* errors are handed on, agreement may be luck */
        grow(&exact->event[i].error, exact->event[i - 1].error);
    return BR_OK;
}
