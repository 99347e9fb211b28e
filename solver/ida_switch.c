/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which branches of the laws hold next.
 *
 * At a switch, or at t = 0, the state itself does not always tell: from rest with the gap just
 * closed both lambda and its bound are zero, and a tip that would stick slips first, since the
 * bound then grows slower than the reaction. So branches are tried, the likely ones first: those
 * hold whose margins are not negative after a first step, which is tiny. The likeliest is
 * allowed an error of the size of the tolerance, the others are not: a tip that begins to slip has
 * no velocity yet by which to tell the directions. Where none holds, a longer first step is
 * tried, and at last that error is allowed to all. */
#include <math.h>

#include "solver/ida_march.h"

/* First steps that are tried, of the duration. */
static const double first_steps[] = {1e-9, 1e-8, 1e-7, 1e-6, 1e-5};

enum { TRIES = sizeof first_steps / sizeof *first_steps };

/* So many switches within so small a part of the duration get nowhere. */
enum { MOST_CROWDED = 1000 };
static const double crowded = 1e-6;

static enum br_status watch_crowd(struct br_ida_march *m, struct br_error *err)
{
    if (!(m->reached - m->crowd_since <= crowded * m->system.scene->duration)) {
        m->crowd_since = m->reached;
        m->crowd = 0;
    }
    if (++m->crowd < MOST_CROWDED)
        return BR_OK;
    return br_fail(err, BR_NOT_FINITE,
                   "scheme ida stopped at t = %.9g s: contact and friction switched %d times since "
                   "%.9g s. Fewer elements or scheme adaptive may help",
                   m->reached, MOST_CROWDED, m->crowd_since);
}

/* ---- the branches that are possible ---- */

static bool has_friction(const struct br_ida_system *s, bool closed)
{
    if (!s->modelled[BR_BENDING] || !(s->scene->friction.coefficient > 0))
        return false;
    return s->scene->friction.law == BR_TRESCA || (s->scene->friction.law == BR_COULOMB && closed);
}

/* Whether the tip's velocity lets a branch begin. */
static bool may_begin(const struct br_ida_march *m, struct br_ida_regime regime)
{
    const struct br_ida_system *s = &m->system;
    const double v = br_ida_tip_velocity(s, BR_BENDING, N_VGetArrayPointer(m->start));
    const double least = s->mu * (1 - 1e-9), most = s->mu * (1 + 1e-9);
    switch (regime.friction) {
    case BR_IDA_STICK:
        return fabs(v) <= most;
    case BR_IDA_SLIP_UP:
        return v >= least;
    case BR_IDA_SLIP_DOWN:
        return v <= -least;
    case BR_IDA_FREE:
        break;
    }
    return true;
}

enum { MOST_CANDIDATES = 8 };

static void add_candidate(const struct br_ida_march *m, struct br_ida_regime regime,
                          struct br_ida_regime *list, size_t *count)
{
    for (size_t i = 0; i < *count; i++)
        if (list[i].closed == regime.closed && list[i].friction == regime.friction)
            return;
    if (may_begin(m, regime))
        list[(*count)++] = regime;
}

/* list: out, at most MOST_CANDIDATES, the likely ones first; returns their number. */
static size_t candidates(const struct br_ida_march *m, struct br_ida_regime likely,
                         struct br_ida_regime *list)
{
    const struct br_ida_system *s = &m->system;
    const enum br_ida_friction order[] = {likely.friction, BR_IDA_STICK, BR_IDA_SLIP_UP,
                                          BR_IDA_SLIP_DOWN};
    size_t count = 0;
    for (int i = 0; i < (s->scene->contact.modelled ? 2 : 1); i++) {
        const bool closed = i ? !likely.closed : likely.closed;
        if (!has_friction(s, closed)) {
            add_candidate(m, (struct br_ida_regime){closed, BR_IDA_FREE}, list, &count);
            continue;
        }
        for (size_t j = 0; j < sizeof order / sizeof *order; j++)
            if (order[j] != BR_IDA_FREE)
                add_candidate(m, (struct br_ida_regime){closed, order[j]}, list, &count);
    }
    return count;
}

/* ---- a switch ---- */

/* What likely follows a friction branch that has ended. */
static enum br_ida_friction next_friction(const struct br_ida_march *m)
{
    const struct br_ida_system *s = &m->system;
    const double *y = N_VGetArrayPointer(m->y);
    if (s->regime.friction != BR_IDA_STICK)
        return BR_IDA_STICK;
    const double pull = s->mu > 0 ? br_ida_tip_velocity(s, BR_BENDING, y)
                                  : br_ida_reaction(s, y, N_VGetArrayPointer(m->rate), NULL);
    return pull > 0 ? BR_IDA_SLIP_UP : BR_IDA_SLIP_DOWN;
}

/* A tip that sticks, or whose slip has come to its end, rests to the last digit. */
static void rest(struct br_ida_march *m)
{
    const struct br_ida_system *s = &m->system;
    const bool slips =
        s->regime.friction == BR_IDA_SLIP_UP || s->regime.friction == BR_IDA_SLIP_DOWN;
    const bool rests =
        m->begun && s->modelled[BR_BENDING] && !(s->mu > 0) &&
        (s->regime.friction == BR_IDA_STICK || (slips && m->switched[BR_IDA_FRICTION]));
    if (rests)
        N_VGetArrayPointer(m->start)[br_ida_at(s, BR_BENDING, s->field[BR_BENDING].n) + 2] = 0;
}

/* Whether a branch holds with a first step of h. */
static enum br_status try_regime(struct br_ida_march *m, struct br_ida_regime regime, double t,
                                 double h, double error, bool *holds, struct br_error *err)
{
    bool violated[BR_IDA_LAWS];
    m->system.regime = regime;
    const enum br_status status = br_ida_begin(m, t, h, err);
    if (status)
        return status;
    br_ida_violated(m, error, violated);
    *holds = !violated[BR_IDA_CONTACT] && !violated[BR_IDA_FRICTION];
    if (!*holds) {
        br_ida_add_counts(m, &m->counts);
        m->counts.rejected++;
        m->counts.steps--;
    }
    return BR_OK;
}

static enum br_regime name_of(const struct br_ida_system *s, enum br_field_kind kind,
                              struct br_ida_regime regime)
{
    static const enum br_regime frictions[] = {
        [BR_IDA_FREE] = BR_REGIME_NONE,
        [BR_IDA_STICK] = BR_REGIME_STICK,
        [BR_IDA_SLIP_UP] = BR_REGIME_FORWARD,
        [BR_IDA_SLIP_DOWN] = BR_REGIME_BACKWARD,
    };
    if (kind == BR_BENDING)
        return frictions[regime.friction];
    if (!s->scene->contact.modelled)
        return BR_REGIME_NONE;
    return regime.closed ? BR_REGIME_CLOSED : BR_REGIME_OPEN;
}

static void tell(struct br_ida_march *m, struct br_ida_regime before, double t)
{
    for (int i = BR_AXIAL; i <= BR_BENDING; i++) {
        const enum br_field_kind kind = (enum br_field_kind)i;
        const enum br_regime from = name_of(&m->system, kind, before),
                             to = name_of(&m->system, kind, m->system.regime);
        if (from == to)
            continue;
        if (m->found_count < BR_MOST_SWITCHES)
            m->found[m->found_count] = (struct br_switch){t, kind, from, to};
        m->found_count++;
    }
}

enum br_status br_ida_switch(struct br_ida_march *m, struct br_error *err)
{
    const struct br_ida_regime before = m->system.regime;
    const bool begun = m->begun;
    struct br_ida_regime list[MOST_CANDIDATES], likely = before;
    const double t = m->reached;
    enum br_status status = watch_crowd(m, err);
    if (status)
        return status;
    br_ida_add_counts(m, &m->counts);
    N_VScale(1, m->y, m->start);
    rest(m);
    m->begun = true;
    if (m->switched[BR_IDA_FRICTION])
        likely.friction = next_friction(m);
    if (m->switched[BR_IDA_CONTACT])
        likely.closed = !likely.closed;
    const size_t count = candidates(m, likely, list);
    bool found = false;
    for (size_t i = 0; i < 2 * TRIES * count && !found && !status; i++) {
        const double h = first_steps[i / count % TRIES] * m->system.scene->duration;
        const double error = i % count == 0 || i >= TRIES * count ? m->tolerance : 0;
        status = try_regime(m, list[i % count], t, h, error, &found, err);
    }
    if (found && begun)
        tell(m, before, t);
    if (status || found)
        return status;
    return br_fail(err, BR_NOT_FINITE,
                   "scheme ida stopped at t = %.9g s: no branch of the contact and friction laws "
                   "holds there beyond round-off. Fewer elements or scheme adaptive may help",
                   t);
}
