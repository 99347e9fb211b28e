/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/scene/value.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "study/base/words.h"
#include "study/scene/units.h"

/* ---- numbers ---- */

/* unknown: the text that is no unit; NULL: it is `found`. */
static enum br_status refuse_unit(const struct br_scene_value *v, const char *unknown,
                                  const struct br_unit *found, const struct br_unit *wanted)
{
    char text[2][BR_DIMENSION_TEXT], words[BR_UNIT_WORDS], suggestion[BR_SUGGESTION];
    const char *expected = br_dimension_words(wanted->of, text[0]);
    const char *ratio = v->key->need == BR_OR_RATIO ? ", or a number without unit" : "";
    if (!unknown)
        return BR_REFUSE_VALUE(v, "found '%s', which is %s, expected %s, as %s%s",
                               br_yaml_text(v->node), br_dimension_words(found->of, text[1]),
                               expected, v->unit, ratio);
    return BR_REFUSE_VALUE(
        v,
        "found '%s', expected a number and its unit, %s%s, or another unit of %s, "
        "made of %s, with prefixes from n to T%s",
        br_yaml_text(v->node), v->unit, ratio, expected, br_unit_words(words),
        br_unit_suggestion(unknown, wanted->of, suggestion));
}

/* Reads any unit of the expected dimension. */
enum br_status br_scene_read_unit(struct br_scene_value *v, const char *text, struct br_unit *unit)
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
static enum br_status read_quantity(struct br_scene_value *v, const char *text, const char *end,
                                    struct br_si_number *q)
{
    enum { MOST_UNIT = 64 };
    char *behind, word[MOST_UNIT];
    struct br_unit unit;
    const double value = strtod(text, &behind);
    const size_t length = end && end >= behind ? (size_t)(end - behind) : strlen(behind);
    const size_t blanks = strspn(behind, " ");
    if (behind == text || (*behind && *behind != ' ') || !isfinite(value) || length >= MOST_UNIT)
        return BR_REFUSE_VALUE(v, "found '%s', expected a finite number in %s",
                               br_yaml_text(v->node), v->unit);
    snprintf(word, sizeof word, "%.*s", (int)length, behind);
    const enum br_status status =
        br_scene_read_unit(v, word + (blanks < length ? blanks : length), &unit);
    if (status)
        return status;
    if (br_unit_convert(&unit, text, (size_t)(behind - text), q) && isfinite(q->value))
        return BR_OK;
    return BR_REFUSE_VALUE(v, "found '%s', expected a finite number of at most 400 letters in %s",
                           br_yaml_text(v->node), v->unit);
}

static enum br_status read_number(struct br_scene_value *v)
{
    const struct br_scene_key *key = v->key;
    const bool positive = key->kind == BR_KEY_POSITIVE;
    struct br_si_number q;
    const enum br_status status = read_quantity(v, br_yaml_text(v->node), NULL, &q);
    if (status)
        return status;
    if (!(positive ? q.value > 0 : q.value >= 0))
        return BR_REFUSE_VALUE(v, "found %s, expected a value %s 0 %s", br_yaml_text(v->node),
                               positive ? ">" : ">=", key->unit);
    struct br_scene_number *given = &v->r->given->row[key - br_scene_keys];
    given->value = q.wide;
    given->ratio = v->ratio;
    if (key->need != BR_MAKES && !v->ratio)
        *(double *)br_scene_target(v) = q.value;
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
static enum br_status read_shape(struct br_scene_value *v)
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
        return BR_REFUSE_VALUE(v, "found '%s', expected %s%s", text, v->key->help, suggestion);
    v->unit = "m";
    enum br_status status = read_quantity(v, text + length + 1, cross, &a);
    if (!status && cross)
        status = read_quantity(v, cross + strlen(" x "), NULL, &b);
    if (status)
        return status;
    if (!(a.wide > 0 && (b.wide > 0 || shape == 1) && (shape != 2 || 2 * b.wide < a.wide)))
        return BR_REFUSE_VALUE(
            v,
            "found '%s', expected lengths above 0, and the wall of a tube below its "
            "radius",
            text);
    set_shape(&v->r->given->row[v->key - br_scene_keys], shape == 0, a.wide, b.wide);
    return BR_OK;
}

enum br_status br_scene_keep_text(const struct br_scene_value *v, const char *text)
{
    char **copy = br_scene_target(v);
    *copy = br_allocate(strlen(text) + 1, 1);
    if (!*copy)
        return br_no_memory(v->r->err, "the scene");
    strcpy(*copy, text);
    return BR_OK;
}

static enum br_status read_law(const struct br_scene_value *v)
{
    const char *text = br_yaml_text(v->node);
    char expected[BR_EXPECTED];
    for (int law = 0; law < BR_FRICTION_LAWS; law++)
        if (br_friction_law_names[law] && strcmp(text, br_friction_law_names[law]) == 0) {
            v->r->scene->friction.law = (enum br_friction_law)law;
            return BR_OK;
        }
    return BR_REFUSE_VALUE(
        v, "found '%s', %s", text,
        br_expected(text, br_friction_law_names + 1, BR_FRICTION_LAWS - 1, expected));
}

enum br_status br_scene_read_value(const struct br_scene_reader *r, const struct br_scene_key *key,
                                   const yaml_node_t *node)
{
    struct br_scene_value v = {r, key, node, key->unit, false};
    const bool product = key->kind == BR_KEY_LOAD && node->type == YAML_MAPPING_NODE;
    if (node->type != YAML_SCALAR_NODE && !product)
        return BR_REFUSE_VALUE(&v, "found a list or a mapping, expected %s", key->help);
    switch (key->kind) {
    case BR_KEY_POSITIVE:
    case BR_KEY_NOT_NEGATIVE:
        return read_number(&v);
    case BR_KEY_INITIAL:
    case BR_KEY_HISTORY:
    case BR_KEY_LOAD:
    case BR_KEY_SOLUTION:
        return br_scene_read_expression(&v);
    case BR_KEY_LAW:
        return read_law(&v);
    case BR_KEY_SHAPE:
        return read_shape(&v);
    case BR_KEY_TEXT:
    case BR_KEY_SECTION: /* read_key handles sections and `verify` */
    case BR_KEY_VERIFY:
        break;
    }
    return br_scene_keep_text(&v, br_yaml_text(node));
}
