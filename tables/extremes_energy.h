/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The page of study/extremes/energy_behaviour.h. */
#ifndef BR_TABLES_EXTREMES_ENERGY_H
#define BR_TABLES_EXTREMES_ENERGY_H

#include "study/extremes/energy_behaviour.h"
#include "tables/sheet.h"

/* Fills caption, tables and sentences, which borrow the behaviour. */
void br_energy_page(const struct br_energy_behaviour *behaviour, struct br_page *page);

#endif
