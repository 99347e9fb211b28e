/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/warn.h"

#include <stdio.h>

void br_print_warnings(const struct br_warnings *warnings)
{
    for (size_t i = 0; i < warnings->count; i++) {
        const struct br_warning *w = &warnings->list[i];
        fprintf(stderr, "beamrate: warning: %s", w->text);
        if (w->more)
            fprintf(stderr, " (and so %zu more of these marches)", w->more);
        fprintf(stderr, "%s%s\n", w->remedy[0] ? "; remedy: " : "", w->remedy);
    }
}
