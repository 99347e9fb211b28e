/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The stability of the lagged contact as heat maps, with the predicted limit on them. */
#ifndef BR_PLOTS_EXTREMES_STABILITY_H
#define BR_PLOTS_EXTREMES_STABILITY_H

#include "plots/heat.h"
#include "study/extremes/stability.h"

/* Fills the heat map (out; clear it even after a failure). Fails with BR_NO_MEMORY. */
enum br_status br_extremes_stability_draw(const struct br_stability *s, struct br_heat *heat,
                                          struct br_error *err);

#endif
