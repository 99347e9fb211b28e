/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The report of the library's orders; it stands here since study/ knows no reports. */
#include <math.h>

#include "base/text.h"
#include "orders/library/library.h"
#include "tables/reports.h"

static enum br_status write_report(const struct br_orders *orders, char **text,
                                   struct br_error *err)
{
    static const struct br_estimate not_timed[BR_AXES] = {{NAN, NAN, NAN}, {NAN, NAN, NAN}};
    struct br_document d = {0};
    size_t size;
    FILE *out = br_text_open(text, &size);
    if (!out)
        return br_no_memory(err, "the report");
    br_report_orders(orders, not_timed, "Orders of numbers", &d);
    enum br_status status = br_document_print(out, &br_document_json, &d, NULL, err);
    if (fclose(out) != 0 && !status)
        status = br_no_memory(err, "the report");
    br_document_clear(&d);
    return status;
}

enum beamrate_status beamrate_orders_report(struct beamrate_orders *orders, const char **json,
                                            struct beamrate_error *err)
{
    struct br_call call;
    br_call_begin(&call);
    enum br_status status = br_handle_check(orders, &call.err);
    if (!status && !json)
        status = br_fail(&call.err, BR_BAD_INPUT, "json: found NULL, expected a place for a text");
    if (!status) {
        free(orders->report);
        orders->report = NULL;
        status = write_report(&orders->orders, &orders->report, &call.err);
    }
    if (json)
        *json = status ? NULL : orders->report;
    return br_call_end(&call, status, err);
}
