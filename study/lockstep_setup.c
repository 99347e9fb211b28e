/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>

#include "study/lockstep_state.h"

static const size_t buffer_bytes = 8u << 20; /* of a batch's projections, at most */
static const size_t most_levels = 32;        /* in a batch */
static const size_t most_audits = 1000;      /* of the reference, about */

/* Every reference step that is a time level of some cell, 0 included. */
static enum br_status list_levels(struct br_lockstep *l, struct br_error *err)
{
    const struct br_study *s = l->study;
    size_t most = 1;
    for (size_t j = 0; j < s->k_count; j++)
        most += s->steps[j];
    l->level = br_allocate(most, sizeof *l->level);
    if (!l->level)
        return br_no_memory(err, "the time levels");
    l->level_count = 1; /* t = 0 */
    for (size_t last = 0; last < s->reference.steps;) {
        size_t next = s->reference.steps;
        for (size_t j = 0; j < s->k_count; j++) {
            const size_t ratio = s->reference.steps / s->steps[j];
            const size_t candidate = (last / ratio + 1) * ratio;
            next = candidate < next ? candidate : next;
        }
        l->level[l->level_count++] = last = next;
    }
    return BR_OK;
}

/* The meshes that the reference is looked at on: its own where it has one; else
 * those of the cells that are no divisor of another's. */
static enum br_status list_roots(struct br_lockstep *l, struct br_error *err)
{
    const struct br_study *s = l->study;
    l->root = br_allocate(s->n_count, sizeof *l->root);
    if (!l->root)
        return br_no_memory(err, "the meshes");
    if (s->judge->nests) {
        l->root[l->roots++] = s->reference.n;
        return BR_OK;
    }
    for (size_t i = 0; i < s->n_count; i++) {
        bool divides = false;
        for (size_t j = 0; j < s->n_count; j++)
            divides |= s->n[j] % s->n[i] == 0 && (s->n[j] > s->n[i] || j < i);
        if (!divides)
            l->root[l->roots++] = s->n[i];
    }
    return BR_OK;
}

static enum br_status create_roots(struct br_lockstep *l, enum br_field_kind kind,
                                   struct br_error *err)
{
    struct br_channel *c = &l->channel[kind];
    c->root = br_allocate(l->roots, sizeof *c->root);
    if (!c->root)
        return br_no_memory(err, "the reference's values");
    for (size_t i = 0; i < l->roots; i++) {
        c->root[i].modes = br_allocate(l->root[i] * br_mode_count(kind), sizeof(double));
        if (!c->root[i].modes)
            return br_no_memory(err, "the reference's values");
    }
    c->audit = br_allocate(l->root[0] * br_mode_count(kind), sizeof(double));
    return c->audit ? BR_OK : br_no_memory(err, "the reference's values");
}

static enum br_status create_ladders(struct br_lockstep *l, struct br_error *err)
{
    const struct br_study *s = l->study;
    const struct br_mesh_list roots = {l->roots, l->root}, rungs = {s->n_count, s->n};
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        struct br_channel *c = &l->channel[kind];
        c->modelled = kind == BR_AXIAL ? s->scene->axial.modelled : s->scene->bending.modelled;
        if (!c->modelled)
            continue;
        enum br_status status =
            br_ladder_create(&c->ladder, (enum br_field_kind)kind, &roots, &rungs, err);
        if (!status)
            status = create_roots(l, (enum br_field_kind)kind, err);
        if (status)
            return status;
    }
    return BR_OK;
}

static enum br_status create_buffers(struct br_lockstep *l, struct br_error *err)
{
    size_t doubles = 0;
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        doubles += l->channel[kind].modelled ? br_ladder_size(l->channel[kind].ladder) : 0;
    l->batch = buffer_bytes / (doubles * sizeof(double));
    l->batch = l->batch < 1 ? 1 : l->batch > most_levels ? most_levels : l->batch;
    l->batches = (l->level_count + l->batch - 1) / l->batch;
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        for (int b = 0; b < BR_LOCKSTEP_BUFFERS && l->channel[kind].modelled; b++) {
            struct br_channel *c = &l->channel[kind];
            c->projection[b] = br_allocate(l->batch * br_ladder_size(c->ladder), sizeof(double));
            if (!c->projection[b])
                return br_no_memory(err, "the reference's projections");
        }
    return BR_OK;
}

/* An auditor that cannot promise a solution of this scene is done without. */
static void dismiss_auditor(struct br_lockstep *l)
{
    l->auditor.judge->free(l->auditor.self);
    l->auditor = (struct br_bench){0};
    l->study->auditor = NULL;
    for (int part = 0; part < BR_PARTS; part++)
        l->study->reference_error[part] = NAN;
}

/* The reference, and who audits it. */
static enum br_status create_judges(struct br_lockstep *l, struct br_error *err)
{
    struct br_study *s = l->study;
    struct br_judge_request request = {
        .scene = s->scene,
        .method = s->reference_method,
        .n = s->reference.n,
        .levels = s->reference.steps,
        .mesh_count = l->roots,
        .mesh = l->root,
    };
    l->reference.judge = s->judge;
    const enum br_status status = s->judge->create(&l->reference.self, &request, err);
    if (status || !s->auditor)
        return status;
    l->auditor.judge = s->auditor;
    l->audit_every = l->level_count / most_audits + 1;
    request.modest = true;
    if (!s->auditor->create(&l->auditor.self, &request, &l->auditor.error))
        return BR_OK;
    if (l->auditor.error.status == BR_NO_MEMORY)
        return br_fail(err, BR_NO_MEMORY, "%s", l->auditor.error.message);
    dismiss_auditor(l);
    return BR_OK;
}

void br_cell_failed(struct br_cell *cell, const struct br_error *error)
{
    cell->failure = *error;
    for (int part = 0; part < BR_PARTS; part++) {
        cell->error[part] = NAN;
        cell->flag[part] = BR_FLAG_FAILED;
    }
}

static enum br_status create_cells(struct br_lockstep *l, struct br_error *err)
{
    const struct br_study *s = l->study;
    const size_t cells = s->n_count * s->k_count;
    l->cell = br_allocate(cells, sizeof *l->cell);
    if (!l->cell)
        return br_no_memory(err, "the cells");
    for (size_t i = 0; i < cells; i++) {
        br_runner_start(&l->cell[i], s->scene, s->cell[i].at, &s->method);
        const enum br_status failure = l->cell[i].error.status;
        if (failure == BR_BAD_INPUT || failure == BR_NO_MEMORY)
            return br_fail(err, failure, "%s", l->cell[i].error.message);
        if (!failure)
            s->cell[i].unstable = br_march_contact_unstable(l->cell[i].march);
        if (failure)
            br_cell_failed(&s->cell[i], &l->cell[i].error);
    }
    return BR_OK;
}

enum br_status br_lockstep_create(struct br_lockstep *l, struct br_study *s,
                                  const struct br_observer *observer, struct br_error *err)
{
    l->study = s;
    l->observer = observer;
    enum br_status status = list_levels(l, err);
    if (!status)
        status = list_roots(l, err);
    if (!status)
        status = create_ladders(l, err);
    if (!status)
        status = create_buffers(l, err);
    if (!status)
        status = create_judges(l, err);
    if (!status)
        status = create_cells(l, err);
    return status;
}

static void channel_clear(struct br_channel *c, size_t roots)
{
    br_ladder_free(c->ladder);
    for (size_t i = 0; c->root && i < roots; i++)
        free(c->root[i].modes);
    free(c->root);
    free(c->audit);
    for (int b = 0; b < BR_LOCKSTEP_BUFFERS; b++)
        free(c->projection[b]);
}

void br_lockstep_clear(struct br_lockstep *l)
{
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        channel_clear(&l->channel[kind], l->roots);
    if (l->reference.judge)
        l->reference.judge->free(l->reference.self);
    if (l->auditor.judge)
        l->auditor.judge->free(l->auditor.self);
    for (size_t i = 0; l->cell && i < l->study->n_count * l->study->k_count; i++)
        br_runner_clear(&l->cell[i]);
    free(l->cell);
    free(l->root);
    free(l->level);
}
