/* SPDX-License-Identifier: GPL-3.0-or-later */
/* IDA at work: from one switch of the laws to the next. */
#ifndef BR_SOLVER_IDA_MARCH_H
#define BR_SOLVER_IDA_MARCH_H

#include <sundials/sundials_context.h>
#include <sundials/sundials_linearsolver.h>

#include "solver/ida_laws.h"
#include "solver/ida_scale.h"

struct br_ida_march {
    struct br_ida_system system; /* the first: what IDA calls takes it or the march */
    struct br_ida_scale scale;
    double tolerance;
    size_t most; /* of IDA's steps; 0: two million */
    SUNContext context;
    void *ida;
    N_Vector y, rate;          /* at the end of the last step of IDA's */
    N_Vector start, work;      /* where it last began; workspace */
    N_Vector seen, seen_rate;  /* at the time level that is looked at */
    struct br_tip tip;         /* there */
    SUNMatrix jacobian, rates; /* of dG/dy + cj dG/dy'; dG/dy' */
    SUNLinearSolver solver, rate_solver;
    double reached; /* time of y, s */
    bool begun;
    bool switched[BR_IDA_LAWS]; /* whose branch ends there */
    struct br_counts counts;    /* until IDA last began */
    size_t crowd;               /* of them, those soon after crowd_since */
    double crowd_since;         /* s */
    struct br_switch found[BR_MOST_SWITCHES];
    size_t found_count;
    char said[256]; /* by IDA, of a failure */
};

/* Fails with BR_BAD_INPUT, BR_NOT_FINITE or BR_NO_MEMORY; clear it even then. */
enum br_status br_ida_init(struct br_ida_march *m, const struct br_scene *scene, size_t n,
                           const struct br_method *method, struct br_error *err);
void br_ida_clear(struct br_ida_march *m);

/* One step of IDA's, or over a switch. Fails with BR_NOT_FINITE or BR_SINGULAR. */
enum br_status br_ida_step(struct br_ida_march *m, struct br_error *err);

/* Looks at time t within the last step: seen, seen_rate and tip. Fails as br_ida_step. */
enum br_status br_ida_see(struct br_ida_march *m, double t, struct br_error *err);

/* Chooses the branches at the time reached and begins there, with the first step. At t = 0, too.
 * Fails as br_ida_step. */
enum br_status br_ida_switch(struct br_ida_march *m, struct br_error *err);

/* Begins at `reached` with y = start, the branches that the system has and rates that fit them, and
 * takes one step of length h at most. For br_ida_switch. Fails as br_ida_step. */
enum br_status br_ida_begin(struct br_ida_march *m, double t, double h, struct br_error *err);

/* IDA's own counts are added to those of the march; it then may begin again. */
void br_ida_add_counts(const struct br_ida_march *m, struct br_counts *counts);

/* Which margins are below zero by more than round-off and than an error, relative to the scales and
 * to the terms of lambda. Within the tolerance a margin tells nothing: when a tip begins to slip,
 * the errors that the state then has relax within nanoseconds and may move it the wrong way. A
 * branch that is really wrong soon leaves that limit. */
void br_ida_violated(const struct br_ida_march *m, double error, bool violated[BR_IDA_LAWS]);

#endif
