/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/extremes_part.h"

/* One row a part, in the order in which they run. */
const struct br_extremes_part *const br_extremes_parts[] = {
<<<<<<< HEAD
    &br_extremes_floors,
    &br_extremes_steps,
=======
    &br_extremes_part_floors,
    &br_extremes_part_map,
>>>>>>> e0a29d0d781118b7cd58a3b7e17ad212f8e5f18d
    NULL,
};
