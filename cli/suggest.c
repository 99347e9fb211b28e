/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/suggest.h"

#include <string.h>

enum { MOST_LETTERS = 32, MOST_OPTIONS = 64 };

static size_t least(size_t a, size_t b)
{
    return a < b ? a : b;
}

/* Insertions, deletions, changes and swaps of neighbours that make b of a. */
static size_t distance(const char *a, const char *b)
{
    size_t d[MOST_LETTERS + 1][MOST_LETTERS + 1];
    const size_t m = strlen(a), n = strlen(b);
    if (m > MOST_LETTERS || n > MOST_LETTERS)
        return MOST_LETTERS;
    for (size_t i = 0; i <= m; i++)
        for (size_t j = 0; j <= n; j++) {
            if (i == 0 || j == 0) {
                d[i][j] = i + j;
                continue;
            }
            d[i][j] = least(d[i - 1][j], d[i][j - 1]) + 1;
            d[i][j] = least(d[i][j], d[i - 1][j - 1] + (a[i - 1] != b[j - 1]));
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                d[i][j] = least(d[i][j], d[i - 2][j - 2] + 1);
        }
    return d[m][n];
}

const char *br_nearest(const char *word, const char *const *names, size_t count)
{
    const char *nearest = NULL;
    size_t best = strlen(word) / 3 + 1; /* more is another word */
    for (size_t i = 0; i < count; i++) {
        const size_t letters = distance(word, names[i]);
        if (letters < best + !nearest && letters < strlen(word)) {
            best = letters;
            nearest = names[i];
        }
    }
    return nearest;
}

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
