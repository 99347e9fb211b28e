/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/exact/field.h"

#include <math.h>

/* What axial and bending have in common. */
struct data {
    double stiffness, viscosity;
    const struct br_load *load;
    const struct br_function *tip_force, *tip_moment;
    const struct br_function *displacement, *velocity;
    const struct br_function *slope; /* of the displacement, derived degree - 1 times */
};

static struct data select_data(const struct br_scene *s, size_t degree)
{
    const struct br_axial *a = &s->axial;
    const struct br_bending *b = &s->bending;
    if (degree == 1)
        return (struct data){
            .stiffness = a->stiffness,
            .viscosity = a->viscosity,
            .load = &a->load,
            .tip_force = &a->tip_force,
            .displacement = &a->displacement,
            .velocity = &a->velocity,
            .slope = &a->displacement,
        };
    return (struct data){
        .stiffness = b->stiffness,
        .viscosity = b->viscosity,
        .load = &b->load,
        .tip_force = &b->tip_force,
        .tip_moment = &b->tip_moment,
        .displacement = &b->displacement,
        .velocity = &b->velocity,
        .slope = &b->displacement_slope,
    };
}

static enum br_status set_initial(struct br_field *f, const struct data *d, struct br_error *err)
{
    const double scale = f->modes->degree == 1 ? 1 : f->length; /* dw/dxi = L dw/dx */
    enum br_status status = BR_OK;
    if (!br_function_is_zero(d->slope))
        status =
            br_modes_project_energy(f->modes, d->slope, f->length, scale, f->displacement, err);
    if (!status && !br_function_is_zero(d->velocity))
        status = br_modes_project(f->modes, d->velocity, f->length, f->velocity, err);
    br_function_evaluate(d->displacement, 1, &f->length, 0, &f->tip_displacement);
    br_function_evaluate(d->velocity, 1, &f->length, 0, &f->tip_velocity);
    return status;
}

static enum br_status set_space(struct br_field *f, struct br_error *err)
{
    const size_t m = f->modes->count;
    enum br_status status = BR_OK;
    for (size_t term = 0; term < BR_LOAD_TERMS && !status; term++) {
        const struct br_product *p = &f->load->term[term];
        double *space = f->load_space + term * m;
        if (p->space.uses_t || br_product_is_zero(p))
            continue;
        status = br_modes_load(f->modes, &p->space, f->length, 0, space, err);
        for (size_t i = 0; i < m; i++)
            space[i] *= f->length;
    }
    return status;
}

static enum br_status allocate(struct br_field *f, size_t degree, size_t m, struct br_error *err)
{
    const enum br_status status = br_modes_create(&f->modes, m, degree, err);
    f->mass = br_allocate(m, sizeof *f->mass);
    f->load_space = br_allocate(m * (BR_LOAD_TERMS + 1), sizeof *f->load_space);
    f->displacement = br_allocate(m, sizeof *f->displacement);
    f->velocity = br_allocate(m, sizeof *f->velocity);
    if (status)
        return status;
    if (!f->mass || !f->load_space || !f->displacement || !f->velocity)
        return br_no_memory(err, "the modes");
    return BR_OK;
}

enum br_status br_field_create(struct br_field **out, const struct br_scene *scene, size_t degree,
                               size_t modes, struct br_error *err)
{
    const struct data d = select_data(scene, degree);
    const double power = pow(scene->length, 1 - 2 * (double)degree);
    *out = NULL;
    struct br_field *f = br_allocate(1, sizeof *f);
    if (!f)
        return br_no_memory(err, "the modes");
    f->length = scene->length;
    f->load = d.load;
    f->tip_force = d.tip_force;
    f->tip_moment = d.tip_moment;
    f->damping = d.viscosity * power;
    f->stiffness = d.stiffness * power;
    enum br_status status = allocate(f, degree, modes, err);
    for (size_t i = 0; !status && i < modes; i++)
        f->mass[i] = scene->density * f->length * f->modes->size[i] * f->modes->size[i];
    if (!status)
        status = set_space(f, err);
    if (!status)
        status = set_initial(f, &d, err);
    if (status)
        br_field_free(f);
    else
        *out = f;
    return status;
}

void br_field_free(struct br_field *f)
{
    if (!f)
        return;
    br_modes_free(f->modes);
    free(f->mass);
    free(f->load_space);
    free(f->displacement);
    free(f->velocity);
    free(f);
}

/* out[i] += force * tip_i + moment * slope_i / L */
static void add_tip(const struct br_field *f, double t, double *out)
{
    double force, moment = 0;
    br_function_evaluate(f->tip_force, 1, &f->length, t, &force);
    if (f->tip_moment)
        br_function_evaluate(f->tip_moment, 1, &f->length, t, &moment);
    for (size_t i = 0; i < f->modes->count; i++)
        out[i] += force * f->modes->tip[i] + moment / f->length * f->modes->slope[i];
}

enum br_status br_field_load(const struct br_field *f, double t, double *out, struct br_error *err)
{
    const size_t m = f->modes->count;
    for (size_t i = 0; i < m; i++)
        out[i] = 0;
    for (size_t term = 0; term < BR_LOAD_TERMS; term++) {
        const struct br_product *p = &f->load->term[term];
        double factor, *space = f->load_space + term * m;
        if (br_product_is_zero(p))
            continue;
        br_function_evaluate(&p->time, 1, &f->length, t, &factor);
        if (p->space.uses_t) {
            space = f->load_space + BR_LOAD_TERMS * m;
            const enum br_status status =
                br_modes_load(f->modes, &p->space, f->length, t, space, err);
            if (status)
                return status;
            factor *= f->length;
        }
        for (size_t i = 0; i < m; i++)
            out[i] += factor * space[i];
    }
    add_tip(f, t, out);
    return BR_OK;
}

double br_field_norm(const struct br_field *f, const double *q, size_t stride)
{
    double sum = 0;
    for (size_t i = 0; i < f->modes->count; i++) {
        const double part = f->modes->size[i] * q[i * stride];
        sum += part * part;
    }
    return sqrt(f->length * sum);
}
