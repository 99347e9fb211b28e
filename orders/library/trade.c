/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The library's trade: errors over costs of several programs. */
#include "orders/library/library.h"

static enum br_status read_source(struct beamrate_trade *t, const struct beamrate_table *from,
                                  const char *cost, struct br_error *err)
{
    struct br_orders_request q;
    struct br_work_source *s = &t->source[t->count];
    if (br_request_of(from, &q, err))
        return err->status;
    t->count++;
    s->path = from->name ? from->name : "table";
    const bool study = br_is_study_file(from->text);
    bool failed = study && br_orders_request_read(s->path, from->text, &q, err);
    q.cost = cost;
    failed = failed || br_orders_read(&q, &s->numbers, err);
    if (study)
        br_orders_request_clear(&q);
    return failed ? err->status : BR_OK;
}

static enum br_status read_all(struct beamrate_trade *t, const struct beamrate_table *sources,
                               size_t count, const char *cost, struct br_error *err)
{
    if (!sources || !count)
        return br_fail(err, BR_BAD_INPUT, "sources: found none, expected at least one");
    if (!(t->source = br_allocate(count, sizeof *t->source)))
        return br_no_memory(err, "the programs");
    for (size_t i = 0; i < count; i++)
        if (read_source(t, &sources[i], cost, err))
            return err->status;
    br_work_name_sources(t->source, count);
    return br_work_find(t->source, count, cost, &t->works, &t->quantities, err);
}

enum beamrate_status beamrate_trade_read(struct beamrate_trade **trade,
                                         const struct beamrate_table *sources, size_t count,
                                         const char *cost, struct beamrate_error *err)
{
    MAKE_HANDLE(trade, BR_HANDLE_TRADE, beamrate_trade_free,
                read_all(*trade, sources, count, cost ? cost : "", &call.err));
}

void beamrate_trade_free(struct beamrate_trade *t)
{
    if (!br_handle_is(t, BR_HANDLE_TRADE))
        return;
    br_work_sources_clear(t->source, t->count);
    br_work_clear(t->works, t->quantities);
    free(t->report);
    free(t);
}
