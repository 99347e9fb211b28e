/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A dry run: the marches of a command with their forecast time and memory. Nothing is marched. */
#ifndef BR_STUDY_FORESEE_FORESEEN_H
#define BR_STUDY_FORESEE_FORESEEN_H

#include "study/foresee/warnings.h"
#include "study/trade/trial.h"

/* One row: a march, or the work of a judge. Names are borrowed. */
struct br_foreseen_march {
    const char *scene;
    const char *what; /* "cell", "reference", "march", "trial", or the judge that evaluates */
    struct br_resolution at;
    const struct br_scene *of;
    struct br_method method; /* scheme NULL: a judge without a mesh */
    double seconds;          /* of one thread; NaN: not known, or an adaptive scheme */
    double bytes;            /* NaN: not known */
};

/* Begins as zeros. */
struct br_foreseen {
    struct br_foreseen_march *row; /* rows; owned */
    size_t rows, room;
    bool together;    /* all are in memory at once, not one after the other */
    bool alone;       /* one thread marches, however many there are */
    const char *then; /* later work that cannot be forecast; NULL: none */
    bool lost;        /* a row was lost, for lack of memory */
};
void br_foreseen_clear(struct br_foreseen *work);

/* Adds the cells of a study and its reference; the study need not be prepared. */
void br_foreseen_add_study(struct br_foreseen *work, const struct br_study *study);

/* Adds a march, and a trial with its repeats. */
void br_foreseen_add_march(struct br_foreseen *work, const struct br_planned_march *planned);
void br_foreseen_add_trial(struct br_foreseen *work, const struct br_trial *trial,
                           const struct br_trial_request *request);

/* Of all rows: approximate seconds on so many threads, where known, and bytes at one time. */
double br_foreseen_seconds(const struct br_foreseen *work, int threads);
double br_foreseen_bytes(const struct br_foreseen *work);

/* Refuses (BR_NO_MEMORY) studies that do not fit into so many bytes of memory: br_study_run has all
 * cells and fine references in memory at once. The studies need not be prepared. */
enum br_status br_fit_together(const struct br_study *studies, size_t count, double available,
                               struct br_error *err);

#endif
