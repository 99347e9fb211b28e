/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The coarse marches that a prediction is made from. */
#ifndef BR_PREDICTION_PROBES_H
#define BR_PREDICTION_PROBES_H

#include "study/study.h"
#include "study/warnings.h"

enum br_probe_kind {
    BR_PROBE_TIME,  /* steps against finer steps, on a coarse mesh, from 0 to T */
    BR_PROBE_START, /* the run's own first steps against finer ones */
    BR_PROBE_SPACE, /* a mesh against a finer one, at few steps */
    BR_PROBES
};

/* A study of one or two cells against a fine run. Not to be moved. */
struct br_probe {
    bool held;     /* it is needed */
    bool measured; /* its first cell has the run's own n or steps: nothing is extrapolated */
    double beyond; /* the run's n or steps, or one over its tolerance, over those of the last
                      cell */
    double ratio;  /* the fine run's over those of the cell that tells the error */
    struct br_scene scene; /* borrows; its duration may be shorter */
    size_t n[2], steps[2];
    struct br_study study;
};

struct br_probe_set {
    const struct br_outlook *outlook;
    struct br_probe probe[BR_PROBES];
};

/* Marches them. What fails is left in the studies. Fails with BR_NO_MEMORY, or with BR_INTERRUPTED
 * where it takes too long. Clear them even then. */
enum br_status br_probes_hold(struct br_probe_set *set, const struct br_outlook *outlook,
                              struct br_error *err);
void br_probes_clear(struct br_probe_set *set);

#endif
