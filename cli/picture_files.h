/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pictures in a folder of results: scripts and data, rendered while other files are written. A
 * picture that fails costs no table and no exit code: a warning says which, and why. */
#ifndef BR_CLI_PICTURE_FILES_H
#define BR_CLI_PICTURE_FILES_H

#include "cli/output.h"
#include "plots/chart.h"
#include "plots/heat.h"
#include "plots/plots.h"

/* Begins with its output, the rest zeros. */
struct br_picture_files {
    const struct br_output *output;
    struct br_renderer renderer;
    bool missing; /* gnuplot */
};

/* Starts gnuplot, where there is one, on a script that has been written to the output. Fails with
 * BR_INTERRUPTED. Finish the files even then. */
enum br_status br_picture_files_render(struct br_picture_files *files, const char *script,
                                       struct br_error *err);

/* Write the data and the script, and render it. Fail with BR_IO, or as above. */
enum br_status br_picture_files_chart(struct br_picture_files *files, const struct br_chart *chart,
                                      struct br_error *err);
enum br_status br_picture_files_heat(struct br_picture_files *files, const struct br_heat *heat,
                                     struct br_error *err);

/* Warns of a picture that gnuplot has not drawn (what: its name). Fails with BR_INTERRUPTED where
 * that is why. */
enum br_status br_picture_failed(const struct br_error *why, const char *what,
                                 struct br_error *err);

/* Waits for all pictures, and says where gnuplot is missing. Fails with BR_INTERRUPTED. */
enum br_status br_picture_files_finish(struct br_picture_files *files, struct br_error *err);

#endif
