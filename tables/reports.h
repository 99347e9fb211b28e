/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The reports of all commands. Each begins the document and puts all into it but pictures; nothing
 * is computed but ratios of what is there. Where they are given, strings of the provenance are
 * copied. */
#ifndef BR_TABLES_REPORTS_H
#define BR_TABLES_REPORTS_H

#include "tables/document.h"

struct br_check;
struct br_comparison;
struct br_energy_behaviour;
struct br_estimate;
struct br_extreme_map;
struct br_finding;
struct br_floors;
struct br_foreseen;
struct br_old_check;
struct br_orders;
struct br_plan;
struct br_prediction;
struct br_report;
struct br_run_report;
struct br_split;
struct br_stability;
struct br_variation;
struct br_trade;
struct br_warnings;
struct json_t; /* of jansson */

/* ---- study, tables, figures: without provenance ---- */

/* Of a study, which has been finished (br_report_finish). */
void br_report_study(const struct br_report *report, struct br_document *d);

/* Of what a study, or a run, has found at each value of a number that is varied. */
void br_report_variation(const struct br_variation *variation, struct br_document *d);

/* What the paper claims beside what is found. finding: in the order of br_claims; h = L/n,
 * k = 1 s / per_second. */
void br_report_claims(const struct br_finding *finding, size_t n, size_t per_second,
                      struct br_document *d);

/* ---- run ---- */

/* All that a run's summary is made of. Borrowed. */
struct br_run_findings {
    const struct br_run_report *report;
    const struct br_prediction *prediction;
    const struct br_warnings *warnings;
    const struct br_provenance *provenance; /* with its scene */
    double wall_seconds;
};

/* What happened at the tip and how far off that is, then all that was found. In JSON what is not
 * known or not modelled is null. */
void br_report_run(const struct br_run_findings *findings, struct br_document *d);

/* ---- dry runs ---- */

/* What a command would march, on so many threads. */
void br_report_foreseen(const struct br_foreseen *work, const char *command, int threads,
                        struct br_document *d);

/* ---- orders ---- */

/* Orders of any program's numbers, limits of its values, what runs cost (growth: by enum br_axis,
 * NaN where it is not known), and all rows: without provenance. */
void br_report_orders(const struct br_orders *orders, const struct br_estimate *growth,
                      const char *caption, struct br_document *d);

/* ---- check ---- */

/* All that a check has found. Borrowed. */
struct br_check_findings {
    const struct br_check *checks;
    size_t count;
    bool stopped; /* after the first scene that failed: the rest was not checked */
    double wall_seconds;
    const struct br_comparison *comparison; /* NULL: none was asked for */
    const struct br_provenance *provenance; /* without a scene */
};

/* What did not pass and what would mend it, then all orders. */
void br_report_check(const struct br_check_findings *findings, struct br_document *d);

/* Its formats, each an option by its name. NULL-terminated; the first is the terminal's. */
extern const struct br_document_format *const br_check_formats[];

/* Reads what a check's JSON says, for a comparison: that of br_report_check, or the one of before
 * (format "beamrate check 1"). Fails with BR_BAD_INPUT, naming the file and what is wrong with it,
 * or BR_NO_MEMORY; clear `old` even then. */
enum br_status br_check_read_json(const char *path, struct br_old_check *old, struct br_error *err);

/* ---- trade, split, plan ---- */

/* One scene: the cheapest way to each error, the seconds of each method to these, the Pareto front,
 * and for programs all trials. The document has the scene's name. */
void br_report_trade(const struct br_trade *trade, const struct br_provenance *provenance,
                     struct br_document *d);

/* Several scenes in one norm: the cheapest ways alone. The document's name is "summary". */
void br_report_trade_summary(const struct br_trade *const *trade, size_t scenes,
                             const struct br_provenance *provenance, struct br_document *d);

/* Where the errors of `count` runs of one scene come from. Its name is <scene>-split. */
void br_report_split(const struct br_split *split, size_t count,
                     const struct br_provenance *provenance, struct br_document *d);

/* What a plan proposes, what was predicted and achieved, and how good the models are. Its name is
 * <scene>-plan. scene_word: the scene as on the command line. */
void br_report_plan(const struct br_plan *plan, const char *scene_word,
                    const struct br_provenance *provenance, struct br_document *d);

/* ---- repeat ---- */

struct br_repeated {
    size_t compared, different; /* values */
};

/* Puts what differs between two JSON documents of one report into a document that has begun:
 * numbers beyond the interval or the error that is stated beside them, or beyond round-off;
 * verdicts, words and what one of them does not have. Times of the clock are not compared. */
void br_report_repeated(const struct json_t *was, const struct json_t *is,
                        struct br_repeated *found, struct br_document *d);

/* ---- extremes, one a part: without provenance ---- */

void br_report_floors(const struct br_floors *floors, struct br_document *d);
void br_report_stability(const struct br_stability *stability, struct br_document *d);
void br_report_energy(const struct br_energy_behaviour *behaviour, struct br_document *d);
void br_report_map(const struct br_extreme_map *map, struct br_document *d);

#endif
