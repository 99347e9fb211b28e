/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/scene/value.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "study/scene/expression.h"

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

/* Splits "value unit" in a copy of `text`: *unit points behind the number. */
static bool parse_number(const char *text, double *value, const char **unit)
{
    char *end;
    errno = 0;
    *value = strtod(text, &end);
    if (end == text || (*end && *end != ' ') || !isfinite(*value))
        return false;
    while (*end == ' ')
        end++;
    *unit = end;
    return true;
}

static enum br_status read_number(const struct br_scene_reader *r, const struct br_scene_key *key,
                                  const yaml_node_t *node)
{
    double value;
    const char *unit;
    if (!parse_number(br_yaml_text(node), &value, &unit))
        return br_scene_refuse(r, br_yaml_line(node), key->name,
                               "found '%s', expected a finite number in %s", br_yaml_text(node),
                               key->unit);
    if (strcmp(unit, key->unit) != 0)
        return br_scene_refuse(r, br_yaml_line(node), key->name,
                               "found '%s', expected a number and its unit, %s", br_yaml_text(node),
                               key->unit);
    const bool fits = key->kind == BR_KEY_POSITIVE ? value > 0 : value >= 0;
    if (!fits)
        return br_scene_refuse(r, br_yaml_line(node), key->name,
                               "found %s, expected a value %s 0 %s", br_yaml_text(node),
                               key->kind == BR_KEY_POSITIVE ? ">" : ">=", key->unit);
    *(double *)((char *)r->scene + key->offset) = value;
    return BR_OK;
}

enum { MOST_TEXT = 1024 };

/* Splits "expression [unit]": the expression goes into text. */
static enum br_status split_unit(const struct br_scene_reader *r, const struct br_scene_key *key,
                                 const char *unit, const yaml_node_t *node, char text[MOST_TEXT])
{
    const char *bracket = strrchr(br_yaml_text(node), '[');
    const size_t length = bracket ? (size_t)(bracket - br_yaml_text(node)) : 0;
    char expected[64];
    snprintf(expected, sizeof expected, "[%s]", unit);
    if (!bracket || strcmp(bracket, expected) != 0)
        return br_scene_refuse(r, br_yaml_line(node), key->name,
                               "found '%s', expected an expression and its unit, like 'x*t %s'",
                               br_yaml_text(node), expected);
    if (length >= MOST_TEXT)
        return br_scene_refuse(r, br_yaml_line(node), key->name, "longer than %d characters",
                               MOST_TEXT - 1);
    memcpy(text, br_yaml_text(node), length);
    text[length] = '\0';
    while (*text && text[strlen(text) - 1] == ' ')
        text[strlen(text) - 1] = '\0';
    return BR_OK;
}

/* "expression [unit]" into a function. */
static enum br_status read_expression(const struct br_scene_reader *r,
                                      const struct br_scene_key *key, const char *unit,
                                      const yaml_node_t *node, struct br_function *out)
{
    char text[MOST_TEXT];
    enum br_status status = split_unit(r, key, unit, node, text);
    if (status)
        return status;
    struct br_error inner = {0};
    status = br_expression(text, out, &inner);
    if (status == BR_BAD_INPUT)
        return br_scene_refuse(r, br_yaml_line(node), key->name, "%s", inner.message);
    return status ? br_fail(r->err, status, "%s", inner.message) : BR_OK;
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
    const enum br_status status = read_expression(r, key, key->unit, node, f);
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
    char text[MOST_TEXT];
    const bool axial = key->offset == offsetof(struct br_scene, axial.solution);
    enum br_status status = read_expression(
        r, key, key->unit, node, axial ? &r->scene->axial.given : &r->scene->bending.given);
    if (!status)
        status = split_unit(r, key, key->unit, node, text);
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
        enum br_status status = read_expression(r, key, shape ? "1" : "N/m", value, f);
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
    const enum br_status status = read_expression(r, key, "N/m", node, &f);
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
    case BR_KEY_TEXT:
    case BR_KEY_SECTION: /* read_entry has taken these */
    case BR_KEY_VERIFY:
        break;
    }
    return keep_text(r, key, br_yaml_text(node));
}
