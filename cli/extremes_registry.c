/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <string.h>

#include "cli/extremes_part.h"

const struct br_extremes_part *const br_extremes_parts[] = {NULL};

const struct br_extremes_part *br_extremes_part_find(const char *name)
{
    for (const struct br_extremes_part *const *p = br_extremes_parts; *p; p++)
        if (strcmp((*p)->name, name) == 0)
            return *p;
    return NULL;
}
