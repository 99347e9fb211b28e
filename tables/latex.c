/* SPDX-License-Identifier: GPL-3.0-or-later */
/* LaTeX tables to \input; they need the booktabs package. */
#include <math.h>
#include <string.h>

#include "study/scene/quote.h"
#include "tables/emitter.h"
#include "tables/sentences.h"

static void comment(void *self, const char *text)
{
    FILE *out = self;
    br_quote(out, &br_for_latex, text);
    fputs("\\par\n", out);
}

/* 7.794e-04 as $7.794\cdot10^{-4}$ */
static void print_number(FILE *out, double value)
{
    if (!isfinite(value)) {
        fputs("--", out);
        return;
    }
    char text[32];
    snprintf(text, sizeof text, "%.3e", value);
    char *e = strchr(text, 'e');
    *e = '\0';
    fprintf(out, "$%s\\cdot10^{%ld}$", text, strtol(e + 1, NULL, 10));
}

static void open_table(FILE *out, const struct br_report *r, const char *title, const char *last)
{
    const struct br_study *s = r->study;
    fprintf(out, "\n\\begin{table}\n\\centering\n\\caption{");
    br_quote(out, &br_for_latex, r->caption);
    fprintf(out, ": %s}\n\\begin{tabular}{r", title);
    for (size_t j = 0; j < s->k_count; j++)
        fputc('r', out);
    fprintf(out, "%s}\n\\toprule\n$n$", *last ? "l" : "");
    for (size_t j = 0; j < s->k_count; j++)
        fprintf(out, " & $k=%g$", br_time_step(s->scene, s->steps[j]));
    fprintf(out, "%s \\\\\n\\midrule\n", last);
}

static void close_table(FILE *out)
{
    fprintf(out, "\\bottomrule\n\\end{tabular}\n\\end{table}\n");
}

static const char *mark(enum br_flag flag)
{
    static const char *const marks[] = {"", "$^{\\mathrm{R}}$", "$^{\\mathrm{F}}$",
                                        "$^{\\mathrm{X}}$", "$^{\\mathrm{U}}$"};
    return marks[flag];
}

static void print_errors(FILE *out, const struct br_report *r, enum br_part part)
{
    const struct br_study *s = br_report_fitted(r);
    char title[64], buffer[64];
    snprintf(title, sizeof title, "%s error, %s", br_part_names[part], r->study->norm->unit_tex);
    open_table(out, r, title, " & slope in $k$");
    for (size_t i = 0; i < s->n_count; i++) {
        fprintf(out, "%zu", s->n[i]);
        for (size_t j = 0; j < s->k_count; j++) {
            const struct br_cell *c = br_study_cell(s, i, j);
            fputs(" & ", out);
            print_number(out, c->error[part]);
            fputs(mark(c->flag[part]), out);
        }
        fprintf(out, " & %s \\\\\n",
                br_order_text(&r->fits[part].by_n[i].order, buffer, sizeof buffer));
    }
    fprintf(out, "\\midrule\nslope in $h$");
    for (size_t j = 0; j < s->k_count; j++)
        fprintf(out, " & %s", br_order_text(&r->fits[part].by_k[j].order, buffer, sizeof buffer));
    fprintf(out, " & \\\\\n");
    close_table(out);
}

/* The total against the reference that is not fitted. */
static void print_beside(FILE *out, const struct br_report *r)
{
    const struct br_study *s = r->study;
    char title[96];
    snprintf(title, sizeof title, "total error, %s, against %s", s->norm->unit_tex, s->judge->name);
    open_table(out, r, title, "");
    for (size_t i = 0; i < s->n_count; i++) {
        fprintf(out, "%zu", s->n[i]);
        for (size_t j = 0; j < s->k_count; j++) {
            const struct br_cell *c = br_study_cell(s, i, j);
            fputs(" & ", out);
            print_number(out, c->error[BR_PART_TOTAL]);
            fputs(mark(c->flag[BR_PART_TOTAL]), out);
        }
        fprintf(out, " \\\\\n");
    }
    close_table(out);
}

static void print_printed(FILE *out, const struct br_report *r)
{
    const struct br_study *s = r->study;
    open_table(out, r, "as printed, and ours over printed", "");
    for (size_t i = 0; i < s->n_count; i++) {
        fprintf(out, "%zu", s->n[i]);
        for (size_t j = 0; j < s->k_count; j++) {
            fputs(" & ", out);
            print_number(out, r->printed[i * s->k_count + j]);
        }
        fprintf(out, " \\\\\n");
        for (size_t j = 0; j < s->k_count; j++) {
            const double ratio = br_report_ratio(r, i * s->k_count + j);
            if (isfinite(ratio))
                fprintf(out, " & (%.3f)", ratio);
            else
                fprintf(out, " & --");
        }
        fprintf(out, " \\\\\n");
    }
    close_table(out);
}

static enum br_status emit(FILE *out, const struct br_report *r, const struct br_provenance *p,
                           struct br_error *err)
{
    (void)err;
    const struct br_writer w = {comment, out};
    fprintf(out, "%% beamrate %s (%s), %s; needs \\usepackage{booktabs}\n", p->version, p->commit,
            p->date);
    for (int part = 0; part < BR_PARTS; part++)
        if (br_part_shown(r, (enum br_part)part))
            print_errors(out, r, (enum br_part)part);
    if (r->exact)
        print_beside(out, r);
    if (r->printed)
        print_printed(out, r);
    fputc('\n', out);
    br_say_method(r, &w);
    br_say_flags(r, &w);
    br_say_events(r, &w);
    br_say_orders(r, &w);
    br_say_printed(r, &w);
    return BR_OK;
}

const struct br_emitter br_emit_latex = {"latex", ".tex", "LaTeX with booktabs", emit};
