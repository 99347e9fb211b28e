/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The rows of a registry by their names, the same for every registry. */
#ifndef BR_STUDY_SCENE_WORDS_H
#define BR_STUDY_SCENE_WORDS_H

#include <stdbool.h>
#include <stddef.h>

#include "solver/status.h"

struct br_words {
    const char *(*name)(size_t row);  /* NULL: behind the last row */
    const char *(*title)(size_t row); /* one line for a person; NULL: the rows have none */
    bool (*available)(size_t row);    /* on this machine; NULL: every row is */
};

/* Defines words_name and words_title of a NULL-terminated registry of rows that have both. */
#define BR_WORDS(words, registry)                              \
    static const char *words##_name(size_t row)                \
    {                                                          \
        return (registry)[row] ? (registry)[row]->name : NULL; \
    }                                                          \
    static const char *words##_title(size_t row)               \
    {                                                          \
        return (registry)[row]->title;                         \
    }

/* Whether row i can be chosen here. */
bool br_word_available(const struct br_words *words, size_t row);

/* The names of the rows that can be chosen here, "a, b" with the separator ", ", cut where the text
 * (out) is full; returns it. */
char *br_words_join(const struct br_words *words, const char *separator, char *text, size_t size);

/* Finds the row whose name the first `length` letters of text are. Fails with BR_BAD_INPUT: "found
 * 'x', expected one of: a, b", with the nearest name where one is near. */
enum br_status br_words_read(const struct br_words *words, const char *text, size_t length,
                             size_t *row, struct br_error *err);

#endif
