/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The report of `check`, and its JSON read again. */
#ifndef BR_TABLES_REPORT_CHECK_H
#define BR_TABLES_REPORT_CHECK_H

#include "study/verify/comparison.h"
#include "tables/document.h"

/* All that a check has found. Borrowed. */
struct br_check_findings {
    const struct br_check *checks;
    size_t count;
    bool stopped; /* after the first scene that failed: the rest was not checked */
    double wall_seconds;
    const struct br_comparison *comparison; /* NULL: none was asked for */
    const struct br_provenance *provenance; /* without a scene */
};

/* Builds the report: what did not pass and what would mend it, then all orders. */
void br_report_check(const struct br_check_findings *findings, struct br_document *document);

/* Its formats, each an option by its name. NULL-terminated; the first is the terminal's. */
extern const struct br_document_format *const br_check_formats[];

/* Reads what a check's JSON says, for a comparison: that of br_report_check, or the one of before
 * (format "beamrate check 1"). Fails with BR_BAD_INPUT, naming the file and what is wrong with it,
 * or BR_NO_MEMORY; clear `old` even then. */
enum br_status br_check_read_json(const char *path, struct br_old_check *old, struct br_error *err);

#endif
