/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>

#include "study/grid/lockstep.h"

/* The channel, or NULL where it is not in use at that level. */
static struct br_channel *channel_at(struct br_lockstep *l, enum br_field_kind kind, int measure,
                                     bool last)
{
    struct br_channel *c = br_channel_of(l, kind, (enum br_measure)measure);
    return c->used && (last || !c->last_only) ? c : NULL;
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
static double project(struct br_lockstep *l, struct br_channel *c, struct br_sample_at at,
                      double *projection)
{
    for (at.mesh = 0; at.mesh < (c->ladder ? l->roots : 1); at.mesh++)
        l->reference.judge->sample(l->reference.self, &at, &c->root[at.mesh]);
    if (!c->ladder) {
        *projection = l->study->reference_tip[at.kind] = c->root[0].values[0];
        return fabs(*projection);
    }
    br_ladder_project(c->ladder, c->root, projection);
    return br_ladder_norm(c->ladder, projection);
}

void br_lockstep_project(struct br_lockstep *l, enum br_field_kind kind, struct br_slot slot,
                         size_t level)
{
    double *size = l->scale[slot.buffer][slot.index].size[kind];
    for (int measure = 0; measure < BR_MEASURES; measure++) {
        const struct br_sample_at at = {kind, (enum br_measure)measure, 0};
        struct br_channel *c = channel_at(l, kind, measure, level == l->study->reference.steps);
        size[measure] = c ? project(l, c, at, slot_of(c, slot)) : 0;
    }
}

/* The distance of the reference, as last looked at, from the auditor. */
static double audit(struct br_lockstep *l, struct br_channel *c, const struct br_sample_at *at)
{
    l->auditor.judge->sample(l->auditor.self, at, &c->audit);
    if (!c->audit_ladder)
        return fabs(c->audit.values[0] - c->root[0].values[0]);
    br_ladder_project(c->audit_ladder, c->root, c->audit_projection);
    return br_ladder_distance(c->audit_ladder, 0, &c->audit, c->audit_projection);
}

bool br_lockstep_audits(const struct br_lockstep *l, size_t index)
{
    return l->auditor.judge && (index % l->audit_every == 0 || index + 1 == l->level_count);
}

enum br_status br_lockstep_audit(struct br_lockstep *l, enum br_field_kind kind,
                                 struct br_slot slot, size_t level, struct br_error *err)
{
    const enum br_status status = l->auditor.judge->advance(l->auditor.self, kind, level, err);
    double *size = l->audit[slot.buffer][slot.index].size[kind];
    for (int measure = 0; measure < BR_MEASURES && !status; measure++) {
        const struct br_sample_at at = {kind, (enum br_measure)measure, 0};
        struct br_channel *c = channel_at(l, kind, measure, level == l->study->reference.steps);
        size[measure] = c ? audit(l, c, &at) : 0;
    }
    return status;
}

/* A sample's share of an integral over time goes back to the one before it. */
static void add_sample(const struct br_lockstep *l, struct br_sample *sample, double *last,
                       struct br_norm_sum *sum)
{
    sample->weight = sample->time - *last;
    *last = sample->time;
    add_to_all(l, sample, sum);
}

void br_lockstep_add_up(struct br_lockstep *l, struct br_slot slot, size_t index)
{
    const double t = reference_time(l, l->level[index]);
    struct br_sample *scale = &l->scale[slot.buffer][slot.index];
    struct br_sample *audited = &l->audit[slot.buffer][slot.index];
    scale->time = audited->time = t;
    add_sample(l, scale, &l->scale_time, l->scale_sum);
    if (br_lockstep_audits(l, index))
        add_sample(l, audited, &l->audit_time, l->audit_sum);
}

/* The distance of a cell, as it stands, from the reference in one measure. */
static double distance(struct br_lockstep *l, size_t index, const struct br_channel *c,
                       const double *reference)
{
    const struct br_runner *r = &l->cell[index];
    if (!c->ladder)
        return fabs(r->view.values[0] - *reference);
    return br_ladder_distance(c->ladder, br_study_row(l->study, index), &r->view, reference);
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
            const struct br_channel *c = channel_at(l, (enum br_field_kind)kind, measure, last);
            if (!c)
                continue;
            br_look(r->march, (enum br_field_kind)kind, (enum br_measure)measure, &r->view);
            const double size = distance(l, index, c, slot_of(c, slot));
            if (!isfinite(size))
                br_fail(&r->error, BR_NOT_FINITE, "the error at t = %g s is %g", t, size);
            sample.size[kind][measure] = size;
            if (measure == BR_TIP)
                cell->tip[kind] = r->view.values[0];
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
    cell->unstable = l->cell[index].march && br_march_contact_unstable(l->cell[index].march);
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
        for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
            const enum br_part part = kind == BR_AXIAL ? BR_PART_AXIAL : BR_PART_BENDING;
            s->reference_size[kind] = br_norm_value(s->norm, &l->scale_sum[m], part);
            s->reference_tip[kind] = l->study->reference_tip[kind];
        }
        for (int part = 0; part < BR_PARTS; part++)
            s->reference_error[part] =
                s->auditor ? br_norm_value(s->norm, &l->audit_sum[m], (enum br_part)part) : NAN;
        for (size_t i = 0; i < br_study_cells(s); i++)
            conclude_cell(l, s, i, &l->cell_sum[i * l->norms + m]);
    }
}
