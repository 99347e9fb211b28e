/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/scene/units.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/words.h"

/* ---- tables ---- */

/* All are exact: SI Brochure (2019), tables 4, 7 and 8, and NIST Special Publication 811 (2008),
 * appendix B. A pound-force is 0.45359237 kg times 9.80665 m/s^2. */
#define POUND_FORCE 44482216152605.0L /* 1e-13 N */
static const struct known {
    const char *word;
    bool takes_prefix;
    struct br_unit unit;
} units[] = {
    {"m", true, {{1, 0, 0}, 1, 0}},
    {"s", true, {{0, 1, 0}, 1, 0}},
    {"g", true, {{0, 0, 1}, 1, -3}},
    {"N", true, {{1, -2, 1}, 1, 0}},
    {"Pa", true, {{-1, -2, 1}, 1, 0}},
    {"J", true, {{2, -2, 1}, 1, 0}},
    {"bar", true, {{-1, -2, 1}, 1, 5}},
    {"t", false, {{0, 0, 1}, 1, 3}},
    {"min", false, {{0, 1, 0}, 60, 0}},
    {"h", false, {{0, 1, 0}, 3600, 0}},
    {"%", false, {{0, 0, 0}, 1, -2}},
    {"in", false, {{1, 0, 0}, 254, -4}},
    {"inch", false, {{1, 0, 0}, 254, -4}},
    {"ft", false, {{1, 0, 0}, 3048, -4}},
    {"lb", false, {{0, 0, 1}, 45359237, -8}},
    {"lbf", false, {{1, -2, 1}, POUND_FORCE, -13}},
    {"kip", false, {{1, -2, 1}, POUND_FORCE, -10}},
    {"psi", false, {{-1, -2, 1}, POUND_FORCE / (254 * 254), -5}},
    {"ksi", false, {{-1, -2, 1}, POUND_FORCE / (254 * 254), -2}},
};
enum { UNITS = sizeof units / sizeof *units };

/* The empty prefix is first: "min" is a minute, not a milli-inch. Both the micro sign and the Greek
 * letter mu are micro-. */
static const struct prefix {
    const char *word;
    int ten;
} prefixes[] = {{"", 0},   {"n", -9}, {"u", -6}, {"\u00b5", -6}, {"\u03bc", -6},
                {"m", -3}, {"c", -2}, {"d", -1}, {"h", 2},       {"k", 3},
                {"M", 6},  {"G", 9},  {"T", 12}};
enum { PREFIXES = sizeof prefixes / sizeof *prefixes };

static const struct {
    struct br_dimension is;
    const char *words;
} dimensions[] = {
    {{0, 0, 0}, "a number without unit"},
    {{1, 0, 0}, "a length"},
    {{0, 1, 0}, "a time"},
    {{0, 0, 1}, "a mass"},
    {{2, 0, 0}, "an area"},
    {{3, 0, 0}, "a volume"},
    {{4, 0, 0}, "a length to the fourth power"},
    {{1, -1, 0}, "a speed"},
    {{0, -1, 0}, "one per time"},
    {{-1, 0, 1}, "a mass per length"},
    {{-3, 0, 1}, "a mass per volume"},
    {{1, -2, 1}, "a force"},
    {{0, -2, 1}, "a force per length"},
    {{-1, -2, 1}, "a force per area"},
    {{2, -2, 1}, "a force times a length"},
    {{3, -2, 1}, "a force times an area"},
    {{1, -1, 1}, "a force times a time"},
    {{3, -1, 1}, "a force times an area times a time"},
};

bool br_dimension_is(struct br_dimension a, struct br_dimension b)
{
    return a.metre == b.metre && a.second == b.second && a.kilogram == b.kilogram;
}

const char *br_dimension_words(struct br_dimension d, char text[BR_DIMENSION_TEXT])
{
    for (size_t i = 0; i < sizeof dimensions / sizeof *dimensions; i++)
        if (br_dimension_is(d, dimensions[i].is))
            return dimensions[i].words;
    snprintf(text, BR_DIMENSION_TEXT, "m^%d s^%d kg^%d", d.metre, d.second, d.kilogram);
    return text;
}

const char *br_unit_words(char text[BR_UNIT_WORDS])
{
    text[0] = '\0';
    for (size_t i = 0; i < UNITS; i++)
        br_append(text, BR_UNIT_WORDS, "%s%s", i ? " " : "", units[i].word);
    return text;
}

/* ---- reading ---- */

#define SEPARATORS " */()^-0123456789" /* of words */

/* Finds a word, with a prefix or without. */
static bool find(const char *text, size_t length, struct br_unit *unit)
{
    for (const struct prefix *p = prefixes; p < prefixes + PREFIXES; p++) {
        const size_t head = strlen(p->word);
        if (length <= head || memcmp(p->word, text, head) != 0)
            continue;
        for (const struct known *k = units; k < units + UNITS; k++)
            if ((k->takes_prefix || !head) && strlen(k->word) == length - head &&
                memcmp(k->word, text + head, length - head) == 0) {
                *unit = k->unit;
                unit->ten += p->ten;
                return true;
            }
    }
    return false;
}

static void multiply(struct br_unit *unit, const struct br_unit *by, int power)
{
    unit->of.metre += power * by->of.metre;
    unit->of.second += power * by->of.second;
    unit->of.kilogram += power * by->of.kilogram;
    unit->ten += power * by->ten;
    for (int i = 0; i < abs(power); i++)
        unit->factor = power > 0 ? unit->factor * by->factor : unit->factor / by->factor;
}

/* Multiplies the unit by "mm^4", "mm4" or "s^-1" to the power `sign`; moves *at behind it. */
static bool read_word(const char **at, int sign, struct br_unit *unit)
{
    struct br_unit word;
    const size_t length = strcspn(*at, SEPARATORS);
    if (!find(*at, length, &word))
        return false;
    *at += length;
    const bool caret = **at == '^';
    const bool minus = caret && (*at)[1] == '-';
    const char *digit = *at + caret + minus;
    const bool power = *digit >= '1' && *digit <= '9' && !isdigit((unsigned char)digit[1]);
    if (power)
        *at = digit + 1;
    multiply(unit, &word, sign * (minus ? -1 : 1) * (power ? *digit - '0' : 1));
    return power || !caret;
}

static bool read_words(const char **at, int sign, struct br_unit *unit)
{
    while (read_word(at, sign, unit)) {
        const size_t blanks = strspn(*at, " ");
        const char *next = *at + blanks;
        if (*next == '*')
            next += 1 + strspn(next + 1, " ");
        else if (!blanks || !*next || strchr("/)", *next)) {
            *at = next;
            return true;
        }
        *at = next;
    }
    return false;
}

bool br_unit_read(const char *text, struct br_unit *unit)
{
    const char *at = text;
    *unit = (struct br_unit){.factor = 1};
    if (*at == '1')
        at++;
    else if (*at && !read_words(&at, 1, unit))
        return false;
    if (*at != '/')
        return !*at;
    at += 1 + strspn(at + 1, " ");
    if (*at != '(')
        return read_word(&at, -1, unit) && !*at;
    at++;
    return read_words(&at, -1, unit) && strcmp(at, ")") == 0;
}

char *br_unit_suggestion(const char *unknown, struct br_dimension of, char *text)
{
    enum { WORDS = UNITS * PREFIXES, MOST = 80 };
    char word[WORDS][16], whole[MOST], wrong[MOST];
    const char *names[WORDS], *at = unknown + strspn(unknown, SEPARATORS);
    size_t count = 0, length = 0;
    struct br_unit unit;
    while (*at && find(at, length = strcspn(at, SEPARATORS), &unit))
        at += length + strspn(at + length, SEPARATORS);
    snprintf(wrong, sizeof wrong, "%.*s", (int)(*at ? length : 0), at);
    for (const struct prefix *p = prefixes; *at && p < prefixes + PREFIXES; p++)
        for (const struct known *k = units; k < units + UNITS; k++) {
            names[count] = word[count];
            snprintf(word[count], sizeof *word, "%s%s", p->word, k->word);
            snprintf(whole, MOST, "%.*s%s%s", (int)(at - unknown), unknown, word[count],
                     at + length);
            count += br_unit_read(whole, &unit) && br_dimension_is(unit.of, of);
        }
    const char *nearest = br_nearest(wrong, names, count);
    if (nearest)
        snprintf(text, BR_SUGGESTION, "; did you mean '%.*s%s%s'?", (int)(at - unknown), unknown,
                 nearest, at + length);
    return nearest ? text : strcpy(text, "");
}

/* ---- converting ---- */

bool br_unit_convert(const struct br_unit *unit, const char *text, size_t length,
                     struct br_si_number *q)
{
    enum { MOST = 400, FARTHEST = 100000 /* beyond it a number is 0 or infinite */ };
    char moved[MOST + 16];
    if (length >= MOST)
        return false;
    const size_t digits = strcspn(text, "eE");
    long exponent = digits < length ? strtol(text + digits + 1, NULL, 10) : 0;
    exponent = exponent > FARTHEST ? FARTHEST : exponent < -FARTHEST ? -FARTHEST : exponent;
    snprintf(moved, sizeof moved, "%.*se%ld", (int)(digits < length ? digits : length), text,
             exponent + unit->ten);
    q->wide = strtold(moved, NULL) * unit->factor;
    q->value = unit->factor == 1 ? strtod(moved, NULL) : (double)q->wide;
    return true;
}

/* Divides by 1000 for milli-, since 0.001 is no double: 5*x [mm] is 5*x/1000. */
bool br_unit_apply(const struct br_unit *unit, const char *expression, char *out, size_t size)
{
    const bool divides = unit->factor == 1 && unit->ten < 0;
    const long double by = unit->factor * powl(10, divides ? -unit->ten : unit->ten);
    const int length =
        by == 1 ? snprintf(out, size, "%s", expression)
                : snprintf(out, size, "(%s)%c%.17Lg", expression, divides ? '/' : '*', by);
    return length >= 0 && (size_t)length < size;
}
