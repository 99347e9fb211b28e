/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Marches one scene from 0 to T, and gives rows of the tip, and the nodal fields at chosen time
 * levels, to observers. Only observers store values, so 1e7 steps take no memory. */
#ifndef BR_STUDY_RUN_HISTORY_H
#define BR_STUDY_RUN_HISTORY_H

#include "solver/march.h"

/* The tip at one time level; what is not modelled is zero. */
struct br_history_row {
    size_t step;            /* 0 .. steps */
    double time;            /* s */
    double displacement[2]; /* by br_field_kind, m; NAN for bending in the rows that `step` gets */
    double velocity[2];     /* m/s */
    double contact_force;   /* c_H (u - g)_+ as the step used it, N */
    double friction_force;  /* lambda, N; NAN at step 0, where the scheme has none */
    double friction_bound;  /* h(t_n), N */
};

/* ---- a march with observers ---- */

/* An observer of a march; every function may be NULL. A status other than BR_OK ends the march and
 * is what br_history_run returns. The march is at the row's time level. */
struct br_history_observer {
    void *self;
    /* Once, at t = 0: an observer may begin to watch the march's stages. */
    enum br_status (*begin)(void *self, struct br_march *march, struct br_error *err);
    /* Every time level, from 0 on. The bending displacement of the row is NAN: it costs a pass over
     * the elements, which br_march_tip_displacement makes. */
    enum br_status (*step)(void *self, const struct br_march *march,
                           const struct br_history_row *row, struct br_error *err);
    /* Every level of the request's stride, the first and the last, with all values; of a march that
     * fails the last good one, its bending displacement NAN where it had not been asked for. */
    enum br_status (*row)(void *self, const struct br_history_row *row, struct br_error *err);
    /* The chosen levels: br_march_get has the fields. */
    enum br_status (*sample)(void *self, const struct br_march *march,
                             const struct br_history_row *row, struct br_error *err);
};

/* What is marched, and which observers get which rows. All borrowed. */
struct br_history_request {
    const struct br_scene *scene;
    const struct br_method *method;
    size_t n, steps;
    size_t stride;       /* steps between rows; 0: no rows */
    const size_t *level; /* levels, ascending, of 0 .. steps: where `sample` is called */
    size_t levels;
    const struct br_history_observer *observer; /* observers */
    size_t observers;
};

/* How a march went; filled also where it failed. */
struct br_history_end {
    struct br_history_row last; /* the last good one, with all values; step 0 if none was */
    double set_up_seconds, march_seconds; /* the latter with what observers took */
};

/* Marches the request's scene. Fails as br_march_create and br_march_step do; a march that blows up
 * stops at that step and says when, in which field, and from what value on. The observers have had
 * everything up to then. The march is handed to *march (out, owned by the caller; NULL where it
 * could not be set up) if `march` is not NULL, at its last level, for what may be asked of it. */
enum br_status br_history_run(const struct br_history_request *request, struct br_march **march,
                              struct br_history_end *end, struct br_error *err);

/* The stride that makes at most so many rows, the first and the last included. */
static inline size_t br_history_stride(size_t steps, size_t most_rows)
{
    const size_t intervals = most_rows > 2 ? most_rows - 1 : 1;
    return steps <= intervals ? 1 : (steps + intervals - 1) / intervals;
}

/* ---- an observer that keeps what it gets ---- */

/* Rows, and the nodal fields at the samples; clear it. */
struct br_history_record {
    size_t n;
    size_t unknowns[2];         /* of a node, by br_field_kind, where there is a sample */
    struct br_history_row *row; /* rows */
    size_t rows, most_rows;
    struct br_history_row *at; /* samples: the tip there */
    double *field;             /* samples times n + 1 nodes' values, see br_history_field */
    size_t samples, most_samples;
};

/* An observer that fills a record (in: zeroed; it must outlive the march). */
struct br_history_observer br_history_recorder(struct br_history_record *record, size_t n);
void br_history_record_clear(struct br_history_record *record);

/* The kept nodal values of a sample, laid out as in solver/field.h: displacement or velocity. */
const double *br_history_field(const struct br_history_record *record, size_t sample,
                               enum br_field_kind kind, bool velocity);

/* ---- what happens at the tip ---- */

/* What happens at the tip, from every step of a march: when it closed, opened, stuck, slipped and
 * reversed, and the extremes. An event is seen at the first time level of the new regime, so it
 * happened within the step before it. */

/* What the tip did. */
enum br_tip_event_kind {
    BR_TIP_CLOSED,
    BR_TIP_OPENED,
    BR_TIP_STUCK,
    BR_TIP_SLIPPED,
    BR_TIP_REVERSED, /* slips the other way than it last did */
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

extern const char *const br_tip_event_words[], *const br_tip_regime_words[];

/* An observer that fills a watch (out; it must outlive the march). */
struct br_history_observer br_tip_watch_start(struct br_tip_watch *watch,
                                              const struct br_scene *scene, size_t steps);

#endif
