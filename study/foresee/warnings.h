/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a person should know before a march begins, with what to do about it; and what is refused
 * then. Each source looks at what is to be marched and predicts; it marches little or nothing. */
#ifndef BR_STUDY_FORESEE_WARNINGS_H
#define BR_STUDY_FORESEE_WARNINGS_H

#include "solver/method.h"

/* X(name, word for programs). Of each kind a list keeps the first; others are counted. */
#define BR_WARNING_LIST(X)                                                             \
    X(BR_WARN_UNSTABLE, "unstable")        /* lagged contact beyond its limit */       \
    X(BR_WARN_BOUNCE, "bounce")            /* lagged contact that may gain energy */   \
    X(BR_WARN_ROUND_OFF, "round-off")      /* above the discretisation error */        \
    X(BR_WARN_INACCURATE, "inaccurate")    /* the discretisation error is large */     \
    X(BR_WARN_UNKNOWN, "error-not-known")  /* the discretisation error is not known */ \
    X(BR_WARN_LOAD_TIME, "load-in-time")   /* the time levels miss some of a load */   \
    X(BR_WARN_LOAD_SPACE, "load-in-space") /* the elements' quadrature misses some */  \
    X(BR_WARN_INITIAL, "initial-data")     /* initial data between the nodes */        \
    X(BR_WARN_LONG, "long")                /* the march takes days */

enum br_warning_kind {
#define X(name, word) name,
    BR_WARNING_LIST(X)
#undef X
        BR_WARNINGS
};
const char *br_warning_word(enum br_warning_kind kind);

struct br_warning {
    enum br_warning_kind kind;
    char text[400];   /* what will happen, with the figures; no full stop */
    char remedy[400]; /* what to do instead: alternatives, a line each, options that can be typed
                         where there are some, with "  # why"; "": nothing known */
    size_t more;      /* marches of the same study with a warning of this kind */
};

/* Zeroed at first. */
struct br_warnings {
    struct br_warning list[BR_WARNINGS];
    size_t count;
    double unseen[BR_WARNINGS]; /* by kind: the largest share of a load, or of initial data */
    char share[16];             /* room for a text of br_unseen */
};

/* Adds a warning; its text is the formatted one. The remedy may be NULL. */
__attribute__((format(printf, 4, 5))) void br_warn(struct br_warnings *warnings,
                                                   enum br_warning_kind kind, const char *remedy,
                                                   const char *format, ...);

/* Notes that levels, elements or nodes miss so much of a load or of initial data of that size;
 * INFINITY: it is not known how much. Where that is a larger share than `large` it returns it as
 * "31 %", "all" or "more than all", else NULL. */
const char *br_unseen(struct br_warnings *warnings, enum br_warning_kind kind, double missed,
                      double size, double large);

/* The warning of that kind, or NULL. */
const struct br_warning *br_warnings_find(const struct br_warnings *warnings,
                                          enum br_warning_kind kind);

struct br_prediction;

/* What is to be marched. All borrowed; the scene is the part of it that is marched
 * (study/run/run.h). */
struct br_planned_march {
    const struct br_scene *scene;
    const struct br_method *method;
    size_t n, steps;
    struct br_prediction *prediction; /* out: the errors to expect; NULL: nobody asks */
    double budget; /* elements times solves that a prediction may take; 0: as prediction.h says */
};

/* A source of warnings: a row of the registry. */
struct br_warning_source {
    const char *title; /* what it looks at, for a person */
    bool every;        /* so cheap that each march of a study is looked at */
    /* Adds what it has to say. What it cannot tell is no failure. Fails with BR_BAD_INPUT or
     * BR_NO_MEMORY where the march is refused, the message with the figures. */
    enum br_status (*look)(const struct br_planned_march *planned, struct br_warnings *warnings,
                           struct br_error *err);
};

/* NULL-terminated: refusals first, then in the order in which warnings are told. To add one: a
 * const record and a row in warnings.c. */
extern const struct br_warning_source *const br_warning_sources[];

/* Asks all sources about one march; adds to *warnings. Fails as they do. */
enum br_status br_look_ahead(const struct br_planned_march *planned, struct br_warnings *warnings,
                             struct br_error *err);

/* Asks those that are cheap alone: for marches that are many. */
enum br_status br_look_ahead_cheaply(const struct br_planned_march *planned,
                                     struct br_warnings *warnings, struct br_error *err);

/* Asks about the loads and initial data alone: what of them the time levels and the elements do
 * not see. For the finest of many marches; that takes milliseconds, or a second for loads with
 * thousands of jumps.
 */
enum br_status br_look_at_loads(const struct br_planned_march *planned,
                                struct br_warnings *warnings, struct br_error *err);

/* The warning of a lagged contact that will be unstable (solver/laws.h). */
extern const struct br_warning_source br_warn_contact;

/* Of the other files of this room. */
extern const struct br_warning_source br_warn_initial, br_warn_load, br_warn_load_space,
    br_warn_resources;

/* The least round number of steps, 1, 2, 4, 5, 8, 10, 16, 20, 25, ... of `least` or more, so that a
 * duration with few digits has time steps with few digits; INFINITY above 8e12. */
double br_round_steps(double least);

#endif
