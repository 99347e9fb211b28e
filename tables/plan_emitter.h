/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Plans (study/trade/plan.h) as text. Nothing is computed here. */
#ifndef BR_TABLES_PLAN_EMITTER_H
#define BR_TABLES_PLAN_EMITTER_H

#include "study/trade/plan.h"
#include "tables/sheet.h"

/* All borrowed. */
struct br_plan_page {
    const char *name;       /* the scene's, and of the files */
    const char *scene_word; /* the scene as on the command line */
    const char *caption;    /* one line */
    const struct br_plan *plan;
    const struct br_provenance *provenance;
};

/* Prints a plan in a format of tables/sheet.h; CSV and JSON have what a plan has to tell programs.
 * Fails with BR_NO_MEMORY only: write errors stay in `out`. */
enum br_status br_plan_emit(const struct br_page_emitter *format, FILE *out,
                            const struct br_plan_page *page, struct br_error *err);

/* ---- what formats share ---- */

/* The plan as a page: what was proposed, and how good the models are. It borrows all. */
void br_plan_fill(const struct br_plan_page *plan, struct br_page *page);

/* The goal and how it was met; what is proposed; then how good the models were, what the planning
 * took, and what errors and seconds are. */
void br_say_plan(const struct br_plan_page *page, const struct br_writer *writer);
void br_say_plan_notes(const struct br_plan_page *page, const struct br_writer *writer);

/* Command lines that repeat the chosen trial: its march, and its error and seconds. Empty where
 * nothing was chosen. */
enum { BR_PLAN_LINE = 1536 };
void br_plan_run_line(const struct br_plan_page *page, char line[BR_PLAN_LINE]);
void br_plan_trade_line(const struct br_plan_page *page, char line[BR_PLAN_LINE]);

/* One line a trial; everything. */
enum br_status br_plan_csv(FILE *out, const struct br_plan_page *page, struct br_error *err);
enum br_status br_plan_json(FILE *out, const struct br_plan_page *page, struct br_error *err);

/* k of a trial, s; NaN of an adaptive one. */
double br_plan_step(const struct br_plan_page *page, const struct br_trial *trial);

#endif
