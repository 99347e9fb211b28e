/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/suggest.h"

#include <string.h>

enum { MOST_OPTIONS = 64 };

/* The long names of a table and of those that it includes. */
static size_t collect(const struct poptOption *table, const char **names, size_t count)
{
    for (const struct poptOption *o = table; o->longName || o->shortName || o->arg; o++) {
        if ((o->argInfo & POPT_ARG_MASK) == POPT_ARG_INCLUDE_TABLE)
            count = collect(o->arg, names, count);
        else if (o->longName && count < MOST_OPTIONS)
            names[count++] = o->longName;
    }
    return count;
}

enum br_status br_bad_option(poptContext context, const struct poptOption *table, int code,
                             struct br_error *err)
{
    const char *names[MOST_OPTIONS], *bad = poptBadOption(context, POPT_BADOPTION_NOALIAS);
    const size_t count = collect(table, names, 0);
    char word[64];
    const char *begin = bad + strspn(bad, "-");
    const size_t length = strcspn(begin, "=");
    strncpy(word, begin, sizeof word - 1);
    word[length < sizeof word ? length : sizeof word - 1] = '\0';
    const char *nearest = code == POPT_ERROR_BADOPT ? br_nearest(word, names, count) : NULL;
    if (nearest)
        return br_fail(err, BR_BAD_INPUT, "%s: %s; did you mean --%s?", bad, poptStrerror(code),
                       nearest);
    return br_fail(err, BR_BAD_INPUT, "%s: %s; '--help' lists the options", bad,
                   poptStrerror(code));
}
