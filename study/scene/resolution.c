/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/scene/resolution.h"

#include <math.h>
#include <stdlib.h>

#include "solver/scene.h"

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
                       "k = %.10g s does not divide the duration of T = %g s; the nearest that do "
                       "are T/%.0f and T/%.0f",
                       k, scene->duration, floor(ratio), ceil(ratio));
    *steps = (size_t)whole;
    return BR_OK;
}

static int ascending(const void *a, const void *b)
{
    const size_t x = *(const size_t *)a, y = *(const size_t *)b;
    return (x > y) - (x < y);
}

void br_sort_counts(size_t *counts, size_t count)
{
    qsort(counts, count, sizeof *counts, ascending);
}

double br_time_step(const struct br_scene *scene, size_t steps)
{
    return steps ? scene->duration / (double)steps : 0;
}

double br_mesh_size(const struct br_scene *scene, size_t n)
{
    return n ? scene->length / (double)n : 0;
}
