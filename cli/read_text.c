/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/read_text.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

enum br_status br_read_text(const char *path, char **text, struct br_error *err)
{
    FILE *file = fopen(path, "rb");
    if (!file)
        return br_fail(err, BR_BAD_INPUT, "%s: %s", path, strerror(errno));
    const size_t most = 1u << 20;
    *text = br_allocate(most, 1);
    if (*text)
        (*text)[fread(*text, 1, most - 1, file)] = '\0';
    fclose(file);
    return *text ? BR_OK : br_no_memory(err, "the scene");
}
