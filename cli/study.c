/* SPDX-License-Identifier: GPL-3.0-or-later */
/* beamrate study SCENE: a grid of cells against one reference. */
#include "cli/command.h"
#include "cli/study_run.h"

static enum br_status run(const struct br_options *options, struct br_error *err)
{
    const struct br_study_job job = {.scene = options->word[0]};
    return br_study_run_jobs(&job, 1, options, false, err);
}

const struct br_command br_command_study = {
    .bit = BR_FOR_STUDY,
    .name = "study",
    .arguments = "SCENE",
    .title = "the errors of a grid of meshes and time steps, and their orders",
    .about = "The errors of a grid of cells (n, k) of a scene against the exact solution or a fine "
             "run.",
    .more =
        "A scene is a file, or one of the bundled scenes that 'beamrate scenes' lists. The errors "
        "are measured in exact norms over all time levels, and the orders of convergence are "
        "fitted with 95 % intervals.",
    .example = {"beamrate study example4 -n 50,100,200 -k 0.03,0.015 --reference fine:800,1e-3",
                "beamrate study example2 --norm l2,energy,tip",
                "beamrate study release --reference none"},
    .least_words = 1,
    .most_words = 1,
    .run = run,
};
