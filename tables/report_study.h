/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The reports of `study` and `tables`, and what the paper claims beside what is found (`figures`).
 * Nothing is computed here but ratios of what is there. */
#ifndef BR_TABLES_REPORT_STUDY_H
#define BR_TABLES_REPORT_STUDY_H

#include "study/fit/report.h"
#include "study/paper/claims.h"
#include "tables/document.h"

/* Builds the report of a study, which has been finished (br_report_finish). */
void br_report_study(const struct br_report *report, struct br_document *document);

/* Builds the report of the claims. finding: in the order of br_claims; h = L/n,
 * k = 1 s / per_second. */
void br_report_claims(const struct br_finding *finding, size_t n, size_t per_second,
                      struct br_document *document);

#endif
