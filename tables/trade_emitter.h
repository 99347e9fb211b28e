/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Trades as text: one const record a format, named as those of tables/emitter.h. Emitters compute
 * nothing. */
#ifndef BR_TRADE_EMITTER_H
#define BR_TRADE_EMITTER_H

#include "tables/trade_page.h"

struct br_trade_emitter {
    const char *name;      /* as on the command line */
    const char *extension; /* of its file, with the dot */
    /* Writes one page, and the summary of several. Fail with BR_NO_MEMORY only: write errors stay
     * in `out`. */
    enum br_status (*emit)(FILE *out, const struct br_trade_page *page, struct br_error *err);
    enum br_status (*summarise)(FILE *out, const struct br_trade_page *page, size_t pages,
                                struct br_error *err);
};

/* NULL-terminated; the first is the terminal's. */
extern const struct br_trade_emitter *const br_trade_emitters[];
const struct br_trade_emitter *br_trade_emitter_find(const char *name);

/* For a terminal: without the sheet of all trials. */
void br_trade_show(FILE *out, const struct br_trade_page *page);

#endif
