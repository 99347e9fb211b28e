/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What floors and steps have found, as pages. */
#ifndef BR_TABLES_EXTREMES_FLOORS_H
#define BR_TABLES_EXTREMES_FLOORS_H

#include "study/extremes/floors.h"
#include "tables/sheet.h"

/* Fills caption, tables and sentences, which borrow the floors. */
void br_floors_page(const struct br_floors *floors, struct br_page *page);

#endif
