/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The stability of the contact as a page. */
#ifndef BR_TABLES_EXTREMES_STABILITY_H
#define BR_TABLES_EXTREMES_STABILITY_H

#include "study/extremes/stability.h"
#include "tables/sheet.h"

/* Fills the page (out) but for its name and provenance; it borrows from the stability. */
void br_extremes_stability_page(const struct br_stability *s, struct br_page *page);

#endif
