/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/exact/solution.h"

#include "reference/exact/march.h"

static struct br_law axial_law(const struct br_scene *scene)
{
    return (struct br_law){
        .contact = true,
        .obstacle = scene->contact.modelled,
        .stiffness = scene->contact.modelled ? scene->contact.stiffness : 0,
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

/* What a solution is made from. */
struct recipe {
    const struct br_scene *scene;
    const struct br_outline *outline; /* of each field */
    const struct br_fineness *fineness;
    struct br_effort *effort;
};

/* What modes cost, in the effort's units: a singular value decomposition. */
static double modes_work(const struct br_outline *outline, size_t modes)
{
    double count = 0;
    for (size_t e = 0; e + 1 < outline->end.count; e++)
        count += (double)br_outline_terms(outline, e, modes);
    return 2e-3 * count * count * count;
}

static enum br_status solve(struct br_solution *s, enum br_exact_field which,
                            const struct recipe *r, struct br_error *err)
{
    const bool axial = which == BR_EXACT_AXIAL;
    const struct br_scene *scene = r->scene;
    s->law[which] = axial ? axial_law(scene) : bending_law(scene, s->track[BR_EXACT_AXIAL]);
    const struct br_march_options options = {
        .duration = scene->duration,
        .gap = axial && scene->contact.modelled ? scene->contact.gap : 0,
        .tolerance = r->fineness->tolerance,
        .first_step = r->fineness->first_step,
        .max_steps = r->fineness->max_steps,
        .outline = {&r->outline[which], s->law[which].axial ? &r->outline[BR_EXACT_AXIAL] : NULL},
        .effort = r->effort,
    };
    enum br_status status =
        br_effort_spend(r->effort, modes_work(&r->outline[which], r->fineness->modes), err);
    if (!status)
        status = br_field_create(&s->field[which], scene, axial ? 1 : 2, &r->outline[which],
                                 r->fineness->modes, err);
    if (!status)
        status = br_march(s->field[which], &s->law[which], &options, &s->track[which], err);
    return status;
}

enum br_status br_solution_create(struct br_solution **out, const struct br_scene *scene,
                                  const struct br_outline outline[BR_EXACT_FIELDS],
                                  const struct br_fineness *fineness, struct br_effort *effort,
                                  struct br_error *err)
{
    const struct recipe recipe = {scene, outline, fineness, effort};
    *out = NULL;
    struct br_solution *s = br_allocate(1, sizeof *s);
    if (!s)
        return br_no_memory(err, "the exact solution");
    enum br_status status = BR_OK;
    if (scene->axial.modelled)
        status = solve(s, BR_EXACT_AXIAL, &recipe, err);
    if (!status && scene->bending.modelled)
        status = solve(s, BR_EXACT_BENDING, &recipe, err);
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
