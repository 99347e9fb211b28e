/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The verdicts of a check as text: one const record a format. Emitters compute nothing. */
#ifndef BR_TABLES_CHECK_EMITTER_H
#define BR_TABLES_CHECK_EMITTER_H

#include "study/verify/comparison.h"
#include "tables/document.h"

/* A scene that this build cannot check, and why. Borrowed. */
struct br_skipped {
    const char *scene, *reason;
};

/* All that a check has found. Borrowed. */
struct br_check_page {
    const struct br_check *checks;
    size_t count;
    const struct br_skipped *skipped;
    size_t skips;
    bool stopped; /* after the first scene that failed: the rest was not checked */
    double wall_seconds;
    const struct br_comparison *comparison; /* NULL: none was asked for */
    const struct br_provenance *provenance; /* without a scene */
};

struct br_check_emitter {
    const char *name; /* of the option, and of the format */
    const char *title;
    /* Write errors stay in `out`; fails with BR_NO_MEMORY only. */
    enum br_status (*emit)(FILE *out, const struct br_check_page *page, struct br_error *err);
};

/* NULL-terminated; the first is the terminal's. */
extern const struct br_check_emitter *const br_check_emitters[];

/* ---- what the formats share ---- */

/* "space l2 axial" */
const char *br_case_name(const struct br_case *c, char *buffer, size_t size);

/* "2 +- 0.1" */
const char *br_case_band(const struct br_case *c, char *buffer, size_t size);

/* "0.1 to 0.2", "at most 0.2", or "-": of the constant */
const char *br_case_range(const struct br_case *c, char *buffer, size_t size);

/* Calls line for each point of a case, and for why it does not pass. */
void br_case_lines(const struct br_case *c, void (*line)(void *self, const char *text), void *self);

/* "12 orders in 3 scenes: 11 PASS, 1 FAIL, 0 INCONCLUSIVE; 0.8 s" */
const char *br_check_summary(const struct br_check_page *page, char *buffer, size_t size);

/* Reads what a check's JSON says, for a comparison. Fails with BR_BAD_INPUT, naming the file and
 * what is wrong with it, or BR_NO_MEMORY; clear `old` even then. */
enum br_status br_check_read_json(const char *path, struct br_old_check *old, struct br_error *err);

#endif
