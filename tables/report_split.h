/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The report of `beamrate trade --split`. */
#ifndef BR_TABLES_REPORT_SPLIT_H
#define BR_TABLES_REPORT_SPLIT_H

#include "study/trade/split.h"
#include "tables/document.h"

/* Where the errors of `count` runs of one scene come from: begins the document, <scene>-split, and
 * puts all into it but pictures. */
void br_report_split(const struct br_split *split, size_t count,
                     const struct br_provenance *provenance, struct br_document *d);

#endif
