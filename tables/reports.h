/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The reports of any program's numbers; those of the beam are in tables/beam/reports.h. Each
 * function begins the document and puts all into it but pictures; it computes only ratios of given
 * numbers. Strings of the provenance, where there is one, are copied. */
#ifndef BR_TABLES_REPORTS_H
#define BR_TABLES_REPORTS_H

#include "tables/document.h"

struct br_check;
struct br_comparison;
struct br_estimate;
struct br_old_check;
struct br_orders;
struct br_work_precision;

/* ---- orders ---- */

/* Orders of any program's numbers, limits of its values, costs of runs (growth: by enum br_axis,
 * NaN where it is not known), and all rows. Without provenance. */
void br_report_orders(const struct br_orders *orders, const struct br_estimate *growth,
                      const char *caption, struct br_document *d);

/* What a digit costs, of each quantity: the cheapest program to each power of ten, how costs grow,
 * what failed, and all runs. machine: that of programs that were run; NULL:
 * none was. Without provenance. */
void br_report_work(const struct br_work_precision *works, size_t count, const char *machine,
                    struct br_document *d);

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

#endif
