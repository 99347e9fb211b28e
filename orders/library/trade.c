/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The library's trade: errors over costs of several programs. */
#include "orders/library/library.h"

static enum br_status read_source(struct beamrate_trade *t, const struct beamrate_table *from,
                                  const char *cost, struct br_error *err)
{
    struct br_orders_request q;
    struct br_numbers *numbers = &t->numbers[t->count];
    if (br_request_of(from, &q, err))
        return err->status;
    t->source[t->count] =
        (struct br_work_source){.path = from->name ? from->name : "table", .numbers = numbers};
    t->count++;
    if (!br_is_study_file(from->text)) {
        q.cost = cost;
        return br_orders_read(&q, numbers, err);
    }
    br_orders_request_read(t->source[t->count - 1].path, from->text, &q, err);
    q.cost = cost;
    if (!err->status)
        br_orders_read(&q, numbers, err);
    br_orders_request_clear(&q);
    return err->status;
}

static enum br_status read_all(struct beamrate_trade *t, const struct beamrate_table *sources,
                               size_t count, const char *cost, struct br_error *err)
{
    if (!sources || !count)
        return br_fail(err, BR_BAD_INPUT, "sources: found none, expected at least one");
    t->numbers = br_allocate(count, sizeof *t->numbers);
    t->source = br_allocate(count, sizeof *t->source);
    if (!t->numbers || !t->source)
        return br_no_memory(err, "the programs");
    err->status = BR_OK;
    for (size_t i = 0; i < count; i++)
        if (read_source(t, &sources[i], cost ? cost : "", err))
            return err->status;
    br_work_name_sources(t->source, count);
    return br_work_find(t->source, count, cost ? cost : "", &t->works, &t->quantities, err);
}

enum beamrate_status beamrate_trade_read(struct beamrate_trade **trade,
                                         const struct beamrate_table *sources, size_t count,
                                         const char *cost, struct beamrate_error *err)
{
    MAKE_HANDLE(trade, BR_HANDLE_TRADE, beamrate_trade_free,
                read_all(*trade, sources, count, cost, &call.err));
}

void beamrate_trade_free(struct beamrate_trade *t)
{
    if (!br_handle_is(t, BR_HANDLE_TRADE))
        return;
    for (size_t i = 0; i < t->count; i++)
        br_numbers_clear(&t->numbers[i]);
    br_work_clear(t->works, t->quantities);
    free(t->numbers);
    free(t->source);
    free(t->report);
    free(t);
}
