/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/grid/study.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

#include "study/scene/statement.h"

const char *br_flag_name(enum br_flag flag)
{
    static const char *const names[BR_CELL_FLAGS] = {"",       "reference", "round-off",
                                                     "failed", "unstable",  "stagnation",
                                                     "not asymptotic", "outlier"};
    return names[flag];
}

size_t br_study_cells(const struct br_study *s)
{
    return s->path ? s->n_count : s->n_count * s->k_count;
}

const struct br_method *br_study_method(const struct br_study *s, size_t cell)
{
    return s->cell_method ? &s->cell_method[cell] : &s->method;
}

size_t br_study_row(const struct br_study *s, size_t cell)
{
    return s->path ? cell : cell / s->k_count;
}

struct br_resolution br_study_resolution(const struct br_study *s, size_t cell)
{
    return (struct br_resolution){s->n[br_study_row(s, cell)],
                                  s->steps[s->path ? cell : cell % s->k_count]};
}

const struct br_cell *br_study_cell(const struct br_study *study, size_t i, size_t j)
{
    return &study->cell[i * study->k_count + j];
}

double br_reference_step(const struct br_study *s)
{
    return s->judge->nests ? br_time_step(s->scene, s->reference.steps) : 0;
}

double br_reference_mesh(const struct br_study *s)
{
    return br_mesh_size(s->scene, s->reference.n);
}

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

void br_state_study(struct br_statement *s, const struct br_study *study, size_t cell)
{
    const bool all = cell == SIZE_MAX;
    br_state_scene(s, study->scene);
    br_state(s, "norm", "%s", study->norm->name);
    br_state(s, "judge", "%s", study->judge->name);
    if (study->judge->nests) { /* else they need not be set */
        state_resolution(s, study->reference);
        br_state_method(s, &study->reference_method);
    }
    if (all)
        br_state(s, "auditor", "%s", study->auditor ? study->auditor->name : "");
    for (size_t c = all ? 0 : cell; c < (all ? br_study_cells(study) : cell + 1); c++) {
        br_state(s, "cell", "%s", "");
        state_resolution(s, br_study_resolution(study, c));
        if (!all || c == 0 || study->cell_method)
            br_state_method(s, br_study_method(study, c));
    }
}

/* ---- over h and over k ---- */

const char *const br_axis_letters[] = {"h", "k"};

size_t br_axis_count(const struct br_study *s, int axis)
{
    return axis == BR_AXIS_SPACE ? s->n_count : s->k_count;
}

double br_axis_size(const struct br_scene *scene, int axis, struct br_resolution at)
{
    return axis == BR_AXIS_SPACE ? br_mesh_size(scene, at.n) : br_time_step(scene, at.steps);
}

size_t br_axis_cell(const struct br_study *s, int axis, size_t along, size_t at)
{
    return axis == BR_AXIS_SPACE ? along * s->k_count + at : at * s->k_count + along;
}
