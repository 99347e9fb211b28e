/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tables/sentences.h"

#include <math.h>
#include <stdarg.h>
#include <string.h>

#include "study/scene/method_fields.h"
#include "study/scene/quote.h"

enum { PARAGRAPH = 4096, WIDTH = 100 };

void br_print_wrapped(void *self, const char *paragraph)
{
    FILE *out = self;
    char visible[2 * PARAGRAPH],
        *text = br_quoted(visible, sizeof visible, &br_for_text, paragraph);
    size_t column = 0;
    while (*text) {
        const size_t word = strcspn(text, " ");
        if (column && column + 1 + word > WIDTH) {
            fprintf(out, "\n  ");
            column = 2;
        } else if (column) {
            fputc(' ', out);
            column++;
        }
        fprintf(out, "%.*s", (int)word, text);
        column += word;
        text += word;
        text += strspn(text, " ");
    }
    fputc('\n', out);
}

int br_width_of(const char *text)
{
    char visible[PARAGRAPH];
    int width = 0;
    for (const char *c = br_quoted(visible, sizeof visible, &br_for_text, text); *c; c++)
        width += ((unsigned char)*c & 0xc0) != 0x80;
    return width;
}

void br_print_caption(FILE *out, const char *caption)
{
    br_quote(out, &br_for_text, caption);
    fputc('\n', out);
    for (int i = br_width_of(caption); i > 0; i--)
        fputc('=', out);
    fputc('\n', out);
}

void br_say(const struct br_writer *w, const char *format, ...)
{
    char text[PARAGRAPH];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    w->paragraph(w->self, text);
}

bool br_part_shown(const struct br_report *r, enum br_part part)
{
    const struct br_scene *s = r->study->scene;
    return part == BR_PART_TOTAL || (s->axial.modelled && s->bending.modelled);
}

/* "a fine run of the same scheme, n = 12800, ..." */
static void describe_reference(const struct br_study *s, char *text, size_t size)
{
    char method[BR_METHOD_TEXT];
    if (!s->judge->nests) {
        snprintf(text, size, "%s", s->judge->title);
        return;
    }
    snprintf(text, size, "%s: N = %zu, K = %g s; %s", s->judge->title, s->reference.n,
             br_reference_step(s), br_method_text(s->scene, &s->reference_method, method));
}

void br_say_method(const struct br_report *r, const struct br_writer *w)
{
    char cells[BR_METHOD_TEXT], reference[512];
    br_say(w, "%s Cells: %s.", r->study->norm->title,
           br_method_text(r->study->scene, &r->study->method, cells));
    describe_reference(br_report_fitted(r), reference, sizeof reference);
    br_say(w, "Reference: %s.", reference);
    if (!r->exact)
        return;
    describe_reference(r->study, reference, sizeof reference);
    br_say(w, "Beside it, %s: %s.", r->study->judge->name, reference);
}

/* "C_h = 0.0716, p = 2.03 [2.01, 2.04]" */
static void describe_side(const char *constant, const struct br_estimate *c, const char *exponent,
                          const struct br_estimate *order, char *text, size_t size)
{
    char buffer[64];
    if (br_order_determined(order))
        snprintf(text, size, "%s = %.3g, %s = %s", constant, c->value, exponent,
                 br_order_text(order, buffer, sizeof buffer));
    else
        snprintf(text, size, "%s is not determined by these cells (%s)", exponent,
                 br_order_text(order, buffer, sizeof buffer));
}

static void say_joint(const struct br_report *r, enum br_part part, const struct br_writer *w)
{
    const struct br_joint_fit *fit = &r->fits[part].joint;
    const char *name = br_part_names[part];
    if (!fit->converged) {
        br_say(w, "%s: no joint fit: %zu usable cells tell no order.", name, fit->points);
        return;
    }
    char space[160], time[160];
    describe_side("C_h", &fit->c_h, "p", &fit->p, space, sizeof space);
    describe_side("C_k", &fit->c_k, "q", &fit->q, time, sizeof time);
    if (!br_joint_describes(fit)) {
        br_say(w,
               "%s: the joint model does not describe these errors (misfit %.0f %%, %zu cells); no "
               "orders are claimed.",
               name, 100 * fit->misfit, fit->points);
        return;
    }
    switch (fit->kind) {
    case BR_JOINT_BOTH:
        br_say(w,
               "%s: %s; %s; r = %.3f [%.3f, %.3f]; misfit %.2g %% (worst %.2g %%), R^2 = %.6f, %zu "
               "cells.",
               name, space, time, fit->r.value, fit->r.low, fit->r.high, 100 * fit->misfit,
               100 * fit->worst, fit->r_squared, fit->points);
        return;
    case BR_JOINT_TIME:
        br_say(w,
               "%s: %s; the fit needs no space error; misfit %.2g %% (worst %.2g %%), "
               "R^2 = %.6f, %zu cells.",
               name, time, 100 * fit->misfit, 100 * fit->worst, fit->r_squared, fit->points);
        return;
    case BR_JOINT_SPACE:
        br_say(w,
               "%s: %s; the fit needs no time error; misfit %.2g %% (worst %.2g %%), "
               "R^2 = %.6f, %zu cells.",
               name, space, 100 * fit->misfit, 100 * fit->worst, fit->r_squared, fit->points);
    }
}

/* What the cells alone say of the tip, and what the reference has there. */
static void say_tip(const struct br_report *r, enum br_field_kind kind, const struct br_writer *w)
{
    const struct br_study *s = br_report_fitted(r);
    const struct br_estimate *e = &r->tip[kind];
    const double half = (e->high - e->low) / 2, there = s->reference_tip[kind];
    char reference[256] = "";
    if (s->judge != &br_judge_none)
        snprintf(reference, sizeof reference, "; the %s reference has %.10g, %s", s->judge->name,
                 there,
                 there >= e->low && there <= e->high
                     ? "within that"
                     : "OUTSIDE that: the cells are too coarse to see all of the solution, or one "
                       "of the two is wrong");
    if (isfinite(half))
        br_say(w, "From the cells alone (Richardson, h and k to 0): %s(L, T) = %.10g +- %.1e m%s.",
               kind == BR_AXIAL ? "u" : "w", e->value, half, reference);
}

void br_say_orders(const struct br_report *r, const struct br_writer *w)
{
    br_say(w, "Joint fit with 95 %% intervals: e^2 = a^2 + 2 r a b + b^2, a = C_h (h^p - h_ref^p), "
              "b = C_k (k^q - k_ref^q).");
    for (int part = 0; part < BR_PARTS; part++)
        if (br_part_shown(r, (enum br_part)part))
            say_joint(r, (enum br_part)part, w);
    br_say(w, "Theory: %s", r->study->norm->theory);
    if (r->study->scene->axial.modelled)
        say_tip(r, BR_AXIAL, w);
    if (r->study->scene->bending.modelled)
        say_tip(r, BR_BENDING, w);
}

static size_t count_flag(const struct br_study *s, enum br_flag flag)
{
    size_t count = 0;
    for (size_t i = 0; i < s->n_count * s->k_count; i++)
        count += s->cell[i].flag[BR_PART_TOTAL] == flag;
    return count;
}

static void say_failures(const struct br_study *s, const struct br_writer *w)
{
    for (size_t i = 0; i < s->n_count * s->k_count; i++) {
        const struct br_cell *c = &s->cell[i];
        if (c->failure.status)
            br_say(w, "Failed: n = %zu, k = %g s: %s.", c->at.n,
                   br_time_step(s->scene, c->at.steps), c->failure.message);
    }
}

static void say_reference(const struct br_study *s, double own, const struct br_writer *w)
{
    if (s->judge == &br_judge_none)
        return;
    const double floor = s->judged_by.round_off * s->reference_scale;
    char measured[64];
    snprintf(measured, sizeof measured, "measured against the %s solution",
             s->auditor ? s->auditor->name : "");
    const bool told =
        isfinite(br_norm_of_constant(s->norm, s->scene, s->judged_by.own_error, BR_PART_TOTAL));
    const char *by = s->auditor ? measured : told ? "by its own estimate" : "by the joint fit";
    char rounding[64] = "";
    if (floor > 0)
        snprintf(rounding, sizeof rounding, "; its round-off is about %.0e", floor);
    if (isfinite(own))
        br_say(w, "The own error of the %s reference is about %.1e, %s%s.", s->judge->name, own, by,
               rounding);
    else
        br_say(
            w,
            "The own error of the %s reference is not known: the joint fit does not describe the "
            "errors%s.",
            s->judge->name, rounding);
}

static void say_marks(const struct br_study *s, const struct br_writer *w)
{
    const size_t limited = count_flag(s, BR_FLAG_REFERENCE);
    const size_t rounded = count_flag(s, BR_FLAG_ROUND_OFF);
    if (limited)
        br_say(w,
               "R marks %zu cells whose error is below %g times the own error of the %s reference; "
               "they are left out of fits.",
               limited, br_flag_margin, s->judge->name);
    const size_t unstable = count_flag(s, BR_FLAG_UNSTABLE);
    if (unstable)
        br_say(w,
               "U marks %zu cells beyond the stability limit of the lagged contact: the tip may "
               "chatter. They are left out of fits; smaller k or --contact implicit mends it.",
               unstable);
    if (s->judged_by.unstable)
        br_say(w, "The %s reference itself is beyond that limit: do not trust it.", s->judge->name);
    if (rounded)
        br_say(w,
               "F marks %zu cells whose error is below %g times the predicted round-off (floor); "
               "they are left out of fits.",
               rounded, br_flag_margin);
}

void br_say_flags(const struct br_report *r, const struct br_writer *w)
{
    const struct br_study *fitted = br_report_fitted(r);
    say_reference(fitted, r->fits[BR_PART_TOTAL].reference_error, w);
    say_marks(fitted, w);
    if (r->exact) {
        say_reference(r->study, r->study->reference_error[BR_PART_TOTAL], w);
        say_marks(r->study, w);
    }
    say_failures(r->study, w);
}

bool br_has_events(const struct br_report *r)
{
    const char *events = br_report_fitted(r)->events;
    return (events && *events) || r->study->scene->remark;
}

void br_say_events(const struct br_report *r, const struct br_writer *w)
{
    const char *line = br_report_fitted(r)->events;
    while (line && *line) {
        const size_t length = strcspn(line, "\n");
        br_say(w, "%.*s", (int)length, line);
        line += length + (line[length] == '\n');
    }
    if (r->study->scene->remark)
        br_say(w, "%s", r->study->scene->remark);
}

static size_t contradictions(const struct br_report *r)
{
    size_t count = 0;
    for (size_t i = 0; i < r->triangles; i++)
        count += r->triangle[i].contradiction;
    return count;
}

static void say_ratio(const struct br_report *r, const struct br_writer *w)
{
    double least = INFINITY, most = 0;
    size_t differ = 0, compared = 0;
    for (size_t i = 0; i < r->study->n_count * r->study->k_count; i++) {
        const double ratio = br_report_ratio(r, i);
        if (!isfinite(ratio))
            continue;
        compared++;
        least = fmin(least, ratio);
        most = fmax(most, ratio);
        differ += !(ratio >= 0.95 && ratio <= 1.05);
    }
    if (compared == 0)
        return;
    if (differ == 0)
        br_say(w, "Ours and the printed errors agree within 5 %% in all %zu cells.", compared);
    else
        br_say(
            w,
            "Ours and the printed errors DIFFER by more than 5 %% in %zu of %zu cells; ours over "
            "printed goes from %.2g to %.2g.%s",
            differ, compared, least, most,
            contradictions(r) ? " No choice of reference can repair that:" : "");
}

static void say_triangle(const struct br_report *r, const struct br_triangle *t,
                         const struct br_writer *w)
{
    const struct br_scene *scene = r->study->scene;
    const char *needed = t->distance < t->least ? "at least" : "at most";
    const double bound = t->distance < t->least ? t->least : t->most;
    if (!t->contradiction)
        return;
    br_say(
        w,
        "Cells (n = %zu, k = %g) and (n = %zu, k = %g): the printed %.3e and %.3e, against "
        "whatever common reference, need solutions that are %s %.2e apart (triangle inequality); "
        "the scheme's are %.2e apart.",
        t->a.n, br_time_step(scene, t->a.steps), t->b.n, br_time_step(scene, t->b.steps),
        t->printed_a, t->printed_b, needed, bound, t->distance);
}

void br_say_printed(const struct br_report *r, const struct br_writer *w)
{
    if (!r->printed)
        return;
    say_ratio(r, w);
    for (size_t i = 0; i < r->triangles; i++)
        say_triangle(r, &r->triangle[i], w);
}
