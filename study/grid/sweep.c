/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/grid/sweep.h"

static struct br_engine usual = {br_lockstep, NULL};

void br_engine_set(struct br_engine engine)
{
    usual = engine;
}

/* The largest divisor of `of` that is <= a, and the smallest that is >= a. */
static void nearest_divisors(size_t of, size_t a, size_t *below, size_t *above)
{
    *below = a < of ? a : of;
    while (of % *below != 0)
        (*below)--;
    *above = a < of ? a : of;
    while (of % *above != 0)
        (*above)++;
}

/* The time levels of a reference that has none of its own: those of all cells. */
static enum br_status common_levels(struct br_study *s, struct br_error *err)
{
    size_t common = 1;
    for (size_t j = 0; j < s->k_count; j++) {
        size_t a = common, b = s->steps[j];
        while (b) {
            const size_t rest = a % b;
            a = b;
            b = rest;
        }
        if (a == 0 || s->steps[j] / a > ((size_t)1 << 52) / common)
            return br_fail(err, BR_BAD_INPUT, "the time steps have too few time levels in common");
        common *= s->steps[j] / a;
    }
    s->reference = (struct br_resolution){.n = 0, .steps = common};
    return BR_OK;
}

static enum br_status check_nesting(const struct br_study *s, struct br_error *err)
{
    size_t below, above;
    for (size_t i = 0; i < s->n_count; i++) {
        if (s->n[i] < 1)
            return br_fail(err, BR_BAD_INPUT, "n is 0, expected at least one element");
        if (s->reference.n % s->n[i] == 0)
            continue;
        nearest_divisors(s->reference.n, s->n[i], &below, &above);
        return br_fail(err, BR_BAD_INPUT,
                       "n = %zu does not nest in the reference's %zu elements; the nearest that do "
                       "are %zu and %zu",
                       s->n[i], s->reference.n, below, above);
    }
    for (size_t j = 0; j < s->k_count; j++) {
        if (s->steps[j] >= 1 && s->reference.steps % s->steps[j] == 0)
            continue;
        nearest_divisors(s->reference.steps, s->steps[j] ? s->steps[j] : 1, &below, &above);
        return br_fail(err, BR_BAD_INPUT,
                       "the time levels of k = %g s are not all among the reference's (k = %g s); "
                       "the nearest k that would do are %.10g and %.10g s",
                       br_time_step(s->scene, s->steps[j]),
                       br_time_step(s->scene, s->reference.steps), br_time_step(s->scene, above),
                       br_time_step(s->scene, below));
    }
    return BR_OK;
}

static enum br_status create_cells(struct br_study *s, struct br_error *err)
{
    const size_t cells = br_study_cells(s);
    s->cell = br_allocate(cells, sizeof *s->cell);
    if (!s->cell)
        return br_no_memory(err, "the table");
    for (size_t c = 0; c < cells; c++)
        s->cell[c] = (struct br_cell){
            .at = br_study_resolution(s, c),
            .against = s->judge->nests ? s->reference : (struct br_resolution){0},
        };
    return BR_OK;
}

static enum br_status prepare(struct br_study *s, struct br_error *err)
{
    if (s->n_count == 0 || s->k_count == 0)
        return br_fail(err, BR_BAD_INPUT, "the list of %s is empty, expected at least one value",
                       s->n_count == 0 ? "n" : "k");
    if (s->judge->nests && (s->reference.n < 1 || s->reference.steps < 1))
        return br_fail(err, BR_BAD_INPUT, "the reference needs at least one element and one step");
    if (s->path && s->n_count != s->k_count)
        return br_fail(err, BR_BAD_INPUT, "a path has %zu n and %zu k, expected as many",
                       s->n_count, s->k_count);
    for (size_t c = 0; c < br_study_cells(s); c++)
        if (br_study_method(s, c)->axial_degree != s->method.axial_degree)
            return br_fail(err, BR_BAD_INPUT, "the cells have axial elements of several degrees");
    if (s->judge->nests && s->reference_method.axial_degree != s->method.axial_degree)
        return br_fail(err, BR_BAD_INPUT,
                       "the cells have axial elements of degree %d and the reference of degree %d, "
                       "expected the same",
                       s->method.axial_degree, s->reference_method.axial_degree);
    const enum br_status status = s->judge->nests ? check_nesting(s, err) : common_levels(s, err);
    if (status)
        return status;
    enum br_status table = BR_OK;
    for (struct br_study *norm = s; norm && !table; norm = norm->next_norm) {
        norm->reference = s->reference;
        table = create_cells(norm, err);
    }
    return table;
}

enum br_status br_study_run_each(struct br_study *studies, size_t count, int threads,
                                 const struct br_observer *observer, struct br_error *err)
{
    enum br_status status = BR_OK;
    for (size_t i = 0; i < count; i++)
        for (struct br_study *s = &studies[i]; s; s = s->next_norm)
            s->cell = NULL, s->events = NULL, s->failure = (struct br_error){0};
    for (size_t i = 0; i < count && !status; i++)
        if (prepare(&studies[i], &studies[i].failure) == BR_NO_MEMORY)
            status = br_fail(err, BR_NO_MEMORY, "%s", studies[i].failure.message);
    const struct br_engine *engine = count && studies->engine.march ? &studies->engine : &usual;
    if (!status)
        status = engine->march(studies, count, threads, observer, err);
    for (size_t i = 0; i < count && status; i++)
        for (struct br_study *s = &studies[i]; s; s = s->next_norm)
            br_study_clear(s);
    return status;
}

enum br_status br_study_run(struct br_study *studies, size_t count, int threads,
                            const struct br_observer *observer, struct br_error *err)
{
    enum br_status status = br_study_run_each(studies, count, threads, observer, err);
    for (size_t i = 0; i < count && !status; i++)
        if (studies[i].failure.status)
            status = br_fail(err, studies[i].failure.status, "%s", studies[i].failure.message);
    for (size_t i = 0; i < count && status; i++)
        for (struct br_study *s = &studies[i]; s; s = s->next_norm)
            br_study_clear(s);
    return status;
}
