/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Running gnuplot, and ffmpeg. All fail with BR_IO where gnuplot does, with the line in which it
 * says why, and where it takes longer than a minute (or BEAMRATE_GNUPLOT_SECONDS); with
 * BR_INTERRUPTED when the work is to stop. A gnuplot that has not ended is killed. */
#ifndef BR_PLOTS_RENDER_H
#define BR_PLOTS_RENDER_H

#include <stdbool.h>
#include <stdio.h>
#include <sys/types.h>

#include "solver/status.h"
#include "study/grid/observer.h"

/* What tells all that wait for gnuplot that they shall stop. NULL, as at first: nothing. */
void br_gnuplot_stop_when(bool (*stop)(void));

/* A script that gnuplot is at work on; several may be so side by side. */
enum { BR_SCRIPT_NAME = 512 };
struct br_gnuplot {
    const char *program; /* its name */
    char folder[4096], script[BR_SCRIPT_NAME];
    pid_t child;
    FILE *said;     /* what it says */
    double started; /* s, by the monotonic clock */
    /* of a script that says a dot a picture: who is told how many it has drawn of all; NULL: nobody
     */
    const struct br_observer *observer;
    size_t pictures;
};

/* Starts gnuplot on a script in its folder, or on commands (script NULL) that stand in a file.
 * *missing (out): gnuplot is not installed, and the call fails. End what has been started. */
enum br_status br_gnuplot_start(struct br_gnuplot *g, const char *folder, const char *script,
                                FILE *commands, bool *missing, struct br_error *err);

/* Waits for the end. */
enum br_status br_gnuplot_end(struct br_gnuplot *g, struct br_error *err);

/* The same for the script of a figure. Fails, too, where a picture is not complete (a full disk);
 * after any failure none of them stays. */
enum br_status br_gnuplot_end_figure(struct br_gnuplot *g, struct br_error *err);

/* Runs the commands in a temporary file, which is closed (NULL: it could not be made); what gnuplot
 * says goes to `out`. */
enum br_status br_gnuplot_run(FILE *commands, FILE *out, bool *missing, struct br_error *err);

/* Makes a film, folder/stem.mp4, of the frames folder/stem-0001.png and so on, with ffmpeg, and
 * removes them. *missing (out): ffmpeg is not installed, and the call fails. */
enum br_status br_film_make(const char *folder, const char *stem, bool *missing,
                            struct br_error *err);

/* Whether ffmpeg is installed. */
bool br_film_can_be_made(void);

/* Whether a picture that gnuplot has drawn is whole, which gnuplot does not look at: fails with
 * BR_IO where it is not there, or does not end as its kind does. */
enum br_status br_picture_check(const char *path, struct br_error *err);

#endif
