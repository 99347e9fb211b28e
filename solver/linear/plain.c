/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The recursions of plain.h as a solver: in double, and with BR_LONG in long double. */
#include <float.h>
#include <math.h>

#include "solver/linear/plain.h"

struct plain {
    struct br_states states;
    struct br_field field;
    struct br_recursion recursion;
};

/* ---- a step ---- */

static enum br_status predict(void *self, const struct br_drive *drive, double *velocity,
                              struct br_error *err)
{
    (void)err;
    struct plain *s = self;
    *velocity = (double)br_recursion_predict(&s->recursion, s->states.of[0], drive);
    return BR_OK;
}

static double finish(void *self, double force)
{
    struct plain *s = self;
    return (double)br_recursion_finish(&s->recursion, s->states.of[0], force);
}

static double tip_displacement(const void *self)
{
    const struct plain *s = self;
    return (double)br_recursion_tip(&s->recursion, s->states.of[0]);
}

static double tip_compliance(const void *self)
{
    return (double)((const struct plain *)self)->recursion.compliance;
}

/* ---- states ---- */

static enum br_status set_step(void *self, double k, struct br_error *err)
{
    struct plain *s = self;
    s->recursion.k = k;
    return br_recursion_fill(&s->recursion, br_field_names[s->field.kind], err);
}

static enum br_status create(const struct br_field *field, const struct br_kernel *kernel,
                             void **self, struct br_error *err)
{
    (void)kernel;
    const char *what = field->kind == BR_AXIAL ? "the axial solver" : "the bending solver";
    struct plain *s = br_allocate(1, sizeof *s);
    *self = s;
    if (!s)
        return br_no_memory(err, what);
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
    br_recursion_take(&s->recursion, &s->states.store);
    const enum br_status status =
        br_states_add(&s->states, br_recursion_size(&s->recursion), 1, err);
    return status ? status : set_step(s, field->k, err);
}

static void set(void *self, const double *displacement, const double *velocity)
{
    struct plain *s = self;
    br_recursion_set(&s->recursion, displacement, velocity, s->states.of[0]);
}

static void get(const void *self, double *displacement, double *velocity)
{
    const struct plain *s = self;
    br_recursion_get(&s->recursion, s->states.of[0], displacement, velocity);
}

static void strain_rate(const void *self, double *rate)
{
    const struct plain *s = self;
    const size_t m = (size_t)s->recursion.m;
    for (size_t i = 0; i < s->field.n; i++)
        for (size_t c = 0; c < m; c++)
            rate[m * i + c] = (double)s->states.of[0][(2 * i + 1) * m + c];
}

/* The square of u_x over an element is (kappa_0^2 + kappa_1^2 / 3) / h, of w_xx the same over h^3;
 * squares of small numbers would underflow in double. */
static void size_of(void *self, size_t which, double size[2])
{
    const struct plain *s = self;
    const size_t m = (size_t)s->recursion.m;
    const bool beam = s->recursion.d == 2;
    for (size_t j = 0; j < 2; j++) {
        long double sum[2] = {0};
        for (size_t i = 0; i < s->field.n; i++) {
            const real *kappa = s->states.of[which] + (2 * i + j) * m;
            const long double first = kappa[0], second = m == 2 ? kappa[1] : 0;
            sum[0] += beam ? first * first + second * second / 3 : first * first;
            sum[1] += beam ? 0 : second * second;
        }
        const long double strain = sqrtl((sum[0] + sum[1] / 3) / s->field.h);
        size[j] = (double)(beam ? strain / s->field.h : strain);
    }
}

const struct br_field_solver br_plain_form = {
    .create = create,
    .free = br_free_states,
    .tip_compliance = tip_compliance,
    .set = set,
    .get = get,
    .strain_rate = strain_rate,
    .predict = predict,
    .finish = finish,
    .tip_displacement = tip_displacement,
    .set_step = set_step,
    .keep = br_keep_states,
    .exchange = br_exchange_states,
    .combine = br_combine_states,
    .size = size_of,
};

#ifdef BR_LONG

bool br_long_plain_resolves(void)
{
    volatile long double one = 1, tiny = DBL_EPSILON / 1024; /* valgrind's has 53 bits */
    return one + tiny > one;
}

static double round_off(const struct br_field *field)
{
    (void)field;
    return DBL_EPSILON;
}

const struct br_linear_solver br_long_plain = {
    .name = "plain in long double",
    .axial = &br_plain_form,
    .axial_quadratic = &br_plain_form,
    .bending = &br_plain_form,
    .round_off = round_off,
    .bytes = {184, 436, 282},
    .state_bytes = {32, 64, 64},
    .step_cost = 120,
    .element_cost = {10, 28, 16},
};

#else

/* An upper estimate; the benchmark and tests/ measure less. The round-off of a tip that sticks does
 * not depend on the mesh. */
static double round_off(const struct br_field *field)
{
    return 4 * DBL_EPSILON * ((double)field->n + 1024);
}

const struct br_linear_solver br_plain = {
    .name = "plain",
    .title = "the same form as it is written down: one backward and one forward recursion",
    .citation = "discrete linear-quadratic problem; Riccati recursion, see solver/linear/plain.h",
    .axial = &br_plain_form,
    .axial_quadratic = &br_plain_form,
    .bending = &br_plain_form,
    .round_off = round_off,
    .bytes = {92, 218, 141},
    .state_bytes = {16, 32, 32},
    .step_cost = 120,
    .element_cost = {2.5, 7.1, 3.9},
};

#endif
