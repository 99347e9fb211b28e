/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <jansson.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "study/scene/method_fields.h"
#include "study/scene/schema.h"
#include "study/verify/verify.h"
#include "tables/scene_format.h"

/* Regular expressions as JSON Schema has them (ECMA 262). */
#define NUMBER "\\+?(\\d+\\.?\\d*|\\.\\d+)([eE][+-]?\\d+)?"
#define NOT_ZERO "(?=[+\\d.]*[1-9])"
enum { MOST_PATTERN = 512 };

/* Any unit, in a format, as units.c has it: of which dimension it is, is left to the program. */
#define WORD "[A-Za-z%%\u00b5\u03bc]+(\\^?[1-9]|\\^-[1-9])?"
#define WORDS WORD "( *[ *] *" WORD ")*"
#define UNIT "(1|" WORDS ")( */ *(" WORD "|\\(" WORDS "\\)))?"
#define LENGTH NOT_ZERO NUMBER " +[A-Za-z\u00b5\u03bc]+"

/* A unit as a regular expression. */
static const char *escape(const char *unit, char text[64])
{
    size_t used = 0;
    for (const char *c = unit; *c && used < 61; c++) {
        if (strchr("^$.|?*+()[]{}\\", *c))
            text[used++] = '\\';
        text[used++] = *c;
    }
    text[used] = '\0';
    return text;
}

/* A text of a pattern, which is formatted. description: NULL, none. */
__attribute__((format(printf, 2, 3))) static json_t *matching(const char *description,
                                                              const char *format, ...)
{
    char pattern[MOST_PATTERN];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(pattern, sizeof pattern, format, arguments);
    va_end(arguments);
    return json_pack("{s:s, s:s, s:s*}", "type", "string", "pattern", pattern, "description",
                     description);
}

/* An expression in which no word is `without`, before "[unit]"; NULL: any. */
static json_t *expression(const char *without)
{
    char ahead[32] = "";
    if (without)
        snprintf(ahead, sizeof ahead, "(?![^\\[]*\\b%s\\b)", without);
    return matching(NULL, "^%s\\s*[^\\s\\[].*\\[" UNIT "\\]$", ahead);
}

/* Where a number without unit is one, an editor has it as a number. */
static json_t *number(const struct br_scene_key *key)
{
    const bool bare = key->need == BR_OR_RATIO || strcmp(key->unit, "1") == 0;
    json_t *o =
        matching(NULL, bare ? "^ *%s" NUMBER "( +" UNIT ")?$" : "^ *%s" NUMBER " +" UNIT "$",
                 key->kind == BR_KEY_POSITIVE ? NOT_ZERO : "");
    if (bare)
        json_object_update_new(
            o, json_pack("{s:[s, s], s:i}", "type", "number", "string", "minimum", 0));
    return o;
}

static json_t *law(void)
{
    json_t *names = json_array();
    for (int i = 0; i < BR_FRICTION_LAWS; i++)
        if (br_friction_law_names[i])
            json_array_append_new(names, json_string(br_friction_law_names[i]));
    return json_pack("{s:o}", "enum", names);
}

/* The rows of a registry; a number of them may be written as one. */
static json_t *method_words(const struct br_words *words)
{
    json_t *names = json_array();
    for (size_t row = 0; words->name(row); row++) {
        if (strspn(words->name(row), "0123456789"))
            json_array_append_new(names, json_integer(atoll(words->name(row))));
        json_array_append_new(names, json_string(words->name(row)));
    }
    return json_pack("{s:o}", "enum", names);
}

static json_t *method_number(const struct br_method_field *f)
{
    const bool whole = f->range.whole;
    json_t *o =
        json_pack("{s:[s, s], s:s, s:s}", "type", whole ? "integer" : "number", "string", "pattern",
                  whole ? "^[0-9]{1,10}$" : "^ *" NUMBER "$", "description", f->help);
    json_object_set_new(o, whole ? "minimum" : "exclusiveMinimum", json_real(f->range.low));
    if (isfinite(f->range.high))
        json_object_set_new(o, whole ? "maximum" : "exclusiveMaximum", json_real(f->range.high));
    return o;
}

static void add_methods(json_t *properties)
{
    for (const struct br_method_field *f = br_method_fields;
         f < br_method_fields + BR_METHOD_FIELDS; f++)
        if (!f->unsaid)
            json_object_set_new(properties, br_method_field_key(f),
                                f->words ? method_words(f->words) : method_number(f));
}

/* "2 +- 0.1, at most 3e-4 m", "2 to 4 +- 0.1": as verify_file.c reads it. part: NULL, of the norm alone. */
static void add_expectation(json_t *properties, const struct br_norm *norm, const char *part)
{
    char key[64], unit[64];
    snprintf(key, sizeof key, "%s%s%s", norm->name, part ? " " : "", part ? part : "");
    json_object_set_new(properties, key,
                        matching(norm->title,
                                 "^ *" NUMBER "( *to *" NUMBER ")? *\\+- *" NUMBER "( *, *(at most|constant *" NUMBER
                                 " *to) *" NUMBER " *%s)?$",
                                 escape(norm->unit, unit)));
}

static json_t *verify_study(void)
{
    json_t *properties = json_object();
    json_object_set_new(properties, "n",
                        json_pack("{s:[s, s], s:s, s:s}", "type", "number", "string", "pattern",
                                  "^ *" NUMBER "( *, *" NUMBER ")* *$", "description",
                                  "elements of the meshes"));
    json_object_set_new(properties, "k",
                        matching("time steps, s", "^ *%s( *, *%s)* s$", NUMBER, NUMBER));
    add_methods(properties);
    for (const struct br_norm *const *n = br_norms; *n; n++) {
        add_expectation(properties, *n, NULL);
        for (int part = 0; part < BR_PARTS; part++)
            add_expectation(properties, *n, br_part_names[part]);
    }
    return json_pack("{s:s, s:b, s:[s, s], s:o}", "type", "object", "additionalProperties", 0,
                     "required", "n", "k", "properties", properties);
}

static json_t *verify(void)
{
    json_t *properties = json_object();
    for (int kind = 0; kind < BR_VERIFY_KINDS; kind++)
        json_object_set_new(properties, br_verify_names[kind], verify_study());
    return json_pack("{s:s, s:i, s:b, s:o}", "type", "object", "minProperties", 1,
                     "additionalProperties", 0, "properties", properties);
}

static json_t *section(const char *name);

static json_t *value(const struct br_scene_key *key)
{
    switch (key->kind) {
    case BR_KEY_SECTION:
        return section(key->name);
    case BR_KEY_TEXT:
        return json_pack("{s:[s, s, s, s]}", "type", "string", "number", "boolean", "null");
    case BR_KEY_POSITIVE:
    case BR_KEY_NOT_NEGATIVE:
        return number(key);
    case BR_KEY_LOAD:
        return json_pack("{s:[o, {s:s, s:b, s:[s, s], s:{s:o, s:o}}]}", "anyOf", expression(NULL),
                         "type", "object", "additionalProperties", 0, "required", "shape",
                         "history", "properties", "shape", expression("t"), "history",
                         expression("x"));
    case BR_KEY_INITIAL:
        return expression("t");
    case BR_KEY_HISTORY:
        return expression("x");
    case BR_KEY_SOLUTION:
        return expression(NULL);
    case BR_KEY_LAW:
        return law();
    case BR_KEY_SHAPE:
        return matching(NULL, "^(circle +" LENGTH "|(rectangle|tube) +" LENGTH " x +" LENGTH ")$");
    case BR_KEY_VERIFY:
        break;
    }
    return verify();
}

static json_t *describe(const struct br_scene_key *key)
{
    json_t *v = value(key);
    char text[256];
    snprintf(text, sizeof text, "%s%s%s", key->help, *key->unit ? ", " : "", key->unit);
    json_object_set_new(v, "description", json_string(text));
    if (*key->example)
        json_object_set_new(v, "examples", json_pack("[s]", key->example));
    return v;
}

/* Where a friction law is chosen, its keys are needed and no other law's. */
static json_t *rule_of_law(const char *name, enum br_friction_law chosen)
{
    json_t *required = json_array(), *refused = json_object();
    for (const struct br_scene_key *k = br_scene_keys; k->name; k++) {
        if (strcmp(k->section, name) != 0 || !k->law)
            continue;
        if (k->law == chosen)
            json_array_append_new(required, json_string(k->name));
        else
            json_object_set_new(refused, k->name, json_false());
    }
    return json_pack("{s:{s:{s:{s:s}}}, s:{s:o, s:o}}", "if", "properties", "law", "const",
                     br_friction_law_names[chosen], "then", "required", required, "properties",
                     refused);
}

/* br_scene_derive and br_scene_check: what stands instead of a number, and what means nothing
 * without another. */
static void add_top_rules(json_t *object)
{
    json_t *density = json_pack("{s:[{s:[s]}, {s:[s]}]}", "anyOf", "required", "density",
                                "required", "mass_density");
    json_t *stiffness = json_pack("{s:[{s:[s]}, {s:{s:{s:[s]}, s:{s:[s]}}}]}", "anyOf", "required",
                                  "young", "properties", "axial", "required", "stiffness",
                                  "bending", "required", "stiffness");
    json_object_set_new(object, "allOf", json_pack("[o, o]", density, stiffness));
    json_object_set_new(
        object, "anyOf",
        json_pack("[{s:[s]}, {s:[s]}]", "required", "axial", "required", "bending"));
    json_object_set_new(object, "dependencies",
                        json_pack("{s:[s], s:[s]}", "contact", "axial", "friction", "bending"));
}

static void add_rules(json_t *object, const char *name)
{
    if (!*name)
        add_top_rules(object);
    if (strcmp(name, "axial") == 0 || strcmp(name, "bending") == 0)
        json_object_set_new(object, "anyOf",
                            json_pack("[{s:[s]}, {s:[s]}, {s:[s]}]", "required", "viscosity",
                                      "required", "relaxation_time", "required", "damping_ratio"));
    if (strcmp(name, "friction") != 0)
        return;
    json_t *rules = json_array();
    for (int i = 0; i < BR_FRICTION_LAWS; i++)
        if (br_friction_law_names[i])
            json_array_append_new(rules, rule_of_law(name, (enum br_friction_law)i));
    json_object_set_new(object, "allOf", rules);
}

/* The mapping of one section; "": the whole scene. */
static json_t *section(const char *name)
{
    json_t *properties = json_object(), *required = json_array();
    for (const struct br_scene_key *k = br_scene_keys; k->name; k++) {
        if (strcmp(k->section, name) != 0)
            continue;
        json_object_set_new(properties, k->name, describe(k));
        if (k->need == BR_REQUIRED && !k->law)
            json_array_append_new(required, json_string(k->name));
    }
    json_t *object = json_pack("{s:s, s:b, s:o, s:o}", "type", "object", "additionalProperties", 0,
                               "required", required, "properties", properties);
    add_rules(object, name);
    return object;
}

enum br_status br_scene_schema_write(FILE *out, struct br_error *err)
{
    json_t *o = json_pack("{s:s, s:s}", "$schema", "http://json-schema.org/draft-07/schema#",
                          "title", "A scene of beamrate");
    json_t *scene = section("");
    const bool whole = o && scene && json_object_update(o, scene) == 0;
    if (whole) {
        json_dumpf(o, out, JSON_INDENT(1) | JSON_ENSURE_ASCII);
        fputc('\n', out);
    }
    json_decref(scene);
    json_decref(o);
    return whole ? BR_OK : br_no_memory(err, "the JSON schema");
}
