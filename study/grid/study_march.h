/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The reference and the cells of a study on their way through time: study_march_setup.c creates the
 * state, study_march.c does its batches, lanes.c chooses who does which, sweep.c takes the results.
 * Private to these files and costs.c. */
#ifndef BR_STUDY_GRID_STUDY_MARCH_H
#define BR_STUDY_GRID_STUDY_MARCH_H

#include <pthread.h>
#include <stdatomic.h>

#include "base/observer.h"
#include "study/grid/nested_meshes.h"
#include "study/grid/study.h"

enum {
    BR_STUDY_MARCH_BUFFERS = 4,
    BR_STUDY_MARCH_LEAD = 20000, /* steps of a fine run in a buffer, unless its levels have more */
    BR_MEASURED = 2 * BR_MEASURES
};

/* One measure of one field of the reference and the cells. */
struct br_measured {
    struct br_sample_at at;
    bool used, last_only;                /* last_only: measured only at t = T */
    size_t size;                         /* of a projection */
    struct br_nested_meshes *nested;     /* NULL: one number, the tip's */
    struct br_view *root_view;           /* the reference on the root meshes */
    double *projection;                  /* buffered_levels * size */
    struct br_view check;                /* the check on the first root mesh */
    struct br_nested_meshes *own_nested; /* of that mesh alone; NULL for the tip */
    double *own_projection;              /* the reference there */
};

/* A reference at work. */
struct br_reference_run {
    const struct br_reference *reference_kind;
    void *self;
    struct br_sample *sample; /* buffered_levels: norms of the reference, or its distances from the
                                 reference check */
    struct br_norm_sum *sum;  /* norms, of the same */
    double time;              /* of the last sample, s */
};

/* A cell's march, with a buffer to sample it. */
struct br_runner {
    struct br_march *march;
    struct br_view view;
    double seconds;
    struct br_error error; /* status BR_OK while all is well */
};

/* What works through the batches, one after the other: a field of the reference, the sums, or the
 * cells of a task. */
enum { BR_LANE_AXIAL, BR_LANE_BENDING, BR_LANE_SUMS, BR_LANE_CELLS };
struct br_lane {
    size_t done; /* batches */
    bool busy;   /* a thread does the next one */
};

struct br_study_march {
    struct br_study *study;                             /* the first of its chain */
    size_t norms;                                       /* in the chain */
    struct br_measured measured[BR_MEASURED];           /* by field, then measure */
    struct br_reference_run reference, reference_check; /* the reference check's kind may be NULL */
    atomic_size_t first_failed; /* the index of the first level at which a field failed, */
    struct br_error failure;    /* and why; status BR_OK while all is well; under the lock */
    pthread_mutex_t lock;
    size_t *root_mesh; /* on which the reference is sampled */
    size_t root_meshes;
    size_t check_every;           /* of the levels, so that there are not too many checks */
    struct br_runner *cell;       /* br_study_cells */
    size_t *task_cell, tasks;     /* the first cell that each task marches; then the end */
    struct br_norm_sum *cell_sum; /* norms for each cell */
    size_t *level;                /* reference steps at which some cell has a time level */
    size_t level_count, batch, batches;
    size_t buffered_levels; /* levels in all buffers together */
    const struct br_observer *observer;
    struct br_store store; /* of all arrays, and of the nested meshes */
    atomic_bool stopped;
    struct br_lane *lane; /* BR_LANE_CELLS + tasks */
};

/* The elements of a field, of the cells and of the reference. */
static inline struct br_elements br_study_march_elements(const struct br_study_march *l,
                                                         enum br_field_kind kind)
{
    return (struct br_elements){kind, l->study->method.axial_degree};
}

/* Sets up all that a prepared study needs; clear it even after a failure. */
enum br_status br_study_march_create(struct br_study_march *march, struct br_study *study,
                                     const struct br_observer *observer, struct br_error *err);
void br_study_march_clear(struct br_study_march *march);

/* Marks a cell as failed in all norms, with the reason. */
void br_cell_failed(struct br_study *study, size_t cell, const struct br_error *error);

/* Batch b of a field of the reference, of the sums, and of the cells of a task. */
void br_reference_batch(struct br_study_march *march, enum br_field_kind kind, size_t b);
void br_sums_batch(struct br_study_march *march, size_t b);
void br_cells_batch(struct br_study_march *march, size_t b, size_t task);

/* Does all batches of `count` studies that are set up. */
void br_lanes_run(struct br_study_march *march, size_t count, int threads,
                  const struct br_observer *observer);

#endif
