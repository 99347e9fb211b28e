/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/scene/value.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "study/base/words.h"
#include "study/known/expression.h"
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
    /* A long value must not hide what was expected, which is at the end of the text. */
    enum { HEAD = 200, TAIL = 400 };
    if (length > HEAD + TAIL)
        br_fail(r->err, BR_BAD_INPUT, "%s:%zu: %.100s: %.*s ... %s", r->path, line, key, HEAD, text,
                text + length - TAIL);
    else
        br_fail(r->err, BR_BAD_INPUT, "%s:%zu: %.100s: %s", r->path, line, key, text);
    free(text);
    return BR_BAD_INPUT;
}

enum br_status br_scene_pass_on(const struct br_scene_reader *r, size_t line, const char *key,
                                const struct br_error *inner)
{
    if (inner->status == BR_BAD_INPUT)
        return br_scene_refuse(r, line, key, "%s", inner->message);
    return inner->status ? br_fail(r->err, inner->status, "%s", inner->message) : BR_OK;
}

size_t br_yaml_line(const yaml_node_t *node)
{
    return node->start_mark.line + 1;
}

const char *br_yaml_text(const yaml_node_t *node)
{
    return (const char *)node->data.scalar.value;
}

/* The value that is read. */
struct value {
    const struct br_scene_reader *r;
    const struct br_scene_key *key;
    const yaml_node_t *node;
    const char *unit; /* the expected unit */
    bool ratio;       /* a number without unit was found, and the key accepts it */
};

#define REFUSE(v, ...) br_scene_refuse((v)->r, br_yaml_line((v)->node), (v)->key->name, __VA_ARGS__)

/* The key's member of the scene. */
static void *target(const struct value *v)
{
    return (char *)v->r->scene + v->key->offset;
}

/* ---- numbers ---- */

/* unknown: the text that is no unit; NULL: it is `found`. */
static enum br_status refuse_unit(const struct value *v, const char *unknown,
                                  const struct br_unit *found, const struct br_unit *wanted)
{
    char text[2][BR_DIMENSION_TEXT], words[BR_UNIT_WORDS], suggestion[BR_SUGGESTION];
    const char *expected = br_dimension_words(wanted->of, text[0]);
    const char *ratio = v->key->need == BR_OR_RATIO ? ", or a number without unit" : "";
    if (!unknown)
        return REFUSE(v, "found '%s', which is %s, expected %s, as %s%s", br_yaml_text(v->node),
                      br_dimension_words(found->of, text[1]), expected, v->unit, ratio);
    return REFUSE(v,
                  "found '%s', expected a number and its unit, %s%s, or another unit of %s, "
                  "made of %s, with prefixes from n to T%s",
                  br_yaml_text(v->node), v->unit, ratio, expected, br_unit_words(words),
                  br_unit_suggestion(unknown, wanted->of, suggestion));
}

/* Reads any unit of the expected dimension. */
static enum br_status read_unit(struct value *v, const char *text, struct br_unit *unit)
{
    struct br_unit wanted;
    br_unit_read(v->unit, &wanted);
    const bool known = br_unit_read(text, unit);
    if (known && br_dimension_is(unit->of, wanted.of))
        return BR_OK;
    v->ratio = known && v->key->need == BR_OR_RATIO &&
               br_dimension_is(unit->of, (struct br_dimension){0, 0, 0});
    return v->ratio ? BR_OK : refuse_unit(v, known && *text ? NULL : text, unit, &wanted);
}

/* Reads "value unit", as far as `end`, which points into the text; NULL: to the end of the text. */
static enum br_status read_quantity(struct value *v, const char *text, const char *end,
                                    struct br_si_number *q)
{
    enum { MOST_UNIT = 64 };
    char *behind, word[MOST_UNIT];
    struct br_unit unit;
    const double value = strtod(text, &behind);
    const size_t length = end && end >= behind ? (size_t)(end - behind) : strlen(behind);
    const size_t blanks = strspn(behind, " ");
    if (behind == text || (*behind && *behind != ' ') || !isfinite(value) || length >= MOST_UNIT)
        return REFUSE(v, "found '%s', expected a finite number in %s", br_yaml_text(v->node),
                      v->unit);
    snprintf(word, sizeof word, "%.*s", (int)length, behind);
    const enum br_status status = read_unit(v, word + (blanks < length ? blanks : length), &unit);
    if (status)
        return status;
    if (br_unit_convert(&unit, text, (size_t)(behind - text), q) && isfinite(q->value))
        return BR_OK;
    return REFUSE(v, "found '%s', expected a finite number of at most 400 letters in %s",
                  br_yaml_text(v->node), v->unit);
}

static enum br_status read_number(struct value *v)
{
    const struct br_scene_key *key = v->key;
    const bool positive = key->kind == BR_KEY_POSITIVE;
    struct br_si_number q;
    const enum br_status status = read_quantity(v, br_yaml_text(v->node), NULL, &q);
    if (status)
        return status;
    if (!(positive ? q.value > 0 : q.value >= 0))
        return REFUSE(v, "found %s, expected a value %s 0 %s", br_yaml_text(v->node),
                      positive ? ">" : ">=", key->unit);
    struct br_scene_number *given = &v->r->given->row[key - br_scene_keys];
    given->value = q.wide;
    given->ratio = v->ratio;
    if (key->need != BR_MAKES && !v->ratio)
        *(double *)target(v) = q.value;
    return BR_OK;
}

/* ---- cross-sections ---- */

/* Area and second moment of area for bending in the direction of w. a, b: width and height of a
 * rectangle, diameter and wall of a tube; b is 0 for a circle. The formulas of a tube avoid a
 * difference of powers: (D^4 - d^4)/64 = (D^2 - d^2)/4 (D^2 + d^2)/16, with D - d = 2 b. */
static void set_shape(struct br_scene_number *to, bool rectangle, long double a, long double b)
{
    const long double pi = 3.141592653589793238463L, inner = b > 0 ? a - 2 * b : 0;
    const long double area = rectangle ? a * b : b > 0 ? pi * b * (a - b) : pi * a * a / 4;
    to->value = area;
    to->second = rectangle ? area * b * b / 12 : area * (a * a + inner * inner) / 16;
}

/* "rectangle 20 mm x 5 mm", "circle 10 mm", "tube 20 mm x 2 mm" */
static enum br_status read_shape(struct value *v)
{
    static const char *const words[] = {"rectangle", "circle", "tube"};
    const char *text = br_yaml_text(v->node), *cross = strstr(text, " x ");
    const size_t length = strcspn(text, " ");
    struct br_si_number a, b = {0, 0};
    size_t shape = 0;
    char word[32], suggestion[BR_SUGGESTION] = "";
    snprintf(word, sizeof word, "%.*s", (int)(length < 31 ? length : 31), text);
    while (shape < 3 && strcmp(word, words[shape]) != 0)
        shape++;
    if (shape == 3)
        br_suggestion(word, words, 3, suggestion);
    if (shape == 3 || !text[length] || (shape == 1) == (cross != NULL))
        return REFUSE(v, "found '%s', expected %s%s", text, v->key->help, suggestion);
    v->unit = "m";
    enum br_status status = read_quantity(v, text + length + 1, cross, &a);
    if (!status && cross)
        status = read_quantity(v, cross + strlen(" x "), NULL, &b);
    if (status)
        return status;
    if (!(a.wide > 0 && (b.wide > 0 || shape == 1) && (shape != 2 || 2 * b.wide < a.wide)))
        return REFUSE(v,
                      "found '%s', expected lengths above 0, and the wall of a tube below its "
                      "radius",
                      text);
    set_shape(&v->r->given->row[v->key - br_scene_keys], shape == 0, a.wide, b.wide);
    return BR_OK;
}

/* ---- expressions ---- */

/* Room for the text of an expression, and for the text in m, s and kg. */
enum { MOST_TEXT = 1024, MOST_APPLIED = MOST_TEXT + 64 };

/* Splits "expression [unit]". text (out): the expression. */
static enum br_status split_unit(struct value *v, char text[MOST_TEXT], struct br_unit *found)
{
    const char *whole = br_yaml_text(v->node), *bracket = strrchr(whole, '[');
    size_t length = bracket ? (size_t)(bracket - whole) : 0;
    char word[64] = "";
    if (bracket)
        snprintf(word, sizeof word, "%s", bracket + 1);
    char *end = strchr(word, ']');
    if (!end || end == word || end[1])
        return REFUSE(v, "found '%s', expected an expression and its unit, like 'x*t [%s]'", whole,
                      v->unit);
    *end = '\0';
    const enum br_status status = read_unit(v, word, found);
    if (status)
        return status;
    if (length >= MOST_TEXT)
        return REFUSE(v, "longer than %d characters", MOST_TEXT - 1);
    while (length && whole[length - 1] == ' ')
        length--;
    snprintf(text, MOST_TEXT, "%.*s", (int)length, whole);
    return BR_OK;
}

static enum br_status parse_expression(const struct value *v, const char *text,
                                       struct br_function *out)
{
    struct br_error inner = {0};
    br_expression(text, out, &inner);
    return br_scene_pass_on(v->r, br_yaml_line(v->node), v->key->name, &inner);
}

/* Reads "expression [unit]" as a function. applied (out): the expression in m, s and kg. The
 * expression is parsed before brackets are put around it, so that "1) + (2" is refused. */
static enum br_status read_expression(struct value *v, struct br_function *out,
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
        return REFUSE(v, "has no room for its unit");
    if (strcmp(applied, text) == 0)
        return BR_OK;
    br_function_free(out);
    return parse_expression(v, applied, out);
}

/* An expression that must not use t (of_x) or x. */
static enum br_status read_function(struct value *v, bool of_x, struct br_function *f)
{
    char applied[MOST_APPLIED];
    const enum br_status status = read_expression(v, f, applied);
    if (status || !(of_x ? f->uses_t : f->uses_x))
        return status;
    return REFUSE(v, "found '%s', expected an expression without %s", br_yaml_text(v->node),
                  of_x ? "t" : "x");
}

static enum br_status keep_text(const struct value *v, const char *text)
{
    char **copy = target(v);
    *copy = br_allocate(strlen(text) + 1, 1);
    if (!*copy)
        return br_no_memory(v->r->err, "the scene");
    strcpy(*copy, text);
    return BR_OK;
}

/* Reads an expression, and keeps its text, too. */
static enum br_status read_solution(struct value *v)
{
    char text[MOST_APPLIED];
    struct br_scene *scene = v->r->scene;
    const bool axial = v->key->offset == offsetof(struct br_scene, axial.solution);
    const enum br_status status =
        read_expression(v, &scene->field[axial ? BR_AXIAL : BR_BENDING].given, text);
    return status ? status : keep_text(v, text);
}

/* A product {shape: F(x), history: G(t)}. */
static enum br_status read_product(const struct value *v, struct br_load *load)
{
    static const char *const expected = "expected 'shape: F(x) [1]' and 'history: G(t) [N/m]'";
    static const char *const words[] = {"shape", "history"};
    char suggestion[BR_SUGGESTION];
    bool seen[2] = {false, false};
    const yaml_node_pair_t *end = v->node->data.mapping.pairs.top;
    for (const yaml_node_pair_t *p = v->node->data.mapping.pairs.start; p < end; p++) {
        const yaml_node_t *name = yaml_document_get_node(v->r->document, p->key);
        struct value factor = *v, at = *v;
        factor.node = yaml_document_get_node(v->r->document, p->value);
        at.node = name;
        if (name->type != YAML_SCALAR_NODE || factor.node->type != YAML_SCALAR_NODE)
            return REFUSE(&at, "%s", expected);
        const bool shape = strcmp(br_yaml_text(name), "shape") == 0;
        if (!shape && strcmp(br_yaml_text(name), "history") != 0)
            return REFUSE(&at, "found '%s', %s%s", br_yaml_text(name), expected,
                          br_suggestion(br_yaml_text(name), words, 2, suggestion));
        if (seen[shape])
            return REFUSE(&at, "'%s' is given twice", br_yaml_text(name));
        seen[shape] = true;
        factor.unit = shape ? "1" : v->unit;
        const enum br_status status =
            read_function(&factor, shape, shape ? &load->term[0].space : &load->term[0].time);
        if (status)
            return status;
    }
    return seen[0] && seen[1] ? BR_OK : REFUSE(v, "%s", expected);
}

/* A load: a product, or an expression, which is split into a sum of products. */
static enum br_status read_load(struct value *v)
{
    char applied[MOST_APPLIED];
    struct br_function f;
    if (v->node->type == YAML_MAPPING_NODE)
        return read_product(v, target(v));
    const enum br_status status = read_expression(v, &f, applied);
    return status ? status : br_products(&f, target(v), v->r->err);
}

static enum br_status read_law(const struct value *v)
{
    const char *text = br_yaml_text(v->node);
    char expected[BR_EXPECTED];
    for (int law = 0; law < BR_FRICTION_LAWS; law++)
        if (br_friction_law_names[law] && strcmp(text, br_friction_law_names[law]) == 0) {
            v->r->scene->friction.law = (enum br_friction_law)law;
            return BR_OK;
        }
    return REFUSE(v, "found '%s', %s", text,
                  br_expected(text, br_friction_law_names + 1, BR_FRICTION_LAWS - 1, expected));
}

enum br_status br_scene_read_value(const struct br_scene_reader *r, const struct br_scene_key *key,
                                   const yaml_node_t *node)
{
    struct value v = {r, key, node, key->unit, false};
    const bool product = key->kind == BR_KEY_LOAD && node->type == YAML_MAPPING_NODE;
    if (node->type != YAML_SCALAR_NODE && !product)
        return REFUSE(&v, "found a list or a mapping, expected %s", key->help);
    switch (key->kind) {
    case BR_KEY_POSITIVE:
    case BR_KEY_NOT_NEGATIVE:
        return read_number(&v);
    case BR_KEY_INITIAL:
    case BR_KEY_HISTORY:
        return read_function(&v, key->kind == BR_KEY_INITIAL, target(&v));
    case BR_KEY_LOAD:
        return read_load(&v);
    case BR_KEY_SOLUTION:
        return read_solution(&v);
    case BR_KEY_LAW:
        return read_law(&v);
    case BR_KEY_SHAPE:
        return read_shape(&v);
    case BR_KEY_TEXT:
    case BR_KEY_SECTION: /* read_key handles sections and `verify` */
    case BR_KEY_VERIFY:
        break;
    }
    return keep_text(&v, br_yaml_text(node));
}
