/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Time schemes: a registry. All are sequences of the backward Euler step of linear_solver.h.
 *
 * A stage of an implicit scheme asks for the state Y = (w, v) with
 *     Y = Z + tau Y',    tau = gamma k,
 * where Z is a sum of states that are known and Y' obeys the equations of motion with the contact
 * and friction laws at the stage's own time. That is an Euler step of length tau which starts at Z:
 * schemes differ in gamma and in the weights of Z alone, and the laws are the same scalar problem
 * (laws.h), enforced exactly at every stage. The last stage of every scheme here is
 * the step's end. */
#ifndef BR_SOLVER_SCHEME_H
#define BR_SOLVER_SCHEME_H

#include <stdbool.h>
#include <stddef.h>

enum {
    BR_MOST_STAGES = 5,
    /* What weights refer to: */
    BR_NOW = 0,                            /* Y_{n-1} */
    BR_STAGE = 1,                          /* the stages of this step */
    BR_BEFORE = BR_STAGE + BR_MOST_STAGES, /* Y_{n-2} */
    BR_BEFORE_THAT,                        /* Y_{n-3} */
    BR_RATE,                               /* tau Y'_{n-1} */
    BR_KNOWN
};

struct br_stage {
    double time;             /* t = t_{n-1} + time k */
    double gamma;            /* tau over k */
    double weight[BR_KNOWN]; /* of what Z is a sum of */
};

/* The stages of one step; the last one is at its end. */
struct br_stages {
    int count;
    struct br_stage stage[BR_MOST_STAGES];
    double error[BR_KNOWN]; /* weights of an estimate of the step's error; all 0: none */
};

struct br_time_scheme {
    const char *name;  /* as on the command line */
    const char *title; /* one line for a person */
    const char *citation;
    int order;          /* of the error where the solution is smooth */
    int estimate_order; /* p of the step's error estimate O(k^p); 0: none */
    bool needs_damping; /* undamped vibration grows: refused */
    bool may_lag;       /* also accepts the lagged contact of (16) */
    bool adaptive;      /* chooses its steps by a tolerance, and finds the times of switching; the
                           march's steps are then output times only */
    const struct br_step_form *form[3]; /* of step 1, 2, and later ones */
};

/* NULL-terminated; the first is the default, the paper's. */
extern const struct br_time_scheme *const br_time_schemes[];
const struct br_time_scheme *br_time_scheme_find(const char *name);

/* The stages (out) of a step; since: the number of steps since t = 0 or since the solution switched
 * (stick, slip, contact opens or closes); all numbers from 2 on give the same stages. States before
 * that time have no weight, nor has Y' at that time. */
void br_time_scheme_step(const struct br_time_scheme *scheme, size_t since,
                         struct br_stages *stages);

/* The number of states that its steps refer to, beside the solver's own. */
int br_time_scheme_kept(const struct br_time_scheme *scheme);

/* The mean number of passes over the states that a stage needs beside its solve: a sum of states
 * counts 1, and each state in it 1/5. 0 where each step starts where the last one ended. */
double br_time_scheme_sums(const struct br_time_scheme *scheme);

/* Linear solves a step, after the first steps. */
int br_time_scheme_stages(const struct br_time_scheme *scheme);

#endif
