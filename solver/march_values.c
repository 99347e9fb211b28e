/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a march has come to: its tip, its fields, its costs, and whether their numbers are in range.
 */
#include <float.h>
#include <math.h>
#include <string.h>

#include "solver/laws.h"
#include "solver/march_state.h"
#include "solver/method.h"

const struct br_tip *br_march_tip(const struct br_march *m)
{
    return &m->tip;
}

const struct br_tip *br_march_start(const struct br_march *m)
{
    return &m->start;
}

double br_march_tip_displacement(const struct br_march *m, enum br_field_kind kind)
{
    const struct br_field_march *fm = &m->field[kind];
    return fm->modelled ? fm->solver->tip_displacement(fm->state) : 0;
}

void br_march_get(const struct br_march *m, enum br_field_kind kind, double *displacement,
                  double *velocity)
{
    const struct br_field_march *fm = &m->field[kind];
    if (fm->modelled) {
        fm->solver->get(fm->state, displacement, velocity);
        return;
    }
    const size_t bytes = br_field_size(&fm->field) * sizeof(double);
    if (displacement)
        memset(displacement, 0, bytes);
    if (velocity)
        memset(velocity, 0, bytes);
}

void br_march_strain_rate(const struct br_march *m, enum br_field_kind kind, double *rate)
{
    const struct br_field_march *fm = &m->field[kind];
    if (fm->modelled)
        fm->solver->strain_rate(fm->state, rate);
    else
        memset(rate, 0, fm->field.n * br_field_unknowns(&fm->field) * sizeof *rate);
}

const struct br_field *br_march_field(const struct br_march *m, enum br_field_kind kind)
{
    return &m->field[kind].field;
}

bool br_march_models(const struct br_march *m, enum br_field_kind kind)
{
    return m->field[kind].modelled;
}

void br_march_load(const struct br_march *m, enum br_field_kind kind, double *load)
{
    const struct br_field_march *fm = &m->field[kind];
    const struct br_drive *drive = &fm->load.drive;
    const size_t size = br_field_size(&fm->field), unknowns = br_field_unknowns(&fm->field);
    for (size_t i = 0; i < size; i++)
        load[i] = drive->vector ? drive->factor * drive->vector[i] : 0;
    for (size_t c = 0; c < unknowns; c++)
        load[size - unknowns + c] += drive->tip[c];
}

double br_march_compliance(const struct br_march *m, enum br_field_kind kind)
{
    const struct br_field_march *fm = &m->field[kind];
    return fm->solver ? fm->solver->tip_compliance(fm->state) : 0;
}

bool br_march_contact_unstable(const struct br_march *m)
{
    if (!m->was_closed || m->method.contact->at_new_step)
        return false;
    return br_contact_grows(&m->field[BR_AXIAL].field, br_contact_stiffness(&m->scene->contact));
}

double br_march_round_off(const struct br_march *m)
{
    /* Round-off of equal steps adds up like a random walk: in measurements a tip that sticks crept
     * by up to 35 times 2^-52 sqrt(N) (bdf2 with plain, 1e6 steps; with riccati 4 times), for all
     * n. */
    const double walk = 64 * DBL_EPSILON * sqrt((double)m->steps);
    double largest = 0;
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        const struct br_field_march *fm = &m->field[kind];
        if (!fm->solver)
            continue;
        const double own = fm->solver->round_off ? fm->solver->round_off(fm->state, m->steps)
                                                 : br_method_round_off(&m->method, &fm->field);
        largest = fmax(largest, own + walk);
    }
    return largest;
}

struct br_counts br_march_counts(const struct br_march *m)
{
    struct br_counts counts = m->counts;
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        const struct br_counts *own = &m->field[kind].counts;
        counts.steps = own->steps > counts.steps ? own->steps : counts.steps;
        counts.stages = own->stages > counts.stages ? own->stages : counts.stages;
        counts.set_ups = own->set_ups > counts.set_ups ? own->set_ups : counts.set_ups;
    }
    return counts;
}

bool br_march_watch(struct br_march *m, const struct br_march_watcher *watcher)
{
    if (m->watchers == BR_MOST_WATCHERS)
        return false;
    m->watcher[m->watchers++] = *watcher;
    return true;
}

void br_march_unwatch(struct br_march *m, const void *self)
{
    size_t left = 0;
    for (size_t i = 0; i < m->watchers; i++)
        if (m->watcher[i].self != self)
            m->watcher[left++] = m->watcher[i];
    m->watchers = left;
}

const char *br_regime_name(enum br_regime regime)
{
    static const char *const names[] = {
        [BR_REGIME_NONE] = "",
        [BR_REGIME_OPEN] = "open",
        [BR_REGIME_CLOSED] = "closed",
        [BR_REGIME_STICK] = "stick",
        [BR_REGIME_FORWARD] = "slip towards +w",
        [BR_REGIME_BACKWARD] = "slip towards -w",
    };
    return names[regime];
}

size_t br_march_switches(const struct br_march *m, const struct br_switch **first)
{
    if (m->adaptive)
        return br_adaptive_switches(m->adaptive, first);
    *first = NULL;
    return 0;
}

/* ---- range ---- */

/* Products of a few numbers of this size with entries of a matrix are not below DBL_MIN / eps. */
static const double least_size = 1e-280;

/* Squares of such numbers do not overflow, nor do the next step's values. */
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
        {"force on the tip", "N", tip->force[kind]},
    };
    for (size_t i = 0; i < sizeof values / sizeof *values; i++)
        if (!(fabs(values[i].value) <= br_most_size))
            return br_fail(err, BR_NOT_FINITE,
                           "the march blew up at t = %g s (step %zu of %zu, k = %g s): the %s %s "
                           "is %g %s",
                           t, m->field[kind].done, m->steps, m->scene->duration / (double)m->steps,
                           br_field_names[kind], values[i].what, values[i].value, values[i].unit);
    return BR_OK;
}

/* The size of the force per nodal displacement in the field's operator, N/m: R of plain.h, and
 * mass. */
static long double resistance(const struct br_field *f)
{
    const long double h = f->h,
                      stiff = (long double)f->viscosity + (long double)f->k * f->stiffness;
    const long double volume = f->kind == BR_AXIAL ? h : h * h * h;
    return stiff / volume + f->density * h / f->k;
}

enum br_status br_march_check_range(const struct br_march *m, enum br_field_kind kind,
                                    struct br_error *err)
{
    const struct br_field_march *fm = &m->field[kind];
    double size[2];
    if (!fm->solver)
        return BR_OK;
    fm->solver->size(fm->state, 0, size);
    if (!isfinite(size[0]) || !isfinite(size[1])) /* the tip may still be finite */
        return br_fail(err, BR_NOT_FINITE,
                       "the march blew up by t = %g s: the %s strain is %g, its rate %g 1/s",
                       m->scene->duration, br_field_names[kind], size[0], size[1]);
    /* A field that is moved only by forces and data below least_size has lost digits to underflow.
     * A field that was larger and decays to such values keeps its digits relative to its former
     * size. */
    const long double r = resistance(&fm->field), force = fm->moved_by;
    const long double motion = fmaxl(force / r * fminl(fm->field.k, 1), fm->started_with);
    const long double smaller = fminl(fmaxl(force, r * fm->started_with), motion);
    if (motion == 0 || smaller >= least_size)
        return BR_OK;
    return br_fail(err, BR_NOT_FINITE,
                   "the %s motion is lost to underflow: its largest nodal force is %Lg N and its "
                   "largest initial value %g m, which move an element by about %Lg m, expected at "
                   "least %g: choose smaller units",
                   br_field_names[fm->field.kind], force, fm->started_with, motion, least_size);
}
