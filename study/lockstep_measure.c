/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>

#include "study/lockstep_state.h"

/* The channel, or NULL where it is not in use at that level. */
static struct br_channel *channel_at(struct br_lockstep *l, int kind, int measure, bool last)
{
    struct br_channel *c = br_channel_of(l, (enum br_field_kind)kind, (enum br_measure)measure);
    return c->used && (last || !c->last_only) ? c : NULL;
}

static double norm(const double *modes, size_t count, double rest)
{
    enum { LANES = 8 }; /* one sum would wait for itself at every term */
    double part[LANES] = {0}, sum = rest;
    for (size_t i = 0; i + LANES <= count; i += LANES)
        for (size_t j = 0; j < LANES; j++)
            part[j] += modes[i + j] * modes[i + j];
    for (size_t i = count - count % LANES; i < count; i++)
        sum += modes[i] * modes[i];
    for (size_t j = 0; j < LANES; j++)
        sum += part[j];
    return sqrt(sum);
}

static double reference_time(const struct br_lockstep *l, size_t level)
{
    return l->study->scene->duration * (double)level / (double)l->study->reference.steps;
}

static void add_to_all(const struct br_lockstep *l, const struct br_sample *sample,
                       struct br_norm_sum *sum)
{
    for (const struct br_study *s = l->study; s; s = s->next_norm)
        br_norm_add(s->norm, s->scene, sample, sum++);
}

static double *slot_of(const struct br_channel *c, struct br_slot slot)
{
    return c->projection[slot.buffer] + slot.index * c->size;
}

/* Looks at the reference and projects it; returns its size. */
static double project(struct br_lockstep *l, struct br_channel *c, struct br_look_at at,
                      double *projection)
{
    for (at.mesh = 0; at.mesh < (c->ladder ? l->roots : 1); at.mesh++)
        l->reference.judge->look(l->reference.self, &at, c->root[at.mesh].modes,
                                 &c->root[at.mesh].rest);
    if (c->ladder)
        br_ladder_project(c->ladder, c->root, projection);
    else
        *projection = l->study->reference_tip[at.kind] = c->root[0].modes[0];
    return norm(c->root[0].modes, br_measure_size(at.kind, at.measure, l->root[0]),
                c->root[0].rest);
}

void br_lockstep_project(struct br_lockstep *l, struct br_slot slot, size_t level)
{
    const double t = reference_time(l, level);
    struct br_sample sample = {.time = t, .weight = t - l->scale_time};
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        for (int measure = 0; measure < BR_MEASURES; measure++) {
            const struct br_look_at at = {(enum br_field_kind)kind, (enum br_measure)measure, 0};
            struct br_channel *c = channel_at(l, kind, measure, level == l->study->reference.steps);
            if (c)
                sample.size[kind][measure] = project(l, c, at, slot_of(c, slot));
        }
    add_to_all(l, &sample, l->scale_sum);
    l->scale_time = t;
}

/* The distance of the reference, as last looked at, from the auditor. */
static double audit(struct br_lockstep *l, struct br_channel *c, const struct br_look_at *at)
{
    double rest;
    l->auditor.judge->look(l->auditor.self, at, c->audit, &rest);
    const size_t size = br_measure_size(at->kind, at->measure, l->root[0]);
    for (size_t i = 0; i < size; i++)
        c->audit[i] -= c->root[0].modes[i];
    return norm(c->audit, size, rest);
}

enum br_status br_lockstep_audit(struct br_lockstep *l, size_t level, struct br_error *err)
{
    const enum br_status status = l->auditor.judge->advance(l->auditor.self, level, err);
    if (status)
        return status;
    const double t = reference_time(l, level);
    struct br_sample sample = {.time = t, .weight = t - l->audit_time};
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        for (int measure = 0; measure < BR_MEASURES; measure++) {
            const struct br_look_at at = {(enum br_field_kind)kind, (enum br_measure)measure, 0};
            struct br_channel *c = channel_at(l, kind, measure, level == l->study->reference.steps);
            if (c)
                sample.size[kind][measure] = audit(l, c, &at);
        }
    add_to_all(l, &sample, l->audit_sum);
    l->audit_time = t;
    return BR_OK;
}

/* The distance of a cell, as it stands, from the reference in one measure. */
static double distance(struct br_lockstep *l, size_t index, const struct br_channel *c,
                       const double *reference)
{
    const struct br_runner *r = &l->cell[index];
    if (!c->ladder)
        return fabs(r->modes[0] - *reference);
    return br_ladder_distance(c->ladder, br_study_row(l->study, index), r->modes, reference);
}

void br_lockstep_measure(struct br_lockstep *l, size_t index, struct br_slot slot)
{
    struct br_runner *r = &l->cell[index];
    struct br_cell *cell = &l->study->cell[index];
    const bool last = br_march_steps_done(r->march) == cell->at.steps;
    const double t = br_march_time(r->march);
    struct br_sample sample = {
        .time = t,
        .weight = t > 0 ? br_time_step(l->study->scene, cell->at.steps) : 0,
    };
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        for (int measure = 0; measure < BR_MEASURES; measure++) {
            const struct br_channel *c = channel_at(l, kind, measure, last);
            if (!c)
                continue;
            br_runner_look(r, (enum br_field_kind)kind, (enum br_measure)measure);
            const double size = distance(l, index, c, slot_of(c, slot));
            if (!isfinite(size))
                br_fail(&r->error, BR_NOT_FINITE, "the error at t = %g s is %g", t, size);
            sample.size[kind][measure] = size;
            if (measure == BR_TIP)
                cell->tip[kind] = r->modes[0];
        }
    if (r->error.status)
        br_cell_failed(l->study, index, &r->error);
    else
        add_to_all(l, &sample, l->cell_sum + index * l->norms);
}

void br_cell_failed(struct br_study *study, size_t index, const struct br_error *error)
{
    for (struct br_study *s = study; s; s = s->next_norm) {
        struct br_cell *cell = &s->cell[index];
        cell->failure = *error;
        for (int part = 0; part < BR_PARTS; part++) {
            cell->error[part] = NAN;
            cell->flag[part] = BR_FLAG_FAILED;
        }
    }
}

/* One cell in one norm. */
static void conclude_cell(const struct br_lockstep *l, struct br_study *s, size_t index,
                          const struct br_norm_sum *sum)
{
    struct br_cell *cell = &s->cell[index];
    const struct br_cell *first = &l->study->cell[index];
    cell->seconds = l->cell[index].seconds;
    cell->unstable = first->unstable;
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        cell->tip[kind] = first->tip[kind];
    for (int part = 0; part < BR_PARTS && !cell->failure.status; part++) {
        cell->error[part] = br_norm_value(s->norm, sum, (enum br_part)part);
        cell->worst_time[part] = sum->time[part];
    }
}

void br_lockstep_conclude(struct br_lockstep *l)
{
    size_t m = 0;
    for (struct br_study *s = l->study; s; s = s->next_norm, m++) {
        s->auditor = l->study->auditor;
        s->judged_by = l->reference.judge->report(l->reference.self);
        s->reference_scale = br_norm_value(s->norm, &l->scale_sum[m], BR_PART_TOTAL);
        for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++)
            s->reference_tip[kind] = l->study->reference_tip[kind];
        for (int part = 0; part < BR_PARTS; part++)
            s->reference_error[part] =
                s->auditor ? br_norm_value(s->norm, &l->audit_sum[m], (enum br_part)part) : NAN;
        for (size_t i = 0; i < br_study_cells(s); i++)
            conclude_cell(l, s, i, &l->cell_sum[i * l->norms + m]);
    }
}
