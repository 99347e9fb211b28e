/* SPDX-License-Identifier: GPL-3.0-or-later */
/* JSON by jansson: memory, and texts. */
#ifndef BR_TABLES_JSON_VALUE_H
#define BR_TABLES_JSON_VALUE_H

#include <jansson.h>
#include <stdbool.h>

/* jansson silently drops a member that it has no memory for. This function notices it from its
 * first call on: false where no memory of jansson's has been refused. Call it before any document
 * is made, and before one is put in place. */
bool br_json_lacked_memory(void);

/* The document in a text, or NULL, with the reason. After a failed allocation jansson's parser
 * loses characters, and frees what it must not. So the program ends there, with a message and exit
 * code 3; results that were not yet in place stay whole for the next command. */
json_t *br_json_parse(const char *text, json_error_t *why);

/* A new reference; without memory NULL. NULL is null; bytes that are not UTF-8 become \xff. */
json_t *br_json_string(const char *text);

#endif
