/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The work of a call of br_study_run, cut into batches for ranks. A batch is some cells of one or
 * more studies, with their references; a rank marches one batch at a time. Every rank makes the
 * same cut. */
#ifndef BR_STUDY_GRID_BATCHES_H
#define BR_STUDY_GRID_BATCHES_H

#include <stdio.h>

#include "base/observer.h"
#include "study/grid/study.h"

/* Which batch each cell belongs to; batches of lower numbers begin first. */
struct br_batches {
    size_t count;
    double *cost; /* of each batch, about, s of one thread; owned */
    size_t *of;   /* of each cell, the studies one after the other: its batch; SIZE_MAX: none, since
                     its study has failed. Owned */
};

/* Cuts prepared studies for so many ranks, of so many threads each. Fails with BR_NO_MEMORY; clear
 * the batches even then. */
enum br_status br_batches_create(struct br_batches *batches, const struct br_study *studies,
                                 size_t count, int ranks, int threads, struct br_error *err);
void br_batches_clear(struct br_batches *batches);

/* Marches a batch, and appends to `results` bytes that any rank of the same program can read. The
 * cells of its studies, and all of the studies behind the first norm, are overwritten and mean
 * nothing until br_batches_read. A study that fails is a result; fails as br_study_run_each does.
 */
enum br_status br_batch_march(struct br_study *studies, size_t count,
                              const struct br_batches *batches, size_t batch, int threads,
                              const struct br_observer *observer, FILE *results,
                              struct br_error *err);

/* Puts the results of all batches (size bytes, in any order) into the studies. Fails with
 * BR_NO_MEMORY, or with BR_IO where they are not what was written. */
enum br_status br_batches_read(struct br_study *studies, size_t count,
                               const struct br_batches *batches, char *bytes, size_t size,
                               struct br_error *err);

/* Which slice each cell belongs to (out, br_study_cells), so that all cost about the same. Returns
 * the largest cost of a slice's cells, s. -1: out of memory. */
double br_slice_cells(const struct br_study *study, size_t slices, size_t *slice);

/* A hash of what studies ask (base/statement.h), equal on ranks that have read the same
 * scenes and options. */
unsigned long long br_studies_fingerprint(const struct br_study *studies, size_t count);

#endif
