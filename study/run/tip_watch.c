/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solver/scene.h"
#include "study/run/history.h"

#include <math.h>

const char *const br_tip_event_words[] = {"closed", "opened", "stuck", "slipped", "reversed"},
                  *const br_tip_regime_words[] = {"free", "stick", "slip"};

static void add(struct br_tip_watch *w, enum br_tip_event_kind kind,
                const struct br_history_row *row, int direction)
{
    w->count[kind]++;
    if (w->events < BR_MOST_EVENTS)
        w->event[w->events++] = (struct br_tip_event){kind, row->step, row->time, direction};
}

static void watch_contact(struct br_tip_watch *w, const struct br_history_row *row)
{
    const bool closed = row->displacement[BR_AXIAL] > w->gap;
    if (row->step == 0)
        w->closed_at_start = closed;
    else if (closed != w->closed)
        add(w, closed ? BR_TIP_CLOSED : BR_TIP_OPENED, row, 0);
    w->closed = closed;
    w->closed_steps += row->step > 0 && closed;
}

/* Both friction rules clamp lambda to the bound, so a slip has the bound's very bits, and the sign
 * of lambda is that of the motion. */
static enum br_tip_regime regime_of(const struct br_history_row *row)
{
    if (row->friction_bound == 0)
        return BR_TIP_FREE;
    return fabs(row->friction_force) < row->friction_bound ? BR_TIP_STICK : BR_TIP_SLIP;
}

static void watch_friction(struct br_tip_watch *w, const struct br_history_row *row)
{
    const enum br_tip_regime regime = regime_of(row);
    const int direction = regime != BR_TIP_SLIP ? 0 : row->friction_force > 0 ? 1 : -1;
    w->regime_steps[regime]++;
    const double power = row->friction_force * row->velocity[BR_BENDING];
    w->friction_work += w->k * (w->trapezoidal ? (w->power + power) / 2 : power);
    w->power = power;
    const bool turned = direction && w->direction && direction != w->direction;
    if (row->step == 1) {
        w->regime_at_start = regime;
        w->direction_at_start = direction;
    } else if (turned)
        add(w, BR_TIP_REVERSED, row, direction);
    else if (regime != w->regime && regime != BR_TIP_FREE)
        add(w, regime == BR_TIP_STICK ? BR_TIP_STUCK : BR_TIP_SLIPPED, row, direction);
    w->regime = regime;
    w->direction = direction ? direction : w->direction;
}

static void keep_largest(struct br_extreme *e, double value, double time)
{
    if (fabs(value) > fabs(e->value))
        *e = (struct br_extreme){value, time};
}

static enum br_status watch(void *self, const struct br_march *march,
                            const struct br_history_row *row, struct br_error *err)
{
    (void)march, (void)err;
    struct br_tip_watch *w = self;
    w->steps = row->step;
    if (w->contact) {
        watch_contact(w, row);
        keep_largest(&w->contact_force, row->contact_force, row->time);
    }
    if (w->friction && row->step > 0) {
        watch_friction(w, row);
        keep_largest(&w->friction_force, row->friction_force, row->time);
    }
    return BR_OK;
}

struct br_history_observer br_tip_watch_start(struct br_tip_watch *w, const struct br_scene *scene,
                                              size_t steps)
{
    *w = (struct br_tip_watch){
        .gap = scene->contact.gap,
        .contact = scene->contact.modelled,
        .friction = scene->friction.law != BR_FRICTIONLESS,
        .k = scene->duration / (double)steps,
    };
    return (struct br_history_observer){.self = w, .step = watch};
}
