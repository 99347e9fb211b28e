/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tables/markdown_text.h"

#include <string.h>

void br_print_markdown(FILE *out, const char *text)
{
    for (; *text; text++) {
        if (strchr("*_|`<\\", *text))
            fputc('\\', out);
        fputc(*text, out);
    }
}
