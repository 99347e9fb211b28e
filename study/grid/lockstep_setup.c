/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdint.h>

#include "solver/clock.h"
#include "study/grid/lockstep.h"

static const size_t buffer_bytes = 1u << 20; /* of a batch's projections, at most */
static const size_t most_levels = 32;        /* in a batch */
static const double least_work = 1e5;        /* element-steps of a crew in a batch, about */
static const size_t most_audits = 1000;      /* of the reference, about */

static enum br_status take_arrays(struct br_lockstep *l, struct br_error *err)
{
    const struct br_study *s = l->study;
    const size_t cells = br_study_cells(s);
    size_t levels = 1;
    for (size_t j = 0; j < s->k_count; j++)
        levels += s->steps[j];
    l->level = br_store_take(&l->store, levels, sizeof *l->level);
    l->root = br_store_take(&l->store, s->n_count, sizeof *l->root);
    l->cell = br_store_take(&l->store, cells, sizeof *l->cell);
    l->crew = br_store_take(&l->store, cells + 1, sizeof *l->crew);
    l->cell_sum = br_store_take(&l->store, cells * l->norms, sizeof *l->cell_sum);
    l->reference.sum = br_store_take(&l->store, l->norms, sizeof *l->reference.sum);
    l->auditor.sum = br_store_take(&l->store, l->norms, sizeof *l->auditor.sum);
    return l->store.failed ? br_no_memory(err, "the cells") : BR_OK;
}

/* Every reference step that is a time level of some cell, 0 included. */
static void list_levels(struct br_lockstep *l)
{
    const struct br_study *s = l->study;
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
}

/* The meshes that the reference is looked at on: its own where it has one; else
 * those of the cells that are no divisor of another's. */
static void list_roots(struct br_lockstep *l)
{
    const struct br_study *s = l->study;
    if (s->judge->nests)
        l->root[l->roots++] = s->reference.n;
    for (size_t i = 0; i < s->n_count && !s->judge->nests; i++) {
        bool divides = false;
        for (size_t j = 0; j < s->n_count; j++)
            divides |= s->n[j] % s->n[i] == 0 && (s->n[j] > s->n[i] || j < i);
        if (!divides)
            l->root[l->roots++] = s->n[i];
    }
}

/* Which measures the norms need. The tip's is also kept at the end, whatever they need. */
static void choose_channels(struct br_lockstep *l)
{
    const struct br_scene *scene = l->study->scene;
    const bool modelled[2] = {scene->axial.modelled, scene->bending.modelled};
    for (size_t i = 0; i < BR_CHANNELS; i++) {
        struct br_channel *c = &l->channel[i];
        bool needed = false;
        c->at = (struct br_sample_at){(enum br_field_kind)(i / BR_MEASURES),
                                      (enum br_measure)(i % BR_MEASURES), 0};
        for (const struct br_study *s = l->study; s; s = s->next_norm)
            needed |= br_norm_needs(s->norm, c->at.measure);
        c->used = modelled[c->at.kind] && (needed || c->at.measure == BR_TIP);
        c->last_only = !needed;
    }
}

/* Room for a measure of a field on one mesh; NULL: none. */
static double *new_values(struct br_lockstep *l, const struct br_sample_at *at, size_t n)
{
    const size_t size = br_measure_size(br_lockstep_elements(l, at->kind), at->measure, n);
    return br_store_take(&l->store, size, sizeof(double));
}

/* With the kernel that the cells are marched by, where one was asked for: then another processor
 * gives the same bits. */
static enum br_status create_ladder(struct br_lockstep *l, const struct br_sample_at *at,
                                    const struct br_mesh_list *roots,
                                    const struct br_mesh_list *rungs, struct br_ladder **ladder,
                                    struct br_error *err)
{
    const struct br_kernel *kernel = l->study->method.linear.kernel;
    const size_t modes = br_mode_count(br_lockstep_elements(l, at->kind), at->measure);
    const enum br_status status = br_ladder_create(ladder, modes, roots, rungs, &l->store, err);
    if (!status && kernel)
        br_ladder_use(*ladder, br_ladder_kernels[br_instruction_set_find(kernel->name)]);
    return status;
}

static enum br_status create_channel(struct br_lockstep *l, struct br_channel *c,
                                     struct br_error *err)
{
    const struct br_mesh_list roots = {l->roots, l->root}, own = {1, l->root},
                              rungs = {l->study->n_count, l->study->n};
    const bool distance = c->at.measure != BR_TIP;
    enum br_status status = BR_OK;
    c->size = 1;
    c->root = br_store_take(&l->store, l->roots, sizeof *c->root);
    for (size_t i = 0; i < l->roots && c->root; i++)
        c->root[i].values = new_values(l, &c->at, l->root[i]);
    if (l->study->auditor)
        c->audit.values = new_values(l, &c->at, l->root[0]);
    if (l->study->auditor && distance)
        status = create_ladder(l, &c->at, &own, &own, &c->own_ladder, err);
    if (!status && c->own_ladder)
        c->own_projection = br_store_take(&l->store, br_ladder_size(c->own_ladder), sizeof(double));
    if (!status && distance)
        status = create_ladder(l, &c->at, &roots, &rungs, &c->ladder, err);
    if (!status && distance)
        c->size = br_ladder_size(c->ladder);
    return status || !l->store.failed ? status : br_no_memory(err, "the reference's values");
}

static enum br_status create_channels(struct br_lockstep *l, struct br_error *err)
{
    enum br_status status = BR_OK;
    for (struct br_channel *c = l->channel; c < l->channel + BR_CHANNELS && !status; c++)
        if (c->used)
            status = create_channel(l, c, err);
    return status;
}

static enum br_status create_buffers(struct br_lockstep *l, struct br_error *err)
{
    size_t doubles = 0;
    for (size_t i = 0; i < BR_CHANNELS; i++)
        doubles += l->channel[i].size;
    l->batch = buffer_bytes / (doubles * sizeof(double));
    l->batch = l->batch < 1 ? 1 : l->batch > most_levels ? most_levels : l->batch;
    l->batches = (l->level_count + l->batch - 1) / l->batch;
    l->slots = BR_LOCKSTEP_BUFFERS * l->batch;
    for (size_t i = 0; i < BR_CHANNELS; i++)
        if (l->channel[i].used)
            l->channel[i].projection =
                br_store_take(&l->store, l->slots * l->channel[i].size, sizeof(double));
    l->reference.sample = br_store_take(&l->store, l->slots, sizeof *l->reference.sample);
    l->auditor.sample = br_store_take(&l->store, l->slots, sizeof *l->auditor.sample);
    return l->store.failed ? br_no_memory(err, "the reference's projections") : BR_OK;
}

/* Steps of the reference in the longest run of as many batches as there are buffers. */
static size_t longest_lead(const struct br_lockstep *l)
{
    size_t most = 1;
    for (size_t i = 0; i < l->level_count; i += l->batch) {
        const size_t end = i + l->slots, last = end < l->level_count ? end : l->level_count - 1;
        const size_t steps = l->level[last] - l->level[i];
        most = steps > most ? steps : most;
    }
    return most;
}

/* An auditor that cannot promise a solution of this scene is done without. */
static void dismiss_auditor(struct br_lockstep *l)
{
    l->auditor.judge->free(l->auditor.self);
    l->auditor.judge = NULL;
    l->study->auditor = NULL;
}

/* The reference, and who audits it. */
static enum br_status create_judges(struct br_lockstep *l, struct br_error *err)
{
    struct br_study *s = l->study;
    struct br_judge_request request = {
        .scene = s->scene,
        .method = s->reference_method,
        .n = s->reference.n,
        .axial_degree = s->method.axial_degree,
        .levels = s->reference.steps,
        .lead = longest_lead(l),
        .mesh_count = l->roots,
        .mesh = l->root,
        .stop = l->observer ? l->observer->stop : NULL,
        .stop_self = l->observer ? l->observer->self : NULL,
        .preparing = l->observer ? l->observer->preparing : NULL,
    };
    for (const struct br_channel *c = l->channel; c < l->channel + BR_CHANNELS; c++)
        request.measured[c->at.kind][c->at.measure] = c->used;
    l->reference.judge = s->judge;
    const enum br_status status = s->judge->create(&l->reference.self, &request, err);
    if (status || !s->auditor)
        return status;
    l->auditor.judge = s->auditor;
    l->audit_every = l->level_count / most_audits + 1;
    request.modest = true;
    struct br_error refusal = {0};
    if (!s->auditor->create(&l->auditor.self, &request, &refusal))
        return BR_OK;
    if (refusal.status == BR_NO_MEMORY)
        return br_fail(err, BR_NO_MEMORY, "%s", refusal.message);
    dismiss_auditor(l);
    return BR_OK;
}

/* Starts the march of a cell; what fails is kept in runner->error. */
static void start(struct br_lockstep *l, size_t cell)
{
    struct br_runner *r = &l->cell[cell];
    const struct br_study *s = l->study;
    const struct br_resolution at = s->cell[cell].at;
    const double begun = br_seconds();
    r->error.status =
        br_march_create(&r->march, s->scene, at.n, at.steps, br_study_method(s, cell), &r->error);
    r->seconds += br_seconds() - begun;
    if (r->error.status)
        return;
    if (l->observer)
        br_march_stop_when(r->march, l->observer->stop, l->observer->self);
    r->view.values = br_store_take(&l->store, BR_MOST_MODES * at.n, sizeof *r->view.values);
    if (!r->view.values)
        br_no_memory(&r->error, "a cell");
}

static enum br_status create_cells(struct br_lockstep *l, struct br_error *err)
{
    for (size_t i = 0; i < br_study_cells(l->study); i++) {
        start(l, i);
        const enum br_status failure = l->cell[i].error.status;
        if (failure == BR_BAD_INPUT || failure == BR_NO_MEMORY)
            return br_fail(err, failure, "%s", l->cell[i].error.message);
        if (failure)
            br_cell_failed(l->study, i, &l->cell[i].error);
    }
    return BR_OK;
}

/* Element-steps of a cell in a batch, about. */
static double work_of(const struct br_lockstep *l, size_t cell)
{
    const struct br_resolution at = l->study->cell[cell].at;
    return (double)at.n * (double)at.steps / (double)l->batches;
}

/* Cells go into crews whose tasks are long enough to be worth their while, whatever the number of
 * threads. */
static void choose_crews(struct br_lockstep *l)
{
    const size_t cells = br_study_cells(l->study);
    double work = 0;
    for (size_t i = 0; i < cells; i++) {
        work += work_of(l, i);
        if (work < least_work && i + 1 < cells)
            continue;
        l->crew[++l->crews] = i + 1;
        work = 0;
    }
}

enum br_status br_lockstep_create(struct br_lockstep *l, struct br_study *s,
                                  const struct br_observer *observer, struct br_error *err)
{
    l->study = s;
    for (; s; s = s->next_norm)
        l->norms++;
    l->observer = observer;
    atomic_init(&l->first_failed, SIZE_MAX);
    choose_channels(l);
    if (take_arrays(l, err))
        return err->status;
    list_levels(l);
    list_roots(l);
    if (create_channels(l, err) || create_buffers(l, err) || create_judges(l, err) ||
        create_cells(l, err))
        return err->status;
    choose_crews(l);
    return BR_OK;
}

void br_lockstep_clear(struct br_lockstep *l)
{
    if (l->reference.judge)
        l->reference.judge->free(l->reference.self);
    if (l->auditor.judge)
        l->auditor.judge->free(l->auditor.self);
    for (size_t i = 0; l->cell && i < br_study_cells(l->study); i++)
        br_march_free(l->cell[i].march);
    br_store_clear(&l->store);
}
