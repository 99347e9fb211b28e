/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solver/ida_laws.h"

#include <math.h>

double br_ida_penetration(const struct br_ida_system *s, const double *y)
{
    if (!s->regime.closed)
        return 0;
    return br_ida_tip_displacement(s, BR_AXIAL, y) - s->scene->contact.gap;
}

double br_ida_bound(const struct br_ida_system *s, const double *y)
{
    return br_friction_bound(s->scene, br_ida_penetration(s, y));
}

/* 1, -1: slips up, down; 0: neither. */
static double direction(const struct br_ida_system *s)
{
    if (s->regime.friction == BR_IDA_SLIP_UP)
        return 1;
    return s->regime.friction == BR_IDA_SLIP_DOWN ? -1 : 0;
}

double br_ida_given_friction(const struct br_ida_system *s, const double *y)
{
    if (s->regime.friction == BR_IDA_STICK && s->mu > 0)
        return br_ida_bound(s, y) * br_ida_tip_velocity(s, BR_BENDING, y) / s->mu;
    return direction(s) * br_ida_bound(s, y);
}

double br_ida_reaction(const struct br_ida_system *s, const double *y, const double *rate,
                       double *size)
{
    const struct br_field *f = &s->field[BR_BENDING];
    const struct br_drive *drive = &s->load[BR_BENDING].drive;
    const size_t values = br_field_size(f);
    double loads = 0, inertia = 0;
    for (size_t i = 2; i < values; i++) {
        const size_t at = br_ida_at(s, BR_BENDING, i / 2) + 2 + i % 2; /* of the velocity */
        if (drive->vector)
            loads += s->cubic[i] * drive->factor * drive->vector[i];
        inertia += s->cubic_mass[i] * rate[at];
    }
    for (size_t c = 0; c < 2; c++)
        loads += s->cubic[values - 2 + c] * drive->tip[c];
    const double spring = 3 / pow(s->scene->length, 3);
    const double elastic = spring * f->stiffness * br_ida_tip_displacement(s, BR_BENDING, y);
    const double viscous = spring * f->viscosity * br_ida_tip_velocity(s, BR_BENDING, y);
    if (size)
        *size = fabs(loads) + fabs(inertia) + fabs(elastic) + fabs(viscous);
    return loads - inertia - elastic - viscous;
}

static double contact_margin(const struct br_ida_system *s, const double *y)
{
    const struct br_contact *contact = &s->scene->contact;
    if (!contact->modelled)
        return 1;
    const double depth = br_ida_tip_displacement(s, BR_AXIAL, y) - contact->gap;
    return s->regime.closed ? depth : -depth;
}

static double friction_margin(const struct br_ida_system *s, const double *y, const double *rate)
{
    const double v = br_ida_tip_velocity(s, BR_BENDING, y);
    switch (s->regime.friction) {
    case BR_IDA_FREE:
        break;
    case BR_IDA_STICK:
        return s->mu > 0 ? s->mu - fabs(v)
                         : br_ida_bound(s, y) - fabs(br_ida_reaction(s, y, rate, NULL));
    case BR_IDA_SLIP_UP:
    case BR_IDA_SLIP_DOWN:
        return direction(s) * v - s->mu;
    }
    return 1;
}

void br_ida_margins(const struct br_ida_system *s, const double *y, const double *rate,
                    double margin[BR_IDA_LAWS])
{
    margin[BR_IDA_CONTACT] = contact_margin(s, y);
    margin[BR_IDA_FRICTION] = friction_margin(s, y, rate);
}

int br_ida_roots(double t, N_Vector y, N_Vector rate, double *margin, void *system)
{
    struct br_ida_system *s = system;
    if (br_ida_load(s, t, &s->err))
        return -1;
    br_ida_margins(s, N_VGetArrayPointer(y), N_VGetArrayPointer(rate), margin);
    return 0;
}

/* lambda as the law has it: what differs by the error of the solution is cut off. */
static double friction_force(const struct br_ida_system *s, const double *y, const double *rate,
                             double bound)
{
    const double force =
        br_ida_sticks(s) ? br_ida_reaction(s, y, rate, NULL) : br_ida_given_friction(s, y);
    if (force > bound)
        return bound;
    return force < -bound ? -bound : force;
}

void br_ida_tip(const struct br_ida_system *s, const double *y, const double *rate,
                struct br_tip *tip)
{
    const struct br_contact *contact = &s->scene->contact;
    const double u = br_ida_tip_displacement(s, BR_AXIAL, y);
    const double depth = s->regime.closed ? br_penetration(contact, u) : 0;
    const double bound = br_friction_bound(s->scene, depth);
    *tip = (struct br_tip){
        .displacement = u,
        .velocity = {br_ida_tip_velocity(s, BR_AXIAL, y), br_ida_tip_velocity(s, BR_BENDING, y)},
        .contact_force = contact->modelled ? contact->stiffness * depth : 0,
        .friction_force = s->modelled[BR_BENDING] ? friction_force(s, y, rate, bound) : 0,
        .friction_bound = bound,
    };
}
