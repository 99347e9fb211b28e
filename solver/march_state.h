/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What march.c, step.c and adaptive.c share of a march; for these and field_march.c alone. */
#ifndef BR_SOLVER_MARCH_STATE_H
#define BR_SOLVER_MARCH_STATE_H

#include "solver/linear/states.h"
#include "solver/load.h"
#include "solver/march.h"
#include "solver/scheme.h"

/* ---- one field of a march ---- */

/* Its solver, its load, and the states that its time scheme looks back to. */
struct br_field_march {
    bool modelled;
    struct br_field field; /* with the step of the stages, tau */
    const struct br_field_solver *solver;
    void *state;
    struct br_step_load load;
    size_t done;  /* steps */
    size_t since; /* steps since the last start, see scheme.h */
    size_t kept;  /* states that the solver keeps, its own not counted; 0: none is needed */
    size_t slot[BR_KNOWN]; /* which of them is what; 0: none */
    double rate_tau;       /* of BR_RATE, s */
    struct br_counts counts;
    long double load_size; /* of the load vector's largest entry for a factor of 1, N */
    long double moved_by;  /* the largest nodal force so far, N */
    double started_with;   /* the largest nodal value of the initial data, velocities times k, m */
};

/* Larger forces, N, initial data and tip values are refused: their squares are beyond a double. */
extern const double br_most_size;

/* A field of a scene at rest or as it starts, with its initial step, s, by a method. Where the
 * scheme looks back or has several stages, room is made for what it keeps. Fails as
 * br_march_create; clear it even then. */
enum br_status br_field_march_create(struct br_field_march *part, const struct br_scene *scene,
                                     const struct br_field *field, const struct br_method *method,
                                     struct br_error *err);
void br_field_march_clear(struct br_field_march *part);

/* The solver's state becomes one of those that are kept, BR_NOW say, if it is kept at all; and the
 * other way round. */
void br_field_march_keep(struct br_field_march *part, int known);
void br_field_march_recall(struct br_field_march *part, int known);

/* The state that the solver has is kept, where later stages or steps look back to it, and goes to
 * where stage i starts; the solver's step becomes its tau, for a step of k, s. Fails with
 * BR_SINGULAR or BR_NO_MEMORY. */
enum br_status br_field_march_start_stage(struct br_field_march *part,
                                          const struct br_stages *stages, int i, double k,
                                          struct br_error *err);

/* The tip's free velocity v* at time t, s. Fails as br_march_step. */
enum br_status br_field_march_predict(struct br_field_march *part, double t, double *velocity,
                                      struct br_error *err);

/* The step of these stages is taken: what was BR_NOW is BR_BEFORE. switched: the next one starts
 * anew. */
void br_field_march_accept(struct br_field_march *part, const struct br_stages *stages,
                           bool switched);

/* Sizes (out), as br_field_solver's size has them, of the error's estimate, the larger of its
 * strain by displacement and of what its strain rate leads to, and of the state's strain by
 * displacement. The last stage has not been followed by another. */
void br_field_march_estimate(struct br_field_march *part, const struct br_stages *stages,
                             double *error, double *state);

/* ---- margins ---- */

/* How far a field's tip is from leaving the branch of its law that a step holds, over that step: at
 * its start, its stages and its end, and by their polynomial in between. A tip may leave its branch
 * and be back on it at the end of the step. */

struct br_margins {
    size_t count;
    double time[BR_MOST_STAGES + 1];   /* over k, from the start of the step */
    double margin[BR_MOST_STAGES + 1]; /* not negative on the branch */
};

/* Adds one; no two are of one time. */
void br_margins_add(struct br_margins *margins, double time, double margin);

/* Where in the step, over k, a margin is negative: the first that is, or, where none is, the lowest
 * point of their polynomial if that is. 0: nowhere. */
double br_margins_dip(const struct br_margins *margins);

/* ---- a march ---- */

/* The axial tip over one step, for the friction bound of the bending field. */
struct br_tip_path {
    int count;
    double time[BR_MOST_STAGES];        /* of its stages, over k from t_{n-1} on */
    double penetration[BR_MOST_STAGES]; /* (u - g)_+ there, m */
    double start[2], end[2];            /* u and k u_t at t_{n-1} and t_n, m */
};

/* A step of a march: from and to, s, and its length, which is the same in all equal steps. */
struct br_step {
    double from, to, k;
};

/* At `part` of the step. */
static inline double br_step_time(const struct br_step *step, double part)
{
    return part == 1 ? step->to : step->from + part * (step->to - step->from);
}

struct br_adaptive;

struct br_march {
    const struct br_scene *scene;
    struct br_method method;
    size_t steps;
    struct br_field_march part[2]; /* by br_field_kind */
    enum br_regime regime[2];
    bool was_closed; /* the contact, in a step */
    bool held[2];    /* the regime holds, whatever the law says of the stage's result */
    struct br_margins margins[2]; /* of the step so far, where a branch is held */
    struct br_tip tip;
    struct br_tip_path *path; /* of the last `lead` steps */
    size_t lead;
    struct br_counts counts;      /* what the parts do not count */
    struct br_adaptive *adaptive; /* NULL: fixed steps */
    bool (*stop)(void *self);     /* NULL: nobody is asked */
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

/* Not negative while a field's tip is on the branch that is held; 0 where none is. */
double br_march_margin(const struct br_march *march, enum br_field_kind kind);

/* A field's step is taken; switched: the next one starts anew. */
void br_march_accept(struct br_march *march, enum br_field_kind kind,
                     const struct br_stages *stages, bool switched);

/* Refuses a tip that has left the numbers at time t, s. */
enum br_status br_march_check_finite(const struct br_march *march, enum br_field_kind kind,
                                     double t, struct br_error *err);

/* Refuses (BR_NOT_FINITE) a march that has come to its end in a field where numbers end, too: with
 * a value that is not finite anywhere, or moved by so little that its digits are lost to underflow.
 */
enum br_status br_march_check_range(const struct br_march *march, enum br_field_kind kind,
                                    struct br_error *err);

/* What an adaptive scheme adds to a march; free releases it. Fails with BR_NO_MEMORY. */
enum br_status br_adaptive_create(struct br_march *march, struct br_error *err);

size_t br_adaptive_switches(const struct br_adaptive *adaptive, const struct br_switch **first);

/* On to the next of the march's time levels, with steps of its own. Fails as br_march_step, and
 * with BR_NOT_FINITE where no step is small enough. */
enum br_status br_adaptive_advance(struct br_march *march, struct br_error *err);

#endif
