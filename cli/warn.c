/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/warn.h"

#include <stdio.h>
#include <string.h>

#include "study/scene/quote.h"

/* Each alone, so that it can be copied. */
static void print_lines(const char *remedy)
{
    for (const char *line = remedy; *line; line += strcspn(line, "\n"), line += *line == '\n')
        fprintf(stderr, "    %.*s\n", (int)strcspn(line, "\n"), line);
}

static void print(const char *scene, const struct br_warnings *warnings)
{
    for (size_t i = 0; i < warnings->count; i++) {
        const struct br_warning *w = &warnings->list[i];
        fputs("beamrate: warning: ", stderr);
        br_quote(stderr, &br_for_text, scene);
        fputs(*scene ? ": " : "", stderr);
        br_quote(stderr, &br_for_text, w->text);
        if (w->more)
            fprintf(stderr, " (and so %zu more of these marches)", w->more);
        fprintf(stderr, "%s\n", w->remedy[0] ? "; remedy:" : "");
        print_lines(w->remedy);
    }
}

void br_print_warnings(const struct br_warnings *warnings)
{
    print("", warnings);
}

void br_print_warnings_of(const char *scene, const struct br_warnings *warnings)
{
    print(scene, warnings);
}
