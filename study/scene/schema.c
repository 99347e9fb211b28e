/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The format of scenes: its keys, a row each, and how the value of each kind is read. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/words.h"
#include "solver/laws.h"
#include "study/scene/units.h"
#include "study/scene/value.h"

#define AT(member) offsetof(struct br_scene, member)
#define OF(law) (1u << (law))

const struct br_scene_key br_scene_keys[] = {
    {"", "title", BR_KEY_TEXT, BR_REQUIRED, 0, "", AT(title), "one line for a person", "My scene"},
    {"", "remark", BR_KEY_TEXT, BR_OPTIONAL, 0, "", AT(remark),
     "a sentence to stand beside the results", "A sentence about it"},
    {"", "length", BR_KEY_POSITIVE, BR_REQUIRED, 0, "m", AT(length), "the beam's length L", "1 m"},
    {"", "duration", BR_KEY_POSITIVE, BR_REQUIRED, 0, "s", AT(duration), "the time interval T",
     "1 s"},
    {"", "density", BR_KEY_NOT_NEGATIVE, BR_OR_DERIVED, 0, "kg/m", AT(density),
     "mass per length rho", "0.1 kg/m"},
    {"", "mass_density", BR_KEY_NOT_NEGATIVE, BR_MAKES, 0, "kg/m^3", 0,
     "mass per volume; with area, instead of density", "7850 kg/m^3"},
    {"", "young", BR_KEY_POSITIVE, BR_MAKES, 0, "Pa", 0,
     "Young's modulus; with area and inertia, instead of the stiffnesses", "210 GPa"},
    {"", "area", BR_KEY_POSITIVE, BR_MAKES, 0, "m^2", 0, "area of the cross-section", "100 mm^2"},
    {"", "inertia", BR_KEY_POSITIVE, BR_MAKES, 0, "m^4", 0,
     "second moment of area of the cross-section", "208.3 mm^4"},
    {"", "section", BR_KEY_SHAPE, BR_MAKES, 0, "", 0,
     "rectangle WIDTH x HEIGHT, circle DIAMETER or tube DIAMETER x WALL, instead of area and "
     "inertia",
     "rectangle 20 mm x 5 mm"},
    {"", "axial", BR_KEY_SECTION, BR_OPTIONAL, 0, "", AT(axial.modelled), "the rod, u", ""},
    {"", "bending", BR_KEY_SECTION, BR_OPTIONAL, 0, "", AT(bending.modelled), "the beam, w", ""},
    {"", "contact", BR_KEY_SECTION, BR_OPTIONAL, 0, "", AT(contact.modelled),
     "normal compliance (10)", ""},
    {"", "friction", BR_KEY_SECTION, BR_OPTIONAL, 0, "", 0, "friction at the tip (12)", ""},
    {"", "verify", BR_KEY_VERIFY, BR_OPTIONAL, 0, "", 0, "what 'beamrate check' expects", ""},

    {"axial", "stiffness", BR_KEY_NOT_NEGATIVE, BR_OR_DERIVED, 0, "N", AT(axial.stiffness), "a1",
     "1000 N"},
    {"axial", "viscosity", BR_KEY_NOT_NEGATIVE, BR_OR_DERIVED, 0, "N s", AT(axial.viscosity), "c1",
     "10 N s"},
    {"axial", "relaxation_time", BR_KEY_NOT_NEGATIVE, BR_MAKES, 0, "s", 0,
     "viscosity/stiffness, instead of viscosity", "10 ms"},
    {"axial", "damping_ratio", BR_KEY_NOT_NEGATIVE, BR_MAKES, 0, "1", 0,
     "of the lowest mode, instead of viscosity", "2 %"},
    {"axial", "load", BR_KEY_LOAD, BR_OPTIONAL, 0, "N/m", AT(axial.load), "f_H(x, t)",
     "100*(exp(t) - 1) [N/m]"},
    {"axial", "tip_force", BR_KEY_HISTORY, BR_OPTIONAL, 0, "N", AT(axial.tip_force),
     "a force on the tip along the beam", "5*sin(t) [N]"},
    {"axial", "solution", BR_KEY_SOLUTION, BR_OPTIONAL, 0, "m", AT(axial.solution),
     "u(x, t), from which load, tip force and initial data are derived", "0.1*sin(8*x)*t^2 [m]"},
    {"axial", "displacement", BR_KEY_INITIAL, BR_OPTIONAL, 0, "m", AT(axial.displacement), "u_0(x)",
     "0.01*sin(pi*x/2) [m]"},
    {"axial", "velocity", BR_KEY_INITIAL, BR_OPTIONAL, 0, "m/s", AT(axial.velocity), "v_0(x)",
     "2*sin(pi*x/2) [m/s]"},

    {"bending", "stiffness", BR_KEY_NOT_NEGATIVE, BR_OR_DERIVED, 0, "N m^2", AT(bending.stiffness),
     "a2", "1000 N m^2"},
    {"bending", "viscosity", BR_KEY_NOT_NEGATIVE, BR_OR_DERIVED, 0, "N m^2 s",
     AT(bending.viscosity), "c2", "10 N m^2 s"},
    {"bending", "relaxation_time", BR_KEY_NOT_NEGATIVE, BR_MAKES, 0, "s", 0,
     "viscosity/stiffness, instead of viscosity", "10 ms"},
    {"bending", "damping_ratio", BR_KEY_NOT_NEGATIVE, BR_MAKES, 0, "1", 0,
     "of the lowest mode, instead of viscosity", "2 %"},
    {"bending", "load", BR_KEY_LOAD, BR_OPTIONAL, 0, "N/m", AT(bending.load), "f_V(x, t)",
     "-1000*x*sin(3*t) [N/m]"},
    {"bending", "tip_force", BR_KEY_HISTORY, BR_OPTIONAL, 0, "N", AT(bending.tip_force),
     "a force on the tip across the beam", "2*sin(3*t) [N]"},
    {"bending", "tip_moment", BR_KEY_HISTORY, BR_OPTIONAL, 0, "N m", AT(bending.tip_moment),
     "a moment on the tip", "2*sin(2*t) [N m]"},
    {"bending", "solution", BR_KEY_SOLUTION, BR_OPTIONAL, 0, "m", AT(bending.solution),
     "w(x, t), from which load, tip forces and initial data are derived",
     "0.1*(1 - cos(12*x))*exp(-t) [m]"},
    {"bending", "stick_force", BR_KEY_HISTORY, BR_OPTIONAL, 0, "N", AT(bending.stick_force),
     "the friction force of a solution while its tip rests", "3*cos(2*t) [N]"},
    {"bending", "displacement", BR_KEY_INITIAL, BR_OPTIONAL, 0, "m", AT(bending.displacement),
     "w_0(x)", "0.02*x^2 [m]"},
    {"bending", "displacement_slope", BR_KEY_INITIAL, BR_OPTIONAL, 0, "1",
     AT(bending.displacement_slope), "the derivative of w_0", "0.04*x [1]"},
    {"bending", "velocity", BR_KEY_INITIAL, BR_OPTIONAL, 0, "m/s", AT(bending.velocity),
     "the initial bending velocity", "0.2*x^2 [m/s]"},
    {"bending", "velocity_slope", BR_KEY_INITIAL, BR_OPTIONAL, 0, "1/s", AT(bending.velocity_slope),
     "the derivative of the initial bending velocity", "0.4*x [1/s]"},

    {"contact", "gap", BR_KEY_NOT_NEGATIVE, BR_REQUIRED, 0, "m", AT(contact.gap), "g", "0.01 m"},
    {"contact", "stiffness", BR_KEY_NOT_NEGATIVE, BR_REQUIRED, 0, "N/m", AT(contact.stiffness),
     "c_H", "1000 N/m"},

    {"friction", "law", BR_KEY_LAW, BR_REQUIRED, 0, "", 0, "", "coulomb"},
    {"friction", "bound", BR_KEY_NOT_NEGATIVE, BR_REQUIRED, OF(BR_TRESCA), "N",
     AT(friction.coefficient), "c_V of Tresca's law", "100 N"},
    {"friction", "coefficient", BR_KEY_NOT_NEGATIVE, BR_OR_RATIO, OF(BR_COULOMB), "N/m",
     AT(friction.coefficient), "c_V of Coulomb's law, or without unit c_V/c_H", "1e4 N/m"},
    {"friction", "regularisation", BR_KEY_NOT_NEGATIVE, BR_OPTIONAL, 0, "m/s",
     AT(friction.regularisation), "mu of (29)", "1e-8 m/s"},
    {0},
};
_Static_assert(sizeof br_scene_keys / sizeof *br_scene_keys <= BR_MOST_SCENE_KEYS,
               "struct br_scene_given has no room");

const char *br_scene_key_help(const struct br_scene_key *key, char text[BR_KEY_HELP])
{
    return key->kind == BR_KEY_LAW ? br_words_join(&br_friction_words, " or ", text, BR_KEY_HELP)
                                   : key->help;
}

size_t br_scene_row(const char *path)
{
    const char *dot = strchr(path, '.');
    const size_t length = dot ? (size_t)(dot - path) : 0;
    size_t row = 0;
    while (strlen(br_scene_keys[row].section) != length ||
           strncmp(br_scene_keys[row].section, path, length) != 0 ||
           strcmp(br_scene_keys[row].name, dot ? dot + 1 : path) != 0)
        row++;
    return row;
}

/* ---- values: numbers ---- */

/* unknown: the text that is no unit; NULL: it is `found`. */
static enum br_status refuse_unit(const struct br_scene_value *v, const char *unknown,
                                  const struct br_unit *found, const struct br_unit *wanted)
{
    char text[2][BR_DIMENSION_TEXT], words[BR_UNIT_WORDS], suggestion[BR_SUGGESTION];
    const char *expected = br_dimension_words(wanted->of, text[0]);
    const char *value = br_yaml_text(v->node);
    const char *ratio = v->key->need == BR_OR_RATIO ? ", or a number without unit" : "";
    if (!unknown)
        return BR_REFUSE_VALUE(v, "found '%s', which is %s, expected %s, as %s%s", value,
                               br_dimension_words(found->of, text[1]), expected, v->unit, ratio);
    return BR_REFUSE_VALUE(
        v,
        "found '%s', expected a number and its unit, %s%s%s%s%s%s, or another unit of %s, "
        "made of %s, with prefixes from n to T%s",
        value, v->unit, *unknown ? "" : ", as in ", *unknown ? "" : value, *unknown ? "" : " ",
        *unknown ? "" : v->unit, ratio, expected, br_unit_words(words),
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

enum br_status br_scene_read_quantity(struct br_scene_value *v, const char *text, const char *end,
                                      struct br_si_number *q)
{
    enum { MOST_UNIT = 64 };
    char word[MOST_UNIT];
    double value;
    struct br_unit unit;
    const char *behind = br_read_number(text, &value);
    const size_t length = !behind                ? 0
                          : end && end >= behind ? (size_t)(end - behind)
                                                 : strlen(behind);
    if (!behind || (*behind && strchr(".,", *behind)) || length >= MOST_UNIT)
        return BR_REFUSE_VALUE(v, "found '%s', expected a finite number in %s%s",
                               br_yaml_text(v->node), v->unit,
                               behind && *behind == ',' ? ", with a point before decimals" : "");
    snprintf(word, sizeof word, "%.*s", (int)length, behind);
    const enum br_status status = br_scene_read_unit(v, word + strspn(word, " "), &unit);
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
    const enum br_status status = br_scene_read_quantity(v, br_yaml_text(v->node), NULL, &q);
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

enum br_status br_scene_keep_text(const struct br_scene_value *v, const char *text)
{
    char **copy = br_scene_target(v);
    *copy = br_allocate(strlen(text) + 1, 1);
    if (!*copy)
        return br_no_memory(v->r->yaml.err, "the scene");
    strcpy(*copy, text);
    return BR_OK;
}

/* ---- values of all kinds ---- */

static enum br_status read_law(const struct br_scene_value *v)
{
    const char *text = br_yaml_text(v->node);
    struct br_error inner = {0};
    size_t row;
    if (br_words_read(&br_friction_words, text, strlen(text), &row, &inner))
        return BR_REFUSE_VALUE(v, "%s", inner.message);
    v->r->scene->friction.law = (enum br_friction_law)(row + 1);
    return BR_OK;
}

enum br_status br_scene_read_value(const struct br_scene_reader *r, const struct br_scene_key *key,
                                   const yaml_node_t *node)
{
    struct br_scene_value v = {r, key, node, key->unit, false};
    const bool product = key->kind == BR_KEY_LOAD && node->type == YAML_MAPPING_NODE;
    if (node->type != YAML_SCALAR_NODE && !product)
        return BR_REFUSE_VALUE(&v, "found a list or a mapping, expected %s",
                               br_scene_key_help(key, (char[BR_KEY_HELP]){0}));
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
        return br_scene_read_shape(&v);
    case BR_KEY_TEXT:
    case BR_KEY_SECTION: /* read_key handles sections and `verify` */
    case BR_KEY_VERIFY:
        break;
    }
    return br_scene_keep_text(&v, br_yaml_text(node));
}
