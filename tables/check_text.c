/* SPDX-License-Identifier: GPL-3.0-or-later */
/* For a person at a terminal: a line an order, and below the reasons. */
#include <math.h>
#include <string.h>

#include "study/scene/quote.h"
#include "tables/check_emitter.h"
#include "tables/sentences.h"

/* The first column. */
static void print_scene(FILE *out, const char *name)
{
    br_quote(out, &br_for_text, name);
    fprintf(out, "%*s ", br_width_of(name) < 13 ? 13 - br_width_of(name) : 0, "");
}

static void print_case(FILE *out, const struct br_check *check, const struct br_case *c)
{
    char name[64], band[64], order[64], range[64];
    print_scene(out, check->scene->name);
    fprintf(out, "%-21s %-14s %-24s", br_case_name(c, name, sizeof name),
            br_case_band(c, band, sizeof band), br_order_text(&c->order, order, sizeof order));
    if (isfinite(c->constant))
        fprintf(out, " %9.3e", c->constant);
    else
        fprintf(out, " %9s", "-");
    fprintf(out, "  %-18s %s\n", br_case_range(c, range, sizeof range),
            br_verdict_names[c->verdict]);
}

static void print_cells(FILE *out, const struct br_scene *scene, const struct br_verify_study *v)
{
    const bool mesh = v->n[v->count - 1] != v->n[0], step = v->steps[v->count - 1] != v->steps[0];
    fprintf(out, "    n: %zu", v->n[0]);
    for (size_t i = 1; i < v->count && mesh; i++)
        fprintf(out, ", %zu", v->n[i]);
    fprintf(out, "\n    k: %.10g", br_time_step(scene, v->steps[0]));
    for (size_t i = 1; i < v->count && step; i++)
        fprintf(out, ", %.10g", br_time_step(scene, v->steps[i]));
    fprintf(out, " s\n");
}

/* A scene that does not say what to expect: the defaults, as its file would have them. */
static void print_default(FILE *out, const struct br_check *check)
{
    br_quote(out, &br_for_text, check->path);
    fputs(" has no verify part; these are the defaults, to begin one with:\nverify:\n", out);
    for (int kind = 0; kind < BR_VERIFY_KINDS; kind++) {
        const struct br_verify_study *v = &check->verify->study[kind];
        fprintf(out, "  %s:\n", br_verify_names[kind]);
        print_cells(out, check->scene, v);
        for (size_t i = 0; i < v->expectations; i++) {
            const struct br_expectation *e = &v->expectation[i];
            fprintf(out, "    %s%s%s: %g +- %g\n", e->norm->name, e->part ? " " : "",
                    e->part ? br_part_names[e->part] : "", e->order, e->tolerance);
        }
    }
    fputc('\n', out);
}

static void indented(void *self, const char *text)
{
    fputs("    ", self);
    br_quote(self, &br_for_text, text);
    fputc('\n', self);
}

static void explain(FILE *out, const struct br_check *check, const struct br_case *c)
{
    char name[64];
    if (c->verdict == BR_PASS && !c->note[0])
        return;
    fputc('\n', out);
    br_quote(out, &br_for_text, check->scene->name);
    fprintf(out, ", %s: %s\n", br_case_name(c, name, sizeof name), br_verdict_names[c->verdict]);
    if (c->verdict != BR_PASS)
        br_case_lines(c, indented, out);
    else
        indented(out, c->note);
}

static void print_comparison(FILE *out, const struct br_comparison *c)
{
    fprintf(out,
            "\nAgainst the earlier check: %zu serious, %zu warnings, %zu notes, %zu the same\n",
            c->tally[BR_SERIOUS], c->tally[BR_WARNING], c->tally[BR_NOTE], c->tally[BR_SAME]);
    for (size_t i = 0; i < c->count; i++) {
        const struct br_difference *d = &c->difference[i];
        fprintf(out, "  %-8s ", br_severity_names[d->severity]);
        br_quote(out, &br_for_text, d->subject);
        if (isfinite(d->before))
            fprintf(out, ", %.6g before", d->before);
        if (isfinite(d->now))
            fprintf(out, ", %.6g now", d->now);
        fputs(d->remark[0] ? " (" : "", out);
        br_quote(out, &br_for_text, d->remark);
        fputs(d->remark[0] ? ")\n" : "\n", out);
    }
}

static enum br_status emit(FILE *out, const struct br_check_page *page, struct br_error *err)
{
    (void)err;
    for (size_t i = 0; i < page->count; i++)
        if (page->checks[i].verify->by_default)
            print_default(out, &page->checks[i]);
    fprintf(out, "%-13s %-21s %-14s %-24s %9s  %-18s %s\n", "scene", "study, norm, part",
            "expected", "observed order", "constant", "its range", "verdict");
    for (size_t i = 0; i < page->count; i++)
        for (size_t c = 0; c < page->checks[i].count; c++)
            print_case(out, &page->checks[i], &page->checks[i].cases[c]);
    for (size_t i = 0; i < page->count; i++)
        if (page->checks[i].failure.status) {
            print_scene(out, page->checks[i].scene->name);
            br_quote(out, &br_for_text, page->checks[i].failure.message);
            fputc('\n', out);
        }
    for (size_t i = 0; i < page->skips; i++) {
        print_scene(out, page->skipped[i].scene);
        fputs("skipped: ", out);
        br_quote(out, &br_for_text, page->skipped[i].reason);
        fputc('\n', out);
    }
    for (size_t i = 0; i < page->count; i++)
        for (size_t c = 0; c < page->checks[i].count; c++)
            explain(out, &page->checks[i], &page->checks[i].cases[c]);
    if (page->comparison)
        print_comparison(out, page->comparison);
    char summary[256];
    fprintf(out, "\n%s\n", br_check_summary(page, summary, sizeof summary));
    return BR_OK;
}

const struct br_check_emitter br_check_emit_text = {
    .name = "text",
    .title = "a table for a person",
    .emit = emit,
};
