/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Setting a march up. */
#include "solver/damping.h"
#include "solver/march_state.h"
#include "solver/rounding.h"

static enum br_status check_method(const struct br_scene *scene, size_t n, size_t steps,
                                   const struct br_method *method, struct br_error *err)
{
    if (n < 1)
        return br_fail(err, BR_BAD_INPUT, "n is 0, expected at least one element");
    if (steps < 1)
        return br_fail(err, BR_BAD_INPUT, "there are no time steps, expected at least one");
    enum br_status status = br_method_check_scene(method, scene, err);
    if (!status)
        status = br_scene_check(scene, err);
    return status ? status
                  : br_damping_check(method, scene, n, scene->duration / (double)steps, err);
}

static enum br_status create_parts(struct br_march *m, size_t n, struct br_error *err)
{
    struct br_stages stages;
    m->method.scheme->stages(0, &stages);
    const double tau = stages.stage[0].gamma * (m->scene->duration / (double)m->steps);
    enum br_status status = br_march_allow_lead(m, 1, err);
    for (int kind = BR_AXIAL; kind <= BR_BENDING && !status; kind++) {
        struct br_field field = br_field_of_scene(m->scene, (enum br_field_kind)kind, n, tau);
        field.degree = m->method.axial_degree;
        status = br_part_create(&m->part[kind], m->scene, &field, &m->method, err);
    }
    if (!status && m->method.scheme->adaptive)
        status = br_adaptive_create(m, err);
    return status;
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
    const int rounding = br_rounding_set(method->rounding);
    status = create_parts(m, n, err);
    br_rounding_restore(rounding);
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
    br_adaptive_free(m->adaptive);
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        br_part_clear(&m->part[kind]);
    free(m->path);
    free(m);
}

enum br_status br_march_allow_lead(struct br_march *m, size_t steps, struct br_error *err)
{
    if (steps > 1 && br_fields_go_together(m))
        return br_fail(err, BR_BAD_INPUT,
                       "scheme %s: its fields go together, expected a scheme of fixed steps",
                       m->method.scheme->name);
    free(m->path);
    m->lead = steps;
    m->path = br_allocate(steps, sizeof *m->path);
    return m->path ? BR_OK : br_no_memory(err, "a march");
}
