/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tables/extremes_steps.h"

#include <math.h>

/* ---- a line a scene, scheme, contact and solver; a column a number of steps ---- */

static const char *grid_heading(const void *self, size_t column, bool *number)
{
    static _Thread_local char text[32];
    const struct br_drifts *d = self;
    *number = column >= 2;
    if (column < 2)
        return column ? "method" : "scene";
    snprintf(text, sizeof text, "N = %.3g", (double)d->steps[column - 2]);
    return text;
}

static void grid_cell(const void *self, size_t row, size_t column, char text[BR_CELL])
{
    const struct br_drifts *d = self;
    const size_t scene = row / d->contenders, contender = row % d->contenders;
    if (column == 0)
        snprintf(text, BR_CELL, "%s", d->scene[scene].name);
    else if (column == 1)
        snprintf(text, BR_CELL, "%s", d->contender[contender].name);
    else {
        const struct br_drift *drift = br_drift_at(d, scene, contender, column - 2);
        if (drift->refused.status)
            snprintf(text, BR_CELL, "refused");
        else if (!drift->steps)
            snprintf(text, BR_CELL, "-");
        else
            snprintf(text, BR_CELL, "%.1e", br_drift_deviation(drift));
    }
}

/* ---- all ---- */

enum { SCENE, METHOD, STEPS, AXIAL, BENDING, PREDICTED, TIMES, OUTCOME };

static const char *const headings[] = {
    "scene", "method", "steps", "axial", "bending", "predicted", "time levels", "outcome",
};

static const char *all_heading(const void *self, size_t column, bool *number)
{
    (void)self;
    *number = column >= STEPS && column < OUTCOME;
    return headings[column];
}

static void put(char text[BR_CELL], const struct br_drift *drift, double value)
{
    if (drift->steps && isfinite(value))
        snprintf(text, BR_CELL, "%.2e", value);
    else
        snprintf(text, BR_CELL, "-");
}

static void put_outcome(char text[BR_CELL], const struct br_drift *drift)
{
    if (drift->refused.status)
        snprintf(text, BR_CELL, "refused: %.140s", drift->refused.message);
    else if (!drift->steps)
        snprintf(text, BR_CELL, "not marched");
    else
        snprintf(text, BR_CELL, "%s",
                 br_drift_deviation(drift) <= drift->predicted ? "as predicted" : "ABOVE");
}

static void all_cell(const void *self, size_t row, size_t column, char text[BR_CELL])
{
    const struct br_drifts *d = self;
    const struct br_drift *drift = &d->drift[row];
    const size_t line = row / d->k_count;
    if (column < STEPS)
        grid_cell(self, line, column, text);
    else if (column == STEPS)
        snprintf(text, BR_CELL, "%zu", d->steps[row % d->k_count]);
    else if (column < PREDICTED)
        put(text, drift, drift->deviation[column - AXIAL]);
    else if (column < OUTCOME)
        put(text, drift, column == PREDICTED ? drift->predicted : drift->time_error);
    else
        put_outcome(text, drift);
}

/* ---- words ---- */

static void say(const void *self, const struct br_writer *w)
{
    struct br_error err = {0};
    char text[1400];
    if (br_drifts_verdict(self, &err))
        snprintf(text, sizeof text, "ABOVE: %s", err.message);
    else
        snprintf(text, sizeof text,
                 "However many steps there are, the round-off that they gather stays below what is "
                 "predicted, and the time levels are n T/N.");
    w->paragraph(w->self, text);
}

static void say_notes(const void *self, const struct br_writer *w)
{
    (void)self;
    w->paragraph(w->self,
                 "Deviation: the largest difference of all nodal displacements from the exact "
                 "discrete solution at the end of the duration, relative to the largest "
                 "displacement of the field; the larger of both fields; 10 elements.");
    w->paragraph(w->self, "Predicted: what a solver loses in a step, and a random walk of "
                          "64 * 2^-52 * sqrt(N). In Example 1 the tip sticks: friction holds its "
                          "velocity, and nothing its displacement.");
}

void br_drifts_page(const struct br_drifts *d, struct br_page *page)
{
    page->caption = "Round-off that steps gather";
    page->self = d;
    page->say = say;
    page->say_notes = say_notes;
    page->tables = 2;
    page->table[0] = (struct br_table){
        .name = "gathered",
        .title = "Deviation from the exact discrete solution after N steps",
        .columns = 2 + d->k_count,
        .rows = BR_DRIFT_SCENES * d->contenders,
        .self = d,
        .heading = grid_heading,
        .cell = grid_cell,
    };
    page->table[1] = (struct br_table){
        .name = "all",
        .title = "Every scene, method and number of steps",
        .columns = sizeof headings / sizeof *headings,
        .rows = BR_DRIFT_SCENES * d->contenders * d->k_count,
        .only_in_files = true,
        .self = d,
        .heading = all_heading,
        .cell = all_cell,
    };
}
