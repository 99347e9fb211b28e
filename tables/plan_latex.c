/* SPDX-License-Identifier: GPL-3.0-or-later */
/* LaTeX tables to \input; they need the booktabs package. */
#include "tables/latex_text.h"
#include "tables/plan_emitter.h"

static void paragraph(void *self, const char *text)
{
    FILE *out = self;
    br_print_latex(out, text);
    fputs("\\par\n", out);
}

static void print_sheet(FILE *out, const struct br_plan_page *page, const struct br_plan_sheet *s)
{
    char text[BR_PLAN_CELL];
    bool number;
    fputs("\n\\begin{table}\n\\centering\n\\caption{", out);
    br_print_latex(out, page->caption);
    fputs(": ", out);
    br_print_latex(out, s->title);
    fputs("}\n\\begin{tabular}{", out);
    for (size_t c = 0; c < s->columns; c++) {
        s->heading(c, &number);
        fputc(number ? 'r' : 'l', out);
    }
    fputs("}\n\\toprule\n", out);
    for (size_t c = 0; c < s->columns; c++) {
        br_print_latex(out, s->heading(c, &number));
        fputs(c + 1 < s->columns ? " & " : " \\\\\n\\midrule\n", out);
    }
    for (size_t r = 0; r < s->rows(page); r++)
        for (size_t c = 0; c < s->columns; c++) {
            s->cell(page, r, c, text);
            br_print_latex(out, text);
            fputs(c + 1 < s->columns ? " & " : " \\\\\n", out);
        }
    fputs("\\bottomrule\n\\end{tabular}\n\\end{table}\n", out);
}

static enum br_status emit(FILE *out, const struct br_plan_page *page, struct br_error *err)
{
    (void)err;
    const struct br_provenance *p = page->provenance;
    const struct br_writer w = {paragraph, out};
    fprintf(out, "%% beamrate %s (%s), %s; needs \\usepackage{booktabs}\n", p->version, p->commit,
            p->date);
    br_say_plan(page, &w);
    for (const struct br_plan_sheet *const *s = br_plan_sheets; *s; s++)
        print_sheet(out, page, *s);
    br_say_plan_notes(page, &w);
    return BR_OK;
}

const struct br_plan_emitter br_plan_latex = {"latex", ".tex", emit};
