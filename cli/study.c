/* SPDX-License-Identifier: GPL-3.0-or-later */
/* beamrate study SCENE: a grid of cells against one reference. */
#include "cli/command.h"
#include "cli/study_run.h"

static enum br_status run(int argc, const char **argv, struct br_error *err)
{
    struct br_study_options options = {0};
    char *scene = NULL;
    enum br_status status = br_study_options_parse(
        argc, argv,
        "SCENE [OPTION...]\n\nThe errors of a grid of cells (n, k) of a scene against the "
        "exact solution\nor a fine run. Without --n, --k or --reference: n = 25, 50, 100, 200; "
        "k = T/100,\nT/200, T/400, T/800; exact.\n\nExample:\n  beamrate study example4 "
        "--n 50,100,200 --k 0.03,0.015 --reference fine:800,1e-3\n",
        &options, &scene, err);
    const struct br_study_job job = {.scene = scene};
    if (!status && !options.help)
        status = br_study_run_jobs(&job, 1, &options, false, err);
    free(scene);
    br_study_options_clear(&options);
    return status;
}

const struct br_command br_command_study = {
    .name = "study",
    .arguments = "SCENE",
    .title = "the errors of a grid of meshes and time steps, and their orders",
    .run = run,
};
