/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Works of a march as its scheme sums rates of change, stage by stage, and what the scheme takes.
 */
#include <float.h>
#include <math.h>

#include "reference/energy_forms.h"

/* ---- a stage ---- */

/* The norms of K, without its coefficient, and of M. */
static real bend_norm(const struct br_field *f, const double *y)
{
    return sqrtl(br_bend_product(f, y, y));
}

static real mass_norm(const struct br_field *f, const double *y)
{
    return f->density > 0 ? sqrtl(br_mass_product(f, y, y)) : 0;
}

/* A stage goes from Z to Y in tau, and its residual r is relative to the sum of its terms, those of
 * Z among them (residual.c): where a velocity stops or a displacement decays in one step, Z's are
 * far larger than Y's. By Schwarz' inequality |v'r| is at most that relative size times
 *     |v| (a (|w| + |Z_w| + tau |v| + tau |Z_v|) + c (|v| + |Z_v|) + |r_tip|)  in the norms of K,
 *     |v - Z_v| (|v| + |Z_v|) / tau                                            in those of M,
 * and so is what rounding the stage's update does to <v, w> and <v', v>; |Z_w| <= |w| + tau |v|. */
static real residual_power(const struct br_field *f, const struct br_watched_field *seen, real tau,
                           real bent_speed, real tip_force)
{
    const real length = (real)f->h * f->n;
    const real tip = tip_force * sqrtl(f->kind == BR_AXIAL ? length : length * length * length / 3);
    const struct br_nodal *y = &seen->y.row[seen->last], *z = &seen->y.start;
    const real w = bend_norm(f, y->displacement), v = bent_speed,
               before = bend_norm(f, z->velocity);
    const real moving = mass_norm(f, y->velocity) + mass_norm(f, z->velocity);
    return v * ((real)f->stiffness * (2 * w + 2 * tau * v + tau * before) +
                (real)f->viscosity * (v + before) + fabsl(tip)) +
           moving * moving / tau;
}

/* How far a stage's own round-off is above the march's: it depends on tau, and some solvers leave a
 * residual beyond it. */
static real excess_of(const struct br_energy_meter *m, const struct br_field *f)
{
    const struct br_method *method = m->method;
    const double own = method->solver->residual ? method->solver->residual(f, &method->linear) : 0;
    const double now = br_energy_limit(f->n, br_march_round_off(m->march)) + own;
    return fmax(1, now / m->limit);
}

static struct br_power power_of(const struct br_energy_meter *m, enum br_field_kind kind, real tau)
{
    const struct br_meter_field *f = &m->field[kind];
    const struct br_watched_field *seen = &m->seen.field[kind];
    const struct br_tip *tip = br_march_tip(m->march);
    const double *v = seen->y.row[seen->last].velocity;
    const real bent = br_bend_product(&f->field, v, v);
    const double force = kind == BR_AXIAL ? tip->contact_force : tip->friction_force;
    struct br_power p = {
        .viscous = (real)f->field.viscosity * bent,
        .residual =
            excess_of(m, &f->field) * residual_power(&f->field, seen, tau, sqrtl(bent), force),
        .tip = (real)force * v[f->field.n * br_field_unknowns(&f->field)],
    };
    p.load = br_nodal_product(seen->load, v, br_field_size(&f->field), &p.load_size);
    return p;
}

static void watch_stage(void *self, const struct br_march_stage *told)
{
    struct br_energy_meter *m = self;
    const real tau = br_watched_stage(&m->seen, told);
    const int row = m->seen.field[told->kind].last;
    if (row >= 0)
        m->field[told->kind].row[row] = power_of(m, told->kind, tau);
    m->field[told->kind].k = told->k;
}

/* ---- what a scheme takes ---- */

/* <Y, Z> of displacements and velocities. */
static real product(const struct br_field *f, const double *const y[2], const double *const z[2])
{
    return (real)f->stiffness * br_bend_product(f, y[0], z[0]) + br_mass_product(f, y[1], z[1]);
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
static const struct br_nodal *row_of(const struct br_watched_field *seen,
                                     const struct br_textbook *t, int i)
{
    return t->c[i] == 0 ? &seen->y.past[0] : &seen->y.row[i];
}

/* k^2/2 sum_i <Y'_i, sum_j m_ij Y'_j>,  m_ij = b_i a_ij + b_j a_ji - b_i b_j */
static struct sum runge_kutta_takes(struct br_meter_field *m, const struct br_watched_field *seen,
                                    const struct br_textbook *t)
{
    struct sum taken = {0, 0};
    const long double *b = t->a[t->rows - 1];
    const size_t size = br_field_size(&m->field);
    for (int i = 0; i < t->rows; i++) {
        for (size_t x = 0; x < size; x++) {
            real z[2] = {0, 0};
            for (int j = 0; j < t->rows; j++) {
                const struct br_nodal *y = row_of(seen, t, j);
                const real weight = b[i] * t->a[i][j] + b[j] * t->a[j][i] - b[i] * b[j];
                z[0] += weight * y->velocity[x];
                z[1] += weight * y->acceleration[x];
            }
            m->scratch[0][x] = (double)z[0];
            m->scratch[1][x] = (double)z[1];
        }
        const struct br_nodal *y = row_of(seen, t, i);
        const double *const rate[2] = {y->velocity, y->acceleration};
        add(&taken, m->k * m->k / 2 * product(&m->field, rate, (const double *const *)m->scratch));
    }
    return taken;
}

/* The backward difference d^order of the displacement or the velocity. */
static void difference(const struct br_watched_field *seen, int order, bool velocity, double *out)
{
    static const int binomial[4][4] = {{1}, {1, -1}, {1, -2, 1}, {1, -3, 3, -1}};
    const struct br_nodal *now = &seen->y.row[0], *past = seen->y.past;
    for (size_t x = 0; x < seen->y.size; x++) {
        real sum = velocity ? now->velocity[x] : now->displacement[x];
        for (int i = 1; i <= order; i++)
            sum += binomial[order][i] *
                   (real)(velocity ? past[i - 1].velocity[x] : past[i - 1].displacement[x]);
        out[x] = (double)sum;
    }
}

/* 1/2 |d Y|^2 + sum <Y_n, d^j Y / j>, j = 2, ... */
static struct sum differences_take(struct br_meter_field *m, const struct br_watched_field *seen,
                                   const struct br_textbook *t)
{
    struct sum taken = {0, 0};
    const struct br_nodal *y = &seen->y.row[0];
    const double *const now[2] = {y->displacement, y->velocity};
    const double *const *d = (const double *const *)m->scratch;
    for (int order = 1; order <= t->back; order++) {
        difference(seen, order, false, m->scratch[0]);
        difference(seen, order, true, m->scratch[1]);
        add(&taken, product(&m->field, order == 1 ? d : now, d) / (order == 1 ? 2 : order));
    }
    return taken;
}

/* ---- a step ---- */

/* The works of a step by the scheme's weights, J. */
static struct sum add_works(struct br_meter_field *m, const struct br_textbook *t)
{
    struct br_field_work *w = &m->work;
    struct sum all = {0, 0};
    for (int i = 0; i < (t->rows > 0 ? t->rows : 1); i++) {
        const real weight = m->k * (t->rows > 0 ? t->a[t->rows - 1][i] : 1);
        const struct br_power *p = t->rows > 0 && t->c[i] == 0 ? &m->before : &m->row[i];
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

static real total(const struct br_field_energy *e)
{
    return e->kinetic + e->stored;
}

static double relative(real a, real size)
{
    return a == 0 ? 0 : (double)(fabsl(a) / size);
}

/* Displacements are sums of ways k v, and as good as these, also where a step annihilates the
 * velocity it begins with: with what the certificate allows their update, relative to |w| + k |v|,
 * stored energy has that times |k v| |w|, J, in the norms of K. */
static real noise_of_ways(const struct br_energy_meter *m, const struct br_meter_field *f,
                          const struct br_watched_field *seen)
{
    const real ways = bend_norm(&f->field, seen->y.past[0].velocity) +
                      bend_norm(&f->field, seen->y.start.velocity);
    const real size = bend_norm(&f->field, seen->y.row[seen->last].displacement);
    return (real)m->update * (real)f->field.stiffness * f->k * ways * size;
}

/* What an imbalance is relative to, J: what has decayed below the last bit of the largest so far
 * counts as nothing. */
static real scale_of(struct br_energy_meter *m, struct br_meter_field *f, real size, real noise)
{
    size += noise / m->limit;
    f->largest = f->largest > size ? f->largest : size;
    const real least = (real)DBL_EPSILON * f->largest;
    return size > least ? size : least;
}

/* Takes the energies at the step's end into the sums. Returns the imbalance. */
static double add_step(struct br_energy_meter *m, enum br_field_kind kind)
{
    struct br_meter_field *f = &m->field[kind];
    const struct br_watched_field *seen = &m->seen.field[kind];
    const struct br_textbook *t = br_watched_textbook(&m->seen, kind);
    const struct br_nodal *y = &seen->y.row[seen->last];
    const struct br_field_energy before = f->now;
    const real tip_before = f->work.tip;
    const struct sum works = add_works(f, t);
    const struct sum taken =
        t->rows > 0 ? runge_kutta_takes(f, seen, t) : differences_take(f, seen, t);
    f->now = br_energy_of_field(&f->field, &m->scene->contact, y->displacement, y->velocity);
    const real contact =
        kind == BR_BENDING ? 0 : f->work.tip - tip_before - (f->now.contact - before.contact);
    const real size = scale_of(m, f,
                               works.size + taken.size + total(&f->now) + total(&before) +
                                   f->now.contact + before.contact,
                               noise_of_ways(m, f, seen));
    f->work.scheme += taken.value;
    f->work.contact += contact;
    f->work.noise += m->limit * size;
    f->work.steps++;
    if (taken.value + contact < -m->limit * size) {
        f->work.gaining++;
        f->work.gained -= taken.value + contact;
    }
    f->before = f->row[seen->last];
    return relative(total(&f->now) - total(&before) - works.value + taken.value, size);
}

static void watch_step(void *self, enum br_field_kind kind, bool switched)
{
    struct br_energy_meter *m = self;
    const double imbalance = m->seen.field[kind].last < 0 ? NAN : add_step(m, kind);
    if (isnan(imbalance) || imbalance > m->worst)
        m->worst = imbalance;
    m->any = true;
    br_watched_step(&m->seen, kind, switched);
}

enum br_status br_meter_watch(struct br_energy_meter *m, struct br_error *err)
{
    const enum br_status status = br_watched_init(&m->seen, m->march, m->scene, m->method, err);
    if (status)
        return status;
    if (!br_march_watch(m->march, &(struct br_march_watcher){m, watch_stage, watch_step}))
        return br_fail(err, BR_BAD_INPUT, "the march has %d watchers, and room for no more",
                       BR_MOST_WATCHERS);
    return BR_OK;
}
