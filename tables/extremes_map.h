/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The map of extremes as a page. */
#ifndef BR_TABLES_EXTREMES_MAP_H
#define BR_TABLES_EXTREMES_MAP_H

#include "study/extremes/count.h"
#include "tables/sheet.h"

struct br_extremes_map_page {
    const struct br_extreme_map *map;
    const struct br_extreme_counts *counts;
};

/* Fills the page (out) but for its name and provenance; it borrows from `self`. */
void br_extremes_map_page(const struct br_extremes_map_page *self, struct br_page *page);

#endif
