/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solver/march.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "solver/contact_limit.h"
#include "solver/march_state.h"
#include "solver/rounding.h"
#include "solver/traps.h"

/* t_n = n T / N, never summed. */
static double time_level(const struct br_march *m, size_t n)
{
    return m->scene->duration * (double)n / (double)m->steps;
}

/* ---- stepping ---- */

static enum br_status fixed_step(struct br_march *m, enum br_field_kind kind, struct br_error *err)
{
    struct br_part *part = &m->part[kind];
    const struct br_step step = {time_level(m, part->done), time_level(m, part->done + 1),
                                 m->scene->duration / (double)m->steps};
    struct br_stages stages;
    m->method.scheme->stages(part->since, &stages);
    const enum br_status status =
        br_march_stages(m, kind, &stages, &step, &m->path[part->done % m->lead], err);
    if (status)
        return status;
    const enum br_regime before = m->regime[kind];
    m->regime[kind] = br_march_regime(m, kind);
    br_march_accept(m, kind, &stages, part->counts.steps > 0 && m->regime[kind] != before);
    return BR_OK;
}

/* Both fields, whichever of them is asked for first. */
static enum br_status common_step(struct br_march *m, enum br_field_kind kind, struct br_error *err)
{
    if (kind == BR_BENDING)
        return BR_OK;
    return br_adaptive_advance(m, err);
}

static enum br_status step_field(struct br_march *m, enum br_field_kind kind, struct br_error *err)
{
    struct br_part *part = &m->part[kind];
    enum br_status status = BR_OK;
    if (br_fields_go_together(m))
        status = common_step(m, kind, err);
    else if (part->modelled)
        status = fixed_step(m, kind, err);
    if (status)
        return status;
    part->done++;
    status = br_march_check_finite(m, kind, time_level(m, part->done), err);
    return status || part->done < m->steps ? status : br_march_check_range(m, kind, err);
}

enum br_status br_march_step_field(struct br_march *m, enum br_field_kind kind,
                                   struct br_error *err)
{
    const int traps = br_traps_set();
    const int rounding = br_rounding_set(m->method.rounding);
    const enum br_status status = step_field(m, kind, err);
    br_rounding_restore(rounding);
    br_traps_restore(traps);
    return status;
}

enum br_status br_march_step(struct br_march *m, struct br_error *err)
{
    const enum br_status status = br_march_step_field(m, BR_AXIAL, err);
    return status ? status : br_march_step_field(m, BR_BENDING, err);
}

struct br_counts br_march_counts(const struct br_march *m)
{
    struct br_counts counts = m->counts;
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        const struct br_counts *own = &m->part[kind].counts;
        counts.steps = own->steps > counts.steps ? own->steps : counts.steps;
        counts.stages = own->stages > counts.stages ? own->stages : counts.stages;
        counts.set_ups = own->set_ups > counts.set_ups ? own->set_ups : counts.set_ups;
    }
    return counts;
}

void br_march_stop_when(struct br_march *m, bool (*stop)(void *self), void *self)
{
    m->stop = stop;
    m->stop_self = self;
}

/* ---- looking ---- */

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
    const struct br_part *part = &m->part[kind];
    return part->modelled ? part->solver->tip_displacement(part->state) : 0;
}

void br_march_get(const struct br_march *m, enum br_field_kind kind, double *displacement,
                  double *velocity)
{
    const struct br_part *part = &m->part[kind];
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
    const struct br_part *part = &m->part[kind];
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
    const struct br_part *part = &m->part[kind];
    const struct br_drive *drive = &part->load.drive;
    const size_t size = br_field_size(&part->field), unknowns = br_field_unknowns(&part->field);
    for (size_t i = 0; i < size; i++)
        load[i] = drive->vector ? drive->factor * drive->vector[i] : 0;
    for (size_t c = 0; c < unknowns; c++)
        load[size - unknowns + c] += drive->tip[c];
}

double br_march_compliance(const struct br_march *m, enum br_field_kind kind)
{
    const struct br_part *part = &m->part[kind];
    return part->solver ? part->solver->tip_compliance(part->state) : 0;
}

bool br_march_contact_unstable(const struct br_march *m)
{
    if (!m->was_closed || m->method.contact->at_new_step)
        return false;
    return br_contact_grows(&m->part[BR_AXIAL].field, m->scene->contact.stiffness);
}

static double part_round_off(const struct br_march *m, const struct br_part *part)
{
    if (part->solver->round_off)
        return part->solver->round_off(part->state, m->steps);
    return m->method.solver->round_off(&part->field, &m->method.linear);
}

/* What equal steps gather is a random walk: a tip that sticks was seen to creep by up to 35 times
 * 2^-52 sqrt(N) (bdf2 with plain, 1e6 steps; riccati by 4 times), whatever n. */
static double walk(const struct br_march *m)
{
    return 64 * DBL_EPSILON * sqrt((double)m->steps);
}

double br_march_round_off(const struct br_march *m)
{
    double largest = 0;
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        if (m->part[kind].solver)
            largest = fmax(largest, part_round_off(m, &m->part[kind]) + walk(m));
    return largest;
}
