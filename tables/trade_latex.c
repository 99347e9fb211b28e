/* SPDX-License-Identifier: GPL-3.0-or-later */
/* LaTeX to \input; it needs the booktabs and longtable packages. */
#include <ctype.h>
#include <string.h>

#include "tables/latex_text.h"
#include "tables/trade_emitter.h"

static void paragraph(void *self, const char *text)
{
    FILE *out = self;
    br_print_latex(out, text);
    fputs("\\par\n", out);
}

/* "1.2e-05" as $1.2\cdot10^{-5}$, and any other text as it is. */
static void print_cell(FILE *out, char *text)
{
    char *e = strchr(text, 'e');
    if (!e || e == text || !isdigit((unsigned char)e[-1]) || !strchr("+-", e[1])) {
        br_print_latex(out, text);
        return;
    }
    char *start = e;
    while (start > text && strchr("0123456789.-", start[-1]))
        start--;
    *e = '\0';
    fprintf(out, "%.*s$%s\\cdot10^{%ld}$", (int)(start - text), text, start,
            strtol(e + 1, NULL, 10));
}

static void print_sheet(FILE *out, const struct br_sheet_view *v, const char *caption)
{
    char text[BR_SHEET_CELL];
    bool number;
    fputs("\n\\begin{longtable}{", out);
    for (size_t c = 0; c < v->sheet->columns; c++) {
        v->sheet->heading(c, &number);
        fputc(number ? 'r' : 'l', out);
    }
    fputs("}\n\\caption{", out);
    br_print_latex(out, caption);
    fprintf(out, ": %s}\\\\\n\\toprule\n", v->sheet->title);
    for (size_t c = 0; c < v->sheet->columns; c++) {
        snprintf(text, sizeof text, "%s", v->sheet->heading(c, &number));
        fputs(c ? " & " : "", out);
        print_cell(out, text);
    }
    fputs(" \\\\\n\\midrule\n\\endhead\n", out);
    for (size_t r = 0; r < v->sheet->rows(v); r++)
        for (size_t c = 0; c < v->sheet->columns; c++) {
            v->sheet->cell(v, r, c, text, sizeof text);
            fputs(c ? " & " : "", out);
            print_cell(out, text);
            fputs(c + 1 < v->sheet->columns ? "" : " \\\\\n", out);
        }
    fputs("\\bottomrule\n\\end{longtable}\n", out);
}

static void print_head(FILE *out, const struct br_provenance *p)
{
    fprintf(out, "%% beamrate %s (%s), %s; needs \\usepackage{booktabs,longtable}\n", p->version,
            p->commit, p->date);
}

static enum br_status emit(FILE *out, const struct br_trade_page *page, struct br_error *err)
{
    (void)err;
    const struct br_writer w = {paragraph, out};
    print_head(out, page->provenance);
    for (const struct br_sheet *const *s = br_trade_sheets; *s; s++)
        print_sheet(out, &(struct br_sheet_view){*s, page, 1}, page->caption);
    fputc('\n', out);
    br_say_trade(page, &w);
    br_say_trade_ends(page, &w);
    return BR_OK;
}

static enum br_status summarise(FILE *out, const struct br_trade_page *page, size_t pages,
                                struct br_error *err)
{
    (void)err;
    print_head(out, page->provenance);
    print_sheet(out, &(struct br_sheet_view){&br_sheet_summary, page, pages}, "What a digit costs");
    return BR_OK;
}

const struct br_trade_emitter br_trade_latex = {"latex", ".tex", emit, summarise};
