/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/exact/field.h"

#include <cblas.h>
#include <math.h>

static enum br_status set_initial(struct br_field *f, struct br_error *err)
{
    const struct br_field_data *d = &f->data;
    const double scale = f->modes->degree == 1 ? 1 : f->length; /* dw/dxi = L dw/dx */
    enum br_status status = BR_OK;
    if (!br_function_is_zero(d->slope))
        status = br_modes_project_energy(f->modes, d->slope, scale, f->displacement, err);
    if (!status && !br_function_is_zero(d->velocity))
        status = br_modes_project(f->modes, d->velocity, f->velocity, err);
    br_function_evaluate(d->displacement, 1, &f->length, 0, &f->tip_displacement);
    br_function_evaluate(d->velocity, 1, &f->length, 0, &f->tip_velocity);
    return status;
}

static enum br_status set_space(struct br_field *f, struct br_error *err)
{
    const size_t m = f->modes->count;
    enum br_status status = BR_OK;
    for (size_t term = 0; term < BR_LOAD_TERMS && !status; term++) {
        const struct br_product *p = &f->data.load->term[term];
        double *space = f->load_space + term * m;
        if (p->space.uses_t || br_product_is_zero(p))
            continue;
        status = br_modes_load(f->modes, &p->space, 0, (struct br_places){0}, space, err);
        for (size_t i = 0; i < m; i++)
            space[i] *= f->length;
    }
    return status;
}

static enum br_status create_modes(struct br_field *f, size_t degree, const struct br_outline *o,
                                   size_t modes, struct br_error *err)
{
    const size_t elements = o->end.count - 1;
    struct br_pieces pieces = {0};
    size_t *terms = br_allocate(elements, sizeof *terms);
    for (size_t e = 0; terms && e < elements; e++)
        terms[e] = br_outline_terms(o, e, modes);
    enum br_status status =
        terms ? br_pieces_init(&pieces, f->length, elements, o->end.at, terms, err)
              : br_no_memory(err, "the modes");
    if (!status)
        status = br_modes_create(&f->modes, &pieces, degree, err);
    br_pieces_clear(&pieces);
    free(terms);
    return status;
}

static enum br_status allocate(struct br_field *f, struct br_error *err)
{
    const size_t m = f->modes->count;
    f->mass = br_allocate(m, sizeof *f->mass);
    f->load_space = br_allocate(m * (BR_LOAD_TERMS + 1), sizeof *f->load_space);
    f->displacement = br_allocate(m, sizeof *f->displacement);
    f->velocity = br_allocate(m, sizeof *f->velocity);
    return f->mass && f->load_space && f->displacement && f->velocity
               ? BR_OK
               : br_no_memory(err, "the modes");
}

enum br_status br_field_create(struct br_field **out, const struct br_scene *scene, size_t degree,
                               const struct br_outline *outline, size_t modes, struct br_error *err)
{
    const double power = pow(scene->length, 1 - 2 * (double)degree);
    *out = NULL;
    struct br_field *f = br_allocate(1, sizeof *f);
    if (!f)
        return br_no_memory(err, "the modes");
    f->length = scene->length;
    f->data = br_field_data(scene, degree);
    f->fronts = outline->fronts;
    f->damping = f->data.viscosity * power;
    f->stiffness = f->data.stiffness * power;
    enum br_status status = create_modes(f, degree, outline, modes, err);
    if (!status)
        status = allocate(f, err);
    for (size_t i = 0; !status && i < f->modes->count; i++)
        f->mass[i] = scene->density * f->length * f->modes->size[i] * f->modes->size[i];
    if (!status)
        status = set_space(f, err);
    if (!status)
        status = set_initial(f, err);
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
    br_function_evaluate(f->data.tip_force, 1, &f->length, t, &force);
    if (f->data.tip_moment)
        br_function_evaluate(f->data.tip_moment, 1, &f->length, t, &moment);
    for (size_t i = 0; i < f->modes->count; i++)
        out[i] += force * f->modes->tip[i] + moment / f->length * f->modes->slope[i];
}

/* A load that no product gives, at one time: cut where it jumps there. */
static enum br_status load_at(const struct br_field *f, const struct br_function *space, double t,
                              double *out, struct br_error *err)
{
    struct br_breaks breaks = {0};
    enum br_status status = BR_OK;
    if (f->fronts && space->uses_x)
        status = br_breaks_add(space, BR_X, (struct br_box){{0, f->length}, {t, t}}, &breaks, err);
    double *x = br_allocate(breaks.count + 1, sizeof *x);
    if (!status && !x)
        status = br_no_memory(err, "a load");
    for (size_t i = 0; i < breaks.count && x; i++)
        x[i] = breaks.at[i].high;
    if (!status)
        status = br_modes_load(f->modes, space, t, (struct br_places){breaks.count, x}, out, err);
    free(x);
    br_breaks_free(&breaks);
    return status;
}

enum br_status br_field_load(const struct br_field *f, double t, double *out, double *size,
                             struct br_error *err)
{
    const size_t m = f->modes->count;
    *size = 0;
    for (size_t i = 0; i < m; i++)
        out[i] = 0;
    for (size_t term = 0; term < BR_LOAD_TERMS; term++) {
        const struct br_product *p = &f->data.load->term[term];
        double factor, *space = f->load_space + term * m;
        if (br_product_is_zero(p))
            continue;
        br_function_evaluate(&p->time, 1, &f->length, t, &factor);
        if (p->space.uses_t) {
            space = f->load_space + BR_LOAD_TERMS * m;
            const enum br_status status = load_at(f, &p->space, t, space, err);
            if (status)
                return status;
            factor *= f->length;
            *size +=
                fabs(factor) * cblas_dnrm2((int)br_modes_length(f->modes, 0), f->modes->series, 1);
        }
        for (size_t i = 0; i < m; i++)
            out[i] += factor * space[i];
    }
    add_tip(f, t, out);
    return BR_OK;
}

double br_field_work(const struct br_field *f)
{
    const double points = (double)f->modes->quadrature.count, m = (double)f->modes->count;
    double work = m;
    for (size_t term = 0; term < BR_LOAD_TERMS; term++) {
        const struct br_product *p = &f->data.load->term[term];
        if (p->space.uses_t && !br_product_is_zero(p))
            work += 9 * (0.05 * points + 2e-4 * m * (m + points)) + (f->fronts ? 100 : 0);
    }
    return work;
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
