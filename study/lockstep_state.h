/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What lockstep.c works on and lockstep_setup.c sets up; for these two alone. */
#ifndef BR_LOCKSTEP_STATE_H
#define BR_LOCKSTEP_STATE_H

#include <stdatomic.h>

#include "study/ladder.h"
#include "study/runner.h"
#include "study/study.h"

enum { BR_LOCKSTEP_BUFFERS = 2 };

/* One field of the reference and the cells. */
struct br_channel {
    bool modelled;
    struct br_ladder *ladder;
    struct br_root_value *root;              /* the reference on its meshes */
    double *projection[BR_LOCKSTEP_BUFFERS]; /* batch * ladder size */
    double *audit;                           /* the auditor's modes on the reference's mesh */
};

/* A judge at work. */
struct br_bench {
    const struct br_judge *judge;
    void *self;
    struct br_error error; /* status BR_OK while all is well */
};

struct br_lockstep {
    struct br_study *study;
    struct br_channel channel[2];       /* by br_field_kind */
    struct br_bench reference, auditor; /* the auditor's judge may be NULL */
    size_t *root;                       /* the meshes on which the reference is looked at */
    size_t roots;
    size_t audit_every;     /* of the levels, so that there are not too many audits */
    struct br_runner *cell; /* n_count * k_count */
    size_t *level;          /* reference steps at which some cell has a time level */
    size_t level_count, batch, batches;
    const struct br_observer *observer;
    atomic_bool stopped;
    char token[BR_LOCKSTEP_BUFFERS]; /* what the tasks depend on: the buffers */
};

/* Sets up all that a prepared study needs; clear it even after a failure. */
enum br_status br_lockstep_create(struct br_lockstep *lockstep, struct br_study *study,
                                  const struct br_observer *observer, struct br_error *err);
void br_lockstep_clear(struct br_lockstep *lockstep);

/* Marks a cell as failed, with the reason. */
void br_cell_failed(struct br_cell *cell, const struct br_error *error);

#endif
