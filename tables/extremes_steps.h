/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What steps gather, as a page. */
#ifndef BR_EXTREMES_STEPS_H
#define BR_EXTREMES_STEPS_H

#include "study/steps.h"
#include "tables/sheet.h"

/* Fills caption, tables and sentences, which borrow the drifts. */
void br_drifts_page(const struct br_drifts *drifts, struct br_page *page);

#endif
