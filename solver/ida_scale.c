/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solver/ida_scale.h"

#include <math.h>

static const double from_rest = 1e-3; /* of the estimate */
static const double nothing = 1e-9;   /* of the length, where there is no load either */
enum { SAMPLES = 32 };

/* The field's displacement, were all of its load at the tip, F L / a1 or F L^3 / (3 a2), but not
 * more than inertia allows by the end, F T^2 / (2 rho L). A viscous one without stiffness creeps as
 * if it had c / T. */
static double estimate(const struct br_ida_system *s, enum br_field_kind kind)
{
    const struct br_field *f = &s->field[kind];
    const struct br_drive *drive = &s->load[kind].drive;
    const size_t unknowns = br_field_unknowns(&s->field[kind]);
    const double length = s->scene->length;
    double force = fabs(drive->tip[0]);
    if (kind == BR_BENDING)
        force += fabs(drive->tip[1]) / (double)f->n; /* moment / L */
    for (size_t i = unknowns; i < br_field_size(f) && drive->vector; i += unknowns)
        force += fabs(drive->factor * drive->vector[i]);
    const double stiffness = f->stiffness + f->viscosity / s->scene->duration;
    const double at_rest = kind == BR_AXIAL ? length / stiffness : pow(length, 3) / (3 * stiffness);
    const double thrown = pow(s->scene->duration, 2) / (2 * f->density * length);
    return force * fmin(at_rest, thrown);
}

static void set_field(struct br_ida_scale *scale, enum br_field_kind kind, double displacement)
{
    const struct br_ida_system *s = scale->system;
    const size_t unknowns = br_field_unknowns(&s->field[kind]);
    double *const at = scale->largest + s->at[kind];
    for (size_t c = 0; c < unknowns; c++) {
        const double slope = c == 1 ? 1 / (double)s->field[kind].n : 1; /* h w_x, h = L/n */
        at[c] = fmax(at[c], slope * displacement);
        at[unknowns + c] = fmax(at[unknowns + c], slope * displacement / s->scene->duration);
    }
}

enum br_status br_ida_scale_init(struct br_ida_scale *scale, struct br_ida_system *system,
                                 double tolerance, struct br_error *err)
{
    *scale = (struct br_ida_scale){.system = system, .tolerance = tolerance};
    double largest[2] = {0};
    for (int sample = 0; sample <= SAMPLES; sample++) {
        const double t = system->scene->duration * sample / SAMPLES;
        const enum br_status status = br_ida_load(system, t, err);
        if (status)
            return status;
        for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++)
            if (system->modelled[kind])
                largest[kind] =
                    fmax(largest[kind], from_rest * estimate(system, (enum br_field_kind)kind));
    }
    if (!isfinite(largest[BR_AXIAL] + largest[BR_BENDING]))
        return br_fail(err, BR_NOT_FINITE,
                       "scheme ida: the loads are so large that displacements are no numbers");
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        if (system->modelled[kind])
            set_field(scale, (enum br_field_kind)kind,
                      largest[kind] > 0 ? largest[kind] : nothing * system->scene->length);
    return BR_OK;
}

void br_ida_scale_see(struct br_ida_scale *scale, const double *y)
{
    const size_t node = scale->system->node;
    for (size_t i = 0; i < scale->system->count; i += node)
        for (size_t c = 0; c < node; c++)
            scale->largest[c] = fmax(scale->largest[c], fabs(y[i + c]));
}

void br_ida_scale_weights(const struct br_ida_scale *scale, double *weight)
{
    const struct br_ida_system *s = scale->system;
    for (size_t i = 0; i < s->count; i += s->node)
        for (size_t c = 0; c < s->node; c++)
            weight[i + c] = 1 / (scale->tolerance * scale->largest[c]);
    if (s->mu > 0 && s->regime.friction == BR_IDA_STICK) /* creeps, by mu at most */
        weight[br_ida_tip_row(s, BR_BENDING)] =
            1 / (scale->tolerance * fmin(s->mu, br_ida_scale_of_tip(scale, BR_BENDING, 1)));
}

double br_ida_scale_of_tip(const struct br_ida_scale *scale, enum br_field_kind kind,
                           int derivative)
{
    const size_t unknowns = br_field_unknowns(&scale->system->field[kind]);
    return scale->largest[scale->system->at[kind] + (derivative ? unknowns : 0)];
}
