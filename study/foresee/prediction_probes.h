/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The marches that a prediction is made from. */
#ifndef BR_STUDY_FORESEE_PREDICTION_PROBES_H
#define BR_STUDY_FORESEE_PREDICTION_PROBES_H

#include "study/foresee/warnings.h"
#include "study/grid/study.h"

enum br_probe_kind {
    BR_PROBE_TIGHT,     /* the run itself against adaptive steps, on a finer mesh */
    BR_PROBE_WHOLE,     /* the run itself against smaller equal steps */
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
    BR_WHOLE_CHECK, /* the reference with half its elements, and half its steps or a larger
                       tolerance: shows how sure the reference is */
    BR_WHOLE_TIME,  /* the run's steps on the reference's mesh: the error of time */
    BR_WHOLE_SPACE, /* the run's mesh with the check's steps: the error of space */
    BR_WHOLE_STEPS, /* the reference's mesh with the check's steps: how sure it is in time */
    BR_WHOLE_CELLS
};

/* A study of a few cells against a fine run. Must not be moved: the study points into it. */
struct br_probe {
    bool active;   /* it is set up, and marched */
    bool measured; /* its first cell has the run's own n or steps: nothing is extrapolated */
    double beyond; /* the run's n or steps, or one over its tolerance, over those of the last
                      cell */
    double ratio;  /* the fine run's over those of the cell with the error */
    struct br_scene scene; /* borrows; its duration may be shorter */
    size_t n[BR_WHOLE_CELLS], steps[BR_WHOLE_CELLS];
    struct br_method method[BR_WHOLE_CELLS]; /* of the cells */
    struct br_study study;
};

struct br_probe_set {
    const struct br_planned_march *planned;
    struct br_probe probe[BR_PROBES];
};

/* Sets the probes up and marches them. If BR_PROBE_TIGHT or BR_PROBE_WHOLE is active, it marches
 * the run itself, and neither BR_PROBE_TIME nor BR_PROBE_SPACE is active. Work is counted, not
 * timed, so that a prediction is the same on any machine. Failures of marches stay in the studies.
 * Fails with BR_NO_MEMORY. Clear the set even then. */
enum br_status br_probes_march(struct br_probe_set *set, const struct br_planned_march *planned,
                               struct br_error *err);
void br_probes_clear(struct br_probe_set *set);

/* Whether an active probe has failed, and why (out). */
bool br_probe_failed(const struct br_probe *probe, char why[200]);

#endif
