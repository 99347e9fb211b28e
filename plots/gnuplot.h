/* SPDX-License-Identifier: GPL-3.0-or-later */
/* gnuplot for what is not a picture in SVG and PNG. */
#ifndef BR_PLOTS_GNUPLOT_H
#define BR_PLOTS_GNUPLOT_H

#include <stdbool.h>
#include <stdio.h>

#include "solver/status.h"
#include "study/run/history.h"

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

/* Draws the tip's history with letters: displacements and forces over time, `columns` wide, into
 * `out`. Fails as br_gnuplot_run. */
enum br_status br_gnuplot_letters(FILE *out, const struct br_scene *scene,
                                  const struct br_history_record *record, int columns,
                                  bool *missing, struct br_error *err);

#endif
