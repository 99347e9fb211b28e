/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solver/ida_system.h"

#include <math.h>
#include <string.h>

/* Differences first, so that no more round-off than theirs is in it. */
void br_ida_elastic_force(const struct br_field *f, const double node[4], double force[4])
{
    if (f->kind == BR_AXIAL) {
        const double strain = (node[1] - node[0]) / f->h;
        force[0] = -strain;
        force[1] = strain;
        return;
    }
    double kappa[2]; /* h^2 w_xx, whose energy is (kappa0^2 + kappa1^2 / 3) / h^3 */
    br_curvature(node, kappa);
    const double scale = 1 / (f->h * f->h * f->h);
    const double even = scale * kappa[0], odd = scale * kappa[1];
    force[0] = 2 * odd;
    force[1] = odd - even;
    force[2] = -2 * odd;
    force[3] = odd + even;
}

static void fill_element(struct br_ida_system *s, enum br_field_kind kind)
{
    const size_t values = 2 * br_field_unknowns(&s->field[kind]);
    for (size_t j = 0; j < values; j++) {
        double node[4] = {0}, force[4];
        node[j] = 1;
        br_ida_elastic_force(&s->field[kind], node, force);
        for (size_t i = 0; i < values; i++)
            s->element_stiffness[kind][i][j] = force[i];
    }
}

double br_ida_mass(const struct br_field *f, size_t i, size_t j)
{
    return f->density * f->h * (f->kind == BR_AXIAL ? br_axial_mass[i][j] : br_bending_mass[i][j]);
}

/* ---- setting up ---- */

/* z and rho M z of br_ida_reaction. */
static enum br_status fill_cubic(struct br_ida_system *s, struct br_error *err)
{
    const struct br_field *f = &s->field[BR_BENDING];
    const size_t values = br_field_size(f);
    s->cubic = br_allocate(2 * values, sizeof *s->cubic);
    if (!s->cubic)
        return br_no_memory(err, "the reaction of the tip");
    s->cubic_mass = s->cubic + values;
    for (size_t node = 0; node <= f->n; node++) {
        const double x = (double)node / (double)f->n; /* over L */
        s->cubic[2 * node] = x * x * (3 - x) / 2;
        s->cubic[2 * node + 1] = (6 * x - 3 * x * x) / 2 / (double)f->n;
    }
    for (size_t e = 0; e < f->n; e++)
        for (size_t i = 0; i < 4; i++)
            for (size_t j = 0; j < 4; j++)
                s->cubic_mass[2 * e + i] += br_ida_mass(f, i, j) * s->cubic[2 * e + j];
    return BR_OK;
}

/* Displacements and velocities of a node stand side by side, so that a row's farthest unknown is
 * less than two nodes away. */
static void lay_out(struct br_ida_system *s)
{
    size_t node = 0;
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        s->at[kind] = node;
        if (s->modelled[kind])
            node += 2 * br_field_unknowns(&s->field[kind]);
    }
    s->node = node;
    s->count = node * s->field[BR_AXIAL].n;
    s->lower = node + 3 < s->count ? node + 3 : s->count - 1;
    s->upper = node + 1 < s->count ? node + 1 : s->count - 1;
}

enum br_status br_ida_system_init(struct br_ida_system *s, const struct br_scene *scene, size_t n,
                                  const struct br_method *method, struct br_error *err)
{
    *s = (struct br_ida_system){.scene = scene, .loaded = NAN};
    s->modelled[BR_AXIAL] = scene->axial.modelled;
    s->modelled[BR_BENDING] = scene->bending.modelled;
    s->mu = method->friction->needs_regularisation ? scene->friction.regularisation : 0;
    enum br_status status = BR_OK;
    for (int i = BR_AXIAL; i <= BR_BENDING && !status; i++) {
        const enum br_field_kind kind = (enum br_field_kind)i;
        s->field[kind] = br_field_of_scene(scene, kind, n, scene->duration);
        const struct br_forces forces = br_forces_of_scene(scene, kind);
        fill_element(s, kind);
        if (s->modelled[kind])
            status = br_step_load_init(&s->load[kind], &forces, &s->field[kind], err);
    }
    lay_out(s);
    if (!status && s->modelled[BR_BENDING])
        status = fill_cubic(s, err);
    return status;
}

void br_ida_system_clear(struct br_ida_system *s)
{
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        br_step_load_clear(&s->load[kind]);
    free(s->cubic);
    s->cubic = s->cubic_mass = NULL;
}

/* ---- looking at y ---- */

double br_ida_tip_displacement(const struct br_ida_system *s, enum br_field_kind kind,
                               const double *y)
{
    return s->modelled[kind] ? y[br_ida_at(s, kind, s->field[kind].n)] : 0;
}

double br_ida_tip_velocity(const struct br_ida_system *s, enum br_field_kind kind, const double *y)
{
    const size_t at = br_ida_at(s, kind, s->field[kind].n) + br_field_unknowns(&s->field[kind]);
    return s->modelled[kind] ? y[at] : 0;
}

void br_ida_nodal(const struct br_ida_system *s, enum br_field_kind kind, const double *y,
                  double *displacement, double *velocity)
{
    const size_t unknowns = br_field_unknowns(&s->field[kind]);
    const size_t bytes = unknowns * sizeof(double);
    double *const into[2] = {displacement, velocity};
    for (size_t part = 0; part < 2; part++) {
        if (!into[part])
            continue;
        memset(into[part], 0, bytes);
        for (size_t node = 1; node <= s->field[kind].n; node++)
            memcpy(into[part] + unknowns * node, y + br_ida_at(s, kind, node) + part * unknowns,
                   bytes);
    }
}

void br_ida_strain_rate(const struct br_ida_system *s, enum br_field_kind kind, const double *y,
                        double *rate)
{
    const size_t unknowns = br_field_unknowns(&s->field[kind]);
    for (size_t e = 0; e < s->field[kind].n; e++) {
        double node[4] = {0};
        for (size_t i = e == 0 ? unknowns : 0; i < 2 * unknowns; i++)
            node[i] = y[br_ida_at(s, kind, e + i / unknowns) + unknowns + i % unknowns];
        if (kind == BR_BENDING)
            br_curvature(node, rate + 2 * e);
        else
            rate[e] = node[1] - node[0];
    }
}

enum br_status br_ida_load(struct br_ida_system *s, double t, struct br_error *err)
{
    enum br_status status = BR_OK;
    if (t == s->loaded)
        return status;
    s->loaded = NAN;
    for (int kind = BR_AXIAL; kind <= BR_BENDING && !status; kind++)
        if (s->modelled[kind])
            status = br_step_load_update(&s->load[kind], &s->field[kind], t, err);
    if (!status)
        s->loaded = t;
    return status;
}
