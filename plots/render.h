/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Running gnuplot: scripts that draw pictures, a few side by side, and questions to it. */
#ifndef BR_PLOTS_RENDER_H
#define BR_PLOTS_RENDER_H

#include <sys/types.h>

#include "plots/figure.h"

/* What tells all that wait for gnuplot that they shall stop. NULL, as at first: nothing. */
void br_gnuplot_stop_when(bool (*stop)(void));

/* Runs a script in its folder and waits, as br_renderer_end_oldest. *missing (out): gnuplot is not
 * installed, and the call fails with BR_IO, as it does where gnuplot does. */
enum br_status br_gnuplot_run(const char *folder, const char *script, bool *missing,
                              struct br_error *err);

/* Whether a picture that gnuplot has drawn is whole, which gnuplot does not look at: fails with
 * BR_IO where it is not there, or does not end as its kind does. */
enum br_status br_picture_check(const char *path, struct br_error *err);

/* Whether the installed gnuplot has a terminal; *missing as above, and then the call succeeds. */
enum br_status br_gnuplot_has(const char *terminal, bool *has, bool *missing, struct br_error *err);

/* Draws a figure with letters, `columns` wide, into `out`. Fails as br_gnuplot_run. */
enum br_status br_gnuplot_letters(FILE *out, const struct br_figure *figure, int columns,
                                  bool *missing, struct br_error *err);

/* ---- pictures ---- */

/* Scripts that gnuplot is at work on, a few side by side, in order. Begins as zeros. */
enum { BR_MOST_RENDERINGS = 8, BR_SCRIPT_NAME = 512 };
struct br_renderer {
    size_t count;
    struct br_rendering {
        char folder[4096], script[BR_SCRIPT_NAME];
        pid_t child;
        int said;       /* the end of a pipe: what gnuplot says */
        double started; /* s, by the monotonic clock */
    } at_work[BR_MOST_RENDERINGS];
};

/* Starts gnuplot on a script in its folder, when there is room: waits for the oldest one and
 * fails where that did. *missing (out): gnuplot is not installed, and the call fails with BR_IO.
 * Finish the renderer even after a failure. */
enum br_status br_renderer_add(struct br_renderer *renderer, const char *folder, const char *script,
                               bool *missing, struct br_error *err);

/* Waits for the first of them, of which there is one. Fails with BR_IO where gnuplot did, with the
 * line in which it says why, where it took longer than a minute (or BEAMRATE_GNUPLOT_SECONDS), and
 * where a picture is not complete (a full disk): then no picture of the script stays. Fails with
 * BR_INTERRUPTED when the work is to stop. A gnuplot that has not ended is killed. */
enum br_status br_renderer_end_oldest(struct br_renderer *renderer, struct br_error *err);

/* Waits for all of them. Fails as the first one that failed. */
enum br_status br_renderer_finish(struct br_renderer *renderer, struct br_error *err);

/* Both for one script. */
enum br_status br_plot_render(const char *folder, const char *script, bool *missing,
                              struct br_error *err);

#endif
