/* SPDX-License-Identifier: GPL-3.0-or-later */
/* LaTeX tables to \input; they need the booktabs package. */
#include "study/scene/quote.h"
#include "tables/split_emitter.h"

static void paragraph(void *self, const char *text)
{
    FILE *out = self;
    br_quote(out, &br_for_latex, text);
    fputs("\\par\n", out);
}

static void cell(FILE *out, const char *text)
{
    fputs(" & ", out);
    br_quote(out, &br_for_latex, text);
}

static void print_line(FILE *out, const struct br_split *s, size_t norm, size_t i)
{
    const struct br_split_line line = br_split_line(s, norm, i);
    char text[32];
    if (i == s->shares)
        fputs("\\midrule\n", out);
    br_quote(out, &br_for_latex, line.name);
    if (line.none) {
        fputs(" & \\multicolumn{6}{l}{none: ", out);
        br_quote(out, &br_for_latex, line.none);
        fputs("} \\\\\n", out);
        return;
    }
    for (int part = 0; part < BR_PARTS; part++)
        cell(out, br_split_error_text(&line, (enum br_part)part, text));
    cell(out, i > s->shares ? "" : br_split_share_text(&line, text));
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        cell(out, br_split_tip_text(&line, (enum br_field_kind)kind, text));
    fputs(" \\\\\n", out);
}

static void print_table(FILE *out, const struct br_split *s, size_t norm)
{
    char text[256];
    fputs("\n\\begin{table}\n\\centering\n\\caption{", out);
    br_quote(out, &br_for_latex, s->scene->title);
    fputs(": where the error comes from (", out);
    br_quote(out, &br_for_latex, s->norm[norm]->name);
    fprintf(out, ", %s); ", s->norm[norm]->unit_tex);
    br_quote(out, &br_for_latex, br_split_run_text(s, text, sizeof text));
    fputs("}\n\\begin{tabular}{lrrrrrr}\n\\toprule\npart & total & axial & bending & of the sum & "
          "tip axial & tip bending \\\\\n\\midrule\n",
          out);
    for (size_t i = 0; i < br_split_lines(s); i++)
        print_line(out, s, norm, i);
    fputs("\\bottomrule\n\\end{tabular}\n\\end{table}\n", out);
}

static enum br_status emit(FILE *out, const struct br_split_page *page, struct br_error *err)
{
    (void)err;
    const struct br_provenance *p = page->provenance;
    const struct br_writer w = {paragraph, out};
    fprintf(out, "%% beamrate %s (%s), %s; needs \\usepackage{booktabs}\n", p->version, p->commit,
            p->date);
    br_split_say_chain(page->split, &w);
    for (size_t i = 0; i < page->count; i++) {
        for (size_t m = 0; m < page->split[i].norms; m++)
            print_table(out, &page->split[i], m);
        br_split_say_run(&page->split[i], &w);
    }
    return BR_OK;
}

const struct br_split_emitter br_split_latex = {"latex", ".tex", "LaTeX with booktabs", emit};
