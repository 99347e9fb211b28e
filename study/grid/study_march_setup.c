/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdint.h>

#include "base/clock.h"
#include "solver/linear/linear_solver.h"
#include "solver/scene.h"
#include "study/grid/study_march.h"

static const size_t buffer_bytes = 1u << 20; /* of a batch's projections, at most */
static const size_t most_levels = 32;        /* in a batch */
static const double least_work = 1e5;        /* element-steps of a task in a batch, about */
static const size_t most_checks = 1000;      /* of the reference, about */

static enum br_status take_arrays(struct br_study_march *l, struct br_error *err)
{
    const struct br_study *s = l->study;
    const size_t cells = br_study_cells(s);
    size_t levels = 1;
    for (size_t j = 0; j < s->k_count; j++)
        levels += s->steps[j];
    l->level = br_store_take(&l->store, levels, sizeof *l->level);
    l->root_mesh = br_store_take(&l->store, s->n_count, sizeof *l->root_mesh);
    l->cell = br_store_take(&l->store, cells, sizeof *l->cell);
    l->task_cell = br_store_take(&l->store, cells + 1, sizeof *l->task_cell);
    l->lane = br_store_take(&l->store, BR_LANE_CELLS + cells, sizeof *l->lane);
    l->cell_sum = br_store_take(&l->store, cells * l->norms, sizeof *l->cell_sum);
    l->reference.sum = br_store_take(&l->store, l->norms, sizeof *l->reference.sum);
    l->reference_check.sum = br_store_take(&l->store, l->norms, sizeof *l->reference_check.sum);
    return l->store.failed ? br_no_memory(err, "the cells") : BR_OK;
}

/* Every reference step that is a time level of some cell, 0 included. */
static void list_levels(struct br_study_march *l)
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

/* The meshes on which the reference is sampled: its own, if it has one; otherwise the meshes of the
 * cells that do not divide another one. */
static void list_root_meshes(struct br_study_march *l)
{
    const struct br_study *s = l->study;
    if (s->reference_kind->nests)
        l->root_mesh[l->root_meshes++] = s->reference.n;
    for (size_t i = 0; i < s->n_count && !s->reference_kind->nests; i++) {
        bool divides = false;
        for (size_t j = 0; j < s->n_count; j++)
            divides |= s->n[j] % s->n[i] == 0 && (s->n[j] > s->n[i] || j < i);
        if (!divides)
            l->root_mesh[l->root_meshes++] = s->n[i];
    }
}

/* Chooses the measures that the norms need. The tip is always measured at the end. */
static void choose_measured(struct br_study_march *l)
{
    for (size_t i = 0; i < BR_MEASURED; i++) {
        struct br_measured *f = &l->measured[i];
        bool needed = false;
        f->at = (struct br_sample_at){(enum br_field_kind)(i / BR_MEASURES),
                                      (enum br_measure)(i % BR_MEASURES), 0};
        for (const struct br_study *s = l->study; s; s = s->next_norm)
            needed |= br_norm_needs(s->norm, f->at.measure);
        f->used =
            l->study->scene->field[f->at.kind].modelled && (needed || f->at.measure == BR_TIP);
        f->last_only = !needed;
    }
}

/* Room for a measure of a field on one mesh; NULL: none. */
static double *new_values(struct br_study_march *l, const struct br_sample_at *at, size_t n)
{
    const size_t size = br_measure_size(br_study_march_elements(l, at->kind), at->measure, n);
    return br_store_take(&l->store, size, sizeof(double));
}

/* Uses the kernel of the cells, if one was requested: then another processor gives the same
 * bits. */
static enum br_status create_nested(struct br_study_march *l, const struct br_sample_at *at,
                                    const struct br_mesh_list *roots,
                                    const struct br_mesh_list *meshes,
                                    struct br_nested_meshes **nested, struct br_error *err)
{
    const struct br_kernel *kernel = l->study->method.kernel;
    const size_t modes = br_mode_count(br_study_march_elements(l, at->kind), at->measure);
    const enum br_status status =
        br_nested_meshes_create(nested, modes, roots, meshes, &l->store, err);
    if (!status && kernel)
        br_nested_meshes_use(*nested,
                             br_nested_meshes_kernels[br_instruction_set_find(kernel->name)]);
    return status;
}

static enum br_status create_measured(struct br_study_march *l, struct br_measured *f,
                                      struct br_error *err)
{
    const struct br_mesh_list roots = {l->root_meshes, l->root_mesh}, own = {1, l->root_mesh},
                              meshes = {l->study->n_count, l->study->n};
    const bool distance = f->at.measure != BR_TIP;
    enum br_status status = BR_OK;
    f->size = 1;
    f->root_view = br_store_take(&l->store, l->root_meshes, sizeof *f->root_view);
    for (size_t i = 0; i < l->root_meshes && f->root_view; i++)
        f->root_view[i].values = new_values(l, &f->at, l->root_mesh[i]);
    if (l->study->reference_check)
        f->check.values = new_values(l, &f->at, l->root_mesh[0]);
    if (l->study->reference_check && distance)
        status = create_nested(l, &f->at, &own, &own, &f->own_nested, err);
    if (!status && f->own_nested)
        f->own_projection =
            br_store_take(&l->store, br_nested_meshes_size(f->own_nested), sizeof(double));
    if (!status && distance)
        status = create_nested(l, &f->at, &roots, &meshes, &f->nested, err);
    if (!status && distance)
        f->size = br_nested_meshes_size(f->nested);
    return status || !l->store.failed ? status : br_no_memory(err, "the reference's values");
}

static enum br_status create_all_measured(struct br_study_march *l, struct br_error *err)
{
    enum br_status status = BR_OK;
    for (struct br_measured *f = l->measured; f < l->measured + BR_MEASURED && !status; f++)
        if (f->used)
            status = create_measured(l, f, err);
    return status;
}

static size_t least(size_t a, size_t b)
{
    return a < b ? a : b;
}

static enum br_status create_buffers(struct br_study_march *l, struct br_error *err)
{
    size_t doubles = 0;
    for (size_t i = 0; i < BR_MEASURED; i++)
        doubles += l->measured[i].size;
    l->batch = least(most_levels, buffer_bytes / (doubles * sizeof(double)));
    l->batch = least(l->batch, BR_STUDY_MARCH_LEAD / br_study_longest_gap(l->study));
    l->batch = l->batch < 1 ? 1 : l->batch;
    l->batches = (l->level_count + l->batch - 1) / l->batch;
    l->buffered_levels = BR_STUDY_MARCH_BUFFERS * l->batch;
    for (size_t i = 0; i < BR_MEASURED; i++)
        if (l->measured[i].used)
            l->measured[i].projection =
                br_store_take(&l->store, l->buffered_levels * l->measured[i].size, sizeof(double));
    l->reference.sample = br_store_take(&l->store, l->buffered_levels, sizeof *l->reference.sample);
    l->reference_check.sample =
        br_store_take(&l->store, l->buffered_levels, sizeof *l->reference_check.sample);
    return l->store.failed ? br_no_memory(err, "the reference's projections") : BR_OK;
}

/* The most steps of the reference in as many successive batches as there are buffers. */
static size_t longest_lead(const struct br_study_march *l)
{
    size_t most = 1;
    for (size_t i = 0; i < l->level_count; i += l->batch) {
        const size_t end = i + l->buffered_levels,
                     last = end < l->level_count ? end : l->level_count - 1;
        const size_t steps = l->level[last] - l->level[i];
        most = steps > most ? steps : most;
    }
    return most;
}

/* Drops a reference check that cannot promise a solution of this scene. */
static void drop_reference_check(struct br_study_march *l)
{
    l->reference_check.reference_kind->free(l->reference_check.self);
    l->reference_check.reference_kind = NULL;
    l->study->reference_check = NULL;
}

/* Creates the reference and its check. */
static enum br_status create_references(struct br_study_march *l, struct br_error *err)
{
    struct br_study *s = l->study;
    struct br_reference_request request = {
        .scene = s->scene,
        .method = s->reference_method,
        .n = s->reference.n,
        .axial_degree = s->method.axial_degree,
        .levels = s->reference.steps,
        .lead = longest_lead(l),
        .mesh_count = l->root_meshes,
        .mesh = l->root_mesh,
        .observer = l->observer,
    };
    for (const struct br_measured *f = l->measured; f < l->measured + BR_MEASURED; f++)
        request.measured[f->at.kind][f->at.measure] = f->used;
    l->reference.reference_kind = s->reference_kind;
    const enum br_status status = s->reference_kind->create(&l->reference.self, &request, err);
    if (status || !s->reference_check)
        return status;
    l->reference_check.reference_kind = s->reference_check;
    l->check_every = l->level_count / most_checks + 1;
    request.modest = true;
    struct br_error refusal = {0};
    if (!s->reference_check->create(&l->reference_check.self, &request, &refusal))
        return BR_OK;
    if (refusal.status == BR_NO_MEMORY)
        return br_fail(err, BR_NO_MEMORY, "%s", refusal.message);
    drop_reference_check(l);
    return BR_OK;
}

/* Starts the march of a cell; what fails is kept in runner->error. */
static void start(struct br_study_march *l, size_t cell)
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

static enum br_status create_cells(struct br_study_march *l, struct br_error *err)
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
static double work_of(const struct br_study_march *l, size_t cell)
{
    const struct br_resolution at = l->study->cell[cell].at;
    return (double)at.n * (double)at.steps / (double)l->batches;
}

/* Groups cells into tasks that are long enough to be worthwhile, for any number of threads. */
static void choose_tasks(struct br_study_march *l)
{
    const size_t cells = br_study_cells(l->study);
    double work = 0;
    for (size_t i = 0; i < cells; i++) {
        work += work_of(l, i);
        if (work < least_work && i + 1 < cells)
            continue;
        l->task_cell[++l->tasks] = i + 1;
        work = 0;
    }
}

enum br_status br_study_march_create(struct br_study_march *l, struct br_study *s,
                                     const struct br_observer *observer, struct br_error *err)
{
    l->study = s;
    for (; s; s = s->next_norm)
        l->norms++;
    l->observer = observer;
    atomic_init(&l->first_failed, SIZE_MAX);
    l->lock = (pthread_mutex_t)PTHREAD_MUTEX_INITIALIZER;
    choose_measured(l);
    if (take_arrays(l, err))
        return err->status;
    list_levels(l);
    list_root_meshes(l);
    if (create_all_measured(l, err) || create_buffers(l, err) || create_references(l, err) ||
        create_cells(l, err))
        return err->status;
    choose_tasks(l);
    return BR_OK;
}

void br_study_march_clear(struct br_study_march *l)
{
    if (l->reference.reference_kind)
        l->reference.reference_kind->free(l->reference.self);
    if (l->reference_check.reference_kind)
        l->reference_check.reference_kind->free(l->reference_check.self);
    for (size_t i = 0; l->cell && i < br_study_cells(l->study); i++)
        br_march_free(l->cell[i].march);
    br_store_clear(&l->store);
}
