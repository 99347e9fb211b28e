/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The picture of study/extremes/energy_behaviour.h. */
#ifndef BR_PLOTS_EXTREMES_ENERGY_H
#define BR_PLOTS_EXTREMES_ENERGY_H

#include "plots/chart.h"
#include "study/extremes/energy_behaviour.h"

/* Loss a period against steps a period, undamped and damped: marks are measured, lines predicted.
 * *chart (out) is owned (br_chart_clear, free). Fails with BR_NO_MEMORY. */
enum br_status br_energy_chart(const struct br_energy_behaviour *behaviour, struct br_chart **chart,
                               struct br_error *err);

#endif
