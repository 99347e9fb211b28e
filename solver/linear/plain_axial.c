/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The recursions of plain.h for the rod: 1 by 1 blocks, T = G = 1, the control
 * is the element's elongation h u_x, R = (c + ka)/h, element mass m [2 1; 1 2]
 * with m = rho h / (6 k). */
#include <math.h>

#include "solver/instruction_set.h"
#include "solver/linear/plain.h"
#include "solver/linear/states.h"

struct gain {
    double closed;   /* A = 1 - K */
    double feedback; /* K */
    double inverse;  /* S^-1 */
    double tip;      /* zeta */
};

struct element {
    double elongation; /* h u_x, m */
    double rate;       /* of it, m/s */
    double drive;      /* workspace: S^-1 s, m/s */
};

struct axial {
    struct br_field field;
    size_t n;
    double k, alpha;
    double r;                /* R */
    double tip_displacement; /* m */
    double tip_velocity;     /* m/s */
    double compliance;       /* z_tip */
    struct gain *gain;       /* n */
    struct element *element; /* n */
    struct br_states states; /* see numbers_of; the first is that of the elements */
};

static void axial_free(void *self)
{
    struct axial *a = self;
    if (!a)
        return;
    free(a->gain);
    free(a->element);
    br_states_clear(&a->states);
    free(a);
}

/* Q = 2m + P, S = R + Q, H = Q + m; P = 2m + 2mA + QA^2 + RK^2. */
static enum br_status fill_tables(struct axial *a, struct br_error *err)
{
    const struct br_field *field = &a->field;
    const long double m = (long double)field->density * field->h / field->k / 6;
    const long double r =
        ((long double)field->viscosity + (long double)field->k * field->stiffness) / field->h;
    long double p = 0, influence = 1, compliance = 0;
    for (size_t i = field->n; i-- > 0;) {
        const long double q = 2 * m + p;
        const long double s = r + q;
        if (!(s > 0 && isfinite(s)))
            return br_fail(err, BR_SINGULAR,
                           "axial: the step is not positive definite at element %zu of %zu", i,
                           field->n);
        const long double feedback = (q + m) / s;
        const long double closed = (r - m) / s; /* 1 - K */
        const long double zeta = influence / s;
        compliance += zeta * influence;
        influence *= closed;
        p = 2 * m + 2 * m * closed + q * closed * closed + r * feedback * feedback;
        a->gain[i] = (struct gain){(double)closed, (double)feedback, (double)(1 / s), (double)zeta};
    }
    a->k = field->k;
    a->alpha = field->stiffness / (field->viscosity + field->k * field->stiffness);
    a->r = (double)r;
    a->compliance = (double)compliance;
    return BR_OK;
}

static enum br_status axial_create(const struct br_linear_solver *row, const struct br_field *field,
                                   const struct br_linear_options *options, void **self,
                                   struct br_error *err)
{
    (void)row;
    (void)options;
    struct axial *a = br_allocate(1, sizeof *a);
    *self = a;
    if (!a)
        return br_no_memory(err, "the axial solver");
    a->field = *field;
    a->n = field->n;
    a->gain = br_allocate(field->n, sizeof *a->gain);
    a->element = br_allocate(field->n, sizeof *a->element);
    if (!a->gain || !a->element)
        return br_no_memory(err, "the axial solver");
    const enum br_status status = br_states_add(&a->states, 2 * field->n + 2, 1, err);
    return status ? status : fill_tables(a, err);
}

static double axial_compliance(const void *self)
{
    return ((const struct axial *)self)->compliance;
}

static void axial_set(void *self, const double *displacement, const double *velocity)
{
    struct axial *a = self;
    for (size_t i = 0; i < a->n; i++) {
        struct element *e = &a->element[i];
        e->elongation = displacement[i + 1] - displacement[i];
        e->rate = velocity[i + 1] - velocity[i];
    }
    a->tip_displacement = displacement[a->n];
    a->tip_velocity = velocity[a->n];
}

static void axial_get(const void *self, double *displacement, double *velocity)
{
    const struct axial *a = self;
    double u = 0, v = 0;
    for (size_t i = 0; i <= a->n; i++) {
        if (displacement)
            displacement[i] = u;
        if (velocity)
            velocity[i] = v;
        if (i == a->n)
            break;
        const struct element *e = &a->element[i];
        u += e->elongation;
        v += e->rate;
    }
}

static void axial_strain_rate(const void *self, double *rate)
{
    const struct axial *a = self;
    for (size_t i = 0; i < a->n; i++)
        rate[i] = a->element[i].rate;
}

BR_SWEEP
static enum br_status axial_predict(void *self, const struct br_drive *drive, double *velocity,
                                    struct br_error *err)
{
    (void)err;
    struct axial *a = self;
    const double *load = drive->vector, factor = drive->factor;
    const double r = a->r, alpha = a->alpha;
    const double zero = 0;
    const size_t stride = load ? 1 : 0;
    if (!load)
        load = &zero;
    double p = -factor * load[stride * a->n] - drive->tip[0];
    double tip = 0;
    for (size_t i = a->n; i-- > 0;) {
        const struct gain *gain = &a->gain[i];
        struct element *e = &a->element[i];
        const double rg = r * (alpha * e->elongation + e->rate); /* R g */
        const double s = rg + p;                                 /* s = R g + G'p */
        e->drive = gain->inverse * s;
        tip -= gain->tip * s;
        p = gain->closed * p - (gain->feedback * rg + factor * load[stride * i]);
    }
    *velocity = a->tip_velocity + tip;
    return BR_OK;
}

/* As for bending; the tip's displacement and velocity are sums over the field. */
BR_SWEEP
static double axial_finish(void *self, double force)
{
    struct axial *a = self;
    const double k = a->k;
    double y = 0, u = 0, v = 0;
    for (size_t i = 0; i < a->n; i++) {
        const struct gain *gain = &a->gain[i];
        struct element *e = &a->element[i];
        const double drive = e->drive + force * gain->tip;
        const double kappa = -(gain->feedback * y + drive);
        y = gain->closed * y - drive;

        e->rate += kappa;
        e->elongation += k * e->rate;
        u += e->elongation;
        v += e->rate;
    }
    a->tip_velocity = v;
    a->tip_displacement = u;
    return v;
}

static double axial_tip_displacement(const void *self)
{
    return ((const struct axial *)self)->tip_displacement;
}

/* A state as numbers: elongation and its rate element by element, and the tip's motion. */
static double *numbers_of(struct axial *a)
{
    double *to = a->states.of[0];
    for (size_t i = 0; i < a->n; i++) {
        const struct element *e = &a->element[i];
        *to++ = e->elongation;
        *to++ = e->rate;
    }
    to[0] = a->tip_displacement;
    to[1] = a->tip_velocity;
    return a->states.of[0];
}

static void take_numbers(struct axial *a)
{
    const double *from = a->states.of[0];
    for (size_t i = 0; i < a->n; i++, from += 2) {
        a->element[i].elongation = from[0];
        a->element[i].rate = from[1];
    }
    a->tip_displacement = from[0];
    a->tip_velocity = from[1];
}

static enum br_status axial_set_step(void *self, double k, struct br_error *err)
{
    struct axial *a = self;
    numbers_of(a);
    a->field.k = k;
    const enum br_status status = fill_tables(a, err);
    take_numbers(a);
    return status;
}

static enum br_status axial_keep(void *self, size_t count, struct br_error *err)
{
    struct axial *a = self;
    return br_states_add(&a->states, a->states.size, count, err);
}

static void axial_exchange(void *self, size_t a, size_t b)
{
    struct axial *of = self;
    numbers_of(of);
    br_states_exchange(&of->states, a, b);
    take_numbers(of);
}

static void axial_combine(void *self, size_t into, size_t count, const double *weight)
{
    struct axial *a = self;
    if (weight[0] != 0)
        numbers_of(a);
    br_add_states(a->states.of[into], a->states.size, count, a->states.of, weight);
    if (into == 0)
        take_numbers(a);
}

/* u_x = elongation/h. Squares of small numbers are lost in double. */
static void axial_size(void *self, size_t state, double size[2])
{
    struct axial *a = self;
    const double *from = state == 0 ? numbers_of(a) : a->states.of[state];
    long double sum[2] = {0};
    for (size_t i = 0; i < 2 * a->n; i++)
        sum[i % 2] += (long double)from[i] * from[i];
    for (int rate = 0; rate < 2; rate++)
        size[rate] = (double)sqrtl(sum[rate] / a->field.h);
}

const struct br_field_solver br_plain_axial = {
    .create = axial_create,
    .free = axial_free,
    .tip_compliance = axial_compliance,
    .set = axial_set,
    .get = axial_get,
    .strain_rate = axial_strain_rate,
    .predict = axial_predict,
    .finish = axial_finish,
    .tip_displacement = axial_tip_displacement,
    .set_step = axial_set_step,
    .keep = axial_keep,
    .exchange = axial_exchange,
    .combine = axial_combine,
    .size = axial_size,
};
