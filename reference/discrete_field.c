/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One field of the exact discrete solution (discrete.h), in long double, and its backward Euler
 * step.
 *
 * The step's velocity y minimises, over all y with y = 0 at the clamp,
 *     1/2 y'(M/tau) y + sum_e 1/2 q'R q + g'q - b'y,    R = (c + tau a) D,  g = a D kappa,
 * where q is what deforms an element by time (h u_x; or the two coefficients of h^2 w_xx), kappa
 * the same of the displacement that the step starts from, D = 1/h (or diag(1, 1/3)/h^3) and
 * b = F + M v/tau. The value of all elements from node i to the tip is a quadratic function of y_i,
 * 1/2 y'P y - p'y, found from the free end (dynamic programming; Bellman 1957). Its unknowns are
 * strains: what a stiffness matrix of condition n^4 would lose is never there. */
#include <math.h>
#include <string.h>

#include "reference/discrete_field.h"
#include "reference/textbook.h"

enum { MOST = BR_DISCRETE_MOST };

/* ---- an element ---- */

/* right = T left + G q: the node at an element's right end. Rod: u + q. Beam, with the curvature
 * q0 + q1 (2 xi - 1) integrated twice over xi: w + s + q0/2 - q1/6, s + q0. */
static inline void cross(size_t d, const long double *left, const long double *q,
                         long double *right)
{
    if (d == 1) {
        right[0] = left[0] + q[0];
        return;
    }
    right[0] = left[0] + left[1] + q[0] / 2 - q[1] / 6;
    right[1] = left[1] + q[0];
}

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

/* Entry (a, b) of the element's mass over rho h. */
static long double mass_entry(size_t d, size_t a, size_t b)
{
    const struct br_element *e = br_element_of(d == 1 ? BR_AXIAL : BR_BENDING, 1);
    return (long double)e->entry[BR_MASS][a][b] / e->over[BR_MASS];
}

/* D of strain c, which the stiffness multiplies, 1/m or 1/m^3. */
static long double rigidity(const struct br_discrete_field *f, size_t c)
{
    return f->d == 1 ? 1 / f->h : 1 / (f->h * f->h * f->h) / (c == 0 ? 1 : 3);
}

/* x'y by the element's mass rho h/tau of nodal values x, y, the strains' R, and the value P of what
 * lies right of it. */
struct energy {
    size_t d;
    long double mass, stiff[MOST], value[MOST][MOST];
};

/* An element's motion: nodes and strains. */
struct motion {
    long double node[2 * MOST], q[MOST];
};

static long double product(const struct energy *e, const struct motion *x, const struct motion *y)
{
    const size_t d = e->d;
    long double sum = 0;
    for (size_t a = 0; a < 2 * d; a++)
        for (size_t b = 0; b < 2 * d; b++)
            sum += e->mass * mass_entry(d, a, b) * x->node[a] * y->node[b];
    for (size_t a = 0; a < d; a++) {
        sum += e->stiff[a] * x->q[a] * y->q[a];
        for (size_t b = 0; b < d; b++)
            sum += x->node[d + a] * e->value[a][b] * y->node[d + b];
    }
    return sum;
}

/* The motion with its left node and its strain given. */
static struct motion motion(size_t d, const long double *left, const long double *q)
{
    struct motion m = {0};
    memcpy(m.node, left, d * sizeof *left);
    memcpy(m.q, q, d * sizeof *q);
    cross(d, m.node, m.q, m.node + d);
    return m;
}

static bool invert(size_t d, long double s[MOST][MOST], long double inverse[MOST][MOST])
{
    if (d == 1) {
        inverse[0][0] = 1 / s[0][0];
        return s[0][0] > 0;
    }
    const long double det = s[0][0] * s[1][1] - s[0][1] * s[1][0];
    inverse[0][0] = s[1][1] / det;
    inverse[1][1] = s[0][0] / det;
    inverse[0][1] = inverse[1][0] = -s[0][1] / det;
    return s[0][0] > 0 && det > 0;
}

/* The gains (out) of an element for steps of tau, s; its own value then takes the place of what
 * lies right of it, 1/2 y'P y with P in N s/m: that of the best motions for unit left nodes, as a
 * sum of energies. False: the step is not positive definite. */
static bool add_element(const struct br_discrete_field *f, long double tau,
                        long double right[MOST][MOST], struct br_discrete_gain *g)
{
    static const long double unit[MOST][MOST] = {{1, 0}, {0, 1}}, none[MOST] = {0};
    const size_t d = f->d;
    struct energy energy = {.d = d, .mass = f->density * f->h / tau}, *e = &energy;
    for (size_t c = 0; c < d; c++)
        e->stiff[c] = (f->viscosity + tau * f->stiffness) * rigidity(f, c);
    memcpy(e->value, right, sizeof e->value);
    struct motion strain[MOST], left[MOST];
    long double s[MOST][MOST] = {{0}}, value[MOST][MOST];
    for (size_t a = 0; a < d; a++) {
        strain[a] = motion(d, none, unit[a]);
        left[a] = motion(d, unit[a], none);
    }
    for (size_t a = 0; a < d; a++)
        for (size_t b = 0; b < d; b++)
            s[a][b] = product(e, &strain[a], &strain[b]);
    if (!invert(d, s, g->inverse))
        return false;
    for (size_t b = 0; b < d; b++) {
        long double q[MOST] = {0};
        for (size_t a = 0; a < d; a++) {
            g->gain[a][b] = 0;
            for (size_t c = 0; c < d; c++)
                g->gain[a][b] += g->inverse[a][c] * product(e, &strain[c], &left[b]);
            q[a] = -g->gain[a][b];
        }
        left[b] = motion(d, unit[b], q);
    }
    for (size_t a = 0; a < d; a++)
        for (size_t b = 0; b < d; b++)
            value[a][b] = product(e, &left[a], &left[b]);
    memcpy(right, value, sizeof value);
    return true;
}

/* ---- nodal values ---- */

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
    const long double stiff[MOST] = {f->stiffness * rigidity(f, 0), f->stiffness * rigidity(f, 1)};
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
        cross(d, y, rate + d * i, next);
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
            m[a][c] = mass * mass_entry(d, a, c);
    for (size_t i = 0; i < d * (f->n + 1); i++)
        f->nodal[i] = f->load[i];
    for (size_t i = 0; i < f->n; i++) {
        cross(d, v, rate + d * i, v + d);
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
    long double value[MOST][MOST] = {{0}};
    for (size_t i = f->n; i-- > 0;)
        if (!add_element(f, tau, value, &f->gain[i]))
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

/* ---- quadrature ---- */

enum { POINTS = 5 };

/* Gauss and Legendre's rule on [0, 1]: the roots of P_5 are 0 and -+ sqrt(5 -+ 2 sqrt(10/7)) / 3,
 * the weights 128/225 and (322 +- 13 sqrt 70) / 900, here halved (Abramowitz and Stegun 25.4.30).
 */
static void gauss(long double x[POINTS], long double weight[POINTS])
{
    const long double inner = sqrtl(5 - 2 * sqrtl(10 / 7.0L)) / 6;
    const long double outer = sqrtl(5 + 2 * sqrtl(10 / 7.0L)) / 6;
    const long double place[POINTS] = {-outer, -inner, 0, inner, outer};
    const long double heavy = (322 + 13 * sqrtl(70)) / 1800, light = (322 - 13 * sqrtl(70)) / 1800;
    const long double share[POINTS] = {light, heavy, 64 / 225.0L, heavy, light};
    for (int q = 0; q < POINTS; q++) {
        x[q] = 0.5L + place[q];
        weight[q] = share[q];
    }
}

/* The shape functions of an element at xi: Lagrange's two, or Hermite's four for (w, h w_x). */
static void shapes(size_t d, long double xi, long double shape[2 * MOST])
{
    const long double square = xi * xi, cube = square * xi;
    if (d == 1) {
        shape[0] = 1 - xi;
        shape[1] = xi;
        return;
    }
    shape[0] = 1 - 3 * square + 2 * cube;
    shape[1] = xi - 2 * square + cube;
    shape[2] = 3 * square - 2 * cube;
    shape[3] = cube - square;
}

/* One value of f at a time. */
static enum br_status value_of(const struct br_function *f, double x, double t, long double *value,
                               struct br_error *err)
{
    const double y = br_function_at(f, x, t);
    *value = y;
    return isfinite(y) ? BR_OK
                       : br_fail(err, BR_NOT_FINITE,
                                 "an expression is %g at x = %.17g m, t = %.17g s", y, x, t);
}

/* vector = int f(x, t) shape: of a function of t alone the rule is exact, too. */
static enum br_status assemble(const struct br_discrete_field *field, const struct br_function *f,
                               double t, long double *vector, struct br_error *err)
{
    const size_t d = field->d;
    long double xi[POINTS], weight[POINTS], shape[2 * MOST];
    gauss(xi, weight);
    memset(vector, 0, d * (field->n + 1) * sizeof *vector);
    for (size_t q = 0; q < POINTS; q++) {
        shapes(d, xi[q], shape);
        for (size_t i = 0; i < field->n; i++) {
            long double value;
            const long double x = field->h * ((long double)i + xi[q]);
            const enum br_status status = value_of(f, (double)x, t, &value, err);
            if (status)
                return status;
            for (size_t a = 0; a < 2 * d; a++)
                vector[d * i + a] += field->h * weight[q] * value * shape[a];
        }
    }
    return BR_OK;
}

/* ---- forces ---- */

/* The functions of the forces, and the load vectors that do not change. */
static enum br_status take_forces(struct br_discrete_field *f, const struct br_scene *scene,
                                  struct br_error *err)
{
    const bool axial = f->d == 1;
    const struct br_function none = {0};
    enum br_status status =
        br_load_clone(axial ? &scene->axial.load : &scene->bending.load, &f->functions, err);
    for (size_t i = 0; i < BR_LOAD_TERMS && !status; i++) {
        const struct br_product *p = &f->functions.term[i];
        if (br_product_is_zero(p))
            continue;
        f->vector[i] = br_allocate(f->d * (f->n + 1), sizeof *f->vector[i]);
        if (!f->vector[i])
            status = br_no_memory(err, "a load vector");
        else if (!p->space.uses_t)
            status = assemble(f, &p->space, 0, f->vector[i], err);
    }
    if (!status)
        status = br_function_clone(axial ? &scene->axial.tip_force : &scene->bending.tip_force,
                                   &f->tip_force, err);
    if (!status)
        status = br_function_clone(axial ? &none : &scene->bending.tip_moment, &f->tip_moment, err);
    return status;
}

/* The load at time t, s, and what is at the tip's unknowns (out), N. */
static enum br_status update_forces(struct br_discrete_field *f, double t, long double tip[MOST],
                                    struct br_error *err)
{
    enum br_status status = BR_OK;
    const size_t size = f->d * (f->n + 1);
    memset(f->load, 0, size * sizeof *f->load);
    for (size_t i = 0; i < BR_LOAD_TERMS && f->vector[i] && !status; i++) {
        const struct br_product *p = &f->functions.term[i];
        long double factor = 0;
        status = value_of(&p->time, 0, t, &factor, err);
        if (!status && p->space.uses_t)
            status = assemble(f, &p->space, t, f->vector[i], err);
        for (size_t j = 0; j < size; j++)
            f->load[j] += factor * f->vector[i][j];
    }
    if (!status)
        status = value_of(&f->tip_force, 0, t, &tip[0], err);
    if (!status)
        status = value_of(&f->tip_moment, 0, t, &tip[1], err);
    tip[1] /= f->h; /* on h w_x */
    return status;
}

/* ---- initial data ---- */

/* One unknown of all nodes but the clamped one: `unit` times a function of the scene, which other
 * threads may use. */
static enum br_status fill_nodes(struct br_discrete_field *field, size_t unknown, long double unit,
                                 const struct br_function *f, struct br_error *err)
{
    struct br_function own;
    enum br_status status = br_function_clone(f, &own, err);
    for (size_t i = 1; i <= field->n && !status; i++) {
        const double x = (double)field->h * (double)i; /* as the data are given: at doubles */
        long double value = 0;
        status = value_of(&own, x, 0, &value, err);
        field->nodal[field->d * i + unknown] = unit * value;
    }
    br_function_free(&own);
    return status;
}

/* u_1 - u_0; or h^2 w_xx of the Hermite cubic, its mean and its half slope. */
static void strain_of(size_t d, const long double *x, long double *strain)
{
    strain[0] = d == 1 ? x[1] - x[0] : x[3] - x[1];
    if (d == 2)
        strain[1] = 3 * (x[1] + x[3]) - 6 * (x[2] - x[0]);
}

/* The interpolant of the scene's initial data. */
static enum br_status set_initial(struct br_discrete_field *f, const struct br_scene *scene,
                                  struct br_error *err)
{
    const bool axial = f->d == 1;
    const struct br_bending *b = &scene->bending;
    const struct br_function *of[2] = {axial ? &scene->axial.displacement : &b->displacement,
                                       axial ? &scene->axial.velocity : &b->velocity};
    const struct br_function *slope[2] = {&b->displacement_slope, &b->velocity_slope};
    enum br_status status = BR_OK;
    memset(f->nodal, 0, f->d * sizeof *f->nodal);
    for (size_t part = 0; part < 2 && !status; part++) {
        status = fill_nodes(f, 0, 1, of[part], err);
        if (!status && !axial)
            status = fill_nodes(f, 1, f->h, slope[part], err);
        for (size_t i = 0; i < f->n && !status; i++)
            strain_of(f->d, f->nodal + f->d * i, f->state[0] + f->d * (part * f->n + i));
    }
    return status;
}

/* ---- a field ---- */

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
    enum br_status status = room ? BR_OK : br_no_memory(err, "the exact discrete solution");
    if (!status)
        status = take_forces(f, scene, err);
    return status ? status : set_initial(f, scene, err);
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
    br_load_clear(&f->functions);
    br_function_free(&f->tip_force);
    br_function_free(&f->tip_moment);
    for (size_t i = 0; i < BR_LOAD_TERMS; i++)
        free(f->vector[i]);
    *f = (struct br_discrete_field){0};
}

/* ---- a step ---- */

enum br_status br_discrete_field_predict(struct br_discrete_field *f, double t,
                                         long double *velocity, struct br_error *err)
{
    long double tip[MOST] = {0};
    const enum br_status status = update_forces(f, t, tip, err);
    if (status)
        return status;
    if (f->d == 1)
        find_forces(f, 1, tip);
    else
        find_forces(f, 2, tip);
    solve_field(f, f->state[0], f->free_rate);
    *velocity = tip_of(f, f->free_rate);
    return BR_OK;
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
