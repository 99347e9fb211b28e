/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the JSON formats share; each returns a new reference, or NULL without memory. */
#ifndef BR_TABLES_JSON_VALUE_H
#define BR_TABLES_JSON_VALUE_H

#include <jansson.h>

#include "study/fit/fit.h"
#include "tables/document.h"

/* jansson forgets a member that it has no memory for. From the first call on this remembers: false
 * where no memory of jansson's has been refused. Call it before any document is made, and before
 * one is put in place. */
bool br_json_lacked_memory(void);

/* The document in an open file, or NULL, why being said. jansson's parser does not survive a failed
 * allocation: it loses characters, and frees what it must not. So the program ends there, with exit
 * code 3 and its own words; results that were not yet in place stay whole for the next command. */
json_t *br_json_read(int file, json_error_t *why);

json_t *br_json_number(double value);     /* what is not finite is null */
json_t *br_json_string(const char *text); /* NULL is null; what is not UTF-8 gets '?' */

#endif
