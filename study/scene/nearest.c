/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/scene/nearest.h"

#include <string.h>

enum { MOST_LETTERS = 32 };

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
