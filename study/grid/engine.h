/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What marches prepared studies. A study names its engine; without one it takes the usual one. */
#ifndef BR_STUDY_GRID_ENGINE_H
#define BR_STUDY_GRID_ENGINE_H

#include "base/status.h"

struct br_study;
struct br_observer;

/* Marches prepared studies (cells allocated, grids known to nest), all of a call at once; but not
 * those that have failed already. */
struct br_engine {
    enum br_status (*march)(struct br_study *studies, size_t count, int threads,
                            const struct br_observer *observer, struct br_error *err);
};

/* Marches in this process: reference and cells side by side, as tasks. See br_study_run_each. */
enum br_status br_march_studies(struct br_study *studies, size_t count, int threads,
                                const struct br_observer *observer, struct br_error *err);

/* The usual engine, for the whole process: at first br_march_studies. For the main thread, before
 * any study runs. */
void br_engine_set(struct br_engine engine);

#endif
