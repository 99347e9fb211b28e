/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <string.h>

#include "study/extremes/extremes.h"
#include "tables/reports.h"

/* The density that is shown to people. */
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
    char heading[32];
    const bool done = v->end == BR_VIBRATION_DONE;
    if (v->scheme->adaptive)
        snprintf(heading, sizeof heading, "tol %.0e", v->tolerance);
    else
        snprintf(heading, sizeof heading, "k = T/%zu", v->per_period);
    BR_PUT(d, br_if(done, br_number(v->measured)), .heading = heading, .format = "%.3e");
    if (!done)
        br_put_shown(d, v->end == BR_VIBRATION_REFUSED ? "refused" : "failed");
    else if (v->scheme->adaptive)
        br_put_shown(d, "%.2e (%.3g)", v->measured, v->steps);
}

/* Rows of schemes with equal steps, or of adaptive ones, of which nothing is predicted. */
static void put_loss_grid(struct br_document *d, const struct br_energy_behaviour *b, bool adaptive)
{
    br_put_table(d, adaptive ? "losses_of_adaptive" : "losses",
                 adaptive ? "The same of adaptive steps (steps a period)"
                          : "Share of the energy of a free vibration lost a period",
                 BR_FOR_PEOPLE);
    for (size_t i = 0; i < b->vibrations; i++) {
        const struct br_vibration_row *row = &b->vibration[i];
        if (row->scheme->adaptive != adaptive)
            continue;
        br_put_row(d);
        BR_PUT(d, br_text(row->scheme->name), .key = "scheme");
        BR_PUT(d, br_text(field_name(row->kind)), .key = "field");
        BR_PUT(d, br_number(row->damping), .key = "damping", .format = "%g");
        for (size_t r = 0; r < BR_VIBRATION_RATES; r++)
            put_loss(d, &row->at[r][SHOWN]);
        if (!adaptive)
            BR_PUT(d, br_number(br_vibration_difference(row)), .key = "off",
                   .heading = "off theory", .format = "%.1e");
        BR_PUT(d, br_number(worst_of(row)), .key = "imbalance", .format = "%.1e");
    }
}

static void put_vibration(struct br_document *d, const struct br_vibration *v)
{
    static const char *const ends[] = {"done", "refused", "failed"};
    const bool done = v->end == BR_VIBRATION_DONE, adaptive = v->scheme->adaptive;
    br_put_row(d);
    BR_PUT(d, br_text(v->scheme->name), .key = "scheme");
    BR_PUT(d, br_text(field_name(v->kind)), .key = "field");
    BR_PUT(d, br_number(v->damping), .key = "damping");
    BR_PUT(d, br_number(v->density), .key = "density", .unit = "kg/m");
    BR_PUT(d, br_if(!adaptive, br_count(v->per_period)), .key = "steps_per_period");
    BR_PUT(d, br_if(adaptive, br_number(v->tolerance)), .key = "tolerance");
    br_put_blank(d, !done);
    BR_PUT(d, br_number(v->steps), .key = "steps");
    BR_PUT(d, br_number(v->measured), .key = "lost");
    BR_PUT(d, br_number(v->predicted), .key = "predicted");
    BR_PUT(d, br_number(v->worst), .key = "imbalance");
    br_put_blank(d, false);
    BR_PUT(d, br_text(ends[v->end]), .key = "end");
    BR_PUT(d, br_text(done ? NULL : v->failure.message), .key = "message");
}

static void put_vibrations(struct br_document *d, const struct br_energy_behaviour *b)
{
    br_put_table(d, "vibration", "Share of the energy of a free vibration lost a period",
                 BR_FOR_PROGRAMS);
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

/* In per cent. */
static void put_share(struct br_document *d, const char *key, const char *heading, double amount,
                      double whole)
{
    BR_PUT(d,
           br_number(whole > 0     ? 100 * amount / whole
                     : amount == 0 ? 0
                                   : NAN),
           .key = key, .heading = heading, .unit = "%", .format = "%.3g");
}

static void put_outcome(struct br_document *d, const struct br_balance_row *row)
{
    char text[64];
    snprintf(text, sizeof text, "ended after step %zu", row->marched);
    BR_PUT(d,
           br_text(row->end == BR_VIBRATION_REFUSED  ? "refused"
                   : row->end == BR_VIBRATION_FAILED ? text
                   : br_balance_row_is_right(row)    ? "closes"
                                                     : "WRONG"),
           .key = "balance");
}

static void put_balances(struct br_document *d, const struct br_energy_behaviour *b)
{
    br_put_table(d, "balance", "Balances of scenes, 20 elements and 400 steps", BR_FILES_ONLY);
    for (size_t i = 0; i < b->balances; i++) {
        const struct br_balance_row *row = &b->balance[i];
        const struct br_work *w = &row->work;
        const double in = put_in(row), gaining = (double)(w->gaining[0] + w->gaining[1]);
        br_put_row(d);
        BR_PUT(d, br_text(row->scene->name), .key = "scene");
        BR_PUT(d, br_text(row->scheme->name), .key = "scheme");
        put_outcome(d, row);
        br_put_blank(d, row->end == BR_VIBRATION_REFUSED);
        BR_PUT(d, br_number(in), .key = "put_in", .heading = "put in", .unit = "J",
               .format = "%.3g");
        put_share(d, "lost", "lost to scheme", w->scheme[0] + w->scheme[1], in);
        put_share(d, "contact", "its contact", w->scheme_contact, in);
        put_share(d, "added", NULL, added(row), in);
        put_share(d, "gaining", "steps that add", gaining, steps_of(row));
        BR_PUT(d, br_number(row->worst), .key = "imbalance", .format = "%.1e");
        BR_PUT(d, br_number(row->limit), .key = "limit", .format = "%.1e");
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
        const double share = added(row) / put_in(row);
        if (!(share > 1e-3))
            continue;
        br_put_note(d, "%s by %s: the scheme added %.3g J, %.3g %% of what was put in%s.",
                    row->scene->name, row->scheme->name, added(row), 100 * share,
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
