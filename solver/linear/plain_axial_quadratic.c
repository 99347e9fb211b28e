/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The recursions of plain.h for a rod of quadratic elements: still one state, y = u at the node,
 * but two controls, the element's elongation and its bubble (field.h): y_{i+1} = y_i + kappa_0, T =
 * 1,    G = (1 0),    R = (c + ka)/h diag(1, 1/3). The bubble does not reach the nodes, but it has
 * mass and bears load: with N the element's mass in (y, kappa), and f its load, S = R + N_kk +
 * G'PG,  H = N_ky + G'PT,  K = S^-1 H,  A = T - GK, P_i = (1 -K') N (1 -K')' + K'RK + A'PA    (the
 * Joseph form), s_i = R g_i - (0 f)' + G'p_{i+1},  p_i = A'p_{i+1} - K'(R g_i - (0 f)') - F_i. N's
 * form is a sum of squares over the element's Legendre modes, so that nothing is lost there. The
 * state is the controls of u and of its velocity, which do not know the step. */
#include <math.h>

#include "solver/instruction_set.h"
#include "solver/linear/plain.h"
#include "solver/linear/states.h"

struct gain {
    double closed;      /* A = 1 - K_0 */
    double feedback[2]; /* K */
    double inverse[3];  /* S^-1: 00, 01, 11 */
    double tip[2];      /* zeta */
};

/* Of an element: elongation and bubble of u, m, and of its velocity, m/s. */
enum { STRETCH = 0, RATE = 2, ELEMENT = 4 };

struct rod {
    struct br_field field;
    double alpha, r[2];      /* a / (c + ka); R */
    double compliance;       /* z_tip */
    struct gain *gain;       /* n */
    double (*drive)[2];      /* n, workspace: S^-1 s, m/s */
    struct br_states states; /* ELEMENT numbers an element; the tip's displacement and velocity */
};

static void rod_free(void *self)
{
    struct rod *a = self;
    if (!a)
        return;
    free(a->gain);
    free(a->drive);
    br_states_clear(&a->states);
    free(a);
}

/* The tip's displacement and velocity in the state that marches. */
static double *tip_of(const struct rod *a)
{
    return a->states.of[0] + ELEMENT * a->field.n;
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

static enum br_status fill_tables(struct rod *a, struct br_error *err)
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

static enum br_status rod_create(const struct br_linear_solver *row, const struct br_field *field,
                                 const struct br_linear_options *options, void **self,
                                 struct br_error *err)
{
    (void)row;
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
    const enum br_status status = br_states_add(&a->states, ELEMENT * field->n + 2, 1, err);
    return status ? status : fill_tables(a, err);
}

static enum br_status rod_set_step(void *self, double k, struct br_error *err)
{
    struct rod *a = self;
    a->field.k = k;
    return fill_tables(a, err);
}

static enum br_status rod_keep(void *self, size_t count, struct br_error *err)
{
    struct rod *a = self;
    return br_states_add(&a->states, a->states.size, count, err);
}

static void rod_exchange(void *self, size_t a, size_t b)
{
    struct rod *of = self;
    br_states_exchange(&of->states, a, b);
}

static void rod_combine(void *self, size_t into, size_t count, const double *weight)
{
    struct rod *a = self;
    br_add_states(a->states.of[into], a->states.size, count, a->states.of, weight);
}

/* h u_x = stretch_0 + stretch_1 (2 xi - 1) */
static void rod_size(void *self, size_t state, double size[2])
{
    struct rod *a = self;
    const double *from = a->states.of[state];
    long double sum[ELEMENT] = {0}; /* squares of small numbers are lost in double */
    for (size_t i = 0; i < ELEMENT * a->field.n; i++)
        sum[i % ELEMENT] += (long double)from[i] * from[i];
    size[0] = (double)sqrtl((sum[STRETCH] + sum[STRETCH + 1] / 3) / a->field.h);
    size[1] = (double)sqrtl((sum[RATE] + sum[RATE + 1] / 3) / a->field.h);
}

static void rod_set(void *self, const double *displacement, const double *velocity)
{
    struct rod *a = self;
    const double *const nodal[2] = {displacement, velocity};
    double *to = a->states.of[0];
    for (size_t i = 0; i < a->field.n; i++)
        for (int j = 0; j < 2; j++) {
            *to++ = nodal[j][2 * i + 2] - nodal[j][2 * i];
            *to++ = nodal[j][2 * i + 3];
        }
    for (int j = 0; j < 2; j++)
        *to++ = nodal[j][2 * a->field.n];
}

static void rod_get(const void *self, double *displacement, double *velocity)
{
    const struct rod *a = self;
    double *const nodal[2] = {displacement, velocity};
    for (size_t j = 0; j < 2; j++) {
        const double *from = a->states.of[0] + 2 * j;
        if (!nodal[j])
            continue;
        nodal[j][0] = nodal[j][1] = 0;
        for (size_t i = 0; i < a->field.n; i++, from += ELEMENT) {
            nodal[j][2 * i + 2] = nodal[j][2 * i] + from[0];
            nodal[j][2 * i + 3] = from[1];
        }
    }
}

static void rod_strain_rate(const void *self, double *rate)
{
    const struct rod *a = self;
    const double *from = a->states.of[0];
    for (size_t i = 0; i < a->field.n; i++, from += ELEMENT) {
        rate[2 * i] = from[RATE];
        rate[2 * i + 1] = from[RATE + 1];
    }
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
    const double *state = a->states.of[0];
    double p = -factor * load[stride * n] - drive->tip[0];
    double tip = 0;
    for (size_t i = n; i-- > 0;) {
        const struct gain *gain = &a->gain[i];
        const double *e = state + ELEMENT * i;
        const double along = r0 * (alpha * e[STRETCH] + e[RATE]);
        const double bubble =
            r1 * (alpha * e[STRETCH + 1] + e[RATE + 1]) - factor * load[stride * (i + 1) + 1];
        const double s = along + p;
        a->drive[i][0] = gain->inverse[0] * s + gain->inverse[1] * bubble;
        a->drive[i][1] = gain->inverse[1] * s + gain->inverse[2] * bubble;
        tip -= gain->tip[0] * s + gain->tip[1] * bubble;
        p = gain->closed * p -
            (gain->feedback[0] * along + gain->feedback[1] * bubble + factor * load[stride * i]);
    }
    *velocity = tip_of(a)[1] + tip;
    return BR_OK;
}

/* The tip's displacement and velocity are sums over the field. */
BR_SWEEP
static double rod_finish(void *self, double force)
{
    struct rod *a = self;
    const double k = a->field.k;
    double y = 0, u = 0, v = 0;
    double *e = a->states.of[0];
    for (size_t i = 0; i < a->field.n; i++, e += ELEMENT) {
        const struct gain *gain = &a->gain[i];
        const double drive0 = a->drive[i][0] + force * gain->tip[0];
        const double drive1 = a->drive[i][1] + force * gain->tip[1];
        e[RATE] -= gain->feedback[0] * y + drive0;
        e[RATE + 1] -= gain->feedback[1] * y + drive1;
        y = gain->closed * y - drive0;
        e[STRETCH] += k * e[RATE];
        e[STRETCH + 1] += k * e[RATE + 1];
        u += e[STRETCH];
        v += e[RATE];
    }
    e[0] = u;
    e[1] = v;
    return v;
}

static double rod_compliance(const void *self)
{
    return ((const struct rod *)self)->compliance;
}

static double rod_tip_displacement(const void *self)
{
    return tip_of(self)[0];
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
    .exchange = rod_exchange,
    .combine = rod_combine,
    .size = rod_size,
};
