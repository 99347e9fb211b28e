/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/extremes_part.h"

/* One row a part, in the order in which they run. */
const struct br_extremes_part *const br_extremes_parts[] = {
    &br_extremes_part_floors, &br_extremes_part_steps, &br_extremes_part_stability,
    &br_extremes_part_energy, &br_extremes_part_map,   NULL,
};
