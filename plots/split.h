/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parts of the error over the time step, or over the mesh: where one of them takes over. */
#ifndef BR_PLOTS_SPLIT_H
#define BR_PLOTS_SPLIT_H

#include "plots/chart.h"
#include "study/trade/split.h"

/* A panel for each of the first two methods among the runs, over what they differ by: k on the
 * finest mesh, or else h at the smallest k. chart (out): without panels where no two runs differ
 * by either; to be cleared, even after a failure. Fails with BR_NO_MEMORY. */
enum br_status br_split_chart(const struct br_split *split, size_t count, struct br_chart *chart,
                              struct br_error *err);

#endif
