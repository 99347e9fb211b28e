/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tables/sentences.h"

#include "study/scene/quote.h"

int br_width_of(const char *text)
{
    char visible[4096];
    int width = 0;
    for (const char *c = br_quoted(visible, sizeof visible, &br_for_text, text); *c; c++)
        width += ((unsigned char)*c & 0xc0) != 0x80;
    return width;
}
