/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a person should know before a march begins, with what to do about it; and what is refused
 * then: what is to be marched is looked at, and little or nothing is marched. */
#ifndef BR_STUDY_FORESEE_WARNINGS_H
#define BR_STUDY_FORESEE_WARNINGS_H

#include "solver/method.h"

/* Of each kind a list keeps the first; others are counted. */
enum br_warning_kind {
    BR_WARN_UNSTABLE,   /* lagged contact beyond its limit */
    BR_WARN_BOUNCE,     /* lagged contact that may gain energy */
    BR_WARN_ROUND_OFF,  /* above the discretisation error */
    BR_WARN_INACCURATE, /* the discretisation error is large */
    BR_WARN_UNKNOWN,    /* the discretisation error is not known */
    BR_WARN_LOAD_TIME,  /* the time levels miss some of a load */
    BR_WARN_LOAD_SPACE, /* the elements' quadrature misses some */
    BR_WARN_INITIAL,    /* initial data between the nodes */
    BR_WARN_LONG,       /* the march takes days */
    BR_WARNINGS
};
extern const char *const br_warning_words[BR_WARNINGS]; /* for programs */

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

/* Looks at a march before it begins, and adds what it has to say. What it cannot tell is no
 * failure. Fails with BR_BAD_INPUT or BR_NO_MEMORY where the march is refused, the message with the
 * figures. To add a source of warnings: a function, and a call in warnings.c. */
enum br_status br_look_ahead(const struct br_planned_march *planned, struct br_warnings *warnings,
                             struct br_error *err);

/* The same by the sources that are cheap alone: for marches that are many. */
enum br_status br_look_ahead_cheaply(const struct br_planned_march *planned,
                                     struct br_warnings *warnings, struct br_error *err);

/* At the loads and initial data alone: what of them the time levels and the elements do not see.
 * For the finest of many marches; that takes milliseconds, or a second for loads with thousands of
 * jumps. */
enum br_status br_look_at_loads(const struct br_planned_march *planned,
                                struct br_warnings *warnings, struct br_error *err);

/* ---- parts of these ---- */

/* At memory and time. */
enum br_status br_look_at_resources(const struct br_planned_march *planned,
                                    struct br_warnings *warnings, struct br_error *err);

/* Warns of a lagged contact beyond its stability limit (solver/laws.h), with what would be within
 * it. */
void br_look_at_contact(const struct br_planned_march *planned, struct br_warnings *warnings);

/* The least round number of steps, 1, 2, 4, 5, 8, 10, 16, 20, 25, ... of `least` or more, so that a
 * duration with few digits has time steps with few digits; INFINITY above 8e12. */
double br_round_steps(double least);

/* ---- what a march takes, memory and time (resources.c) ---- */

/* Bytes that a march needs at most, from what elements were measured to take. */
double br_march_bytes(const struct br_planned_march *planned);

/* Seconds that a march takes, about, in one thread; those of steps by a tolerance are not known:
 * 0. */
double br_march_seconds(const struct br_planned_march *planned);

/* Bytes that may still be had: the least of what the machine has (MemAvailable of /proc/meminfo),
 * of the limit of the address space (RLIMIT_AS) and of the control group; INFINITY: not known. */
double br_memory_available(void);

/* Refuses (BR_NO_MEMORY) a march that does not fit into a memory of so many bytes, with the
 * figures. */
enum br_status br_fits_memory(const struct br_planned_march *planned, double available,
                              struct br_error *err);

#endif
