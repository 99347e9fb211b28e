/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A march of one cell, with room to look at it. */
#ifndef BR_STUDY_GRID_RUNNER_H
#define BR_STUDY_GRID_RUNNER_H

#include "solver/march.h"

struct br_resolution;

struct br_runner {
    struct br_march *march;
    struct br_view view;
    double seconds;
    struct br_error error; /* status BR_OK while all is well */
};

/* Starts the march; what fails is kept in runner->error, too. */
enum br_status br_runner_start(struct br_runner *runner, const struct br_scene *scene,
                               struct br_resolution at, const struct br_method *method);
void br_runner_clear(struct br_runner *runner);

/* Steps on to its time level `step`, and counts the seconds. */
enum br_status br_runner_advance(struct br_runner *runner, size_t step);

/* runner->view = a measure of the march as it is. */
void br_runner_look(struct br_runner *runner, enum br_field_kind kind, enum br_measure measure);

#endif
