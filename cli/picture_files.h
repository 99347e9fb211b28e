/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Charts and heat maps in a folder of results: scripts and data, rendered while other files are
 * written. */
#ifndef BR_PICTURE_FILES_H
#define BR_PICTURE_FILES_H

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

/* Write the data and the script, and start gnuplot on it, where there is one. Fail with BR_IO.
 * Finish the files even then. */
enum br_status br_picture_files_chart(struct br_picture_files *files, const struct br_chart *chart,
                                      struct br_error *err);
enum br_status br_picture_files_heat(struct br_picture_files *files, const struct br_heat *heat,
                                     struct br_error *err);

/* Waits for all pictures, and says where gnuplot is missing. Fails with BR_IO where gnuplot did. */
enum br_status br_picture_files_finish(struct br_picture_files *files, struct br_error *err);

#endif
