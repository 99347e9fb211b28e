/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a command would march, with its time and memory, foreseen and not begun. */
#ifndef BR_STUDY_FORESEE_FORESEEN_H
#define BR_STUDY_FORESEE_FORESEEN_H

#include "study/foresee/warnings.h"
#include "study/trade/trial.h"

/* Marches of one kind. Names are borrowed. */
struct br_foreseen_march {
    const char *scene;
    const char *what; /* "cell", "reference", "march", "trial", or the judge that evaluates */
    struct br_resolution at;
    const struct br_scene *of;
    struct br_method method; /* without a scheme: none, a judge of no mesh */
    double seconds;          /* of one thread; NaN: not known, or the steps are chosen as it goes */
    double bytes;            /* NaN: not known */
};

/* Begins as zeros. */
struct br_foreseen {
    struct br_foreseen_march *row; /* rows; owned */
    size_t rows, room;
    bool together;    /* all are in memory at once, not one after the other */
    bool alone;       /* one thread marches, whatever there is */
    const char *then; /* what comes behind these and cannot be foreseen; NULL: nothing */
    bool lost;        /* one, where there was no memory */
};
void br_foreseen_clear(struct br_foreseen *work);

/* Adds the cells of a study and its reference; the study need not be prepared. */
void br_foreseen_add_study(struct br_foreseen *work, const struct br_study *study);

/* Adds a march, and a trial with its repeats. */
void br_foreseen_add_march(struct br_foreseen *work, const struct br_planned_march *planned);
void br_foreseen_add_trial(struct br_foreseen *work, const struct br_trial *trial,
                           const struct br_trial_request *request);

/* All rows together, on so many threads: s, about, as far as it is known, and bytes at once. */
double br_foreseen_seconds(const struct br_foreseen *work, int threads);
double br_foreseen_bytes(const struct br_foreseen *work);

/* Refuses (BR_NO_MEMORY) studies whose marches, cells and fine references, do not fit into a memory
 * of so many bytes: br_study_run has them all at once. They need not be prepared. */
enum br_status br_fit_together(const struct br_study *studies, size_t count, double available,
                               struct br_error *err);

#endif
