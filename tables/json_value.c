/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tables/json_value.h"

#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/quote.h"
#include "base/status.h"

static atomic_bool lacked, parsing;

static void *remembering_malloc(size_t size)
{
    static const char message[] = "beamrate: out of memory for reading JSON\n";
    void *p = malloc(size);
    if (!p && atomic_load(&parsing)) {
        (void)!write(STDERR_FILENO, message, sizeof message - 1);
        _exit(br_status_exit_code(BR_NO_MEMORY));
    }
    if (!p)
        atomic_store(&lacked, true);
    return p;
}

bool br_json_lacked_memory(void)
{
    json_set_alloc_funcs(remembering_malloc, free);
    return atomic_load(&lacked);
}

json_t *br_json_parse(const char *text, json_error_t *why)
{
    br_json_lacked_memory();
    atomic_store(&parsing, true);
    json_t *json = json_loads(text, 0, why);
    atomic_store(&parsing, false);
    return json;
}

/* A file's name need not be UTF-8, which JSON must be: it is written as for a terminal. */
json_t *br_json_string(const char *text)
{
    if (!text)
        return json_null();
    if (!br_not_utf8(text))
        return json_string(text);
    const size_t size = 4 * strlen(text) + 1;
    char *visible = br_allocate(size, 1);
    json_t *o = visible ? json_string(br_quoted(visible, size, &br_for_text, text)) : NULL;
    free(visible);
    return o;
}
