/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/foresee/load_mesh.h"

#include <math.h>

#define NEAR 0.26923465505284155 /* of the middle: half of the zeros of Legendre's polynomial */
#define FAR 0.45308992296933200

const double br_load_place[BR_LOAD_PLACES] = {0.5 - FAR, 0.5 - NEAR, 0.5, 0.5 + NEAR, 0.5 + FAR};
const double br_load_weight[BR_LOAD_PLACES] = {0.11846344252809454, 0.23931433524968324, 64.0 / 225,
                                               0.23931433524968324, 0.11846344252809454};

void br_load_values(const struct br_function *f, enum br_variable along, struct br_box box,
                    struct br_interval piece, double value[BR_LOAD_PLACES])
{
    double place[BR_LOAD_PLACES];
    for (int i = 0; i < BR_LOAD_PLACES; i++)
        place[i] = piece.low + (piece.high - piece.low) * br_load_place[i];
    if (along == BR_X)
        br_function_evaluate(f, BR_LOAD_PLACES, place, box.t.low, value);
    for (int i = 0; i < BR_LOAD_PLACES && along == BR_T; i++)
        br_function_evaluate(f, 1, &box.x.low, place[i], &value[i]);
}

static double integral_of_size(const struct br_function *f, enum br_variable along,
                               struct br_box box, const struct br_mesh *m)
{
    double sum = 0, value[BR_LOAD_PLACES];
    for (size_t i = 0; i < m->count; i++) {
        br_load_values(f, along, box, (struct br_interval){m->at[i], m->at[i + 1]}, value);
        for (int k = 0; k < BR_LOAD_PLACES; k++)
            sum += (m->at[i + 1] - m->at[i]) * br_load_weight[k] * fabs(value[k]);
    }
    return sum;
}

enum br_status br_load_mesh(const struct br_function *f, enum br_variable along, struct br_box box,
                            struct br_mesh *mesh, double *size, struct br_error *err)
{
    enum { DEGREE = 8, ROUNDS = 6 };
    const struct br_interval all = along == BR_X ? box.x : box.t;
    struct br_interval values;
    struct br_box peak;
    enum br_status status = BR_OK;
    *mesh = (struct br_mesh){0};
    if (!br_enclose_values(f, box, 0, &values, &peak))
        return br_fail(err, BR_BAD_INPUT, "it cannot be bounded");
    const double most = fmax(fabs(values.low), fabs(values.high)), width = all.high - all.low;
    struct br_mesh_aim aim = {.degree = DEGREE, .tolerance = 1e-3 * most};
    for (int i = 0; i < ROUNDS && !status; i++) {
        br_mesh_free(mesh);
        status = br_resolve(f, along, box, &aim, mesh, err);
        *size = status ? 0 : integral_of_size(f, along, box, mesh);
        if ((aim.tolerance * width <= 0.01 * *size && mesh->missed <= 0.01 * *size) || most == 0)
            return status;
        aim.tolerance = fmin(fmax(0.005 * *size / width, 1e-6 * aim.tolerance), aim.tolerance / 8);
    }
    if (!status)
        br_mesh_free(mesh);
    return status ? status : br_fail(err, BR_BAD_INPUT, "it cannot be resolved");
}
