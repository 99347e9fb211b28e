/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/exact/inside.h"

#include <math.h>
#include <pthread.h>
#include <stdint.h>

struct br_exact_report br_exact_report(const struct br_exact *exact, enum br_field_kind field)
{
    return exact->report[field];
}

const struct br_exact_event *br_exact_events(const struct br_exact *exact, size_t *count)
{
    *count = exact->events;
    return exact->event;
}

const char *br_phase_text(enum br_phase phase)
{
    static const char *const text[] = {
#define X(name, text) [name] = text,
        BR_PHASE_LIST(X)
#undef X
    };
    return text[phase];
}

enum br_status br_exact_state_create(struct br_exact_state **out, const struct br_exact *exact,
                                     struct br_error *err)
{
    size_t count = 0;
    for (size_t i = 0; i < BR_FIELDS; i++)
        count += exact->report[i].modes;
    struct br_exact_state *state = *out =
        br_allocate(1, sizeof *state + 2 * count * sizeof(double));
    if (!state)
        return br_no_memory(err, "a state of the exact solution");
    double *next = state->memory;
    for (size_t i = 0; i < BR_FIELDS; i++)
        for (size_t j = 0; j < 2 && exact->solution->field[i]; j++) {
            state->mode[i][j] = next;
            next += exact->report[i].modes;
        }
    br_exact_at(exact, 0, state);
    return BR_OK;
}

void br_exact_state_free(struct br_exact_state *state)
{
    free(state);
}

void br_exact_field_at(const struct br_exact *exact, enum br_field_kind field, double t,
                       struct br_exact_state *state)
{
    const struct br_history *track = exact->solution->track[field];
    if (!track)
        return;
    const double time = fmin(fmax(t, 0), exact->duration);
    const struct br_tip_state tip =
        br_history_at(track, time, state->mode[field][0], state->mode[field][1]);
    state->tip[field].displacement = tip.displacement + track->gap;
    state->tip[field].velocity = tip.velocity;
    state->force[field] = br_law_at(&exact->solution->law[field], time, &tip).force;
}

void br_exact_at(const struct br_exact *exact, double t, struct br_exact_state *state)
{
    state->time = fmin(fmax(t, 0), exact->duration);
    br_exact_field_at(exact, BR_AXIAL, t, state);
    br_exact_field_at(exact, BR_BENDING, t, state);
    state->friction_bound = br_law_bound(&exact->solution->law[BR_BENDING], state->time);
}

/* Refuses (BR_BAD_INPUT) fields that are not modelled, and orders above the field's (1 axial, 2
 * bending). */
static enum br_status check_quantity(const struct br_exact *exact,
                                     const struct br_exact_quantity *quantity, struct br_error *err)
{
    const struct br_oscillators *field =
        quantity->field < BR_FIELDS ? exact->solution->field[quantity->field] : NULL;
    if (!field)
        return br_fail(err, BR_BAD_INPUT, "a field that is not modelled was asked for");
    if (quantity->order > field->modes.degree)
        return br_fail(err, BR_BAD_INPUT,
                       "a derivative of order %u was asked for, expected at most %zu",
                       quantity->order, field->modes.degree);
    return BR_OK;
}

/* ---- shared solutions ---- */

/* A scene is identified by its address, which is unique while a user has the solution. Without
 * users: a free entry. A solution that finds no free entry is not shared. */
static struct loan {
    const struct br_scene *scene;
    struct br_exact_options options;
    const struct br_exact *exact;
    size_t users;
} loans[64];
enum { MOST_LOANS = sizeof loans / sizeof *loans };

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;

static size_t most_modes(const struct br_exact_options *o)
{
    return o->max_modes ? o->max_modes : SIZE_MAX;
}

static bool below(const struct br_exact *exact, size_t limit)
{
    return exact->report[0].modes < limit && exact->report[1].modes < limit;
}

/* Whether a loan is the solution for `o`: a limit to the modes that was not reached changes
 * nothing. */
static bool serves(const struct loan *loan, const struct br_scene *scene,
                   const struct br_exact_options *o)
{
    const struct br_exact_options *l = &loan->options;
    const bool same = l->tolerance == o->tolerance && l->acceptable == o->acceptable &&
                      l->max_steps == o->max_steps;
    return loan->users && loan->scene == scene && same &&
           (most_modes(l) == most_modes(o) ||
            (below(loan->exact, most_modes(l)) && below(loan->exact, most_modes(o))));
}

enum br_status br_exact_borrow(const struct br_exact **out, const struct br_scene *scene,
                               const struct br_exact_options *options, struct br_error *err)
{
    struct br_exact *made = NULL;
    *out = NULL;
    pthread_mutex_lock(&lock);
    for (struct loan *loan = loans; loan < loans + MOST_LOANS && !*out; loan++)
        if (serves(loan, scene, options)) {
            loan->users++;
            *out = loan->exact;
        }
    pthread_mutex_unlock(&lock);
    const enum br_status status = *out ? BR_OK : br_exact_create(&made, scene, options, err);
    if (!made)
        return status;
    *out = made;
    pthread_mutex_lock(&lock);
    size_t i = 0;
    while (i < MOST_LOANS && loans[i].users)
        i++;
    if (i < MOST_LOANS)
        loans[i] = (struct loan){scene, *options, made, 1};
    pthread_mutex_unlock(&lock);
    return BR_OK;
}

void br_exact_give_back(const struct br_exact *exact)
{
    bool last = true;
    pthread_mutex_lock(&lock);
    for (size_t i = 0; i < MOST_LOANS; i++)
        if (loans[i].users && loans[i].exact == exact)
            last = --loans[i].users == 0;
    pthread_mutex_unlock(&lock);
    if (last)
        br_exact_free((struct br_exact *)(uintptr_t)exact); /* nobody else has it */
}

/* ---- projections ---- */

struct br_exact_projection {
    struct br_exact_quantity quantity;
    size_t modes, length; /* of the field, of its quantity's series */
    double *expand;       /* modes x length: each mode's series */
    double *series;       /* length, workspace */
    struct br_piecewise *piecewise;
    struct br_store store;
};

static enum br_status projection_init(struct br_exact_projection *p,
                                      const struct br_oscillators *field,
                                      const struct br_exact_mesh *mesh, struct br_error *err)
{
    const struct br_modes *modes = &field->modes;
    const double scale = pow(field->length, -(double)p->quantity.order);
    p->modes = modes->count;
    p->length = br_modes_length(modes, p->quantity.order);
    p->expand = br_store_take(&p->store, p->modes * p->length, sizeof *p->expand);
    p->series = br_store_take(&p->store, p->length, sizeof *p->series);
    double *q = br_store_take(&p->store, p->modes, sizeof *q);
    double *longest = br_store_take(&p->store, br_modes_length(modes, 0), sizeof *longest);
    if (p->store.failed)
        return br_no_memory(err, "a projection");
    for (size_t i = 0; i < p->modes; i++) {
        q[i] = 1;
        br_modes_expand(modes, p->quantity.order, q, longest);
        for (size_t k = 0; k < p->length; k++)
            p->expand[i * p->length + k] = scale * longest[k];
        q[i] = 0;
    }
    return br_piecewise_create(&p->piecewise, &modes->spectral, modes->degree - p->quantity.order,
                               mesh, &p->store, err);
}

enum br_status br_exact_projection_create(struct br_exact_projection **out,
                                          const struct br_exact *exact,
                                          const struct br_exact_quantity *quantity,
                                          const struct br_exact_mesh *mesh, struct br_error *err)
{
    *out = NULL;
    enum br_status status = check_quantity(exact, quantity, err);
    if (!status && (!mesh->elements || mesh->degree > 8))
        status = br_fail(err, BR_BAD_INPUT,
                         "%zu elements of degree %zu, expected 1 or more of at most 8",
                         mesh->elements, mesh->degree);
    if (status)
        return status;
    struct br_exact_projection *p = br_allocate(1, sizeof *p);
    if (!p)
        return br_no_memory(err, "a projection");
    p->quantity = *quantity;
    status = projection_init(p, exact->solution->field[quantity->field], mesh, err);
    if (status)
        br_exact_projection_free(p);
    else
        *out = p;
    return status;
}

void br_exact_projection_free(struct br_exact_projection *p)
{
    if (!p)
        return;
    br_store_clear(&p->store);
    free(p);
}

void br_exact_projection_apply(struct br_exact_projection *p, const struct br_exact_state *state,
                               double *c, double *rest)
{
    br_combine(1, p->modes, state->mode[p->quantity.field][p->quantity.velocity], p->length,
               p->expand, p->series);
    br_piecewise_apply(p->piecewise, p->series, c, rest);
}
