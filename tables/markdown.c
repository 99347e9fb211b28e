/* SPDX-License-Identifier: GPL-3.0-or-later */
/* GitHub-flavoured Markdown. */
#include <math.h>
#include <string.h>

#include "study/scene/quote.h"
#include "tables/emitter.h"
#include "tables/sentences.h"

/* Paragraphs are set as list items. */
static void item(void *self, const char *text)
{
    FILE *out = self;
    fputs("- ", out);
    br_quote(out, &br_for_markdown, text);
    fputc('\n', out);
}

static void heading(FILE *out, const struct br_report *r, const char *title, const char *last)
{
    const struct br_study *s = r->study;
    fprintf(out, "\n| %s |", title);
    for (size_t j = 0; j < s->k_count; j++)
        fprintf(out, " k = %g s |", br_time_step(s->scene, s->steps[j]));
    fprintf(out, "%s\n|---|", last);
    for (size_t j = 0; j < s->k_count; j++)
        fprintf(out, "---:|");
    fprintf(out, "%s\n", *last ? "---|" : "");
}

static void number(FILE *out, double value, const char *format)
{
    if (isfinite(value))
        fprintf(out, format, value);
    else
        fprintf(out, "-");
}

static void print_errors(FILE *out, const struct br_report *r, enum br_part part)
{
    const struct br_study *s = br_report_fitted(r);
    char buffer[64];
    heading(out, r, br_part_names[part], " slope in k |");
    for (size_t i = 0; i < s->n_count; i++) {
        fprintf(out, "| n = %zu |", s->n[i]);
        for (size_t j = 0; j < s->k_count; j++) {
            const struct br_cell *c = br_study_cell(s, i, j);
            fputc(' ', out);
            number(out, c->error[part], "%.3e");
            if (c->flag[part])
                fprintf(out, " (%s)", br_flag_name(c->flag[part]));
            fputs(" |", out);
        }
        fprintf(out, " %s |\n", br_order_text(&r->fits[part].by_n[i].order, buffer, sizeof buffer));
    }
    fprintf(out, "| slope in h |");
    for (size_t j = 0; j < s->k_count; j++)
        fprintf(out, " %s |", br_order_text(&r->fits[part].by_k[j].order, buffer, sizeof buffer));
    fprintf(out, " |\n");
}

/* The total against the reference that is not fitted. */
static void print_beside(FILE *out, const struct br_report *r)
{
    const struct br_study *s = r->study;
    char title[64];
    snprintf(title, sizeof title, "total against %s", s->judge->name);
    heading(out, r, title, "");
    for (size_t i = 0; i < s->n_count; i++) {
        fprintf(out, "| n = %zu |", s->n[i]);
        for (size_t j = 0; j < s->k_count; j++) {
            const struct br_cell *c = br_study_cell(s, i, j);
            fputc(' ', out);
            number(out, c->error[BR_PART_TOTAL], "%.3e");
            if (c->flag[BR_PART_TOTAL])
                fprintf(out, " (%s)", br_flag_name(c->flag[BR_PART_TOTAL]));
            fputs(" |", out);
        }
        fputc('\n', out);
    }
}

static void print_printed(FILE *out, const struct br_report *r)
{
    const struct br_study *s = r->study;
    heading(out, r, "printed (ours/printed)", "");
    for (size_t i = 0; i < s->n_count; i++) {
        fprintf(out, "| n = %zu |", s->n[i]);
        for (size_t j = 0; j < s->k_count; j++) {
            fputc(' ', out);
            number(out, r->printed[i * s->k_count + j], "%.3e");
            fputs(" (", out);
            number(out, br_report_ratio(r, i * s->k_count + j), "%.3f");
            fputs(") |", out);
        }
        fputc('\n', out);
    }
}

static enum br_status emit(FILE *out, const struct br_report *r, const struct br_provenance *p,
                           struct br_error *err)
{
    (void)err;
    const struct br_writer w = {item, out};
    fputs("# ", out);
    br_quote(out, &br_for_markdown, r->caption);
    fputs("\n\n", out);
    br_say_method(r, &w);
    for (int part = 0; part < BR_PARTS; part++)
        if (br_part_shown(r, (enum br_part)part))
            print_errors(out, r, (enum br_part)part);
    if (r->exact)
        print_beside(out, r);
    if (r->printed)
        print_printed(out, r);
    fprintf(out, "\n## Which cells count\n\n");
    br_say_flags(r, &w);
    if (br_has_events(r))
        fprintf(out, "\n## Events\n\n");
    br_say_events(r, &w);
    fprintf(out, "\n## Observed orders\n\n");
    br_say_orders(r, &w);
    if (r->printed)
        fprintf(out, "\n## Against the printed table\n\n");
    br_say_printed(r, &w);
    fprintf(out, "\nbeamrate %s (%s), %s\n", p->version, p->commit, p->date);
    return BR_OK;
}

const struct br_emitter br_emit_markdown = {"markdown", ".md", "GitHub-flavoured Markdown", emit};
