/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What steps gather, as a page. */
#ifndef BR_TABLES_EXTREMES_STEPS_H
#define BR_TABLES_EXTREMES_STEPS_H

#include "study/extremes/steps.h"
#include "tables/sheet.h"

/* Fills caption, tables and sentences, which borrow the drifts. */
void br_drifts_page(const struct br_drifts *drifts, struct br_page *page);

#endif
