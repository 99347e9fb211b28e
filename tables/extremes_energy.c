/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tables/extremes_energy.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

typedef const struct br_energy_behaviour behaviour;

/* The density that is shown. */
enum { SHOWN = BR_VIBRATION_DENSITIES / 2, TEXT = 800 };

static void put(char text[BR_CELL], const char *format, double value)
{
    if (isfinite(value))
        snprintf(text, BR_CELL, format, value);
    else
        snprintf(text, BR_CELL, "-");
}

static const char *field_name(enum br_field_kind kind)
{
    return kind == BR_AXIAL ? "axial" : "bending";
}

/* ---- free vibration: the rows of schemes with fixed steps, or of adaptive ones ---- */

static bool is_adaptive(const struct br_vibration_row *row)
{
    return row->scheme->adaptive;
}

static size_t count_rows(behaviour *b, bool adaptive)
{
    size_t count = 0;
    for (size_t i = 0; i < b->vibrations; i++)
        count += is_adaptive(&b->vibration[i]) == adaptive;
    return count;
}

static const struct br_vibration_row *row_of(behaviour *b, size_t row, bool adaptive)
{
    size_t i = 0;
    while (is_adaptive(&b->vibration[i]) != adaptive || row-- > 0)
        i++;
    return &b->vibration[i];
}

enum vibration_column { SCHEME, FIELD, DAMPING, RATES, OFF = RATES + BR_VIBRATION_RATES, WORST };

static void vibration_cell(const struct br_vibration_row *row, size_t column, char text[BR_CELL])
{
    double worst = 0;
    switch (column) {
    case SCHEME:
        snprintf(text, BR_CELL, "%s", row->scheme->name);
        return;
    case FIELD:
        snprintf(text, BR_CELL, "%s", field_name(row->kind));
        return;
    case DAMPING:
        put(text, "%g", row->damping);
        return;
    case OFF:
        put(text, "%.1e", br_vibration_difference(row));
        return;
    case WORST:
        for (size_t r = 0; r < BR_VIBRATION_RATES; r++)
            worst = fmax(worst, row->at[r][SHOWN].worst);
        put(text, "%.1e", row->at[0][SHOWN].end == BR_VIBRATION_DONE ? worst : NAN);
        return;
    default:
        break;
    }
    const struct br_vibration *v = &row->at[column - RATES][SHOWN];
    if (v->end != BR_VIBRATION_DONE)
        snprintf(text, BR_CELL, v->end == BR_VIBRATION_REFUSED ? "refused" : "failed");
    else if (is_adaptive(row))
        snprintf(text, BR_CELL, "%.2e (%.3g)", v->measured, v->steps);
    else
        put(text, "%.3e", v->measured);
}

static const char *vibration_heading(size_t column, bool adaptive, bool *number)
{
    static const char *const fixed[] = {"k = T/6",  "k = T/12", "k = T/24",
                                        "k = T/48", "k = T/96", "k = T/192"};
    static const char *const own[] = {"tol 1e-2", "tol 1e-3", "tol 1e-4",
                                      "tol 1e-5", "tol 1e-6", "tol 1e-7"};
    _Static_assert(sizeof fixed == sizeof own && sizeof own / sizeof *own == BR_VIBRATION_RATES,
                   "a heading a rate");
    *number = column > FIELD;
    switch (column) {
    case SCHEME:
        return "scheme";
    case FIELD:
        return "field";
    case DAMPING:
        return "damping";
    case OFF:
        return "off theory";
    case WORST:
        return "imbalance";
    default:
        return adaptive ? own[column - RATES] : fixed[column - RATES];
    }
}

static void fixed_cell(const void *self, size_t row, size_t column, char text[BR_CELL])
{
    vibration_cell(row_of(self, row, false), column, text);
}

static const char *fixed_heading(const void *self, size_t column, bool *number)
{
    (void)self;
    return vibration_heading(column, false, number);
}

/* Nothing is predicted of steps that are not equal. */
static size_t own_column(size_t column)
{
    return column >= OFF ? column + 1 : column;
}

static void adaptive_cell(const void *self, size_t row, size_t column, char text[BR_CELL])
{
    vibration_cell(row_of(self, row, true), own_column(column), text);
}

static const char *adaptive_heading(const void *self, size_t column, bool *number)
{
    (void)self;
    return vibration_heading(own_column(column), true, number);
}

/* ---- balances ---- */

static double put_in(const struct br_balance_row *row)
{
    return br_energy_put_in(&row->start, &row->work, BR_AXIAL) +
           br_energy_put_in(&row->start, &row->work, BR_BENDING);
}

static double added(const struct br_balance_row *row)
{
    return br_energy_added(&row->work, BR_AXIAL) + br_energy_added(&row->work, BR_BENDING);
}

static double share(double part, double whole)
{
    return whole > 0 ? 100 * part / whole : part == 0 ? 0 : NAN;
}

static double steps_of(const struct br_balance_row *row)
{
    return (double)(row->work.steps[0] + row->work.steps[1]);
}

static void outcome(const struct br_balance_row *row, char text[BR_CELL])
{
    if (row->scheme->integrator)
        snprintf(text, BR_CELL, "not told apart");
    else if (row->end == BR_VIBRATION_REFUSED)
        snprintf(text, BR_CELL, "refused");
    else if (row->end == BR_VIBRATION_FAILED)
        snprintf(text, BR_CELL, "ended after step %zu", row->marched);
    else
        snprintf(text, BR_CELL, br_balance_row_is_right(row) ? "closes" : "WRONG");
}

static const char *balance_heading(const void *self, size_t column, bool *number)
{
    static const char *const headings[] = {
        "scene",          "scheme",   "balance",           "put in, J", "lost to scheme, %",
        "its contact, %", "added, %", "steps that add, %", "imbalance", "limit"};
    (void)self;
    *number = column > 2;
    return headings[column];
}

static void balance_cell(const void *self, size_t i, size_t column, char text[BR_CELL])
{
    const struct br_balance_row *row = &((behaviour *)self)->balance[i];
    const struct br_work *w = &row->work;
    const bool told = row->end != BR_VIBRATION_REFUSED;
    switch (column) {
    case 0:
        snprintf(text, BR_CELL, "%s", br_balance_scenes[row->scene]);
        return;
    case 1:
        snprintf(text, BR_CELL, "%s", row->scheme->name);
        return;
    case 2:
        outcome(row, text);
        return;
    default:
        break;
    }
    const double values[] = {put_in(row),
                             share(w->scheme[0] + w->scheme[1], put_in(row)),
                             share(w->scheme_contact, put_in(row)),
                             share(added(row), put_in(row)),
                             share((double)(w->gaining[0] + w->gaining[1]), steps_of(row)),
                             row->worst,
                             row->limit};
    put(text, column >= 8 ? "%.1e" : "%.3g", told ? values[column - 3] : NAN);
}

/* ---- sentences ---- */

static void say_verdict(behaviour *b, const struct br_writer *w)
{
    char text[TEXT];
    double steps = 0, worst = 0, off = 0;
    size_t marches = 0, wrong = 0;
    for (size_t i = 0; i < b->balances; i++) {
        const struct br_balance_row *row = &b->balance[i];
        wrong += !br_balance_row_is_right(row);
        if (row->end == BR_VIBRATION_REFUSED)
            continue;
        marches++;
        steps += steps_of(row);
        worst = fmax(worst, row->worst);
    }
    for (size_t i = 0; i < b->vibrations; i++) {
        wrong += !br_vibration_row_is_right(&b->vibration[i]);
        off = fmax(off, br_vibration_difference(&b->vibration[i]));
    }
    snprintf(text, sizeof text,
             "%s Kinetic and stored energy, what viscosity, friction and the scheme take, and the "
             "work done balance in each of %.0f steps of a field in %zu marches of scenes, to %.1e "
             "of the terms' sum at worst. What the schemes take from a free vibration is what "
             "their stability functions predict, to %.1e of the energy a period.",
             wrong ? "WRONG: see the tables."
                   : "Every balance closes, and every loss is as "
                     "predicted.",
             steps, marches, worst, off);
    w->paragraph(w->self, text);
}

static void say_added(behaviour *b, const struct br_writer *w)
{
    char text[TEXT];
    for (size_t i = 0; i < b->balances; i++) {
        const struct br_balance_row *row = &b->balance[i];
        const double part = added(row) / put_in(row);
        if (!(part > 1e-3))
            continue;
        snprintf(text, sizeof text,
                 "%s by %s: the scheme added %.3g J, %.3g %% of what was put in%s.",
                 br_balance_scenes[row->scene], row->scheme->name, added(row), 100 * part,
                 row->work.scheme_contact < 0 && row->scheme->may_lag
                     ? "; it is the lagged contact's force, implicit contact adds nothing"
                     : "");
        w->paragraph(w->self, text);
    }
}

static void say_refused(behaviour *b, const struct br_writer *w)
{
    const char *last = "";
    char text[TEXT];
    for (size_t i = 0; i < b->vibrations; i++) {
        const struct br_vibration *v = &b->vibration[i].at[0][SHOWN];
        if (v->end == BR_VIBRATION_DONE || strcmp(v->failure.message, last) == 0)
            continue;
        last = v->failure.message;
        snprintf(text, sizeof text, "Refused: %.700s.", last);
        w->paragraph(w->self, text);
    }
}

static void say(const void *self, const struct br_writer *w)
{
    say_verdict(self, w);
    say_added(self, w);
    say_refused(self, w);
}

static void say_notes(const void *self, const struct br_writer *w)
{
    (void)self;
    w->paragraph(w->self,
                 "Loss a period: the share of the energy of the lowest mode that is gone after one "
                 "period T beside what viscosity would take; negative: viscosity took less than it "
                 "should. Without damping it is 1 - |R(i omega k)|^(2 T/k), R being the stability "
                 "function, or the principal root of backward differences. Measured over two "
                 "periods on 8 elements, for densities of 1e-6, 1 and 1e6 kg/m; shown is 1 kg/m.");
    w->paragraph(w->self,
                 "Added: to a field, by the scheme, in all of the march. Schemes of higher order "
                 "than Euler's may add in single steps what others take, by no more than their "
                 "error: that goes to zero with k.");
}

static void add_table(struct br_page *page, behaviour *b, struct br_table table)
{
    table.self = b;
    page->table[page->tables++] = table;
}

void br_energy_page(behaviour *b, struct br_page *page)
{
    page->caption = "Energy: what every scheme takes or adds, and whether every step's balance "
                    "closes";
    page->self = b;
    page->say = say;
    page->say_notes = say_notes;
    page->notes_title = "What is measured";
    page->tables = 0;
    add_table(page, b,
              (struct br_table){.name = "vibration",
                                .title = "Share of the energy of a free vibration lost a period",
                                .columns = WORST + 1,
                                .rows = count_rows(b, false),
                                .heading = fixed_heading,
                                .cell = fixed_cell});
    add_table(page, b,
              (struct br_table){.name = "adaptive",
                                .title = "The same of adaptive steps (steps a period)",
                                .columns = WORST,
                                .rows = count_rows(b, true),
                                .heading = adaptive_heading,
                                .cell = adaptive_cell});
    add_table(page, b,
              (struct br_table){.name = "balance",
                                .title = "Balances of scenes, 20 elements and 400 steps",
                                .columns = 10,
                                .rows = b->balances,
                                .only_in_files = true,
                                .heading = balance_heading,
                                .cell = balance_cell});
}
