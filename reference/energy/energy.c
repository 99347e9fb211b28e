/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/energy/energy.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "reference/certificate/certificate.h"
#include "reference/certificate/watched.h"
#include "reference/textbook.h"
#include "solver/scene.h"

typedef long double real;

/* a'Mb, or a'Kb of the stiffness without its coefficient. */
static real product(const struct br_field *f, enum br_element_matrix matrix, const double *a,
                    const double *b)
{
    const struct br_element *e = br_element_of(f->kind, f->degree);
    const real h = (real)f->h;
    real sum = 0;
    for (size_t i = 0; i < f->n * e->unknowns; i += e->unknowns)
        sum += br_element_product(e, matrix, a + i, b + i);
    return matrix == BR_MASS     ? (real)f->density * h * sum
           : f->kind == BR_AXIAL ? sum / h
                                 : sum / (h * h * h);
}

/* ---- of a state ---- */

/* Energies of one field's state, J; of the axial field with the contact's potential. */
struct field_energy {
    real kinetic, stored, contact;
};

static struct field_energy energy_of_field(const struct br_field *f,
                                           const struct br_contact *contact,
                                           const double *displacement, const double *velocity)
{
    struct field_energy e = {
        .kinetic = product(f, BR_MASS, velocity, velocity) / 2,
        .stored = (real)f->stiffness * product(f, BR_STIFFNESS, displacement, displacement) / 2,
    };
    if (f->kind != BR_AXIAL || !contact->modelled)
        return e;
    const real depth = (real)displacement[f->n * br_field_unknowns(f)] - contact->gap;
    e.contact = depth <= 0 ? 0 : br_contact_stiffness(contact) * depth * depth / 2;
    return e;
}

static void put(struct br_energy *to, enum br_field_kind kind, const struct field_energy *e)
{
    to->kinetic[kind] = (double)e->kinetic;
    to->stored[kind] = (double)e->stored;
    to->contact += (double)e->contact;
}

enum br_status br_energy_sample(const struct br_march *march, const struct br_scene *scene,
                                struct br_energy *energy, struct br_error *err)
{
    *energy = (struct br_energy){0};
    const size_t size = 2 * (br_march_field(march, BR_AXIAL)->n + 1); /* of either field at most */
    double *y = br_allocate(2 * size, sizeof *y);
    if (!y)
        return br_no_memory(err, "the energies");
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        const struct br_field *f = br_march_field(march, kind);
        if (!br_march_models(march, kind))
            continue;
        br_march_get(march, kind, y, y + size);
        const struct field_energy e = energy_of_field(f, &scene->contact, y, y + size);
        put(energy, kind, &e);
    }
    free(y);
    return BR_OK;
}

/* ---- sums of terms ---- */

double br_energy_total(const struct br_energy *e)
{
    return e->kinetic[0] + e->kinetic[1] + e->stored[0] + e->stored[1] + e->contact;
}

double br_energy_imbalance(const struct br_energy *start, const struct br_energy *now,
                           const struct br_work *w)
{
    real error = 0, size = 0;
    const double terms[][2] = {
        {br_energy_total(now), 1}, {br_energy_total(start), -1},
        {w->loads[0], -1},         {w->loads[1], -1},
        {w->viscous[0], 1},        {w->viscous[1], 1},
        {w->friction, 1},          {w->scheme[0], 1},
        {w->scheme[1], 1},         {w->scheme_contact, 1},
    };
    for (size_t i = 0; i < sizeof terms / sizeof *terms; i++) {
        error += (real)terms[i][0] * (real)terms[i][1];
        size += fabsl((real)terms[i][0]);
    }
    return size == 0 ? 0 : (double)(error / size);
}

double br_energy_added(const struct br_work *w, enum br_field_kind kind)
{
    const double lost = w->scheme[kind] + (kind == BR_AXIAL ? w->scheme_contact : 0);
    return lost >= -w->noise[kind] ? 0 : -lost; /* NaN stays NaN */
}

double br_energy_put_in(const struct br_energy *start, const struct br_work *w,
                        enum br_field_kind kind)
{
    const double first =
        start->kinetic[kind] + start->stored[kind] + (kind == BR_AXIAL ? start->contact : 0);
    return first + fmax(w->loads[kind], 0);
}

const double br_energy_useless = 1e-3;

double br_energy_limit(size_t n, double round_off)
{
    const double nodes = (double)n + 1, noise = 64 * DBL_EPSILON * nodes * nodes;
    return fmin(64 * DBL_EPSILON * nodes + 16 * round_off + noise * noise, br_energy_useless);
}

/* ---- the works of a march, summed over stages as its scheme sums rates of change ---- */

/* Rates of work at one time, W. */
struct power {
    real load, viscous, tip; /* tip: of the contact or the friction force, which resists */
    real load_size;          /* the sum of the sizes of the nodes' shares */
    real residual; /* power that a sound stage's residual may have, over its relative size */
};

/* Since t = 0, J. */
struct field_work {
    real load, viscous, tip, scheme, contact, noise, gained;
    size_t steps, gaining;
};

struct meter_field {
    struct br_field field; /* as the scene has it */
    struct field_energy start, now;
    struct power before, row[BR_TEXTBOOK_ROWS]; /* at the step's beginning, and its stages */
    struct field_work work;
    real k;             /* of the step, s */
    real largest;       /* sum of the sizes of a step's terms so far, J */
    double *scratch[2]; /* displacement and velocity, br_field_size values each */
};

struct br_energy_meter {
    struct br_watched watched;
    struct meter_field field[2]; /* by br_field_kind */
    double limit, worst;         /* of the imbalance; worst: since the last call */
    double update;               /* what a certificate allows the displacement's update */
    bool any;
};

/* ---- a stage ---- */

/* c'v, and the sum of the sizes of its terms (out). */
static real dot(const double *c, const double *v, size_t size, real *sizes)
{
    real sum = 0;
    *sizes = 0;
    for (size_t i = 0; i < size; i++) {
        const real term = (real)c[i] * v[i];
        sum += term;
        *sizes += fabsl(term);
    }
    return sum;
}

/* In the norm of M, or of K without its coefficient. */
static real norm(const struct br_field *f, enum br_element_matrix matrix, const double *y)
{
    return sqrtl(product(f, matrix, y, y));
}

/* A stage goes from Z to Y in tau, and its residual r is relative to the sum of its terms, those of
 * Z among them (certificate.c): where a velocity stops or a displacement decays in one step, Z's
 * are far larger than Y's. By Schwarz' inequality |v'r| is at most that relative size times
 *     |v| (a (|w| + |Z_w| + tau |v| + tau |Z_v|) + c (|v| + |Z_v|) + |r_tip|)  in the norms of K,
 *     |v - Z_v| (|v| + |Z_v|) / tau                                            in those of M,
 * and so is what rounding the stage's update does to <v, w> and <v', v>; |Z_w| <= |w| + tau |v|. */
static real residual_power(const struct br_field *f, const struct br_watched_field *watched,
                           real tau, real bent_speed, real tip_force)
{
    const real length = (real)f->h * f->n;
    const real tip = tip_force * sqrtl(f->kind == BR_AXIAL ? length : length * length * length / 3);
    const struct br_nodal *y = &watched->y.row[watched->last], *z = &watched->y.start;
    const real w = norm(f, BR_STIFFNESS, y->displacement), v = bent_speed,
               before = norm(f, BR_STIFFNESS, z->velocity);
    const real moving = norm(f, BR_MASS, y->velocity) + norm(f, BR_MASS, z->velocity);
    return v * ((real)f->stiffness * (2 * w + 2 * tau * v + tau * before) +
                (real)f->viscosity * (v + before) + fabsl(tip)) +
           moving * moving / tau;
}

/* How far a stage's own round-off is above the march's: it depends on tau, and some solvers leave a
 * residual beyond it. */
static real excess_of(const struct br_energy_meter *m, const struct br_field *f)
{
    const struct br_method *method = m->watched.method;
    const double own = br_method_residual(method, f);
    const double now = br_energy_limit(f->n, br_march_round_off(m->watched.march)) + own;
    return fmax(1, now / m->limit);
}

static struct power power_of(const struct br_energy_meter *m, enum br_field_kind kind, real tau)
{
    const struct meter_field *f = &m->field[kind];
    const struct br_watched_field *watched = &m->watched.field[kind];
    const struct br_tip *tip = br_march_tip(m->watched.march);
    const double *v = watched->y.row[watched->last].velocity;
    const real bent = product(&f->field, BR_STIFFNESS, v, v);
    const double force = tip->force[kind];
    struct power p = {
        .viscous = (real)f->field.viscosity * bent,
        .residual =
            excess_of(m, &f->field) * residual_power(&f->field, watched, tau, sqrtl(bent), force),
        .tip = (real)force * v[f->field.n * br_field_unknowns(&f->field)],
    };
    p.load = dot(watched->load, v, br_field_size(&f->field), &p.load_size);
    return p;
}

static void watch_stage(void *self, const struct br_march_stage *stage)
{
    struct br_energy_meter *m = self;
    const real tau = br_watched_stage(&m->watched, stage);
    const int row = m->watched.field[stage->kind].last;
    if (row >= 0)
        m->field[stage->kind].row[row] = power_of(m, stage->kind, tau);
    m->field[stage->kind].k = stage->k;
}

/* ---- what a scheme dissipates ---- */

/* <Y, Z> of displacements and velocities. */
static real inner(const struct br_field *f, const double *const y[2], const double *const z[2])
{
    return (real)f->stiffness * product(f, BR_STIFFNESS, y[0], z[0]) +
           product(f, BR_MASS, y[1], z[1]);
}

/* A sum and the sum of its terms' sizes, J. */
struct sum {
    real value, size;
};

static void add(struct sum *s, real term)
{
    s->value += term;
    s->size += fabsl(term);
}

/* Row i's Y' = (w', v'); a row with c = 0 is the step's beginning. */
static const struct br_nodal *row_of(const struct br_watched_field *watched,
                                     const struct br_textbook *t, int i)
{
    return t->c[i] == 0 ? &watched->y.past[0] : &watched->y.row[i];
}

/* k^2/2 sum_i <Y'_i, sum_j m_ij Y'_j>,  m_ij = b_i a_ij + b_j a_ji - b_i b_j */
static struct sum runge_kutta_takes(struct meter_field *m, const struct br_watched_field *watched,
                                    const struct br_textbook *t)
{
    struct sum taken = {0, 0};
    const long double *b = t->a[t->rows - 1];
    const size_t size = br_field_size(&m->field);
    for (int i = 0; i < t->rows; i++) {
        for (size_t x = 0; x < size; x++) {
            real z[2] = {0, 0};
            for (int j = 0; j < t->rows; j++) {
                const struct br_nodal *y = row_of(watched, t, j);
                const real weight = b[i] * t->a[i][j] + b[j] * t->a[j][i] - b[i] * b[j];
                z[0] += weight * y->velocity[x];
                z[1] += weight * y->acceleration[x];
            }
            m->scratch[0][x] = (double)z[0];
            m->scratch[1][x] = (double)z[1];
        }
        const struct br_nodal *y = row_of(watched, t, i);
        const double *const rate[2] = {y->velocity, y->acceleration};
        add(&taken, m->k * m->k / 2 * inner(&m->field, rate, (const double *const *)m->scratch));
    }
    return taken;
}

/* The backward difference d^order of the displacement or the velocity. */
static void difference(const struct br_watched_field *watched, int order, bool velocity,
                       double *out)
{
    static const int binomial[4][4] = {{1}, {1, -1}, {1, -2, 1}, {1, -3, 3, -1}};
    const struct br_nodal *now = &watched->y.row[0], *past = watched->y.past;
    for (size_t x = 0; x < watched->y.size; x++) {
        real sum = velocity ? now->velocity[x] : now->displacement[x];
        for (int i = 1; i <= order; i++)
            sum += binomial[order][i] *
                   (real)(velocity ? past[i - 1].velocity[x] : past[i - 1].displacement[x]);
        out[x] = (double)sum;
    }
}

/* 1/2 |d Y|^2 + sum <Y_n, d^j Y / j>, j = 2, ... */
static struct sum differences_take(struct meter_field *m, const struct br_watched_field *watched,
                                   const struct br_textbook *t)
{
    struct sum taken = {0, 0};
    const struct br_nodal *y = &watched->y.row[0];
    const double *const now[2] = {y->displacement, y->velocity};
    const double *const *d = (const double *const *)m->scratch;
    for (int order = 1; order <= t->back; order++) {
        difference(watched, order, false, m->scratch[0]);
        difference(watched, order, true, m->scratch[1]);
        add(&taken, inner(&m->field, order == 1 ? d : now, d) / (order == 1 ? 2 : order));
    }
    return taken;
}

/* ---- a step ---- */

/* The works of a step by the scheme's weights, J. */
static struct sum add_works(struct meter_field *m, const struct br_textbook *t)
{
    struct field_work *w = &m->work;
    struct sum all = {0, 0};
    for (int i = 0; i < (t->rows > 0 ? t->rows : 1); i++) {
        const real weight = m->k * (t->rows > 0 ? t->a[t->rows - 1][i] : 1);
        const struct power *p = t->rows > 0 && t->c[i] == 0 ? &m->before : &m->row[i];
        w->load += weight * p->load;
        w->viscous += weight * p->viscous;
        w->tip += weight * p->tip;
        add(&all, weight * p->load);
        add(&all, -weight * p->viscous);
        add(&all, -weight * p->tip);
        all.size += fabsl(weight) * (p->load_size + p->residual);
    }
    return all;
}

static real total(const struct field_energy *e)
{
    return e->kinetic + e->stored;
}

static double relative(real a, real size)
{
    return a == 0 ? 0 : (double)(fabsl(a) / size);
}

/* Displacements are sums of increments k v and have their accuracy, also where a step stops the
 * velocity it starts with. The certificate allows the update an error relative to |w| + k |v|. The
 * stored energy then has an error of that times |k v| |w|, J, in the norms of K. */
static real noise_of_increments(const struct br_energy_meter *m, const struct meter_field *f,
                                const struct br_watched_field *watched)
{
    const real speeds = norm(&f->field, BR_STIFFNESS, watched->y.past[0].velocity) +
                        norm(&f->field, BR_STIFFNESS, watched->y.start.velocity);
    const real size = norm(&f->field, BR_STIFFNESS, watched->y.row[watched->last].displacement);
    return (real)m->update * (real)f->field.stiffness * f->k * speeds * size;
}

/* The scale of an imbalance, J. Energies below the last bit of the largest scale so far count as
 * nothing. */
static real scale_of(struct br_energy_meter *m, struct meter_field *f, real size, real noise)
{
    size += noise / m->limit;
    f->largest = f->largest > size ? f->largest : size;
    const real least = (real)DBL_EPSILON * f->largest;
    return size > least ? size : least;
}

/* Adds the energies at the step's end to the sums. Returns the imbalance. */
static double add_step(struct br_energy_meter *m, enum br_field_kind kind)
{
    struct meter_field *f = &m->field[kind];
    const struct br_watched_field *watched = &m->watched.field[kind];
    const struct br_textbook *t = br_watched_textbook(&m->watched, kind);
    const struct br_nodal *y = &watched->y.row[watched->last];
    const struct field_energy before = f->now;
    const real tip_before = f->work.tip;
    const struct sum works = add_works(f, t);
    const struct sum taken =
        t->rows > 0 ? runge_kutta_takes(f, watched, t) : differences_take(f, watched, t);
    f->now = energy_of_field(&f->field, &m->watched.scene->contact, y->displacement, y->velocity);
    const real contact =
        kind == BR_BENDING ? 0 : f->work.tip - tip_before - (f->now.contact - before.contact);
    const real size = scale_of(m, f,
                               works.size + taken.size + total(&f->now) + total(&before) +
                                   f->now.contact + before.contact,
                               noise_of_increments(m, f, watched));
    f->work.scheme += taken.value;
    f->work.contact += contact;
    f->work.noise += m->limit * size;
    f->work.steps++;
    if (taken.value + contact < -m->limit * size) {
        f->work.gaining++;
        f->work.gained -= taken.value + contact;
    }
    f->before = f->row[watched->last];
    return relative(total(&f->now) - total(&before) - works.value + taken.value, size);
}

static void watch_step(void *self, enum br_field_kind kind, bool switched)
{
    struct br_energy_meter *m = self;
    const double imbalance = m->watched.field[kind].last < 0 ? NAN : add_step(m, kind);
    if (isnan(imbalance) || imbalance > m->worst)
        m->worst = imbalance;
    m->any = true;
    br_watched_step(&m->watched, kind, switched);
}

/* ---- setting up ---- */

/* Sets up a field from the scene, not from the solver, and its energies at t = 0. */
static enum br_status set_up(struct br_energy_meter *m, enum br_field_kind kind,
                             struct br_error *err)
{
    struct meter_field *f = &m->field[kind];
    const struct br_nodal *y = &m->watched.field[kind].y.past[0];
    f->field = br_field_of_scene(m->watched.scene, kind, m->watched.n, NAN,
                                 m->watched.method->axial_degree);
    const size_t size = br_field_size(&f->field);
    f->scratch[0] = br_allocate(2 * size, sizeof *f->scratch[0]);
    if (!f->scratch[0])
        return br_no_memory(err, "the energies");
    f->scratch[1] = f->scratch[0] + size;
    if (br_march_models(m->watched.march, kind))
        f->start = f->now =
            energy_of_field(&f->field, &m->watched.scene->contact, y->displacement, y->velocity);
    return BR_OK;
}

enum br_status br_energy_meter_create(struct br_energy_meter **out, struct br_march *march,
                                      const struct br_scene *scene, const struct br_method *method,
                                      struct br_error *err)
{
    const size_t n = br_march_field(march, BR_AXIAL)->n;
    const double round_off = br_march_round_off(march);
    struct br_energy_meter *m = *out = br_allocate(1, sizeof *m);
    if (!m)
        return br_no_memory(err, "the energies");
    m->limit = br_energy_limit(n, round_off);
    m->update = br_certificate_limits(method->scheme, n, round_off).update;
    const struct br_march_watcher watcher = {m, watch_stage, watch_step};
    enum br_status status = br_watched_init(&m->watched, march, scene, method, &watcher, err);
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING && !status; kind++)
        status = set_up(m, kind, err);
    if (status) {
        br_energy_meter_free(m);
        *out = NULL;
    }
    return status;
}

void br_energy_meter_free(struct br_energy_meter *m)
{
    if (!m)
        return;
    br_watched_clear(&m->watched);
    free(m->field[BR_AXIAL].scratch[0]);
    free(m->field[BR_BENDING].scratch[0]);
    free(m);
}

/* ---- reading ---- */

double br_energy_meter_step(struct br_energy_meter *m)
{
    const double worst = m->any ? m->worst : NAN;
    m->worst = 0;
    m->any = false;
    return worst;
}

void br_energy_meter_read(const struct br_energy_meter *m, struct br_energy *start,
                          struct br_energy *now, struct br_work *work)
{
    *start = *now = (struct br_energy){0};
    *work = (struct br_work){0};
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        const struct meter_field *f = &m->field[kind];
        const struct field_work *w = &f->work;
        put(start, kind, &f->start);
        put(now, kind, &f->now);
        work->loads[kind] = (double)w->load;
        work->viscous[kind] = (double)w->viscous;
        work->scheme[kind] = (double)w->scheme;
        work->noise[kind] = (double)w->noise;
        work->steps[kind] = w->steps;
        work->gaining[kind] = w->gaining;
        work->gained[kind] = (double)w->gained;
    }
    work->friction = (double)m->field[BR_BENDING].work.tip;
    work->scheme_contact = (double)m->field[BR_AXIAL].work.contact;
}
