/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The report of `beamrate plan`. */
#ifndef BR_TABLES_REPORT_PLAN_H
#define BR_TABLES_REPORT_PLAN_H

#include "study/trade/plan.h"
#include "tables/document.h"

/* What a plan proposes, what was predicted and achieved, and how good the models are: begins the
 * document, <scene>-plan, and puts all into it. scene_word: the scene as on the command line. */
void br_report_plan(const struct br_plan *plan, const char *scene_word,
                    const struct br_provenance *provenance, struct br_document *d);

#endif
