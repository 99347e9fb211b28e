/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solver/march.h"

#include <math.h>

#include "solver/arithmetic.h"
#include "solver/laws.h"
#include "solver/march_state.h"
#include "solver/method.h"

/* ---- set-up ---- */

enum br_status br_march_check(const struct br_scene *scene, size_t n, size_t steps,
                              const struct br_method *method, struct br_error *err)
{
    if (n < 1)
        return br_fail(err, BR_BAD_INPUT, "n is 0, expected at least one element");
    if (steps < 1)
        return br_fail(err, BR_BAD_INPUT, "there are no time steps, expected at least one");
    enum br_status status = br_method_check(method, scene, err);
    if (!status)
        status = br_scene_check(scene, err);
    return status ? status
                  : br_damping_check(method, scene, n, scene->duration / (double)steps, err);
}

static enum br_status create_fields(struct br_march *m, size_t n, struct br_error *err)
{
    struct br_stages stages;
    br_time_scheme_step(m->method.scheme, 0, &stages);
    const double tau = stages.stage[0].gamma * (m->scene->duration / (double)m->steps);
    enum br_status status = br_march_allow_lead(m, 1, err);
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING && !status; kind++) {
        const struct br_field field =
            br_field_of_scene(m->scene, kind, n, tau, m->method.axial_degree);
        status = br_field_march_create(&m->field[kind], m->scene, &field, &m->method, err);
    }
    if (!status && m->method.scheme->adaptive)
        status = br_adaptive_create(m, err);
    return status;
}

/* The tip at t = 0. */
static enum br_status find_start(struct br_march *m, size_t n, struct br_error *err)
{
    const struct br_scene *scene = m->scene;
    double *velocity = br_allocate(2 * (n + 1), sizeof *velocity);
    if (!velocity)
        return br_no_memory(err, "the tip's start");
    m->tip.displacement = br_march_tip_displacement(m, BR_AXIAL);
    const struct br_contact *contact = &scene->contact;
    const double u = m->tip.displacement;
    m->start = (struct br_tip){
        .displacement = u,
        .contact_force = contact->modelled ? br_contact_force(contact, u) : 0,
        .friction_force = scene->friction.law == BR_FRICTIONLESS ? 0 : NAN,
        .friction_bound = br_friction_bound(scene, br_penetration(contact, u)),
    };
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        br_march_get(m, kind, NULL, velocity);
        m->start.velocity[kind] = velocity[n * br_field_unknowns(&m->field[kind].field)];
    }
    free(velocity);
    return BR_OK;
}

enum br_status br_march_create(struct br_march **out, const struct br_scene *scene, size_t n,
                               size_t steps, const struct br_method *method, struct br_error *err)
{
    *out = NULL;
    enum br_status status = br_march_check(scene, n, steps, method, err);
    if (status)
        return status;
    struct br_march *m = br_allocate(1, sizeof *m);
    if (!m)
        return br_no_memory(err, "a march");
    m->scene = scene;
    m->method = *method;
    m->steps = steps;
    status = create_fields(m, n, err);
    if (!status)
        status = find_start(m, n, err);
    if (status) {
        br_march_free(m);
        return status;
    }
    *out = m;
    return BR_OK;
}

void br_march_free(struct br_march *m)
{
    if (!m)
        return;
    free(m->adaptive);
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        br_field_march_clear(&m->field[kind]);
    free(m->path);
    free(m);
}

enum br_status br_march_allow_lead(struct br_march *m, size_t steps, struct br_error *err)
{
    if (steps > 1 && m->method.scheme->adaptive)
        return br_fail(err, BR_BAD_INPUT,
                       "scheme %s: its fields go together, expected a scheme of fixed steps",
                       m->method.scheme->name);
    free(m->path);
    m->lead = steps;
    m->path = br_allocate(steps, sizeof *m->path);
    return m->path ? BR_OK : br_no_memory(err, "a march");
}

/* t_n = n T / N, without a sum of steps. */
static double time_level(const struct br_march *m, size_t n)
{
    return m->scene->duration * (double)n / (double)m->steps;
}

/* ---- stepping ---- */

static enum br_status fixed_step(struct br_march *m, enum br_field_kind kind, struct br_error *err)
{
    struct br_field_march *fm = &m->field[kind];
    const struct br_step step = {time_level(m, fm->done), time_level(m, fm->done + 1),
                                 m->scene->duration / (double)m->steps};
    struct br_stages stages;
    br_time_scheme_step(m->method.scheme, fm->since, &stages);
    const enum br_status status =
        br_march_stages(m, kind, &stages, &step, &m->path[fm->done % m->lead], err);
    if (status)
        return status;
    const enum br_regime before = m->regime[kind];
    m->regime[kind] = br_march_regime(m, kind);
    br_march_accept(m, kind, &stages, fm->counts.steps > 0 && m->regime[kind] != before);
    return BR_OK;
}

static enum br_status step_field(struct br_march *m, enum br_field_kind kind, struct br_error *err)
{
    struct br_field_march *fm = &m->field[kind];
    enum br_status status = BR_OK;
    if (m->adaptive && kind == BR_AXIAL) /* both fields */
        status = br_adaptive_advance(m, err);
    else if (!m->adaptive && fm->modelled)
        status = fixed_step(m, kind, err);
    if (status)
        return status;
    fm->done++;
    status = br_march_check_finite(m, kind, time_level(m, fm->done), err);
    return status || fm->done < m->steps ? status : br_march_check_range(m, kind, err);
}

enum br_status br_march_step_field(struct br_march *m, enum br_field_kind kind,
                                   struct br_error *err)
{
    const int traps = br_traps_set();
    const enum br_status status = step_field(m, kind, err);
    br_traps_restore(traps);
    return status;
}

enum br_status br_march_step(struct br_march *m, struct br_error *err)
{
    const enum br_status status = br_march_step_field(m, BR_AXIAL, err);
    return status ? status : br_march_step_field(m, BR_BENDING, err);
}

void br_march_stop_when(struct br_march *m, bool (*stop)(void *self), void *self)
{
    m->stop = stop;
    m->stop_self = self;
}

/* ---- looking ---- */

size_t br_march_steps_done(const struct br_march *m)
{
    const size_t axial = m->field[BR_AXIAL].done, bending = m->field[BR_BENDING].done;
    return axial < bending ? axial : bending;
}

size_t br_march_field_steps(const struct br_march *m, enum br_field_kind kind)
{
    return m->field[kind].done;
}

double br_march_time(const struct br_march *m)
{
    return time_level(m, br_march_steps_done(m));
}

void br_march_sample(const struct br_march *march, enum br_field_kind kind, enum br_measure measure,
                     struct br_view *view)
{
    br_view_field(view, br_march_field(march, kind), measure);
    switch (measure) {
    case BR_DISPLACEMENT:
        br_march_get(march, kind, view->values, NULL);
        return;
    case BR_VELOCITY:
        br_march_get(march, kind, NULL, view->values);
        return;
    case BR_STRAIN_RATE:
        br_march_strain_rate(march, kind, view->values);
        return;
    case BR_TIP:
    case BR_MEASURES:
        break;
    }
    *view->values = br_march_tip_displacement(march, kind);
}
