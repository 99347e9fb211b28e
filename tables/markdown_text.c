/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tables/markdown_text.h"

#include <string.h>

#include "tables/plain_text.h"

void br_print_markdown(FILE *out, const char *text)
{
    for (; *text; text++) {
        if (strchr("*_|`<>[]&\\", *text))
            fputc('\\', out);
        const unsigned char *rest = (const unsigned char *)text;
        const size_t length = br_utf8_length(rest);
        if (*rest < ' ')
            fputc(' ', out);
        else if (length == 0)
            fputc('?', out);
        else
            fwrite(rest, 1, length, out);
        text += length ? length - 1 : 0;
    }
}
