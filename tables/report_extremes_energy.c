/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <string.h>

#include "tables/report_extremes.h"

/* The density that people see. */
enum { SHOWN = BR_VIBRATION_DENSITIES / 2 };

static const char *field_name(enum br_field_kind kind)
{
    return kind == BR_AXIAL ? "axial" : "bending";
}

static double worst_of(const struct br_vibration_row *row)
{
    double worst = 0;
    for (size_t r = 0; r < BR_VIBRATION_RATES; r++)
        worst = fmax(worst, row->at[r][SHOWN].worst);
    return row->at[0][SHOWN].end == BR_VIBRATION_DONE ? worst : NAN;
}

static void put_loss(struct br_document *d, const struct br_vibration *v)
{
    br_put(d, NULL, br_number(v->end == BR_VIBRATION_DONE ? v->measured : NAN));
    if (v->end != BR_VIBRATION_DONE)
        br_put_shown(d, v->end == BR_VIBRATION_REFUSED ? "refused" : "failed");
    else if (v->scheme->adaptive)
        br_put_shown(d, "%.2e (%.3g)", v->measured, v->steps);
}

/* Rows of schemes with equal steps, or of adaptive ones, of which nothing is predicted. */
static void put_loss_grid(struct br_document *d, const struct br_energy_behaviour *b, bool adaptive)
{
    static const struct br_column columns[] = {
        {.key = "scheme"}, {.key = "field"}, {.key = "damping", .format = "%g"}};
    char heading[32];
    br_put_table(d, adaptive ? "losses_of_adaptive" : "losses",
                 adaptive ? "The same of adaptive steps (steps a period)"
                          : "Share of the energy of a free vibration lost a period",
                 BR_FOR_PEOPLE, BR_COLUMNS(columns));
    for (size_t r = 0; r < BR_VIBRATION_RATES; r++) {
        if (adaptive)
            snprintf(heading, sizeof heading, "tol %.0e", br_vibration_tolerance(r));
        else
            snprintf(heading, sizeof heading, "k = T/%zu", br_vibration_per_period(r));
        br_put_column(d, &(struct br_column){.heading = heading, .format = "%.3e"});
    }
    if (!adaptive)
        br_put_column(d,
                      &(struct br_column){.key = "off", .heading = "off theory", .format = "%.1e"});
    br_put_column(d, &(struct br_column){.key = "imbalance", .format = "%.1e"});
    for (size_t i = 0; i < b->vibrations; i++) {
        const struct br_vibration_row *row = &b->vibration[i];
        if (row->scheme->adaptive != adaptive)
            continue;
        br_put_row(d);
        br_put(d, "scheme", br_text(row->scheme->name));
        br_put(d, "field", br_text(field_name(row->kind)));
        br_put(d, "damping", br_number(row->damping));
        for (size_t r = 0; r < BR_VIBRATION_RATES; r++)
            put_loss(d, &row->at[r][SHOWN]);
        if (!adaptive)
            br_put(d, "off", br_number(br_vibration_difference(row)));
        br_put(d, "imbalance", br_number(worst_of(row)));
    }
}

static void put_vibration(struct br_document *d, const struct br_vibration *v)
{
    static const char *const ends[] = {"done", "refused", "failed"};
    const bool done = v->end == BR_VIBRATION_DONE, adaptive = v->scheme->adaptive;
    br_put_row(d);
    br_put(d, "scheme", br_text(v->scheme->name));
    br_put(d, "field", br_text(field_name(v->kind)));
    br_put(d, "damping", br_number(v->damping));
    br_put(d, "density", br_number(v->density));
    br_put(d, "steps_per_period", adaptive ? br_nothing() : br_count(v->per_period));
    br_put(d, "tolerance", br_number(adaptive ? v->tolerance : NAN));
    br_put(d, "steps", br_number(done ? v->steps : NAN));
    br_put(d, "lost", br_number(done ? v->measured : NAN));
    br_put(d, "predicted", br_number(done ? v->predicted : NAN));
    br_put(d, "imbalance", br_number(done ? v->worst : NAN));
    br_put(d, "end", br_text(ends[v->end]));
    br_put(d, "message", br_text(done ? NULL : v->failure.message));
}

static void put_vibrations(struct br_document *d, const struct br_energy_behaviour *b)
{
    static const struct br_column columns[] = {
        {.key = "scheme"},
        {.key = "field"},
        {.key = "damping"},
        {.key = "density", .unit = "kg/m"},
        {.key = "steps_per_period"},
        {.key = "tolerance"},
        {.key = "steps"},
        {.key = "lost"},
        {.key = "predicted"},
        {.key = "imbalance"},
        {.key = "end"},
        {.key = "message"},
    };
    br_put_table(d, "vibration", "Share of the energy of a free vibration lost a period",
                 BR_FOR_PROGRAMS, BR_COLUMNS(columns));
    for (size_t i = 0; i < b->vibrations; i++)
        for (size_t r = 0; r < BR_VIBRATION_RATES; r++)
            for (size_t density = 0; density < BR_VIBRATION_DENSITIES; density++)
                put_vibration(d, &b->vibration[i].at[r][density]);
}

static double put_in(const struct br_balance_row *row)
{
    return br_energy_put_in(&row->start, &row->work, BR_AXIAL) +
           br_energy_put_in(&row->start, &row->work, BR_BENDING);
}

static double added(const struct br_balance_row *row)
{
    return br_energy_added(&row->work, BR_AXIAL) + br_energy_added(&row->work, BR_BENDING);
}

static double steps_of(const struct br_balance_row *row)
{
    return (double)(row->work.steps[0] + row->work.steps[1]);
}

/* Percent; refused: nothing. */
static struct br_value share(const struct br_balance_row *row, double part, double whole)
{
    if (row->end == BR_VIBRATION_REFUSED || !(whole > 0 || part == 0))
        return br_nothing();
    return br_number(whole > 0 ? 100 * part / whole : 0);
}

static void put_outcome(struct br_document *d, const struct br_balance_row *row)
{
    if (row->end == BR_VIBRATION_REFUSED)
        br_put(d, "balance", br_text("refused"));
    else if (row->end == BR_VIBRATION_FAILED)
        br_put_text(d, "balance", "ended after step %zu", row->marched);
    else
        br_put(d, "balance", br_text(br_balance_row_is_right(row) ? "closes" : "WRONG"));
}

static void put_balances(struct br_document *d, const struct br_energy_behaviour *b)
{
    static const struct br_column columns[] = {
        {.key = "scene"},
        {.key = "scheme"},
        {.key = "balance"},
        {.key = "put_in", .heading = "put in", .unit = "J", .format = "%.3g"},
        {.key = "lost", .heading = "lost to scheme", .unit = "%", .format = "%.3g"},
        {.key = "contact", .heading = "its contact", .unit = "%", .format = "%.3g"},
        {.key = "added", .unit = "%", .format = "%.3g"},
        {.key = "gaining", .heading = "steps that add", .unit = "%", .format = "%.3g"},
        {.key = "imbalance", .format = "%.1e"},
        {.key = "limit", .format = "%.1e"},
    };
    br_put_table(d, "balance", "Balances of scenes, 20 elements and 400 steps", BR_FILES_ONLY,
                 BR_COLUMNS(columns));
    for (size_t i = 0; i < b->balances; i++) {
        const struct br_balance_row *row = &b->balance[i];
        const struct br_work *w = &row->work;
        const bool told = row->end != BR_VIBRATION_REFUSED;
        br_put_row(d);
        br_put(d, "scene", br_text(br_balance_scenes[row->scene]));
        br_put(d, "scheme", br_text(row->scheme->name));
        put_outcome(d, row);
        br_put(d, "put_in", br_number(told ? put_in(row) : NAN));
        br_put(d, "lost", share(row, w->scheme[0] + w->scheme[1], put_in(row)));
        br_put(d, "contact", share(row, w->scheme_contact, put_in(row)));
        br_put(d, "added", share(row, added(row), put_in(row)));
        br_put(d, "gaining", share(row, (double)(w->gaining[0] + w->gaining[1]), steps_of(row)));
        br_put(d, "imbalance", br_number(told ? row->worst : NAN));
        br_put(d, "limit", br_number(told ? row->limit : NAN));
    }
}

static void answer_energy(struct br_document *d, const struct br_energy_behaviour *b)
{
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
    br_put_answer(d, wrong ? "WRONG: see the tables."
                           : "Every balance closes, and every loss is as predicted.");
    br_put_answer(
        d,
        "Kinetic and stored energy, what viscosity, friction and the scheme take, and the "
        "work done balance in each of %.0f steps of a field in %zu marches of scenes, to "
        "%.1e of the terms' sum at worst.",
        steps, marches, worst);
    br_put_answer(d,
                  "What the schemes take from a free vibration is what their stability functions "
                  "predict, to %.1e of the energy a period.",
                  off);
}

static void note_added(struct br_document *d, const struct br_energy_behaviour *b)
{
    for (size_t i = 0; i < b->balances; i++) {
        const struct br_balance_row *row = &b->balance[i];
        const double part = added(row) / put_in(row);
        if (!(part > 1e-3))
            continue;
        br_put_note(d, "%s by %s: the scheme added %.3g J, %.3g %% of what was put in%s.",
                    br_balance_scenes[row->scene], row->scheme->name, added(row), 100 * part,
                    row->work.scheme_contact < 0 && row->scheme->may_lag
                        ? "; it is the lagged contact's force, implicit contact adds nothing"
                        : "");
    }
}

static void note_refused(struct br_document *d, const struct br_energy_behaviour *b)
{
    const char *last = "";
    for (size_t i = 0; i < b->vibrations; i++) {
        const struct br_vibration *v = &b->vibration[i].at[0][SHOWN];
        if (v->end == BR_VIBRATION_DONE || strcmp(v->failure.message, last) == 0)
            continue;
        last = v->failure.message;
        br_put_note(d, "Refused: %s.", last);
    }
}

void br_report_energy(const struct br_energy_behaviour *b, struct br_document *d)
{
    br_document_begin(
        d, "energy", "beamrate extremes energy", 1,
        "Energy: what every scheme takes or adds, and whether every step's balance closes");
    answer_energy(d, b);
    put_loss_grid(d, b, false);
    put_loss_grid(d, b, true);
    put_vibrations(d, b);
    put_balances(d, b);
    br_put_section(d, "What was added or refused");
    note_added(d, b);
    note_refused(d, b);
    br_put_section(d, "What is measured");
    br_put_note(
        d, "Loss a period: the share of the energy of the lowest mode that is gone after one "
           "period T beside what viscosity would take; negative: viscosity took less than it "
           "should. Without damping it is 1 - |R(i omega k)|^(2 T/k), R being the stability "
           "function, or the principal root of backward differences. Measured over two periods on "
           "8 elements, for densities of 1e-6, 1 and 1e6 kg/m; shown is 1 kg/m.");
    br_put_note(d, "Added: to a field, by the scheme, in all of the march. Schemes of higher order "
                   "than Euler's may add in single steps what others take, by no more than their "
                   "error: that goes to zero with k.");
}
