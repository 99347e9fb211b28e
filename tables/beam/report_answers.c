/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What was found in a study, and what was measured, in sentences. */
#include <math.h>

#include "reference/exact/exact.h"
#include "solver/scene.h"
#include "study/fit/report.h"
#include "study/scene/method_fields.h"
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
        if (!isnan(t->order))
            br_put_more(d, "; theory %s", br_range_text(t->order, t->highest, text, sizeof text));
        if (isnan(t->order) && isnan(observed->order.value))
            br_put_more(d, "; theory: none");
        if (*t->reason && !(isnan(t->order) && isfinite(observed->order.value)))
            br_put_more(d, " (%s)", t->reason);
        if (isfinite(observed->order.value) && *observed->by)
            br_put_more(d, "; measured from %s", observed->by);
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

/* ---- notes and facts ---- */

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
