/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Plans (study/plan.h) as text: one const record a format. Emitters compute nothing. */
#ifndef BR_PLAN_EMITTER_H
#define BR_PLAN_EMITTER_H

#include "study/plan.h"
#include "tables/emitter.h"
#include "tables/sentences.h"

/* All borrowed. */
struct br_plan_page {
    const char *name;       /* the scene's, and of the files */
    const char *scene_word; /* the scene as on the command line */
    const char *caption;    /* one line */
    const struct br_plan *plan;
    const struct br_provenance *provenance;
};

struct br_plan_emitter {
    const char *name;      /* as on the command line */
    const char *extension; /* of its file, with the dot */
    /* Fails with BR_NO_MEMORY only: write errors stay in `out`. */
    enum br_status (*emit)(FILE *out, const struct br_plan_page *page, struct br_error *err);
};

/* NULL-terminated; the first is the terminal's. */
extern const struct br_plan_emitter *const br_plan_emitters[];

/* ---- what all formats share ---- */

/* Tables of text: the proposals that were tried, and the models of all methods. */
enum { BR_PLAN_CELL = 96 };
struct br_plan_sheet {
    const char *title;
    size_t columns;
    const char *(*heading)(size_t column, bool *number);
    size_t (*rows)(const struct br_plan_page *page);
    void (*cell)(const struct br_plan_page *page, size_t row, size_t column,
                 char text[BR_PLAN_CELL]);
};
extern const struct br_plan_sheet *const br_plan_sheets[]; /* NULL-terminated */

/* The goal and how it was met; what is proposed; then how good the models were, what the planning
 * took, and what errors and seconds are. */
void br_say_plan(const struct br_plan_page *page, const struct br_writer *writer);
void br_say_plan_notes(const struct br_plan_page *page, const struct br_writer *writer);

/* Command lines that repeat the chosen trial: its march, and its error and seconds. Empty where
 * nothing was chosen. */
enum { BR_PLAN_LINE = 1536 };
void br_plan_run_line(const struct br_plan_page *page, char line[BR_PLAN_LINE]);
void br_plan_trade_line(const struct br_plan_page *page, char line[BR_PLAN_LINE]);

/* k of a trial, s; NaN of an adaptive one. */
double br_plan_step(const struct br_plan_page *page, const struct br_trial *trial);

#endif
