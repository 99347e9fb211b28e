/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <float.h>
#include <string.h>

#include "reference/discrete_state.h"

bool br_discrete_judges(void)
{
    volatile long double one = 1, tiny = DBL_EPSILON / 1024; /* valgrind's has 53 bits */
    return one + tiny > one;
}

/* ---- creation ---- */

static enum br_status check_method(const struct br_method *m, struct br_error *err)
{
    if (!br_textbook_step(m->scheme->name, 0) || m->scheme->adaptive)
        return br_fail(err, BR_BAD_INPUT,
                       "the exact discrete solution does not know the scheme '%s'",
                       m->scheme->name);
    if (strcmp(m->contact->name, "lagged") != 0 && strcmp(m->contact->name, "implicit") != 0)
        return br_fail(err, BR_BAD_INPUT, "the exact discrete solution does not know contact '%s'",
                       m->contact->name);
    if (strcmp(m->friction->name, "exact") != 0 && strcmp(m->friction->name, "regularised") != 0)
        return br_fail(err, BR_BAD_INPUT, "the exact discrete solution does not know friction '%s'",
                       m->friction->name);
    if (m->axial_degree != 1)
        return br_fail(err, BR_BAD_INPUT,
                       "the exact discrete solution has axial elements of degree 1, not %d",
                       m->axial_degree);
    return BR_OK;
}

static enum br_status create_part(struct br_discrete *d, enum br_field_kind kind, size_t n,
                                  struct br_error *err)
{
    struct br_discrete_part *part = &d->part[kind];
    const struct br_scene *s = d->scene;
    part->n = n;
    part->d = kind == BR_AXIAL ? 1 : 2;
    part->modelled = kind == BR_AXIAL ? s->axial.modelled : s->bending.modelled;
    if (!part->modelled)
        return BR_OK;
    const size_t states = strcmp(d->scheme, "euler") == 0 ? 1 : BR_DISCRETE_STATES;
    enum br_status status = br_discrete_field_init(&part->field, s, kind, n, states, err);
    if (!status)
        status = br_discrete_load_init(&part->load, s, kind, &part->field, err);
    if (!status)
        status = br_discrete_set_initial(&part->field, s, kind, err);
    for (int velocity = 0; velocity < 2 && !status; velocity++)
        (velocity ? d->tip.velocity : d->tip.displacement)[kind] =
            br_discrete_field_tip(&part->field, velocity);
    return status;
}

enum br_status br_discrete_create(struct br_discrete **out, const struct br_scene *scene, size_t n,
                                  size_t steps, const struct br_method *method,
                                  struct br_error *err)
{
    *out = NULL;
    enum br_status status = check_method(method, err);
    if (status)
        return status;
    if (n < 1 || steps < 1)
        return br_fail(err, BR_BAD_INPUT, "found %zu elements and %zu steps, expected some", n,
                       steps);
    struct br_discrete *d = br_allocate(1, sizeof *d);
    if (!d)
        return br_no_memory(err, "the exact discrete solution");
    d->scene = scene;
    d->scheme = method->scheme->name;
    d->implicit = strcmp(method->contact->name, "implicit") == 0;
    d->regularised = strcmp(method->friction->name, "regularised") == 0;
    d->steps = steps;
    for (int kind = BR_AXIAL; kind <= BR_BENDING && !status; kind++)
        status = create_part(d, (enum br_field_kind)kind, n, err);
    if (status)
        br_discrete_free(d);
    else
        *out = d;
    return status;
}

void br_discrete_free(struct br_discrete *d)
{
    if (!d)
        return;
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        br_discrete_field_clear(&d->part[kind].field);
        br_discrete_load_clear(&d->part[kind].load);
    }
    free(d);
}

enum br_status br_discrete_step(struct br_discrete *d, struct br_error *err)
{
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        const enum br_status status = d->part[kind].modelled
                                          ? br_discrete_step_field(d, (enum br_field_kind)kind, err)
                                          : BR_OK;
        if (status)
            return status;
    }
    d->done++;
    return BR_OK;
}

/* ---- looking ---- */

size_t br_discrete_steps_done(const struct br_discrete *d)
{
    return d->done;
}

struct br_discrete_tip br_discrete_tip(const struct br_discrete *d)
{
    struct br_discrete_tip tip = d->tip;
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        if (d->part[kind].modelled) {
            tip.displacement[kind] = br_discrete_field_tip(&d->part[kind].field, false);
            tip.velocity[kind] = br_discrete_field_tip(&d->part[kind].field, true);
        }
    return tip;
}

void br_discrete_get(const struct br_discrete *d, enum br_field_kind kind,
                     long double *displacement, long double *velocity)
{
    const struct br_discrete_part *part = &d->part[kind];
    const size_t bytes = part->d * (part->n + 1) * sizeof(long double);
    if (part->modelled) {
        br_discrete_field_get(&part->field, displacement, velocity);
        return;
    }
    if (displacement)
        memset(displacement, 0, bytes);
    if (velocity)
        memset(velocity, 0, bytes);
}

void br_discrete_load(const struct br_discrete *d, enum br_field_kind kind, long double *load)
{
    const struct br_discrete_part *part = &d->part[kind];
    const size_t size = part->d * (part->n + 1);
    for (size_t i = 0; i < size; i++)
        load[i] = part->modelled ? part->field.load[i] : 0;
    for (size_t c = 0; c < part->d && part->modelled; c++)
        load[size - part->d + c] += part->load.tip[c];
}
