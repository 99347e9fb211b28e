/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tables/extremes_map.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

/* ---- how many of each kind ---- */

static const char *const class_headings[BR_EXTREME_CLASSES] = {
    [BR_EXTREME_RIGHT] = "right",
    [BR_EXTREME_WARNED] = "inaccurate, said",
    [BR_EXTREME_UNKNOWN] = "inaccurate, error not known",
    [BR_EXTREME_UNSTABLE] = "unstable as predicted",
    [BR_EXTREME_REFUSED] = "refused",
    [BR_EXTREME_UNJUDGED] = "given up by the map",
    [BR_EXTREME_WRONG] = "silently wrong",
};

static const char *tally_heading(const void *self, size_t column, bool *number)
{
    static const char *const first[] = {"what was tried", "range", "cases"};
    (void)self;
    *number = column >= 2;
    return column < 3 ? first[column] : class_headings[column - 3];
}

static void tally_cell(const void *self, size_t row, size_t column, char text[BR_CELL])
{
    const struct br_extreme_tally *t =
        &((const struct br_extremes_map_page *)self)->counts->tally[row];
    if (column == 0)
        snprintf(text, BR_CELL, "%s", t->axis ? t->axis->title : "all");
    else if (column == 1)
        snprintf(text, BR_CELL, "%s", t->axis ? t->label : "-");
    else
        snprintf(text, BR_CELL, "%zu", column == 2 ? t->cases : t->count[column - 3]);
}

/* ---- reasons ---- */

static const char *reason_heading(const void *self, size_t column, bool *number)
{
    static const char *const headings[] = {"kind", "cases", "first", "reason"};
    (void)self;
    *number = column == 1 || column == 2;
    return headings[column];
}

static void reason_cell(const void *self, size_t row, size_t column, char text[BR_CELL])
{
    const struct br_extreme_reason *r =
        &((const struct br_extremes_map_page *)self)->counts->reason[row];
    if (column == 0)
        snprintf(text, BR_CELL, "%s", class_headings[r->which]);
    else if (column == 3)
        snprintf(text, BR_CELL, "%s", r->text);
    else
        snprintf(text, BR_CELL, "%zu", column == 1 ? r->cases : r->first);
}

/* ---- what is wrong ---- */

static const char *wrong_heading(const void *self, size_t column, bool *number)
{
    static const char *const headings[] = {"case", "scene", "why", "command"};
    (void)self;
    *number = column == 0;
    return headings[column];
}

static void wrong_cell(const void *self, size_t row, size_t column, char text[BR_CELL])
{
    const struct br_extreme_shrunk *s =
        &((const struct br_extremes_map_page *)self)->map->shrunk[row];
    if (column == 0)
        snprintf(text, BR_CELL, "%zu", s->one.index);
    else
        snprintf(text, BR_CELL, "%.*s", BR_CELL - 1,
                 column == 1   ? s->file
                 : column == 2 ? s->verdict.why
                               : s->command);
}

/* ---- all cases ---- */

static const char *const case_headings[] = {
    "case",   "verdict", "judge",     "error",    "other units", "round-off", "warnings",
    "scheme", "solver",  "contact",   "friction", "degree",      "n",         "steps",
    "L, m",   "T, s",    "rho, kg/m", "c_H, N/m", "c_V",         "why"};
enum { CASE_COLUMNS = sizeof case_headings / sizeof *case_headings };

static const char *case_heading(const void *self, size_t column, bool *number)
{
    (void)self;
    *number = column == 0 || (column >= 3 && column <= 5) || (column >= 11 && column <= 18);
    return case_headings[column];
}

static void number_or_none(char text[BR_CELL], const char *format, double value)
{
    if (isnan(value))
        snprintf(text, BR_CELL, "-");
    else
        snprintf(text, BR_CELL, format, value);
}

static void warnings_cell(unsigned warned, char text[BR_CELL])
{
    size_t used = 0;
    snprintf(text, BR_CELL, "-");
    for (int kind = 0; kind < BR_WARNINGS; kind++)
        if (warned & 1u << kind && used < BR_CELL)
            used += (size_t)snprintf(text + used, BR_CELL - used, "%s%s", used ? " " : "",
                                     br_warning_word((enum br_warning_kind)kind));
}

static void verdict_cell(const struct br_extreme_verdict *v, size_t column, char text[BR_CELL])
{
    switch (column) {
    case 1:
        snprintf(text, BR_CELL, "%s", br_extreme_word(v->which));
        break;
    case 2:
        snprintf(text, BR_CELL, "%s", v->by == BR_BY_NOBODY ? "-" : br_extreme_by_name(v->by));
        break;
    case 6:
        warnings_cell(v->warned, text);
        break;
    case CASE_COLUMNS - 1:
        snprintf(text, BR_CELL, "%.*s", BR_CELL - 1, *v->why ? v->why : "-");
        break;
    default:
        number_or_none(text, "%.2e",
                       column == 3   ? v->error
                       : column == 4 ? v->units
                                     : v->round_off);
    }
}

static void method_cell(const struct br_extreme_case *c, size_t column, char text[BR_CELL])
{
    const struct br_method *m = &c->method;
    const char *const names[] = {m->scheme->name, m->solver->name, m->contact->name,
                                 m->friction->name};
    if (column == 11)
        snprintf(text, BR_CELL, "%d", m->axial_degree);
    else
        snprintf(text, BR_CELL, "%s", names[column - 7]);
}

static void case_cell(const void *self, size_t row, size_t column, char text[BR_CELL])
{
    const struct br_extremes_map_page *p = self;
    const struct br_extreme_case *c = &p->map->one[row];
    const double numbers[] = {c->length, c->duration, c->density,
                              c->contact ? c->contact_stiffness : NAN,
                              c->law == BR_FRICTIONLESS ? NAN : c->friction};
    if (column == 0)
        snprintf(text, BR_CELL, "%zu", row);
    else if (column <= 6 || column == CASE_COLUMNS - 1)
        verdict_cell(&p->map->verdict[row], column, text);
    else if (column <= 11)
        method_cell(c, column, text);
    else if (column <= 13)
        snprintf(text, BR_CELL, "%zu", column == 12 ? c->n : c->steps);
    else
        number_or_none(text, "%.4g", numbers[column - 14]);
}

/* ---- in words ---- */

static void say_rate(const struct br_extreme_map *m, const struct br_writer *w)
{
    const struct br_extreme_rate r = br_extreme_rate(m);
    if (r.answers == 0)
        return;
    br_say(
        w,
        "Of %zu answers that were judged, %.2g %% are silently wrong, which tells a rate between "
        "%.2g %% and %.2g %% (95 %%, Clopper and Pearson).",
        r.answers, 100 * (double)r.wrong / (double)r.answers, 100 * r.low, 100 * r.high);
    br_say(
        w,
        "%zu of them, %.2g %%, say that their error is not known, %zu of these beyond the lagged "
        "contact's limit; all others state it, with an interval.",
        r.unstated, 100 * (double)r.unstated / (double)r.answers, r.unstated_unstable);
}

static void say_counts(const void *self, const struct br_writer *w)
{
    const struct br_extreme_map *m = ((const struct br_extremes_map_page *)self)->map;
    const size_t *n = m->count;
    if (n[BR_EXTREME_WRONG])
        br_say(w, "%zu of %zu cases are silently wrong.", n[BR_EXTREME_WRONG], m->cases);
    else
        br_say(w, "None of %zu cases is silently wrong.", m->cases);
    br_say(w,
           "%zu are right, %zu are inaccurate and say so, %zu are inaccurate and say that their "
           "error is not known, %zu are unstable as predicted, %zu are refused, and %zu were given "
           "up by the map, since they or their judges take too long.",
           n[BR_EXTREME_RIGHT], n[BR_EXTREME_WARNED], n[BR_EXTREME_UNKNOWN], n[BR_EXTREME_UNSTABLE],
           n[BR_EXTREME_REFUSED], n[BR_EXTREME_UNJUDGED]);
    say_rate(m, w);
}

static size_t judged_by(const struct br_extreme_map *m, enum br_extreme_by by)
{
    size_t count = 0;
    for (size_t i = 0; i < m->cases; i++)
        count += m->verdict[i].by == by;
    return count;
}

static double largest_units(const struct br_extreme_map *m, size_t *compared)
{
    double most = 0;
    *compared = 0;
    for (size_t i = 0; i < m->cases; i++)
        if (!isnan(m->verdict[i].units)) {
            most = fmax(most, m->verdict[i].units);
            (*compared)++;
        }
    return most;
}

static void say_how(const void *self, const struct br_writer *w)
{
    const struct br_extreme_map *m = ((const struct br_extremes_map_page *)self)->map;
    size_t compared;
    const double units = largest_units(m, &compared);
    br_say(
        w,
        "Cases are drawn from seed %" PRIu64
        ". Silently wrong is an answer that is further from the truth than the error that it "
        "states, with its interval and round-off, or than 5 %% where it states none and no warning "
        "says so; and one that breaks an equation or a law. Right means: marched with the certificate "
        "of every step, within what is stated, and within 5 %% (each field relative to its largest, "
        "mean squares at eight times and up to 24 places), judged by the exact solution (%zu cases) "
        "or by another scheme on two to eight times the elements with up to 32 times the steps "
        "(%zu), and once more by a finer one before anything is called wrong.",
        m->seed, judged_by(m, BR_BY_EXACT), judged_by(m, BR_BY_REFINEMENT));
    br_say(
        w,
        "%zu cases were marched in other units of length, time and mass, too. Their displacements "
        "agree to the predicted round-off, or to what a change of the data by 1e-12 does to them; "
        "the largest difference is %.1e.",
        compared, units);
    br_say(w, "beamrate extremes map --cases %zu --seed %" PRIu64 " repeats this.", m->cases,
           m->seed);
}

void br_extremes_map_page(const struct br_extremes_map_page *self, struct br_page *page)
{
    const struct br_table tables[] = {
        {"map", "What was tried, and what came of it", 3 + BR_EXTREME_CLASSES,
         self->counts->tallies, false, self, tally_heading, tally_cell},
        {"reasons", "Why it is not right (# stands for numbers)", 4, self->counts->reasons, true,
         self, reason_heading, reason_cell},
        {"wrong", "Silently wrong, made small", 4, self->map->shrunks, false, self, wrong_heading,
         wrong_cell},
        {"cases", "All cases", CASE_COLUMNS, self->map->cases, true, self, case_heading, case_cell},
    };
    page->caption = "The map of extremes: right, or refused; never silently wrong";
    page->self = self;
    page->say = say_counts;
    page->say_notes = say_how;
    page->notes_title = "How it was judged";
    page->tables = 0;
    for (size_t i = 0; i < sizeof tables / sizeof *tables; i++)
        if (tables[i].rows)
            page->table[page->tables++] = tables[i];
}
