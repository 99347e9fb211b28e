/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The reports of all commands. Each function begins the document and puts all into it but pictures;
 * it computes only ratios of given numbers. Strings of the provenance, where there is one, are
 * copied. */
#ifndef BR_TABLES_REPORTS_H
#define BR_TABLES_REPORTS_H

#include "tables/document.h"

struct br_check;
struct br_comparison;
struct br_estimate;
struct br_finding;
struct br_floors;
struct br_old_check;
struct br_orders;
struct br_prediction;
struct br_report;
struct br_run_report;
struct br_split;
struct br_stability;
struct br_trade;
struct br_warnings;
struct json_t; /* of jansson */

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

/* ---- orders ---- */

/* Orders of any program's numbers, limits of its values, costs of runs (growth: by enum br_axis,
 * NaN where it is not known), and all rows. Without provenance. */
void br_report_orders(const struct br_orders *orders, const struct br_estimate *growth,
                      const char *caption, struct br_document *d);

/* ---- check ---- */

/* The results of a check. Borrowed. */
struct br_check_findings {
    const struct br_check *checks;
    size_t count;
    double wall_seconds;
    const struct br_comparison *comparison; /* NULL: none was asked for */
    const struct br_provenance *provenance; /* without a scene */
};

/* What did not pass, and how to mend it; then all orders. */
void br_report_check(const struct br_check_findings *findings, struct br_document *d);

/* The formats of a check; each is an option of that name. NULL-terminated; the first is that of the
 * terminal. */
extern const struct br_document_format *const br_check_formats[];

/* Reads the JSON of an earlier check, as br_report_check has it, for a comparison. Fails with
 * BR_BAD_INPUT, naming the file and what is wrong with it, or BR_NO_MEMORY; clear `old` even then.
 */
enum br_status br_check_read_json(const char *path, struct br_old_check *old, struct br_error *err);

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

#endif
