/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tables/latex_text.h"

void br_print_latex(FILE *out, const char *text)
{
    for (; *text; text++)
        switch (*text) {
        case '_':
        case '%':
        case '&':
        case '#':
        case '$':
        case '{':
        case '}':
            fprintf(out, "\\%c", *text);
            break;
        case '^':
            fputs("\\^{}", out);
            break;
        case '\\':
            fputs("\\textbackslash{}", out);
            break;
        case '~':
            fputs("\\textasciitilde{}", out);
            break;
        case '|':
        case '<':
        case '>':
            fprintf(out, "$%c$", *text);
            break;
        default:
            fputc(*text, out);
        }
}
