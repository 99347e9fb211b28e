/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The work of a command before it begins: its marches, with their forecast time and memory. */
#ifndef BR_STUDY_ESTIMATE_COST_ESTIMATE_H
#define BR_STUDY_ESTIMATE_COST_ESTIMATE_H

#include "study/estimate/warnings.h"
#include "study/grid/study.h"

/* Begins as zeros, but for the first two members. */
struct br_cost_estimate {
    bool together;  /* all are in memory at once, not one after the other */
    bool alone;     /* one thread marches, however many there are */
    size_t marches; /* cells and fine references are marches, too */
    size_t untimed; /* of these, those that choose their steps: their time is not known */
    double seconds; /* of one thread, where known */
    double steps;   /* of these, what steps take: without errors and references */
    double longest; /* march or reference, s */
    double bytes;   /* at one time */
    struct br_planned_march dearest; /* the longest march; borrows */
};

/* Adds the cells of a study and its reference; the study need not be prepared. */
void br_cost_estimate_add_study(struct br_cost_estimate *work, const struct br_study *study);

void br_cost_estimate_add_march(struct br_cost_estimate *work,
                                const struct br_planned_march *planned);

/* The costs of the registry are those of one machine: measures some steps of the longest march, for
 * a millisecond or so, and corrects the seconds by their pace here. */
void br_cost_estimate_measure(struct br_cost_estimate *work);

/* Approximate seconds on so many threads, where known. */
double br_cost_estimate_seconds(const struct br_cost_estimate *work, int threads);

/* Refuses (BR_NO_MEMORY) studies that do not fit into so many bytes of memory: br_study_run has all
 * cells and fine references in memory at once. The studies need not be prepared. */
enum br_status br_fit_together(const struct br_study *studies, size_t count, double available,
                               struct br_error *err);

#endif
