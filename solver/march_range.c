/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whether a march has stayed where double precision has all its digits. */
#include <math.h>

#include "solver/march_state.h"

static const char *const names[] = {"axial", "bending"};

/* Products of a few numbers of this size with those of a matrix are no less than DBL_MIN / eps. */
static const double least_size = 1e-280;

/* Squares of these are doubles, and the next step's values, too. */
const double br_most_size = 1e150;

enum br_status br_march_check_finite(const struct br_march *m, enum br_field_kind kind, double t,
                                     struct br_error *err)
{
    const struct br_tip *tip = &m->tip;
    const struct {
        const char *what, *unit;
        double value;
    } values[] = {
        {"velocity of the tip", "m/s", tip->velocity[kind]},
        {"displacement of the tip", "m", kind == BR_AXIAL ? tip->displacement : 0},
        {"force on the tip", "N", kind == BR_AXIAL ? tip->contact_force : tip->friction_force},
    };
    for (size_t i = 0; i < sizeof values / sizeof *values; i++)
        if (!(fabs(values[i].value) <= br_most_size))
            return br_fail(err, BR_NOT_FINITE,
                           "the march blew up at t = %g s (step %zu of %zu, k = %g s): the %s %s "
                           "is %g %s",
                           t, m->part[kind].done, m->steps, m->scene->duration / (double)m->steps,
                           names[kind], values[i].what, values[i].value, values[i].unit);
    return BR_OK;
}

/* A tip that is finite may have elements behind it that are not yet seen there. */
static enum br_status check_elements(const struct br_march *m, enum br_field_kind kind,
                                     struct br_error *err)
{
    const struct br_part *part = &m->part[kind];
    double size[2];
    part->solver->size(part->state, 0, size);
    if (isfinite(size[0]) && isfinite(size[1]))
        return BR_OK;
    return br_fail(err, BR_NOT_FINITE,
                   "the march blew up by t = %g s: the %s strain is %g, its rate %g 1/s",
                   m->scene->duration, names[kind], size[0], size[1]);
}

/* What a field's own operator answers to a nodal displacement with, N/m: R of plain.h, and mass. */
static long double resistance(const struct br_field *f)
{
    const long double h = f->h,
                      stiff = (long double)f->viscosity + (long double)f->k * f->stiffness;
    const long double volume = f->kind == BR_AXIAL ? h : h * h * h;
    return stiff / volume + f->density * h / f->k;
}

/* Where nothing but forces and data far below the others' sizes moves a field, it has few digits,
 * or none. What only decays to there has them, relative to what it was. */
static enum br_status check_underflow(const struct br_part *part, struct br_error *err)
{
    const long double r = resistance(&part->field), force = part->moved_by;
    const long double motion = fmaxl(force / r * fminl(part->field.k, 1), part->started_with);
    const long double smaller = fminl(fmaxl(force, r * part->started_with), motion);
    if (motion == 0 || smaller >= least_size)
        return BR_OK;
    return br_fail(err, BR_NOT_FINITE,
                   "the %s motion is lost to underflow: its largest nodal force is %Lg N and its "
                   "largest initial value %g m, which is to move an element by about %Lg m, "
                   "expected no less than %g: choose smaller units",
                   names[part->field.kind], force, part->started_with, motion, least_size);
}

enum br_status br_march_check_range(const struct br_march *m, enum br_field_kind kind,
                                    struct br_error *err)
{
    if (!m->part[kind].solver)
        return BR_OK;
    const enum br_status status = check_elements(m, kind, err);
    return status ? status : check_underflow(&m->part[kind], err);
}
