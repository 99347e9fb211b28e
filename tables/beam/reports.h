/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The reports of the beam's commands, as tables/reports.h says. */
#ifndef BR_TABLES_BEAM_REPORTS_H
#define BR_TABLES_BEAM_REPORTS_H

#include "tables/document.h"

struct br_finding;
struct br_floors;
struct br_prediction;
struct br_report;
struct br_run_report;
struct br_split;
struct br_stability;
struct br_trade;
struct br_warnings;

/* ---- study, tables, figures: without provenance ---- */

/* Of a study after br_report_finish. */
void br_report_study(const struct br_report *report, struct br_document *d);

/* The paper's claims with our findings. finding: by br_claims; h = L/n, k = 1 s / per_second. */
void br_report_claims(const struct br_finding *finding, size_t n, size_t per_second,
                      struct br_document *d);

/* ---- run ---- */

/* All data of the summary of a run. Borrowed. */
struct br_run_findings {
    const struct br_run_report *report;
    const struct br_prediction *prediction;
    const struct br_warnings *warnings;
    const struct br_provenance *provenance; /* with its scene */
    double wall_seconds;
};

/* The events at the tip and the error there, then all other results. In JSON, what is not known or
 * not modelled is null. */
void br_report_run(const struct br_run_findings *findings, struct br_document *d);

/* ---- trade, split ---- */

/* One scene: the cheapest way to each error, the seconds that each method takes to it, the Pareto
 * front, and for programs all trials; with a goal the way to take, and the best of each method. The
 * document has the name of the scene. words: the scene on a command line. */
void br_report_trade(const struct br_trade *trade, const char *words,
                     const struct br_provenance *provenance, struct br_document *d);

/* Several scenes in one norm: the cheapest ways alone. The document is named BR_SUMMARY. */
#define BR_SUMMARY "summary"
void br_report_trade_summary(const struct br_trade *const *trade, size_t scenes,
                             const struct br_provenance *provenance, struct br_document *d);

/* The sources of the errors of `count` runs of one scene. The document is named <scene>-split. */
void br_report_split(const struct br_split *split, size_t count,
                     const struct br_provenance *provenance, struct br_document *d);

/* ---- extremes, one for each experiment: without provenance ---- */

void br_report_floors(const struct br_floors *floors, struct br_document *d);
void br_report_stability(const struct br_stability *stability, struct br_document *d);

/* ---- scenes: the format ---- */

/* Writes a valid scene with every key, its meaning, unit and default; those that are optional stand
 * behind a #. It walks br_scene_keys and the registry of norms, and so cannot go stale. */
void br_scene_template_write(FILE *out);

#endif
