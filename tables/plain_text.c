/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tables/plain_text.h"

#include <string.h>

#include <stdbool.h>

size_t br_utf8_length(const unsigned char *text)
{
    const unsigned char c = text[0];
    const size_t length = c < 0x80                ? 1
                          : c >= 0xc2 && c < 0xe0 ? 2
                          : c >= 0xe0 && c < 0xf0 ? 3
                          : c >= 0xf0 && c < 0xf5 ? 4
                                                  : 0;
    for (size_t i = 1; i < length; i++)
        if ((text[i] & 0xc0) != 0x80)
            return 0;
    const bool control = c < ' ' && c != '\t' && c != '\n';
    const bool excluded = length == 3 && ((c == 0xe0 && text[1] < 0xa0) ||  /* overlong */
                                          (c == 0xed && text[1] >= 0xa0) || /* surrogates */
                                          (c == 0xef && text[1] == 0xbf && text[2] >= 0xbe));
    const bool range =
        length == 4 && ((c == 0xf0 && text[1] < 0x90) || (c == 0xf4 && text[1] >= 0x90));
    return control || excluded || range || c == 0x7f ? 0 : length;
}

void br_print_plain(FILE *out, const char *text)
{
    const unsigned char *rest = (const unsigned char *)text;
    while (*rest) {
        const size_t length = br_utf8_length(rest);
        if (*rest < ' ')
            fputc(' ', out);
        else if (length == 0)
            fputc('?', out);
        else
            fwrite(rest, 1, length, out);
        rest += length ? length : 1;
    }
}

enum { WIDTH = 100 };

void br_print_wrapped(void *self, const char *text)
{
    FILE *out = self;
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
