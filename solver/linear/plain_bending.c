/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The recursions of plain.h for bending: 2 by 2 blocks,
 *     T = [1 1; 0 1],   G = [1/2 -1/6; 1 0],   y = (w, h w_x). */
#include <math.h>
#include <string.h>

#include "solver/instruction_set.h"
#include "solver/linear/pair.h"
#include "solver/linear/plain.h"
#include "solver/linear/states.h"

typedef long double real; /* of the tables, which are computed once */

/* What a sweep needs of an element; depends on the distance to the tip only. */
struct gain {
    struct br_matrix closed;   /* A */
    struct br_matrix feedback; /* K */
    struct br_matrix inverse;  /* S^-1, symmetric */
    br_pair tip;               /* zeta */
};

struct element {
    br_pair curvature; /* kappa_w, displacement, m */
    br_pair rate;      /* kappa_v, velocity, m/s */
    br_pair drive;     /* workspace: S^-1 s, m/s */
};

struct bending {
    struct br_field field;
    size_t n;
    double k, alpha;
    br_pair r;               /* R, diagonal */
    double tip_velocity;     /* m/s */
    double compliance;       /* z_tip */
    struct gain *gain;       /* n */
    struct element *element; /* n */
    struct br_states states; /* see numbers_of; the first is that of the elements */
};

struct block {
    real e[2][2];
};

static const struct block transition = {{{1, 1}, {0, 1}}};         /* T */
static const struct block control = {{{0.5L, -1.0L / 6}, {1, 0}}}; /* G */

/* The product of two blocks, with the left one transposed if asked for. */
static struct block multiply(const struct block *a, bool transposed, const struct block *b)
{
    struct block c;
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2; j++)
            c.e[i][j] = transposed ? a->e[0][i] * b->e[0][j] + a->e[1][i] * b->e[1][j]
                                   : a->e[i][0] * b->e[0][j] + a->e[i][1] * b->e[1][j];
    return c;
}

static struct block add(const struct block *a, const struct block *b, real factor)
{
    struct block c;
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2; j++)
            c.e[i][j] = a->e[i][j] + factor * b->e[i][j];
    return c;
}

static struct block transpose(const struct block *a)
{
    return (struct block){{{a->e[0][0], a->e[1][0]}, {a->e[0][1], a->e[1][1]}}};
}

/* The 2 by 2 block of rho h / k times the element mass that starts at (row, column). */
static struct block mass_block(const struct br_field *field, int row, int column)
{
    const real factor = (real)field->density * field->h / field->k;
    struct block m;
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2; j++)
            m.e[i][j] = factor * br_bending_mass[row + i][column + j];
    return m;
}

/* One backward step of the Riccati recursion: the gains of an element from P_{i+1},
 * which becomes P_i, and from pi_{i+1}, which becomes pi_i. */
struct recursion {
    struct block maa, mab, mbb; /* element mass over k */
    real r[2];                  /* R */
    struct block p;             /* P */
    real influence[2];          /* pi */
    real compliance;            /* sum of zeta'S zeta so far */
};

static void recursion_start(struct recursion *rec, const struct br_field *field)
{
    const real stiff = (real)field->viscosity + (real)field->k * field->stiffness;
    const real h = field->h;
    *rec = (struct recursion){
        .maa = mass_block(field, 0, 0),
        .mab = mass_block(field, 0, 2),
        .mbb = mass_block(field, 2, 2),
        .r = {stiff / (h * h * h), stiff / (3 * h * h * h)},
        .influence = {1, 0},
    };
}

/* S^-1 for S = R + G'QG; false when S is not positive definite. */
static bool invert(const struct block *s, struct block *inverse)
{
    const real det = s->e[0][0] * s->e[1][1] - s->e[0][1] * s->e[1][0];
    if (!(s->e[0][0] > 0 && det > 0 && isfinite(det)))
        return false;
    *inverse = (struct block){
        {{s->e[1][1] / det, -s->e[0][1] / det}, {-s->e[1][0] / det, s->e[0][0] / det}}};
    return true;
}

static struct br_matrix rounded(const struct block *a)
{
    return (struct br_matrix){
        {{(double)a->e[0][0], (double)a->e[0][1]}, {(double)a->e[1][0], (double)a->e[1][1]}}};
}

/* zeta = S^-1 G'pi;  z += zeta'S zeta = zeta'G'pi;  pi = A'pi. */
static void recursion_influence(struct recursion *rec, const struct block *inverse,
                                const struct block *closed, real zeta[2])
{
    const real *pi = rec->influence;
    const real q[2] = {0.5L * pi[0] + pi[1], -pi[0] / 6};
    for (int i = 0; i < 2; i++)
        zeta[i] = inverse->e[i][0] * q[0] + inverse->e[i][1] * q[1];
    rec->compliance += zeta[0] * q[0] + zeta[1] * q[1];
    const real next[2] = {closed->e[0][0] * pi[0] + closed->e[1][0] * pi[1],
                          closed->e[0][1] * pi[0] + closed->e[1][1] * pi[1]};
    rec->influence[0] = next[0];
    rec->influence[1] = next[1];
}

static bool recursion_step(struct recursion *rec, struct gain *out)
{
    const struct block q = add(&rec->mbb, &rec->p, 1);
    const struct block qg = multiply(&q, false, &control);
    struct block s = multiply(&control, true, &qg); /* S = R + G'QG */
    s.e[0][0] += rec->r[0];
    s.e[1][1] += rec->r[1];
    struct block inverse;
    if (!invert(&s, &inverse))
        return false;

    const struct block qt = multiply(&q, false, &transition);
    const struct block mba = transpose(&rec->mab);
    const struct block inner = add(&qt, &mba, 1);
    const struct block h = multiply(&control, true, &inner);     /* H = G'(QT + Mab') */
    const struct block feedback = multiply(&inverse, false, &h); /* K = S^-1 H */
    const struct block gk = multiply(&control, false, &feedback);
    const struct block closed = add(&transition, &gk, -1); /* A = T - GK */

    /* P = Maa + Mab A + (Mab A)' + A'QA + K'RK */
    const struct block mab_a = multiply(&rec->mab, false, &closed);
    const struct block mab_a_t = transpose(&mab_a);
    const struct block qa = multiply(&q, false, &closed);
    const struct block aqa = multiply(&closed, true, &qa);
    struct block rk = feedback;
    for (int j = 0; j < 2; j++) {
        rk.e[0][j] *= rec->r[0];
        rk.e[1][j] *= rec->r[1];
    }
    const struct block krk = multiply(&feedback, true, &rk);
    struct block p = add(&rec->maa, &mab_a, 1);
    p = add(&p, &mab_a_t, 1);
    p = add(&p, &aqa, 1);
    rec->p = add(&p, &krk, 1);

    real zeta[2];
    recursion_influence(rec, &inverse, &closed, zeta);
    *out = (struct gain){
        .closed = rounded(&closed),
        .feedback = rounded(&feedback),
        .inverse = rounded(&inverse),
        .tip = {(double)zeta[0], (double)zeta[1]},
    };
    return true;
}

static void bending_free(void *self)
{
    struct bending *b = self;
    if (!b)
        return;
    free(b->gain);
    free(b->element);
    br_states_clear(&b->states);
    free(b);
}

/* All that follows from the field and its step. */
static enum br_status fill_tables(struct bending *b, struct br_error *err)
{
    const struct br_field *field = &b->field;
    struct recursion rec;
    recursion_start(&rec, field);
    for (size_t i = field->n; i-- > 0;)
        if (!recursion_step(&rec, &b->gain[i]))
            return br_fail(err, BR_SINGULAR,
                           "bending: the step is not positive definite at element %zu of %zu", i,
                           field->n);
    b->k = field->k;
    b->alpha = field->stiffness / (field->viscosity + field->k * field->stiffness);
    b->r = (br_pair){(double)rec.r[0], (double)rec.r[1]};
    b->compliance = (double)rec.compliance;
    return BR_OK;
}

static enum br_status bending_create(const struct br_linear_solver *row,
                                     const struct br_field *field,
                                     const struct br_linear_options *options, void **self,
                                     struct br_error *err)
{
    (void)row;
    (void)options;
    struct bending *b = br_allocate(1, sizeof *b);
    *self = b;
    if (!b)
        return br_no_memory(err, "the bending solver");
    b->field = *field;
    b->n = field->n;
    b->gain = br_allocate(field->n, sizeof *b->gain);
    b->element = br_allocate(field->n, sizeof *b->element);
    if (!b->gain || !b->element)
        return br_no_memory(err, "the bending solver");
    const enum br_status status = br_states_add(&b->states, 4 * field->n + 1, 1, err);
    return status ? status : fill_tables(b, err);
}

static double bending_compliance(const void *self)
{
    return ((const struct bending *)self)->compliance;
}

static void bending_set(void *self, const double *displacement, const double *velocity)
{
    struct bending *b = self;
    for (size_t i = 0; i < b->n; i++) {
        struct element *e = &b->element[i];
        double curvature[2], rate[2];
        br_curvature(displacement + 2 * i, curvature);
        br_curvature(velocity + 2 * i, rate);
        e->curvature = (br_pair){curvature[0], curvature[1]};
        e->rate = (br_pair){rate[0], rate[1]};
    }
    b->tip_velocity = velocity[2 * b->n];
}

/* G kappa */
static inline br_pair control_times(br_pair kappa)
{
    return (br_pair){0.5, 1} * br_splat(kappa[0]) - (br_pair){1.0 / 6, 0} * br_splat(kappa[1]);
}

/* G' p */
static inline br_pair control_transposed_times(br_pair p)
{
    return (br_pair){0.5, -1.0 / 6} * br_splat(p[0]) + (br_pair){1, 0} * br_splat(p[1]);
}

/* T y + G kappa */
static inline br_pair carry(br_pair y, br_pair kappa)
{
    return y + ((br_pair){y[1], 0} + control_times(kappa));
}

static void bending_get(const void *self, double *displacement, double *velocity)
{
    const struct bending *b = self;
    br_pair w = {0, 0}, v = {0, 0};
    for (size_t i = 0; i <= b->n; i++) {
        if (displacement)
            memcpy(displacement + 2 * i, &w, sizeof w);
        if (velocity)
            memcpy(velocity + 2 * i, &v, sizeof v);
        if (i == b->n)
            break;
        const struct element *e = &b->element[i];
        w = carry(w, e->curvature);
        v = carry(v, e->rate);
    }
}

static void bending_strain_rate(const void *self, double *rate)
{
    const struct bending *b = self;
    for (size_t i = 0; i < b->n; i++) {
        memcpy(rate + 2 * i, &b->element[i].rate, 2 * sizeof *rate);
    }
}

/* factor * F_i, or zero */
static inline br_pair scaled_load(const double *load, size_t i, double factor)
{
    return load ? factor * (br_pair){load[2 * i], load[2 * i + 1]} : br_splat(0);
}

/* Backward sweep: drive = S^-1 s on every element; *velocity = v*. */
BR_SWEEP
static enum br_status bending_predict(void *self, const struct br_drive *drive, double *velocity,
                                      struct br_error *err)
{
    (void)err;
    struct bending *b = self;
    const br_pair r = b->r;
    const double alpha = b->alpha;
    const double *load = drive->vector, factor = drive->factor;
    br_pair p = -scaled_load(load, b->n, factor) - (br_pair){drive->tip[0], drive->tip[1]};
    br_pair tip = {0, 0};
    for (size_t i = b->n; i-- > 0;) {
        const struct gain *gain = &b->gain[i];
        struct element *e = &b->element[i];
        const br_pair rg = r * (alpha * e->curvature + e->rate);
        const br_pair s = rg + control_transposed_times(p); /* s = R g + G'p */
        e->drive = br_transposed_times(&gain->inverse, s);  /* S^-1 s */
        tip -= gain->tip * s;                               /* - zeta's */
        const br_pair q = -scaled_load(load, i, factor) - br_transposed_times(&gain->feedback, rg);
        p = br_add_transposed_times(q, &gain->closed, p); /* A'p - K'R g - F */
    }
    *velocity = b->tip_velocity + (tip[0] + tip[1]);
    return BR_OK;
}

/* Forward sweep: the increment kappa of every element's curvature rate, with the
 * tip force in it, and the update of the state. The tip's velocity is rebuilt
 * from the rates: one that is only incremented drifts. */
BR_SWEEP
static double bending_finish(void *self, double force)
{
    struct bending *b = self;
    const double k = b->k;
    br_pair y = {0, 0}; /* the increment's nodal state */
    br_pair v = {0, 0}; /* the velocity's */
    for (size_t i = 0; i < b->n; i++) {
        const struct gain *gain = &b->gain[i];
        struct element *e = &b->element[i];
        const br_pair drive = e->drive + force * gain->tip;
        const br_pair kappa = -br_add_times(drive, &gain->feedback, y); /* -(K y + S^-1 s) */
        y = br_add_times(-control_times(drive), &gain->closed, y);      /* A y - G S^-1 s */

        e->rate += kappa;
        e->curvature += k * e->rate;
        v = carry(v, e->rate);
    }
    b->tip_velocity = v[0];
    return v[0];
}

static double bending_tip_displacement(const void *self)
{
    const struct bending *b = self;
    br_pair w = {0, 0};
    for (size_t i = 0; i < b->n; i++)
        w = carry(w, b->element[i].curvature);
    return w[0];
}

/* A state as numbers: the curvatures and their rates element by element, and the tip's velocity. */
static double *numbers_of(struct bending *b)
{
    double *to = b->states.of[0];
    for (size_t i = 0; i < b->n; i++, to += 4) {
        const struct element *e = &b->element[i];
        memcpy(to, &e->curvature, sizeof e->curvature);
        memcpy(to + 2, &e->rate, sizeof e->rate);
    }
    *to = b->tip_velocity;
    return b->states.of[0];
}

static void take_numbers(struct bending *b)
{
    const double *from = b->states.of[0];
    for (size_t i = 0; i < b->n; i++, from += 4) {
        struct element *e = &b->element[i];
        e->curvature = (br_pair){from[0], from[1]};
        e->rate = (br_pair){from[2], from[3]};
    }
    b->tip_velocity = *from;
}

static enum br_status bending_set_step(void *self, double k, struct br_error *err)
{
    struct bending *b = self;
    numbers_of(b);
    b->field.k = k;
    const enum br_status status = fill_tables(b, err);
    take_numbers(b);
    return status;
}

static enum br_status bending_keep(void *self, size_t count, struct br_error *err)
{
    struct bending *b = self;
    return br_states_add(&b->states, b->states.size, count, err);
}

static void bending_exchange(void *self, size_t a, size_t b)
{
    struct bending *of = self;
    numbers_of(of);
    br_states_exchange(&of->states, a, b);
    take_numbers(of);
}

static void bending_combine(void *self, size_t into, size_t count, const double *weight)
{
    struct bending *b = self;
    if (weight[0] != 0)
        numbers_of(b);
    br_add_states(b->states.of[into], b->states.size, count, b->states.of, weight);
    if (into == 0)
        take_numbers(b);
}

/* The square of w_xx over an element is (kappa0^2 + kappa1^2 / 3) / h^3. */
static void bending_size(void *self, size_t state, double size[2])
{
    struct bending *b = self;
    const double *from = state == 0 ? numbers_of(b) : b->states.of[state];
    long double sum[2] = {0}; /* squares of small numbers are lost in double */
    for (size_t i = 0; i < b->n; i++, from += 4)
        for (int rate = 0; rate < 2; rate++) {
            const long double first = from[2 * rate], second = from[2 * rate + 1];
            sum[rate] += first * first + second * second / 3;
        }
    for (int rate = 0; rate < 2; rate++)
        size[rate] = (double)(sqrtl(sum[rate] / b->field.h) / b->field.h);
}

const struct br_field_solver br_plain_bending = {
    .create = bending_create,
    .free = bending_free,
    .tip_compliance = bending_compliance,
    .set = bending_set,
    .get = bending_get,
    .strain_rate = bending_strain_rate,
    .predict = bending_predict,
    .finish = bending_finish,
    .tip_displacement = bending_tip_displacement,
    .set_step = bending_set_step,
    .keep = bending_keep,
    .exchange = bending_exchange,
    .combine = bending_combine,
    .size = bending_size,
};
