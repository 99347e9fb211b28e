/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tables/emitter.h"

#include <string.h>

extern const struct br_emitter br_emit_text, br_emit_csv, br_emit_markdown, br_emit_latex,
    br_emit_json;

const struct br_emitter *const br_emitters[] = {
    &br_emit_text, &br_emit_csv, &br_emit_markdown, &br_emit_latex, &br_emit_json, NULL,
};

const struct br_emitter *br_emitter_find(const char *name)
{
    for (const struct br_emitter *const *e = br_emitters; *e; e++)
        if (strcmp((*e)->name, name) == 0)
            return *e;
    return NULL;
}
