/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The size of a solution that is not known yet. One that starts at rest has none of its own that
 * its first errors could be compared with.
 *
 * Of two rough marches without common times the smaller size counts, since a short blow that one of
 * them meets acts on it for a whole step; but not that of a march that meets the zeros of a load.
 */
#include <math.h>

#include "solver/march_state.h"

static enum br_status rough_step(struct br_march *m, const struct br_step *step, double largest[2],
                                 struct br_error *err)
{
    static const struct br_stages euler = {.count = 1, .stage = {{1, 1, {[BR_NOW] = 1}}}};
    enum br_status status = BR_OK;
    for (int kind = BR_AXIAL; kind <= BR_BENDING && !status; kind++) {
        struct br_part *part = &m->part[kind];
        double size[2];
        if (!part->modelled)
            continue;
        status = br_march_stages(m, (enum br_field_kind)kind, &euler, step, m->path, err);
        part->solver->size(part->state, 0, size);
        largest[kind] = fmax(largest[kind], size[0]);
    }
    return status;
}

/* The largest strains (out) of a few Euler steps to the end. */
static enum br_status rough_march(struct br_march *m, int steps, double largest[2],
                                  struct br_error *err)
{
    const double T = m->scene->duration;
    const struct br_tip tip = m->tip;
    enum br_status status = BR_OK;
    largest[0] = largest[1] = 0;
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        if (m->part[kind].modelled)
            br_part_keep(&m->part[kind], BR_STAGE);
    for (int n = 0; n < steps && !status; n++) {
        const struct br_step step = {T * n / steps, T * (n + 1) / steps, T / steps};
        status = rough_step(m, &step, largest, err);
    }
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        if (m->part[kind].modelled)
            br_part_recall(&m->part[kind], BR_STAGE);
    m->tip = tip;
    return status;
}

enum br_status br_rough_size(struct br_march *m, double largest[2], struct br_error *err)
{
    const double nothing = 1e-10;
    double one[2], other[2];
    enum br_status status = rough_march(m, 16, one, err);
    if (!status)
        status = rough_march(m, 11, other, err);
    for (int kind = BR_AXIAL; kind <= BR_BENDING && !status; kind++) {
        const double larger = fmax(one[kind], other[kind]), smaller = fmin(one[kind], other[kind]);
        largest[kind] = smaller > nothing * larger ? smaller : larger;
    }
    return status;
}
