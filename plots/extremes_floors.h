/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Deviation from the exact discrete solution against n. */
#ifndef BR_PLOTS_EXTREMES_FLOORS_H
#define BR_PLOTS_EXTREMES_FLOORS_H

#include "plots/chart.h"
#include "study/extremes/floors.h"

/* The chart (out) of time step number k; to be cleared. Fails with BR_NO_MEMORY. */
enum br_status br_floors_draw(const struct br_floors *floors, size_t k, struct br_chart *chart,
                              struct br_error *err);

#endif
