/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sums the works of a march. */
#include <math.h>
#include <stdlib.h>

#include "reference/certificate.h"
#include "reference/energy_forms.h"

real br_nodal_product(const double *c, const double *v, size_t size, real *sizes)
{
    real sum = 0;
    *sizes = 0;
    for (size_t i = 0; i < size; i++) {
        const real term = (real)c[i] * v[i];
        sum += term;
        *sizes += fabsl(term);
    }
    return sum;
}

/* ---- setting up ---- */

/* A field by the scene, not by the solver. */
static struct br_field field_of(const struct br_energy_meter *m, enum br_field_kind kind)
{
    struct br_field f = br_field_of_scene(m->scene, kind, br_march_field(m->march, kind)->n, NAN);
    if (kind == BR_AXIAL)
        f.degree = m->method->axial_degree;
    return f;
}

static enum br_status set_up(struct br_energy_meter *m, struct br_error *err)
{
    size_t room = 0;
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        m->field[kind].field = field_of(m, (enum br_field_kind)kind);
        m->field[kind].modelled = br_march_models(m->march, (enum br_field_kind)kind);
        room += 2 * br_field_size(&m->field[kind].field);
    }
    double *memory = m->memory = br_allocate(room, sizeof *memory);
    if (!memory)
        return br_no_memory(err, "the energies");
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        struct br_meter_field *f = &m->field[kind];
        for (int i = 0; i < 2; i++, memory += br_field_size(&f->field))
            f->scratch[i] = memory;
        br_march_get(m->march, (enum br_field_kind)kind, f->scratch[0], f->scratch[1]);
        if (f->modelled)
            f->start = f->now =
                br_energy_of_field(&f->field, &m->scene->contact, f->scratch[0], f->scratch[1]);
    }
    return br_meter_watch(m, err);
}

enum br_status br_energy_meter_create(struct br_energy_meter **out, struct br_march *march,
                                      const struct br_scene *scene, const struct br_method *method,
                                      struct br_error *err)
{
    struct br_energy_meter *m = *out = br_allocate(1, sizeof *m);
    if (!m)
        return br_no_memory(err, "the energies");
    *m = (struct br_energy_meter){.march = march, .scene = scene, .method = method};
    m->limit = br_energy_limit(br_march_field(march, BR_AXIAL)->n, br_march_round_off(march));
    m->update = br_certificate_limits(method->scheme, br_march_field(march, BR_AXIAL)->n,
                                      br_march_round_off(march))
                    .update;
    const enum br_status status = set_up(m, err);
    if (status) {
        br_energy_meter_free(m);
        *out = NULL;
    }
    return status;
}

void br_energy_meter_free(struct br_energy_meter *m)
{
    if (!m)
        return;
    br_march_unwatch(m->march, m);
    br_watched_clear(&m->seen);
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        br_step_load_clear(&m->field[kind].own);
    free(m->memory);
    free(m);
}

/* ---- reading ---- */

double br_energy_meter_step(struct br_energy_meter *m)
{
    const double worst = m->any ? m->worst : NAN;
    m->worst = 0;
    m->any = false;
    return worst;
}

static void put(struct br_energy *to, enum br_field_kind kind, const struct br_field_energy *e)
{
    to->kinetic[kind] = (double)e->kinetic;
    to->stored[kind] = (double)e->stored;
    to->contact += (double)e->contact;
}

void br_energy_meter_read(const struct br_energy_meter *m, struct br_energy *start,
                          struct br_energy *now, struct br_work *work)
{
    *start = *now = (struct br_energy){0};
    *work = (struct br_work){0};
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        const struct br_meter_field *f = &m->field[kind];
        const struct br_field_work *w = &f->work;
        put(start, (enum br_field_kind)kind, &f->start);
        put(now, (enum br_field_kind)kind, &f->now);
        work->loads[kind] = (double)w->load;
        work->viscous[kind] = (double)w->viscous;
        work->scheme[kind] = (double)w->scheme;
        work->noise[kind] = (double)w->noise;
        work->steps[kind] = w->steps;
        work->gaining[kind] = w->gaining;
        work->gained[kind] = (double)w->gained;
    }
    work->friction = (double)m->field[BR_BENDING].work.tip;
    work->scheme_contact = (double)m->field[BR_AXIAL].work.contact;
}
