/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What lockstep_setup.c sets up and lockstep.c runs and measures; for these alone. */
#ifndef BR_STUDY_GRID_LOCKSTEP_H
#define BR_STUDY_GRID_LOCKSTEP_H

#include <stdatomic.h>

#include "study/grid/ladder.h"
#include "study/grid/observer.h"
#include "study/grid/study.h"

enum { BR_LOCKSTEP_BUFFERS = 4, BR_CHANNELS = 2 * BR_MEASURES };

/* One measure of one field of the reference and the cells. */
struct br_channel {
    struct br_sample_at at;
    bool used, last_only;         /* only at t = T */
    size_t size;                  /* of a projection */
    struct br_ladder *ladder;     /* NULL: one number, the tip's */
    struct br_view *root;         /* the reference on its meshes */
    double *projection;           /* slots * size */
    struct br_view audit;         /* the auditor on the first of them */
    struct br_ladder *own_ladder; /* that mesh alone; NULL: the tip's */
    double *own_projection;       /* the reference there */
};

/* A judge at work. */
struct br_bench {
    const struct br_judge *judge;
    void *self;
    struct br_sample *sample; /* slots: sizes of the reference, or its distances from the auditor */
    struct br_norm_sum *sum;  /* norms, of the same */
    double time;              /* of the last sample, s */
};

/* A cell's march, with room to look at it. */
struct br_runner {
    struct br_march *march;
    struct br_view view;
    double seconds;
    struct br_error error; /* status BR_OK while all is well */
};

struct br_lockstep {
    struct br_study *study;                 /* the first of its chain */
    size_t norms;                           /* in the chain */
    struct br_channel channel[BR_CHANNELS]; /* by field, then measure */
    struct br_bench reference, auditor;     /* the auditor's judge may be NULL */
    atomic_size_t first_failed; /* the index of the first level at which a field failed, */
    struct br_error failure;    /* and why; status BR_OK while all is well */
    size_t *root;               /* the meshes on which the reference is looked at */
    size_t roots;
    size_t audit_every;     /* of the levels, so that there are not too many audits */
    struct br_runner *cell; /* br_study_cells */
    size_t *crew, crews; /* the first cells of crews, whose cells march in one task; and the end */
    struct br_norm_sum *cell_sum; /* norms for each cell */
    size_t *level;                /* reference steps at which some cell has a time level */
    size_t level_count, batch, batches;
    size_t slots; /* levels that there is room for at once: of so many batches as buffers */
    const struct br_observer *observer;
    struct br_store store; /* of all arrays, and of the ladders */
    atomic_bool stopped;
    /* What tasks depend on: by br_field_kind, the reference's march and its buffers; and those that
     * add up. */
    char marched[2], filled[2][BR_LOCKSTEP_BUFFERS], tally;
};

/* The elements of a field, of the cells and of the reference. */
static inline struct br_elements br_lockstep_elements(const struct br_lockstep *l,
                                                      enum br_field_kind kind)
{
    return (struct br_elements){kind, l->study->method.axial_degree};
}

/* Sets up all that a prepared study needs; clear it even after a failure. */
enum br_status br_lockstep_create(struct br_lockstep *lockstep, struct br_study *study,
                                  const struct br_observer *observer, struct br_error *err);
void br_lockstep_clear(struct br_lockstep *lockstep);

/* Marks a cell as failed in all norms, with the reason. */
void br_cell_failed(struct br_study *study, size_t cell, const struct br_error *error);

#endif
