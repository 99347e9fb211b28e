/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Figure 10: Example 4 with other coefficients of contact and friction. The paper does not say
 * which ones, nor at what time: c_H from 1 to 1e8 N/m, c_V from 10 to 1e9 N/m; at t = T, and the
 * most. */
#include <math.h>
#include <string.h>

#include "study/paper/paper.h"

enum { LOOKS = 300 };

static const struct range {
    double low;
    size_t decades;
} ranges[BR_SWEEPS] = {{1, 8}, {10, 8}};

enum br_status br_paper_sweep_create(struct br_paper *p, struct br_error *err)
{
    const struct br_scene *scene = &p->example[3].scene;
    p->sweep[BR_SWEEP_CONTACT].paper = scene->contact.stiffness;
    p->sweep[BR_SWEEP_FRICTION].paper = scene->friction.coefficient;
    for (size_t s = 0; s < BR_SWEEPS; s++) {
        struct br_sweep *sweep = &p->sweep[s];
        const size_t count = ranges[s].decades * p->request.per_decade + 1;
        sweep->point = br_allocate(count, sizeof *sweep->point);
        if (!sweep->point)
            return br_no_memory(err, "the sweep");
        sweep->points = count;
        for (size_t i = 0; i < count; i++)
            sweep->point[i].coefficient =
                ranges[s].low * pow(10, (double)i / (double)p->request.per_decade);
    }
    return BR_OK;
}

/* |u| + |w| of a march, in L2. */
struct size {
    double *nodal;
    double last, most; /* m^(3/2) */
};

/* The square of the L2 norm of nodal values, by the element's mass. */
static double square(const struct br_field *field, const double *nodal)
{
    const size_t unknowns = br_field_unknowns(field), size = 2 * unknowns;
    double sum = 0;
    for (size_t e = 0; e < field->n; e++)
        for (size_t i = 0; i < size; i++)
            for (size_t j = 0; j < size; j++)
                sum += nodal[e * unknowns + i] * nodal[e * unknowns + j] *
                       (field->kind == BR_AXIAL ? br_axial_mass[i][j] : br_bending_mass[i][j]);
    return field->h * sum;
}

static enum br_status measure(void *self, const struct br_march *march,
                              const struct br_history_row *row, struct br_error *err)
{
    (void)row, (void)err;
    struct size *s = self;
    s->last = 0;
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        br_march_get(march, (enum br_field_kind)kind, s->nodal, NULL);
        s->last += sqrt(square(br_march_field(march, (enum br_field_kind)kind), s->nodal));
    }
    s->most = s->last <= s->most ? s->most : s->last; /* keeps a NaN */
    return BR_OK;
}

/* How a point is marched. */
struct way {
    bool implicit;  /* the contact force at the new step */
    size_t coarser; /* h and k times this */
};

static enum br_status run(const struct br_paper *p, const struct br_scene *scene,
                          const struct way *way, struct size *size, bool *unstable,
                          struct br_error *err)
{
    struct br_method method = br_method_default();
    for (size_t c = 0; br_contact_rules[c]; c++)
        if (br_contact_rules[c]->at_new_step == way->implicit)
            method.contact = br_contact_rules[c];
    size_t level[LOOKS];
    const size_t steps = p->request.per_second * (size_t)lround(scene->duration) / way->coarser;
    const size_t looks = steps < LOOKS ? steps : LOOKS;
    for (size_t i = 0; i < looks; i++)
        level[i] = (i + 1) * steps / looks;
    const struct br_history_observer observer = {.self = size, .look = measure};
    const struct br_history_request request = {
        .scene = scene,
        .method = &method,
        .n = p->request.n / way->coarser,
        .steps = steps,
        .level = level,
        .levels = looks,
        .observer = &observer,
        .observers = 1,
    };
    struct br_march *march = NULL;
    struct br_history_end end;
    const enum br_status status = br_history_run(&request, &march, &end, err);
    if (march && unstable)
        *unstable = br_march_contact_unstable(march);
    br_march_free(march);
    return status;
}

enum br_status br_paper_sweep_point(struct br_paper *p, size_t sweep, size_t i,
                                    struct br_error *err)
{
    struct br_sweep_point *point = &p->sweep[sweep].point[i];
    struct br_scene scene = p->example[3].scene; /* borrows its functions */
    if (sweep == BR_SWEEP_CONTACT)
        scene.contact.stiffness = point->coefficient;
    else
        scene.friction.coefficient = point->coefficient;
    struct size size = {.nodal = br_allocate(2 * (p->request.n + 1), sizeof *size.nodal)};
    if (!size.nodal)
        return br_no_memory(err, "the sweep");
    enum br_status status = BR_OK;
    for (int rule = 0; rule < 2 && !status; rule++) {
        size.last = size.most = 0;
        status = run(p, &scene, &(struct way){rule, 1}, &size, rule ? NULL : &point->unstable, err);
        point->last[rule] = size.last;
        point->most[rule] = size.most;
    }
    size.last = size.most = 0;
    if (!status)
        status = run(p, &scene, &(struct way){true, 2}, &size, NULL, err);
    point->doubled = size.most;
    free(size.nodal);
    return status;
}
