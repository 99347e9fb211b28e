/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/exact/solution.h"

#include "reference/exact/march.h"

static struct br_law axial_law(const struct br_scene *scene)
{
    return (struct br_law){
        .contact = true,
        .stiffness = scene->contact.modelled ? scene->contact.stiffness : 0,
        .bounds = scene->contact.modelled && scene->friction.law == BR_COULOMB,
    };
}

static struct br_law bending_law(const struct br_scene *scene, const struct br_track *axial)
{
    return (struct br_law){
        .friction = scene->friction.law,
        .coefficient = scene->friction.coefficient,
        .axial = scene->friction.law == BR_COULOMB ? axial : NULL,
    };
}

static enum br_status solve(struct br_solution *s, enum br_exact_field which,
                            const struct br_scene *scene, const struct br_fineness *fineness,
                            struct br_error *err)
{
    const bool axial = which == BR_EXACT_AXIAL;
    const struct br_march_options options = {
        .duration = scene->duration,
        .gap = axial && scene->contact.modelled ? scene->contact.gap : 0,
        .tolerance = fineness->tolerance,
        .first_step = fineness->first_step,
        .max_steps = fineness->max_steps,
        .stop = fineness->stop,
        .stop_self = fineness->stop_self,
    };
    enum br_status status =
        br_field_create(&s->field[which], scene, axial ? 1 : 2, fineness->modes, err);
    s->law[which] = axial ? axial_law(scene) : bending_law(scene, s->track[BR_EXACT_AXIAL]);
    if (!status)
        status = br_march(s->field[which], &s->law[which], &options, &s->track[which], err);
    return status;
}

enum br_status br_solution_create(struct br_solution **out, const struct br_scene *scene,
                                  const struct br_fineness *fineness, struct br_error *err)
{
    *out = NULL;
    struct br_solution *s = br_allocate(1, sizeof *s);
    if (!s)
        return br_no_memory(err, "the exact solution");
    enum br_status status = BR_OK;
    if (scene->axial.modelled)
        status = solve(s, BR_EXACT_AXIAL, scene, fineness, err);
    if (!status && scene->bending.modelled)
        status = solve(s, BR_EXACT_BENDING, scene, fineness, err);
    if (status)
        br_solution_free(s);
    else
        *out = s;
    return status;
}

void br_solution_free(struct br_solution *s)
{
    if (!s)
        return;
    for (size_t i = 0; i < BR_EXACT_FIELDS; i++) {
        br_field_free(s->field[i]);
        br_track_free(s->track[i]);
    }
    free(s);
}
