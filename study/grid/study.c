/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/grid/study.h"

#include <math.h>

const char *br_flag_name(enum br_flag flag)
{
    static const char *const names[] = {"", "reference", "round-off", "failed", "unstable"};
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

double br_time_step(const struct br_scene *scene, size_t steps)
{
    return steps ? scene->duration / (double)steps : 0;
}

double br_mesh_size(const struct br_scene *scene, size_t n)
{
    return n ? scene->length / (double)n : 0;
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

enum br_status br_steps_of(const struct br_scene *scene, double k, size_t *steps,
                           struct br_error *err)
{
    const double ratio = scene->duration / k;
    if (!(k > 0 && isfinite(k)))
        return br_fail(err, BR_BAD_INPUT, "k is %g s, expected a finite number > 0", k);
    if (!(ratio >= 1 - 1e-9))
        return br_fail(err, BR_BAD_INPUT, "k = %g s is longer than the duration, %g s", k,
                       scene->duration);
    if (!(ratio <= 1e12))
        return br_fail(err, BR_BAD_INPUT, "k = %g s makes %g steps, expected at most 1e12", k,
                       ratio);
    const double whole = round(ratio);
    if (!(fabs(ratio - whole) <= 1e-9 * whole))
        return br_fail(err, BR_BAD_INPUT,
                       "k = %.10g s does not divide the duration of %g s; the nearest that do are "
                       "%.10g and %.10g",
                       k, scene->duration, scene->duration / floor(ratio),
                       scene->duration / ceil(ratio));
    *steps = (size_t)whole;
    return BR_OK;
}
