/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cells that several reports have. */
#ifndef BR_TABLES_REPORT_CELLS_H
#define BR_TABLES_REPORT_CELLS_H

#include "orders/estimate.h"
#include "orders/expectation/setting.h"
#include "tables/document.h"

/* An estimate as br_order_text and br_interval_text have it, in the memory of the document. */
const char *br_order_shown(struct br_document *d, const struct br_estimate *estimate);
const char *br_interval_shown(struct br_document *d, const struct br_estimate *estimate);

/* An estimate, and for programs the ends of its interval under the keys PREFIXlow and PREFIXhigh.
 * shown: for people; NULL: the number. */
void br_put_estimate(struct br_document *d, const struct br_column *column, const char *prefix,
                     const struct br_estimate *estimate, const char *shown);
#define BR_PUT_ESTIMATE(d, prefix, e, shown, ...) \
    br_put_estimate((d), &(struct br_column){__VA_ARGS__}, (prefix), (e), (shown))

/* The value of a setting; nothing where it is not used. */
struct br_value br_setting_value(const struct br_setting *setting);

/* All settings of a method, for programs: facts, each a member of the object `key`, those of a
 * group members of one object in it, which is nothing where the method does not use them. */
void br_put_settings(struct br_document *d, const char *key, const struct br_settings *settings);

/* The message of a failure; nothing where there is none. */
static inline struct br_value br_failure_text(const struct br_error *failure)
{
    return br_text(failure->status ? failure->message : NULL);
}

#endif
