/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Plots of a report: a registry. Each is a gnuplot script beside its data file, both
 * made to be read, edited and run again; nothing is computed here.
 *
 * To add a plot: one file that defines a `const struct br_plot`, and one row in plots.c. */
#ifndef BR_PLOTS_PLOTS_H
#define BR_PLOTS_PLOTS_H

#include <stdio.h>
#include <sys/types.h>

#include "study/fit/report.h"

/* A row of the registry. Its files are <report->name>-<name>.dat, .gp, .svg and .png. */
struct br_plot {
    const char *name;  /* of the files */
    const char *title; /* one line for a person */
    bool (*applies)(const struct br_report *report);
    /* Write the data and the script (out: open files; the caller checks for errors).
     * stem: the files' name without its extension. */
    void (*write_data)(FILE *out, const struct br_report *report);
    void (*write_script)(FILE *out, const struct br_report *report, const char *stem);
};

extern const struct br_plot br_plot_h, br_plot_k, br_plot_parts, br_plot_printed;

/* The registry; NULL-terminated. */
extern const struct br_plot *const br_plots[];

/* The plot of that name, or NULL. */
const struct br_plot *br_plot_find(const char *name);

/* Writes the name of a plot's file with that extension ("gp", "svg"...) into `file` (out,
 * size bytes). Fails with BR_BAD_INPUT where report->name makes no file name. */
enum br_status br_plot_file(const struct br_plot *plot, const struct br_report *report,
                            const char *extension, char *file, size_t size, struct br_error *err);

/* Writes data and script into an existing folder. Ask plot->applies first. Fails with
 * BR_BAD_INPUT (as br_plot_file) or BR_IO, perhaps leaving one of the files behind. */
enum br_status br_plot_write(const struct br_plot *plot, const struct br_report *report,
                             const char *folder, struct br_error *err);

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
