/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The residual, the laws at the tip and the update of the displacement, as pure numbers. */
#include "reference/certificate/certificate.h"
#include "reference/textbook.h"
#include "solver/scene.h"

#include <float.h>
#include <math.h>
#include <string.h>

typedef long double real;

/* A stage adds up to six velocities with weights up to 8; steps grow by up to 5. */
enum { MOST_WEIGHT = 240 };

/* ---- scalars; each of these passes a NaN on ---- */

double br_worse_of(double a, double b)
{
    return isnan(a) || a > b ? a : b;
}

static double smaller(double a, double b)
{
    return isnan(a) || a < b ? a : b;
}

static double positive(double a)
{
    return br_worse_of(a, 0);
}

static double ratio(double a, double size)
{
    return a == 0 ? 0 : a / size;
}

static double with_last_bit(const struct br_checked_step *s, enum br_field_kind kind,
                            enum br_scale scale, double size)
{
    if (!s->largest)
        return size;
    double *largest = &s->largest[kind][scale];
    *largest = br_worse_of(size, *largest);
    return br_worse_of(size, DBL_EPSILON * *largest);
}

/* a over a size, or over the last bit of the largest such size so far (in/out: in the step) if that
 * is larger; 0 for 0. */
static double over_scale(const struct br_checked_step *s, enum br_field_kind kind,
                         enum br_scale scale, double a, double size)
{
    return ratio(a, with_last_bit(s, kind, scale, size));
}

/* Largest magnitude of count values. */
static double magnitude(const double *x, size_t count)
{
    double most = 0;
    for (size_t i = 0; i < count; i++)
        most = br_worse_of(fabs(x[i]), most);
    return most;
}

static size_t size_of(const struct br_checked_step *s, enum br_field_kind kind)
{
    return br_step_unknowns(s->method, kind) * (s->n + 1);
}

static double at_tip(const struct br_checked_step *s, enum br_field_kind kind, const double *nodal)
{
    return nodal[s->n * br_step_unknowns(s->method, kind)];
}

/* The size to which displacements are rounded; over k, that of velocities, which a solver finds
 * from differences of displacements. */
static double field_scale(const struct br_checked_step *s, enum br_field_kind kind)
{
    const size_t size = size_of(s, kind);
    const struct br_step_field *f = &s->field[kind];
    return magnitude(f->displacement, size) + magnitude(f->displacement_before, size) +
           s->k * (magnitude(f->velocity, size) + magnitude(f->velocity_before, size));
}

/* The distance that a force moves the tip in the step, m, at most: that without mass. */
static double static_distance(const struct br_checked_step *s, enum br_field_kind kind,
                              double force)
{
    const struct br_scene *c = s->scene;
    const double length = c->length;
    const double still =
        kind == BR_AXIAL
            ? length / (c->axial.viscosity + s->k * c->axial.stiffness)
            : length * length * length / 3 / (c->bending.viscosity + s->k * c->bending.stiffness);
    return s->k * smaller(s->compliance[kind], still) * fabs(force);
}

/* Error of u_n = u_{n-1} + k v_n, and of the stated velocity of the tip. */
static double update_error(const struct br_checked_step *s, enum br_field_kind kind)
{
    if (!s->scene->field[kind].modelled)
        return 0;
    const size_t size = size_of(s, kind);
    const struct br_step_field *f = &s->field[kind];
    double most = 0;
    for (size_t i = 0; i < size; i++) {
        const real error =
            (real)f->displacement[i] - f->displacement_before[i] - (real)s->k * f->velocity[i];
        most = br_worse_of((double)fabsl(error), most);
    }
    const double stated = fabs(s->tip.velocity[kind] - at_tip(s, kind, f->velocity));
    return over_scale(s, kind, BR_SCALE_FIELD, br_worse_of(most, s->k * stated),
                      field_scale(s, kind));
}

static double tip_displacement_error(const struct br_checked_step *s)
{
    if (!s->scene->axial.modelled)
        return s->tip.displacement == 0 ? 0 : NAN;
    const double *u = s->field[BR_AXIAL].displacement;
    return over_scale(s, BR_AXIAL, BR_SCALE_FIELD,
                      fabs(s->tip.displacement - at_tip(s, BR_AXIAL, u)),
                      magnitude(u, size_of(s, BR_AXIAL)));
}

/* Velocities are sums of increments: the rounding errors of the velocities that a step starts from
 * stay in its own velocity, m/s. */
static double velocity_round_off(const struct br_checked_step *s, enum br_field_kind kind)
{
    const size_t size = size_of(s, kind);
    const struct br_step_field *f = &s->field[kind];
    const double own =
        br_worse_of(magnitude(f->velocity, size), magnitude(f->velocity_before, size));
    return MOST_WEIGHT * DBL_EPSILON * br_worse_of(own, s->speed[kind]);
}

/* Error of the force c_H (u - g), for any sign of the depth, less the round-off of velocities. */
static double force_error(const struct br_checked_step *s, double force, double wanted)
{
    const double way = s->k * velocity_round_off(s, BR_AXIAL);
    return positive(fabs(force - wanted) - br_contact_stiffness(&s->scene->contact) * way);
}

/* The scale of a contact force, N. */
static double contact_scale(const struct br_checked_step *s, double force)
{
    const struct br_contact *c = &s->scene->contact;
    const double ways = field_scale(s, BR_AXIAL) + static_distance(s, BR_AXIAL, force);
    return fabs(force) + br_contact_stiffness(c) * (ways + c->gap);
}

/* (10): at u_{n-1} or u_n, as the method's contact rule has it. */
static double contact_error(const struct br_checked_step *s)
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
    const double wanted = br_contact_stiffness(c) * positive(at_tip(s, BR_AXIAL, u) - c->gap);
    return over_scale(s, BR_AXIAL, BR_SCALE_LAW, force_error(s, force, wanted),
                      contact_scale(s, force));
}

/* u(L) - g at the time of a stage of the bending field. */
static double depth_of(const struct br_checked_step *s)
{
    const double u =
        s->axial_tip ? *s->axial_tip : at_tip(s, BR_AXIAL, s->field[BR_AXIAL].displacement);
    return u - s->scene->contact.gap;
}

static double tresca(const struct br_friction *f, double depth)
{
    (void)depth;
    return f->coefficient;
}

static double coulomb(const struct br_friction *f, double depth)
{
    return f->coefficient * depth;
}

static double coulomb_slope(const struct br_friction *f)
{
    return f->coefficient;
}

/* The bounds, once more than solver/laws.c has them: a check may not use what it checks. A law
 * without a row gets NaN, which passes no check. `steepest`: the most that a bound grows with the
 * depth, N/m; NULL: it does not follow it. */
static const struct {
    double (*bound)(const struct br_friction *friction, double depth);
    double (*steepest)(const struct br_friction *friction);
} friction_laws[BR_FRICTION_LAWS] = {
    [BR_TRESCA] = {tresca, NULL}, [BR_COULOMB] = {coulomb, coulomb_slope}};

/* h at that depth, which is not positive where there is no contact. */
static double bound_at(const struct br_checked_step *s, double depth)
{
    const struct br_friction *f = &s->scene->friction;
    return friction_laws[f->law].bound ? friction_laws[f->law].bound(f, depth) : NAN;
}

/* h(t_n), from the nodal u_n. */
static double bound_of(const struct br_checked_step *s)
{
    const bool follows = friction_laws[s->scene->friction.law].steepest;
    return bound_at(s, follows ? positive(depth_of(s)) : 0);
}

/* How the bound follows the depth, N/m. */
static double steepness(const struct br_checked_step *s)
{
    const struct br_friction *f = &s->scene->friction;
    return friction_laws[f->law].steepest ? friction_laws[f->law].steepest(f) : 0;
}

/* Distance of the bound from `wanted`, N, less the round-off of the axial velocities: the march has
 * the depth from its contact force, the certificate from the nodes. */
static double bound_error(const struct br_checked_step *s, double wanted)
{
    const double left =
        steepness(s) > 0 ? steepness(s) * s->k * velocity_round_off(s, BR_AXIAL) : 0;
    return positive(fabs(s->tip.friction_bound - wanted) - left);
}

/* The size to which the bound is rounded where it is found from u_n - g. */
static double bound_scale(const struct br_checked_step *s)
{
    if (!(steepness(s) > 0))
        return 0;
    const double ways =
        field_scale(s, BR_AXIAL) + static_distance(s, BR_AXIAL, s->tip.contact_force);
    return steepness(s) * (ways + s->scene->contact.gap);
}

/* Errors of lambda and of v = v* - lambda z that an iteration may leave, and the round-off of v. */
struct slack {
    double force, speed;
};

/* Distance of (v, lambda), in their own units of size, from the graph of (12): the
 * nearest of stick (v = 0, |lambda| <= h) and slip either way (lambda = +-h). */
static double exact_law(double v, double lambda, double bound, struct slack left)
{
    const double stick =
        br_worse_of(positive(fabs(v) - left.speed), positive(fabs(lambda) - bound));
    const double up =
        br_worse_of(positive(fabs(lambda - bound) - left.force), positive(-v - left.speed));
    const double down =
        br_worse_of(positive(fabs(lambda + bound) - left.force), positive(v - left.speed));
    return smaller(stick, smaller(up, down));
}

/* The same for (29), corrected; mu in the unit of v. */
static double regularised_law(double v, double lambda, double bound, double mu, struct slack left)
{
    const double law = br_worse_of(-bound, smaller(bound * v / mu, bound));
    const double in_force = fabs(lambda - law);
    if (!(fabs(lambda) <= bound) || bound == 0)
        return in_force;
    return smaller(in_force, positive(fabs(v - mu * lambda / bound) - left.speed));
}

/* Checks the march's own bound against that of the nodes, and the law with this bound. */
static double friction_error(const struct br_checked_step *s)
{
    const double lambda = s->tip.friction_force;
    if (s->scene->friction.law == BR_FRICTIONLESS)
        return lambda == 0 ? 0 : NAN;
    const double *nodal = s->field[BR_BENDING].velocity;
    const double ways = field_scale(s, BR_BENDING) + static_distance(s, BR_BENDING, lambda);
    const double speed = with_last_bit(s, BR_BENDING, BR_SCALE_FIELD, ways) / s->k;
    const double bound = bound_of(s);
    const double force = with_last_bit(s, BR_BENDING, BR_SCALE_LAW,
                                       br_worse_of(fabs(lambda), bound) + bound_scale(s));
    const double stated = ratio(bound_error(s, bound), force);
    const double v = ratio(at_tip(s, BR_BENDING, nodal), speed);
    const double l = ratio(lambda, force), b = ratio(s->tip.friction_bound, force);
    const double tolerance = s->method->friction->iterates ? s->method->iteration.tolerance : 0;
    const struct slack left = {tolerance * b, ratio(tolerance * bound * s->compliance[BR_BENDING] +
                                                        velocity_round_off(s, BR_BENDING),
                                                    speed)};
    if (!s->method->friction->needs_regularisation)
        return br_worse_of(stated, exact_law(v, l, b, left));
    if (speed == 0)
        return br_worse_of(stated, fabs(l));
    return br_worse_of(stated,
                       regularised_law(v, l, b, s->scene->friction.regularisation / speed, left));
}

/* ---- branches ---- */

static int contact_branches(const struct br_checked_step *s, double distance[BR_MOST_BRANCHES])
{
    const struct br_contact *c = &s->scene->contact;
    if (!c->modelled || !(br_contact_stiffness(c) > 0))
        return 0;
    const double force = s->tip.contact_force;
    const double depth = at_tip(s, BR_AXIAL, s->field[BR_AXIAL].displacement) - c->gap;
    const double scale = with_last_bit(s, BR_AXIAL, BR_SCALE_LAW, contact_scale(s, force));
    distance[0] = ratio(fabs(force), scale);
    distance[1] = ratio(force_error(s, force, br_contact_stiffness(c) * depth), scale);
    return 2;
}

/* The bound of a contact whose phase is prolonged beyond its end: 0 for an open one. */
static double prolonged_bound(const struct br_checked_step *s)
{
    const bool open = br_contact_stiffness(&s->scene->contact) > 0 && s->tip.contact_force == 0;
    return open ? 0 : bound_at(s, depth_of(s));
}

/* The bound may also be that of a prolonged contact. */
static int friction_branches(const struct br_checked_step *s, double distance[BR_MOST_BRANCHES])
{
    const struct br_scene *scene = s->scene;
    if (scene->friction.law == BR_FRICTIONLESS || s->method->friction->needs_regularisation)
        return 0;
    const double lambda = s->tip.friction_force, bound = s->tip.friction_bound;
    const double ways = field_scale(s, BR_BENDING) + static_distance(s, BR_BENDING, lambda);
    const double speed = with_last_bit(s, BR_BENDING, BR_SCALE_FIELD, ways) / s->k;
    const double force = with_last_bit(s, BR_BENDING, BR_SCALE_LAW,
                                       br_worse_of(fabs(lambda), fabs(bound)) + bound_scale(s));
    double stated = bound_error(s, bound_of(s));
    if (steepness(s) > 0)
        stated = smaller(stated, bound_error(s, prolonged_bound(s)));
    stated = ratio(stated, force);
    const double v = fabs(at_tip(s, BR_BENDING, s->field[BR_BENDING].velocity));
    distance[0] =
        br_worse_of(stated, ratio(positive(v - velocity_round_off(s, BR_BENDING)), speed));
    distance[1] = br_worse_of(stated, ratio(fabs(lambda - bound), force));
    distance[2] = br_worse_of(stated, ratio(fabs(lambda + bound), force));
    return 3;
}

int br_branch_distances(const struct br_checked_step *s, enum br_field_kind kind,
                        double distance[BR_MOST_BRANCHES])
{
    return kind == BR_AXIAL ? contact_branches(s, distance) : friction_branches(s, distance);
}

/* ---- the residual of (27) and (28) ---- */

/* The terms of (27) and (28), whose sum is the residual. The terms of the state before, from which
 * a solver starts, give the size of a motion that stops in this step. */
enum term {
    INERTIA_AFTER,  /*  M v_n / k */
    INERTIA_BEFORE, /* -M v_{n-1} / k */
    VISCOUS,        /*  C v_n */
    ELASTIC,        /*  K w_n */
    RATE_BEFORE,    /*  (C + kK) v_{n-1}, for the size alone */
    ELASTIC_BEFORE, /*  K w_{n-1}, for the size alone */
    RESIDUAL,
    OF_ELEMENTS,        /* the terms before this one have shares of each element */
    LOAD = OF_ELEMENTS, /* -F_n */
    TIP,                /*  the force that resists the tip */
    TERMS
};

/* The forces beyond a point: their sum; for bending their moment about it over h, for a quadratic
 * rod the force on the bubble of the element that ends there. */
struct resultant {
    real force, second; /* N, N */
    real square;        /* of the norm so far: N^2 m, or N^2 m^3 */
};

struct balance {
    const struct br_checked_step *step;
    const struct br_step_field *field;
    const struct br_element *element;
    enum br_field_kind kind;
    size_t unknowns;
    real h, density, stiffness, viscosity, k;
    struct resultant term[TERMS];
};

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
static void element_terms(const struct balance *b, size_t e, real out[OF_ELEMENTS][4])
{
    const struct br_step_field *f = b->field;
    const int *over = b->element->over;
    const real inertia = b->density * b->h / over[BR_MASS] / b->k,
               bent = 1 / (over[BR_STIFFNESS] * (b->kind == BR_AXIAL ? b->h : b->h * b->h * b->h)),
               elastic = b->stiffness * bent, viscous = b->viscosity * bent;
    const struct {
        enum br_element_matrix matrix;
        const double *nodal;
        real factor;
    } terms[] = {
        [INERTIA_AFTER] = {BR_MASS, f->velocity, inertia},
        [INERTIA_BEFORE] = {BR_MASS, f->velocity_before, -inertia},
        [VISCOUS] = {BR_STIFFNESS, f->velocity, viscous},
        [ELASTIC] = {BR_STIFFNESS, f->displacement, elastic},
        [RATE_BEFORE] = {BR_STIFFNESS, f->velocity_before, viscous + b->k * elastic},
        [ELASTIC_BEFORE] = {BR_STIFFNESS, f->displacement_before, elastic},
    };
    memset(out[RESIDUAL], 0, sizeof out[RESIDUAL]);
    for (size_t t = INERTIA_AFTER; t < RESIDUAL; t++) {
        br_element_forces(b->element, terms[t].matrix, terms[t].factor,
                          terms[t].nodal + e * b->unknowns, out[t]);
        for (size_t i = 0; i < 2 * b->unknowns && t <= ELASTIC; i++)
            out[RESIDUAL][i] += out[t][i];
    }
}

static void add_element_node(struct balance *b, real forces[OF_ELEMENTS][4], size_t node)
{
    for (enum term t = INERTIA_AFTER; t < OF_ELEMENTS; t++)
        add_node(b, t, forces[t] + node * b->unknowns, 1);
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

/* Where inertia dominates, a force moves almost nothing but the elements where it acts. A solver's
 * velocities then have errors of r times the largest velocity everywhere, where r is the round-off
 * of inertia. The moments of these errors have the lever of the beam; the moments of the motion
 * have the lever of an element, and are n^2 times less. Measured are 0.17 r and 3 n^2 last bits of
 * largest_inertia, for beams that start bent, n = 21 to 800 and inertia up to 1e25; nothing for a
 * rod, whose lever counts once. */
static double dragged_along(const struct balance *b)
{
    const double nodes = (double)b->step->n + 1, r = b->step->inertia_round_off;
    if (b->kind != BR_BENDING || !(r > 0))
        return 0;
    return fmin(r / 2, 4 * nodes * nodes * DBL_EPSILON) * largest_inertia(b);
}

/* A residual, less the round-off of larger earlier states: where motion and load cross zero at
 * once, all terms are small, but a velocity is still a sum of larger ones. */
static double beyond_rounding(const struct balance *b, double residual)
{
    const double inherited = MOST_WEIGHT * DBL_EPSILON * b->step->size[b->kind];
    return br_worse_of(residual - inherited - dragged_along(b), 0);
}

static double relative_residual(struct balance *b, double tip_force)
{
    const real tip[2] = {tip_force, 0};
    add_node(b, TIP, tip, 1);
    add_node(b, RESIDUAL, tip, 1);
    add_load(b, b->step->n);
    for (size_t e = b->step->n; e-- > 0;) {
        real forces[OF_ELEMENTS][4];
        element_terms(b, e, forces);
        add_element_node(b, forces, 1);
        for (int t = 0; t < TERMS; t++)
            cross_element(b, &b->term[t]);
        add_element_node(b, forces, 0);
        add_load(b, e);
    }
    real size = 0;
    for (int t = 0; t < TERMS; t++)
        size += t == RESIDUAL ? 0 : sqrtl(b->term[t].square);
    const double residual = (double)sqrtl(b->term[RESIDUAL].square);
    if (b->step->size_now)
        b->step->size_now[b->kind] = (double)size;
    return over_scale(b->step, b->kind, BR_SCALE_RESIDUAL, beyond_rounding(b, residual),
                      (double)size);
}

/* The residual of (27) or (28), relative; 0 where the field is not modelled. */
static double residual_of(const struct br_checked_step *s, enum br_field_kind kind)
{
    if (!s->scene->field[kind].modelled)
        return 0;
    struct balance b = {
        .step = s,
        .field = &s->field[kind],
        .kind = kind,
        .element = br_element_of(kind, s->method->axial_degree),
        .unknowns = br_step_unknowns(s->method, kind),
        .h = (real)s->scene->length / (real)s->n,
        .density = s->scene->density,
        .stiffness = s->scene->field[kind].stiffness,
        .viscosity = s->scene->field[kind].viscosity,
        .k = s->k,
    };
    return relative_residual(&b, s->tip.force[kind]);
}

/* ---- a step ---- */

static bool finite_field(const struct br_checked_step *s, enum br_field_kind kind)
{
    const double *tip[] = {&s->tip.displacement, &s->tip.contact_force, &s->tip.friction_force,
                           &s->tip.friction_bound};
    bool good = isfinite(s->tip.velocity[kind]);
    for (int i = 0; i < 2; i++)
        good = good && isfinite(*tip[kind == BR_AXIAL ? i : 2 + i]);
    if (!s->scene->field[kind].modelled)
        return good;
    const struct br_step_field *f = &s->field[kind];
    const double *arrays[] = {f->displacement_before, f->displacement, f->velocity_before,
                              f->velocity, f->load};
    for (size_t a = 0; a < sizeof arrays / sizeof *arrays; a++)
        good = good && isfinite(magnitude(arrays[a], size_of(s, kind)));
    return good;
}

struct br_certificate br_certify_field(const struct br_checked_step *s, enum br_field_kind kind)
{
    if (!finite_field(s, kind))
        return (struct br_certificate){NAN, NAN, NAN, NAN, NAN};
    if (kind == BR_AXIAL)
        return (struct br_certificate){
            .axial_residual = residual_of(s, BR_AXIAL),
            .update = br_worse_of(tip_displacement_error(s), update_error(s, BR_AXIAL)),
            .contact = contact_error(s),
        };
    return (struct br_certificate){
        .bending_residual = residual_of(s, BR_BENDING),
        .update = update_error(s, BR_BENDING),
        .friction = friction_error(s),
    };
}

/* ---- verdicts ---- */

static const char *const entries[BR_CERTIFICATE_ENTRIES] = {
    "the residual of the axial equation (27)", "the residual of the bending equation (28)",
    "the update of the displacement",          "the distance from the friction law (12)",
    "the distance from the contact law (10)",
};

static double entry(const struct br_certificate *c, size_t i)
{
    return (&c->axial_residual)[i];
}

enum br_status br_certificate_check(const struct br_certificate *certificate,
                                    const struct br_certificate *limits, struct br_error *err)
{
    for (size_t i = 0; i < BR_CERTIFICATE_ENTRIES; i++)
        if (!(entry(certificate, i) <= entry(limits, i)))
            return br_fail(err, BR_VERDICT, "%s is %.3g, expected at most %.3g", entries[i],
                           entry(certificate, i), entry(limits, i));
    return BR_OK;
}

void br_certificate_merge(struct br_certificate *worst, const struct br_certificate *other)
{
    double *value = br_certificate_entries(worst);
    for (size_t i = 0; i < BR_CERTIFICATE_ENTRIES; i++)
        value[i] = br_worse_of(value[i], entry(other, i));
}

/* Accuracy of an adaptive step that ends at a switch, relative to the tip's force or displacement;
 * measured: 7e-14. */
static const double switch_accuracy = 1e-12;

/* The first adaptive step is 1e-7 of the duration: in a beam that starts bent, only inertia
 * balances then, and the velocities of riccati have 8 digits. */
static const double small_steps = 64;

/* The laws are scalar, and accurate to some of the tip's last bits; an update or a sum over the
 * nodes is accurate to n of them. */
struct br_certificate br_certificate_limits(const struct br_time_scheme *scheme, size_t n,
                                            double round_off)
{
    const double nodes = (double)n + 1;
    const double sums = 64 * DBL_EPSILON * nodes + round_off;
    const double laws = sums + (scheme->adaptive ? switch_accuracy : 0);
    const double small = scheme->adaptive ? small_steps : 1;
    return (struct br_certificate){
        .axial_residual = 64 * DBL_EPSILON * nodes + 16 * round_off,
        .bending_residual = small * (64 * DBL_EPSILON * nodes * nodes + 16 * round_off),
        .update = sums,
        .friction = laws,
        .contact = laws,
    };
}
