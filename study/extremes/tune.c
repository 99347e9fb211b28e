/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Numbers that only a march can tell: its stability limit, its reaction. */
#include <math.h>

#include "study/extremes/case.h"
#include "study/run/model.h"
#include "study/scene/file.h"

/* The first step of a case; NULL: it cannot be made. The scene is to be cleared. */
static struct br_march *first_step(const struct br_extreme_case *c, struct br_scene *scene,
                                   struct br_scene *marched)
{
    char text[BR_EXTREME_TEXT];
    struct br_march *march = NULL;
    br_extreme_scene(c, text);
    if (br_scene_read_text("case.yaml", text, scene, NULL) ||
        br_model_select(scene, c->wanted, marched, NULL) ||
        br_march_create(&march, marched, c->n, c->steps, &c->method, NULL))
        return NULL;
    if (!br_march_step(march, NULL))
        return march;
    br_march_free(march);
    return NULL;
}

/* c_H k z_tip = 1 + c/(c + k a), and a little more or less. */
static void tune_contact(struct br_extreme_case *c, const struct br_march *march, double little)
{
    const struct br_field *f = br_march_field(march, BR_AXIAL);
    const double limit = (1 + f->viscosity / (f->viscosity + f->k * f->stiffness)) /
                         (f->k * br_march_compliance(march, BR_AXIAL)) * (1 + little);
    if (limit > 0 && isfinite(limit))
        c->contact_stiffness = limit;
}

void br_extreme_tune(struct br_extreme_case *c, double little)
{
    struct br_extreme_case trial = *c;
    struct br_scene scene = {0}, marched;
    const bool bound = c->trick == BR_TRICK_AT_REACTION;
    if (bound ? c->law != BR_TRESCA : !c->contact)
        return;
    if (bound)
        trial.friction = 1e300;
    struct br_march *march = first_step(&trial, &scene, &marched);
    if (march && !bound)
        tune_contact(c, march, little);
    else if (march && isfinite(br_march_tip(march)->friction_force))
        c->friction = fabs(br_march_tip(march)->friction_force);
    br_march_free(march);
    br_scene_clear(&scene);
}
