/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the parts of a step cost, as measured: the march's solver is wrapped in one that reads the
 * clock around what it calls, so that the march itself knows nothing of it. */
#ifndef BR_STUDY_RUN_STEP_COST_H
#define BR_STUDY_RUN_STEP_COST_H

#include "study/run/history.h"

/* X(name, text): the parts. */
#define BR_COST_LIST(X)                          \
    X(BR_COST_LOAD_AXIAL, "load, axial")         \
    X(BR_COST_FIELD_AXIAL, "axial field")        \
    X(BR_COST_CONTACT, "contact law")            \
    X(BR_COST_LOAD_BENDING, "load, bending")     \
    X(BR_COST_FIELD_BENDING, "bending field")    \
    X(BR_COST_FRICTION, "friction law")          \
    X(BR_COST_RECORD, "records")                 \
    X(BR_COST_CHECK, "certificate and energies") \
    X(BR_COST_OUTPUT, "output")

enum br_cost_part {
#define X(name, text) name,
    BR_COST_LIST(X)
#undef X
        BR_COST_PARTS
};

/* One march's cost; one at a time in a thread. */
struct br_step_cost {
    double seconds[BR_COST_PARTS]; /* the clock's own cost is taken off by br_step_cost_end */
    size_t laps[BR_COST_PARTS];
    double lap_seconds;              /* what a reading of the clock costs */
    double last;                     /* private: time of the last reading, s */
    struct br_linear_solver wrapped; /* private */
};

const char *br_cost_part_text(enum br_cost_part part);

/* Begins: method (in/out) gets a solver that measures, for marches that are created and made in
 * this thread until br_step_cost_end. cost: out; it must outlive the march. */
void br_step_cost_begin(struct br_step_cost *cost, struct br_method *method);

/* Ends, and takes off what reading the clock took. */
void br_step_cost_end(struct br_step_cost *cost);

/* The time since the last reading goes to a part; cost NULL: nothing. For observers. */
void br_step_cost_lap(struct br_step_cost *cost, enum br_cost_part part);

/* An observer that ends a part: put it behind the observers whose work that is. `step` tells which
 * of an observer's calls are meant: that of every step, or those of rows and looks. */
struct br_cost_mark {
    struct br_step_cost *cost;
    enum br_cost_part part;
};
struct br_history_observer br_cost_mark_step(struct br_cost_mark *mark);
struct br_history_observer br_cost_mark_output(struct br_cost_mark *mark);

#endif
