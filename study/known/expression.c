/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/known/expression.h"

#include <locale.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/words.h"

/* A recursive descent parser. Each function is named after what it reads, from `at` on, and returns
 * its node. After the first error `at` is the text's end, so that all functions return. */
struct parser {
    const char *text, *at;
    struct br_tree_builder builder;
    int depth;
    enum br_status status;
    struct br_error *err;
};

/* ---- errors ---- */

__attribute__((format(printf, 2, 3))) static unsigned refuse(struct parser *p, const char *format,
                                                             ...)
{
    if (p->status)
        return BR_NO_NODE;
    char reason[512];
    va_list args;
    va_start(args, format);
    vsnprintf(reason, sizeof reason, format, args);
    va_end(args);
    p->status =
        br_fail(p->err, BR_BAD_INPUT, "'%.300s' is no expression in x and t: at column %d: %s",
                p->text, (int)(p->at - p->text) + 1, reason);
    p->at = p->text + strlen(p->text);
    return BR_NO_NODE;
}

/* Independent of the locale: only ASCII counts. */
static bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

static bool is_letter(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

static size_t word_length(const char *at)
{
    size_t length = 0;
    while (is_letter(at[length]) || is_digit(at[length]))
        length++;
    return length;
}

static unsigned unexpected(struct parser *p, const char *expected)
{
    const unsigned char c = (unsigned char)*p->at;
    const size_t length = word_length(p->at);
    if (c == '=')
        return refuse(p, "it assigns; a comparison is ==");
    if (c == '\0')
        return refuse(p, "found the end, expected %s", expected);
    if (c < ' ' || c > '~')
        return refuse(p, "found the byte 0x%02x, expected %s", c, expected);
    return refuse(p, "found '%.*s', expected %s", length ? (int)length : 1, p->at, expected);
}

/* ---- words ---- */

static void skip_blanks(struct parser *p)
{
    while (*p->at && strchr(" \t\r\n", *p->at))
        p->at++;
}

/* Skips `what` if it comes next; returns whether it did. */
static bool take(struct parser *p, const char *what)
{
    skip_blanks(p);
    const size_t length = strlen(what);
    if (strncmp(p->at, what, length) != 0)
        return false;
    p->at += length;
    return true;
}

static unsigned node(struct parser *p, enum br_operation operation, unsigned a, unsigned b,
                     unsigned c)
{
    const unsigned made = br_tree_node(&p->builder, operation, a, b, c);
    if (p->builder.tree.count > BR_EXPRESSION_MOST_NODES)
        return refuse(p, "it has more than %d operations", BR_EXPRESSION_MOST_NODES);
    return made;
}

static unsigned expression(struct parser *p);

/* Reads a nested expression or factor, and limits the depth. */
static unsigned inner(struct parser *p, unsigned (*read)(struct parser *))
{
    if (p->depth == BR_EXPRESSION_MOST_DEPTH)
        return refuse(p, "more than %d brackets, signs, powers or ?: in one another",
                      BR_EXPRESSION_MOST_DEPTH);
    p->depth++;
    const unsigned out = read(p);
    p->depth--;
    return out;
}

static const char *skip_digits(const char *at)
{
    while (is_digit(*at))
        at++;
    return at;
}

/* Digits, a point, an exponent, as in C and always in C's locale. */
static unsigned number(struct parser *p)
{
    const char *end = skip_digits(p->at);
    const bool whole = end > p->at;
    if (*end == '.')
        end = skip_digits(end + 1);
    if (!whole && end == p->at + 1)
        return unexpected(p, "a digit beside the decimal point");
    if (*end == 'e' || *end == 'E') {
        const char *digits = end + 1 + (end[1] == '+' || end[1] == '-');
        end = skip_digits(digits) > digits ? skip_digits(digits) : end;
    }
    const locale_t c = newlocale(LC_ALL_MASK, "C", (locale_t)0); /* allocates nothing */
    const double value = is_letter(*end) ? 0 : strtod_l(p->at, NULL, c);
    freelocale(c);
    if (!isfinite(value))
        return refuse(p, "found '%.*s', expected a number below 1.8e308", (int)(end - p->at),
                      p->at);
    p->at = end;
    if (word_length(end) || *end == '.')
        return unexpected(p, "an operator behind a number");
    return br_tree_number(&p->builder, value);
}

/* Reads the arguments of a function, after '('. */
static unsigned call(struct parser *p, enum br_operation operation)
{
    const unsigned arguments = br_operations[operation].arguments;
    unsigned first = inner(p, expression);
    if (arguments == 2 && !take(p, ","))
        return unexpected(p, "',' and one more argument");
    if (arguments == 2)
        do
            first = node(p, operation, first, inner(p, expression), 0);
        while (take(p, ","));
    else
        first = node(p, operation, first, 0, 0);
    return take(p, ")") ? first : unexpected(p, arguments == 2 ? "',' or ')'" : "')'");
}

/* Finds a function: an operation whose word has letters. */
static bool find_function(const char *word, size_t length, enum br_operation *operation)
{
    if (length == 2 && memcmp(word, "ln", 2) == 0) {
        *operation = BR_OP_LOG;
        return true;
    }
    for (int i = BR_OP_SIN; i <= BR_OP_MAX; i++) {
        const char *known = br_operations[i].word;
        *operation = (enum br_operation)i;
        if (is_letter(*known) && strlen(known) == length && memcmp(known, word, length) == 0)
            return true;
    }
    return false;
}

static unsigned unknown_name(struct parser *p, size_t length)
{
    const char *names[64] = {"x", "t", "pi", "e", "ln"};
    char word[40], expected[BR_EXPECTED];
    size_t count = 5;
    snprintf(word, sizeof word, "%.*s", (int)(length < 39 ? length : 39), p->at);
    for (int i = BR_OP_SIN; i <= BR_OP_MAX; i++)
        if (is_letter(*br_operations[i].word))
            names[count++] = br_operations[i].word;
    return refuse(p, "unknown name '%s', %s", word, br_expected(word, names, count, expected));
}

static unsigned name(struct parser *p)
{
    const char *const word = p->at;
    const size_t length = word_length(word);
    enum br_operation function;
    if (find_function(word, length, &function)) {
        p->at += length;
        return take(p, "(") ? call(p, function) : unexpected(p, "'(' behind a function's name");
    }
    if (length == 2 && memcmp(word, "pi", 2) == 0) {
        p->at += 2;
        return br_tree_number(&p->builder, M_PI);
    }
    if (length != 1 || !strchr("xte", *word))
        return unknown_name(p, length);
    p->at++;
    return *word == 'e' ? br_tree_number(&p->builder, M_E)
                        : node(p, *word == 'x' ? BR_OP_X : BR_OP_T, 0, 0, 0);
}

static unsigned operand(struct parser *p)
{
    skip_blanks(p);
    if (take(p, "(")) {
        const unsigned out = inner(p, expression);
        return take(p, ")") ? out : unexpected(p, "an operator or ')'");
    }
    if (is_digit(*p->at) || *p->at == '.')
        return number(p);
    return is_letter(*p->at) ? name(p) : unexpected(p, "a number, a name or '('");
}

/* ---- operators ---- */

/* An operand with the operators in front of it and its power. */
static unsigned factor(struct parser *p)
{
    if (take(p, "+"))
        return inner(p, factor);
    if (take(p, "-"))
        return node(p, BR_OP_NEGATE, inner(p, factor), 0, 0);
    if (take(p, "!"))
        return node(p, BR_OP_NOT, inner(p, factor), 0, 0);
    const unsigned base = operand(p);
    return take(p, "^") ? node(p, BR_OP_POW, base, inner(p, factor), 0) : base;
}

struct binary {
    const char *word;
    enum br_operation operation;
    int level;
    bool swapped; /* a > b is b < a */
    bool negated;
};

enum { COMPARISON = 3 };

/* The next operator, which is not skipped; NULL: none. */
static const struct binary *next_operator(struct parser *p)
{
    static const struct binary known[] = {
        {"||", BR_OP_OR, 1, false, false},         {"&&", BR_OP_AND, 2, false, false},
        {"<=", BR_OP_LESS_EQUAL, 3, false, false}, {">=", BR_OP_LESS_EQUAL, 3, true, false},
        {"==", BR_OP_EQUAL, 3, false, false},      {"!=", BR_OP_EQUAL, 3, false, true},
        {"<", BR_OP_LESS, 3, false, false},        {">", BR_OP_LESS, 3, true, false},
        {"+", BR_OP_ADD, 4, false, false},         {"-", BR_OP_SUBTRACT, 4, false, false},
        {"*", BR_OP_MULTIPLY, 5, false, false},    {"/", BR_OP_DIVIDE, 5, false, false},
    };
    skip_blanks(p);
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (strncmp(p->at, known[i].word, strlen(known[i].word)) == 0)
            return &known[i];
    return NULL;
}

/* Factors and the operators between them, of level `least` or above. */
static unsigned chain(struct parser *p, int least)
{
    unsigned left = factor(p);
    int before = 0;
    for (const struct binary *o; (o = next_operator(p)) && o->level >= least;) {
        if (o->level == COMPARISON && before == COMPARISON)
            return refuse(p, "found a second comparison, expected && between two, or brackets");
        before = o->level;
        p->at += strlen(o->word);
        const unsigned right = chain(p, o->level + 1);
        left = node(p, o->operation, o->swapped ? right : left, o->swapped ? left : right, 0);
        if (o->negated)
            left = node(p, BR_OP_NOT, left, 0, 0);
    }
    return left;
}

static unsigned expression(struct parser *p)
{
    const unsigned condition = chain(p, 0);
    if (!take(p, "?"))
        return condition;
    const unsigned yes = inner(p, expression);
    return take(p, ":") ? node(p, BR_OP_CHOOSE, condition, yes, inner(p, expression))
                        : unexpected(p, "an operator or ':'");
}

enum br_status br_expression_parse(const char *text, struct br_tree *tree, struct br_error *err)
{
    struct parser p = {.text = text, .at = text, .err = err};
    *tree = (struct br_tree){0};
    const unsigned root = expression(&p);
    skip_blanks(&p);
    if (*p.at == ',')
        refuse(&p, "it is more than one, separated by commas");
    else if (*p.at)
        unexpected(&p, "an operator or the end");
    if (!p.status)
        return br_tree_finish(&p.builder, root, tree, err);
    br_tree_clear(&p.builder.tree);
    return p.status;
}

enum br_status br_expression(const char *text, struct br_function *f, struct br_error *err)
{
    struct br_tree tree;
    *f = (struct br_function){0};
    enum br_status status = br_expression_parse(text, &tree, err);
    if (!status)
        status = br_tree_function(&tree, f, err);
    if (status || f->ops || isfinite(f->constant))
        return status;
    const double found = isnan(f->constant) ? NAN : f->constant; /* not "-nan" */
    *f = (struct br_function){0};
    return br_fail(err, BR_BAD_INPUT, "'%.300s' is %g, expected a finite number", text, found);
}
