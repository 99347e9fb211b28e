/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>

#include "reference/exact/solution.h"

/* The estimate is this many times the distance of two solutions: either may be
 * the worse one, but hardly by less than that. */
static const double safety = 2;

/* After an event, a jump of the data or a blow that is as short, velocity and force are not
 * compared for this part of T. */
static const double layer = 1e-6;

/* One field of two solutions, with room for their values at one time. */
struct pair {
    const struct br_outline *outline;
    const struct br_oscillators *field[2];
    const struct br_law *law[2];
    const struct br_history *track[2];
    double *q[2], *v[2]; /* modes */
    double *series[2];   /* Legendre coefficients */
    struct br_store store;
};

static enum br_status pair_init(struct pair *p, const struct br_exact_solution *a,
                                const struct br_exact_solution *b, size_t which,
                                struct br_error *err)
{
    const struct br_exact_solution *solution[2] = {a, b};
    for (size_t i = 0; i < 2; i++) {
        p->field[i] = solution[i]->field[which];
        p->law[i] = &solution[i]->law[which];
        p->track[i] = solution[i]->track[which];
        const size_t m = p->field[i]->modes.count;
        p->q[i] = br_store_take(&p->store, m, sizeof(double));
        p->v[i] = br_store_take(&p->store, m, sizeof(double));
        p->series[i] =
            br_store_take(&p->store, br_modes_length(&p->field[i]->modes, 0), sizeof(double));
    }
    return p->store.failed ? br_no_memory(err, "the comparison of two solutions") : BR_OK;
}

/* Element e's coefficients of solution i, derived `order` times; *terms of them. */
static const double *series_on(const struct pair *p, size_t i, size_t order, size_t e,
                               size_t *terms)
{
    const struct br_modes *modes = &p->field[i]->modes;
    *terms = modes->pieces.terms[e] + modes->degree - order;
    return p->series[i] + br_pieces_at(&modes->pieces, e, modes->degree - order);
}

/* Root mean square over the beam of the difference of two fields on the same elements, derived
 * `order` times in x / L. */
static double distance(struct pair *p, double *const q[2], size_t order)
{
    for (size_t i = 0; i < 2; i++)
        br_modes_expand(&p->field[i]->modes, order, q[i], p->series[i]);
    double sum = 0;
    for (size_t e = 0; e < p->field[0]->modes.pieces.count; e++) {
        size_t length[2];
        const double *const c[2] = {series_on(p, 0, order, e, &length[0]),
                                    series_on(p, 1, order, e, &length[1])};
        for (size_t k = 0; k < length[0] || k < length[1]; k++) {
            const double a = k < length[0] ? c[0][k] : 0, b = k < length[1] ? c[1][k] : 0;
            sum += (a - b) * (a - b);
        }
    }
    return sqrt(sum);
}

/* Root mean square of the first field's velocity, derived in x / L. */
static double strain_norm(struct pair *p, size_t order)
{
    br_modes_expand(&p->field[0]->modes, order, p->v[0], p->series[0]);
    const size_t length = br_modes_length(&p->field[0]->modes, order);
    double sum = 0;
    for (size_t k = 0; k < length; k++)
        sum += p->series[0][k] * p->series[0][k];
    return sqrt(sum);
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

static void compare_at(struct pair *p, double t, bool smooth, struct br_exact_report *report)
{
    struct br_tip_state tip[2];
    for (size_t i = 0; i < 2; i++) {
        tip[i] = br_history_at(p->track[i], t, p->q[i], p->v[i]);
        tip[i].force = br_law_force_at(p->law[i], t, &tip[i]);
    }
    const double length = p->field[0]->length, norm = 1 / sqrt(length);
    const size_t degree = p->field[0]->modes.degree;
    const double strain = pow(length, -(double)degree);
    struct br_exact_size *largest = &report->largest, *error = &report->error;
    grow(&largest->displacement, norm * br_oscillators_norm(p->field[0], p->q[0], 1));
    grow(&largest->displacement, fabs(tip[0].displacement + p->track[0]->gap));
    grow(&largest->velocity, norm * br_oscillators_norm(p->field[0], p->v[0], 1));
    grow(&largest->velocity, fabs(tip[0].velocity));
    grow(&largest->force, fabs(tip[0].force));
    grow(&largest->strain_rate, strain_norm(p, degree) * strain);
    grow(&error->displacement, safety * distance(p, p->q, 0));
    grow(&error->displacement, safety * fabs(tip[0].displacement - tip[1].displacement));
    if (!smooth)
        return;
    grow(&error->velocity, safety * distance(p, p->v, 0));
    grow(&error->strain_rate, safety * distance(p, p->v, degree) * strain);
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

/* Compares where a step begins, where velocities are at their worst, and at some of its nodes,
 * where displacements are. */
static void compare_step(struct pair *p, const struct br_tip_step *tip, double duration,
                         struct br_exact_report *report)
{
    static const double inside[] = {0, 0.0913, 0.3719, 0.5452, 0.8556};
    for (size_t j = 0; j < sizeof inside / sizeof *inside; j++) {
        const double t = tip->start + inside[j] * tip->length;
        const bool smooth = !in_layer(p->track[0], t, layer * duration) &&
                            !in_layer(p->track[1], t, layer * duration) &&
                            !br_outline_is_sharp(p->outline, t, layer * duration);
        compare_at(p, t, smooth, report);
    }
}

/* Work of a step's comparison: sums over all modes, as long as these are. */
static double step_work(const struct pair *p)
{
    const double a = (double)p->field[0]->modes.count, b = (double)p->field[1]->modes.count;
    return 3e-3 * (a * a + b * b);
}

/* Compares at each step of either solution. What is begun is ended, though no work be left for it;
 * but not where somebody stops it. */
static enum br_status compare_field(struct pair *p, double duration, struct br_effort *effort,
                                    struct br_exact_report *report, struct br_error *err)
{
    struct br_error spent;
    if (!same_phases(p->track[0], p->track[1])) {
        report->error = (struct br_exact_size){INFINITY, INFINITY, INFINITY, INFINITY};
        return BR_OK;
    }
    for (size_t i = 0; i < 2; i++)
        for (size_t n = 0; n < p->track[i]->steps; n++) {
            compare_step(p, &p->track[i]->tip[n], duration, report);
            if (br_effort_spend(effort, step_work(p), &spent) == BR_INTERRUPTED)
                return br_fail(err, BR_INTERRUPTED, "%s", spent.message);
        }
    compare_at(p, duration, true, report);
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
