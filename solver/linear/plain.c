/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The recursions of plain.h, once for all elements: the state y has d numbers, the control kappa m.
 *
 *     rod             d = 1, m = 1    y = u             kappa = the elongation h u_x
 *     quadratic rod   d = 1, m = 2    y = u             kappa = the elongation, and the bubble
 *     beam            d = 2, m = 2    y = (w, h w_x)    kappa = the coefficients of h^2 w_xx
 *
 * A bubble (field.h) does not reach the nodes, but it has mass and bears load: with f its load,
 *     s_i = R g_i - (0 f)' + G'p_{i+1},    p_i = A'p_{i+1} - K'(R g_i - (0 f)') - F_i.
 */
#include <float.h>
#include <math.h>
#include <string.h>

#include "solver/instruction_set.h"
#include "solver/linear/block.h"
#include "solver/linear/plain.h"
#include "solver/linear/states.h"

#define INLINE static inline __attribute__((always_inline))

struct plain {
    struct br_states states; /* of each element the controls of the displacement, m, and of the
                                velocity, m/s, which do not know the step, 2 m; then at 0 and m the
                                tip's own: see tip_displacement */
    struct br_field field;
    int d, m;
    double alpha, r[2]; /* a / (c + ka); R, diagonal */
    double compliance;  /* z_tip */
    double *gain;       /* n of gain_size: A, K, S^-1, zeta, each by rows */
    double *drive;      /* m n, workspace: S^-1 s, m/s */
};

INLINE int gain_size(int d, int m)
{
    return d * d + m * d + m * m + m;
}

/* G and T: of a rod both are 1 for the elongation, and G is 0 for the bubble. */
static const double g[2][2] = {{0.5, -1.0 / 6}, {1, 0}};

/* Row a of G kappa. */
INLINE double control(int d, int a, const double *kappa)
{
    return d == 1 ? kappa[0] : a == 1 ? kappa[0] : g[0][0] * kappa[0] + g[0][1] * kappa[1];
}

/* T y + G kappa: the node at an element's right end, from that at its left one. */
INLINE void cross(int d, const double *kappa, double *y)
{
    y[0] += d == 2 ? y[1] + control(d, 0, kappa) : control(d, 0, kappa);
    if (d == 2)
        y[1] += control(d, 1, kappa);
}

/* Row c of G'p; of a rod the first. */
INLINE double transposed_control(int d, int c, const double *p)
{
    return d == 2 ? g[0][c] * p[0] + g[1][c] * p[1] : p[0];
}

/* ---- tables ---- */

/* The Riccati recursion, from the tip to the clamp. */
struct recursion {
    real mass, r[2];            /* rho h / k; R */
    struct block p;             /* P */
    real influence[2];          /* pi */
    real compliance;            /* sum of zeta'S zeta so far */
    struct block a, k, inverse; /* out, of an element: A, K, S^-1 */
    real zeta[2];               /* zeta */
};

/* Each of these turns P_{i+1} and pi_{i+1} into P_i and pi_i; false where S is not positive
 * definite.
 *
 * The rod, of mass m [2 1; 1 2]: Q = 2m + P, S = R + Q, H = Q + m; P = 2m + 2mA + QA^2 + RK^2. */
static bool rod_gain(struct recursion *rec)
{
    const real m = rec->mass / 6, r = rec->r[0], q = 2 * m + rec->p.e[0][0], s = r + q;
    if (!(s > 0 && isfinite(s)))
        return false;
    const real feedback = (q + m) / s, closed = (r - m) / s; /* 1 - K */
    rec->zeta[0] = rec->influence[0] / s;
    rec->compliance += rec->zeta[0] * rec->influence[0];
    rec->influence[0] *= closed;
    rec->p.e[0][0] = 2 * m + 2 * m * closed + q * closed * closed + r * feedback * feedback;
    rec->a.e[0][0] = closed;
    rec->k.e[0][0] = feedback;
    rec->inverse.e[0][0] = 1 / s;
    return true;
}

/* (1 -K') N (1 -K')' for m times the mass N of a quadratic element, as a sum of squares, in which
 * nothing is lost: of the Legendre modes of the function that is 1 and A at the nodes and has the
 * bubble -K_1. */
static real mass_square(real m, real closed, real elongation, real bubble)
{
    const real mean = (1 + closed) / 2 - bubble / 6;
    return m * (mean * mean + elongation * elongation / 12 + bubble * bubble / 180);
}

/* S = R + N_kk + G'PG, H = N_ky + G'PT, P_i = (1 -K') N (1 -K')' + K'RK + A'PA. */
static bool quadratic_gain(struct recursion *rec)
{
    const real m = rec->mass, *r = rec->r, p = rec->p.e[0][0];
    const struct block s = {{{r[0] + m / 3 + p, -m / 12}, {-m / 12, r[1] + m / 30}}};
    const struct block h = {{{m / 2 + p}, {-m / 6}}};
    if (!is_positive_definite(s))
        return false;
    rec->inverse = inverse_of(s);
    rec->k = times(rec->inverse, h);
    const real k0 = rec->k.e[0][0], k1 = rec->k.e[1][0];
    /* 1 - K_0, whose P cancels */
    const real closed = (r[0] * r[1] + m * (r[0] / 30 - r[1] / 6) + m * m / 720) / determinant(s);
    rec->p.e[0][0] =
        mass_square(m, closed, k0, -k1) + r[0] * k0 * k0 + r[1] * k1 * k1 + closed * closed * p;
    for (int c = 0; c < 2; c++)
        rec->zeta[c] = rec->inverse.e[c][0] * rec->influence[0];
    rec->compliance += rec->zeta[0] * rec->influence[0];
    rec->influence[0] *= closed;
    rec->a.e[0][0] = closed;
    return true;
}

/* The 2 by 2 block of rho h / k times the beam's element mass that starts at (row, column). */
static struct block mass_block(real mass, int row, int column)
{
    struct block m;
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2; j++)
            m.e[i][j] = mass * br_bending_mass[row + i][column + j];
    return m;
}

/* zeta = S^-1 G'pi;  z += zeta'S zeta = zeta'G'pi;  pi = A'pi. */
static void beam_influence(struct recursion *rec)
{
    const real pi[2] = {rec->influence[0], rec->influence[1]};
    const real q[2] = {0.5L * pi[0] + pi[1], -pi[0] / 6};
    for (int c = 0; c < 2; c++) {
        rec->zeta[c] = rec->inverse.e[c][0] * q[0] + rec->inverse.e[c][1] * q[1];
        rec->influence[c] = rec->a.e[0][c] * pi[0] + rec->a.e[1][c] * pi[1];
    }
    rec->compliance += rec->zeta[0] * q[0] + rec->zeta[1] * q[1];
}

static bool beam_gain(struct recursion *rec)
{
    static const struct block t = {{{1, 1}, {0, 1}}}, control = {{{0.5L, -1.0L / 6}, {1, 0}}},
                              minus_control = {{{-0.5L, 1.0L / 6}, {-1, 0}}};
    const struct block maa = mass_block(rec->mass, 0, 0), mab = mass_block(rec->mass, 0, 2);
    const struct block q = plus(mass_block(rec->mass, 2, 2), rec->p), gt = transpose(control);
    struct block s = times(gt, times(q, control)); /* S = R + G'QG */
    for (int c = 0; c < 2; c++)
        s.e[c][c] += rec->r[c];
    if (!is_positive_definite(s))
        return false;
    rec->inverse = inverse_of(s);
    const struct block h = times(gt, plus(times(q, t), transpose(mab))); /* H = G'(QT + Mab') */
    const struct block k = times(rec->inverse, h);                       /* K = S^-1 H */
    const struct block a = plus(t, times(minus_control, k));             /* A = T - GK */
    struct block rk = k;
    for (int j = 0; j < 2; j++)
        for (int c = 0; c < 2; c++)
            rk.e[c][j] *= rec->r[c];
    /* P = Maa + Mab A + (Mab A)' + A'QA + K'RK */
    const struct block ma = times(mab, a), aqa = times(transpose(a), times(q, a));
    rec->p = plus(plus(plus(plus(maa, ma), transpose(ma)), aqa), times(transpose(k), rk));
    rec->a = a;
    rec->k = k;
    beam_influence(rec);
    return true;
}

static void put(int rows, int columns, const struct block *from, double **to)
{
    for (int i = 0; i < rows; i++)
        for (int j = 0; j < columns; j++)
            *(*to)++ = (double)from->e[i][j];
}

/* All that follows from the field and its step. */
static enum br_status fill_tables(struct plain *s, struct br_error *err)
{
    const struct br_field *f = &s->field;
    const bool axial = s->d == 1, quadratic = s->m > s->d;
    const real h = f->h, stiff = (real)f->viscosity + (real)f->k * f->stiffness;
    const real volume = axial ? h : h * h * h;
    struct recursion rec = {.mass = (real)f->density * h / f->k,
                            .r = {stiff / volume, axial ? stiff / h / 3 : stiff / (3 * h * h * h)},
                            .influence = {1, 0}};
    for (size_t i = f->n; i-- > 0;) {
        if (!(quadratic ? quadratic_gain : axial ? rod_gain : beam_gain)(&rec))
            return br_fail(err, BR_SINGULAR,
                           "%s: the step is not positive definite at element %zu of %zu",
                           axial ? "axial" : "bending", i, f->n);
        double *gain = s->gain + i * (size_t)gain_size(s->d, s->m);
        put(s->d, s->d, &rec.a, &gain);
        put(s->m, s->d, &rec.k, &gain);
        put(s->m, s->m, &rec.inverse, &gain);
        for (int c = 0; c < s->m; c++)
            *gain++ = (double)rec.zeta[c];
    }
    s->alpha = quadratic ? (double)(f->stiffness / stiff)
                         : f->stiffness / (f->viscosity + f->k * f->stiffness);
    for (int c = 0; c < 2; c++)
        s->r[c] = (double)rec.r[c];
    s->compliance = (double)rec.compliance;
    return BR_OK;
}

/* ---- a step ---- */

/* Backward sweep: drive = S^-1 s on every element. Returns v*. */
INLINE double sweep_left(int d, int m, struct plain *s, const struct br_drive *drive)
{
    static const double none[4] = {0};
    const size_t n = s->field.n, stride = drive->vector ? (size_t)m : 0;
    const double *load = drive->vector ? drive->vector : none;
    const double factor = drive->factor, alpha = s->alpha, r[2] = {s->r[0], s->r[1]};
    const double *restrict gain = s->gain, *restrict state = s->states.of[0];
    double *restrict out = s->drive;
    double p[2], tip[2] = {0};
    for (int a = 0; a < d; a++)
        p[a] = -factor * load[stride * n + (size_t)a] - drive->tip[a];
    for (size_t i = n; i-- > 0;) {
        const double *closed = gain + i * (size_t)gain_size(d, m), *feedback = closed + d * d;
        const double *inverse = feedback + m * d, *zeta = inverse + m * m;
        const double *e = state + 2 * (size_t)m * i;
        double rg[2], x[2], next[2];
        for (int c = 0; c < m; c++)
            rg[c] = r[c] * (alpha * e[c] + e[m + c]); /* R g */
        if (m > d)
            rg[1] -= factor * load[stride * (i + 1) + 1];
        for (int c = 0; c < m; c++) /* s = R g + G'p */
            x[c] = d == 1 && c == 1 ? rg[c] : rg[c] + transposed_control(d, c, p);
        for (int c = 0; c < m; c++) { /* S^-1 s */
            double sum = inverse[c] * x[0];
            if (m == 2)
                sum += inverse[m + c] * x[1];
            out[(size_t)m * i + (size_t)c] = sum;
        }
        if (d < m) /* - zeta's */
            tip[0] -= zeta[0] * x[0] + zeta[1] * x[1];
        else
            for (int c = 0; c < m; c++)
                tip[c] -= zeta[c] * x[c];
        for (int a = 0; a < d; a++) { /* A'p - (K'R g + F) */
            double sum = feedback[a] * rg[0];
            if (m == 2)
                sum += feedback[d + a] * rg[1];
            next[a] = -(sum + factor * load[stride * i + (size_t)a]);
            for (int j = 0; j < d; j++)
                next[a] += closed[j * d + a] * p[j];
        }
        for (int a = 0; a < d; a++)
            p[a] = next[a];
    }
    return state[2 * (size_t)m * n + (size_t)m] + (tip[0] + tip[1]);
}

/* Forward sweep: the increment kappa of every element's rate, with the tip's force in it, and the
 * update of the state. The tip's motion is rebuilt from it: what is only incremented drifts. */
INLINE void sweep_right(int d, int m, struct plain *s, double force)
{
    const size_t n = s->field.n;
    const double k = s->field.k;
    double y[2] = {0}, u[2] = {0}, v[2] = {0}; /* at the node: of the increment, and of the state */
    const double *restrict gain = s->gain, *restrict drive = s->drive;
    double *restrict e = s->states.of[0];
    for (size_t i = 0; i < n; i++, e += 2 * m) {
        const double *closed = gain + i * (size_t)gain_size(d, m), *feedback = closed + d * d;
        const double *zeta = feedback + m * d + m * m;
        double q[2], next[2];
        for (int c = 0; c < m; c++)
            q[c] = -(drive[(size_t)m * i + (size_t)c] + force * zeta[c]);
        for (int a = 0; a < d; a++) { /* A y - G S^-1 s */
            next[a] = control(d, a, q);
            for (int j = 0; j < d; j++)
                next[a] += closed[a * d + j] * y[j];
        }
        for (int c = 0; c < m; c++) { /* kappa = -(K y + S^-1 s) */
            for (int j = 0; j < d; j++)
                q[c] -= feedback[c * d + j] * y[j];
            e[m + c] += q[c];
            e[c] += k * e[m + c];
        }
        for (int a = 0; a < d; a++)
            y[a] = next[a];
        if (d == 1) /* the laws do not ask for the beam's */
            cross(d, e, u);
        cross(d, e + m, v);
    }
    e[0] = u[0];
    e[m] = v[0];
}

/* d and m become constants. */
#define WITH_SIZES(s, sweep, ...)             \
    ((s)->d == 2   ? sweep(2, 2, __VA_ARGS__) \
     : (s)->m == 2 ? sweep(1, 2, __VA_ARGS__) \
                   : sweep(1, 1, __VA_ARGS__))

BR_SWEEP
static enum br_status predict(void *self, const struct br_drive *drive, double *velocity,
                              struct br_error *err)
{
    (void)err;
    struct plain *s = self;
    *velocity = WITH_SIZES(s, sweep_left, s, drive);
    return BR_OK;
}

BR_SWEEP
static double finish(void *self, double force)
{
    struct plain *s = self;
    WITH_SIZES(s, sweep_right, s, force);
    return s->states.of[0][2 * (size_t)s->m * s->field.n + (size_t)s->m];
}

static double tip_displacement(const void *self)
{
    const struct plain *s = self;
    const size_t m = (size_t)s->m, n = s->field.n;
    if (s->d == 1)
        return s->states.of[0][2 * m * n];
    double w[2] = {0};
    for (size_t i = 0; i < n; i++)
        cross(2, s->states.of[0] + 2 * m * i, w);
    return w[0];
}

static double tip_compliance(const void *self)
{
    return ((const struct plain *)self)->compliance;
}

/* ---- states ---- */

static void release(void *self)
{
    struct plain *s = self;
    if (!s)
        return;
    free(s->gain);
    free(s->drive);
    br_states_clear(&s->states);
    free(s);
}

static enum br_status create(const struct br_linear_solver *row, const struct br_field *field,
                             const struct br_linear_options *options, void **self,
                             struct br_error *err)
{
    (void)row;
    (void)options;
    const char *what = field->kind == BR_AXIAL ? "the axial solver" : "the bending solver";
    struct plain *s = br_allocate(1, sizeof *s);
    *self = s;
    if (!s)
        return br_no_memory(err, what);
    s->field = *field;
    s->d = field->kind == BR_AXIAL ? 1 : 2;
    s->m = (int)br_field_unknowns(field);
    s->gain = br_allocate(field->n * (size_t)gain_size(s->d, s->m), sizeof *s->gain);
    s->drive = br_allocate(field->n * (size_t)s->m, sizeof *s->drive);
    if (!s->gain || !s->drive)
        return br_no_memory(err, what);
    const enum br_status status =
        br_states_add(&s->states, 2 * (size_t)s->m * (field->n + 1), 1, err);
    return status ? status : fill_tables(s, err);
}

static enum br_status set_step(void *self, double k, struct br_error *err)
{
    struct plain *s = self;
    s->field.k = k;
    return fill_tables(s, err);
}

/* The controls of an element, from its nodes. */
static void control_of(const struct plain *s, const double *node, double *kappa)
{
    if (s->d == 2) {
        br_curvature(node, kappa);
        return;
    }
    kappa[0] = node[s->m] - node[0];
    if (s->m == 2)
        kappa[1] = node[3];
}

static void set(void *self, const double *displacement, const double *velocity)
{
    struct plain *s = self;
    const double *const nodal[2] = {displacement, velocity};
    const size_t m = (size_t)s->m, n = s->field.n;
    for (size_t j = 0; j < 2; j++) {
        for (size_t i = 0; i < n; i++)
            control_of(s, nodal[j] + m * i, s->states.of[0] + (2 * i + j) * m);
        memcpy(s->states.of[0] + (2 * n + j) * m, nodal[j] + m * n, m * sizeof(double));
    }
}

static void get(const void *self, double *displacement, double *velocity)
{
    const struct plain *s = self;
    double *const nodal[2] = {displacement, velocity};
    const size_t m = (size_t)s->m;
    for (size_t j = 0; j < 2; j++) {
        double y[2] = {0}, *to = nodal[j];
        if (!to)
            continue;
        memcpy(to, y, m * sizeof *to);
        for (size_t i = 0; i < s->field.n; i++) {
            const double *kappa = s->states.of[0] + (2 * i + j) * m;
            to += m;
            cross(s->d, kappa, y);
            if (s->m > s->d)
                y[1] = kappa[1];
            memcpy(to, y, m * sizeof *to);
        }
    }
}

static void strain_rate(const void *self, double *rate)
{
    const struct plain *s = self;
    const size_t m = (size_t)s->m;
    for (size_t i = 0; i < s->field.n; i++)
        memcpy(rate + m * i, s->states.of[0] + (2 * i + 1) * m, m * sizeof *rate);
}

/* The square of u_x over an element is (kappa_0^2 + kappa_1^2 / 3) / h, of w_xx the same over h^3;
 * squares of small numbers are lost in double. */
static void size_of(void *self, size_t which, double size[2])
{
    const struct plain *s = self;
    const size_t m = (size_t)s->m;
    for (size_t j = 0; j < 2; j++) {
        real sum[2] = {0};
        for (size_t i = 0; i < s->field.n; i++) {
            const double *kappa = s->states.of[which] + (2 * i + j) * m;
            const real first = kappa[0], second = m == 2 ? kappa[1] : 0;
            sum[0] += s->d == 2 ? first * first + second * second / 3 : first * first;
            sum[1] += s->d == 2 ? 0 : second * second;
        }
        const real strain = sqrtl((sum[0] + sum[1] / 3) / s->field.h);
        size[j] = (double)(s->d == 2 ? strain / s->field.h : strain);
    }
}

const struct br_field_solver br_plain_form = {
    .create = create,
    .free = release,
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

/* An upper estimate; the benchmark and tests/ measure less. A tip that sticks gathers round-off of
 * its own, whatever the mesh. */
static double round_off(const struct br_linear_solver *row, const struct br_field *field,
                        const struct br_linear_options *options)
{
    (void)row;
    (void)options;
    return 4 * DBL_EPSILON * ((double)field->n + 1024);
}

/* See linear_solver.h; of an AMD EPYC with AVX-512 at about 3 GHz. */
static double cost(const struct br_linear_solver *row, const struct br_field *field, double sums)
{
    static const struct br_by_element sum = {0.65, 1.3, 1.3};
    return 120 + 42 * sums +
           (double)field->n *
               (br_by_element_of(&row->element_cost, field) + sums * br_by_element_of(&sum, field));
}

const struct br_linear_solver br_plain = {
    .name = "plain",
    .title = "the same form as it is written down: one backward and one forward recursion",
    .citation = "discrete linear-quadratic problem; Riccati recursion, see solver/linear/plain.h",
    .options = "",
    .axial = &br_plain_form,
    .axial_quadratic = &br_plain_form,
    .bending = &br_plain_form,
    .round_off = round_off,
    .bytes = {92, 218, 140},
    .state_bytes = {16, 32, 32},
    .cost = cost,
    .element_cost = {2.5, 7.1, 3.9},
};
