/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A report that was never computed: every number in it is another one, so that a table or
 * a plot that takes the wrong one is caught. */
#ifndef BR_TESTS_MADE_REPORT_H
#define BR_TESTS_MADE_REPORT_H

#include "solver/scene.h"
#include "study/fit/report.h"
#include "support.h"

enum { BR_MADE_N = 3, BR_MADE_K = 4, BR_MADE_CELLS = BR_MADE_N * BR_MADE_K };

/* The caption: every character that some format must escape. */
#define BR_MADE_CAPTION "A_b & 50% #1 {x} ~y ^z \\w <v> |u| $5 *t* `s` \"r\""

struct br_made_report {
    struct br_scene scene;
    struct br_study study, exact;
    struct br_cell cell[2][BR_MADE_CELLS];
    struct br_report report;
};

/* Fills a report in place; to be cleared. with_exact: a study by a fine run with the exact
 * one beside it, else by the exact solution alone. Of the fitted study's cells, by rows of
 * 4, number 1 is flagged by the reference, 6 by round-off, and 11 failed, in all parts; 2 by
 * the reference, 7 as unstable and 9 as stalled in the total alone. Of the study that is not fitted
 * number 4 is flagged by the reference, and 11 failed. Nothing is printed of cells 3 and 8. */
void br_made_report(struct br_made_report *made, bool with_exact);
void br_made_report_clear(struct br_made_report *made);

#endif
