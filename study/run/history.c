/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/run/history.h"

#include <math.h>

#include "base/clock.h"
#include "base/words.h"
#include "solver/field.h"

struct history_run {
    const struct br_history_request *request;
    struct br_march *march;
    struct br_history_row row; /* of the level reached */
    size_t next_level;         /* index into request->level */
};

/* ---- rows ---- */

static void fill_row(struct history_run *r)
{
    const size_t step = br_march_steps_done(r->march);
    const struct br_tip *tip = step > 0 ? br_march_tip(r->march) : br_march_start(r->march);
    r->row = (struct br_history_row){
        .step = step,
        .time = br_march_time(r->march),
        .displacement = {tip->displacement, NAN},
        .velocity = {tip->velocity[BR_AXIAL], tip->velocity[BR_BENDING]},
        .contact_force = tip->contact_force,
        .friction_force = tip->friction_force,
        .friction_bound = tip->friction_bound,
    };
}

static void complete_row(struct history_run *r)
{
    if (isnan(r->row.displacement[BR_BENDING]))
        r->row.displacement[BR_BENDING] = br_march_tip_displacement(r->march, BR_BENDING);
}

/* ---- observers ---- */

static bool is_row(const struct history_run *r)
{
    const struct br_history_request *q = r->request;
    return q->stride && (r->row.step % q->stride == 0 || r->row.step == q->steps);
}

/* Whether this is a chosen level; true once for each. */
static bool is_chosen(struct history_run *r)
{
    const struct br_history_request *q = r->request;
    if (r->next_level >= q->levels || q->level[r->next_level] != r->row.step)
        return false;
    r->next_level++;
    return true;
}

static enum br_status report(struct history_run *r, struct br_error *err)
{
    const struct br_history_request *q = r->request;
    const struct br_history_observer *end = q->observer + q->observers;
    const bool row = is_row(r), sample = is_chosen(r);
    enum br_status status = BR_OK;
    for (const struct br_history_observer *o = q->observer; o < end && !status; o++)
        if (o->step)
            status = o->step(o->self, r->march, &r->row, err);
    if (row || sample)
        complete_row(r);
    for (const struct br_history_observer *o = q->observer; o < end && !status; o++) {
        if (row && o->row)
            status = o->row(o->self, &r->row, err);
        if (sample && o->sample && !status)
            status = o->sample(o->self, r->march, &r->row, err);
    }
    return status;
}

/* ---- the march ---- */

/* Appends the velocities before a march left the range of numbers. */
static void append_last(const struct history_run *r, struct br_error *err)
{
    if (!err)
        return;
    const struct br_history_row *last = &r->row;
    br_append(err->message, sizeof err->message,
              "; the last good step, %zu at t = %.15g s, has velocities of %.3g m/s (axial) and "
              "%.3g m/s (bending) at the tip",
              last->step, last->time, last->velocity[BR_AXIAL], last->velocity[BR_BENDING]);
}

/* Gives the last good row to `row`, if it has not had it: without the bending displacement, which
 * is lost. */
static void report_last(const struct history_run *r)
{
    const struct br_history_request *q = r->request;
    if (!q->stride || is_row(r))
        return;
    for (size_t i = 0; i < q->observers; i++)
        if (q->observer[i].row)
            q->observer[i].row(q->observer[i].self, &r->row, NULL);
}

static enum br_status begin(struct history_run *r, struct br_error *err)
{
    const struct br_history_request *q = r->request;
    enum br_status status = BR_OK;
    fill_row(r);
    for (size_t i = 0; i < q->observers && !status; i++)
        if (q->observer[i].begin)
            status = q->observer[i].begin(q->observer[i].self, r->march, err);
    return status;
}

static enum br_status march(struct history_run *r, struct br_error *err)
{
    enum br_status status = begin(r, err);
    if (!status)
        status = report(r, err);
    while (!status && r->row.step < r->request->steps) {
        status = br_march_step(r->march, err);
        if (status) {
            append_last(r, err);
            report_last(r);
            return status;
        }
        fill_row(r);
        status = report(r, err);
    }
    if (!status)
        complete_row(r);
    return status;
}

enum br_status br_history_run(const struct br_history_request *q, struct br_march **out,
                              struct br_history_end *end, struct br_error *err)
{
    struct history_run r = {.request = q};
    if (out)
        *out = NULL;
    *end = (struct br_history_end){0};
    const double start = br_seconds();
    enum br_status status = br_march_create(&r.march, q->scene, q->n, q->steps, q->method, err);
    end->set_up_seconds = br_seconds() - start;
    if (!status) {
        status = march(&r, err);
        end->march_seconds = br_seconds() - start - end->set_up_seconds;
    }
    end->last = r.row;
    if (out)
        *out = r.march;
    else
        br_march_free(r.march);
    return status;
}

/* ---- the recorder ---- */

/* Of a node: u, (w, s), and their velocities. */
static size_t values_of(const struct br_history_record *h)
{
    return 2 * (h->unknowns[BR_AXIAL] + h->unknowns[BR_BENDING]);
}

static enum br_status keep_row(void *self, const struct br_history_row *row, struct br_error *err)
{
    struct br_history_record *h = self;
    if (!br_grow(&h->row, h->rows, &h->most_rows, sizeof *h->row))
        return br_no_memory(err, "the tip's history");
    h->row[h->rows++] = *row;
    return BR_OK;
}

static size_t field_offset(const struct br_history_record *h, enum br_field_kind kind,
                           bool velocity)
{
    const size_t before = kind == BR_AXIAL ? 0 : 2 * h->unknowns[BR_AXIAL];
    return (h->n + 1) * (before + (velocity ? h->unknowns[kind] : 0));
}

static enum br_status keep_sample(void *self, const struct br_march *march,
                                  const struct br_history_row *row, struct br_error *err)
{
    struct br_history_record *h = self;
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        h->unknowns[kind] = br_field_unknowns(br_march_field(march, kind));
    const size_t size = values_of(h) * (h->n + 1);
    size_t most = h->most_samples; /* before both grow */
    if (!br_grow(&h->at, h->samples, &most, sizeof *h->at) ||
        !br_grow(&h->field, h->samples, &h->most_samples, size * sizeof *h->field))
        return br_no_memory(err, "the fields");
    double *field = h->field + h->samples * size;
    for (enum br_field_kind k = BR_AXIAL; k <= BR_BENDING; k++)
        br_march_get(march, k, field + field_offset(h, k, false), field + field_offset(h, k, true));
    h->at[h->samples++] = *row;
    return BR_OK;
}

struct br_history_observer br_history_recorder(struct br_history_record *record, size_t n)
{
    record->n = n;
    return (struct br_history_observer){.self = record, .row = keep_row, .sample = keep_sample};
}

void br_history_record_clear(struct br_history_record *h)
{
    free(h->row);
    free(h->at);
    free(h->field);
    *h = (struct br_history_record){0};
}

const double *br_history_field(const struct br_history_record *h, size_t sample,
                               enum br_field_kind kind, bool velocity)
{
    return h->field + sample * values_of(h) * (h->n + 1) + field_offset(h, kind, velocity);
}
