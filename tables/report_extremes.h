/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The reports of `beamrate extremes`, one a part. Each begins the document and puts all into it but
 * pictures and provenance. */
#ifndef BR_TABLES_REPORT_EXTREMES_H
#define BR_TABLES_REPORT_EXTREMES_H

#include "study/extremes/count.h"
#include "study/extremes/energy_behaviour.h"
#include "study/extremes/floors.h"
#include "study/extremes/stability.h"
#include "tables/document.h"

void br_report_floors(const struct br_floors *floors, struct br_document *d);
void br_report_drifts(const struct br_drifts *drifts, struct br_document *d);
void br_report_stability(const struct br_stability *stability, struct br_document *d);
void br_report_energy(const struct br_energy_behaviour *behaviour, struct br_document *d);
void br_report_map(const struct br_extreme_map *map, const struct br_extreme_counts *counts,
                   struct br_document *d);

#endif
