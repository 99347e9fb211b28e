/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pictures in a folder of results: scripts and data, rendered while other files are written. A
 * picture that fails costs no table and no exit code: a warning says which, and why. */
#ifndef BR_CLI_PICTURE_FILES_H
#define BR_CLI_PICTURE_FILES_H

#include "cli/output.h"
#include "plots/figure.h"
#include "plots/render.h"

/* Begins with its output, the rest zeros. */
struct br_picture_files {
    const struct br_output *output;
    struct br_gnuplot at_work[8]; /* side by side, in order */
    size_t count;
    bool missing; /* gnuplot */
    bool said;    /* that it is */
};

/* Writes a figure's data and script to the output and starts gnuplot on it, where there is one.
 * Fails as br_figure_check, or with BR_IO, BR_INTERRUPTED. Finish the files even then. */
enum br_status br_picture_files_draw(struct br_picture_files *files, const struct br_figure *figure,
                                     struct br_error *err);

/* Warns of a picture that gnuplot has not drawn (what: its name). Fails with BR_INTERRUPTED where
 * that is why. */
enum br_status br_picture_failed(const struct br_error *why, const char *what,
                                 struct br_error *err);

/* Waits for all pictures, and says once where gnuplot is missing. May be called again. Fails with
 * BR_INTERRUPTED. */
enum br_status br_picture_files_finish(struct br_picture_files *files, struct br_error *err);

#endif
