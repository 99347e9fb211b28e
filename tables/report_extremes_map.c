/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <inttypes.h>
#include <math.h>

#include "study/extremes/map.h"
#include "study/scene/words.h"
#include "tables/reports.h"

static void put_tallies(struct br_document *d, const struct br_extreme_map *m)
{
    br_put_table(d, "tally", "What was tried, and what came of it", 0);
    for (size_t i = 0; i < m->tallies; i++) {
        const struct br_extreme_tally *t = &m->tally[i];
        br_put_row(d);
        BR_PUT(d, br_text(t->title), .key = "tried", .heading = "what was tried");
        BR_PUT(d, br_text(*t->label ? t->label : NULL), .key = "range");
        BR_PUT(d, br_count(t->cases), .key = "cases");
        for (int c = 0; c < BR_EXTREME_CLASSES; c++)
            BR_PUT(d, br_count(t->count[c]), .key = br_extreme_names[c].word,
                   .heading = br_extreme_names[c].heading);
    }
}

static void put_reasons(struct br_document *d, const struct br_extreme_map *m)
{
    static const struct br_column columns[] = {
        {.key = "kind"}, {.key = "cases"}, {.key = "first"}, {.key = "reason", .flags = BR_WRAP}};
    BR_TABLE(d, "reasons", "Why it is not right (# stands for numbers)", BR_FILES_ONLY, columns);
    for (size_t i = 0; i < m->reasons; i++) {
        const struct br_extreme_tally *r = &m->reason[i];
        const struct br_extreme_names *name = &br_extreme_names[m->verdict[r->first].which];
        BR_PUT_ROW(d, br_text(name->word));
        br_put_shown(d, "%s", name->heading);
        BR_PUT_CELLS(d, br_count(r->cases), br_count(r->first), br_text(r->label));
    }
}

static void put_wrong(struct br_document *d, const struct br_extreme_map *m)
{
    static const struct br_column columns[] = {{.key = "case"},
                                               {.key = "scene"},
                                               {.key = "why", .flags = BR_WRAP},
                                               {.key = "command", .flags = BR_WRAP}};
    BR_TABLE(d, "wrong", "Silently wrong, made small", 0, columns);
    for (size_t i = 0; i < m->shrunks; i++) {
        const struct br_extreme_shrunk *s = &m->shrunk[i];
        BR_PUT_ROW(d, br_count(s->one.index), br_text(s->file), br_text(s->verdict.why),
                   br_text(s->command));
    }
}

static void put_warnings(struct br_document *d, unsigned warned)
{
    char text[400] = "";
    for (int kind = 0; kind < BR_WARNINGS; kind++)
        if (warned & 1u << kind)
            br_append(text, sizeof text, "%s%s", *text ? " " : "", br_warning_words[kind]);
    BR_PUT(d, br_text(*text ? text : NULL), .key = "warnings");
}

static void put_case(struct br_document *d, const struct br_extreme_case *c, size_t index,
                     const struct br_extreme_verdict *v)
{
    br_put_row(d);
    BR_PUT(d, br_count(index), .key = "case");
    BR_PUT(d, br_text(br_extreme_names[v->which].word), .key = "verdict");
    BR_PUT(d, br_text(v->by == BR_BY_NOBODY ? NULL : br_extreme_judges[v->by]), .key = "judge");
    BR_PUT(d, br_number(v->error), .key = "error", .format = "%.2e");
    BR_PUT(d, br_number(v->units), .key = "other_units", .heading = "other units",
           .format = "%.2e");
    BR_PUT(d, br_number(v->round_off), .key = "round_off", .heading = "round-off",
           .format = "%.2e");
    put_warnings(d, v->warned);
    BR_PUT(d, br_text(c->method.scheme->name), .key = "scheme");
    BR_PUT(d, br_text(c->method.solver->name), .key = "solver");
    BR_PUT(d, br_text(c->method.contact->name), .key = "contact");
    BR_PUT(d, br_text(c->method.friction->name), .key = "friction");
    BR_PUT(d, br_count((size_t)c->method.axial_degree), .key = "degree");
    BR_PUT(d, br_count(c->n), .key = "n");
    BR_PUT(d, br_count(c->steps), .key = "steps");
    BR_PUT(d, br_number(c->length), .key = "L", .unit = "m", .format = "%.4g");
    BR_PUT(d, br_number(c->duration), .key = "T", .unit = "s", .format = "%.4g");
    BR_PUT(d, br_number(c->density), .key = "rho", .unit = "kg/m", .format = "%.4g");
    BR_PUT(d, br_number(c->contact ? c->contact_stiffness : NAN), .key = "c_H", .unit = "N/m",
           .format = "%.4g");
    BR_PUT(d, br_number(c->law == BR_FRICTIONLESS ? NAN : c->friction), .key = "c_V",
           .format = "%.4g");
    BR_PUT(d, br_text(*v->why ? v->why : NULL), .key = "why", .flags = BR_WRAP);
}

static void put_cases(struct br_document *d, const struct br_extreme_map *m)
{
    br_put_table(d, "cases", "All cases", BR_FILES_ONLY | BR_MAIN);
    for (size_t i = 0; i < m->cases; i++)
        put_case(d, &m->one[i], i, &m->verdict[i]);
}

static void answer_map(struct br_document *d, const struct br_extreme_map *m)
{
    const size_t *n = m->count;
    const struct br_extreme_rate r = br_extreme_rate(m);
    if (n[BR_EXTREME_WRONG])
        br_put_answer(d, "%zu of %zu cases are silently wrong.", n[BR_EXTREME_WRONG], m->cases);
    else
        br_put_answer(d, "None of %zu cases is silently wrong.", m->cases);
    br_put_answer(
        d,
        "Right: %zu; inaccurate, and they say so: %zu; inaccurate, and they say that their error is "
        "not known: %zu; unstable as predicted: %zu; refused: %zu; given up by the map, since they "
        "or their judges take too long: %zu.",
        n[BR_EXTREME_RIGHT], n[BR_EXTREME_WARNED], n[BR_EXTREME_UNKNOWN], n[BR_EXTREME_UNSTABLE],
        n[BR_EXTREME_REFUSED], n[BR_EXTREME_UNJUDGED]);
    if (r.answers == 0)
        return;
    br_put_answer(
        d,
        "Of %zu answers that were judged, %.3g %% are silently wrong, which tells a rate between "
        "%.3g %% and %.3g %% (95 %%, Clopper and Pearson).",
        r.answers, 100 * (double)r.wrong / (double)r.answers, 100 * r.low, 100 * r.high);
    br_put_answer(
        d,
        "%zu of them, %.3g %%, say that their error is not known, %zu of these beyond the lagged "
        "contact's limit; all others state it, with an interval.",
        r.unstated, 100 * (double)r.unstated / (double)r.answers, r.unstated_unstable);
}

static void note_judging(struct br_document *d, const struct br_extreme_map *m)
{
    size_t judged[BR_BY_REFINEMENT + 1] = {0}, compared = 0;
    double units = 0;
    for (size_t i = 0; i < m->cases; i++) {
        judged[m->verdict[i].by]++;
        compared += isnan(m->verdict[i].units) ? 0 : 1;
        units = fmax(units, m->verdict[i].units); /* of NaN: the other */
    }
    br_put_section(d, "How it was judged");
    br_put_note(
        d,
        "Cases are drawn from seed %" PRIu64
        ". Silently wrong is an answer that is further from the truth than the error that it "
        "states, with its interval and round-off, or than 5 %% where it states none and no warning "
        "says so; and one that breaks an equation or a law. Right means: marched with the certificate "
        "of every step, within what is stated, and within 5 %% (each field relative to its largest, "
        "mean squares at eight times and up to 24 places), judged by the exact solution (%zu cases) "
        "or by another scheme on two to eight times the elements with up to 32 times the steps "
        "(%zu), and once more by a finer one before anything is called wrong.",
        m->seed, judged[BR_BY_EXACT], judged[BR_BY_REFINEMENT]);
    br_put_note(
        d,
        "%zu cases were marched in other units of length, time and mass, too. Their displacements "
        "agree to the predicted round-off, or to what a change of the data by 1e-12 does to them; "
        "the largest difference is %.1e.",
        compared, units);
}

void br_report_map(const struct br_extreme_map *m, struct br_document *d)
{
    char again[120];
    br_document_begin(d, "map", "beamrate extremes map", 1,
                      "The map of extremes: right, or refused; never silently wrong");
    answer_map(d, m);
    put_tallies(d, m);
    put_reasons(d, m);
    put_wrong(d, m);
    put_cases(d, m);
    note_judging(d, m);
    snprintf(again, sizeof again, "beamrate extremes map --cases %zu --seed %" PRIu64, m->cases,
             m->seed);
    br_put_command(d, "command", "To repeat this", again);
}
