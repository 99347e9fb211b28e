/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What steps gather against their number. */
#ifndef BR_PLOTS_EXTREMES_STEPS_H
#define BR_PLOTS_EXTREMES_STEPS_H

#include "plots/chart.h"
#include "study/extremes/steps.h"

/* The chart (out) of the default linear solver, a panel a scene; to be cleared. Fails with
 * BR_NO_MEMORY. */
enum br_status br_drifts_draw(const struct br_drifts *drifts, struct br_chart *chart,
                              struct br_error *err);

#endif
