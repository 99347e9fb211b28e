/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What was found in a study: the sentences; the joint fits, and contradictions in the printed
 * table; what was measured; and all its facts, for programs. */
#include <math.h>
#include <string.h>

#include "reference/exact/exact.h"
#include "solver/scene.h"
#include "study/fit/report.h"
#include "tables/beam/report_parts.h"

/* ---- the answer ---- */

/* Puts the name of a reference, its own error and its round-off. own: NaN where it is not known. */
static void say_reference(struct br_document *d, const struct br_study *s, double own)
{
    const double floor = s->reference_report.round_off * s->reference_scale;
    const double stated =
        br_norm_of_constant(s->norm, s->scene, s->reference_report.own_error, BR_PART_TOTAL);
    br_put_more(d, "Reference: %s %s, ", s->reference_kind->name,
                s->reference_kind->nests ? "run" : "solution");
    if (!isfinite(own))
        br_put_more(d, "accuracy not known, since the joint fit does not describe the errors");
    else if (s->reference_check)
        br_put_more(d, "accurate to %.1e (measured against the %s solution)", own,
                    s->reference_check->name);
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
        [BR_FLAG_BY_HAND] = "left out by hand (H)",
        [BR_FLAG_ABSENT] = "not in the study",
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
    br_put_list(d, " ", "; ");
    for (enum br_flag flag = BR_FLAG_NONE + 1; flag < BR_CELL_FLAGS; flag++)
        if (count[flag])
            br_put_item(d, "%zu %s", count[flag], why[flag]);
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
            s->reference_kind->name, differ, compared, least, most, s->cell[farthest].at.n,
            br_step_of(s, &s->cell[farthest]), s->cell[farthest].error[BR_PART_TOTAL],
            r->printed[farthest]);
    if (differ && pairs)
        br_put_answer(
            d,
            "No reference solution could produce the printed errors: at least %zu pair%s of them violate%s "
            "the triangle inequality.",
            pairs, pairs == 1 ? "" : "s", pairs == 1 ? "s" : "");
}

void br_put_study_answers(struct br_document *d, const struct br_report *r)
{
    const struct br_study *s = r->fitted;
    char text[64];
    for (int i = 0; i < BR_AXES; i++) {
        const struct br_observed_order *observed = &r->observed[BR_PART_TOTAL][i];
        if (!observed->asked)
            continue;
        const struct br_theory *t = &observed->theory;
        br_put_answer(d, "Order in %s: ", br_axis_letters[i]);
        if (isfinite(observed->order.value))
            br_put_more(d, "%s, ", br_order_text(&observed->order, text, sizeof text));
        br_put_more(d, "%s", observed->remark);
        /* "agrees with theory (2)"; behind a remark with rates, "; theory 2" */
        const bool named = !isnan(t->order) && strstr(observed->remark, "theory") &&
                           !strchr(observed->remark, ':');
        if (!isnan(t->order))
            br_put_more(d, named ? " (%s" : "; theory %s",
                        br_range_text(t->order, t->highest, text, sizeof text));
        if (isnan(t->order) && isnan(observed->order.value))
            br_put_more(d, "; theory: none");
        if (*t->reason && !(isnan(t->order) && isfinite(observed->order.value)))
            br_put_more(d, named ? "; %s" : " (%s)", t->reason);
        br_put_more(d, "%s", named ? ")" : "");
        if (isfinite(observed->order.value) && *observed->by)
            br_put_more(d, "; from %s", observed->by);
        br_put_more(d, ".");
    }

    const struct br_cell *c = br_finest_of(s);
    const double error = c->error[BR_PART_TOTAL], relative = br_relative_of(s, c, BR_PART_TOTAL);
    br_put_answer(d, "Error of the finest cell (n = %zu, k = %g s): ", c->at.n, br_step_of(s, c));
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
        if (of->reference_report.unstable)
            br_put_answer(d,
                          "The %s reference is beyond the stability limit of the lagged contact: "
                          "do not trust it.",
                          of->reference_kind->name);
    }

    const double k = br_time_step(s->scene, s->steps[s->k_count - 1]);
    const struct br_reference_report *by = &s->reference_report;
    if (by->shortest.length > 0 && by->shortest.length < k)
        br_put_answer(d,
                      "In the exact solution the %s%s for %.2g s from t = %.4g s on. Steps of %g s "
                      "do not resolve this.",
                      by->shortest.phase >= BR_STICK ? "tip " : "",
                      br_phase_text((enum br_phase)by->shortest.phase), by->shortest.length,
                      by->shortest.from, k);

    answer_printed(d, r);
}

/* ---- fits ---- */

/* People do not see the numbers of a fit that does not describe the errors, nor an order of it that
 * is not the answer: no page has two answers to one question. */
void br_put_study_fits(struct br_document *d, const struct br_report *r)
{
    static const char *const kinds[] = {"space and time", "time", "space"};
    bool shown = false;
    for (enum br_part part = 0; part < BR_PARTS; part++)
        shown |=
            br_part_is_shown(r, part) && br_joint_describes(&r->fits[part].joint) && !r->printed;
    br_put_table(d, "fits", "Joint fit of the signed errors C_h h^p and C_k k^q",
                 shown ? 0 : BR_FILES_ONLY);
    for (enum br_part part = 0; part < BR_PARTS; part++) {
        const struct br_joint_fit *j = &r->fits[part].joint;
        const bool claims = br_joint_describes(j);
        if (!br_part_is_shown(r, part))
            continue;
        br_put_row(d);
        BR_PUT(d, br_text(br_part_names[part]), .key = "part");
        BR_PUT(d, br_text(kinds[j->kind]), .key = "model", .heading = "error in",
               .flags = BR_FILES_ONLY);
        if (!j->converged)
            br_put_shown(d, "none");
        for (int a = 0; a < BR_AXES; a++) {
            const bool sure = r->observed[part][a].joint; /* else another order is the answer */
            BR_PUT_ESTIMATE(d, a ? "q_" : "p_", &j->order[a],
                            sure     ? br_order_shown(d, &j->order[a])
                            : claims ? "not used"
                                     : "-",
                            .key = a ? "q" : "p", .heading = a ? "q [95 %]" : "p [95 %]");
            BR_PUT_ESTIMATE(d, a ? "C_k_" : "C_h_", &j->c[a], claims ? NULL : "-",
                            .key = a ? "C_k" : "C_h", .format = "%.3g");
        }
        BR_PUT_ESTIMATE(d, "r_", &j->r, claims ? br_interval_shown(d, &j->r) : "-", .key = "r",
                        .heading = "r [95 %]");
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

/* ---- contradictions ---- */

static void put_triangle(struct br_document *d, const struct br_scene *scene,
                         const struct br_triangle *t)
{
    br_put_row(d);
    BR_PUT(d, br_count(t->a.n), .key = "a_n", .heading = "n");
    BR_PUT(d, br_number(br_time_step(scene, t->a.steps)), .key = "a_k", .heading = "k",
           .unit = "s");
    BR_PUT(d, br_count(t->b.n), .key = "b_n", .heading = "and n");
    BR_PUT(d, br_number(br_time_step(scene, t->b.steps)), .key = "b_k", .heading = "k",
           .unit = "s");
    BR_PUT(d, br_number(t->printed_a), .key = "printed_a", .heading = "printed", .format = "%.3e");
    BR_PUT(d, br_number(t->printed_b), .key = "printed_b", .heading = "and", .format = "%.3e");
    BR_PUT(d, br_number(t->least), .key = "least", .heading = "need at least", .format = "%.2e");
    BR_PUT(d, br_number(t->most), .key = "most", .heading = "at most", .format = "%.2e");
    BR_PUT(d, br_number(t->distance), .key = "distance", .heading = "are apart", .format = "%.2e");
    BR_PUT(d, br_truth(t->contradiction), .key = "contradiction");
}

void br_put_triangles(struct br_document *d, const struct br_report *r)
{
    if (!r->printed)
        return;
    br_put_table(d, "triangles", "Pairs of printed cells (triangle inequality), m^(3/2)",
                 BR_FILES_ONLY);
    put_triangle(d, r->study->scene, &(struct br_triangle){0});
    br_put_no_row(d);
    for (size_t i = 0; i < r->triangles; i++)
        put_triangle(d, r->study->scene, &r->triangle[i]);
    br_put_note(d, "For every reference, the distance of two solutions is at least the difference "
                   "of their errors, and at most the sum. The last column but one is the distance "
                   "of the scheme's own solutions.");
}

/* ---- notes ---- */

/* Puts the reference of a study. */
static void put_reference_line(struct br_document *d, const char *label, const struct br_study *s)
{
    char method[BR_METHOD_TEXT];
    if (s->reference_kind->nests)
        br_put_note(d, "%s %s, %s: N = %zu, K = %g s; %s.", label, s->reference_kind->name,
                    s->reference_kind->title, s->reference.n, br_reference_step(s),
                    br_method_text(&(struct br_meshes){s->scene, &s->reference.n, 1},
                                   &s->reference_method, method));
    else
        br_put_note(d, "%s %s, %s.", label, s->reference_kind->name, s->reference_kind->title);
}

void br_put_study_notes(struct br_document *d, const struct br_report *r)
{
    const struct br_study *s = r->study;
    char method[BR_METHOD_TEXT];
    br_put_section(d, "What was measured");
    br_put_note(d, "%s", s->norm->title);
    br_put_note(d, "Theory: %s", s->norm->theory);
    br_put_note(
        d, "Cells: %s.",
        br_method_text(&(struct br_meshes){s->scene, s->n, s->n_count}, &s->method, method));
    put_reference_line(d, "Reference:", r->fitted);
    if (r->exact) { /* the study that is not fitted */
        put_reference_line(d, "Second reference:", s);
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
                        br_step_of(s, &s->cell[i]), s->cell[i].failure.message);
}

/* ---- facts, for programs ---- */

static void put_reference_facts(struct br_document *d, const char *key, const struct br_study *s)
{
    static const char *const own[] = {"own_error", "own_axial_error", "own_bending_error"};
    const char *unit = s->norm->unit;
    br_hide_fact(d, br_text(s->reference_kind->name), NULL, "%s.kind", key);
    br_hide_fact(d, br_text(s->reference_kind->title), NULL, "%s.title", key);
    if (s->reference_kind->nests) {
        br_hide_fact(d, br_count(s->reference.n), NULL, "%s.at.n", key);
        br_hide_fact(d, br_number(br_reference_mesh(s)), "m", "%s.at.h", key);
        br_hide_fact(d, br_count(s->reference.steps), NULL, "%s.at.steps", key);
        br_hide_fact(d, br_number(br_reference_step(s)), "s", "%s.at.k", key);
        br_put_method_facts(d, br_format(d, "%s.method", key), &s->reference_method,
                            &(struct br_meshes){s->scene, &s->reference.n, 1});
    }
    for (enum br_part part = 0; part < BR_PARTS; part++)
        br_hide_fact(
            d,
            br_number(br_norm_of_constant(s->norm, s->scene, s->reference_report.own_error, part)),
            unit, "%s.%s", key, own[part]);
    br_hide_fact(d, br_number(s->reference_error[BR_PART_TOTAL]), unit, "%s.measured_error", key);
    br_hide_fact(d, br_number(s->reference_scale), unit, "%s.scale", key);
    br_hide_fact(d, br_number(s->reference_report.round_off), NULL, "%s.round_off", key);
    br_hide_fact(d, br_number(s->reference_report.seconds), "s", "%s.seconds", key);
}

void br_put_study_facts(struct br_document *d, const struct br_report *r)
{
    const struct br_study *s = r->study, *fitted = r->fitted;
    const struct br_cell *finest = br_finest_of(fitted);
    br_hide_fact(d, br_text(s->scene->name), NULL, "scene.name");
    br_hide_fact(d, br_text(s->norm->name), NULL, "norm.name");
    br_hide_fact(d, br_text(s->norm->unit), NULL, "norm.unit");
    br_hide_fact(d, br_text(s->norm->title), NULL, "norm.title");
    br_put_method_facts(d, "method", &s->method, &(struct br_meshes){s->scene, s->n, s->n_count});
    put_reference_facts(d, "reference", s);
    if (r->exact)
        put_reference_facts(d, "exact_reference", r->exact);
    for (enum br_part part = 0; part < BR_PARTS; part++)
        for (int i = 0; i < BR_AXES; i++) {
            const struct br_observed_order *o = &r->observed[part][i];
            const struct {
                const char *key;
                struct br_value value;
            } facts[] = {{"order", br_number(o->order.value)},
                         {"low", br_number(o->order.low)},
                         {"high", br_number(o->order.high)},
                         {"theory", br_number(o->theory.order)},
                         {"theory_highest", br_number(o->theory.highest)},
                         {"theory_reason", br_text(o->theory.reason)},
                         {"by", br_text(o->by)},
                         {"remark", br_text(o->remark)}};
            for (size_t f = 0; f < sizeof facts / sizeof *facts && o->asked; f++)
                br_hide_fact(d, facts[f].value, NULL, "orders.%s.%s.%s", br_part_names[part],
                             br_axis_letters[i], facts[f].key);
        }
    br_hide_fact(d, br_count(finest->at.n), NULL, "finest.n");
    br_hide_fact(d, br_number(br_step_of(fitted, finest)), "s", "finest.k");
    br_hide_fact(d, br_number(finest->error[BR_PART_TOTAL]), fitted->norm->unit, "finest.error");
    br_hide_fact(d, br_number(br_relative_of(fitted, finest, BR_PART_TOTAL)), NULL,
                 "finest.relative");
    br_hide_fact(d, br_text(fitted->reference_kind->name), NULL, "fitted");
    br_hide_fact(d, br_number(r->wall_seconds), "s", "wall_seconds");
}
