/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tables/extremes_floors.h"

#include <math.h>
#include <string.h>

/* ---- one line a mesh: the worst over k ---- */

static const char *worst_heading(const void *self, size_t column, bool *number)
{
    const struct br_floors *f = self;
    *number = true;
    return column == 0 ? "n" : f->solver[column - 1].name;
}

/* The worst of the steps that are marched, and how many are refused. */
static void worst_cell(const void *self, size_t row, size_t column, char text[BR_CELL])
{
    const struct br_floors *f = self;
    double worst = 0;
    size_t refused = 0;
    if (column == 0) {
        snprintf(text, BR_CELL, "%zu", f->n[row]);
        return;
    }
    for (size_t j = 0; j < f->k_count; j++) {
        const struct br_floor *floor = br_floor_at(f, column - 1, row, j);
        const double deviation = br_floor_deviation(floor);
        if (floor->refused.status)
            refused++;
        else
            worst = isnan(worst) || deviation <= worst ? worst : deviation;
    }
    if (refused == f->k_count)
        snprintf(text, BR_CELL, "refused");
    else if (refused)
        snprintf(text, BR_CELL, "%.1e, %zu refused", worst, refused);
    else
        snprintf(text, BR_CELL, "%.1e", worst);
}

/* ---- all ---- */

enum { SOLVER, ELEMENTS, STEP, STEPS, AXIAL, BENDING, TIP_AXIAL, TIP_BENDING, PREDICTED, OUTCOME };

static const char *const headings[] = {
    "solver",  "n",         "k (s)",       "steps",     "axial",
    "bending", "axial tip", "bending tip", "predicted", "outcome",
};

static const char *all_heading(const void *self, size_t column, bool *number)
{
    (void)self;
    *number = column != SOLVER && column != OUTCOME;
    return headings[column];
}

static void put(char text[BR_CELL], double value)
{
    if (isfinite(value))
        snprintf(text, BR_CELL, "%.2e", value);
    else
        snprintf(text, BR_CELL, "-");
}

static void put_outcome(const struct br_floors *f, size_t solver, const struct br_floor *floor,
                        char text[BR_CELL])
{
    if (floor->refused.status)
        snprintf(text, BR_CELL, "refused: %.140s", floor->refused.message);
    else
        snprintf(text, BR_CELL, "%s",
                 br_floor_deviation(floor) <= br_floor_limit(f, solver, floor) ? "as predicted"
                                                                               : "ABOVE");
}

static void all_cell(const void *self, size_t row, size_t column, char text[BR_CELL])
{
    const struct br_floors *f = self;
    const struct br_floor *floor = &f->floor[row];
    const size_t solver = row / (f->n_count * f->k_count);
    switch (column) {
    case SOLVER:
        snprintf(text, BR_CELL, "%s", f->solver[solver].name);
        break;
    case ELEMENTS:
        snprintf(text, BR_CELL, "%zu", floor->n);
        break;
    case STEP:
        snprintf(text, BR_CELL, "%.6g", floor->k);
        break;
    case STEPS:
        snprintf(text, BR_CELL, "%zu", floor->steps);
        break;
    case AXIAL:
    case BENDING:
        put(text, floor->deviation[column - AXIAL]);
        break;
    case TIP_AXIAL:
    case TIP_BENDING:
        put(text, floor->tip[column - TIP_AXIAL]);
        break;
    case PREDICTED:
        put(text, floor->predicted);
        break;
    default:
        put_outcome(f, solver, floor, text);
    }
}

/* ---- words ---- */

static void say(const void *self, const struct br_writer *w)
{
    const struct br_floors *f = self;
    struct br_error err = {0};
    char text[1400];
    if (br_floors_verdict(f, &err))
        snprintf(text, sizeof text, "ABOVE: %s", err.message);
    else
        snprintf(text, sizeof text,
                 "Every solver is right to the round-off that it predicts, or refuses.");
    w->paragraph(w->self, text);
}

static void say_notes(const void *self, const struct br_writer *w)
{
    (void)self;
    w->paragraph(w->self,
                 "Deviation: the largest difference of all nodal displacements from the exact "
                 "discrete solution (the same equations in long double, in a form that loses "
                 "nothing), relative to the largest displacement of the field, after 20 steps of "
                 "Example 2 by implicit Euler with lagged contact; the larger of both fields.");
    w->paragraph(w->self,
                 "Refused: the assembled matrix would leave a march more than a twentieth off. "
                 "'refined' does up to 2 steps of refinement a solve, 'scaled' scales the rows.");
}

void br_floors_page(const struct br_floors *f, struct br_page *page)
{
    page->caption = "Round-off floors of the linear solvers";
    page->self = f;
    page->say = say;
    page->say_notes = say_notes;
    page->tables = 2;
    page->table[0] = (struct br_table){
        .name = "worst",
        .title = "Deviation from the exact discrete solution, the worst over k",
        .columns = 1 + f->solvers,
        .rows = f->n_count,
        .self = f,
        .heading = worst_heading,
        .cell = worst_cell,
    };
    page->table[1] = (struct br_table){
        .name = "all",
        .title = "Every solver, mesh and time step",
        .columns = sizeof headings / sizeof *headings,
        .rows = f->solvers * f->n_count * f->k_count,
        .only_in_files = true,
        .self = f,
        .heading = all_heading,
        .cell = all_cell,
    };
}
