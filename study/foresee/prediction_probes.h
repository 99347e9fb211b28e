/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The marches that a prediction is made from. */
#ifndef BR_STUDY_FORESEE_PREDICTION_PROBES_H
#define BR_STUDY_FORESEE_PREDICTION_PROBES_H

#include "study/foresee/warnings.h"
#include "study/grid/study.h"

enum br_probe_kind {
    BR_PROBE_TIGHT,     /* the run itself against steps by a tolerance, on a finer mesh */
    BR_PROBE_WHOLE,     /* the same against equal steps that are smaller */
    BR_PROBE_TIME,      /* steps against finer steps, on a coarse mesh, from 0 to T */
    BR_PROBE_START,     /* the run's own first steps against finer ones */
    BR_PROBE_ITERATION, /* the last cell of BR_PROBE_TIME against the same steps with a friction
                           rule that does not iterate */
    BR_PROBE_SPACE,     /* a mesh against a finer one, at few steps */
    BR_PROBES
};

/* The cells of BR_PROBE_TIGHT and BR_PROBE_WHOLE. */
enum br_whole_cell {
    BR_WHOLE_RUN,   /* the run */
    BR_WHOLE_CHECK, /* the reference on half its elements, with half its steps, or a larger
                       tolerance: how sure it is */
    BR_WHOLE_TIME,  /* the run's steps on the reference's mesh: the error of time */
    BR_WHOLE_SPACE, /* the run's mesh with the check's steps: the error of space */
    BR_WHOLE_STEPS, /* the reference's mesh with the check's steps: how sure it is of time */
    BR_WHOLE_CELLS
};

/* A study of a few cells against a fine run. Not to be moved. */
struct br_probe {
    bool held;     /* it is needed */
    bool measured; /* its first cell has the run's own n or steps: nothing is extrapolated */
    double beyond; /* the run's n or steps, or one over its tolerance, over those of the last
                      cell */
    double ratio;  /* the fine run's over those of the cell that tells the error */
    struct br_scene scene; /* borrows; its duration may be shorter */
    size_t n[BR_WHOLE_CELLS], steps[BR_WHOLE_CELLS];
    struct br_method method[BR_WHOLE_CELLS]; /* of the run and what it is compared with */
    struct br_study study;
};

struct br_probe_set {
    const struct br_planned_march *planned;
    struct br_probe probe[BR_PROBES];
};

/* Marches them. Where BR_PROBE_TIGHT or BR_PROBE_WHOLE is held and has not failed, it is about the
 * run itself, and neither BR_PROBE_TIME nor BR_PROBE_SPACE is held. How much is
 * counted, not timed, so that a prediction is the same on any machine. What fails is left in the
 * studies. Fails with BR_NO_MEMORY. Clear them even then. */
enum br_status br_probes_hold(struct br_probe_set *set, const struct br_planned_march *planned,
                              struct br_error *err);
void br_probes_clear(struct br_probe_set *set);

/* Why a probe tells nothing (out); false: it does, or is not held. */
bool br_probe_failed(const struct br_probe *probe, char why[200]);

#endif
