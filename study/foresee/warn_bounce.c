/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Warns of a lagged contact that may gain energy as it opens and closes: within the limit of a
 * closed one, but beyond that without inertia, below which none is gained. Whether it does is
 * looked up in a march of the same steps on a coarse mesh: the limit does not depend on the mesh.
 */
#include <math.h>
#include <stdio.h>

#include "reference/energy/energy.h"
#include "solver/laws.h"
#include "study/foresee/warnings.h"
#include "study/run/run.h"

enum { MOST_ELEMENTS = 4, MOST_STEPS = 4000 };

static const double little = 0.01; /* of what was put in */

/* The largest share, of the energy that was put in until then, that the scheme has added. */
static enum br_status march(const struct br_scene *scene, const struct br_method *method, size_t n,
                            size_t steps, double *share, struct br_error *err)
{
    struct br_march *march = NULL;
    struct br_energy_meter *meter = NULL;
    struct br_energy start, now;
    struct br_work work;
    enum br_status status = br_march_create(&march, scene, n, steps, method, err);
    if (!status)
        status = br_energy_meter_create(&meter, march, scene, method, err);
    for (size_t i = 0; i < steps && !status; i++) {
        status = br_march_step(march, err);
        if (status)
            break;
        br_energy_meter_step(meter);
        br_energy_meter_read(meter, &start, &now, &work);
        const double put_in = br_energy_put_in(&start, &work, BR_AXIAL);
        if (put_in > 0)
            *share = fmax(*share, br_energy_added(&work, BR_AXIAL) / put_in);
    }
    br_energy_meter_free(meter);
    br_march_free(march);
    return status;
}

/* NaN: not known. */
static double gain(const struct br_outlook *o)
{
    struct br_scene scene;
    struct br_error failure = {0};
    const size_t n = o->n < MOST_ELEMENTS ? o->n : MOST_ELEMENTS;
    double share = 0;
    if (o->steps > MOST_STEPS || br_model_select(o->scene, BR_WANT_AXIAL, &scene, &failure))
        return NAN;
    return march(&scene, o->method, n, o->steps, &share, &failure) ? NAN : share;
}

static bool applies(const struct br_outlook *o, struct br_field *field)
{
    const struct br_scene *s = o->scene;
    if (!s->contact.modelled || o->method->contact->at_new_step)
        return false;
    *field = br_field_of_scene(s, BR_AXIAL, o->n, s->duration / (double)o->steps);
    field->degree = o->method->axial_degree;
    return s->contact.stiffness > br_contact_limit_bouncing(field) &&
           !br_contact_grows(field, s->contact.stiffness);
}

static enum br_status look(const struct br_outlook *o, struct br_warnings *w, struct br_error *err)
{
    (void)err;
    struct br_field field;
    if (!applies(o, &field))
        return BR_OK;
    const double share = gain(o);
    char found[120] = "";
    if (share <= little)
        return BR_OK;
    if (share > little)
        snprintf(found, sizeof found,
                 "; on a coarse mesh it gains %.2g %% of what is put into the axial field",
                 100 * share);
    br_warn(w, BR_WARN_BOUNCE, "--contact implicit  # gains none",
            "the lagged contact may gain energy as it opens and closes: with k = %.4g s it is sure "
            "not to up to a stiffness of %.4g N/m, the scene has %g N/m%s",
            field.k, br_contact_limit_bouncing(&field), o->scene->contact.stiffness, found);
    return BR_OK;
}

const struct br_warning_source br_warn_bounce = {
    .title = "energy that a lagged contact gains",
    .every = true,
    .look = look,
};
