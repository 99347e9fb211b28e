/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The recursions of plain.h for a rod of quadratic elements: still one state, y = u at the node, but
 * two controls, the element's elongation and its bubble (field.h):
 *     y_{i+1} = y_i + kappa_0,    T = 1,    G = (1 0),    R = (c + ka)/h diag(1, 1/3).
 * The bubble does not reach the nodes, but it has mass and bears load: with N the element's mass in
 * (y, kappa), and f its load,
 *     S = R + N_kk + G'PG,  H = N_ky + G'PT,  K = S^-1 H,  A = T - GK,
 *     P_i = (1 -K') N (1 -K')' + K'RK + A'PA    (the Joseph form),
 *     s_i = R g_i - (0 f)' + G'p_{i+1},  p_i = A'p_{i+1} - K'(R g_i - (0 f)') - F_i.
 * N's form is a sum of squares over the element's Legendre modes, so that nothing is lost there.
 * The state is the controls of u and of its velocity, which do not know the step. */
#include <math.h>

#include "solver/plain.h"
#include "solver/sweep.h"

struct gain {
    double closed;      /* A = 1 - K_0 */
    double feedback[2]; /* K */
    double inverse[3];  /* S^-1: 00, 01, 11 */
    double tip[2];      /* zeta */
};

struct element {
    double stretch[2]; /* elongation and bubble of u, m */
    double rate[2];    /* of its velocity, m/s */
};

struct state {
    struct element *element;  /* n */
    double tip_displacement; /* m */
    double tip_velocity;     /* m/s */
};

struct rod {
    struct br_field field;
    double alpha, r[2];   /* a / (c + ka); R */
    double compliance;    /* z_tip */
    struct gain *gain;    /* n */
    double (*drive)[2];   /* n, workspace: S^-1 s, m/s */
    struct state *state;  /* states; state 0 is marched */
    size_t states;
};

static void rod_free(void *self)
{
    struct rod *a = self;
    if (!a)
        return;
    for (size_t j = 0; a->state && j < a->states; j++)
        free(a->state[j].element);
    free(a->state);
    free(a->drive);
    free(a->gain);
    free(a);
}

/* ---- tables ---- */

typedef long double real;

/* (1 -K') N (1 -K')' for m times the mass of an element: the squares of the modes of the function
 * that is 1 and A at the nodes and has the bubble -K_1. */
static real mass_square(real m, real closed, const real feedback[2])
{
    const real bubble = -feedback[1];
    const real mean = (1 + closed) / 2 - bubble / 6;
    return m * (mean * mean + feedback[0] * feedback[0] / 12 + bubble * bubble / 180);
}

/* One element of the recursion: P_{i+1} becomes P_i. False where S is not positive definite. */
static bool fill_gain(const real r[2], real m, real *p, struct gain *gain, real inverse[3],
                      real *closed)
{
    const real s00 = r[0] + m / 3 + *p, s01 = -m / 12, s11 = r[1] + m / 30;
    const real det = s00 * s11 - s01 * s01;
    if (!(s00 > 0 && det > 0 && isfinite(det)))
        return false;
    inverse[0] = s11 / det;
    inverse[1] = -s01 / det;
    inverse[2] = s00 / det;
    const real h[2] = {m / 2 + *p, -m / 6};
    const real feedback[2] = {inverse[0] * h[0] + inverse[1] * h[1],
                              inverse[1] * h[0] + inverse[2] * h[1]};
    /* 1 - K_0, whose P cancels */
    *closed = (r[0] * r[1] + m * (r[0] / 30 - r[1] / 6) + m * m / 720) / det;
    *p = mass_square(m, *closed, feedback) + r[0] * feedback[0] * feedback[0] +
         r[1] * feedback[1] * feedback[1] + *closed * *closed * *p;
    *gain = (struct gain){
        .closed = (double)*closed,
        .feedback = {(double)feedback[0], (double)feedback[1]},
        .inverse = {(double)inverse[0], (double)inverse[1], (double)inverse[2]},
    };
    return true;
}

static enum br_status fill_gains(struct rod *a, struct br_error *err)
{
    const struct br_field *f = &a->field;
    const real m = (real)f->density * f->h / f->k;
    const real stiff = (real)f->viscosity + (real)f->k * f->stiffness;
    const real r[2] = {stiff / f->h, stiff / f->h / 3};
    real p = 0, influence = 1, compliance = 0;
    for (size_t i = f->n; i-- > 0;) {
        real inverse[3], closed;
        if (!fill_gain(r, m, &p, &a->gain[i], inverse, &closed))
            return br_fail(err, BR_SINGULAR,
                           "axial: the step is not positive definite at element %zu of %zu", i,
                           f->n);
        for (int c = 0; c < 2; c++)
            a->gain[i].tip[c] = (double)(inverse[c] * influence); /* zeta = S^-1 G'pi */
        compliance += inverse[0] * influence * influence;
        influence *= closed;
    }
    a->alpha = (double)(f->stiffness / stiff);
    a->r[0] = (double)r[0];
    a->r[1] = (double)r[1];
    a->compliance = (double)compliance;
    return BR_OK;
}

/* ---- states ---- */

/* Room for states first to first + count - 1, at rest. */
static enum br_status add_states(struct rod *a, size_t count, struct br_error *err)
{
    struct state *all = br_allocate(a->states + count, sizeof *all);
    if (!all)
        return br_no_memory(err, "the axial solver");
    for (size_t j = 0; j < a->states; j++)
        all[j] = a->state[j];
    free(a->state);
    a->state = all;
    for (size_t j = 0; j < count; j++) {
        struct element *element = br_allocate(a->field.n, sizeof *element);
        if (!element)
            return br_no_memory(err, "the axial solver");
        all[a->states++] = (struct state){.element = element};
    }
    return BR_OK;
}

static enum br_status rod_create(const struct br_field *field,
                                 const struct br_linear_options *options, void **self,
                                 struct br_error *err)
{
    (void)options;
    struct rod *a = br_allocate(1, sizeof *a);
    *self = a;
    if (!a)
        return br_no_memory(err, "the axial solver");
    a->field = *field;
    a->gain = br_allocate(field->n, sizeof *a->gain);
    a->drive = br_allocate(field->n, sizeof *a->drive);
    if (!a->gain || !a->drive)
        return br_no_memory(err, "the axial solver");
    const enum br_status status = add_states(a, 1, err);
    return status ? status : fill_gains(a, err);
}

static enum br_status rod_set_step(void *self, double k, struct br_error *err)
{
    struct rod *a = self;
    a->field.k = k;
    return fill_gains(a, err);
}

static enum br_status rod_keep(void *self, size_t count, struct br_error *err)
{
    return add_states(self, count, err);
}

/* to = weight to, or += weight from; a weight of 0 forgets what was there. */
static void scale(size_t n, double weight, struct state *to)
{
    for (size_t i = 0; i < n; i++)
        for (int c = 0; c < 2; c++) {
            struct element *e = &to->element[i];
            e->stretch[c] = weight == 0 ? 0 : weight * e->stretch[c];
            e->rate[c] = weight == 0 ? 0 : weight * e->rate[c];
        }
    to->tip_displacement = weight == 0 ? 0 : weight * to->tip_displacement;
    to->tip_velocity = weight == 0 ? 0 : weight * to->tip_velocity;
}

static void add(size_t n, double weight, const struct state *from, struct state *to)
{
    for (size_t i = 0; i < n; i++)
        for (int c = 0; c < 2; c++) {
            to->element[i].stretch[c] += weight * from->element[i].stretch[c];
            to->element[i].rate[c] += weight * from->element[i].rate[c];
        }
    to->tip_displacement += weight * from->tip_displacement;
    to->tip_velocity += weight * from->tip_velocity;
}

static void rod_combine(void *self, size_t into, size_t count, const double *weight)
{
    struct rod *a = self;
    scale(a->field.n, into < count ? weight[into] : 0, &a->state[into]);
    for (size_t j = 0; j < count; j++)
        if (j != into && weight[j] != 0)
            add(a->field.n, weight[j], &a->state[j], &a->state[into]);
}

/* h u_x = stretch_0 + stretch_1 (2 xi - 1) */
static double strain_square(const double stretch[2])
{
    return stretch[0] * stretch[0] + stretch[1] * stretch[1] / 3;
}

static void rod_size(const void *self, size_t state, double size[2])
{
    const struct rod *a = self;
    double displacement = 0, velocity = 0;
    for (size_t i = 0; i < a->field.n; i++) {
        displacement += strain_square(a->state[state].element[i].stretch);
        velocity += strain_square(a->state[state].element[i].rate);
    }
    size[0] = sqrt(displacement / a->field.h);
    size[1] = sqrt(velocity / a->field.h);
}

static void rod_set(void *self, const double *displacement, const double *velocity)
{
    struct rod *a = self;
    struct state *s = &a->state[0];
    for (size_t i = 0; i < a->field.n; i++) {
        const double *u = displacement + 2 * i, *v = velocity + 2 * i;
        s->element[i] = (struct element){{u[2] - u[0], u[3]}, {v[2] - v[0], v[3]}};
    }
    s->tip_displacement = displacement[2 * a->field.n];
    s->tip_velocity = velocity[2 * a->field.n];
}

static void rod_get(const void *self, double *displacement, double *velocity)
{
    const struct rod *a = self;
    double u[2] = {0, 0}, v[2] = {0, 0};
    for (size_t i = 0; i <= a->field.n; i++) {
        for (size_t c = 0; c < 2; c++) {
            if (displacement)
                displacement[2 * i + c] = u[c];
            if (velocity)
                velocity[2 * i + c] = v[c];
        }
        if (i == a->field.n)
            break;
        const struct element *e = &a->state[0].element[i];
        u[0] += e->stretch[0];
        u[1] = e->stretch[1];
        v[0] += e->rate[0];
        v[1] = e->rate[1];
    }
}

static void rod_strain_rate(const void *self, double *rate)
{
    const struct rod *a = self;
    for (size_t i = 0; i < a->field.n; i++)
        for (size_t c = 0; c < 2; c++)
            rate[2 * i + c] = a->state[0].element[i].rate[c];
}

/* ---- a step ---- */

BR_SWEEP
static enum br_status rod_predict(void *self, const struct br_drive *drive, double *velocity,
                                  struct br_error *err)
{
    (void)err;
    struct rod *a = self;
    static const double none[4] = {0};
    const double *load = drive->vector ? drive->vector : none;
    const size_t stride = drive->vector ? 2 : 0, n = a->field.n;
    const double factor = drive->factor, alpha = a->alpha, r0 = a->r[0], r1 = a->r[1];
    double p = -factor * load[stride * n] - drive->tip[0];
    double tip = 0;
    for (size_t i = n; i-- > 0;) {
        const struct gain *gain = &a->gain[i];
        const struct element *e = &a->state[0].element[i];
        const double along = r0 * (alpha * e->stretch[0] + e->rate[0]);
        const double bubble =
            r1 * (alpha * e->stretch[1] + e->rate[1]) - factor * load[stride * (i + 1) + 1];
        const double s = along + p;
        a->drive[i][0] = gain->inverse[0] * s + gain->inverse[1] * bubble;
        a->drive[i][1] = gain->inverse[1] * s + gain->inverse[2] * bubble;
        tip -= gain->tip[0] * s + gain->tip[1] * bubble;
        p = gain->closed * p - (gain->feedback[0] * along + gain->feedback[1] * bubble +
                                factor * load[stride * i]);
    }
    *velocity = a->state[0].tip_velocity + tip;
    return BR_OK;
}

/* The tip's displacement and velocity are sums over the field. */
BR_SWEEP
static double rod_finish(void *self, double force)
{
    struct rod *a = self;
    const double k = a->field.k;
    double y = 0, u = 0, v = 0;
    for (size_t i = 0; i < a->field.n; i++) {
        const struct gain *gain = &a->gain[i];
        struct element *e = &a->state[0].element[i];
        const double drive0 = a->drive[i][0] + force * gain->tip[0];
        const double drive1 = a->drive[i][1] + force * gain->tip[1];
        e->rate[0] -= gain->feedback[0] * y + drive0;
        e->rate[1] -= gain->feedback[1] * y + drive1;
        y = gain->closed * y - drive0;
        e->stretch[0] += k * e->rate[0];
        e->stretch[1] += k * e->rate[1];
        u += e->stretch[0];
        v += e->rate[0];
    }
    a->state[0].tip_displacement = u;
    a->state[0].tip_velocity = v;
    return v;
}

static double rod_compliance(const void *self)
{
    return ((const struct rod *)self)->compliance;
}

static double rod_tip_displacement(const void *self)
{
    return ((const struct rod *)self)->state[0].tip_displacement;
}

const struct br_field_solver br_plain_axial_quadratic = {
    .create = rod_create,
    .free = rod_free,
    .tip_compliance = rod_compliance,
    .set = rod_set,
    .get = rod_get,
    .strain_rate = rod_strain_rate,
    .predict = rod_predict,
    .finish = rod_finish,
    .tip_displacement = rod_tip_displacement,
    .set_step = rod_set_step,
    .keep = rod_keep,
    .combine = rod_combine,
    .size = rod_size,
};
