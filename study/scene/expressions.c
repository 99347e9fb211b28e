/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Values of a scene that are expressions: functions, solutions, loads. */
#include <stdio.h>
#include <string.h>

#include "base/words.h"
#include "study/known/expression.h"
#include "study/scene/units.h"
#include "study/scene/value.h"

/* Room for the text of an expression, and for the text in m, s and kg. */
enum { MOST_TEXT = 1024, MOST_APPLIED = MOST_TEXT + 64 };

/* "; did you mean '150 [N/m]'?" of an expression whose unit has no brackets; returns text (out). */
static const char *suggest_brackets(const struct br_scene_value *v, const char *whole,
                                    char text[BR_SUGGESTION])
{
    struct br_unit wanted, unit;
    *text = '\0';
    br_unit_read(v->unit, &wanted);
    for (const char *at = strchr(whole, ' '); at && !*text; at = strchr(at + 1, ' '))
        if (br_unit_read(at + 1, &unit) && at[1] && br_dimension_is(unit.of, wanted.of))
            br_append(text, BR_SUGGESTION, "; did you mean '%.*s [%s]'?", (int)(at - whole), whole,
                      at + 1);
    return text;
}

/* Splits "expression [unit]". text (out): the expression. */
static enum br_status split_unit(struct br_scene_value *v, char text[MOST_TEXT],
                                 struct br_unit *found)
{
    const char *whole = br_yaml_text(v->node), *bracket = strrchr(whole, '[');
    size_t length = bracket ? (size_t)(bracket - whole) : 0;
    char word[64] = "", meant[BR_SUGGESTION];
    if (bracket)
        snprintf(word, sizeof word, "%s", bracket + 1);
    char *end = strchr(word, ']');
    if (!end || end == word || end[1])
        return BR_REFUSE_VALUE(v,
                               "found '%s', expected an expression and its unit in brackets, like "
                               "'x*t [%s]'%s",
                               whole, v->unit, suggest_brackets(v, whole, meant));
    *end = '\0';
    const enum br_status status = br_scene_read_unit(v, word, found);
    if (status)
        return status;
    if (length >= MOST_TEXT)
        return BR_REFUSE_VALUE(v, "longer than %d characters", MOST_TEXT - 1);
    while (length && whole[length - 1] == ' ')
        length--;
    snprintf(text, MOST_TEXT, "%.*s", (int)length, whole);
    return BR_OK;
}

static enum br_status parse_expression(const struct br_scene_value *v, const char *text,
                                       struct br_function *out)
{
    struct br_error inner = {0};
    br_expression(text, out, &inner);
    return br_scene_pass_on(v->r, br_yaml_line(v->node), v->key->name, &inner);
}

/* Reads "expression [unit]" as a function. applied (out): the expression in m, s and kg. The
 * expression is parsed before brackets are put around it, so that "1) + (2" is refused. */
static enum br_status read_expression(struct br_scene_value *v, struct br_function *out,
                                      char applied[MOST_APPLIED])
{
    char text[MOST_TEXT];
    struct br_unit found;
    enum br_status status = split_unit(v, text, &found);
    if (!status)
        status = parse_expression(v, text, out);
    if (status)
        return status;
    if (!br_unit_apply(&found, text, applied, MOST_APPLIED))
        return BR_REFUSE_VALUE(v, "has no room for its unit");
    if (strcmp(applied, text) == 0)
        return BR_OK;
    br_function_free(out);
    return parse_expression(v, applied, out);
}

/* An expression that must not use t (of_x) or x. */
static enum br_status read_function(struct br_scene_value *v, bool of_x, struct br_function *f)
{
    char applied[MOST_APPLIED];
    const enum br_status status = read_expression(v, f, applied);
    if (status || !(of_x ? f->uses_t : f->uses_x))
        return status;
    return BR_REFUSE_VALUE(v, "found '%s', expected an expression without %s",
                           br_yaml_text(v->node), of_x ? "t" : "x");
}

/* Reads an expression, and keeps its text, too. */
static enum br_status read_solution(struct br_scene_value *v)
{
    char text[MOST_APPLIED];
    struct br_scene *scene = v->r->scene;
    const bool axial = v->key->offset == offsetof(struct br_scene, axial.solution);
    const enum br_status status =
        read_expression(v, &scene->field[axial ? BR_AXIAL : BR_BENDING].given, text);
    return status ? status : br_scene_keep_text(v, text);
}

/* A product {shape: F(x), history: G(t)}. */
static enum br_status read_product(const struct br_scene_value *v, struct br_load *load)
{
    static const char *const expected = "expected 'shape: F(x) [1]' and 'history: G(t) [N/m]'";
    static const char *const words[] = {"shape", "history"};
    char suggestion[BR_SUGGESTION];
    bool found[2] = {false, false};
    const yaml_node_pair_t *end = v->node->data.mapping.pairs.top;
    for (const yaml_node_pair_t *p = v->node->data.mapping.pairs.start; p < end; p++) {
        const yaml_node_t *name = yaml_document_get_node(v->r->yaml.document, p->key);
        struct br_scene_value factor = *v, at = *v;
        factor.node = yaml_document_get_node(v->r->yaml.document, p->value);
        at.node = name;
        if (name->type != YAML_SCALAR_NODE || factor.node->type != YAML_SCALAR_NODE)
            return BR_REFUSE_VALUE(&at, "%s", expected);
        const bool shape = strcmp(br_yaml_text(name), "shape") == 0;
        if (!shape && strcmp(br_yaml_text(name), "history") != 0)
            return BR_REFUSE_VALUE(&at, "found '%s', %s%s", br_yaml_text(name), expected,
                                   br_suggestion(br_yaml_text(name), words, 2, suggestion));
        if (found[shape])
            return BR_REFUSE_VALUE(&at, "'%s' is given twice", br_yaml_text(name));
        found[shape] = true;
        factor.unit = shape ? "1" : v->unit;
        const enum br_status status =
            read_function(&factor, shape, shape ? &load->term[0].space : &load->term[0].time);
        if (status)
            return status;
    }
    return found[0] && found[1] ? BR_OK : BR_REFUSE_VALUE(v, "%s", expected);
}

/* A load: a product, or an expression, which is split into a sum of products. */
static enum br_status read_load(struct br_scene_value *v)
{
    char applied[MOST_APPLIED];
    struct br_function f;
    if (v->node->type == YAML_MAPPING_NODE)
        return read_product(v, br_scene_target(v));
    const enum br_status status = read_expression(v, &f, applied);
    return status ? status : br_products(&f, br_scene_target(v), v->r->yaml.err);
}

enum br_status br_scene_read_expression(struct br_scene_value *v)
{
    if (v->key->kind == BR_KEY_LOAD)
        return read_load(v);
    if (v->key->kind == BR_KEY_SOLUTION)
        return read_solution(v);
    return read_function(v, v->key->kind == BR_KEY_INITIAL, br_scene_target(v));
}
