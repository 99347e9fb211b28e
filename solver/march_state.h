/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What march.c steps through fixed steps and adaptive.c through its own; for these alone. */
#ifndef BR_SOLVER_MARCH_STATE_H
#define BR_SOLVER_MARCH_STATE_H

#include "solver/margins.h"
#include "solver/part.h"

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
    struct br_part part[2]; /* by br_field_kind */
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

/* Whether a scheme takes both fields through its steps together. */
static inline bool br_fields_go_together(const struct br_march *march)
{
    return march->method.scheme->adaptive;
}

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

/* About the largest strains (out) until the end, by a few Euler steps; the march is then where it
 * was. Fails as br_march_step. */
enum br_status br_rough_size(struct br_march *march, double largest[2], struct br_error *err);

/* What an adaptive scheme adds to a march. Fails with BR_NO_MEMORY. */
enum br_status br_adaptive_create(struct br_march *march, struct br_error *err);
void br_adaptive_free(struct br_adaptive *adaptive); /* accepts NULL */

size_t br_adaptive_switches(const struct br_adaptive *adaptive, const struct br_switch **first);

/* On to the next of the march's time levels, with steps of its own. Fails as br_march_step, and
 * with BR_NOT_FINITE where no step is small enough. */
enum br_status br_adaptive_advance(struct br_march *march, struct br_error *err);

#endif
