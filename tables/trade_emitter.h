/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Trades in the formats of tables/sheet.h; CSV and JSON have what a trade has to tell programs.
 * Nothing is computed here. */
#ifndef BR_TABLES_TRADE_EMITTER_H
#define BR_TABLES_TRADE_EMITTER_H

#include "tables/trade_page.h"

/* One scene, and the summary of several. Fail with BR_NO_MEMORY only: write errors stay in `out`.
 */
enum br_status br_trade_emit(const struct br_page_emitter *format, FILE *out,
                             const struct br_trade_page *page, struct br_error *err);
enum br_status br_trade_summarise(const struct br_page_emitter *format, FILE *out,
                                  const struct br_trade_page *page, size_t pages,
                                  struct br_error *err);

/* For a terminal: without the table of all trials. */
enum br_status br_trade_show(FILE *out, const struct br_trade_page *page, struct br_error *err);

/* One line a trial, or the cheapest ones of every target; everything. */
enum br_status br_trade_csv(FILE *out, const struct br_trade_page *page, struct br_error *err);
enum br_status br_trade_csv_summary(FILE *out, const struct br_trade_page *page, size_t pages,
                                    struct br_error *err);
enum br_status br_trade_json(FILE *out, const struct br_trade_page *page, struct br_error *err);
enum br_status br_trade_json_summary(FILE *out, const struct br_trade_page *page, size_t pages,
                                     struct br_error *err);

#endif
