/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solver/march.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "solver/load.h"

struct part {
    bool modelled;
    struct br_field field;
    const struct br_field_solver *solver;
    void *state;
    struct br_step_load load;
    size_t done; /* steps */
};

struct br_march {
    const struct br_scene *scene;
    struct br_method method;
    size_t steps;
    struct part part[2]; /* by br_field_kind */
    struct br_tip tip;
    double *penetration; /* (u_n - g)_+ of the last `lead` steps, m */
    size_t lead;
};

struct br_method br_method_default(void)
{
    return (struct br_method){
        .scheme = br_time_schemes[0],
        .tolerance = 1e-6,
        .solver = br_linear_solvers[0],
        .linear = br_linear_defaults,
        .contact = br_contact_rules[0],
        .friction = br_friction_rules[0],
        .iteration = br_iteration_defaults,
        .axial_degree = 1,
    };
}

/* t_n = n T / N, never summed. */
static double time_level(const struct br_march *m, size_t n)
{
    return m->scene->duration * (double)n / (double)m->steps;
}

/* Evaluated by clones: marches of one scene may be created in different threads. */
static enum br_status interpolate(const struct part *part, const struct br_function *value,
                                  const struct br_function *slope, double *nodal,
                                  struct br_error *err)
{
    struct br_function own = {0}, own_slope = {0};
    enum br_status status = br_function_clone(value, &own, err);
    if (!status && slope)
        status = br_function_clone(slope, &own_slope, err);
    if (!status)
        status = br_interpolate(&part->field, &own, slope ? &own_slope : NULL, nodal, err);
    br_function_free(&own);
    br_function_free(&own_slope);
    return status;
}

static enum br_status set_initial(struct part *part, const struct br_function *displacement,
                                  const struct br_function *displacement_slope,
                                  const struct br_function *velocity,
                                  const struct br_function *velocity_slope, struct br_error *err)
{
    if (br_function_is_zero(displacement) && br_function_is_zero(velocity))
        return BR_OK; /* a solver starts at rest */
    const size_t size = br_field_size(&part->field);
    double *nodal = br_allocate(2 * size, sizeof *nodal);
    if (!nodal)
        return br_no_memory(err, "the initial data");
    enum br_status status = interpolate(part, displacement, displacement_slope, nodal, err);
    if (!status)
        status = interpolate(part, velocity, velocity_slope, nodal + size, err);
    if (!status)
        part->solver->set(part->state, nodal, nodal + size);
    free(nodal);
    return status;
}

/* Names the solvers that have what this one lacks. */
static enum br_status refuse_degree(const struct br_linear_solver *solver, struct br_error *err)
{
    char names[256] = "";
    for (const struct br_linear_solver *const *s = br_linear_solvers; *s; s++)
        if ((*s)->axial_quadratic) {
            const size_t used = strlen(names);
            snprintf(names + used, sizeof names - used, "%s%s", used ? ", " : "", (*s)->name);
        }
    return br_fail(err, BR_BAD_INPUT,
                   "the solver '%s' has no quadratic axial elements, expected one of %s",
                   solver->name, names);
}

static enum br_status create_part(struct br_march *m, enum br_field_kind kind, size_t n,
                                  struct br_error *err)
{
    struct part *part = &m->part[kind];
    const struct br_scene *s = m->scene;
    part->modelled = kind == BR_AXIAL ? s->axial.modelled : s->bending.modelled;
    part->field = br_field_of_scene(s, kind, n, s->duration / (double)m->steps);
    if (kind == BR_AXIAL)
        part->field.degree = m->method.axial_degree;
    if (!part->modelled)
        return BR_OK;
    part->solver = br_linear_solver_for(m->method.solver, &part->field);
    if (!part->solver)
        return refuse_degree(m->method.solver, err);
    enum br_status status =
        part->solver->create(&part->field, &m->method.linear, &part->state, err);
    const struct br_forces forces = br_forces_of_scene(s, kind);
    if (!status)
        status = br_step_load_init(&part->load, &forces, &part->field, err);
    if (status)
        return status;
    if (kind == BR_AXIAL)
        return set_initial(part, &s->axial.displacement, NULL, &s->axial.velocity, NULL, err);
    return set_initial(part, &s->bending.displacement, &s->bending.displacement_slope,
                       &s->bending.velocity, &s->bending.velocity_slope, err);
}

static enum br_status check_method(const struct br_scene *scene, size_t n, size_t steps,
                                   const struct br_method *method, struct br_error *err)
{
    if (n < 1)
        return br_fail(err, BR_BAD_INPUT, "n is 0, expected at least one element");
    if (steps < 1)
        return br_fail(err, BR_BAD_INPUT, "there are no time steps, expected at least one");
    if (method->axial_degree != 1 && method->axial_degree != 2)
        return br_fail(err, BR_BAD_INPUT, "axial elements of degree %d, expected 1 or 2",
                       method->axial_degree);
    if (scene->friction.law != BR_FRICTIONLESS && method->friction->needs_regularisation &&
        !(scene->friction.regularisation > 0))
        return br_fail(err, BR_BAD_INPUT,
                       "friction rule '%s' needs the scene's regularisation, mu > 0",
                       method->friction->name);
    return br_scene_check(scene, err);
}

enum br_status br_march_create(struct br_march **out, const struct br_scene *scene, size_t n,
                               size_t steps, const struct br_method *method, struct br_error *err)
{
    *out = NULL;
    enum br_status status = check_method(scene, n, steps, method, err);
    if (status)
        return status;
    struct br_march *m = br_allocate(1, sizeof *m);
    if (!m)
        return br_no_memory(err, "a march");
    m->scene = scene;
    m->method = *method;
    m->steps = steps;
    status = br_march_allow_lead(m, 1, err);
    for (int kind = BR_AXIAL; kind <= BR_BENDING && !status; kind++)
        status = create_part(m, (enum br_field_kind)kind, n, err);
    if (status) {
        br_march_free(m);
        return status;
    }
    m->tip.displacement = br_march_tip_displacement(m, BR_AXIAL);
    *out = m;
    return BR_OK;
}

void br_march_free(struct br_march *m)
{
    if (!m)
        return;
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        struct part *part = &m->part[kind];
        if (part->solver)
            part->solver->free(part->state);
        br_step_load_clear(&part->load);
    }
    free(m->penetration);
    free(m);
}

enum br_status br_march_allow_lead(struct br_march *m, size_t steps, struct br_error *err)
{
    free(m->penetration);
    m->lead = steps;
    m->penetration = br_allocate(steps, sizeof *m->penetration);
    return m->penetration ? BR_OK : br_no_memory(err, "a march");
}

/* v*: the tip's velocity at t_n with no tip force. */
static enum br_status predict(struct br_march *m, enum br_field_kind kind, double *velocity,
                              struct br_error *err)
{
    struct part *part = &m->part[kind];
    const enum br_status status =
        br_step_load_update(&part->load, &part->field, time_level(m, part->done + 1), err);
    if (status)
        return status;
    const enum br_status predicted =
        part->solver->predict(part->state, &part->load.drive, velocity, err);
    part->load.drive.changed = false;
    return predicted;
}

/* (u_n - g)_+. A contact force at u_n knows it without the loss of a difference. */
static double penetration(const struct br_march *m)
{
    const struct br_contact *contact = &m->scene->contact;
    if (contact->modelled && m->method.contact->at_new_step && contact->stiffness > 0)
        return m->tip.contact_force / contact->stiffness;
    return br_penetration(contact, m->tip.displacement);
}

/* Equation (16), or (27): v_n with the contact force at u_{n-1} or at u_n. */
static enum br_status step_axial(struct br_march *m, struct br_error *err)
{
    struct part *part = &m->part[BR_AXIAL];
    struct br_contact_state contact = {
        .displacement = m->tip.displacement,
        .compliance = part->solver->tip_compliance(part->state),
        .k = part->field.k,
    };
    const enum br_status status = predict(m, BR_AXIAL, &contact.free_velocity, err);
    if (status)
        return status;
    m->tip.contact_force =
        m->scene->contact.modelled ? m->method.contact->force(&m->scene->contact, &contact) : 0;
    m->tip.velocity[BR_AXIAL] = part->solver->finish(part->state, m->tip.contact_force);
    m->tip.displacement = part->solver->tip_displacement(part->state);
    m->penetration[part->done % m->lead] = penetration(m);
    return BR_OK;
}

/* Inequality (17), or (28) and (30): A v + lambda e_tip = rhs with lambda from
 * the friction law, whose bound takes u_n. */
static enum br_status step_bending(struct br_march *m, struct br_error *err)
{
    struct part *part = &m->part[BR_BENDING];
    struct br_friction_state friction = {
        .compliance = part->solver->tip_compliance(part->state),
        .bound = br_friction_bound(m->scene, m->penetration[part->done % m->lead]),
        .regularisation = m->scene->friction.regularisation,
    };
    const enum br_status status = predict(m, BR_BENDING, &friction.free_velocity, err);
    if (status)
        return status;
    m->tip.friction_bound = friction.bound;
    m->tip.friction_force =
        m->scene->friction.law == BR_FRICTIONLESS ? 0 : m->method.friction->force(&friction);
    m->tip.velocity[BR_BENDING] = part->solver->finish(part->state, m->tip.friction_force);
    return BR_OK;
}

/* A march that has left the numbers says so at once. */
static enum br_status check_finite(const struct br_march *m, enum br_field_kind kind,
                                   struct br_error *err)
{
    static const char *const names[] = {"axial", "bending"};
    const struct part *part = &m->part[kind];
    if (isfinite(m->tip.velocity[kind]))
        return BR_OK;
    return br_fail(err, BR_NOT_FINITE,
                   "the march blew up at t = %g s (step %zu of %zu, k = %g s): the %s velocity of "
                   "the tip is %g m/s",
                   time_level(m, part->done), part->done, m->steps, part->field.k, names[kind],
                   m->tip.velocity[kind]);
}

enum br_status br_march_step_field(struct br_march *m, enum br_field_kind kind,
                                   struct br_error *err)
{
    struct part *part = &m->part[kind];
    if (part->modelled) {
        const enum br_status status = kind == BR_AXIAL ? step_axial(m, err) : step_bending(m, err);
        if (status)
            return status;
    }
    part->done++;
    return check_finite(m, kind, err);
}

enum br_status br_march_step(struct br_march *m, struct br_error *err)
{
    const enum br_status status = br_march_step_field(m, BR_AXIAL, err);
    return status ? status : br_march_step_field(m, BR_BENDING, err);
}

size_t br_march_steps_done(const struct br_march *m)
{
    const size_t axial = m->part[BR_AXIAL].done, bending = m->part[BR_BENDING].done;
    return axial < bending ? axial : bending;
}

size_t br_march_field_steps(const struct br_march *m, enum br_field_kind kind)
{
    return m->part[kind].done;
}

double br_march_time(const struct br_march *m)
{
    return time_level(m, br_march_steps_done(m));
}

const struct br_tip *br_march_tip(const struct br_march *m)
{
    return &m->tip;
}

double br_march_tip_displacement(const struct br_march *m, enum br_field_kind kind)
{
    const struct part *part = &m->part[kind];
    return part->modelled ? part->solver->tip_displacement(part->state) : 0;
}

void br_march_get(const struct br_march *m, enum br_field_kind kind, double *displacement,
                  double *velocity)
{
    const struct part *part = &m->part[kind];
    if (part->modelled) {
        part->solver->get(part->state, displacement, velocity);
        return;
    }
    const size_t bytes = br_field_size(&part->field) * sizeof(double);
    if (displacement)
        memset(displacement, 0, bytes);
    if (velocity)
        memset(velocity, 0, bytes);
}

void br_march_strain_rate(const struct br_march *m, enum br_field_kind kind, double *rate)
{
    const struct part *part = &m->part[kind];
    if (part->modelled)
        part->solver->strain_rate(part->state, rate);
    else
        memset(rate, 0, part->field.n * br_field_unknowns(&part->field) * sizeof *rate);
}

const struct br_field *br_march_field(const struct br_march *m, enum br_field_kind kind)
{
    return &m->part[kind].field;
}

bool br_march_models(const struct br_march *m, enum br_field_kind kind)
{
    return m->part[kind].modelled;
}

void br_march_load(const struct br_march *m, enum br_field_kind kind, double *load)
{
    const struct part *part = &m->part[kind];
    const struct br_drive *drive = &part->load.drive;
    const size_t size = br_field_size(&part->field), unknowns = br_field_unknowns(&part->field);
    for (size_t i = 0; i < size; i++)
        load[i] = drive->vector ? drive->factor * drive->vector[i] : 0;
    for (size_t c = 0; c < unknowns; c++)
        load[size - unknowns + c] += drive->tip[c];
}

double br_march_compliance(const struct br_march *m, enum br_field_kind kind)
{
    const struct part *part = &m->part[kind];
    return part->modelled ? part->solver->tip_compliance(part->state) : 0;
}

bool br_march_contact_unstable(const struct br_march *m)
{
    if (!m->scene->contact.modelled || m->method.contact->at_new_step)
        return false;
    const struct br_field *f = &m->part[BR_AXIAL].field;
    const double gain = m->scene->contact.stiffness * f->k * br_march_compliance(m, BR_AXIAL);
    const double limit = 1 + f->viscosity / (f->viscosity + f->k * f->stiffness);
    return !(gain <= (1 + 1e-12) * limit); /* at the limit, whatever the solver's last digits */
}

double br_march_round_off(const struct br_march *m)
{
    double largest = 0;
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        if (m->part[kind].modelled)
            largest =
                fmax(largest, m->method.solver->round_off(&m->part[kind].field, &m->method.linear));
    return largest;
}
