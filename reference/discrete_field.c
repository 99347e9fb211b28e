/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <string.h>

#include "reference/discrete_element.h"

enum { MOST = BR_DISCRETE_MOST };

/* T'p and G'p */
static inline void pull_back(size_t d, const long double *p, long double *state,
                             long double *strain)
{
    if (d == 1) {
        state[0] = strain[0] = p[0];
        return;
    }
    state[0] = p[0];
    state[1] = p[0] + p[1];
    strain[0] = p[0] / 2 + p[1];
    strain[1] = -p[0] / 6;
}

/* ---- room ---- */

static long double *numbers(size_t count)
{
    return br_allocate(count, sizeof(long double));
}

enum br_status br_discrete_field_init(struct br_discrete_field *f, const struct br_scene *scene,
                                      enum br_field_kind kind, size_t n, size_t states,
                                      struct br_error *err)
{
    const bool axial = kind == BR_AXIAL;
    *f = (struct br_discrete_field){
        .n = n,
        .d = axial ? 1 : 2,
        .h = (long double)scene->length / (long double)n,
        .density = scene->density,
        .stiffness = axial ? scene->axial.stiffness : scene->bending.stiffness,
        .viscosity = axial ? scene->axial.viscosity : scene->bending.viscosity,
        .states = states,
    };
    bool room = true;
    for (size_t i = 0; i < states; i++)
        room = (f->state[i] = numbers(2 * f->d * n)) && room;
    f->gain = br_allocate(n, sizeof *f->gain);
    f->response = numbers(f->d * n);
    f->free_rate = numbers(f->d * n);
    f->nodal = numbers(f->d * (n + 1));
    f->load = numbers(f->d * (n + 1));
    room = room && f->gain && f->response && f->free_rate && f->nodal && f->load;
    return room ? BR_OK : br_no_memory(err, "the exact discrete solution");
}

void br_discrete_field_clear(struct br_discrete_field *f)
{
    for (size_t i = 0; i < f->states; i++)
        free(f->state[i]);
    free(f->gain);
    free(f->response);
    free(f->free_rate);
    free(f->nodal);
    free(f->load);
    *f = (struct br_discrete_field){0};
}

/* ---- nodal values ---- */

/* u_1 - u_0; or h^2 w_xx of the Hermite cubic, its mean and its half slope. */
static void strain_of(size_t d, const long double *x, long double *strain)
{
    strain[0] = d == 1 ? x[1] - x[0] : x[3] - x[1];
    if (d == 2)
        strain[1] = 3 * (x[1] + x[3]) - 6 * (x[2] - x[0]);
}

void br_discrete_field_set(struct br_discrete_field *f, const long double *displacement,
                           const long double *velocity)
{
    const size_t d = f->d;
    for (size_t i = 0; i < f->n; i++) {
        strain_of(d, displacement + d * i, f->state[0] + d * i);
        strain_of(d, velocity + d * i, f->state[0] + d * (f->n + i));
    }
}

/* A sum and what it has lost to rounding (Neumaier 1974): over 1e6 elements plain sums would lose
 * more than all else does. */
struct sum {
    long double value, lost;
};

static inline void add(struct sum *s, long double x)
{
    const long double sum = s->value + x, shift = sum - s->value;
    s->lost += (s->value - (sum - shift)) + (x - shift);
    s->value = sum;
}

/* The node behind an element, from the node before it. */
static inline void advance(size_t d, const long double *q, struct sum node[MOST])
{
    if (d == 2) {
        add(&node[0], node[1].value);
        node[0].lost += node[1].lost;
        add(&node[0], q[0] / 2 - q[1] / 6);
        add(&node[1], q[0]);
    } else
        add(&node[0], q[0]);
}

static void nodes_of(const struct br_discrete_field *f, const long double *strain, long double *x)
{
    struct sum node[MOST] = {{0, 0}};
    memset(x, 0, f->d * sizeof *x);
    for (size_t i = 0; i < f->n; i++) {
        advance(f->d, strain + f->d * i, node);
        for (size_t a = 0; a < f->d; a++)
            x[f->d * (i + 1) + a] = node[a].value + node[a].lost;
    }
}

void br_discrete_field_get(const struct br_discrete_field *f, long double *displacement,
                           long double *velocity)
{
    if (displacement)
        nodes_of(f, f->state[0], displacement);
    if (velocity)
        nodes_of(f, f->state[0] + f->d * f->n, velocity);
}

static long double tip_of(const struct br_discrete_field *f, const long double *strain)
{
    struct sum node[MOST] = {{0, 0}};
    for (size_t i = 0; i < f->n; i++)
        advance(f->d, strain + f->d * i, node);
    return node[0].value + node[0].lost;
}

long double br_discrete_field_tip(const struct br_discrete_field *f, bool velocity)
{
    return tip_of(f, f->state[0] + (velocity ? f->d * f->n : 0));
}

/* ---- a solve ---- */

/* rate = argmin of the energies with g of `strain` (NULL: none) and the nodal forces b. */
static inline void solve(const struct br_discrete_field *f, size_t d, const long double *strain,
                         const long double *b, long double *rate)
{
    const long double stiff[MOST] = {f->stiffness * br_discrete_rigidity(f, 0),
                                     f->stiffness * br_discrete_rigidity(f, 1)};
    long double p[MOST], y[MOST] = {0};
    memcpy(p, b + d * f->n, d * sizeof *p);
    for (size_t i = f->n; i-- > 0;) { /* r = g - G'p,  p = b + T'p + gain'r */
        long double state[MOST], r[MOST];
        pull_back(d, p, state, r);
        for (size_t a = 0; a < d; a++)
            r[a] = (strain ? stiff[a] * strain[d * i + a] : 0) - r[a];
        for (size_t a = 0; a < d; a++) {
            p[a] = b[d * i + a] + state[a];
            rate[d * i + a] = 0;
            for (size_t c = 0; c < d; c++) {
                p[a] += f->gain[i].gain[c][a] * r[c];
                rate[d * i + a] -= f->gain[i].inverse[a][c] * r[c];
            }
        }
    }
    for (size_t i = 0; i < f->n; i++) { /* q = -(gain y + inverse r) */
        long double next[MOST];
        for (size_t a = 0; a < d; a++)
            for (size_t c = 0; c < d; c++)
                rate[d * i + a] -= f->gain[i].gain[a][c] * y[c];
        br_discrete_cross(d, y, rate + d * i, next);
        memcpy(y, next, d * sizeof *y);
    }
}

/* b = F + tip + M v/tau in f->nodal. */
static inline void find_forces(struct br_discrete_field *f, size_t d, const long double *tip)
{
    const long double mass = f->density * f->h / f->tau, *rate = f->state[0] + d * f->n;
    long double m[2 * MOST][2 * MOST], v[2 * MOST] = {0};
    for (size_t a = 0; a < 2 * d; a++)
        for (size_t c = 0; c < 2 * d; c++)
            m[a][c] = mass * br_discrete_mass(d, a, c);
    for (size_t i = 0; i < d * (f->n + 1); i++)
        f->nodal[i] = f->load[i];
    for (size_t i = 0; i < f->n; i++) {
        br_discrete_cross(d, v, rate + d * i, v + d);
        for (size_t a = 0; a < 2 * d; a++)
            for (size_t c = 0; c < 2 * d; c++)
                f->nodal[d * i + a] += m[a][c] * v[c];
        memcpy(v, v + d, d * sizeof *v);
    }
    for (size_t c = 0; c < d; c++)
        f->nodal[d * f->n + c] += tip[c];
}

/* For each number of unknowns a loop of its own. */
static void solve_field(const struct br_discrete_field *f, const long double *strain,
                        long double *rate)
{
    if (f->d == 1)
        solve(f, 1, strain, f->nodal, rate);
    else
        solve(f, 2, strain, f->nodal, rate);
}

enum br_status br_discrete_field_set_step(struct br_discrete_field *f, long double tau,
                                          struct br_error *err)
{
    if (tau == f->tau)
        return BR_OK;
    struct br_discrete_value value = {{{0}}};
    for (size_t i = f->n; i-- > 0;)
        if (!br_discrete_add_element(f, tau, &value, &f->gain[i]))
            return br_fail(err, BR_SINGULAR,
                           "the exact discrete solution: the step is not positive definite at "
                           "element %zu of %zu",
                           i, f->n);
    f->tau = tau;
    memset(f->nodal, 0, f->d * (f->n + 1) * sizeof *f->nodal);
    f->nodal[f->d * f->n] = 1;
    solve_field(f, NULL, f->response);
    f->compliance = tip_of(f, f->response);
    return BR_OK;
}

long double br_discrete_field_predict(struct br_discrete_field *f,
                                      const long double tip[BR_DISCRETE_MOST])
{
    if (f->d == 1)
        find_forces(f, 1, tip);
    else
        find_forces(f, 2, tip);
    solve_field(f, f->state[0], f->free_rate);
    return tip_of(f, f->free_rate);
}

void br_discrete_field_finish(struct br_discrete_field *f, long double force)
{
    const size_t count = f->d * f->n;
    long double *strain = f->state[0], *rate = strain + count;
    for (size_t i = 0; i < count; i++) {
        rate[i] = f->free_rate[i] - force * f->response[i];
        strain[i] += f->tau * rate[i];
    }
}
