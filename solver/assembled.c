/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solver/assembled.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "solver/modes.h"
#include "solver/states.h"

struct assembled {
    struct br_system system;
    struct br_states states; /* nodal: displacement, and behind it velocity */
    double *displacement;    /* of the first of them */
    double *velocity;
    double *free_velocity; /* v* */
    double *tip_response;  /* z = A^-1 e_tip, nodal */
    double *rhs;           /* workspace, nodal */
    double loss;   /* of a solve, relative, as br_system_loss has it: the largest of all steps */
    double safety; /* how much more a march may lose, see round_off */
    double usual;  /* loss of a march as br_system_usual_loss has it */
};

/* Index of the tip's displacement in a nodal array. */
static size_t tip_index(const struct assembled *s)
{
    return s->system.field.n * s->system.unknowns;
}

/* Each step's velocity is off by what a solve loses, which inertia keeps for so many steps. */
static double kept(const struct assembled *s, double steps)
{
    return fmin(1 + br_field_inertia(&s->system.field), steps);
}

/* A march that is more than a twentieth off has next to no digit left; near 1 the mass, or what the
 * clamp holds, is not in the factors any more, and steps grow without end. */
static const double most_loss = 0.05, few_steps = 10;

/* What is lost is measured, not predicted: it depends on n, k, damping and the order of elimination
 * by factors of thousands, and only sometimes makes a pivot negative. A force at the tip asks for
 * the softest motion there is, which loses most. */
static enum br_status check_digits(struct assembled *s, struct br_error *err)
{
    const struct br_field *f = &s->system.field;
    double loss = NAN;
    const enum br_status status = br_system_loss(&s->system, s->rhs, s->tip_response, &loss, err);
    if (status)
        return status;
    s->loss = fmax(s->loss, loss);
    const double lost = loss * kept(s, few_steps);
    if (lost <= most_loss)
        return BR_OK;
    return br_fail(
        err, BR_SINGULAR,
        "%s: the %s matrix of n = %zu elements and k = %g s is too ill-conditioned: %.2g "
        "of the velocity is lost in %g steps, expected at most %g; solver riccati has no "
        "such matrix",
        s->system.factoriser->name, f->kind == BR_AXIAL ? "axial" : "bending", f->n, f->k, lost,
        few_steps, most_loss);
}

static enum br_status find_tip_response(struct assembled *s, struct br_error *err)
{
    memset(s->rhs, 0, s->system.nodal * sizeof *s->rhs);
    s->rhs[tip_index(s)] = 1;
    const enum br_status status = br_system_solve(&s->system, s->rhs, s->tip_response, err);
    if (status)
        return status;
    const double compliance = s->tip_response[tip_index(s)];
    if (compliance > 0 && isfinite(compliance))
        return check_digits(s, err);
    return br_fail(err, BR_SINGULAR, "%s: the tip's compliance is %g, expected > 0",
                   s->system.factoriser->name, compliance);
}

/* All that depends on the step's length. */
static enum br_status factorise(struct assembled *s, struct br_error *err)
{
    const enum br_status status = br_system_factorise(&s->system, err);
    return status ? status : find_tip_response(s, err);
}

static void point_at_first(struct assembled *s)
{
    s->displacement = s->states.of[0];
    s->velocity = s->displacement + s->system.nodal;
}

static enum br_status allocate(struct assembled *s, struct br_error *err)
{
    const size_t nodal = s->system.nodal;
    const enum br_status status = br_states_add(&s->states, 2 * nodal, 1, err);
    if (status)
        return status;
    point_at_first(s);
    s->free_velocity = br_allocate(3 * nodal, sizeof *s->free_velocity);
    if (!s->free_velocity)
        return br_no_memory(err, "the stiffness form");
    s->tip_response = s->free_velocity + nodal;
    s->rhs = s->tip_response + nodal;
    return BR_OK;
}

enum br_status br_assembled_create(const struct br_field *field,
                                   const struct br_linear_options *options,
                                   const struct br_factoriser *factoriser, void **self,
                                   struct br_error *err)
{
    struct assembled *s = br_allocate(1, sizeof *s);
    *self = s;
    if (!s)
        return br_no_memory(err, "the stiffness form");
    s->safety = factoriser->refines && options->refinement > 0 ? 15 : 3;
    s->usual = br_system_usual_loss(field, factoriser, options);
    enum br_status status = br_system_init(&s->system, field, options, factoriser, err);
    if (!status)
        status = allocate(s, err);
    return status ? status : factorise(s, err);
}

void br_assembled_free(void *self)
{
    struct assembled *s = self;
    if (!s)
        return;
    br_system_clear(&s->system);
    br_states_clear(&s->states);
    free(s->free_velocity);
    free(s);
}

enum br_status br_assembled_set_step(void *self, double k, struct br_error *err)
{
    struct assembled *s = self;
    s->system.field.k = k;
    return factorise(s, err);
}

/* What is measured is one right side's, at one length of the step; at another, in another stage
 * say, the factors' errors are others, and chance may make any of them small: of 6000 random scenes
 * on up to 12800 elements, in all schemes, the worst lost 30 times as much. So no less than what is
 * usual is predicted, which by the time that inertia keeps it is spread over 1 + inertia solves,
 * and no less a solve than its sums lose. In those scenes some lost 1.7 times the usual. */
double br_assembled_round_off(const void *self, size_t steps)
{
    const struct assembled *s = self;
    const struct br_field *f = &s->system.field;
    const double sums = 16 * DBL_EPSILON, scatter = 3;
    const double usual = fmin(scatter * s->usual, 1) / (1 + br_field_inertia(f)) + sums;
    return fmax(s->safety * s->loss, usual) * kept(s, (double)steps) +
           8 * DBL_EPSILON * ((double)f->n + 1024);
}

double br_assembled_compliance(const void *self)
{
    const struct assembled *s = self;
    return s->tip_response[tip_index(s)];
}

void br_assembled_set(void *self, const double *displacement, const double *velocity)
{
    struct assembled *s = self;
    memcpy(s->displacement, displacement, s->system.nodal * sizeof *displacement);
    memcpy(s->velocity, velocity, s->system.nodal * sizeof *velocity);
}

void br_assembled_get(const void *self, double *displacement, double *velocity)
{
    const struct assembled *s = self;
    const size_t bytes = s->system.nodal * sizeof *displacement;
    if (displacement)
        memcpy(displacement, s->displacement, bytes);
    if (velocity)
        memcpy(velocity, s->velocity, bytes);
}

/* What deforms element i, from nodal values: its elongation or its two curvatures. */
static void strain(const struct assembled *s, const double *nodal, size_t i, double *out)
{
    if (s->system.field.kind == BR_AXIAL)
        out[0] = nodal[i + 1] - nodal[i];
    else
        br_curvature(nodal + 2 * i, out);
}

void br_assembled_strain_rate(const void *self, double *rate)
{
    const struct assembled *s = self;
    for (size_t i = 0; i < s->system.field.n; i++)
        strain(s, s->velocity, i, rate + i * s->system.unknowns);
}

/* rhs = factor F + tip + M v/k - K w */
static void form_rhs(struct assembled *s, const struct br_drive *drive)
{
    const struct br_field *f = &s->system.field;
    for (size_t i = 0; i < s->system.nodal; i++)
        s->rhs[i] = drive->vector ? drive->factor * drive->vector[i] : 0;
    for (size_t c = 0; c < s->system.unknowns; c++)
        s->rhs[tip_index(s) + c] += drive->tip[c];
    br_add_elements(f, f->density / f->k, s->velocity, f->stiffness, s->displacement, s->rhs);
}

enum br_status br_assembled_predict(void *self, const struct br_drive *drive, double *velocity,
                                    struct br_error *err)
{
    struct assembled *s = self;
    form_rhs(s, drive);
    const enum br_status status = br_system_solve(&s->system, s->rhs, s->free_velocity, err);
    *velocity = s->free_velocity[tip_index(s)];
    return status;
}

/* v = v* - r z,  w += k v */
double br_assembled_finish(void *self, double force)
{
    struct assembled *s = self;
    for (size_t i = 0; i < s->system.nodal; i++) {
        s->velocity[i] = s->free_velocity[i] - force * s->tip_response[i];
        s->displacement[i] += s->system.field.k * s->velocity[i];
    }
    return s->velocity[tip_index(s)];
}

double br_assembled_tip_displacement(const void *self)
{
    const struct assembled *s = self;
    return s->displacement[tip_index(s)];
}

/* ---- more states ---- */

enum br_status br_assembled_keep(void *self, size_t count, struct br_error *err)
{
    struct assembled *s = self;
    return br_states_add(&s->states, s->states.size, count, err);
}

void br_assembled_exchange(void *self, size_t a, size_t b)
{
    struct assembled *s = self;
    br_states_exchange(&s->states, a, b);
    point_at_first(s);
}

void br_assembled_combine(void *self, size_t into, size_t count, const double *weight)
{
    struct assembled *s = self;
    br_add_states(s->states.of[into], s->states.size, count, s->states.of, weight);
}

void br_assembled_size(void *self, size_t which, double size[2])
{
    const struct assembled *s = self;
    struct br_view view;
    br_view_field(&view, &s->system.field,
                  BR_STRAIN_RATE); /* the modes of a strain: the same scales */
    for (int part = 0; part < 2; part++) {
        const double *nodal = s->states.of[which] + (part ? s->system.nodal : 0);
        long double squares = 0; /* those of small numbers are lost in double */
        double modes[2];
        for (size_t i = 0; i < s->system.field.n; i++) {
            strain(s, nodal, i, modes);
            for (size_t c = 0; c < s->system.unknowns; c++) {
                const long double mode = (long double)view.scale[c] * modes[c];
                squares += mode * mode;
            }
        }
        size[part] = (double)sqrtl(squares);
    }
}
