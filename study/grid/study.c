/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/grid/study.h"

#include "study/scene/statement.h"

void br_study_clear(struct br_study *study)
{
    free(study->cell);
    free(study->events);
    study->cell = NULL;
    study->events = NULL;
}

/* ---- in words ---- */

static void state_resolution(struct br_statement *s, struct br_resolution at)
{
    br_state(s, "n", "%zu", at.n);
    br_state(s, "steps", "%zu", at.steps);
}

void br_state_study(struct br_statement *s, const struct br_study *study)
{
    br_state_scene(s, study->scene);
    br_state(s, "norm", "%s", study->norm->name);
    br_state(s, "reference_kind", "%s", study->reference_kind->name);
    if (study->reference_kind->nests) { /* else they need not be set */
        state_resolution(s, study->reference);
        br_state_method(s, &study->reference_method);
    }
    br_state(s, "reference_check", "%s",
             study->reference_check ? study->reference_check->name : "");
    for (size_t c = 0; c < br_study_cells(study); c++) {
        state_resolution(s, br_study_resolution(study, c));
        if (c == 0 || study->cell_method)
            br_state_method(s, br_study_method(study, c));
    }
}

/* ---- over h and over k ---- */

/* ---- the grid ---- */

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

size_t br_common_levels(size_t a, size_t b)
{
    size_t divisor = a;
    for (size_t rest = b, other; rest; rest = other) {
        other = divisor % rest;
        divisor = rest;
    }
    return divisor == 0 || b / divisor > ((size_t)1 << 52) / a ? 0 : a * (b / divisor);
}

/* The time levels of a reference that has none of its own: those of all cells. */
static enum br_status common_levels(struct br_study *s, struct br_error *err)
{
    size_t common = 1;
    for (size_t j = 0; j < s->k_count; j++)
        if (!(common = br_common_levels(common, s->steps[j])))
            return br_fail(err, BR_BAD_INPUT, "the time steps have too few time levels in common");
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
            .against = s->reference_kind->nests ? s->reference : (struct br_resolution){0},
        };
    return BR_OK;
}

enum br_status br_study_prepare(struct br_study *s, struct br_error *err)
{
    if (s->n_count == 0 || s->k_count == 0)
        return br_fail(err, BR_BAD_INPUT, "the list of %s is empty, expected at least one value",
                       s->n_count == 0 ? "n" : "k");
    if (s->reference_kind->nests && (s->reference.n < 1 || s->reference.steps < 1))
        return br_fail(err, BR_BAD_INPUT, "the reference needs at least one element and one step");
    for (size_t c = 0; c < br_study_cells(s); c++)
        if (br_study_method(s, c)->axial_degree != s->method.axial_degree)
            return br_fail(err, BR_BAD_INPUT, "the cells have axial elements of several degrees");
    if (s->reference_kind->nests && s->reference_method.axial_degree != s->method.axial_degree)
        return br_fail(err, BR_BAD_INPUT,
                       "the cells have axial elements of degree %d and the reference of degree %d, "
                       "expected the same",
                       s->method.axial_degree, s->reference_method.axial_degree);
    enum br_status status =
        s->reference_kind->nests ? check_nesting(s, err) : common_levels(s, err);
    for (struct br_study *norm = s; norm && !status; norm = norm->next_norm) {
        norm->reference = s->reference;
        status = create_cells(norm, err);
    }
    return status;
}
