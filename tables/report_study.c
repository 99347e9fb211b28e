/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <string.h>

#include "reference/exact/exact.h"
#include "solver/scene.h"
#include "study/fit/report.h"
#include "study/scene/method_fields.h"
#include "tables/report_parts.h"

static double step_of(const struct br_study *s, const struct br_cell *c)
{
    return br_time_step(s->scene, c->at.steps);
}

/* An error over the norm of the solution, or of its field; not finite where the norm is not
 * known. */
static double relative_of(const struct br_study *s, const struct br_cell *c, enum br_part part)
{
    const double size =
        part == BR_PART_TOTAL ? s->reference_scale : s->reference_size[part - BR_PART_AXIAL];
    return c->error[part] / size;
}

/* ---- the answer ---- */

/* Puts the name of a reference, its own error and its round-off. own: NaN where it is not known. */
static void say_reference(struct br_document *d, const struct br_study *s, double own)
{
    const double floor = s->judged_by.round_off * s->reference_scale;
    const double stated =
        br_norm_of_constant(s->norm, s->scene, s->judged_by.own_error, BR_PART_TOTAL);
    br_put_more(d, "Reference: %s %s, ", s->judge->name, s->judge->nests ? "run" : "solution");
    if (!isfinite(own))
        br_put_more(d, "accuracy not known, since the joint fit does not describe the errors");
    else if (s->auditor)
        br_put_more(d, "accurate to %.1e (measured against the %s solution)", own,
                    s->auditor->name);
    else
        br_put_more(d, "accurate to %.1e (by %s)", own,
                    isfinite(stated) ? "its own estimate" : "the joint fit");
    if (floor > 0)
        br_put_more(d, ", round-off about %.0e", floor);
    br_put_more(d, "; ");
}

/* Puts the number of cells that are left out of fits, and why. */
static void say_flags(struct br_document *d, const struct br_study *s)
{
    static const char *const why[BR_CELL_FLAGS] = {
        [BR_FLAG_REFERENCE] = "too near the reference's own error (R)",
        [BR_FLAG_ROUND_OFF] = "too near the predicted round-off (F)",
        [BR_FLAG_FAILED] = "failed (X)",
        [BR_FLAG_UNSTABLE] = "beyond the stability limit of the lagged contact (U: the tip may "
                             "chatter; use a smaller k or --contact implicit)",
        [BR_FLAG_STALLED] = "no smaller than on coarser grids (S)",
        [BR_FLAG_COARSE] = "not asymptotic (C)",
        [BR_FLAG_OUTLIER] = "far from the neighbours (O)",
    };
    const size_t cells = s->n_count * s->k_count;
    size_t count[BR_CELL_FLAGS] = {0};
    for (size_t i = 0; i < cells; i++)
        count[s->cell[i].flag[BR_PART_TOTAL]]++;
    if (count[BR_FLAG_NONE] == cells) {
        if (cells == 1)
            br_put_more(d, "its one error is used.");
        else
            br_put_more(d, "all %zu errors are used.", cells);
        return;
    }
    br_put_more(d, "%zu of %zu errors are left out of fits:", cells - count[BR_FLAG_NONE], cells);
    const char *separator = " ";
    for (enum br_flag flag = BR_FLAG_NONE + 1; flag < BR_CELL_FLAGS; flag++)
        if (count[flag]) {
            br_put_more(d, "%s%zu %s", separator, count[flag], why[flag]);
            separator = "; ";
        }
    br_put_more(d, ".");
}

static void answer_printed(struct br_document *d, const struct br_report *r)
{
    const struct br_study *s = r->study;
    size_t differ = 0, compared = 0, farthest = 0, pairs = 0;
    double least = INFINITY, most = 0, distance = -1;
    for (size_t i = 0; r->printed && i < s->n_count * s->k_count; i++) {
        const double ratio = br_report_ratio(r, i);
        if (!isfinite(ratio))
            continue;
        compared++;
        least = fmin(least, ratio);
        most = fmax(most, ratio);
        differ += !(ratio >= 0.95 && ratio <= 1.05);
        farthest = fabs(log(ratio)) > distance ? i : farthest;
        distance = fmax(distance, fabs(log(ratio)));
    }
    if (!compared)
        return;
    for (size_t i = 0; i < r->triangles; i++)
        pairs += r->triangle[i].contradiction;
    if (!differ)
        br_put_answer(d, "Our errors and the printed ones agree within 5 %% in all %zu cells.",
                      compared);
    else
        br_put_answer(
            d,
            "Our errors (reference: %s) DIFFER from the printed ones by more than 5 %% in %zu of "
            "%zu cells: ours over printed is %.2g to %.2g. The largest deviation is at n = %zu, k "
            "= %g s: ours %.3e, printed %.3e.",
            s->judge->name, differ, compared, least, most, s->cell[farthest].at.n,
            step_of(s, &s->cell[farthest]), s->cell[farthest].error[BR_PART_TOTAL],
            r->printed[farthest]);
    if (differ && pairs)
        br_put_answer(
            d,
            "No choice of reference explains this: at least %zu pair%s of printed errors violate%s "
            "the triangle inequality.",
            pairs, pairs == 1 ? "" : "s", pairs == 1 ? "s" : "");
}

static void put_answers(struct br_document *d, const struct br_report *r)
{
    const struct br_study *s = br_report_fitted(r);
    char text[64];
    for (int i = 0; i < BR_AXES; i++) {
        const struct br_seen_order *seen = &r->seen[BR_PART_TOTAL][i];
        if (!seen->asked)
            continue;
        const struct br_theory *t = &seen->theory;
        br_put_answer(d, "Order in %s: ", br_axis_letters[i]);
        if (isfinite(seen->order.value))
            br_put_more(d, "%s, ", br_order_text(&seen->order, text, sizeof text));
        br_put_more(d, "%s", seen->remark);
        if (!isnan(t->order))
            br_put_more(d, "; theory %s", br_theory_text(t->order, t->highest, text, sizeof text));
        if (isnan(t->order) && isnan(seen->order.value))
            br_put_more(d, "; theory: none");
        if (*t->reason && !(isnan(t->order) && isfinite(seen->order.value)))
            br_put_more(d, " (%s)", t->reason);
        if (isfinite(seen->order.value) && *seen->by)
            br_put_more(d, "; measured from %s", seen->by);
        br_put_more(d, ".");
    }

    const struct br_cell *c = &s->cell[s->n_count * s->k_count - 1];
    const double error = c->error[BR_PART_TOTAL], relative = relative_of(s, c, BR_PART_TOTAL);
    br_put_answer(d, "Error of the finest cell (n = %zu, k = %g s): ", c->at.n, step_of(s, c));
    if (isfinite(error))
        br_put_more(d, "%.3e %s", error, s->norm->unit);
    else
        br_put_more(d, "none, the march failed");
    if (isfinite(relative))
        br_put_more(d, ", relative %.2e", relative);
    br_put_more(d, ".");

    br_put_answer(d, "%s", "");
    say_reference(d, s, r->fits[BR_PART_TOTAL].reference_error);
    say_flags(d, s);
    for (int i = 0; i < (r->exact ? 2 : 1); i++) {
        const struct br_study *of = i ? r->study : s;
        if (of->judged_by.unstable)
            br_put_answer(d,
                          "The %s reference is beyond the stability limit of the lagged contact: "
                          "do not trust it.",
                          of->judge->name);
    }

    const double k = br_time_step(s->scene, s->steps[s->k_count - 1]);
    const struct br_judge_report *by = &s->judged_by;
    if (by->shortest.length > 0 && by->shortest.length < k)
        br_put_answer(d,
                      "In the exact solution the %s%s for %.2g s from t = %.4g s on. Steps of %g s "
                      "do not resolve this.",
                      by->shortest.phase >= BR_STICK ? "tip " : "",
                      br_phase_text((enum br_phase)by->shortest.phase), by->shortest.length,
                      by->shortest.from, k);

    answer_printed(d, r);
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
    BR_PUT(d, br_text(s->judge->name), .key = "reference");
    BR_PUT(d, br_text(br_part_names[part]), .key = "part");
    BR_PUT(d, br_count(c->at.n), .key = "n");
    BR_PUT(d, br_number(br_mesh_size(s->scene, c->at.n)), .key = "h", .unit = "m");
    BR_PUT(d, br_count(c->at.steps), .key = "steps");
    BR_PUT(d, br_number(step_of(s, c)), .key = "k", .unit = "s");
    BR_PUT(d, br_number(c->error[part]), .key = "error", .unit = unit);
    BR_PUT(d, br_number(relative_of(s, c, part)), .key = "relative");
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

/* ---- fits ---- */

/* People do not see the numbers of a fit that does not describe the errors. */
static void put_fits(struct br_document *d, const struct br_report *r)
{
    static const char *const kinds[] = {"space and time", "time", "space"};
    static const char *const orders[] = {"p", "q"}, *const headings[] = {"p [95 %]", "q [95 %]"},
                             *const constants[] = {"C_h", "C_k"};
    bool shown = false;
    for (enum br_part part = 0; part < BR_PARTS; part++)
        shown |=
            br_part_is_shown(r, part) && br_joint_describes(&r->fits[part].joint) && !r->printed;
    br_put_table(d, "fits", "Joint fit of the signed errors C_h h^p and C_k k^q",
                 shown ? 0 : BR_FILES_ONLY);
    for (enum br_part part = 0; part < BR_PARTS; part++) {
        const struct br_joint_fit *j = &r->fits[part].joint;
        const bool claims = br_joint_describes(j);
        char text[64];
        if (!br_part_is_shown(r, part))
            continue;
        br_put_row(d);
        BR_PUT(d, br_text(br_part_names[part]), .key = "part");
        BR_PUT(d, br_text(kinds[j->kind]), .key = "model", .heading = "error in",
               .flags = BR_FILES_ONLY);
        if (!j->converged)
            br_put_shown(d, "none");
        for (int a = 0; a < BR_AXES; a++) {
            const bool sure = claims && br_order_determined(&j->order[a]);
            BR_PUT_ESTIMATE(d, &j->order[a],
                            sure ? br_order_text(&j->order[a], text, sizeof text)
                                 : "not determined",
                            .key = orders[a], .heading = headings[a]);
            BR_PUT_ESTIMATE(d, &j->c[a], claims ? NULL : "-", .key = constants[a],
                            .format = "%.3g");
        }
        snprintf(text, sizeof text, claims ? "%.3f [%.3f, %.3f]" : "-", j->r.value, j->r.low,
                 j->r.high);
        BR_PUT_ESTIMATE(d, &j->r, text, .key = "r", .heading = "r [95 %]");
        BR_PUT(d, br_number(j->misfit), .key = "misfit", .format = "%.2g");
        BR_PUT(d, br_number(j->worst), .key = "worst", .format = "%.2g", .flags = BR_FILES_ONLY);
        BR_PUT(d, br_number(j->r_squared), .key = "r_squared", .heading = "R^2", .format = "%.6f",
               .flags = BR_FILES_ONLY);
        BR_PUT(d, br_count(j->points), .key = "points", .heading = "cells");
        br_hide(d, "degrees_of_freedom", NULL, br_count(j->freedom));
        BR_PUT(d, br_truth(j->converged), .key = "converged", .flags = BR_FILES_ONLY);
        BR_PUT(d, br_truth(claims), .key = "describes_the_errors", .heading = "usable",
               .flags = BR_FILES_ONLY);
        br_hide(d, "reference_error", r->study->norm->unit,
                br_number(r->fits[part].reference_error));
    }
}

/* ---- notes and facts ---- */

/* Puts the reference that judges a study. */
static void put_judge(struct br_document *d, const char *label, const struct br_study *s)
{
    char method[BR_METHOD_TEXT];
    if (s->judge->nests)
        br_put_note(d, "%s %s, %s: N = %zu, K = %g s; %s.", label, s->judge->name, s->judge->title,
                    s->reference.n, br_reference_step(s),
                    br_method_text(&(struct br_meshes){s->scene, &s->reference.n, 1},
                                   &s->reference_method, method));
    else
        br_put_note(d, "%s %s, %s.", label, s->judge->name, s->judge->title);
}

static void put_notes(struct br_document *d, const struct br_report *r)
{
    const struct br_study *s = r->study;
    char method[BR_METHOD_TEXT];
    br_put_section(d, "What was measured");
    br_put_note(d, "%s", s->norm->title);
    br_put_note(d, "Theory: %s", s->norm->theory);
    br_put_note(
        d, "Cells: %s.",
        br_method_text(&(struct br_meshes){s->scene, s->n, s->n_count}, &s->method, method));
    put_judge(d, "Reference:", br_report_fitted(r));
    if (r->exact) { /* the study that is not fitted */
        put_judge(d, "Second reference:", s);
        br_put_note(d, "%s", "");
        say_reference(d, s, s->reference_error[BR_PART_TOTAL]);
        say_flags(d, s);
    }
    br_put_note(d,
                "Too near: below %g times the own error of the reference (R) or the predicted "
                "round-off (F).",
                br_flag_margin);
    br_put_note(d, "Joint fit with 95 %% intervals: e^2 = a^2 + 2 r a b + b^2, "
                   "a = C_h (h^p - h_ref^p), b = C_k (k^q - k_ref^q).");
    for (size_t i = 0; i < s->n_count * s->k_count; i++)
        if (s->cell[i].failure.status)
            br_put_note(d, "Failed: n = %zu, k = %g s: %s.", s->cell[i].at.n,
                        step_of(s, &s->cell[i]), s->cell[i].failure.message);
}

/* Facts for programs. */
static void put_reference(struct br_document *d, const char *key, const struct br_study *s)
{
    static const char *const own[] = {"own_error", "own_axial_error", "own_bending_error"};
    const char *unit = s->norm->unit;
    char method[64];
    br_hide_fact(d, br_text(s->judge->name), NULL, "%s.kind", key);
    br_hide_fact(d, br_text(s->judge->title), NULL, "%s.title", key);
    if (s->judge->nests) {
        br_hide_fact(d, br_count(s->reference.n), NULL, "%s.at.n", key);
        br_hide_fact(d, br_number(br_reference_mesh(s)), "m", "%s.at.h", key);
        br_hide_fact(d, br_count(s->reference.steps), NULL, "%s.at.steps", key);
        br_hide_fact(d, br_number(br_reference_step(s)), "s", "%s.at.k", key);
        snprintf(method, sizeof method, "%s.method", key);
        br_put_method_facts(d, method, &s->reference_method,
                            &(struct br_meshes){s->scene, &s->reference.n, 1});
    }
    for (enum br_part part = 0; part < BR_PARTS; part++)
        br_hide_fact(
            d, br_number(br_norm_of_constant(s->norm, s->scene, s->judged_by.own_error, part)),
            unit, "%s.%s", key, own[part]);
    br_hide_fact(d, br_number(s->reference_error[BR_PART_TOTAL]), unit, "%s.audited_error", key);
    br_hide_fact(d, br_number(s->reference_scale), unit, "%s.scale", key);
    br_hide_fact(d, br_number(s->judged_by.round_off), NULL, "%s.round_off", key);
    br_hide_fact(d, br_number(s->judged_by.seconds), "s", "%s.seconds", key);
}

static void put_facts(struct br_document *d, const struct br_report *r)
{
    const struct br_study *s = r->study, *fitted = br_report_fitted(r);
    const struct br_cell *finest = &fitted->cell[fitted->n_count * fitted->k_count - 1];
    br_hide_fact(d, br_text(s->scene->name), NULL, "scene.name");
    br_hide_fact(d, br_text(s->norm->name), NULL, "norm.name");
    br_hide_fact(d, br_text(s->norm->unit), NULL, "norm.unit");
    br_hide_fact(d, br_text(s->norm->title), NULL, "norm.title");
    br_put_method_facts(d, "method", &s->method, &(struct br_meshes){s->scene, s->n, s->n_count});
    put_reference(d, "reference", s);
    if (r->exact)
        put_reference(d, "exact_reference", r->exact);
    for (enum br_part part = 0; part < BR_PARTS; part++)
        for (int i = 0; i < BR_AXES; i++) {
            const struct br_seen_order *seen = &r->seen[part][i];
            const char *name = br_part_names[part], *in = br_axis_letters[i];
            if (!seen->asked)
                continue;
            br_hide_fact(d, br_number(seen->order.value), NULL, "orders.%s.%s.order", name, in);
            br_hide_fact(d, br_number(seen->order.low), NULL, "orders.%s.%s.low", name, in);
            br_hide_fact(d, br_number(seen->order.high), NULL, "orders.%s.%s.high", name, in);
            br_hide_fact(d, br_number(seen->theory.order), NULL, "orders.%s.%s.theory", name, in);
            br_hide_fact(d, br_number(seen->theory.highest), NULL, "orders.%s.%s.theory_highest",
                         name, in);
            br_hide_fact(d, br_text(seen->theory.reason), NULL, "orders.%s.%s.theory_reason", name,
                         in);
            br_hide_fact(d, br_text(seen->by), NULL, "orders.%s.%s.by", name, in);
            br_hide_fact(d, br_text(seen->remark), NULL, "orders.%s.%s.remark", name, in);
        }
    br_hide_fact(d, br_count(finest->at.n), NULL, "finest.n");
    br_hide_fact(d, br_number(step_of(fitted, finest)), "s", "finest.k");
    br_hide_fact(d, br_number(finest->error[BR_PART_TOTAL]), fitted->norm->unit, "finest.error");
    br_hide_fact(d, br_number(relative_of(fitted, finest, BR_PART_TOTAL)), NULL, "finest.relative");
    br_hide_fact(d, br_text(fitted->judge->name), NULL, "fitted");
    br_hide_fact(d, br_number(r->wall_seconds), "s", "wall_seconds");
}

void br_report_study(const struct br_report *r, struct br_document *d)
{
    br_document_begin(d, r->name, "beamrate study", 2, r->caption);
    put_answers(d, r);

    /* The orders of the answers, and those of each component. */
    const struct br_study *fitted = br_report_fitted(r);
    const struct br_cell *finest = &fitted->cell[fitted->n_count * fitted->k_count - 1];
    const double error = finest->error[BR_PART_TOTAL];
    const double relative = relative_of(fitted, finest, BR_PART_TOTAL);
    char text[64];
    br_put_table(d, "seen", "Orders, and the error of the finest cell", BR_FOR_PEOPLE);
    for (enum br_part part = 0; part < BR_PARTS; part++) {
        for (int i = 0; br_part_is_shown(r, part) && i < BR_AXES; i++) {
            const struct br_seen_order *seen = &r->seen[part][i];
            if (!seen->asked)
                continue;
            br_put_row(d);
            BR_PUT(d, br_text(br_part_names[part]), .heading = "part");
            BR_PUT(d, br_text(i == BR_AXIS_SPACE ? "order in h" : "order in k"), .heading = "what");
            BR_PUT(d, br_text(br_order_text(&seen->order, text, sizeof text)),
                   .heading = "observed [95 %]");
            BR_PUT(d,
                   br_text(
                       br_theory_text(seen->theory.order, seen->theory.highest, text, sizeof text)),
                   .heading = "theory");
            BR_PUT(d, br_text(seen->remark), .heading = "verdict", .flags = BR_WRAP);
            BR_PUT(d, br_text(*seen->by ? seen->by : NULL), .heading = "measured from",
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
        br_put_shown(d, "finest cell, n = %zu, k = %g s", finest->at.n, step_of(fitted, finest));
    }

    br_put_grids(d, r);
    put_fits(d, r);

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
    put_notes(d, r);

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

    put_facts(d, r);
}
