/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tables in JSON, for layout.c. */
#ifndef BR_ORDERS_READING_JSON_H
#define BR_ORDERS_READING_JSON_H

#include "orders/reading/reading.h"

/* Whether a text is meant to be JSON. */
bool br_json_is_table(const char *text);

/* Takes the fields of records, columns, lines of records, the orients of pandas, or an object
 * around one of them. Fails as br_fields_read does. */
enum br_status br_json_fields(const char *text, const char *path, struct br_fields *fields,
                              struct br_error *err);

#endif
