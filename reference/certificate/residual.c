/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The residual of (27) and (28), in the norm of certificate.h. */
#include "reference/certificate/certificate.h"
#include "reference/textbook.h"

#include <float.h>
#include <math.h>

typedef long double real;

/* The terms of (27) and (28), whose sum is the residual; and those of the state before,
 * which a solver starts from, for the size of a motion that stops in this step. */
enum term {
    INERTIA_AFTER,  /*  M v_n / k */
    INERTIA_BEFORE, /* -M v_{n-1} / k */
    VISCOUS,        /*  C v_n */
    ELASTIC,        /*  K w_n */
    RATE_BEFORE,    /*  (C + kK) v_{n-1}, for the size alone */
    ELASTIC_BEFORE, /*  K w_{n-1}, for the size alone */
    LOAD,           /* -F_n */
    TIP,            /*  the force that resists the tip */
    RESIDUAL,
    TERMS
};

/* The forces beyond a point: their sum; for bending their moment about it over h, for a quadratic
 * rod the force on the bubble of the element that ends there. */
struct resultant {
    real force, second; /* N, N */
    real square;        /* of the norm so far: N^2 m, or N^2 m^3 */
};

struct balance {
    const struct br_step *step;
    const struct br_step_field *field;
    enum br_field_kind kind;
    bool quadratic;
    size_t unknowns;
    real h, density, stiffness, viscosity, k;
    struct resultant term[TERMS];
};

/* ---- element matrices ---- */

/* A quadratic rod is taken by its nodes here: begin, middle, end, less a rigid motion. The unknowns
 * of the march are (u, b) a node, with u = chord - b/4 in the middle. */
static void quadratic_times(const int matrix[3][3], real factor, const double *v, real base,
                            real out[4])
{
    const real begin = v[0] - base, end = v[2] - base;
    const real node[3] = {begin, (begin + end) / 2 - (real)v[3] / 4, end};
    real force[3];
    for (int i = 0; i < 3; i++) {
        force[i] = 0;
        for (int j = 0; j < 3; j++)
            force[i] += factor * matrix[i][j] * node[j];
    }
    out[0] = force[0] + force[1] / 2;
    out[1] = 0; /* the bubble before */
    out[2] = force[2] + force[1] / 2;
    out[3] = -force[1] / 4;
}

static void mass_times(const struct balance *b, const double *v, real out[4])
{
    const bool axial = b->kind == BR_AXIAL;
    if (b->quadratic) {
        quadratic_times(br_rod3_mass, b->density * b->h / 30, v, 0, out);
        return;
    }
    const real factor = b->density * b->h / (axial ? 6 : 420);
    for (size_t i = 0; i < 2 * b->unknowns; i++) {
        out[i] = 0;
        for (size_t j = 0; j < 2 * b->unknowns; j++)
            out[i] += factor * (real)(axial ? br_rod_mass[i][j] : br_beam_mass[i][j]) * (real)v[j];
    }
}

/* A rigid motion has no forces, so that of the element's first node is taken off beforehand,
 * exactly but for the last bits: the last two columns remain. */
static void stiffness_times(const struct balance *b, const double *w, real out[4])
{
    if (b->quadratic) {
        quadratic_times(br_rod3_stiffness, 1 / (3 * b->h), w, w[0], out);
        return;
    }
    if (b->kind == BR_AXIAL) {
        const real stretch = ((real)w[1] - w[0]) / b->h;
        out[0] = -stretch;
        out[1] = stretch;
        return;
    }
    const real deflection = ((real)w[2] - w[0]) - w[1], rotation = (real)w[3] - w[1];
    for (int i = 0; i < 4; i++)
        out[i] = (br_beam_stiffness[i][2] * deflection + br_beam_stiffness[i][3] * rotation) /
                 (b->h * b->h * b->h);
}

/* ---- resultants, from the free end to the clamped one ---- */

static void add_node(struct balance *b, enum term term, const real *force, real factor)
{
    struct resultant *r = &b->term[term];
    r->force += factor * force[0];
    if (b->unknowns == 2)
        r->second += factor * force[1];
}

/* Across an element: m(x) = h (second + force (1 - xi)), int m^2 dx = h^3 (...). The normal force
 * that balances a force r on a bubble is 3 r (2 xi - 1). */
static void cross_element(const struct balance *b, struct resultant *r)
{
    if (b->kind == BR_AXIAL) {
        r->square += b->h * (r->force * r->force + 3 * r->second * r->second);
        r->second = 0;
        return;
    }
    const real mean = r->second + r->force / 2;
    r->square += b->h * b->h * b->h * (mean * mean + r->force * r->force / 12);
    r->second += r->force;
}

/* Forces that the terms of element e put on its nodes. */
static void element_terms(const struct balance *b, size_t e, real out[TERMS][4])
{
    const size_t first = e * b->unknowns;
    const struct br_step_field *f = b->field;
    mass_times(b, f->velocity + first, out[INERTIA_AFTER]);
    mass_times(b, f->velocity_before + first, out[INERTIA_BEFORE]);
    stiffness_times(b, f->velocity + first, out[VISCOUS]);
    stiffness_times(b, f->displacement + first, out[ELASTIC]);
    stiffness_times(b, f->velocity_before + first, out[RATE_BEFORE]);
    stiffness_times(b, f->displacement_before + first, out[ELASTIC_BEFORE]);
    for (size_t i = 0; i < 2 * b->unknowns; i++) {
        out[INERTIA_AFTER][i] /= b->k;
        out[INERTIA_BEFORE][i] /= -b->k;
        out[VISCOUS][i] *= b->viscosity;
        out[ELASTIC][i] *= b->stiffness;
        out[RATE_BEFORE][i] *= b->viscosity + b->k * b->stiffness;
        out[ELASTIC_BEFORE][i] *= b->stiffness;
        out[RESIDUAL][i] =
            out[INERTIA_AFTER][i] + out[INERTIA_BEFORE][i] + out[VISCOUS][i] + out[ELASTIC][i];
    }
}

static void add_element_node(struct balance *b, real forces[TERMS][4], size_t node)
{
    static const enum term of_elements[] = {INERTIA_AFTER, INERTIA_BEFORE, VISCOUS, ELASTIC,
                                            RATE_BEFORE,   ELASTIC_BEFORE, RESIDUAL};
    for (size_t i = 0; i < sizeof of_elements / sizeof *of_elements; i++)
        add_node(b, of_elements[i], forces[of_elements[i]] + node * b->unknowns, 1);
}

static void add_load(struct balance *b, size_t node)
{
    const double *load = b->field->load + node * b->unknowns;
    const real force[2] = {load[0], b->unknowns == 2 ? load[1] : 0};
    add_node(b, LOAD, force, -1);
    add_node(b, RESIDUAL, force, -1);
}

/* The norm of the moments that the whole beam's inertia would make with the field's largest
 * velocity: rho v/k (L - x)^2/2. */
static double largest_inertia(const struct balance *b)
{
    const size_t size = b->unknowns * (b->step->n + 1);
    double most = 0;
    for (size_t i = 0; i < size; i++) {
        most = br_worse_of(fabs(b->field->velocity[i]), most);
        most = br_worse_of(fabs(b->field->velocity_before[i]), most);
    }
    const real length = b->h * (real)b->step->n;
    return (double)(b->density * (real)most / b->k * length * length / 2 * sqrtl(length / 5));
}

/* Where inertia rules by far, a force moves the elements where it acts, and almost nothing else. A
 * solver's velocities are then right to the round-off of inertia, r, of the largest, wherever they
 * are: off by so much together, they make moments with the lever of the beam. The motion makes its
 * own with that of an element, which are n^2 times less. Seen are 0.17 r and 3 n^2 last bits of
 * largest_inertia, of beams that start bent, for n = 21 to 800 and inertia up to 1e25; of a rod,
 * whose lever counts once, nothing. */
static double dragged_along(const struct balance *b)
{
    const double nodes = (double)b->step->n + 1, r = b->step->inertia_round_off;
    if (b->kind != BR_BENDING || !(r > 0))
        return 0;
    return fmin(r / 2, 4 * nodes * nodes * DBL_EPSILON) * largest_inertia(b);
}

/* A residual, less what rounding leaves of states that were larger: where motion and load cross
 * zero at once, all terms are small, but a velocity is still a sum of larger ones. */
static double beyond_rounding(const struct balance *b, double residual)
{
    const double inherited = BR_MOST_WEIGHT * DBL_EPSILON * b->step->size[b->kind];
    return br_worse_of(residual - inherited - dragged_along(b), 0);
}

static double relative_residual(struct balance *b, double tip_force)
{
    const real tip[2] = {tip_force, 0};
    add_node(b, TIP, tip, 1);
    add_node(b, RESIDUAL, tip, 1);
    add_load(b, b->step->n);
    for (size_t e = b->step->n; e-- > 0;) {
        real forces[TERMS][4];
        element_terms(b, e, forces);
        add_element_node(b, forces, 1);
        for (int t = 0; t < TERMS; t++)
            cross_element(b, &b->term[t]);
        add_element_node(b, forces, 0);
        add_load(b, e);
    }
    real size = 0;
    for (int t = 0; t < RESIDUAL; t++)
        size += sqrtl(b->term[t].square);
    const double residual = (double)sqrtl(b->term[RESIDUAL].square);
    if (b->step->size_now)
        b->step->size_now[b->kind] = (double)size;
    return br_over_scale(b->step, b->kind, BR_SCALE_RESIDUAL, beyond_rounding(b, residual),
                         (double)size);
}

double br_step_residual(const struct br_step *s, enum br_field_kind kind)
{
    const bool axial = kind == BR_AXIAL;
    if (axial ? !s->scene->axial.modelled : !s->scene->bending.modelled)
        return 0;
    struct balance b = {
        .step = s,
        .field = &s->field[kind],
        .kind = kind,
        .quadratic = axial && s->method->axial_degree == 2,
        .unknowns = br_step_unknowns(s->method, kind),
        .h = (real)s->scene->length / (real)s->n,
        .density = s->scene->density,
        .stiffness = axial ? s->scene->axial.stiffness : s->scene->bending.stiffness,
        .viscosity = axial ? s->scene->axial.viscosity : s->scene->bending.viscosity,
        .k = s->k,
    };
    return relative_residual(&b, axial ? s->tip.contact_force : s->tip.friction_force);
}
