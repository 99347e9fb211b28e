/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The map of extremes as heat maps: which kind of verdict rules where. */
#ifndef BR_PLOTS_EXTREMES_MAP_H
#define BR_PLOTS_EXTREMES_MAP_H

#include "plots/heat.h"
#include "study/extremes/count.h"

/* Fills the heat map (out; clear it even after a failure). Fails with BR_NO_MEMORY. */
enum br_status br_extremes_map_draw(const struct br_extreme_map *map, struct br_heat *heat,
                                    struct br_error *err);

#endif
