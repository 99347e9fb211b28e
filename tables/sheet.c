/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tables/sheet.h"

#include <string.h>

const struct br_page_emitter *const br_page_emitters[] = {
    &br_page_text, &br_page_csv, &br_page_markdown, &br_page_latex, &br_page_json, NULL};

const struct br_page_emitter *br_page_emitter_find(const char *name)
{
    for (const struct br_page_emitter *const *e = br_page_emitters; *e; e++)
        if (strcmp((*e)->name, name) == 0)
            return *e;
    return NULL;
}
