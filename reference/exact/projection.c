/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>

#include "reference/exact/combine.h"
#include "reference/exact/piecewise.h"
#include "reference/exact/query.h"

struct br_exact_projection {
    struct br_exact_part part;
    size_t modes, length; /* of the field, of its part's series */
    br_combine *combine;
    double *expand; /* modes x length: each mode's series */
    double *series; /* length, workspace */
    struct br_piecewise *piecewise;
};

/* The series of every mode. */
static enum br_status fill(struct br_exact_projection *p, const struct br_field *field,
                           struct br_error *err)
{
    double *q = br_allocate(p->modes, sizeof *q);
    double *c = br_allocate(br_modes_length(field->modes, 0), sizeof *c);
    const double scale = pow(field->length, -(double)p->part.order);
    for (size_t i = 0; i < p->modes && q && c; i++) {
        q[i] = 1;
        br_modes_expand(field->modes, p->part.order, q, c);
        for (size_t k = 0; k < p->length; k++)
            p->expand[i * p->length + k] = scale * c[k];
        q[i] = 0;
    }
    const bool done = q && c;
    free(q);
    free(c);
    return done ? BR_OK : br_no_memory(err, "a projection");
}

static enum br_status init(struct br_exact_projection *p, const struct br_field *field,
                           const struct br_exact_mesh *mesh, struct br_error *err)
{
    p->combine = br_combine_best();
    p->modes = field->modes->count;
    p->length = br_modes_length(field->modes, p->part.order);
    p->expand = br_allocate(p->modes * p->length, sizeof *p->expand);
    p->series = br_allocate(p->length, sizeof *p->series);
    if (!p->expand || !p->series)
        return br_no_memory(err, "a projection");
    const enum br_status status = fill(p, field, err);
    return status ? status
                  : br_piecewise_create(&p->piecewise, &field->modes->pieces,
                                        field->modes->degree - p->part.order, mesh, err);
}

enum br_status br_exact_projection_create(struct br_exact_projection **out,
                                          const struct br_exact *exact,
                                          const struct br_exact_part *part,
                                          const struct br_exact_mesh *mesh, struct br_error *err)
{
    *out = NULL;
    enum br_status status = br_exact_check_part(exact, part, 0, err);
    if (!status && (!mesh->elements || mesh->degree > 8))
        status = br_fail(err, BR_BAD_INPUT,
                         "%zu elements of degree %zu, expected 1 or more of at most 8",
                         mesh->elements, mesh->degree);
    if (status)
        return status;
    struct br_exact_projection *p = br_allocate(1, sizeof *p);
    if (!p)
        return br_no_memory(err, "a projection");
    p->part = *part;
    status = init(p, exact->solution->field[part->field], mesh, err);
    if (status)
        br_exact_projection_free(p);
    else
        *out = p;
    return status;
}

void br_exact_projection_free(struct br_exact_projection *p)
{
    if (!p)
        return;
    br_piecewise_free(p->piecewise);
    free(p->expand);
    free(p->series);
    free(p);
}

void br_exact_projection_apply(struct br_exact_projection *p, const struct br_exact *exact,
                               const struct br_exact_state *state, double *c, double *rest)
{
    (void)exact;
    p->combine(p->modes, state->mode[p->part.field][p->part.velocity], p->length, p->expand,
               p->series);
    br_piecewise_apply(p->piecewise, p->series, c, rest);
}
