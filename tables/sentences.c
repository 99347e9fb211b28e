/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tables/sentences.h"

#include <stdarg.h>
#include <string.h>

#include "study/scene/method_fields.h"
#include "study/scene/quote.h"

enum { PARAGRAPH = 4096, WIDTH = 100 };

void br_print_wrapped(void *self, const char *paragraph)
{
    FILE *out = self;
    char visible[2 * PARAGRAPH],
        *text = br_quoted(visible, sizeof visible, &br_for_text, paragraph);
    size_t column = 0;
    while (*text) {
        const size_t word = strcspn(text, " ");
        if (column && column + 1 + word > WIDTH) {
            fprintf(out, "\n  ");
            column = 2;
        } else if (column) {
            fputc(' ', out);
            column++;
        }
        fprintf(out, "%.*s", (int)word, text);
        column += word;
        text += word;
        text += strspn(text, " ");
    }
    fputc('\n', out);
}

int br_width_of(const char *text)
{
    char visible[PARAGRAPH];
    int width = 0;
    for (const char *c = br_quoted(visible, sizeof visible, &br_for_text, text); *c; c++)
        width += ((unsigned char)*c & 0xc0) != 0x80;
    return width;
}

void br_print_caption(FILE *out, const char *caption)
{
    br_quote(out, &br_for_text, caption);
    fputc('\n', out);
    for (int i = br_width_of(caption); i > 0; i--)
        fputc('=', out);
    fputc('\n', out);
}

void br_say(const struct br_writer *w, const char *format, ...)
{
    char text[PARAGRAPH];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    w->paragraph(w->self, text);
}
