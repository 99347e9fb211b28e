/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/extremes_part.h"

extern const struct br_extremes_part br_extremes_energy;

/* One row a part, in the order in which they run. */
const struct br_extremes_part *const br_extremes_parts[] = {
    &br_extremes_energy,
    NULL,
};
