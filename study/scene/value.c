/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/scene/value.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "study/scene/expression.h"
#include "study/scene/units.h"

/* "path:line: key: ..." */
enum br_status br_scene_refuse(const struct br_scene_reader *r, size_t line, const char *key,
                               const char *format, ...)
{
    char *text = NULL;
    va_list args;
    va_start(args, format);
    const int length = vasprintf(&text, format, args);
    va_end(args);
    if (length < 0)
        return br_no_memory(r->err, "a message");
    /* A long value must not hide what was expected: that stands at the end. */
    enum { HEAD = 200, TAIL = 400 };
    if (length > HEAD + TAIL)
        br_fail(r->err, BR_BAD_INPUT, "%s:%zu: %.100s: %.*s ... %s", r->path, line, key, HEAD, text,
                text + length - TAIL);
    else
        br_fail(r->err, BR_BAD_INPUT, "%s:%zu: %.100s: %s", r->path, line, key, text);
    free(text);
    return BR_BAD_INPUT;
}

size_t br_yaml_line(const yaml_node_t *node)
{
    return node->start_mark.line + 1;
}

const char *br_yaml_text(const yaml_node_t *node)
{
    return (const char *)node->data.scalar.value;
}

/* ---- numbers ---- */

/* A number with its unit on its way. */
struct number {
    const struct br_scene_reader *r;
    const struct br_scene_key *key;
    const yaml_node_t *node;
    const char *unit; /* that is expected */
    bool ratio;       /* found instead, where the key takes one */
};

static enum br_status refuse_unit(const struct number *n, bool known, const struct br_unit *found,
                                  const struct br_unit *wanted)
{
    char text[2][BR_DIMENSION_TEXT], words[BR_UNIT_WORDS];
    const char *expected = br_dimension_words(wanted->of, text[0]);
    const char *ratio = n->key->need == BR_OR_RATIO ? ", or a number without unit" : "";
    if (known)
        return br_scene_refuse(n->r, br_yaml_line(n->node), n->key->name,
                               "found '%s', which is %s, expected %s, as %s%s",
                               br_yaml_text(n->node), br_dimension_words(found->of, text[1]),
                               expected, n->unit, ratio);
    return br_scene_refuse(
        n->r, br_yaml_line(n->node), n->key->name,
        "found '%s', expected a number and its unit, %s%s, or another unit of %s, "
        "made of %s, with prefixes from n to T",
        br_yaml_text(n->node), n->unit, ratio, expected, br_unit_words(words));
}

/* Any unit of the dimension. */
static enum br_status read_unit(struct number *n, const char *text, struct br_unit *unit)
{
    struct br_unit wanted;
    br_unit_read(n->unit, &wanted);
    const bool known = br_unit_read(text, unit);
    if (known && br_dimension_is(unit->of, wanted.of))
        return BR_OK;
    n->ratio = known && n->key->need == BR_OR_RATIO &&
               br_dimension_is(unit->of, (struct br_dimension){0, 0, 0});
    return n->ratio ? BR_OK : refuse_unit(n, known && *text, unit, &wanted);
}

/* "value unit", as far as `end` (a place in the text; NULL: the text's). */
static enum br_status read_quantity(struct number *n, const char *text, const char *end,
                                    struct br_quantity *q)
{
    enum { MOST_UNIT = 64 };
    char *behind, word[MOST_UNIT];
    struct br_unit unit;
    const double value = strtod(text, &behind);
    const size_t length = end && end >= behind ? (size_t)(end - behind) : strlen(behind);
    const size_t blanks = strspn(behind, " ");
    if (behind == text || (*behind && *behind != ' ') || !isfinite(value) || length >= MOST_UNIT)
        return br_scene_refuse(n->r, br_yaml_line(n->node), n->key->name,
                               "found '%s', expected a finite number in %s", br_yaml_text(n->node),
                               n->unit);
    snprintf(word, sizeof word, "%.*s", (int)length, behind);
    const enum br_status status = read_unit(n, word + (blanks < length ? blanks : length), &unit);
    if (status)
        return status;
    if (br_unit_convert(&unit, text, (size_t)(behind - text), q) && isfinite(q->value))
        return BR_OK;
    return br_scene_refuse(n->r, br_yaml_line(n->node), n->key->name,
                           "found '%s', expected a finite number of at most 400 letters in %s",
                           br_yaml_text(n->node), n->unit);
}

static enum br_status read_number(const struct br_scene_reader *r, const struct br_scene_key *key,
                                  const yaml_node_t *node)
{
    struct number n = {r, key, node, key->unit, false};
    struct br_quantity q;
    const enum br_status status = read_quantity(&n, br_yaml_text(node), NULL, &q);
    if (status)
        return status;
    const bool fits = key->kind == BR_KEY_POSITIVE ? q.value > 0 : q.value >= 0;
    if (!fits)
        return br_scene_refuse(r, br_yaml_line(node), key->name,
                               "found %s, expected a value %s 0 %s", br_yaml_text(node),
                               key->kind == BR_KEY_POSITIVE ? ">" : ">=", key->unit);
    struct br_scene_number *given = &r->given->row[key - br_scene_keys];
    given->value = q.wide;
    given->ratio = n.ratio;
    if (key->need != BR_MAKES && !n.ratio)
        *(double *)((char *)r->scene + key->offset) = q.value;
    return BR_OK;
}

/* ---- cross-sections ---- */

/* Area and second moment of area about the axis across w. a, b: width and height of a rectangle,
 * diameter and wall of a tube; b is 0 for a circle. Those of a tube are without a difference of
 * powers: (D^4 - d^4)/64 = (D^2 - d^2)/4 (D^2 + d^2)/16, with D - d = 2 b. */
static void set_shape(struct br_scene_number *to, bool rectangle, long double a, long double b)
{
    const long double pi = 3.141592653589793238463L, inner = b > 0 ? a - 2 * b : 0;
    const long double area = rectangle ? a * b : b > 0 ? pi * b * (a - b) : pi * a * a / 4;
    to->value = area;
    to->second = rectangle ? area * b * b / 12 : area * (a * a + inner * inner) / 16;
}

/* "rectangle 20 mm x 5 mm", "circle 10 mm", "tube 20 mm x 2 mm" */
static enum br_status read_shape(const struct br_scene_reader *r, const struct br_scene_key *key,
                                 const yaml_node_t *node)
{
    static const char *const words[] = {"rectangle ", "circle ", "tube "};
    const char *text = br_yaml_text(node), *cross = strstr(text, " x ");
    struct number n = {r, key, node, "m", false};
    struct br_quantity a, b = {0, 0};
    size_t shape = 0;
    while (shape < 3 && strncmp(text, words[shape], strlen(words[shape])) != 0)
        shape++;
    if (shape == 3 || (shape == 1) == (cross != NULL))
        return br_scene_refuse(r, br_yaml_line(node), key->name, "found '%s', expected %s", text,
                               key->help);
    enum br_status status = read_quantity(&n, text + strlen(words[shape]), cross, &a);
    if (!status && cross)
        status = read_quantity(&n, cross + strlen(" x "), NULL, &b);
    if (status)
        return status;
    if (!(a.wide > 0 && (b.wide > 0 || shape == 1) && (shape != 2 || 2 * b.wide < a.wide)))
        return br_scene_refuse(r, br_yaml_line(node), key->name,
                               "found '%s', expected lengths above 0, and the wall of a tube below "
                               "its radius",
                               text);
    set_shape(&r->given->row[key - br_scene_keys], shape == 0, a.wide, b.wide);
    return BR_OK;
}

/* ---- expressions ---- */

enum { MOST_TEXT = 1024 };

/* Splits "expression [unit]": the expression goes into text. */
static enum br_status split_unit(const struct br_scene_reader *r, const struct br_scene_key *key,
                                 const char *unit, const yaml_node_t *node, char text[MOST_TEXT],
                                 struct br_unit *found)
{
    const char *bracket = strrchr(br_yaml_text(node), '[');
    const size_t length = bracket ? (size_t)(bracket - br_yaml_text(node)) : 0;
    struct number n = {r, key, node, unit, false};
    char word[64] = "";
    if (bracket)
        snprintf(word, sizeof word, "%s", bracket + 1);
    char *end = strchr(word, ']');
    if (!end || end == word || end[1])
        return br_scene_refuse(r, br_yaml_line(node), key->name,
                               "found '%s', expected an expression and its unit, like 'x*t [%s]'",
                               br_yaml_text(node), unit);
    *end = '\0';
    const enum br_status status = read_unit(&n, word, found);
    if (status)
        return status;
    if (length >= MOST_TEXT)
        return br_scene_refuse(r, br_yaml_line(node), key->name, "longer than %d characters",
                               MOST_TEXT - 1);
    memcpy(text, br_yaml_text(node), length);
    text[length] = '\0';
    while (*text && text[strlen(text) - 1] == ' ')
        text[strlen(text) - 1] = '\0';
    return BR_OK;
}

static enum br_status parse_expression(const struct br_scene_reader *r,
                                       const struct br_scene_key *key, const yaml_node_t *node,
                                       const char *text, struct br_function *out)
{
    struct br_error inner = {0};
    const enum br_status status = br_expression(text, out, &inner);
    if (status == BR_BAD_INPUT)
        return br_scene_refuse(r, br_yaml_line(node), key->name, "%s", inner.message);
    return status ? br_fail(r->err, status, "%s", inner.message) : BR_OK;
}

enum { MOST_APPLIED = MOST_TEXT + 64 };

/* "expression [unit]" into a function. applied: out, the expression in m, s and kg; NULL, not
 * needed. The expression must be one before brackets stand around it: "1) + (2" is none. */
static enum br_status read_expression(const struct br_scene_reader *r,
                                      const struct br_scene_key *key, const char *unit,
                                      const yaml_node_t *node, struct br_function *out,
                                      char *applied)
{
    char text[MOST_TEXT], own[MOST_APPLIED];
    struct br_unit found;
    enum br_status status = split_unit(r, key, unit, node, text, &found);
    if (!status)
        status = parse_expression(r, key, node, text, out);
    if (status)
        return status;
    char *whole = applied ? applied : own;
    if (!br_unit_apply(&found, text, whole, MOST_APPLIED))
        return br_scene_refuse(r, br_yaml_line(node), key->name, "has no room for its unit");
    if (strcmp(whole, text) == 0)
        return BR_OK;
    br_function_free(out);
    return parse_expression(r, key, node, whole, out);
}

/* An expression that must not use t (initial data) or x. */
static enum br_status forbid(const struct br_scene_reader *r, const struct br_scene_key *key,
                             const yaml_node_t *node, bool used, const char *variable)
{
    if (!used)
        return BR_OK;
    return br_scene_refuse(r, br_yaml_line(node), key->name,
                           "found '%s', expected an expression without %s", br_yaml_text(node),
                           variable);
}

static enum br_status read_function(const struct br_scene_reader *r, const struct br_scene_key *key,
                                    const yaml_node_t *node)
{
    struct br_function *f = (struct br_function *)((char *)r->scene + key->offset);
    const bool initial = key->kind == BR_KEY_INITIAL;
    const enum br_status status = read_expression(r, key, key->unit, node, f, NULL);
    return status ? status
                  : forbid(r, key, node, initial ? f->uses_t : f->uses_x, initial ? "t" : "x");
}

static enum br_status keep_text(const struct br_scene_reader *r, const struct br_scene_key *key,
                                const char *text)
{
    char **copy = (char **)((char *)r->scene + key->offset);
    *copy = br_allocate(strlen(text) + 1, 1);
    if (!*copy)
        return br_no_memory(r->err, "the scene");
    strcpy(*copy, text);
    return BR_OK;
}

/* An expression that is kept as text, too. */
static enum br_status read_solution(const struct br_scene_reader *r, const struct br_scene_key *key,
                                    const yaml_node_t *node)
{
    char text[MOST_APPLIED];
    const bool axial = key->offset == offsetof(struct br_scene, axial.solution);
    const enum br_status status = read_expression(
        r, key, key->unit, node, axial ? &r->scene->axial.given : &r->scene->bending.given, text);
    return status ? status : keep_text(r, key, text);
}

/* A product {shape: F(x), history: G(t)}. */
static enum br_status read_product(const struct br_scene_reader *r, const struct br_scene_key *key,
                                   const yaml_node_t *node, struct br_load *load)
{
    static const char *const expected = "expected 'shape: F(x) [1]' and 'history: G(t) [N/m]'";
    bool seen[2] = {false, false};
    for (yaml_node_pair_t *p = node->data.mapping.pairs.start; p < node->data.mapping.pairs.top;
         p++) {
        const yaml_node_t *name = yaml_document_get_node(r->document, p->key);
        const yaml_node_t *value = yaml_document_get_node(r->document, p->value);
        if (name->type != YAML_SCALAR_NODE || value->type != YAML_SCALAR_NODE)
            return br_scene_refuse(r, br_yaml_line(name), key->name, "%s", expected);
        const bool shape = strcmp(br_yaml_text(name), "shape") == 0;
        if (!shape && strcmp(br_yaml_text(name), "history") != 0)
            return br_scene_refuse(r, br_yaml_line(name), key->name, "found '%s', %s",
                                   br_yaml_text(name), expected);
        if (seen[shape])
            return br_scene_refuse(r, br_yaml_line(name), key->name, "'%s' is given twice",
                                   br_yaml_text(name));
        seen[shape] = true;
        struct br_function *f = shape ? &load->term[0].space : &load->term[0].time;
        enum br_status status = read_expression(r, key, shape ? "1" : "N/m", value, f, NULL);
        if (!status)
            status = shape ? forbid(r, key, value, f->uses_t, "t")
                           : forbid(r, key, value, f->uses_x, "x");
        if (status)
            return status;
    }
    if (!seen[0] || !seen[1])
        return br_scene_refuse(r, br_yaml_line(node), key->name, "%s", expected);
    return BR_OK;
}

/* A load: one expression, as the sum of products that it is. */
static enum br_status read_load(const struct br_scene_reader *r, const struct br_scene_key *key,
                                const yaml_node_t *node)
{
    struct br_load *load = (struct br_load *)((char *)r->scene + key->offset);
    if (node->type == YAML_MAPPING_NODE)
        return read_product(r, key, node, load);
    struct br_function f;
    const enum br_status status = read_expression(r, key, "N/m", node, &f, NULL);
    if (status)
        return status;
    return br_products(&f, load, r->err);
}

static enum br_status read_law(const struct br_scene_reader *r, const struct br_scene_key *key,
                               const yaml_node_t *node)
{
    for (int law = 0; law < BR_FRICTION_LAWS; law++)
        if (br_friction_law_names[law] &&
            strcmp(br_yaml_text(node), br_friction_law_names[law]) == 0) {
            r->scene->friction.law = (enum br_friction_law)law;
            return BR_OK;
        }
    return br_scene_refuse(r, br_yaml_line(node), key->name,
                           "found '%s', expected tresca or coulomb", br_yaml_text(node));
}

enum br_status br_scene_read_value(const struct br_scene_reader *r, const struct br_scene_key *key,
                                   const yaml_node_t *node)
{
    const bool product = key->kind == BR_KEY_LOAD && node->type == YAML_MAPPING_NODE;
    if (node->type != YAML_SCALAR_NODE && !product)
        return br_scene_refuse(r, br_yaml_line(node), key->name,
                               "found a list or a mapping, expected %s", key->help);
    switch (key->kind) {
    case BR_KEY_POSITIVE:
    case BR_KEY_NOT_NEGATIVE:
        return read_number(r, key, node);
    case BR_KEY_INITIAL:
    case BR_KEY_HISTORY:
        return read_function(r, key, node);
    case BR_KEY_LOAD:
        return read_load(r, key, node);
    case BR_KEY_SOLUTION:
        return read_solution(r, key, node);
    case BR_KEY_LAW:
        return read_law(r, key, node);
    case BR_KEY_SHAPE:
        return read_shape(r, key, node);
    case BR_KEY_TEXT:
    case BR_KEY_SECTION: /* read_entry has taken these */
    case BR_KEY_VERIFY:
        break;
    }
    return keep_text(r, key, br_yaml_text(node));
}
