/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/words.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/quote.h"

enum { MOST_ROWS = 64 };

bool br_word_available(const struct br_words *w, size_t row)
{
    return !w->available || w->available(row);
}

char *br_words_join(const struct br_words *w, const char *separator, char *text, size_t size)
{
    text[0] = '\0';
    for (size_t i = 0; w->name(i); i++)
        if (br_word_available(w, i))
            br_append(text, size, "%s%s", *text ? separator : "", w->name(i));
    return text;
}

char *br_append(char *text, size_t size, const char *format, ...)
{
    const size_t used = strlen(text);
    va_list args;
    va_start(args, format);
    vsnprintf(text + used, size - used, format, args);
    va_end(args);
    return text;
}

static enum br_status refuse(const struct br_words *w, const char *word, bool elsewhere,
                             struct br_error *err)
{
    const char *names[MOST_ROWS];
    char expected[BR_EXPECTED];
    size_t count = 0;
    for (size_t i = 0; w->name(i) && count < MOST_ROWS; i++)
        if (br_word_available(w, i))
            names[count++] = w->name(i);
    return br_fail(err, BR_BAD_INPUT, "found '%s'%s, %s", word,
                   elsewhere ? ", which this machine does not have" : "",
                   br_expected(elsewhere ? "" : word, names, count, expected));
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

/* ---- similar names ---- */

enum { MOST_LETTERS = 32, LETTER = 4 /* quarters of a letter */ };

static size_t least(size_t a, size_t b)
{
    return a < b ? a : b;
}

/* What it takes to change a letter into another one. */
static size_t change(char a, char b)
{
    return a == b ? 0 : tolower((unsigned char)a) == tolower((unsigned char)b) ? 1 : LETTER;
}

/* The insertions, deletions, changes and swaps of neighbours that turn a into b. */
static size_t distance(const char *a, const char *b)
{
    size_t d[MOST_LETTERS + 1][MOST_LETTERS + 1];
    const size_t m = strlen(a), n = strlen(b);
    if (m > MOST_LETTERS || n > MOST_LETTERS)
        return LETTER * MOST_LETTERS;
    for (size_t i = 0; i <= m; i++)
        for (size_t j = 0; j <= n; j++) {
            if (i == 0 || j == 0) {
                d[i][j] = LETTER * (i + j);
                continue;
            }
            d[i][j] = least(d[i - 1][j], d[i][j - 1]) + LETTER;
            d[i][j] = least(d[i][j], d[i - 1][j - 1] + change(a[i - 1], b[j - 1]));
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                d[i][j] = least(d[i][j], d[i - 2][j - 2] + LETTER);
        }
    return d[m][n];
}

const char *br_nearest(const char *word, const char *const *names, size_t count)
{
    const char *nearest = NULL;
    size_t best = LETTER * (strlen(word) / 3 + 1); /* more differences make another word */
    for (size_t i = 0; i < count; i++) {
        const size_t letters = distance(word, names[i]);
        if (letters < best + !nearest && letters < LETTER * strlen(word)) {
            best = letters;
            nearest = names[i];
        }
    }
    return nearest;
}

char *br_suggestion(const char *word, const char *const *names, size_t count,
                    char text[BR_SUGGESTION])
{
    char name[BR_SUGGESTION - sizeof "; did you mean ''?"];
    const char *nearest = br_nearest(word, names, count);
    text[0] = '\0';
    return nearest ? br_append(text, BR_SUGGESTION, "; did you mean '%s'?",
                               br_quoted(name, sizeof name, &br_for_text, nearest))
                   : text;
}

char *br_expected(const char *word, const char *const *names, size_t count, char text[BR_EXPECTED])
{
    char name[80], suggestion[BR_SUGGESTION];
    strcpy(text, "expected one of: ");
    for (size_t i = 0; i < count; i++)
        br_append(text, BR_EXPECTED - BR_SUGGESTION, "%s%s", i ? ", " : "",
                  br_quoted(name, sizeof name, &br_for_text, names[i]));
    return br_append(text, BR_EXPECTED, "%s", br_suggestion(word, names, count, suggestion));
}

/* ---- numbers ---- */

enum { MOST = 1024 };

const char *br_read_number(const char *text, double *value)
{
    const char *digits = text + (*text == '-' || *text == '+');
    if ((!isdigit((unsigned char)*digits) && *digits != '.') || strncasecmp(digits, "0x", 2) == 0)
        return NULL; /* strtod would take "nan", "inf", leading blanks and hexadecimal numbers */
    char *end;
    errno = 0;
    *value = strtod(text, &end);
    const bool lost = errno == ERANGE && *value == 0; /* 1e-400 is not 0 */
    return end != text && isfinite(*value) && !lost ? end : NULL;
}

int br_by_number(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

bool br_takes(const char **text, const char *word)
{
    const bool found = strncmp(*text, word, strlen(word)) == 0;
    *text += found ? strlen(word) : 0;
    return found;
}

const char *br_skip_word(const char *text, const char *word)
{
    static const char blanks[] = " \t\n";
    text += text ? strspn(text, blanks) : 0;
    if (!text || strncmp(text, word, strlen(word)) != 0)
        return NULL;
    text += strlen(word);
    return text + strspn(text, blanks);
}

static enum br_status not_in_range(const char *text, const struct br_number_range *r,
                                   struct br_error *err)
{
    char below[32] = "";
    if (r->whole)
        return br_fail(err, BR_BAD_INPUT, "found '%s', expected a whole number from %.0f to %.0f",
                       text, r->low, r->high);
    if (isfinite(r->high))
        snprintf(below, sizeof below, " and below %g", r->high);
    return br_fail(err, BR_BAD_INPUT, "found '%s', expected a number above %g%s", text, r->low,
                   below);
}

enum br_status br_read_in_range(const char *text, const struct br_number_range *r, double *value,
                                struct br_error *err)
{
    double number = NAN;
    const char *end = br_read_number(text, &number);
    const bool inside = r->whole ? number >= r->low && number <= r->high && number == floor(number)
                                 : number > r->low && number < r->high;
    if (!end || *end || !inside)
        return not_in_range(text, r, err);
    *value = number;
    return BR_OK;
}

const char *br_shortest(double number, char *text, size_t size)
{
    snprintf(text, size, "%.15g", number);
    if (strtod(text, NULL) != number)
        snprintf(text, size, "%.17g", number);
    return text;
}

enum br_status br_read_numbers(const char *option, const char *text, double **values, size_t *count,
                               struct br_error *err)
{
    *count = 0;
    *values = br_allocate(MOST, sizeof **values);
    if (!*values)
        return br_no_memory(err, "a list");
    for (const char *rest = text;; rest++) {
        double value;
        const char *end = br_read_number(rest, &value);
        if (!end || (*end && *end != ',') || !(value > 0))
            return br_fail(err, BR_BAD_INPUT,
                           "%s: found '%s', expected positive numbers separated by commas", option,
                           rest);
        for (size_t i = 0; i < *count; i++)
            if ((*values)[i] == value)
                return br_fail(err, BR_BAD_INPUT, "%s: %g is given twice", option, value);
        if (*count == MOST)
            return br_fail(err, BR_BAD_INPUT, "%s: more than %d values", option, MOST);
        (*values)[(*count)++] = value;
        rest = end;
        if (!*rest)
            return BR_OK;
        while (rest[1] == ' ')
            rest++;
    }
}

enum br_status br_read_counts(const char *option, const char *text, size_t **values, size_t *count,
                              struct br_error *err)
{
    double *numbers;
    enum br_status status = br_read_numbers(option, text, &numbers, count, err);
    *values = status ? NULL : br_allocate(*count, sizeof **values);
    if (!status && !*values)
        status = br_no_memory(err, "a list");
    for (size_t i = 0; i < *count && !status; i++) {
        if (numbers[i] != floor(numbers[i]) || !(numbers[i] <= 1e9))
            status =
                br_fail(err, BR_BAD_INPUT, "%s: found %g, expected whole numbers from 1 to 1e9",
                        option, numbers[i]);
        else
            (*values)[i] = (size_t)numbers[i];
    }
    free(numbers);
    return status;
}

/* ---- lists of names ---- */

const char *br_list_quoted(const char **at)
{
    const char *end = **at == '"' ? strchr(*at + 1, '"') : NULL;
    *at += end != NULL;
    return end ? end + 1 : NULL;
}

const char *br_list_next(const char *list, const char **name, size_t *length)
{
    const char *inside = list += strspn(list, " "), *quoted = br_list_quoted(&inside);
    const char *end = quoted ? quoted : list;
    end += strcspn(end, ",");
    *name = list;
    *length = (size_t)(end - list);
    while (*length && list[*length - 1] == ' ')
        --*length;
    if (quoted && *length == (size_t)(quoted - list)) { /* nothing follows it */
        *name = inside;
        *length -= 2;
    }
    return *end ? end + 1 : NULL;
}

bool br_lists(const char *list, const char *name)
{
    const char *listed;
    size_t length;
    while (name && list) {
        list = br_list_next(list, &listed, &length);
        if (length && length == strlen(name) && memcmp(listed, name, length) == 0)
            return true;
    }
    return false;
}
