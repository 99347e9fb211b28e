/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The report of the library's orders; it stands here since study/ knows no reports. */
#include <math.h>

#include "base/text.h"
#include "orders/library/library.h"
#include "tables/reports.h"

/* Prints a document as JSON, and clears it. *text (out): owned. */
static enum br_status write_json(struct br_document *d, char **text, struct br_error *err)
{
    size_t size;
    free(*text);
    *text = NULL;
    FILE *out = br_text_open(text, &size);
    enum br_status status = out ? br_document_print(out, &br_document_json, d, NULL, err)
                                : br_no_memory(err, "the report");
    if (out && fclose(out) != 0 && !status)
        status = br_no_memory(err, "the report");
    br_document_clear(d);
    return status;
}

enum beamrate_status beamrate_orders_report(struct beamrate_orders *orders, const char **json,
                                            struct beamrate_error *err)
{
    static const struct br_estimate not_timed[BR_AXES] = {{NAN, NAN, NAN}, {NAN, NAN, NAN}};
    struct br_document d = {0};
    struct br_call call;
    br_call_begin(&call);
    enum br_status status = br_handle_check(orders, &call.err);
    if (!status && !json)
        status = br_fail(&call.err, BR_BAD_INPUT, "json: found NULL, expected a place for a text");
    if (!status) {
        br_report_orders(&orders->orders, not_timed, "Orders of numbers", &d);
        status = write_json(&d, &orders->report, &call.err);
    }
    if (json)
        *json = status ? NULL : orders->report;
    return br_call_end(&call, status, err);
}

enum beamrate_status beamrate_trade_report(struct beamrate_trade *trade, const char **json,
                                           struct beamrate_error *err)
{
    struct br_document d = {0};
    struct br_call call;
    br_call_begin(&call);
    enum br_status status = BR_OK;
    if (!br_handle_is(trade, BR_HANDLE_TRADE) || !json)
        status = br_fail(&call.err, BR_BAD_INPUT, "found no trade or NULL, expected both");
    else {
        br_report_work(trade->works, trade->quantities, NULL, &d);
        status = write_json(&d, &trade->report, &call.err);
    }
    if (json)
        *json = status ? NULL : trade->report;
    return br_call_end(&call, status, err);
}
