/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What happens at the tip, from every step of a march: when it closed, opened, stuck, slipped and
 * reversed, and the extremes. An event is seen at the first time level of the new regime, so it
 * happened within the step before it. */
#ifndef BR_STUDY_RUN_TIP_WATCH_H
#define BR_STUDY_RUN_TIP_WATCH_H

#include "study/run/history.h"

/* X(name, word): what the tip did. */
#define BR_EVENT_LIST(X)         \
    X(BR_TIP_CLOSED, "closed")   \
    X(BR_TIP_OPENED, "opened")   \
    X(BR_TIP_STUCK, "stuck")     \
    X(BR_TIP_SLIPPED, "slipped") \
    X(BR_TIP_REVERSED, "reversed") /* slips the other way than it last did */

enum br_tip_event_kind {
#define X(name, word) name,
    BR_EVENT_LIST(X)
#undef X
        BR_TIP_EVENTS
};

/* The friction's regime. */
enum br_tip_regime {
    BR_TIP_FREE,  /* the bound is 0: friction carries nothing */
    BR_TIP_STICK, /* |lambda| below the bound */
    BR_TIP_SLIP,  /* at the bound */
    BR_TIP_REGIMES
};

struct br_tip_event {
    enum br_tip_event_kind kind;
    size_t step;   /* the first of the new regime */
    double time;   /* of that level, s; the one before is k earlier */
    int direction; /* of a slip: that of the motion, -1 or 1; else 0 */
};

enum { BR_MOST_EVENTS = 1000 }; /* kept; all are counted */

/* A value with the time of its level, s. */
struct br_extreme {
    double value, time;
};

/* Zeroed at first, but for what br_tip_watch_start sets. */
struct br_tip_watch {
    double gap;                         /* m */
    bool contact, friction;             /* modelled */
    bool closed_at_start;               /* at t = 0 */
    enum br_tip_regime regime_at_start; /* in the first step */
    int direction_at_start;             /* of a slip there */
    struct br_tip_event event[BR_MOST_EVENTS];
    size_t events;               /* that are kept */
    size_t count[BR_TIP_EVENTS]; /* of each kind */
    size_t regime_steps[BR_TIP_REGIMES], closed_steps, steps;
    struct br_extreme contact_force, friction_force; /* largest in size, N */
    bool trapezoidal;     /* the sum of friction_work, for schemes that are not Euler's */
    double power;         /* lambda v of the step before, W */
    double friction_work; /* sum of k lambda v, J */

    double k; /* private from here on: s */
    bool closed;
    enum br_tip_regime regime;
    int direction; /* of the last slip */
};

const char *br_tip_event_word(enum br_tip_event_kind kind);
const char *br_tip_regime_word(enum br_tip_regime regime);

/* An observer that fills a watch (out; it must outlive the march). */
struct br_history_observer br_tip_watch_start(struct br_tip_watch *watch,
                                              const struct br_scene *scene, size_t steps);

#endif
