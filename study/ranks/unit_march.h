/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A group of units at work, and what comes out, as bytes that another rank of the same program can
 * read. */
#ifndef BR_STUDY_RANKS_UNIT_MARCH_H
#define BR_STUDY_RANKS_UNIT_MARCH_H

#include "study/grid/observer.h"
#include "study/ranks/units.h"

/* Bytes, with a place where they are read. */
struct br_parcel {
    char *bytes; /* owned */
    size_t size, at;
};

/* Marches a group of units of prepared studies (in; not changed) and packs the results (out: owned
 * by the caller, even after a failure). A study that fails is a result; fails as br_study_run_each
 * does. */
enum br_status br_group_march(const struct br_study *studies, const struct br_units *units,
                              size_t group, int threads, const struct br_observer *observer,
                              struct br_parcel *parcel, struct br_error *err);

/* Puts the results of a group into the studies. Fails with BR_NO_MEMORY, or with BR_IO where the
 * parcel is not what was packed. */
enum br_status br_group_unpack(struct br_study *studies, const struct br_units *units, size_t group,
                               struct br_parcel *parcel, struct br_error *err);

#endif
