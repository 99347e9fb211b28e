/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Checks a march before it begins: warnings with remedies, and refusals. Little or nothing is
 * marched for this. */
#ifndef BR_STUDY_ESTIMATE_WARNINGS_H
#define BR_STUDY_ESTIMATE_WARNINGS_H

#include "study/grid/costs.h"

/* A list keeps the first warning of each kind and counts the others. */
enum br_warning_kind {
    BR_WARN_UNSTABLE,   /* lagged contact beyond its limit */
    BR_WARN_BOUNCE,     /* lagged contact that may gain energy */
    BR_WARN_ROUND_OFF,  /* above the discretisation error */
    BR_WARN_INACCURATE, /* the discretisation error is large */
    BR_WARN_UNKNOWN,    /* the discretisation error is not known */
    BR_WARN_LOAD_TIME,  /* the time levels miss a share of a load */
    BR_WARN_LOAD_SPACE, /* the elements' quadrature misses a share */
    BR_WARN_INITIAL,    /* initial data between the nodes */
    BR_WARN_LONG,       /* the march takes days */
    BR_WARNINGS
};
extern const char *const br_warning_words[BR_WARNINGS]; /* for programs */

struct br_warning {
    enum br_warning_kind kind;
    char text[400];   /* the problem, with the figures; no full stop */
    char remedy[400]; /* what to do instead: alternatives, a line each, options that can be typed
                         where there are some, with "  # why"; "": nothing known */
    size_t more;      /* marches of the same study with a warning of this kind */
};

/* Zeroed at first. */
struct br_warnings {
    struct br_warning list[BR_WARNINGS];
    size_t count;
    double unresolved[BR_WARNINGS]; /* by kind: the largest share of a load, or of initial data,
                                   that levels, elements or nodes miss; INFINITY: not known */
};

/* Adds a warning; its text is the formatted one. The remedy may be NULL. */
__attribute__((format(printf, 4, 5))) void br_warn(struct br_warnings *warnings,
                                                   enum br_warning_kind kind, const char *remedy,
                                                   const char *format, ...);

/* Runs all checks on a march before it begins, and adds their warnings. An unknown error is no
 * failure. Fails with BR_BAD_INPUT or BR_NO_MEMORY if the march is refused; the message has the
 * figures. To add a check: a function, and a call in warnings.c. */
enum br_status br_check_ahead(const struct br_planned_march *planned, struct br_warnings *warnings,
                              struct br_error *err);

/* Runs only the cheap checks: for many marches. */
enum br_status br_check_ahead_cheaply(const struct br_planned_march *planned,
                                      struct br_warnings *warnings, struct br_error *err);

/* Checks only the loads and initial data: how much of them the time levels and the elements miss.
 * For the finest of many marches; takes milliseconds, or a second for loads with thousands of
 * jumps. */
enum br_status br_check_loads(const struct br_planned_march *planned, struct br_warnings *warnings,
                              struct br_error *err);

/* ---- single checks ---- */

/* Warns of a lagged contact beyond its stability limit (solver/laws.h); the remedies are within the
 * limit. */
void br_check_contact(const struct br_planned_march *planned, struct br_warnings *warnings);

/* The least round number of steps, 1, 2, 4, 5, 8, 10, 16, 20, 25, ... of `least` or more, so that a
 * duration with few digits has time steps with few digits; INFINITY above 8e12. */
double br_round_steps(double least);

#endif
