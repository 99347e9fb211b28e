/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A run of one scene as text and as files. Nothing is computed here. */
#ifndef BR_TABLES_RUN_PAGE_H
#define BR_TABLES_RUN_PAGE_H

#include "study/foresee/prediction.h"
#include "study/run/run.h"
#include "tables/document.h"

/* All that a run's summary is made of. Borrowed. */
struct br_run_page {
    const struct br_run_report *report;
    const struct br_prediction *prediction;
    const struct br_warnings *warnings;
    const struct br_provenance *provenance; /* with its scene */
    double wall_seconds;
};

/* The summary for a person: write errors stay in `out`. */
void br_run_text(FILE *out, const struct br_run_page *page);

/* The same for programs. Fails with BR_NO_MEMORY. */
enum br_status br_run_json(FILE *out, const struct br_run_page *page, struct br_error *err);

/* The tip's history: a head, one line a row, SI units; a number that is not there is an empty
 * field (RFC 4180). */
void br_history_csv_head(FILE *out);
void br_history_csv_row(FILE *out, const struct br_history_row *row);

/* The last line of a march that did not reach T: a comment, "# stopped: ...". */
void br_history_csv_stopped(FILE *out, const char *message);

#endif
