/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Works of a march by the trapezoidal rule over the march's own steps, for schemes that have no
 * stages to look at. */
#include <math.h>

#include "reference/energy_forms.h"

static real load_power(const struct br_meter_field *m)
{
    const struct br_field *f = &m->field;
    const struct br_drive *drive = &m->own.drive;
    const double *velocity = m->scratch[1];
    const size_t size = br_field_size(f), unknowns = br_field_unknowns(f);
    real sizes, power = 0;
    if (drive->vector)
        power = drive->factor * br_nodal_product(drive->vector, velocity, size, &sizes);
    for (size_t c = 0; c < unknowns; c++)
        power += (real)drive->tip[c] * velocity[size - unknowns + c];
    return power;
}

/* The state's energy and powers; those of the contact are not asked for. */
static enum br_status look(struct br_energy_meter *m, enum br_field_kind kind,
                           struct br_power *power, struct br_error *err)
{
    struct br_meter_field *f = &m->field[kind];
    br_march_get(m->march, kind, f->scratch[0], f->scratch[1]);
    f->now = br_energy_of_field(&f->field, &m->scene->contact, f->scratch[0], f->scratch[1]);
    const enum br_status status =
        br_step_load_update(&f->own, &f->field, br_march_time(m->march), err);
    if (status)
        return status;
    *power = (struct br_power){.load = load_power(f)};
    power->viscous =
        (real)f->field.viscosity * br_bend_product(&f->field, f->scratch[1], f->scratch[1]);
    if (kind == BR_BENDING)
        power->tip = (real)br_march_tip(m->march)->friction_force * f->scratch[1][2 * f->field.n];
    return BR_OK;
}

enum br_status br_meter_start_trapezoid(struct br_energy_meter *m, struct br_error *err)
{
    enum br_status status = BR_OK;
    m->time = br_march_time(m->march);
    for (int kind = BR_AXIAL; kind <= BR_BENDING && !status; kind++) {
        struct br_meter_field *f = &m->field[kind];
        const struct br_forces forces = br_forces_of_scene(m->scene, (enum br_field_kind)kind);
        if (!f->modelled)
            continue;
        status = br_step_load_init(&f->own, &forces, &f->field, err);
        if (!status)
            status = look(m, (enum br_field_kind)kind, &f->before, err);
    }
    return status;
}

void br_meter_add_trapezoid(struct br_energy_meter *m)
{
    const double now_is = br_march_time(m->march);
    const real half = ((real)now_is - m->time) / 2;
    m->time = now_is;
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        struct br_meter_field *f = &m->field[kind];
        struct br_power now;
        struct br_error err = {0};
        if (!f->modelled)
            continue;
        if (look(m, (enum br_field_kind)kind, &now, &err)) /* the march has met that load before */
            now = (struct br_power){.load = NAN};
        f->work.load += half * (f->before.load + now.load);
        f->work.viscous += half * (f->before.viscous + now.viscous);
        f->work.tip += half * (f->before.tip + now.tip);
        f->before = now;
    }
}
