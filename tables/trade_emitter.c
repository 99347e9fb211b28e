/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tables/trade_emitter.h"

#include <string.h>

extern const struct br_trade_emitter br_trade_text, br_trade_csv, br_trade_markdown, br_trade_latex,
    br_trade_json;

const struct br_trade_emitter *const br_trade_emitters[] = {
    &br_trade_text, &br_trade_csv, &br_trade_markdown, &br_trade_latex, &br_trade_json, NULL};

const struct br_trade_emitter *br_trade_emitter_find(const char *name)
{
    for (const struct br_trade_emitter *const *e = br_trade_emitters; *e; e++)
        if (strcmp((*e)->name, name) == 0)
            return *e;
    return NULL;
}
