/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <string.h>

#include "solver/ida_system.h"

/* One function of x at the nodes, into the unknowns behind `at`. Evaluated by clones: marches of
 * one scene may be created in different threads. */
static enum br_status interpolate(const struct br_ida_system *s, enum br_field_kind kind,
                                  const struct br_function *const function[2], double *nodal,
                                  struct br_error *err)
{
    struct br_function own[2] = {0};
    enum br_status status = br_function_clone(function[0], &own[0], err);
    if (!status && function[1])
        status = br_function_clone(function[1], &own[1], err);
    if (!status)
        status = br_interpolate(&s->field[kind], &own[0], function[1] ? &own[1] : NULL, nodal, err);
    br_function_free(&own[0]);
    br_function_free(&own[1]);
    return status;
}

static enum br_status set_field(const struct br_ida_system *s, enum br_field_kind kind,
                                const struct br_function *const function[2][2], double *y,
                                struct br_error *err)
{
    const size_t unknowns = br_field_unknowns(&s->field[kind]);
    double *nodal = br_allocate(br_field_size(&s->field[kind]), sizeof *nodal);
    enum br_status status = nodal ? BR_OK : br_no_memory(err, "the initial data");
    for (size_t part = 0; part < 2 && !status; part++) { /* displacements, velocities */
        status = interpolate(s, kind, function[part], nodal, err);
        for (size_t node = 1; node <= s->field[kind].n && !status; node++)
            memcpy(y + br_ida_at(s, kind, node) + part * unknowns, nodal + unknowns * node,
                   unknowns * sizeof *y);
    }
    free(nodal);
    return status;
}

enum br_status br_ida_initial(const struct br_ida_system *s, double *y, struct br_error *err)
{
    const struct br_axial *a = &s->scene->axial;
    const struct br_bending *b = &s->scene->bending;
    const struct br_function *const axial[2][2] = {{&a->displacement}, {&a->velocity}};
    const struct br_function *const bending[2][2] = {{&b->displacement, &b->displacement_slope},
                                                     {&b->velocity, &b->velocity_slope}};
    enum br_status status = BR_OK;
    if (s->modelled[BR_AXIAL])
        status = set_field(s, BR_AXIAL, axial, y, err);
    if (!status && s->modelled[BR_BENDING])
        status = set_field(s, BR_BENDING, bending, y, err);
    return status;
}
