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

/* Adds to a text that is already in there, cut where it is full; returns it. */
__attribute__((format(printf, 3, 4))) char *br_append(char *text, size_t size, const char *format,
                                                      ...);

/* ---- what was meant ---- */

/* What somebody may have meant who mistyped a name. */

/* The nearest of count names, by the number of letters that differ; NULL: none is near. */
const char *br_nearest(const char *word, const char *const *names, size_t count);

/* ---- numbers ---- */

/* Lists of numbers, on the command line and in scenes: "100,200,400", with blanks
 * behind the commas or without. */

/* Reads a finite number at the start of text; returns what follows, or NULL. */
const char *br_read_number(const char *text, double *value);

/* What a number may be: in (low, high), or a whole one in [low, high]. */
struct br_number_range {
    double low, high;
    bool whole;
};

/* Reads a text that is one number of the range. Fails with BR_BAD_INPUT: "found 'x', expected a
 * number above 0 and below 1". */
enum br_status br_read_in_range(const char *text, const struct br_number_range *range,
                                double *value, struct br_error *err);

/* Writes the fewest digits, of 15 or 17, that are the number again; returns text (out). */
const char *br_shortest(double number, char *text, size_t size);

/* Reads a list of distinct positive numbers (or whole numbers) in any order; *values
 * is owned by the caller, even after a failure (BR_BAD_INPUT, naming the option). */
enum br_status br_read_numbers(const char *option, const char *text, double **values, size_t *count,
                               struct br_error *err);
enum br_status br_read_counts(const char *option, const char *text, size_t **values, size_t *count,
                              struct br_error *err);

#endif
