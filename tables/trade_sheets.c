/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <string.h>

#include "tables/trade_page.h"

/* What a cell is about. */
struct place {
    const struct br_trade_page *page;
    const struct br_trial *trial; /* NULL: there is none */
    double target;
};

/* A column of rows that are about a trial. */
struct column {
    const char *heading;
    bool number;
    void (*cell)(const struct place *at, char *text, size_t size);
};

static void put(char *text, size_t size, const char *format, double value)
{
    if (isfinite(value))
        snprintf(text, size, format, value);
    else
        snprintf(text, size, "-");
}

static void put_count(char *text, size_t size, size_t value)
{
    snprintf(text, size, "%zu", value);
}

static void scene_cell(const struct place *at, char *text, size_t size)
{
    snprintf(text, size, "%s", at->page->name);
}

static void target_cell(const struct place *at, char *text, size_t size)
{
    snprintf(text, size, "%.0e", at->target);
}

static void method_cell(const struct place *at, char *text, size_t size)
{
    snprintf(text, size, "%s", at->trial->contender->name);
}

static void n_cell(const struct place *at, char *text, size_t size)
{
    put_count(text, size, at->trial->at.n);
}

/* The time step, or an adaptive scheme's tolerance. */
static void step_cell(const struct place *at, char *text, size_t size)
{
    if (br_contender_adaptive(at->trial->contender))
        snprintf(text, size, "tol %.0e", at->trial->tolerance);
    else
        snprintf(text, size, "%.6g", br_trade_step(at->page->trade, at->trial));
}

static void relative_cell(const struct place *at, char *text, size_t size)
{
    put(text, size, "%.2e", br_trial_relative(at->trial, 0, BR_PART_TOTAL));
}

static void error_cell(const struct place *at, char *text, size_t size)
{
    put(text, size, "%.3e", at->trial->error[0][BR_PART_TOTAL]);
}

static void axial_cell(const struct place *at, char *text, size_t size)
{
    put(text, size, "%.3e", at->trial->error[0][BR_PART_AXIAL]);
}

static void bending_cell(const struct place *at, char *text, size_t size)
{
    put(text, size, "%.3e", at->trial->error[0][BR_PART_BENDING]);
}

static void seconds_cell(const struct place *at, char *text, size_t size)
{
    put(text, size, "%.3g", br_trial_seconds(at->trial));
}

static void set_up_cell(const struct place *at, char *text, size_t size)
{
    put(text, size, "%.3g", at->trial->cost.set_up);
}

static void march_cell(const struct place *at, char *text, size_t size)
{
    put(text, size, "%.3g", at->trial->cost.march);
}

static void counted(const struct place *at, size_t value, char *text, size_t size)
{
    if (isfinite(br_trial_seconds(at->trial)))
        put_count(text, size, value);
    else
        snprintf(text, size, "-");
}

static void steps_cell(const struct place *at, char *text, size_t size)
{
    counted(at, at->trial->cost.counts.steps, text, size);
}

static void solves_cell(const struct place *at, char *text, size_t size)
{
    counted(at, at->trial->cost.counts.stages, text, size);
}

static void iterations_cell(const struct place *at, char *text, size_t size)
{
    counted(at, at->trial->cost.counts.iterations, text, size);
}

static void digits_cell(const struct place *at, char *text, size_t size)
{
    put(text, size, "%.3g", br_trade_digits_per_second(at->trial));
}

/* How it ended, and what it is besides. */
static void end_cell(const struct place *at, char *text, size_t size)
{
    const size_t i = (size_t)(at->trial - at->page->trade->trial);
    snprintf(text, size, "%s%s%s", br_trial_end_name(at->trial->end),
             at->page->trade->front[i] ? ", front" : "", at->trial->printed ? ", printed" : "");
}

static const struct column summary_columns[] = {
    {"scene", false, scene_cell},    {"to error", true, target_cell},
    {"method", false, method_cell},  {"n", true, n_cell},
    {"k, s", true, step_cell},       {"relative error", true, relative_cell},
    {"error", true, error_cell},     {"CPU s", true, seconds_cell},
    {"solves", true, solves_cell},   {"iterations", true, iterations_cell},
    {"digits/s", true, digits_cell},
};
/* The same without the scene. */
static const struct column *const cheapest_columns = &summary_columns[1];

static const struct column trial_columns[] = {
    {"method", false, method_cell},  {"n", true, n_cell},
    {"k, s", true, step_cell},       {"relative error", true, relative_cell},
    {"error", true, error_cell},     {"axial", true, axial_cell},
    {"bending", true, bending_cell}, {"set-up s", true, set_up_cell},
    {"march s", true, march_cell},   {"steps", true, steps_cell},
    {"solves", true, solves_cell},   {"iterations", true, iterations_cell},
    {"end", false, end_cell},
};

enum {
    SUMMARY_COLUMNS = sizeof summary_columns / sizeof *summary_columns,
    TRIAL_COLUMNS = sizeof trial_columns / sizeof *trial_columns
};

static const char *heading_of(const struct column *columns, size_t column, bool *number)
{
    *number = columns[column].number;
    return columns[column].heading;
}

/* ---- the cheapest way to each error: rows of page after page ---- */

static const char *summary_heading(const void *self, size_t column, bool *number)
{
    (void)self;
    return heading_of(summary_columns, column, number);
}

static const char *cheapest_heading(const void *self, size_t column, bool *number)
{
    (void)self;
    return heading_of(cheapest_columns, column, number);
}

/* Where no trial is good enough, all but the scene and the target is empty. */
static void target_row(const struct br_trade_page *pages, size_t row, const struct column *column,
                       char text[BR_CELL])
{
    const struct br_trade_page *page = &pages[row / BR_TRADE_DIGITS];
    const struct br_trade *trade = page->trade;
    const size_t digit = row % BR_TRADE_DIGITS, best = trade->best[digit];
    const struct place at = {page, best < trade->count ? &trade->trial[best] : NULL,
                             br_trade_target(digit)};
    if (at.trial || column->cell == scene_cell || column->cell == target_cell)
        column->cell(&at, text, BR_CELL);
    else
        snprintf(text, BR_CELL, "-");
}

static void summary_cell(const void *self, size_t row, size_t column, char text[BR_CELL])
{
    target_row(self, row, &summary_columns[column], text);
}

static void cheapest_cell(const void *self, size_t row, size_t column, char text[BR_CELL])
{
    target_row(self, row, &cheapest_columns[column], text);
}

/* ---- by method ---- */

static const char *methods_heading(const void *self, size_t column, bool *number)
{
    static char text[BR_TRADE_DIGITS + 1][16];
    (void)self;
    *number = column > 0;
    if (column == 0)
        return "method";
    snprintf(text[column], sizeof *text, "%.0e", br_trade_target(column - 1));
    return text[column];
}

static void methods_cell(const void *self, size_t row, size_t column, char text[BR_CELL])
{
    const struct br_trade *trade = ((const struct br_trade_page *)self)->trade;
    if (column == 0) {
        snprintf(text, BR_CELL, "%s", trade->contenders.list[row].name);
        return;
    }
    const size_t best = trade->best_of[row][column - 1];
    put(text, BR_CELL, "%.2g",
        best < trade->count ? br_trial_seconds(&trade->trial[best]) : (double)NAN);
}

/* ---- all trials ---- */

static const char *trials_heading(const void *self, size_t column, bool *number)
{
    (void)self;
    return heading_of(trial_columns, column, number);
}

static void trials_cell(const void *self, size_t row, size_t column, char text[BR_CELL])
{
    const struct br_trade_page *page = self;
    const struct place at = {page, &page->trade->trial[row], NAN};
    trial_columns[column].cell(&at, text, BR_CELL);
}

/* ---- the pages ---- */

enum { MOST_ENDS = 6 };

static void say(const void *self, const struct br_writer *w)
{
    br_say_trade(self, w);
}

static void say_ends(const void *self, const struct br_writer *w)
{
    br_say_trade_ends(self, w);
}

void br_trade_fill(const struct br_trade_page *trade, struct br_page *page)
{
    const struct br_trade *t = trade->trade;
    *page = (struct br_page){
        .name = trade->name,
        .caption = trade->caption,
        .table = {{.name = "cheapest",
                   .title = "Cheapest way to an error",
                   .columns = SUMMARY_COLUMNS - 1,
                   .rows = BR_TRADE_DIGITS,
                   .self = trade,
                   .heading = cheapest_heading,
                   .cell = cheapest_cell},
                  {.name = "methods",
                   .title = "CPU seconds to an error, by method",
                   .columns = BR_TRADE_DIGITS + 1,
                   .rows = t->contenders.count,
                   .self = trade,
                   .heading = methods_heading,
                   .cell = methods_cell},
                  {.name = "trials",
                   .title = "All trials",
                   .columns = TRIAL_COLUMNS,
                   .rows = t->count,
                   .only_in_files = true,
                   .self = trade,
                   .heading = trials_heading,
                   .cell = trials_cell}},
        .tables = 3,
        .self = trade,
        .say = say,
        .say_notes = say_ends,
        .notes_title = "How trials ended",
        .notes_shown = MOST_ENDS,
        .provenance = trade->provenance,
    };
}

void br_trade_fill_summary(const struct br_trade_page *trade, size_t scenes, struct br_page *page)
{
    *page = (struct br_page){
        .name = "summary",
        .caption = "What a digit costs",
        .table = {{.name = "summary",
                   .title = "Cheapest way to an error, by scene",
                   .columns = SUMMARY_COLUMNS,
                   .rows = scenes * BR_TRADE_DIGITS,
                   .self = trade,
                   .heading = summary_heading,
                   .cell = summary_cell}},
        .tables = 1,
        .provenance = trade->provenance,
    };
}
