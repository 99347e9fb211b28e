/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/certificate.h"

#include <float.h>
#include <math.h>
#include <string.h>

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

/* Values of a node. */
static size_t unknowns_of(const struct br_method *method, enum br_field_kind kind)
{
    return kind == BR_AXIAL && method->axial_degree != 2 ? 1 : 2;
}

static size_t size_of(const struct br_step *s, enum br_field_kind kind)
{
    return unknowns_of(s->method, kind) * (s->n + 1);
}

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

/* Rod: rho h/6 [2 1; 1 2], of three nodes rho h/30 [4 2 -1; ...].  Beam, for (w, h w_x): rho h/420
 * [...]. */
static void mass_times(const struct balance *b, const double *v, real out[4])
{
    static const int rod[2][2] = {{2, 1}, {1, 2}};
    static const int beam[4][4] = {
        {156, 22, 54, -13}, {22, 4, 13, -3}, {54, 13, 156, -22}, {-13, -3, -22, 4}};
    static const int three[3][3] = {{4, 2, -1}, {2, 16, 2}, {-1, 2, 4}};
    const bool axial = b->kind == BR_AXIAL;
    if (b->quadratic) {
        quadratic_times(three, b->density * b->h / 30, v, 0, out);
        return;
    }
    const real factor = b->density * b->h / (axial ? 6 : 420);
    for (size_t i = 0; i < 2 * b->unknowns; i++) {
        out[i] = 0;
        for (size_t j = 0; j < 2 * b->unknowns; j++)
            out[i] += factor * (real)(axial ? rod[i][j] : beam[i][j]) * (real)v[j];
    }
}

/* Rod: 1/h [1 -1; -1 1], of three nodes 1/(3h) [7 -8 1; ...].  Beam: 1/h^3 [12 6 -12 6; 6 4 -6 2;
 * ...]. A rigid motion has no forces, so that of the element's first node is taken off beforehand,
 * exactly but for the last bits: the last two columns remain. */
static void stiffness_times(const struct balance *b, const double *w, real out[4])
{
    static const int three[3][3] = {{7, -8, 1}, {-8, 16, -8}, {1, -8, 7}};
    if (b->quadratic) {
        quadratic_times(three, 1 / (3 * b->h), w, w[0], out);
        return;
    }
    if (b->kind == BR_AXIAL) {
        const real stretch = ((real)w[1] - w[0]) / b->h;
        out[0] = -stretch;
        out[1] = stretch;
        return;
    }
    static const int beam[4][2] = {{-12, 6}, {-6, 2}, {12, -6}, {-6, 4}};
    const real deflection = ((real)w[2] - w[0]) - w[1], rotation = (real)w[3] - w[1];
    for (int i = 0; i < 4; i++)
        out[i] = (beam[i][0] * deflection + beam[i][1] * rotation) / (b->h * b->h * b->h);
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
    const real residual = sqrtl(b->term[RESIDUAL].square);
    return residual == 0 && size == 0 ? 0 : (double)(residual / size);
}

static double field_residual(const struct br_step *s, enum br_field_kind kind)
{
    const bool axial = kind == BR_AXIAL;
    if (axial ? !s->scene->axial.modelled : !s->scene->bending.modelled)
        return 0;
    struct balance b = {
        .step = s,
        .field = &s->field[kind],
        .kind = kind,
        .quadratic = axial && s->method->axial_degree == 2,
        .unknowns = unknowns_of(s->method, kind),
        .h = (real)s->scene->length / (real)s->n,
        .density = s->scene->density,
        .stiffness = axial ? s->scene->axial.stiffness : s->scene->bending.stiffness,
        .viscosity = axial ? s->scene->axial.viscosity : s->scene->bending.viscosity,
        .k = s->k,
    };
    return relative_residual(&b, axial ? s->tip.contact_force : s->tip.friction_force);
}

/* ---- scalars; each of these passes a NaN on ---- */

static double larger(double a, double b)
{
    return isnan(a) || a > b ? a : b;
}

static double smaller(double a, double b)
{
    return isnan(a) || a < b ? a : b;
}

static double positive(double a)
{
    return larger(a, 0);
}

static double ratio(double a, double size)
{
    return a == 0 ? 0 : a / size;
}

/* Largest magnitude of count values. */
static double magnitude(const double *x, size_t count)
{
    double most = 0;
    for (size_t i = 0; i < count; i++)
        most = larger(fabs(x[i]), most);
    return most;
}

static bool modelled(const struct br_step *s, enum br_field_kind kind)
{
    return kind == BR_AXIAL ? s->scene->axial.modelled : s->scene->bending.modelled;
}

static double at_tip(const struct br_step *s, enum br_field_kind kind, const double *nodal)
{
    return nodal[s->n * unknowns_of(s->method, kind)];
}

/* What a field's displacements are rounded to; over k, what its velocities are: a solver
 * finds them from differences of displacements. */
static double field_scale(const struct br_step *s, enum br_field_kind kind)
{
    const size_t size = size_of(s, kind);
    const struct br_step_field *f = &s->field[kind];
    return magnitude(f->displacement, size) + magnitude(f->displacement_before, size) +
           s->k * (magnitude(f->velocity, size) + magnitude(f->velocity_before, size));
}

/* u_n = u_{n-1} + k v_n, and the tip's velocity as told. */
static double update_error(const struct br_step *s, enum br_field_kind kind)
{
    if (!modelled(s, kind))
        return 0;
    const size_t size = size_of(s, kind);
    const struct br_step_field *f = &s->field[kind];
    double most = 0;
    for (size_t i = 0; i < size; i++) {
        const real error =
            (real)f->displacement[i] - f->displacement_before[i] - (real)s->k * f->velocity[i];
        most = larger((double)fabsl(error), most);
    }
    const double told = fabs(s->tip.velocity[kind] - at_tip(s, kind, f->velocity));
    return ratio(larger(most, s->k * told), field_scale(s, kind));
}

static double tip_displacement_error(const struct br_step *s)
{
    if (!s->scene->axial.modelled)
        return s->tip.displacement == 0 ? 0 : NAN;
    const double *u = s->field[BR_AXIAL].displacement;
    return ratio(fabs(s->tip.displacement - at_tip(s, BR_AXIAL, u)),
                 magnitude(u, size_of(s, BR_AXIAL)));
}

/* (10): at u_{n-1} or u_n, as the method's contact rule has it. */
static double contact_error(const struct br_step *s)
{
    const struct br_contact *c = &s->scene->contact;
    const double force = s->tip.contact_force;
    if (!c->modelled)
        return force == 0 ? 0 : NAN;
    const struct br_step_field *f = &s->field[BR_AXIAL];
    const double *u = NULL;
    if (strcmp(s->method->contact->name, "lagged") == 0)
        u = f->displacement_before;
    else if (strcmp(s->method->contact->name, "implicit") == 0)
        u = f->displacement;
    else
        return NAN;
    const double wanted = c->stiffness * positive(at_tip(s, BR_AXIAL, u) - c->gap);
    const double scale = fabs(force) + c->stiffness * (field_scale(s, BR_AXIAL) + c->gap);
    return ratio(fabs(force - wanted), scale);
}

/* h(t_n), from the nodal u_n. */
static double bound_of(const struct br_step *s)
{
    const struct br_scene *scene = s->scene;
    if (scene->friction.law == BR_TRESCA)
        return scene->friction.coefficient;
    if (scene->friction.law != BR_COULOMB)
        return 0;
    const double u = at_tip(s, BR_AXIAL, s->field[BR_AXIAL].displacement);
    return scene->friction.coefficient * positive(u - scene->contact.gap);
}

/* What the bound is rounded to, where it is found from u_n - g. */
static double bound_scale(const struct br_step *s)
{
    if (s->scene->friction.law != BR_COULOMB)
        return 0;
    return s->scene->friction.coefficient * (field_scale(s, BR_AXIAL) + s->scene->contact.gap);
}

/* What an iteration may leave: of lambda, and of v = v* - lambda z. */
struct slack {
    double force, speed;
};

/* Distance of (v, lambda), in their own units of size, from the graph of (12): the
 * nearest of stick (v = 0, |lambda| <= h) and slip either way (lambda = +-h). */
static double exact_law(double v, double lambda, double bound, struct slack left)
{
    const double stick = larger(positive(fabs(v) - left.speed), positive(fabs(lambda) - bound));
    const double up =
        larger(positive(fabs(lambda - bound) - left.force), positive(-v - left.speed));
    const double down =
        larger(positive(fabs(lambda + bound) - left.force), positive(v - left.speed));
    return smaller(stick, smaller(up, down));
}

/* The same for (29), corrected; mu in the unit of v. */
static double regularised_law(double v, double lambda, double bound, double mu)
{
    const double law = larger(-bound, smaller(bound * v / mu, bound));
    const double in_force = fabs(lambda - law);
    if (!(fabs(lambda) <= bound) || bound == 0)
        return in_force;
    return smaller(in_force, fabs(v - mu * lambda / bound));
}

static double friction_error(const struct br_step *s)
{
    const double lambda = s->tip.friction_force;
    if (s->scene->friction.law == BR_FRICTIONLESS)
        return lambda == 0 ? 0 : NAN;
    const double *nodal = s->field[BR_BENDING].velocity;
    const double speed = field_scale(s, BR_BENDING) / s->k;
    const double bound = bound_of(s);
    const double force = larger(fabs(lambda), bound) + bound_scale(s);
    const double told = ratio(fabs(s->tip.friction_bound - bound), force);
    const double v = ratio(at_tip(s, BR_BENDING, nodal), speed);
    const double l = ratio(lambda, force), b = ratio(bound, force);
    const double tolerance = s->method->friction->iterates ? s->method->iteration.tolerance : 0;
    const struct slack left = {tolerance * b, ratio(tolerance * bound * s->compliance, speed)};
    if (!s->method->friction->needs_regularisation)
        return larger(told, exact_law(v, l, b, left));
    if (speed == 0)
        return larger(told, fabs(l));
    return larger(told, regularised_law(v, l, b, s->scene->friction.regularisation / speed));
}

static bool all_finite(const struct br_step *s)
{
    bool good = isfinite(s->tip.displacement) && isfinite(s->tip.contact_force) &&
                isfinite(s->tip.friction_force) && isfinite(s->tip.friction_bound);
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        good = good && isfinite(s->tip.velocity[kind]);
        if (!modelled(s, (enum br_field_kind)kind))
            continue;
        const struct br_step_field *f = &s->field[kind];
        const double *arrays[] = {f->displacement_before, f->displacement, f->velocity_before,
                                  f->velocity, f->load};
        for (size_t a = 0; a < sizeof arrays / sizeof *arrays; a++)
            good = good && isfinite(magnitude(arrays[a], size_of(s, (enum br_field_kind)kind)));
    }
    return good;
}

struct br_certificate br_certify(const struct br_step *s)
{
    if (!all_finite(s))
        return (struct br_certificate){NAN, NAN, NAN, NAN, NAN};
    return (struct br_certificate){
        .axial_residual = field_residual(s, BR_AXIAL),
        .bending_residual = field_residual(s, BR_BENDING),
        .update = larger(tip_displacement_error(s),
                         larger(update_error(s, BR_AXIAL), update_error(s, BR_BENDING))),
        .friction = friction_error(s),
        .contact = contact_error(s),
    };
}

/* ---- verdicts ---- */

static const struct {
    const char *what;
    size_t offset;
} entries[] = {
    {"the residual of the axial equation (27)", offsetof(struct br_certificate, axial_residual)},
    {"the residual of the bending equation (28)",
     offsetof(struct br_certificate, bending_residual)},
    {"the update of the displacement", offsetof(struct br_certificate, update)},
    {"the distance from the friction law (12)", offsetof(struct br_certificate, friction)},
    {"the distance from the contact law (10)", offsetof(struct br_certificate, contact)},
};
enum { ENTRIES = sizeof entries / sizeof *entries };

static double entry(const struct br_certificate *c, size_t i)
{
    return *(const double *)((const char *)c + entries[i].offset);
}

enum br_status br_certificate_check(const struct br_certificate *certificate,
                                    const struct br_certificate *limits, struct br_error *err)
{
    for (size_t i = 0; i < ENTRIES; i++)
        if (!(entry(certificate, i) <= entry(limits, i)))
            return br_fail(err, BR_VERDICT, "%s is %.3g, expected at most %.3g", entries[i].what,
                           entry(certificate, i), entry(limits, i));
    return BR_OK;
}

void br_certificate_merge(struct br_certificate *worst, const struct br_certificate *other)
{
    for (size_t i = 0; i < ENTRIES; i++) {
        double *value = (double *)((char *)worst + entries[i].offset);
        *value = larger(*value, entry(other, i));
    }
}

/* The laws are scalar, and right to some of the tip's last bits; an update or a sum
 * over the nodes is right to n of them. */
struct br_certificate br_certificate_limits(size_t n, double round_off)
{
    const double nodes = (double)n + 1;
    const double sums = 64 * DBL_EPSILON * nodes + round_off;
    return (struct br_certificate){
        .axial_residual = 64 * DBL_EPSILON * nodes + 16 * round_off,
        .bending_residual = 64 * DBL_EPSILON * nodes * nodes + 16 * round_off,
        .update = sums,
        .friction = sums,
        .contact = sums,
    };
}

/* ---- the witness ---- */

struct br_witness {
    const struct br_march *march;
    struct br_step step;
    double *before[2][2]; /* displacement and velocity by br_field_kind */
    double *after[2][2];
    double *load[2];
    double *memory;
};

static void look(struct br_witness *w)
{
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        br_march_get(w->march, (enum br_field_kind)kind, w->after[kind][0], w->after[kind][1]);
}

enum br_status br_witness_create(struct br_witness **out, const struct br_march *march,
                                 const struct br_scene *scene, const struct br_method *method,
                                 struct br_error *err)
{
    *out = NULL;
    const struct br_field *field = br_march_field(march, BR_AXIAL);
    struct br_witness *w = br_allocate(1, sizeof *w);
    const size_t unknowns[2] = {unknowns_of(method, BR_AXIAL), unknowns_of(method, BR_BENDING)};
    double *memory = br_allocate(5 * (unknowns[0] + unknowns[1]) * (field->n + 1), sizeof *memory);
    if (!w || !memory) {
        free(w);
        free(memory);
        return br_no_memory(err, "a certificate");
    }
    w->march = march;
    w->memory = memory;
    w->step = (struct br_step){
        .scene = scene,
        .method = method,
        .n = field->n,
        .k = field->k,
        .compliance = br_march_compliance(march, BR_BENDING),
    };
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        double **const arrays[] = {&w->before[kind][0], &w->before[kind][1], &w->after[kind][0],
                                   &w->after[kind][1], &w->load[kind]};
        for (size_t a = 0; a < sizeof arrays / sizeof *arrays; a++) {
            *arrays[a] = memory;
            memory += unknowns[kind] * (field->n + 1);
        }
    }
    look(w);
    *out = w;
    return BR_OK;
}

void br_witness_free(struct br_witness *w)
{
    if (!w)
        return;
    free(w->memory);
    free(w);
}

struct br_certificate br_witness_step(struct br_witness *w)
{
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        for (int i = 0; i < 2; i++) {
            double *const swap = w->before[kind][i];
            w->before[kind][i] = w->after[kind][i];
            w->after[kind][i] = swap;
        }
        br_march_load(w->march, (enum br_field_kind)kind, w->load[kind]);
        w->step.field[kind] =
            (struct br_step_field){w->before[kind][0], w->after[kind][0], w->before[kind][1],
                                   w->after[kind][1], w->load[kind]};
    }
    look(w);
    w->step.tip = *br_march_tip(w->march);
    return br_certify(&w->step);
}
