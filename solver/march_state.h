/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What march.c, march_values.c, step.c, adaptive.c and field_march.c share of a march; for these
 * alone. */
#ifndef BR_SOLVER_MARCH_STATE_H
#define BR_SOLVER_MARCH_STATE_H

#include "solver/linear/states.h"
#include "solver/load.h"
#include "solver/march.h"
#include "solver/method.h"
#include "solver/scheme.h"

/* ---- one field of a march ---- */

/* The solver and the load of a field, and the states that the time scheme refers to. */
struct br_field_march {
    bool modelled;
    struct br_field field; /* its k is the step tau of the stages */
    const struct br_field_solver *solver;
    void *state;
    struct br_step_load load;
    size_t done;             /* steps */
    size_t since;            /* steps since the last start, see scheme.h */
    size_t kept;             /* states that the solver keeps beside its own */
    size_t buffer[BR_KNOWN]; /* the solver's index of each known state; 0: it is not kept */
    double rate_tau;         /* tau of the state BR_RATE, s */
    struct br_counts counts;
    long double load_size; /* of the load vector's largest entry for a factor of 1, N */
    long double moved_by;  /* the largest nodal force so far, N */
    double started_with;   /* the largest nodal value of the initial data, velocities times k, m */
};

/* The largest force, N, initial value and tip value that is accepted: the squares of larger ones
 * overflow. */
extern const double br_most_size;

/* A field of a scene at rest or as it starts, with its initial step, s, by a method. Takes memory
 * for the states that the scheme keeps. Fails as br_march_create; clear it even then. */
enum br_status br_field_march_create(struct br_field_march *fm, const struct br_scene *scene,
                                     const struct br_field *field, const struct br_method *method,
                                     struct br_error *err);
void br_field_march_clear(struct br_field_march *fm);

/* Copies the solver's state into a kept one, BR_NOW for example, if the scheme keeps it; recall
 * copies the kept state back. */
void br_field_march_keep(struct br_field_march *fm, int known);
void br_field_march_recall(struct br_field_march *fm, int known);

/* Keeps the solver's state where later stages or steps refer to it, and replaces it with the state
 * at which stage i starts. The solver's step becomes the stage's tau, for a step of k, s. Fails
 * with BR_SINGULAR or BR_NO_MEMORY. */
enum br_status br_field_march_start_stage(struct br_field_march *fm, const struct br_stages *stages,
                                          int i, double k, struct br_error *err);

/* The tip's free velocity v* at time t, s. Fails as br_march_step. */
enum br_status br_field_march_predict(struct br_field_march *fm, double t, double *velocity,
                                      struct br_error *err);

/* Accepts the step of these stages: the state BR_NOW becomes BR_BEFORE. switched: the scheme
 * restarts with the next step. */
void br_field_march_accept(struct br_field_march *fm, const struct br_stages *stages,
                           bool switched);

/* Sizes (out), as br_field_solver's size has them, of the error estimate, which is the larger of
 * its strain and of the strain that its strain rate leads to, and of the state's strain. Call it
 * after the last stage, before the next one starts. */
void br_field_march_estimate(struct br_field_march *fm, const struct br_stages *stages,
                             double *error, double *state);

/* ---- margins ---- */

/* How far a field's tip is from leaving the branch of its law that a step keeps active: at the
 * start, the stages and the end of the step, and by the polynomial through these values in between.
 * A tip may leave its branch and be back on it at the end of the step. */

struct br_margins {
    size_t count;
    double time[BR_MOST_STAGES + 1];   /* over k, from the start of the step */
    double margin[BR_MOST_STAGES + 1]; /* not negative while the tip is on the branch */
};

/* Adds a margin; all times are different. */
void br_margins_add(struct br_margins *margins, double time, double margin);

/* The time in the step, over k, of the first negative margin; where there is none, of the lowest
 * value of the polynomial through all margins, if that is negative. 0: nothing is negative. */
double br_margins_dip(const struct br_margins *margins);

/* ---- a march ---- */

/* The axial tip over one step, for the friction bound of the bending field. */
struct br_tip_path {
    int count;
    double time[BR_MOST_STAGES];        /* of its stages, over k from t_{n-1} on */
    double penetration[BR_MOST_STAGES]; /* (u - g)_+ there, m */
    double start[2], end[2];            /* u and k u_t at t_{n-1} and t_n, m */
};

/* A step of a march: its start and end, s, and its length k, which is bit by bit the same in all
 * equal steps. */
struct br_step {
    double from, to, k;
};

/* The time at that fraction of the step, s. */
static inline double br_step_time(const struct br_step *step, double fraction)
{
    return fraction == 1 ? step->to : step->from + fraction * (step->to - step->from);
}

struct br_adaptive;

struct br_march {
    const struct br_scene *scene;
    struct br_method method;
    size_t steps;
    struct br_field_march field[2]; /* by br_field_kind */
    enum br_regime regime[2];
    bool was_closed;              /* the contact has been closed in a step */
    bool keeps_branch[2];         /* the regime stays active, whatever the stage's result is */
    struct br_margins margins[2]; /* of the step so far, where a branch is kept active */
    struct br_tip tip, start;     /* of the last stage; at t = 0 */
    struct br_tip_path *path;     /* of the last `lead` steps */
    size_t lead;
    struct br_counts counts;      /* those that the fields do not count */
    struct br_adaptive *adaptive; /* NULL: fixed steps */
    bool (*stop)(void *self);     /* NULL: never stops */
    void *stop_self;
    struct br_march_watcher watcher[BR_MOST_WATCHERS];
    size_t watchers;
};

/* All stages of a step of one field, with the contact or the friction law in each; path: of the
 * axial field in that step. Fails as br_march_step. */
enum br_status br_march_stages(struct br_march *march, enum br_field_kind kind,
                               const struct br_stages *stages, const struct br_step *step,
                               struct br_tip_path *path, struct br_error *err);

/* The branch of its law that the tip is on after a stage. */
enum br_regime br_march_regime(const struct br_march *march, enum br_field_kind kind);

/* Not negative while a field's tip is on the branch that is kept active; 0 where none is. */
double br_march_margin(const struct br_march *march, enum br_field_kind kind);

/* Accepts a field's step; switched: the scheme restarts with the next one. */
void br_march_accept(struct br_march *march, enum br_field_kind kind,
                     const struct br_stages *stages, bool switched);

/* Refuses (BR_NOT_FINITE) tip values at time t, s, that are not finite or too large. */
enum br_status br_march_check_finite(const struct br_march *march, enum br_field_kind kind,
                                     double t, struct br_error *err);

/* Refuses (BR_NOT_FINITE) a march at its end if a field has a strain that is not finite, or if
 * forces and data are so small that underflow has lost digits. */
enum br_status br_march_check_range(const struct br_march *march, enum br_field_kind kind,
                                    struct br_error *err);

/* Creates the data of an adaptive scheme in a march; released by free. Fails with BR_NO_MEMORY. */
enum br_status br_adaptive_create(struct br_march *march, struct br_error *err);

size_t br_adaptive_switches(const struct br_adaptive *adaptive, const struct br_switch **first);

/* Advances to the next time level of the march, with steps that the scheme chooses. Fails as
 * br_march_step, and with BR_NOT_FINITE where no step is small enough. */
enum br_status br_adaptive_advance(struct br_march *march, struct br_error *err);

#endif
