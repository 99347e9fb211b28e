/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <cblas.h>
#include <math.h>

#include "reference/exact/legendre.h"
#include "reference/exact/query.h"

struct br_exact_report br_exact_report(const struct br_exact *exact, enum br_exact_field field)
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
    bool done = true;
    *out = br_allocate(1, sizeof **out);
    if (!*out)
        return br_no_memory(err, "a state of the exact solution");
    for (size_t i = 0; i < BR_EXACT_FIELDS; i++)
        for (size_t j = 0; j < 2 && exact->solution->field[i]; j++) {
            (*out)->mode[i][j] = br_allocate(exact->report[i].modes, sizeof(double));
            done = done && (*out)->mode[i][j];
        }
    if (done) {
        br_exact_at(exact, 0, *out);
        return BR_OK;
    }
    br_exact_state_free(*out);
    *out = NULL;
    return br_no_memory(err, "a state of the exact solution");
}

void br_exact_state_free(struct br_exact_state *state)
{
    if (!state)
        return;
    for (size_t i = 0; i < BR_EXACT_FIELDS; i++)
        for (size_t j = 0; j < 2; j++)
            free(state->mode[i][j]);
    free(state);
}

void br_exact_field_at(const struct br_exact *exact, enum br_exact_field field, double t,
                       struct br_exact_state *state)
{
    const struct br_track *track = exact->solution->track[field];
    if (!track)
        return;
    const double time = fmin(fmax(t, 0), exact->duration);
    const struct br_tip_state tip =
        br_track_at(track, time, state->mode[field][0], state->mode[field][1]);
    state->tip[field].displacement = tip.displacement + track->gap;
    state->tip[field].velocity = tip.velocity;
    const double force = br_law_force_at(&exact->solution->law[field], time, &tip);
    *(field == BR_EXACT_AXIAL ? &state->contact_force : &state->friction_force) = force;
}

void br_exact_at(const struct br_exact *exact, double t, struct br_exact_state *state)
{
    state->time = fmin(fmax(t, 0), exact->duration);
    br_exact_field_at(exact, BR_EXACT_AXIAL, t, state);
    br_exact_field_at(exact, BR_EXACT_BENDING, t, state);
    state->friction_bound = br_law_bound(&exact->solution->law[BR_EXACT_BENDING], state->time);
}

enum br_status br_exact_check_part(const struct br_exact *exact, const struct br_exact_part *part,
                                   size_t extra, struct br_error *err)
{
    const struct br_field *field =
        part->field < BR_EXACT_FIELDS ? exact->solution->field[part->field] : NULL;
    if (!field)
        return br_fail(err, BR_BAD_INPUT, "a field that is not modelled was asked for");
    if (part->order > field->modes->degree + extra)
        return br_fail(err, BR_BAD_INPUT,
                       "a derivative of order %u was asked for, expected at most %zu", part->order,
                       field->modes->degree + extra);
    return BR_OK;
}

void br_exact_series(const struct br_exact *exact, const struct br_exact_state *state,
                     const struct br_exact_part *part, double *c)
{
    const struct br_field *field = exact->solution->field[part->field];
    const size_t degree = field->modes->degree;
    const size_t order = part->order < degree ? part->order : degree;
    const size_t length = br_modes_length(field->modes, order);
    br_modes_expand(field->modes, order, state->mode[part->field][part->velocity], c);
    cblas_dscal((int)length, pow(field->length, -(double)part->order), c, 1);
}

enum br_status br_exact_evaluate(const struct br_exact *exact, const struct br_exact_state *state,
                                 const struct br_exact_part *part, size_t count, const double *x,
                                 double *value, struct br_error *err)
{
    const enum br_status status = br_exact_check_part(exact, part, 1, err);
    if (status)
        return status;
    const struct br_field *field = exact->solution->field[part->field];
    const struct br_pieces *pieces = &field->modes->pieces;
    const size_t room = br_modes_length(field->modes, 0), degree = field->modes->degree;
    const bool derive = part->order > degree;
    const size_t extra = derive ? 0 : degree - part->order;
    double *c = br_allocate(3 * room, sizeof *c);
    if (!c)
        return br_no_memory(err, "a series");
    double *p = c + room, *dp = p + room;
    br_exact_series(exact, state, part, c);
    for (size_t i = 0; i < count; i++) {
        const size_t e = br_pieces_find(pieces, x[i]), terms = pieces->terms[e] + extra;
        const double h = br_pieces_width(pieces, e), *here = &c[br_pieces_at(pieces, e, extra)];
        br_legendre_derivative(terms, (x[i] - pieces->end[e]) / (h * field->length), p, dp);
        value[i] = cblas_ddot((int)terms, here, 1, derive ? dp : p, 1) / sqrt(h);
        if (derive)
            value[i] /= h;
    }
    free(c);
    return BR_OK;
}
