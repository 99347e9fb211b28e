/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tables/trade_emitter.h"

enum br_status br_trade_emit(const struct br_page_emitter *format, FILE *out,
                             const struct br_trade_page *page, struct br_error *err)
{
    struct br_page sheets;
    if (format == &br_page_csv)
        return br_trade_csv(out, page, err);
    if (format == &br_page_json)
        return br_trade_json(out, page, err);
    br_trade_fill(page, &sheets);
    return format->emit(out, &sheets, err);
}

enum br_status br_trade_summarise(const struct br_page_emitter *format, FILE *out,
                                  const struct br_trade_page *page, size_t pages,
                                  struct br_error *err)
{
    struct br_page sheets;
    if (format == &br_page_csv)
        return br_trade_csv_summary(out, page, pages, err);
    if (format == &br_page_json)
        return br_trade_json_summary(out, page, pages, err);
    br_trade_fill_summary(page, pages, &sheets);
    return format->emit(out, &sheets, err);
}

enum br_status br_trade_show(FILE *out, const struct br_trade_page *page, struct br_error *err)
{
    struct br_page sheets;
    br_trade_fill(page, &sheets);
    return br_page_show(out, &sheets, err);
}
