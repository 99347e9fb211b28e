/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/scene/words.h"

#include <stdio.h>
#include <string.h>

#include "study/scene/nearest.h"

enum { MOST_ROWS = 64 };

bool br_word_available(const struct br_words *w, size_t row)
{
    return !w->available || w->available(row);
}

char *br_words_join(const struct br_words *w, const char *separator, char *text, size_t size)
{
    size_t used = 0;
    text[0] = '\0';
    for (size_t i = 0; w->name(i) && used < size; i++)
        if (br_word_available(w, i))
            used += (size_t)snprintf(text + used, size - used, "%s%s", used ? separator : "",
                                     w->name(i));
    return text;
}

static enum br_status refuse(const struct br_words *w, const char *word, bool elsewhere,
                             struct br_error *err)
{
    const char *names[MOST_ROWS];
    char all[512];
    size_t count = 0;
    for (size_t i = 0; w->name(i) && count < MOST_ROWS; i++)
        if (br_word_available(w, i))
            names[count++] = w->name(i);
    const char *nearest = elsewhere ? NULL : br_nearest(word, names, count);
    return br_fail(err, BR_BAD_INPUT, "found '%s'%s, expected one of: %s%s%s%s", word,
                   elsewhere ? ", which this machine does not have" : "",
                   br_words_join(w, ", ", all, sizeof all), nearest ? "; did you mean '" : "",
                   nearest ? nearest : "", nearest ? "'?" : "");
}

enum br_status br_words_read(const struct br_words *w, const char *text, size_t length, size_t *row,
                             struct br_error *err)
{
    char word[64];
    snprintf(word, sizeof word, "%.*s", (int)(length < sizeof word ? length : sizeof word), text);
    for (*row = 0; w->name(*row); ++*row)
        if (strcmp(w->name(*row), word) == 0)
            return br_word_available(w, *row) ? BR_OK : refuse(w, word, true, err);
    return refuse(w, word, false, err);
}
