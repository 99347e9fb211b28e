/* SPDX-License-Identifier: GPL-3.0-or-later */
/* LaTeX to \input; it needs the booktabs and longtable packages, and graphicx if the pictures are
 * there as PDF. */
#include <ctype.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "tables/markup.h"

/* The e of the exponent at the end of a text like 1.2e-05; NULL: there is none. */
static char *exponent_of(char *text)
{
    char *e = strrchr(text, 'e');
    if (!e || e == text || !isdigit((unsigned char)e[-1]) || !e[1] || !strchr("+-", e[1]))
        return NULL;
    return e[2] && e[2 + strspn(e + 2, "0123456789")] == '\0' ? e : NULL;
}

/* Prints "1.2e-05" as $1.2\cdot10^{-5}$, and any other text as it is. */
static void print_number(FILE *out, const char *number)
{
    char text[BR_SHOWN];
    snprintf(text, sizeof text, "%s", number);
    char *e = strlen(number) < sizeof text ? exponent_of(text) : NULL;
    if (!e) {
        br_quote(out, &br_for_latex, number);
        return;
    }
    char *start = e;
    while (start > text && strchr("0123456789.-", start[-1]))
        start--;
    const char first = *start;
    *e = *start = '\0';
    br_quote(out, &br_for_latex, text);
    *start = first;
    fprintf(out, "$%s\\cdot10^{%ld}$", start, strtol(e + 1, NULL, 10));
}

/* Prints m^(3/2) with its exponent raised. */
static void print_unit(FILE *out, const char *unit)
{
    char base[64];
    const char *raised = strstr(unit, "^(");
    const size_t length = raised ? strspn(raised + 2, "-0123456789/") : 0;
    if (length && raised[2 + length] == ')' && raised - unit < (ptrdiff_t)sizeof base) {
        snprintf(base, sizeof base, "%.*s", (int)(raised - unit), unit);
        br_quote(out, &br_for_latex, base);
        fprintf(out, "$^{%.*s}$", (int)length, raised + 2);
        unit = raised + 2 + length + 1;
    }
    br_quote(out, &br_for_latex, unit);
}

/* The caption of the document is part of the captions of its tables. */
static void begin(const struct br_markup_page *p)
{
    const struct br_provenance *from = &p->d->provenance;
    if (from->version)
        fprintf(p->out, "%% beamrate %s (%s), %s; needs \\usepackage{booktabs,longtable}\n",
                from->version, from->commit, from->date);
}

static void open_table(const struct br_markup_page *p, const struct br_document_table *t, int level)
{
    static const char *const words[] = {"r", "l", "p{0.25\\textwidth}"};
    (void)level;
    fputs("\n\\begin{longtable}{", p->out);
    br_markup_columns(p, t, words);
    br_markup_put(p, "}\n\\caption{%s: %s}\\\\\n\\toprule\n", p->d->caption, t->title);
}

/* Includes the picture if there is a PDF, which LaTeX reads. */
static void picture(struct br_markup_page *p, const struct br_block *b)
{
    fprintf(p->out,
            "\\IfFileExists{\\detokenize{%s}.pdf}{\\begin{figure}\n\\centering\n"
            "\\includegraphics[width=\\textwidth]{\\detokenize{%s}.pdf}\n\\caption{",
            b->what.key, b->what.key);
    br_markup_put(p, "%s}\n\\end{figure}}{}\n", b->text);
}

static const struct br_markup latex = {
    .quoting = &br_for_latex,
    .of_lines = &br_for_latex,
    .heading = {"\n\\paragraph{", "}\n"},
    .answer = {"", "\\par\n"},
    .note = {"", "\\par\n"},
    .fact = {"", "\\par\n"},
    .label = "%s: ",
    .command = "%s:\n",
    .lines = {"\\begin{flushleft}\n", "\\end{flushleft}\n"},
    .line = {"\\texttt{", "}\\par\n"},
    .verdict = {"", "\\par\n"},
    .detail = "%s\\par\n",
    .mark = "$^{\\mathrm{%s}}$",
    .row = {"", " \\\\\n"},
    .rows = {" \\\\\n\\midrule\n\\endhead\n", "\\bottomrule\n\\end{longtable}\n"},
    .word = "\\textbf{%s}",
    .between = " & ",
    .open_table = open_table,
    .picture = picture,
    .begin = begin,
    .number = print_number,
    .unit = print_unit,
};

const struct br_document_format br_document_latex = {
    .name = "latex",
    .extension = ".tex",
    .title = "LaTeX with booktabs and longtable",
    .markup = &latex,
};
