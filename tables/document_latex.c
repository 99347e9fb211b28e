/* SPDX-License-Identifier: GPL-3.0-or-later */
/* LaTeX to \input; it needs the booktabs and longtable packages, and graphicx where the pictures
 * are there as PDF. */
#include <ctype.h>
#include <string.h>

#include "study/scene/quote.h"
#include "tables/document.h"

static void print(FILE *out, const char *text)
{
    br_quote(out, &br_for_latex, text ? text : "");
}

static void print_paragraph(FILE *out, const char *text)
{
    print(out, text);
    fputs("\\par\n", out);
}

/* The exponent's e of a text that ends with a number like 1.2e-05; NULL: it does not. */
static char *exponent_of(char *text)
{
    char *e = strrchr(text, 'e');
    if (!e || e == text || !isdigit((unsigned char)e[-1]) || !e[1] || !strchr("+-", e[1]))
        return NULL;
    return e[2] && e[2 + strspn(e + 2, "0123456789")] == '\0' ? e : NULL;
}

/* "1.2e-05" as $1.2\cdot10^{-5}$, and any other text as it is. */
static void print_number(FILE *out, const char *number)
{
    char text[BR_SHOWN];
    snprintf(text, sizeof text, "%s", number);
    char *e = strlen(number) < sizeof text ? exponent_of(text) : NULL;
    if (!e) {
        print(out, number);
        return;
    }
    char *start = e;
    while (start > text && strchr("0123456789.-", start[-1]))
        start--;
    const char first = *start;
    *e = *start = '\0';
    print(out, text);
    *start = first;
    fprintf(out, "$%s\\cdot10^{%ld}$", start, strtol(e + 1, NULL, 10));
}

static void print_value(FILE *out, const struct br_column *column,
                        const struct br_document_cell *cell)
{
    char buffer[BR_SHOWN];
    const char *text = br_document_shown(column, cell, buffer);
    if (cell->value.kind == BR_TEXT && !cell->shown)
        print(out, text);
    else
        print_number(out, text);
    if (!cell->mark)
        return;
    fputs("$^{\\mathrm{", out);
    print(out, cell->mark);
    fputs("}}$", out);
}

/* m^(3/2) with its exponent raised. */
static void print_unit(FILE *out, const char *unit)
{
    const char *raised = strstr(unit, "^("), *end = raised ? strchr(raised, ')') : NULL;
    if (end)
        fprintf(out, "%.*s$^{%.*s}$%s", (int)(raised - unit), unit, (int)(end - raised - 2),
                raised + 2, end + 1);
    else
        print(out, unit);
}

/* ---- tables ---- */

static void print_heading(FILE *out, const struct br_column *c)
{
    print_number(out, c->heading);
    if (!c->unit)
        return;
    fputs(", ", out);
    print_unit(out, c->unit);
}

static void print_head(FILE *out, const struct br_document_table *t, const char *caption)
{
    fputs("\n\\begin{longtable}{", out);
    for (size_t c = 0; c < t->columns; c++)
        if (br_document_is_seen(t, c))
            fputs(t->column[c].flags & BR_WRAP ? "p{0.25\\textwidth}"
                  : br_document_is_text(t, c)  ? "l"
                                               : "r",
                  out);
    fputs("}\n\\caption{", out);
    print(out, caption);
    fputs(": ", out);
    print(out, t->title);
    fputs("}\\\\\n\\toprule\n", out);
    const char *separator = "";
    for (size_t c = 0; c < t->columns; c++) {
        if (!br_document_is_seen(t, c))
            continue;
        fputs(separator, out);
        print_heading(out, &t->column[c]);
        separator = " & ";
    }
    fputs(" \\\\\n\\midrule\n\\endhead\n", out);
}

static void print_table(FILE *out, const struct br_document_table *t, const char *caption)
{
    if (!br_for_people(t->flags) || t->rows == 0)
        return;
    print_head(out, t, caption);
    for (size_t r = 0; r < t->rows; r++) {
        const char *separator = t->rule[r] && r > 0 ? "\\midrule\n" : "";
        for (size_t c = 0; c < t->columns; c++) {
            if (!br_document_is_seen(t, c))
                continue;
            fputs(separator, out);
            print_value(out, &t->column[c], br_document_cell_at(t, r, c));
            separator = " & ";
        }
        fputs(" \\\\\n", out);
    }
    fputs("\\bottomrule\n\\end{longtable}\n", out);
}

/* ---- the rest ---- */

static void print_fact(FILE *out, const struct br_block *b)
{
    if (!br_for_people(b->what.flags))
        return;
    print(out, b->what.heading);
    fputs(": ", out);
    print_value(out, &b->what, &b->cell);
    fputs(b->what.unit ? " " : "", out);
    print_unit(out, b->what.unit ? b->what.unit : "");
    fputs("\\par\n", out);
}

static void print_command(FILE *out, const struct br_block *b)
{
    const char *rest = b->cell.value.text;
    print(out, b->what.heading);
    fputs(":\n\\begin{flushleft}\n", out);
    while (*rest) {
        const size_t length = strcspn(rest, "\n");
        char line[2048];
        snprintf(line, sizeof line, "%.*s", (int)length, rest);
        fputs("\\texttt{", out);
        print(out, line);
        fputs("}\\par\n", out);
        rest += length + (rest[length] == '\n');
    }
    fputs("\\end{flushleft}\n", out);
}

/* Only where there is one that LaTeX reads. */
static void print_picture(FILE *out, const struct br_block *b)
{
    fprintf(out,
            "\\IfFileExists{\\detokenize{%s}.pdf}{\\begin{figure}\n\\centering\n"
            "\\includegraphics[width=\\textwidth]{\\detokenize{%s}.pdf}\n\\caption{",
            b->what.key, b->what.key);
    print(out, b->text);
    fputs("}\n\\end{figure}}{}\n", out);
}

static void print_block(FILE *out, const struct br_document *d, const struct br_block *b)
{
    switch (b->kind) {
    case BR_BLOCK_TABLE:
        print_table(out, b->table, d->caption);
        break;
    case BR_BLOCK_SECTION:
        fputs("\n\\paragraph{", out);
        print(out, b->text);
        fputs("}\n", out);
        break;
    case BR_BLOCK_NOTE:
        print_paragraph(out, b->text);
        break;
    case BR_BLOCK_FACT:
        print_fact(out, b);
        break;
    case BR_BLOCK_COMMAND:
        print_command(out, b);
        break;
    case BR_BLOCK_PICTURE:
        print_picture(out, b);
    }
}

static void print_verdict(FILE *out, const struct br_document_verdict *v)
{
    fprintf(out, "\\textbf{%s} ", br_outcome_names[v->outcome]);
    print(out, v->group);
    fputs(v->group ? ", " : "", out);
    print(out, v->name);
    fputs(v->message ? ": " : "", out);
    print_paragraph(out, v->message);
    for (size_t i = 0; i < v->details; i++)
        print_paragraph(out, v->detail[i]);
}

static enum br_status write(FILE *out, const struct br_document *d,
                            const struct br_document_table *table, struct br_error *err)
{
    (void)table, (void)err;
    const struct br_provenance *p = &d->provenance;
    if (p->version)
        fprintf(out, "%% beamrate %s (%s), %s; needs \\usepackage{booktabs,longtable}\n",
                p->version, p->commit, p->date);
    for (size_t i = 0; i < d->answers; i++)
        print_paragraph(out, d->answer[i]);
    for (size_t i = 0; i < d->blocks; i++)
        print_block(out, d, &d->block[i]);
    for (size_t i = 0; i < d->verdicts; i++)
        if (br_document_verdict_matters(&d->verdict[i]))
            print_verdict(out, &d->verdict[i]);
    return BR_OK;
}

const struct br_document_format br_document_latex = {
    .name = "latex",
    .extension = ".tex",
    .title = "LaTeX with booktabs",
    .write = write,
};
