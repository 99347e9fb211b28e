/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The page of study/energy_behaviour.h. */
#ifndef BR_EXTREMES_ENERGY_TABLES_H
#define BR_EXTREMES_ENERGY_TABLES_H

#include "study/energy_behaviour.h"
#include "tables/sheet.h"

/* Fills caption, tables and sentences, which borrow the behaviour. */
void br_energy_page(const struct br_energy_behaviour *behaviour, struct br_page *page);

#endif
