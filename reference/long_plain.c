/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/long_plain.h"

#include <float.h>
#include <math.h>

#define BR_LONG
#include "solver/linear/plain.h"
#include "solver/linear/states.h"

struct long_plain {
    struct br_store store;
    struct br_field field;
    struct br_recursion recursion;
    size_t size, states;
    real *of[BR_MOST_STATES]; /* states, the first is the one that marches */
    real *nodal[2];           /* br_field_size each: workspace */
};

bool br_long_plain_judges(void)
{
    volatile long double one = 1, tiny = DBL_EPSILON / 1024; /* valgrind's has 53 bits */
    return one + tiny > one;
}

static const real *widen(const struct long_plain *s, int which, const double *value)
{
    for (size_t i = 0; value && i < br_field_size(&s->field); i++)
        s->nodal[which][i] = value[i];
    return value ? s->nodal[which] : NULL;
}

/* ---- a step ---- */

static enum br_status predict(void *self, const struct br_drive *drive, double *velocity,
                              struct br_error *err)
{
    (void)err;
    struct long_plain *s = self;
    const struct br_recursion_load load = {
        widen(s, 0, drive->vector), drive->factor, {drive->tip[0], drive->tip[1]}};
    *velocity = (double)br_recursion_predict(&s->recursion, s->of[0], &load);
    return BR_OK;
}

static double finish(void *self, double force)
{
    struct long_plain *s = self;
    return (double)br_recursion_finish(&s->recursion, s->of[0], force);
}

static double tip_displacement(const void *self)
{
    const struct long_plain *s = self;
    return (double)br_recursion_tip(&s->recursion, s->of[0]);
}

static double tip_compliance(const void *self)
{
    return (double)((const struct long_plain *)self)->recursion.compliance;
}

/* ---- states ---- */

static enum br_status set_step(void *self, double k, struct br_error *err)
{
    struct long_plain *s = self;
    s->recursion.k = k;
    return br_recursion_fill(&s->recursion, "the reference", err);
}

static enum br_status keep(void *self, size_t count, struct br_error *err)
{
    struct long_plain *s = self;
    for (size_t i = 0; i < count; i++)
        if (!(s->of[s->states++] = br_store_take(&s->store, s->size, sizeof(real))))
            return br_no_memory(err, "the reference");
    return BR_OK;
}

static void exchange(void *self, size_t a, size_t b)
{
    struct long_plain *s = self;
    real *of_a = s->of[a];
    s->of[a] = s->of[b];
    s->of[b] = of_a;
}

static void combine(void *self, size_t into, size_t count, const double *weight)
{
    struct long_plain *s = self;
    for (size_t i = 0; i < s->size; i++) {
        real sum = 0;
        for (size_t j = 0; j < count; j++)
            sum += weight[j] != 0 ? weight[j] * s->of[j][i] : 0;
        s->of[into][i] = sum;
    }
}

static enum br_status create(const struct br_field *field, const struct br_kernel *kernel,
                             void **self, struct br_error *err)
{
    (void)kernel;
    struct long_plain *s = br_allocate(1, sizeof *s);
    *self = s;
    if (!s)
        return br_no_memory(err, "the reference");
    s->field = *field;
    s->recursion = (struct br_recursion){
        .n = field->n,
        .d = field->kind == BR_AXIAL ? 1 : 2,
        .m = (int)br_field_unknowns(field),
        .h = field->h,
        .density = field->density,
        .stiffness = field->stiffness,
        .viscosity = field->viscosity,
    };
    s->size = br_recursion_size(&s->recursion);
    br_recursion_take(&s->recursion, &s->store);
    for (int i = 0; i < 2; i++)
        s->nodal[i] = br_store_take(&s->store, br_field_size(field), sizeof(real));
    if (s->store.failed)
        return br_no_memory(err, "the reference");
    const enum br_status status = keep(s, 1, err);
    return status ? status : set_step(s, field->k, err);
}

static void release(void *self)
{
    if (self)
        br_store_clear(&((struct long_plain *)self)->store);
    free(self);
}

static void set(void *self, const double *displacement, const double *velocity)
{
    struct long_plain *s = self;
    br_recursion_set(&s->recursion, widen(s, 0, displacement), widen(s, 1, velocity), s->of[0]);
}

static void get(const void *self, double *displacement, double *velocity)
{
    const struct long_plain *s = self;
    const size_t size = br_field_size(&s->field);
    br_recursion_get(&s->recursion, s->of[0], displacement ? s->nodal[0] : NULL,
                     velocity ? s->nodal[1] : NULL);
    for (size_t i = 0; displacement && i < size; i++)
        displacement[i] = (double)s->nodal[0][i];
    for (size_t i = 0; velocity && i < size; i++)
        velocity[i] = (double)s->nodal[1][i];
}

/* As in plain.c. */
static void size_of(void *self, size_t which, double size[2])
{
    const struct long_plain *s = self;
    const size_t m = (size_t)s->recursion.m;
    const bool beam = s->recursion.d == 2;
    for (size_t j = 0; j < 2; j++) {
        real sum = 0;
        for (size_t i = 0; i < s->field.n; i++) {
            const real *kappa = s->of[which] + (2 * i + j) * m;
            sum += kappa[0] * kappa[0] + (m == 2 ? kappa[1] * kappa[1] / 3 : 0);
        }
        const real strain = sqrtl(sum / s->recursion.h);
        size[j] = (double)(beam ? strain / s->recursion.h : strain);
    }
}

static const struct br_field_solver form = {
    .create = create,
    .free = release,
    .tip_compliance = tip_compliance,
    .set = set,
    .get = get,
    .predict = predict,
    .finish = finish,
    .tip_displacement = tip_displacement,
    .set_step = set_step,
    .keep = keep,
    .exchange = exchange,
    .combine = combine,
    .size = size_of,
};

static double round_off(const struct br_field *field)
{
    (void)field;
    return DBL_EPSILON;
}

const struct br_linear_solver br_long_plain = {
    .name = "plain in long double",
    .axial = &form,
    .axial_quadratic = &form,
    .bending = &form,
    .round_off = round_off,
    .bytes = {184, 436, 282},
    .state_bytes = {32, 64, 64},
    .cost = br_cost_by_elements,
    .step_cost = 120,
    .element_cost = {10, 28, 16},
};
