/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/formats.h"

#include <stdio.h>
#include <string.h>

#include "cli/names.h"
#include "tables/document.h"

enum br_status br_formats_check(const char *list, struct br_error *err)
{
    char name[64];
    for (const char *rest = list; rest && *rest;) {
        const size_t length = strcspn(rest, ",");
        snprintf(name, sizeof name, "%.*s", (int)(length < 63 ? length : 63), rest);
        if (!br_document_format_find(name))
            return br_fail(err, BR_BAD_INPUT, "--format: found '%s', expected one of: %s", name,
                           br_format_names());
        rest += length + (rest[length] == ',');
    }
    return BR_OK;
}

bool br_format_wanted(const char *list, const char *name)
{
    const size_t length = strlen(name);
    for (const char *rest = list; rest && *rest; rest += strcspn(rest, ","), rest += *rest == ',')
        if (strcspn(rest, ",") == length && strncmp(rest, name, length) == 0)
            return true;
    return !list;
}
