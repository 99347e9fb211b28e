/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A field of a table as a number: first its signs are made those of C, then it is read by a small
 * grammar, whole or not at all:
 *     field     = term [deviation | power] ["%"] term = number ["x 10^" number]
 *                                                     | "[8 8]", "(8, 8)": the same number
 *     deviation = "+-" term | "(12)"                  | number "/" number | number "^" number
 *     power     = "(-12)" | "(+12)"                   | number "x" the same number ...
 *                                                     | [number] "pi" ["/" number] */
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "base/words.h"
#include "orders/reading/reading.h"

enum { LONGEST = 512, PLUS_MINUS = '~' };

/* ---- signs ---- */

static const struct {
    const char *sign, *plain;
} signs[] = {
    {"\u2212", "-"},  {"\u2013", "-"},  {"\u00d7", "x"},     {"\\times", "x"}, {"\\cdot", "x"},
    {"\u00b7", "x"},  {"\u22c5", "x"},  {"*10", "x10"},      {"* 10", "x10"},  {"\\pm", "~"},
    {"\u00b1", "~"},  {"+/-", "~"},     {"+-", "~"},         {"\u2070", "0"},  {"\u00b9", "1"},
    {"\u00b2", "2"},  {"\u00b3", "3"},  {"\u2074", "4"},     {"\u2075", "5"},  {"\u2076", "6"},
    {"\u2077", "7"},  {"\u2078", "8"},  {"\u2079", "9"},     {"\u207b", "-"},  {"\u207a", "+"},
    {"\\num", ""},    {"\\mathbf", ""}, {"\\textbf", ""},    {"\\bf", ""},     {"\\bm", ""},
    {"\\mathrm", ""}, {"\\textit", ""}, {"\\underline", ""}, {"\\emph", ""},   {"\\,", ""},
    {"\\;", ""},      {"\\!", ""},      {"\\%", "%"},        {"$", ""},        {"{", ""},
    {"}", ""},        {"`", ""},        {"**", ""},          {"\u03c0", "pi"}, {"\\pi", "pi"},
};
enum { SIGNS = sizeof signs / sizeof *signs, FIRST_RAISED = 13, LAST_RAISED = 24 };

/* Copies a text with the signs of C; false: it is too long. A "^" begins raised digits. */
static bool make_plain(const char *text, char plain[LONGEST])
{
    size_t length = 0;
    bool raised = false;
    while (*text && length + 8 < LONGEST) {
        const bool may_be_sign = (unsigned char)*text >= 0x80 || strchr("\\*+${}`", *text);
        size_t i = may_be_sign ? 0 : SIGNS;
        while (i < SIGNS && strncmp(text, signs[i].sign, strlen(signs[i].sign)) != 0)
            i++;
        const bool up = i >= FIRST_RAISED && i <= LAST_RAISED;
        if (up && !raised)
            plain[length++] = '^';
        raised = up;
        if (i == SIGNS) {
            plain[length++] = *text++;
            continue;
        }
        for (const char *c = signs[i].plain; *c; c++)
            plain[length++] = *c;
        text += strlen(signs[i].sign);
    }
    while (length && plain[length - 1] == ' ')
        length--;
    plain[length] = '\0';
    return !*text;
}

bool br_field_is_missing(const char *text)
{
    static const char *const words[] = {
        "-",    "--",   "---",  "\u2013", "\u2014", "\u2212",   "$-$",       "{-}",    "$--$",
        "nan",  "-nan", "+nan", "na",     "n/a",    "n.a.",     "#n/a",      "none",   "missing",
        "null", "<na>", "inf",  "-inf",   "+inf",   "infinity", "-infinity", "\u221e", "$\\infty$"};
    if (!text || strspn(text, "*") == strlen(text))
        return true;
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (strcasecmp(text, words[i]) == 0)
            return true;
    return false;
}

/* ---- the grammar: each takes a text and returns what follows, or NULL ---- */

struct reader {
    char mark;
    int decimals; /* of the last number */
    int exponent; /* of the last number */
};

static const char *skip(const char *at)
{
    return at ? at + strspn(at, " ") : NULL;
}

/* Copies the digits before a mark; "1,000" without its commas, if the mark is a point, and "1.000"
 * without its points, if it is a comma. */
static const char *take_whole(const struct reader *r, const char *at, char **to)
{
    const size_t first = strspn(at, "0123456789");
    memcpy(*to, at, first);
    *to += first;
    at += first;
    const char *const digits = at - first;
    while (*digits != '0' && first > 0 && first <= 3 && *at == (r->mark == '.' ? ',' : '.') &&
           strspn(at + 1, "0123456789") == 3) {
        memcpy(*to, at + 1, 3);
        *to += 3;
        at += 4;
    }
    return at;
}

/* The letter of an exponent may be Fortran's, D or Q; there is none before three digits. */
static const char *take_exponent(const char *at, bool has_mark, char **to)
{
    const bool letter = *at && strchr("eEdDqQ", *at);
    const char *digits = at + letter;
    digits += *digits == '-' || *digits == '+';
    const size_t count = strspn(digits, "0123456789");
    if (!count || (!letter && (digits == at || !has_mark || count != 3)))
        return at;
    *(*to)++ = 'e';
    at += letter;
    memcpy(*to, at, (size_t)(digits - at) + count);
    *to += (size_t)(digits - at) + count;
    return digits + count;
}

static const char *take_number(struct reader *r, const char *at, double *value)
{
    char text[LONGEST + 2], *to = text;
    if (!at)
        return NULL;
    if (*at == '-' || *at == '+')
        *to++ = *at++;
    const char *const first = at;
    at = take_whole(r, at, &to);
    const bool grouped = strspn(first, "0123456789") < (size_t)(at - first);
    const bool has_mark = *at == r->mark && (!grouped || r->mark == '.'); /* "1,000.5" */
    r->decimals = 0;
    if (has_mark) {
        *to++ = '.';
        r->decimals = (int)strspn(++at, "0123456789");
        memcpy(to, at, (size_t)r->decimals);
        to += r->decimals;
        at += r->decimals;
    }
    if (at - first == has_mark) /* no digit */
        return NULL;
    const char *const power = to;
    at = take_exponent(at, has_mark, &to);
    *to = '\0';
    r->exponent = *power ? atoi(power + 1) : 0;
    const char *const end = br_read_number(text, value);
    return end && !*end ? at : NULL;
}

/* "x 10^-2" behind a number, or "x8", "x8x8" of a mesh. */
static const char *take_times(struct reader *r, const char *at, double *value)
{
    const double side = *value;
    double number, power;
    while (at && *skip(at) == 'x') {
        at = skip(skip(at) + 1);
        if (strncmp(at, "10^", 3) == 0) {
            at = take_number(r, at + 3, &power);
            r->exponent = at ? (int)power : 0;
            char text[64], shortest[32];
            snprintf(text, sizeof text, "%se%d", br_shortest(side, shortest, sizeof shortest),
                     r->exponent);
            const char *end = at && power == r->exponent ? br_read_number(text, value) : NULL;
            return end && !*end ? at : NULL;
        }
        at = take_number(r, at, &number);
        if (at && number != side)
            return NULL;
    }
    return at;
}

/* "pi", "2pi", "2 pi", "2*pi": pi times a number. */
static const char *take_pi(struct reader *r, const char *at, double *value)
{
    const char *const number = strncmp(at, "pi", 2) == 0 ? at : take_number(r, at, value);
    if (!number)
        return NULL;
    const char *pi = skip(number);
    pi += pi > at && *pi == '*';
    if (strncmp(pi, "pi", 2) != 0)
        return number;
    *value = M_PI * (number == at ? 1 : *value);
    return pi + 2;
}

/* "[8 8]", "(8, 8, 8)": the cells of a mesh along each side. */
static const char *take_sides(struct reader *r, const char *at, double *value)
{
    const char close = *at == '[' ? ']' : ')';
    double side;
    size_t more = 0;
    for (at = take_number(r, skip(at + 1), value); at && *skip(at) != close; more++) {
        at = *at == ' ' ? take_number(r, skip(at), &side) : NULL;
        at = at && side == *value ? at : NULL;
    }
    return at && more ? skip(at) + 1 : NULL;
}

static const char *take_term(struct reader *r, const char *at, double *value)
{
    double second;
    at = take_pi(r, at, value);
    if (!at)
        return NULL;
    if (*skip(at) == 'x')
        return take_times(r, at, value);
    if (*at != '/' && *at != '^')
        return at;
    const double first = *value;
    const char sign = *at;
    at = take_number(r, at + 1, &second);
    *value = sign == '/' ? first / second : pow(first, second);
    return at && isfinite(*value) && (*value != 0 || first == 0) ? at : NULL;
}

/* "(12)" counts in the last digits, "(0.12)" does not; an exponent may follow. */
static const char *take_brackets(struct reader *r, const char *at, struct br_field_number *number)
{
    struct reader inside = *r;
    const int decimals = r->decimals;
    const bool is_signed = at[1] == '-' || at[1] == '+';
    double power = 0;
    at = take_number(&inside, at + 1, &number->deviation);
    if (!at || *at != ')')
        return NULL;
    if (!inside.decimals)
        number->of_power = number->value * pow(10, number->deviation);
    if (is_signed) {
        number->value = number->of_power;
        number->deviation = NAN;
        return at + 1;
    }
    if (!inside.decimals)
        number->deviation *= pow(10, r->exponent - decimals);
    at++;
    const bool times = *skip(at) == 'x' && strncmp(skip(skip(at) + 1), "10^", 3) == 0;
    if (times || (*at && strchr("eEdD", *at))) {
        at = take_number(&inside, times ? skip(skip(at) + 1) + 3 : at + 1, &power);
        number->value *= pow(10, power);
        number->deviation *= pow(10, power);
    }
    return at;
}

bool br_field_read(const char *text, char mark, struct br_field_number *number)
{
    char plain[LONGEST];
    struct reader r = {.mark = mark};
    *number = (struct br_field_number){NAN, NAN, NAN};
    if (!make_plain(text + (*text == '~'), plain)) /* "~0.04": about */
        return false;
    const bool has_sides = *plain && strchr("[(", *plain);
    for (char *comma = plain; has_sides && (comma = strchr(comma, ','));)
        *comma = ' ';
    const char *at =
        has_sides ? take_sides(&r, plain, &number->value) : take_term(&r, plain, &number->value);
    if (at && *skip(at) == PLUS_MINUS)
        at = take_term(&r, skip(skip(at) + 1), &number->deviation);
    else if (at && *skip(at) == '(')
        at = take_brackets(&r, skip(at), number);
    if (at && *skip(at) == '%') {
        number->value /= 100;
        number->deviation /= 100;
        at = skip(at) + 1;
    }
    if (at && at > plain && isdigit((unsigned char)at[-1]) && (*at == 'k' || *at == 'M')) {
        const double many = *at++ == 'k' ? 1e3 : 1e6; /* "370k", "4.4M" cells */
        number->value *= many;
        number->deviation *= many;
    }
    return at && !*at && isfinite(number->value) && !(number->deviation < 0);
}
