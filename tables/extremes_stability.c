/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tables/extremes_stability.h"

#include <math.h>

static const char *heading_of(const char *const *headings, size_t words, size_t column,
                              bool *number)
{
    *number = column >= words;
    return headings[column];
}

static void put(char text[BR_CELL], const char *format, double value)
{
    if (isnan(value))
        snprintf(text, BR_CELL, "-");
    else
        snprintf(text, BR_CELL, format, value);
}

/* ---- limits ---- */

enum { LIMIT_COLUMNS = 7 };

static const char *limit_heading(const void *self, size_t column, bool *number)
{
    static const char *const headings[LIMIT_COLUMNS] = {
        "rod", "rho, kg/m", "c, N s", "k, s", "predicted, N/m", "measured, N/m", "difference"};
    (void)self;
    return heading_of(headings, 1, column, number);
}

static void limit_cell(const void *self, size_t row, size_t column, char text[BR_CELL])
{
    const struct br_stability *s = self;
    const struct br_stability_plane *p = &s->plane[row / s->rows];
    const struct br_stability_row *r = &p->row[row % s->rows];
    const double values[LIMIT_COLUMNS] = {
        0,        p->rod->density, p->rod->viscosity,         r->k,
        r->limit, r->measured,     r->measured / r->limit - 1};
    if (column == 0)
        snprintf(text, BR_CELL, "%s", p->rod->title);
    else
        put(text, column == 6 ? "%.1e" : column >= 4 ? "%.12g" : "%.4g", values[column]);
}

/* ---- cells ---- */

enum { CELL_COLUMNS = 5 };

static const char *cell_heading(const void *self, size_t column, bool *number)
{
    static const char *const headings[CELL_COLUMNS] = {"rod", "k, s", "c_H, N/m",
                                                       "largest eigenvalue", "predicted growth"};
    (void)self;
    return heading_of(headings, 1, column, number);
}

static void cell_cell(const void *self, size_t row, size_t column, char text[BR_CELL])
{
    const struct br_stability *s = self;
    const size_t cells = s->rows * s->columns, at = row % cells;
    const struct br_stability_plane *p = &s->plane[row / cells];
    const double growth = p->growth[at];
    const double values[CELL_COLUMNS] = {0, p->row[at / s->columns].k,
                                         s->stiffness[at % s->columns], p->radius[at],
                                         growth > 1 ? growth : NAN};
    if (column == 0)
        snprintf(text, BR_CELL, "%s", p->rod->name);
    else
        put(text, column >= 3 ? "%.15g" : "%.6g", values[column]);
}

/* ---- schemes ---- */

enum { SCHEME_COLUMNS = 6 };

static const char *scheme_heading(const void *self, size_t column, bool *number)
{
    static const char *const headings[SCHEME_COLUMNS] = {
        "scheme", "marches", "failed", "without a certificate", "force off by", "depth off by"};
    (void)self;
    return heading_of(headings, 1, column, number);
}

static void scheme_cell(const void *self, size_t row, size_t column, char text[BR_CELL])
{
    const struct br_stability_scheme *c = &((const struct br_stability *)self)->scheme[row];
    if (column == 0)
        snprintf(text, BR_CELL, "%s", c->scheme->name);
    else if (column >= 4)
        put(text, "%.1e", column == 4 ? c->force : c->depth);
    else if (column == 3 && !c->certified)
        snprintf(text, BR_CELL, "-");
    else
        snprintf(text, BR_CELL, "%zu",
                 column == 1   ? c->marches
                 : column == 2 ? c->failed
                               : c->uncertain);
}

/* ---- tips ---- */

enum { TIP_COLUMNS = 5, BOUNCE_COLUMNS = 5 };

static const char *tip_heading(const void *self, size_t column, bool *number)
{
    static const char *const headings[TIP_COLUMNS] = {"c_H over its limit", "c_H, N/m",
                                                      "times it opened", "swing", "farthest"};
    (void)self;
    return heading_of(headings, 0, column, number);
}

static void tip_cell(const void *self, size_t row, size_t column, char text[BR_CELL])
{
    const struct br_stability_tip *t = &((const struct br_stability *)self)->tip[row];
    const double values[TIP_COLUMNS] = {t->share, t->stiffness, 0, t->swing, t->farthest};
    if (column == 2)
        snprintf(text, BR_CELL, "%zu", t->opened);
    else
        put(text, column >= 3 ? "%.2e" : "%.6g", values[column]);
}

static const char *bounce_heading(const void *self, size_t column, bool *number)
{
    static const char *const headings[BOUNCE_COLUMNS] = {
        "c_H, N/m", "over the limit without inertia", "over the limit", "impacts",
        "largest energy over the first"};
    (void)self;
    return heading_of(headings, 0, column, number);
}

static void bounce_cell(const void *self, size_t row, size_t column, char text[BR_CELL])
{
    const struct br_stability_bounce *b = &((const struct br_stability *)self)->bounce[row];
    const double values[BOUNCE_COLUMNS] = {b->stiffness, b->bouncing, b->limit, 0, b->energy};
    if (column == 3)
        snprintf(text, BR_CELL, "%zu", b->impacts);
    else
        put(text, column == 4 ? "%.7g" : "%.4g", values[column]);
}

/* ---- in words ---- */

static void say_found(const void *self, const struct br_writer *w)
{
    const struct br_stability *s = self;
    struct br_error err = {0};
    if (br_stability_verdict(s, &err))
        br_say(w, "Not as predicted: %s.", err.message);
    else
        br_say(w, "The contact is stable and unstable exactly where it is predicted to be.");
    br_say(
        w,
        "The largest relative difference between a predicted and a measured stability limit of the "
        "lagged contact is %.1e; between predicted and measured growth, in %zu of %zu cells of the "
        "planes, %.1e.",
        s->limit_error, s->growing, s->cells, s->growth_error);
    if (s->excess > 0)
        br_say(w, "In the other cells eigenvalues are up to %.1e outside the unit circle.",
               s->excess);
    else
        br_say(w, "In the other cells all eigenvalues are within the unit circle.");
    br_say(w,
           "Contact at u_n has no limit: every scheme brings a pressed rod to rest with c_H up to "
           "1e15 N/m.");
}

static void say_how(const void *self, const struct br_writer *w)
{
    const struct br_stability *s = self;
    br_say(
        w,
        "Measured: the matrix of a step against a closed contact, column by column by marches of "
        "one step of %zu elements, its largest eigenvalue, and by bisection the c_H where that "
        "leaves the unit circle. Predicted: c_H times the tip's flexibility at s = 2/k is 1.",
        s->n);
    br_say(
        w,
        "Pressed tips (the paper's rod, k = %g s, 4000 steps of a constant load): swing of the last "
        "quarter, and largest displacement, over the free rod's. Within the limit they rest, "
        "beyond it they chatter.",
        s->tip_k);
    br_say(
        w,
        "Bouncing rods (no viscosity, k = %g s): within the limit without inertia, (a + 2c/k)/L, a "
        "lagged contact never gains energy; between that and the limit a closed one is stable, but "
        "impacts may gain some. Euler with contact at u_n gains none.",
        s->bounce_k);
}

void br_extremes_stability_page(const struct br_stability *s, struct br_page *page)
{
    const struct br_table tables[] = {
        {"limits", "Stability limit of the lagged contact", LIMIT_COLUMNS,
         BR_STABILITY_RODS * s->rows, true, s, limit_heading, limit_cell},
        {"cells", "Growth a step of the closed lagged contact", CELL_COLUMNS,
         BR_STABILITY_RODS * s->rows * s->columns, true, s, cell_heading, cell_cell},
        {"schemes", "Contact at u_n, c_H from 1 to 1e15 N/m", SCHEME_COLUMNS, s->schemes, false, s,
         scheme_heading, scheme_cell},
        {"pressed", "A pressed tip, lagged contact", TIP_COLUMNS, BR_STABILITY_TIPS, false, s,
         tip_heading, tip_cell},
        {"bouncing", "A bouncing rod, lagged contact", BOUNCE_COLUMNS, BR_STABILITY_BOUNCES, false,
         s, bounce_heading, bounce_cell},
    };
    page->caption = "The contact's stability: predicted, and measured by marches";
    page->self = s;
    page->say = say_found;
    page->say_notes = say_how;
    page->notes_title = "How it was measured";
    for (page->tables = 0; page->tables < sizeof tables / sizeof *tables; page->tables++)
        page->table[page->tables] = tables[page->tables];
}
