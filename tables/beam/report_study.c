/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <string.h>

#include "reference/exact/exact.h"
#include "solver/scene.h"
#include "study/fit/report.h"
#include "study/scene/method_fields.h"
#include "tables/beam/report_parts.h"

bool br_part_is_shown(const struct br_report *r, enum br_part part)
{
    const struct br_scene *s = r->study->scene;
    return part == BR_PART_TOTAL || (s->axial.modelled && s->bending.modelled);
}

/* ---- grids, for people: a row for each mesh, a column for each time step ---- */

struct grid {
    const char *key, *title;
    const struct br_study *study;
    enum br_part part;
    double (*value)(const struct br_report *r, size_t cell); /* NULL: the study's errors */
    const char *format;                                      /* NULL: of errors */
    unsigned flags;
};

static void put_grid(struct br_document *d, const struct br_report *r, const struct grid *g)
{
    static const char *const marks[BR_CELL_FLAGS] = {"", "R", "F", "X", "U", "S"};
    const struct br_study *s = g->study;
    br_put_table(d, g->key, g->title, BR_FOR_PEOPLE | g->flags);
    for (size_t i = 0; i < s->n_count; i++) {
        br_put_row(d);
        BR_PUT(d, br_count(s->n[i]), .key = "n");
        for (size_t j = 0; j < s->k_count; j++) {
            const struct br_cell *c = br_study_cell(s, i, j);
            const double value = g->value ? g->value(r, i * s->k_count + j) : c->error[g->part];
            BR_PUT(d, br_number(value), .key = br_format(d, "steps%zu", s->steps[j]),
                   .heading = br_format(d, "k = %g", br_time_step(s->scene, s->steps[j])),
                   .format = g->format ? g->format : "%.3e");
            br_put_mark(d, g->value ? NULL : marks[c->flag[g->part]]);
        }
    }
}

static double printed_of(const struct br_report *r, size_t cell)
{
    return r->printed[cell];
}

static void put_error_grid(struct br_document *d, const struct br_report *r,
                           const struct br_study *s, enum br_part part)
{
    static const char *const names[] = {"Total", "Axial", "Bending"};
    const bool fitted = s == r->fitted;
    put_grid(d, r,
             &(struct grid){.key = fitted ? br_part_names[part] : s->reference_kind->name,
                            .title = br_format(d, "%s error against %s, %s", names[part],
                                               s->reference_kind->name, s->norm->unit),
                            .study = s,
                            .part = part,
                            .flags = part == BR_PART_TOTAL && fitted ? 0 : BR_FILES_ONLY});
}

static void put_grids(struct br_document *d, const struct br_report *r)
{
    for (enum br_part part = 0; part < BR_PARTS; part++)
        if (br_part_is_shown(r, part))
            put_error_grid(d, r, r->fitted, part);
    if (r->exact)
        put_error_grid(d, r, r->study, BR_PART_TOTAL);
    if (!r->printed)
        return;
    put_grid(d, r,
             &(struct grid){"printed", "Printed error, m^(3/2)", r->study, .value = printed_of,
                            .flags = BR_FILES_ONLY});
    put_grid(d, r,
             &(struct grid){
                 "ratio",
                 br_format(d, "Ours (against %s) over printed", r->study->reference_kind->name),
                 r->study, .value = br_report_ratio, .format = "%.3f"});
}

/* ---- lists ---- */

/* The order that a cell and its coarser neighbour along an axis show; nothing where there is no
 * neighbour. */
static struct br_value rate_to(const struct br_study *s, size_t cell, enum br_part part, int axis)
{
    const size_t stride = axis == BR_AXIS_SPACE ? s->k_count : 1;
    if (axis == BR_AXIS_SPACE ? cell < stride : cell % s->k_count == 0)
        return br_nothing();
    const struct br_cell *fine = &s->cell[cell], *coarse = fine - stride;
    const double ratio = axis == BR_AXIS_SPACE ? (double)fine->at.n / (double)coarse->at.n
                                               : (double)fine->at.steps / (double)coarse->at.steps;
    return br_number(log(coarse->error[part] / fine->error[part]) / log(ratio));
}

static void put_cell(struct br_document *d, const struct br_report *r, const struct br_study *s,
                     enum br_part part, size_t cell)
{
    const struct br_cell *c = &s->cell[cell];
    const char *unit = r->study->norm->unit;
    const bool printed = s == r->study && part == BR_PART_TOTAL && r->printed;
    const bool marched = c->failure.status == BR_OK;
    br_put_row(d);
    BR_PUT(d, br_text(s->reference_kind->name), .key = "reference");
    BR_PUT(d, br_text(br_part_names[part]), .key = "part");
    BR_PUT(d, br_count(c->at.n), .key = "n");
    BR_PUT(d, br_number(br_mesh_size(s->scene, c->at.n)), .key = "h", .unit = "m");
    BR_PUT(d, br_count(c->at.steps), .key = "steps");
    BR_PUT(d, br_number(br_step_of(s, c)), .key = "k", .unit = "s");
    BR_PUT(d, br_number(c->error[part]), .key = "error", .unit = unit);
    BR_PUT(d, br_number(br_relative_of(s, c, part)), .key = "relative");
    BR_PUT(d, br_text(c->flag[part] ? br_flag_name(c->flag[part]) : NULL), .key = "flag");
    BR_PUT(d, rate_to(s, cell, part, BR_AXIS_SPACE), .key = "rate_h");
    BR_PUT(d, rate_to(s, cell, part, BR_AXIS_TIME), .key = "rate_k");
    BR_PUT(d, br_number(printed ? r->printed[cell] : NAN), .key = "printed", .unit = unit);
    BR_PUT(d, br_number(printed ? br_report_ratio(r, cell) : NAN), .key = "ratio");
    BR_PUT(d, br_number(c->worst_time[part]), .key = "worst_time", .unit = "s");
    BR_PUT(d, br_if(marched && s->scene->axial.modelled, br_number(c->tip[BR_AXIAL])),
           .key = "tip_axial", .unit = "m");
    BR_PUT(d, br_if(marched && s->scene->bending.modelled, br_number(c->tip[BR_BENDING])),
           .key = "tip_bending", .unit = "m");
    BR_PUT(d, br_number(c->seconds), .key = "seconds", .unit = "s");
    BR_PUT(d, br_failure_text(&c->failure), .key = "failure");
}

static void put_cells(struct br_document *d, const struct br_report *r)
{
    const struct br_study *const studies[] = {r->study, r->exact};
    br_put_table(d, "cells", "Every cell, part and reference", BR_FOR_PROGRAMS | BR_MAIN);
    for (size_t i = 0; i < 2 && studies[i]; i++)
        for (enum br_part part = 0; part < BR_PARTS; part++)
            for (size_t c = 0; br_part_is_shown(r, part) && c < br_study_cells(r->study); c++)
                put_cell(d, r, studies[i], part, c);
}

void br_report_study(const struct br_report *r, struct br_document *d)
{
    br_document_begin(d, r->name, "beamrate study", 2, r->caption);
    br_put_study_answers(d, r);

    /* The orders of the answers, and those of each component. */
    const struct br_study *fitted = r->fitted;
    const struct br_cell *finest = br_finest_of(fitted);
    const double error = finest->error[BR_PART_TOTAL];
    const double relative = br_relative_of(fitted, finest, BR_PART_TOTAL);
    char text[64];
    br_put_table(d, "observed", "Orders, and the error of the finest cell", BR_FOR_PEOPLE);
    for (enum br_part part = 0; part < BR_PARTS; part++) {
        for (int i = 0; br_part_is_shown(r, part) && i < BR_AXES; i++) {
            const struct br_observed_order *observed = &r->observed[part][i];
            if (!observed->asked)
                continue;
            br_put_row(d);
            BR_PUT(d, br_text(br_part_names[part]), .heading = "part");
            BR_PUT(d, br_text(i == BR_AXIS_SPACE ? "order in h" : "order in k"), .heading = "what");
            BR_PUT(d, br_text(br_order_text(&observed->order, text, sizeof text)),
                   .heading = "observed [95 %]");
            BR_PUT(d,
                   br_text(br_range_text(observed->theory.order, observed->theory.highest, text,
                                         sizeof text)),
                   .heading = "theory");
            BR_PUT(d, br_text(observed->remark), .heading = "verdict", .flags = BR_WRAP);
            BR_PUT(d, br_text(*observed->by ? observed->by : NULL), .heading = "measured from",
                   .flags = BR_WRAP);
        }
        if (part != BR_PART_TOTAL)
            continue;
        br_put_row(d);
        BR_PUT(d, br_text(br_part_names[part]), .heading = "part");
        BR_PUT(d, br_text("error"), .heading = "what");
        BR_PUT(d, br_number(error), .heading = "observed [95 %]");
        if (isfinite(error))
            br_put_shown(d, "%.3e %s", error, fitted->norm->unit);
        BR_PUT(d, br_number(relative), .heading = "verdict");
        if (isfinite(relative))
            br_put_shown(d, "%.1e of the solution", relative);
        BR_PUT(d, br_count(finest->at.n), .heading = "measured from");
        br_put_shown(d, "finest cell, n = %zu, k = %g s", finest->at.n, br_step_of(fitted, finest));
    }

    put_grids(d, r);
    br_put_study_fits(d, r);

    br_put_table(d, "tips", "Tip at t = T", r->printed ? BR_FILES_ONLY : 0);
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        if (!r->study->scene->field[kind].modelled)
            continue;
        br_put_row(d);
        BR_PUT(d, br_text(br_field_names[kind]), .key = "field");
        BR_PUT(d, br_number(finest->tip[kind]), .key = "finest", .heading = "finest cell",
               .unit = "m", .format = "%.10g");
        BR_PUT(d, br_number(fitted->reference_tip[kind]), .key = "reference", .unit = "m",
               .format = "%.10g");
    }

    br_put_triangles(d, r);

    put_cells(d, r);
    br_put_study_notes(d, r);

    const char *line = fitted->events, *remark = r->study->scene->remark;
    if ((line && *line) || remark)
        br_put_section(d, "Events");
    while (line && *line) {
        const size_t length = strcspn(line, "\n");
        br_put_note(d, "%.*s", (int)length, line);
        line += length + (line[length] == '\n');
    }
    if (remark)
        br_put_note(d, "%s", remark);

    br_put_study_facts(d, r);
}
