/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The report of `run`, and the tip's history as CSV. */
#ifndef BR_TABLES_REPORT_RUN_H
#define BR_TABLES_REPORT_RUN_H

#include "study/foresee/prediction.h"
#include "study/run/run.h"
#include "tables/document.h"

/* All that a run's summary is made of. Borrowed. */
struct br_run_findings {
    const struct br_run_report *report;
    const struct br_prediction *prediction;
    const struct br_warnings *warnings;
    const struct br_provenance *provenance; /* with its scene */
    double wall_seconds;
};

/* Builds the report: what happened at the tip and how far off that is, then all that was found. In
 * JSON what is not known or not modelled is null. */
void br_report_run(const struct br_run_findings *findings, struct br_document *document);

/* The tip's history: a head, one line a row, SI units; a number that is not there is an empty
 * field (RFC 4180). */
void br_history_csv_head(FILE *out);
void br_history_csv_row(FILE *out, const struct br_history_row *row);

/* The last line of a march that did not reach T: a comment, "# stopped: ...". */
void br_history_csv_stopped(FILE *out, const char *message);

#endif
