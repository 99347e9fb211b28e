/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/mms/product.h"

#include <ctype.h>
#include <string.h>

/* "(a)*" for each factor "a*", and at least "1". */
size_t br_product_size(size_t length)
{
    return 3 * length + 8;
}

static bool is_word(char c)
{
    return isalnum((unsigned char)c) || c == '_' || c == '.';
}

/* Whether the variable, one letter, occurs among the words of the factor. */
static bool uses(const char *factor, size_t length, char variable)
{
    for (size_t i = 0; i < length;) {
        size_t end = i;
        while (end < length && is_word(factor[end]))
            end++;
        if (end == i + 1 && factor[i] == variable)
            return true;
        i = end > i ? end : i + 1;
    }
    return false;
}

/* Whether a sign at text[i] adds: not in front of an operand, nor in 1e-3. */
static bool adds(const char *text, size_t i)
{
    if (i >= 2 && (text[i - 1] == 'e' || text[i - 1] == 'E') &&
        (isdigit((unsigned char)text[i - 2]) || text[i - 2] == '.'))
        return false;
    while (i > 0 && text[i - 1] == ' ')
        i--;
    return i > 0 && !strchr("+-*/^(", text[i - 1]);
}

/* The length of the factor at the beginning of text + from; 0 where a sum begins. */
static size_t factor_length(const char *text, size_t from)
{
    int depth = 0;
    for (size_t i = from;; i++) {
        const char c = text[i];
        if (c == '\0' || (c == '*' && depth == 0))
            return i - from;
        if ((c == '+' || c == '-') && depth == 0 && adds(text, i))
            return 0;
        depth += (c == '(') - (c == ')');
    }
}

static void append(char *product, const char *factor, size_t length)
{
    strcat(product, *product ? "*(" : "(");
    strncat(product, factor, length);
    strcat(product, ")");
}

bool br_product_split(const char *text, char *in_x, char *in_t)
{
    *in_x = *in_t = '\0';
    for (size_t i = 0;; i++) {
        const size_t length = factor_length(text, i);
        const bool x = uses(text + i, length, 'x'), t = uses(text + i, length, 't');
        if (length == 0 || (x && t))
            return false;
        append(t ? in_t : in_x, text + i, length);
        i += length;
        if (!text[i])
            break;
    }
    if (!*in_x)
        strcpy(in_x, "1");
    if (!*in_t)
        strcpy(in_t, "1");
    return true;
}
