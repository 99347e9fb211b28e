/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finds and lists the rows of any registry by their names. */
#ifndef BR_BASE_WORDS_H
#define BR_BASE_WORDS_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"

struct br_words {
    const char *(*name)(size_t row);  /* NULL: after the last row */
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

/* Writes the names of the rows that can be chosen here, as "a, b" with separator ", ". The text
 * (out) is cut where it is full; returns it. */
char *br_words_join(const struct br_words *words, const char *separator, char *text, size_t size);

/* Finds the row whose name is the first `length` letters of text. Fails with BR_BAD_INPUT: "found
 * 'x', expected one of: a, b", and suggests a similar name if there is one. */
enum br_status br_words_read(const struct br_words *words, const char *text, size_t length,
                             size_t *row, struct br_error *err);

/* Appends to a text, which is cut where it is full; returns it. */
__attribute__((format(printf, 3, 4))) char *br_append(char *text, size_t size, const char *format,
                                                      ...);

/* ---- similar names ---- */

/* The name that differs from the word in the fewest letters; a capital in place of a small letter
 * counts as a quarter of one. Of several that are as near it is the first. NULL: none is similar.
 */
const char *br_nearest(const char *word, const char *const *names, size_t count);

/* How the refusal of an unknown word ends: "; did you mean 'x'?", or nothing; returns text (out).
 */
enum { BR_SUGGESTION = 112 };
char *br_suggestion(const char *word, const char *const *names, size_t count,
                    char text[BR_SUGGESTION]);

/* The same behind a list: "expected one of: a, b; did you mean 'b'?" */
enum { BR_EXPECTED = 800 };
char *br_expected(const char *word, const char *const *names, size_t count, char text[BR_EXPECTED]);

/* ---- lists of names ---- */

/* A name in double quotes, at *at: moves *at behind the first quote, returns what follows the
 * second one. NULL: there is none. */
const char *br_list_quoted(const char **at);

/* The first name of a list "a, b" (out; without the blanks around it, and without a zero at its
 * end); returns the rest of the list, or NULL. In double quotes a name may have commas: "a,b". */
const char *br_list_next(const char *list, const char **name, size_t *length);

/* Whether a name (NULL: a column without a heading) is in a list (NULL: an empty one). */
bool br_lists(const char *list, const char *name);

/* ---- numbers ---- */

/* Lists of numbers on the command line and in scenes: "100,200,400", with or without blanks after
 * the commas. */

/* Reads a finite decimal number at the start of text; returns what follows, or NULL. */
const char *br_read_number(const char *text, double *value);

/* For qsort: numbers in ascending order. */
int br_by_number(const void *a, const void *b);

/* Whether a text begins with a word, which is then skipped. */
bool br_takes(const char **text, const char *word);

/* Skips blanks, a word and the blanks behind it; returns what follows, or NULL: the word is not
 * there, or text is NULL. */
const char *br_skip_word(const char *text, const char *word);

/* The range of a number: (low, high), or the whole numbers in [low, high]. */
struct br_number_range {
    double low, high;
    bool whole;
};

/* Reads one number of the range. Fails with BR_BAD_INPUT: "found 'x', expected a number above 0 and
 * below 1". */
enum br_status br_read_in_range(const char *text, const struct br_number_range *range,
                                double *value, struct br_error *err);

/* Writes 15 digits, or 17 if 15 do not give the same number again; returns text (out). */
const char *br_shortest(double number, char *text, size_t size);

/* Reads a list of distinct positive numbers (or whole numbers) in any order; *values
 * is owned by the caller, even after a failure (BR_BAD_INPUT, naming the option). */
enum br_status br_read_numbers(const char *option, const char *text, double **values, size_t *count,
                               struct br_error *err);
enum br_status br_read_counts(const char *option, const char *text, size_t **values, size_t *count,
                              struct br_error *err);

#endif
