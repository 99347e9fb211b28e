/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sums the works of a march. */
#include <math.h>

#include "reference/energy_forms.h"
#include "solver/load.h"

struct br_energy_meter {
    const struct br_march *march;
    const struct br_scene *scene;
    double *before[2][2], *after[2][2]; /* by br_field_kind: displacement and velocity */
    double *load[2];
    double *memory;
    struct br_energy start, now;
    real k;
    bool euler;                 /* else the trapezoidal rule, and D_scheme as the remainder */
    struct br_step_load own[2]; /* where the scheme is not Euler's */
    struct power {
        real loads[2], viscous[2], friction;
    } before_power; /* at the last look, W */
    struct work {
        real loads[2], viscous[2], friction, scheme, scheme_contact;
    } work;
};

/* Where the tip's u is. */
static size_t axial_tip(const struct br_energy_meter *m)
{
    const struct br_field *field = br_march_field(m->march, BR_AXIAL);
    return field->n * br_field_unknowns(field);
}

static void look(struct br_energy_meter *m)
{
    m->now = (struct br_energy){0};
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        const struct br_field *field = br_march_field(m->march, (enum br_field_kind)kind);
        if (!br_march_models(m->march, (enum br_field_kind)kind))
            continue;
        br_march_get(m->march, (enum br_field_kind)kind, m->after[kind][0], m->after[kind][1]);
        m->now.kinetic[kind] = br_energy_kinetic(field, m->after[kind][1]);
        m->now.stored[kind] = br_energy_stored(field, m->after[kind][0]);
    }
    const struct br_contact *c = &m->scene->contact;
    if (!c->modelled)
        return;
    const double depth = m->after[BR_AXIAL][0][axial_tip(m)] - c->gap;
    m->now.contact = depth <= 0 ? 0 : c->stiffness * depth * depth / 2;
}

/* Loads of one's own at the time levels, of the march's meshes. */
static enum br_status start_powers(struct br_energy_meter *m, struct br_error *err);

static void place(struct br_energy_meter *m, const size_t sizes[2])
{
    double *memory = m->memory;
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        double **const arrays[] = {&m->before[kind][0], &m->before[kind][1], &m->after[kind][0],
                                   &m->after[kind][1], &m->load[kind]};
        for (size_t a = 0; a < sizeof arrays / sizeof *arrays; a++) {
            *arrays[a] = memory;
            memory += sizes[kind];
        }
    }
}

enum br_status br_energy_meter_create(struct br_energy_meter **out, const struct br_march *march,
                                      const struct br_scene *scene,
                                      const struct br_time_scheme *scheme, double k,
                                      struct br_error *err)
{
    *out = NULL;
    const size_t sizes[2] = {br_field_size(br_march_field(march, BR_AXIAL)),
                             br_field_size(br_march_field(march, BR_BENDING))};
    struct br_energy_meter *m = br_allocate(1, sizeof *m);
    double *memory = br_allocate(5 * (sizes[0] + sizes[1]), sizeof *memory);
    if (!m || !memory) {
        free(m);
        free(memory);
        return br_no_memory(err, "the energies");
    }
    *m = (struct br_energy_meter){.march = march,
                                  .scene = scene,
                                  .memory = memory,
                                  .k = k,
                                  .euler = scheme == br_time_schemes[0]};
    place(m, sizes);
    look(m);
    m->start = m->now;
    const enum br_status status = m->euler ? BR_OK : start_powers(m, err);
    if (status)
        br_energy_meter_free(m);
    else
        *out = m;
    return status;
}

void br_energy_meter_free(struct br_energy_meter *m)
{
    if (!m)
        return;
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        br_step_load_clear(&m->own[kind]);
    free(m->memory);
    free(m);
}

/* ---- by the trapezoidal rule ---- */

static real dot(const double *a, const double *b, size_t size)
{
    real sum = 0;
    for (size_t i = 0; i < size; i++)
        sum += (real)a[i] * b[i];
    return sum;
}

static real load_power(struct br_energy_meter *m, enum br_field_kind kind)
{
    const struct br_field *f = br_march_field(m->march, kind);
    const struct br_drive *drive = &m->own[kind].drive;
    const double *velocity = m->after[kind][1];
    const size_t size = br_field_size(f), unknowns = br_field_unknowns(f);
    real power = drive->vector ? drive->factor * dot(drive->vector, velocity, size) : 0;
    for (size_t c = 0; c < unknowns; c++)
        power += (real)drive->tip[c] * velocity[size - unknowns + c];
    return power;
}

static enum br_status find_powers(struct br_energy_meter *m, struct power *power,
                                  struct br_error *err)
{
    const double t = br_march_time(m->march);
    const size_t tip = 2 * br_march_field(m->march, BR_BENDING)->n;
    *power = (struct power){0};
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        const struct br_field *f = br_march_field(m->march, (enum br_field_kind)kind);
        if (!br_march_models(m->march, (enum br_field_kind)kind))
            continue;
        const enum br_status status = br_step_load_update(&m->own[kind], f, t, err);
        if (status)
            return status;
        power->loads[kind] = load_power(m, (enum br_field_kind)kind);
        power->viscous[kind] = (real)f->viscosity * br_bend_square(f, m->after[kind][1], NULL);
    }
    power->friction =
        (real)br_march_tip(m->march)->friction_force * (real)m->after[BR_BENDING][1][tip];
    return BR_OK;
}

static enum br_status start_powers(struct br_energy_meter *m, struct br_error *err)
{
    enum br_status status = BR_OK;
    for (int kind = BR_AXIAL; kind <= BR_BENDING && !status; kind++) {
        const struct br_field *f = br_march_field(m->march, (enum br_field_kind)kind);
        const struct br_forces forces = br_forces_of_scene(m->scene, (enum br_field_kind)kind);
        if (br_march_models(m->march, (enum br_field_kind)kind))
            status = br_step_load_init(&m->own[kind], &forces, f, err);
    }
    return status ? status : find_powers(m, &m->before_power, err);
}

static void add_trapezoid(struct br_energy_meter *m)
{
    struct br_error err = {0};
    struct power now;
    if (find_powers(m, &now, &err)) /* the march has met that load before us */
        now = (struct power){{NAN, NAN}, {NAN, NAN}, NAN};
    const struct power *before = &m->before_power;
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        m->work.loads[kind] += m->k / 2 * (before->loads[kind] + now.loads[kind]);
        m->work.viscous[kind] += m->k / 2 * (before->viscous[kind] + now.viscous[kind]);
    }
    m->work.friction += m->k / 2 * (before->friction + now.friction);
    m->before_power = now;
}

/* ---- by Euler's own sums ---- */

static void add_field(struct br_energy_meter *m, enum br_field_kind kind)
{
    const struct br_field *f = br_march_field(m->march, kind);
    const double *velocity = m->after[kind][1];
    br_march_load(m->march, kind, m->load[kind]);
    real power = 0;
    for (size_t i = 0; i < br_field_size(f); i++)
        power += (real)m->load[kind][i] * velocity[i];
    m->work.loads[kind] += m->k * power;
    m->work.viscous[kind] += m->k * (real)f->viscosity * br_bend_square(f, velocity, NULL);
    m->work.scheme +=
        br_mass_square(f, velocity, m->before[kind][1]) / 2 +
        (real)f->stiffness * br_bend_square(f, m->after[kind][0], m->before[kind][0]) / 2;
}

static void add_euler(struct br_energy_meter *m, double potential)
{
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        if (br_march_models(m->march, (enum br_field_kind)kind))
            add_field(m, (enum br_field_kind)kind);
    const struct br_tip *tip = br_march_tip(m->march);
    const size_t n = br_march_field(m->march, BR_AXIAL)->n;
    m->work.friction += m->k * (real)tip->friction_force * (real)m->after[BR_BENDING][1][2 * n];
    const size_t rod = axial_tip(m);
    const real way = (real)m->after[BR_AXIAL][0][rod] - m->before[BR_AXIAL][0][rod];
    m->work.scheme_contact +=
        (real)tip->contact_force * way - ((real)m->now.contact - (real)potential);
}

void br_energy_meter_step(struct br_energy_meter *m)
{
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        for (int i = 0; i < 2; i++) {
            double *const swap = m->before[kind][i];
            m->before[kind][i] = m->after[kind][i];
            m->after[kind][i] = swap;
        }
    const double potential = m->now.contact;
    look(m);
    if (m->euler)
        add_euler(m, potential);
    else
        add_trapezoid(m);
}

/* W - D_viscous - D_friction - (E_now - E_start) */
static real remainder_of(const struct br_energy_meter *m)
{
    const struct work *w = &m->work;
    return w->loads[0] + w->loads[1] - w->viscous[0] - w->viscous[1] - w->friction -
           ((real)br_energy_total(&m->now) - br_energy_total(&m->start));
}

void br_energy_meter_read(const struct br_energy_meter *m, struct br_energy *start,
                          struct br_energy *now, struct br_work *work)
{
    *start = m->start;
    *now = m->now;
    *work = (struct br_work){
        .loads = {(double)m->work.loads[0], (double)m->work.loads[1]},
        .viscous = {(double)m->work.viscous[0], (double)m->work.viscous[1]},
        .friction = (double)m->work.friction,
        .scheme = (double)(m->euler ? m->work.scheme : remainder_of(m)),
        .scheme_contact = (double)m->work.scheme_contact,
        .remainder = !m->euler,
    };
}
