/* SPDX-License-Identifier: GPL-3.0-or-later */
/* LaTeX to \input; it needs the booktabs and longtable packages. */
#include <ctype.h>
#include <string.h>

#include "study/scene/quote.h"
#include "tables/sheet.h"

static void paragraph(void *self, const char *text)
{
    FILE *out = self;
    br_quote(out, &br_for_latex, text);
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
static void print_cell(FILE *out, char *text)
{
    char *e = exponent_of(text);
    if (!e) {
        br_quote(out, &br_for_latex, text);
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

static void print_head(FILE *out, const struct br_table *t, const char *caption)
{
    bool number;
    fputs("\n\\begin{longtable}{", out);
    for (size_t c = 0; c < t->columns; c++) {
        t->heading(t->self, c, &number);
        fputc(number ? 'r' : 'l', out);
    }
    fputs("}\n\\caption{", out);
    br_quote(out, &br_for_latex, caption);
    fputs(": ", out);
    br_quote(out, &br_for_latex, t->title);
    fputs("}\\\\\n\\toprule\n", out);
    for (size_t c = 0; c < t->columns; c++) {
        char text[BR_CELL];
        snprintf(text, sizeof text, "%s", t->heading(t->self, c, &number));
        fputs(c ? " & " : "", out);
        print_cell(out, text);
    }
    fputs(" \\\\\n\\midrule\n\\endhead\n", out);
}

static void print_table(FILE *out, const struct br_table *t, const char *caption)
{
    char text[BR_CELL];
    print_head(out, t, caption);
    for (size_t r = 0; r < t->rows; r++) {
        for (size_t c = 0; c < t->columns; c++) {
            t->cell(t->self, r, c, text);
            fputs(c ? " & " : "", out);
            print_cell(out, text);
        }
        fputs(" \\\\\n", out);
    }
    fputs("\\bottomrule\n\\end{longtable}\n", out);
}

static enum br_status emit(FILE *out, const struct br_page *page, struct br_error *err)
{
    (void)err;
    const struct br_provenance *p = page->provenance;
    const struct br_writer w = {paragraph, out};
    fprintf(out, "%% beamrate %s (%s), %s; needs \\usepackage{booktabs,longtable}\n", p->version,
            p->commit, p->date);
    if (page->say)
        page->say(page->self, &w);
    for (size_t i = 0; i < page->tables; i++)
        print_table(out, &page->table[i], page->caption);
    if (page->say_notes) {
        fputc('\n', out);
        page->say_notes(page->self, &w);
    }
    return BR_OK;
}

const struct br_page_emitter br_page_latex = {"latex", ".tex", emit};
