/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tables/report_split.h"

#include <math.h>
#include <stdarg.h>
#include <string.h>

#include "tables/report_trial.h"

enum { TEXT = 640 };

/* Appends to a text of TEXT bytes. */
__attribute__((format(printf, 2, 3))) static void append(char text[TEXT], const char *format, ...)
{
    const size_t used = strlen(text);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text + used, TEXT - used, format, arguments);
    va_end(arguments);
}

/* "n = 100, k = 0.01 s: scheme euler, solver riccati on avx2, contact lagged" */
static const char *describe(const struct br_split *s, char text[TEXT])
{
    char method[BR_METHOD_TEXT];
    snprintf(text, TEXT, "n = %zu, k = %.10g s: %s", s->at.n, br_time_step(s->scene, s->at.steps),
             br_method_text(s->scene, &s->method, method));
    return text;
}

/* "99.8 %" */
static void append_share(char text[TEXT], double share)
{
    append(text, share > 0 && share < 1e-3 ? "%.1e %%" : "%.1f %%", 100 * share);
}

static bool is_told(const struct br_share *share, size_t norm)
{
    return !share->none && br_share_told(share, norm, BR_PART_TOTAL);
}

/* "n = 100, ... Error 7.437e-04 m^(3/2), by parts: lag 99.6 %, time 0.2 %, space 0.2 %." */
static void answer_run(struct br_document *d, const struct br_split *s)
{
    char run[TEXT], parts[TEXT] = "";
    for (size_t i = 0; i < s->shares; i++)
        if (is_told(&s->share[i], 0)) {
            append(parts, "%s%s ", *parts ? ", " : "", s->share[i].source->name);
            append_share(parts, br_share_of_sum(s, &s->share[i], 0, BR_PART_TOTAL));
        }
    br_put_answer(d, "%s. Error %.3e %s, by parts: %s.%s", describe(s, run),
                  s->whole.error[0][BR_PART_TOTAL], s->norm[0]->unit,
                  *parts ? parts : "none can be told",
                  s->unstable ? " The lagged contact is beyond its stability limit: its part is "
                                "bounded chatter."
                              : "");
}

/* ---- lines: a part of a run's error in one norm, the sum of the parts, or the whole ---- */

static bool models(const struct br_split *s, enum br_part part)
{
    return part == BR_PART_TOTAL ||
           (part == BR_PART_AXIAL ? s->scene->axial.modelled : s->scene->bending.modelled);
}

struct line {
    const char *name;
    const char *none;          /* why there is no such part; NULL: there is */
    const double *error, *tip; /* by br_part; by br_field_kind, m */
    const double *floor;       /* by br_part; NULL: none */
    double share;              /* of the sum; NaN: cannot be told */
};

enum { OTHERS = 2 };

static struct line line_of(const struct br_split *s, size_t norm, size_t i)
{
    if (i == s->shares)
        return (struct line){.name = "sum",
                             .error = s->sum[norm],
                             .tip = s->tip_sum,
                             .share = s->sum[norm][BR_PART_TOTAL] > 0};
    if (i > s->shares)
        return (struct line){.name = "whole",
                             .error = s->whole.error[norm],
                             .tip = s->whole.tip,
                             .floor = s->whole.floor[norm],
                             .share = NAN};
    const struct br_share *share = &s->share[i];
    return (struct line){
        .name = share->source->name,
        .none = share->none,
        .error = share->error[norm],
        .tip = share->tip,
        .floor = share->floor[norm],
        .share = is_told(share, norm) ? br_share_of_sum(s, share, norm, BR_PART_TOTAL) : NAN,
    };
}

/* An error and its floor. People see "< 3.4e-16" below the floor. */
static void add_error(struct br_row *row, const struct br_split *s, const struct line *l,
                      enum br_part part)
{
    static const char *const key[BR_PARTS] = {"error", "axial", "bending"},
                             *const floor_key[BR_PARTS] = {"floor", "axial_floor", "bending_floor"};
    const double error = models(s, part) ? l->error[part] : (double)NAN;
    const double floor = l->floor ? l->floor[part] : (double)NAN;
    br_row_hide(row, floor_key[part], NULL, br_number(floor));
    BR_ADD(row, br_number(error), .key = key[part], .heading = br_part_names[part],
           .format = "%.3e");
    if (isfinite(error) && floor > 0 && !(error > floor))
        br_row_shown(row, "< %.1e", floor);
}

static void add_share(struct br_row *row, double share)
{
    char text[TEXT] = "";
    append_share(text, share);
    BR_ADD(row, br_number(share), .key = "share", .heading = "of the sum");
    if (isfinite(share))
        br_row_shown(row, "%.30s", text);
}

static void add_line(struct br_row *row, const struct br_split *s, size_t norm, size_t i)
{
    const struct line l = line_of(s, norm, i);
    const bool told = i > s->shares || isfinite(l.share);
    const double relative = told ? l.error[BR_PART_TOTAL] / s->scale[norm] : (double)NAN;
    const double axial_tip = models(s, BR_PART_AXIAL) ? l.tip[BR_AXIAL] : (double)NAN;
    const double bending_tip = models(s, BR_PART_BENDING) ? l.tip[BR_BENDING] : (double)NAN;
    br_row_hide(row, "norm", NULL, br_text(s->norm[norm]->name));
    br_row_hide(row, "unit", NULL, br_text(s->norm[norm]->unit));
    BR_ADD(row, br_text(l.name), .key = "part");
    br_row_hide(row, "applies", NULL, br_truth(!l.none));
    const size_t first = row->cells;
    for (int part = 0; part < BR_PARTS; part++)
        add_error(row, s, &l, (enum br_part)part);
    add_share(row, l.share);
    BR_ADD(row, br_number(relative), .key = "relative", .heading = "of the solution",
           .format = "%.2e");
    BR_ADD(row, br_number(axial_tip), .key = "axial_tip", .heading = "axial tip", .unit = "m",
           .format = "%+.3e");
    BR_ADD(row, br_number(bending_tip), .key = "bending_tip", .heading = "bending tip", .unit = "m",
           .format = "%+.3e");
    if (l.none)
        br_row_empty(row, first);
    br_row_hide(row, "none", NULL, br_text(l.none));
}

/* ---- tables ---- */

static void add_run(struct br_row *row, const struct br_split *s, size_t run)
{
    br_row_hide(row, "run", NULL, br_count(run));
    br_row_hide(row, "n", NULL, br_count(s->at.n));
    br_row_hide(row, "steps", NULL, br_count(s->at.steps));
    br_row_hide(row, "k", "s", br_number(br_time_step(s->scene, s->at.steps)));
    br_row_add_method(row, &s->method);
}

/* For people: a table a run and norm, with the parts that there are. */
static void put_run_tables(struct br_document *d, const struct br_split *s)
{
    char title[TEXT + 64], run[TEXT];
    for (size_t m = 0; m < s->norms; m++) {
        snprintf(title, sizeof title, "%s; %s, %s", describe(s, run), s->norm[m]->name,
                 s->norm[m]->unit);
        br_put_table(d, "run", title, BR_FOR_PEOPLE, NULL, 0);
        for (size_t i = 0; i < s->shares + OTHERS; i++) {
            struct br_row row = {.cells = 0};
            if (i < s->shares && s->share[i].none)
                continue;
            add_line(&row, s, m, i);
            br_put_whole_row(d, &row);
        }
    }
}

/* For programs: all lines of all runs. */
static void put_parts(struct br_document *d, const struct br_split *split, size_t count)
{
    br_put_table(d, "parts", "Parts of the error", BR_FOR_PROGRAMS | BR_MAIN, NULL, 0);
    for (size_t r = 0; r < count; r++)
        for (size_t m = 0; m < split[r].norms; m++)
            for (size_t i = 0; i < split[r].shares + OTHERS; i++) {
                struct br_row row = {.cells = 0};
                add_run(&row, &split[r], r);
                add_line(&row, &split[r], m, i);
                br_put_whole_row(d, &row);
            }
}

static void put_runs(struct br_document *d, const struct br_split *split, size_t count)
{
    br_put_table(d, "runs", "Runs", BR_FOR_PROGRAMS, NULL, 0);
    for (size_t r = 0; r < count; r++) {
        const struct br_split *s = &split[r];
        struct br_row row = {.cells = 0};
        add_run(&row, s, r);
        br_row_hide(&row, "axial_tip", "m", br_number(s->tip[BR_AXIAL]));
        br_row_hide(&row, "bending_tip", "m", br_number(s->tip[BR_BENDING]));
        br_row_hide(&row, "solution_axial_tip", "m", br_number(s->solution_tip[BR_AXIAL]));
        br_row_hide(&row, "solution_bending_tip", "m", br_number(s->solution_tip[BR_BENDING]));
        br_row_hide(&row, "predicted_round_off", NULL, br_number(s->predicted_round_off));
        br_row_hide(&row, "unstable", NULL, br_truth(s->unstable));
        br_row_hide(&row, "reference", NULL, br_text(s->judge->name));
        br_row_hide(&row, "refined", NULL, br_text(s->refined.name));
        br_put_whole_row(d, &row);
    }
}

/* ---- notes ---- */

static void note_run(struct br_document *d, const struct br_split *s)
{
    for (size_t m = 0; m < s->norms; m++) {
        const double whole = s->whole.error[m][BR_PART_TOTAL], sum = s->sum[m][BR_PART_TOTAL];
        br_put_note(d, "The whole is %.3g of the sum of its parts%s (%s).", whole / sum,
                    whole < 0.9 * sum ? ", which point against each other" : "", s->norm[m]->name);
    }
    for (size_t i = 0; i < s->shares; i++)
        if (s->share[i].none)
            br_put_note(d, "No part %s: %s.", s->share[i].source->name, s->share[i].none);
    br_put_note(
        d, "Without time error: %s.%s At the tip the parts add up but for %.1e m.", s->refined.name,
        s->method.scheme->adaptive ? " The part called time is what the tolerance leaves." : "",
        fmax(fabs(s->tip_sum[BR_AXIAL] - s->whole.tip[BR_AXIAL]),
             fabs(s->tip_sum[BR_BENDING] - s->whole.tip[BR_BENDING])));
}

static void put_notes(struct br_document *d, const struct br_split *s)
{
    br_put_section(d, "What is measured");
    for (size_t m = 0; m < s->norms; m++)
        br_put_note(d, "%s", s->norm[m]->title);
    br_put_note(d,
                "A part is the distance of two marches, or of a march from the solution (%s). The "
                "second march has one source of error less. So the parts add up to the whole: as "
                "functions, and at the tip (x = L, t = T) as numbers with signs.",
                s->judge->name);
    br_put_note(d, "<: below this floor a part cannot be told from round-off and from the errors "
                   "of what it is measured by.");
    if (s->scene->remark)
        br_put_note(d, "%s", s->scene->remark);
}

void br_report_split(const struct br_split *split, size_t count,
                     const struct br_provenance *provenance, struct br_document *d)
{
    const struct br_scene *scene = split->scene;
    char name[512], caption[512];
    snprintf(name, sizeof name, "%.500s-split", scene->name);
    snprintf(caption, sizeof caption, "Where the error comes from: %.400s", scene->title);
    br_document_begin(d, name, "beamrate trade --split", 1, caption);
    br_put_hidden_fact(d, "scene.name", br_text(scene->name));
    for (size_t r = 0; r < count; r++)
        answer_run(d, &split[r]);
    for (size_t r = 0; r < count; r++) {
        put_run_tables(d, &split[r]);
        note_run(d, &split[r]);
    }
    put_runs(d, split, count);
    put_parts(d, split, count);
    put_notes(d, split);
    br_put_provenance(d, provenance);
}
