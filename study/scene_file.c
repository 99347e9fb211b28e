/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/scene_file.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <yaml.h>

#include "reference/mms/manufactured.h"
#include "study/expression.h"
#include "study/scene_schema.h"

/* What is being read, for messages. */
struct reader {
    const char *path;
    yaml_document_t *document;
    struct br_scene *scene;
    struct br_error *err;
};

/* "path:line: key: ..." */
__attribute__((format(printf, 4, 5))) static enum br_status refuse(const struct reader *r,
                                                                   size_t line, const char *key,
                                                                   const char *format, ...)
{
    char text[768];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    return br_fail(r->err, BR_BAD_INPUT, "%s:%zu: %s: %s", r->path, line, key, text);
}

static size_t line_of(const yaml_node_t *node)
{
    return node->start_mark.line + 1;
}

static const char *text_of(const yaml_node_t *node)
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

static enum br_status read_number(const struct reader *r, const struct br_scene_key *key,
                                  const yaml_node_t *node)
{
    double value;
    const char *unit;
    if (!parse_number(text_of(node), &value, &unit))
        return refuse(r, line_of(node), key->name, "found '%s', expected a finite number in %s",
                      text_of(node), key->unit);
    if (strcmp(unit, key->unit) != 0)
        return refuse(r, line_of(node), key->name, "found '%s', expected a number and its unit, %s",
                      text_of(node), key->unit);
    const bool fits = key->kind == BR_KEY_POSITIVE ? value > 0 : value >= 0;
    if (!fits)
        return refuse(r, line_of(node), key->name, "found %s, expected a value %s 0 %s",
                      text_of(node), key->kind == BR_KEY_POSITIVE ? ">" : ">=", key->unit);
    *(double *)((char *)r->scene + key->offset) = value;
    return BR_OK;
}

enum { MOST_TEXT = 1024 };

/* Splits "expression [unit]": the expression goes into text. */
static enum br_status split_unit(const struct reader *r, const struct br_scene_key *key,
                                 const char *unit, const yaml_node_t *node, char text[MOST_TEXT])
{
    const char *bracket = strrchr(text_of(node), '[');
    const size_t length = bracket ? (size_t)(bracket - text_of(node)) : 0;
    char expected[64];
    snprintf(expected, sizeof expected, "[%s]", unit);
    if (!bracket || strcmp(bracket, expected) != 0)
        return refuse(r, line_of(node), key->name,
                      "found '%s', expected an expression and its unit, like 'x*t %s'",
                      text_of(node), expected);
    if (length >= MOST_TEXT)
        return refuse(r, line_of(node), key->name, "longer than %d characters", MOST_TEXT - 1);
    memcpy(text, text_of(node), length);
    text[length] = '\0';
    while (*text && text[strlen(text) - 1] == ' ')
        text[strlen(text) - 1] = '\0';
    return BR_OK;
}

/* "expression [unit]" into a function. */
static enum br_status read_expression(const struct reader *r, const struct br_scene_key *key,
                                      const char *unit, const yaml_node_t *node,
                                      struct br_function *out)
{
    char text[MOST_TEXT];
    enum br_status status = split_unit(r, key, unit, node, text);
    if (status)
        return status;
    struct br_error inner = {0};
    status = br_expression(text, out, &inner);
    if (status == BR_BAD_INPUT)
        return refuse(r, line_of(node), key->name, "%s", inner.message);
    return status ? br_fail(r->err, status, "%s", inner.message) : BR_OK;
}

/* An expression that must not use t (initial data) or x. */
static enum br_status forbid(const struct reader *r, const struct br_scene_key *key,
                             const yaml_node_t *node, bool used, const char *variable)
{
    if (!used)
        return BR_OK;
    return refuse(r, line_of(node), key->name, "found '%s', expected an expression without %s",
                  text_of(node), variable);
}

static enum br_status read_initial(const struct reader *r, const struct br_scene_key *key,
                                   const yaml_node_t *node)
{
    struct br_function *f = (struct br_function *)((char *)r->scene + key->offset);
    const enum br_status status = read_expression(r, key, key->unit, node, f);
    return status ? status : forbid(r, key, node, f->uses_t, "t");
}

static enum br_status read_history(const struct reader *r, const struct br_scene_key *key,
                                   const yaml_node_t *node)
{
    struct br_function *f = (struct br_function *)((char *)r->scene + key->offset);
    const enum br_status status = read_expression(r, key, key->unit, node, f);
    return status ? status : forbid(r, key, node, f->uses_x, "x");
}

/* An expression that is kept as text, too. */
static enum br_status read_solution(const struct reader *r, const struct br_scene_key *key,
                                    const yaml_node_t *node)
{
    char text[MOST_TEXT];
    struct br_function parsed = {0};
    enum br_status status = read_expression(r, key, key->unit, node, &parsed);
    br_function_free(&parsed);
    if (!status)
        status = split_unit(r, key, key->unit, node, text);
    if (status)
        return status;
    char **copy = (char **)((char *)r->scene + key->offset);
    *copy = br_allocate(strlen(text) + 1, 1);
    if (!*copy)
        return br_no_memory(r->err, "the scene");
    strcpy(*copy, text);
    return BR_OK;
}

/* A product {shape: F(x), history: G(t)}. */
static enum br_status read_product(const struct reader *r, const struct br_scene_key *key,
                                   const yaml_node_t *node, struct br_load *load)
{
    static const char *const expected = "expected 'shape: F(x) [1]' and 'history: G(t) [N/m]'";
    bool seen[2] = {false, false};
    for (yaml_node_pair_t *p = node->data.mapping.pairs.start; p < node->data.mapping.pairs.top;
         p++) {
        const yaml_node_t *name = yaml_document_get_node(r->document, p->key);
        const yaml_node_t *value = yaml_document_get_node(r->document, p->value);
        if (name->type != YAML_SCALAR_NODE || value->type != YAML_SCALAR_NODE)
            return refuse(r, line_of(name), key->name, "%s", expected);
        const bool shape = strcmp(text_of(name), "shape") == 0;
        if (!shape && strcmp(text_of(name), "history") != 0)
            return refuse(r, line_of(name), key->name, "found '%s', %s", text_of(name), expected);
        if (seen[shape])
            return refuse(r, line_of(name), key->name, "'%s' is given twice", text_of(name));
        seen[shape] = true;
        struct br_function *f = shape ? &load->space : &load->time;
        enum br_status status = read_expression(r, key, shape ? "1" : "N/m", value, f);
        if (!status)
            status = shape ? forbid(r, key, value, f->uses_t, "t")
                           : forbid(r, key, value, f->uses_x, "x");
        if (status)
            return status;
    }
    if (!seen[0] || !seen[1])
        return refuse(r, line_of(node), key->name, "%s", expected);
    return BR_OK;
}

/* A load: one expression, sorted into what depends on x and what on t alone. */
static enum br_status read_load(const struct reader *r, const struct br_scene_key *key,
                                const yaml_node_t *node)
{
    struct br_load *load = (struct br_load *)((char *)r->scene + key->offset);
    if (node->type == YAML_MAPPING_NODE)
        return read_product(r, key, node, load);
    struct br_function f;
    const enum br_status status = read_expression(r, key, "N/m", node, &f);
    if (status)
        return status;
    const struct br_function one = {.constant = 1};
    *load = f.uses_x ? (struct br_load){.space = f, .time = one}
                     : (struct br_load){.space = one, .time = f};
    return BR_OK;
}

static enum br_status read_text(const struct reader *r, const struct br_scene_key *key,
                                const yaml_node_t *node)
{
    char **text = (char **)((char *)r->scene + key->offset);
    *text = br_allocate(strlen(text_of(node)) + 1, 1);
    if (!*text)
        return br_no_memory(r->err, "the scene");
    strcpy(*text, text_of(node));
    return BR_OK;
}

static enum br_status read_law(const struct reader *r, const struct br_scene_key *key,
                               const yaml_node_t *node)
{
    if (strcmp(text_of(node), "tresca") == 0)
        r->scene->friction.law = BR_TRESCA;
    else if (strcmp(text_of(node), "coulomb") == 0)
        r->scene->friction.law = BR_COULOMB;
    else
        return refuse(r, line_of(node), key->name, "found '%s', expected tresca or coulomb",
                      text_of(node));
    return BR_OK;
}

static enum br_status read_value(const struct reader *r, const struct br_scene_key *key,
                                 const yaml_node_t *node)
{
    const bool product = key->kind == BR_KEY_LOAD && node->type == YAML_MAPPING_NODE;
    if (node->type != YAML_SCALAR_NODE && !product)
        return refuse(r, line_of(node), key->name, "found a list or a mapping, expected %s",
                      key->help);
    switch (key->kind) {
    case BR_KEY_POSITIVE:
    case BR_KEY_NOT_NEGATIVE:
        return read_number(r, key, node);
    case BR_KEY_INITIAL:
        return read_initial(r, key, node);
    case BR_KEY_HISTORY:
        return read_history(r, key, node);
    case BR_KEY_LOAD:
        return read_load(r, key, node);
    case BR_KEY_SOLUTION:
        return read_solution(r, key, node);
    case BR_KEY_LAW:
        return read_law(r, key, node);
    case BR_KEY_TEXT:
    case BR_KEY_SECTION: /* read_entry has taken it */
        break;
    }
    return read_text(r, key, node);
}

/* "one, two, three": the keys of a section, for a message. */
static void list_keys(const char *section, char *text, size_t size)
{
    text[0] = '\0';
    for (const struct br_scene_key *k = br_scene_keys; k->name; k++)
        if (strcmp(k->section, section) == 0) {
            const size_t used = strlen(text);
            snprintf(text + used, size - used, "%s%s", used ? ", " : "", k->name);
        }
}

enum { MOST_KEYS = 64 };

/* Reads one mapping; seen: in/out, the lines of the table's rows that have been given; 0: not. */
static enum br_status read_section(const struct reader *r, const char *section,
                                   const yaml_node_t *node, size_t seen[MOST_KEYS]);

static bool *part_flag(struct br_scene *scene, const char *section)
{
    if (strcmp(section, "axial") == 0)
        return &scene->axial.modelled;
    if (strcmp(section, "bending") == 0)
        return &scene->bending.modelled;
    if (strcmp(section, "contact") == 0)
        return &scene->contact.modelled;
    return NULL; /* friction is modelled by its law */
}

static enum br_status read_entry(const struct reader *r, const char *section,
                                 const yaml_node_t *name, const yaml_node_t *value,
                                 size_t seen[MOST_KEYS])
{
    if (name->type != YAML_SCALAR_NODE)
        return refuse(r, line_of(name), *section ? section : "scene", "a key must be a word");
    for (const struct br_scene_key *k = br_scene_keys; k->name; k++) {
        if (strcmp(k->section, section) != 0 || strcmp(k->name, text_of(name)) != 0)
            continue;
        const size_t row = (size_t)(k - br_scene_keys);
        if (seen[row])
            return refuse(r, line_of(name), k->name, "given twice");
        seen[row] = line_of(name);
        if (k->kind == BR_KEY_SECTION)
            return read_section(r, k->name, value, seen);
        return read_value(r, k, value);
    }
    char known[512];
    list_keys(section, known, sizeof known);
    return refuse(r, line_of(name), text_of(name), "unknown key%s%s, expected one of: %s",
                  *section ? " in " : "", section, known);
}

static enum br_status check_required(const struct reader *r, const char *section, size_t line,
                                     const size_t seen[MOST_KEYS])
{
    for (const struct br_scene_key *k = br_scene_keys; k->name; k++) {
        if (strcmp(k->section, section) != 0 || seen[k - br_scene_keys] || !k->required)
            continue;
        if (k->law != BR_FRICTIONLESS && k->law != r->scene->friction.law)
            continue;
        return refuse(r, line, k->name, "missing%s%s, expected %s%s%s", *section ? " in " : "",
                      section, k->help, *k->unit ? ", in " : "", k->unit);
    }
    for (const struct br_scene_key *k = br_scene_keys; k->name; k++)
        if (seen[k - br_scene_keys] && strcmp(k->section, section) == 0 &&
            k->law != BR_FRICTIONLESS && k->law != r->scene->friction.law)
            return refuse(r, line, k->name, "does not belong to this friction law: %s", k->help);
    return BR_OK;
}

static enum br_status read_section(const struct reader *r, const char *section,
                                   const yaml_node_t *node, size_t seen[MOST_KEYS])
{
    if (node->type != YAML_MAPPING_NODE)
        return refuse(r, line_of(node), *section ? section : "scene",
                      "expected a mapping of keys to values");
    bool *modelled = part_flag(r->scene, section);
    if (modelled)
        *modelled = true;
    for (yaml_node_pair_t *p = node->data.mapping.pairs.start; p < node->data.mapping.pairs.top;
         p++) {
        const enum br_status status =
            read_entry(r, section, yaml_document_get_node(r->document, p->key),
                       yaml_document_get_node(r->document, p->value), seen);
        if (status)
            return status;
    }
    return check_required(r, section, line_of(node), seen);
}

/* The line on which the section's solution is given. */
static size_t solution_line(enum br_field_kind kind, const size_t seen[MOST_KEYS])
{
    size_t row = 0;
    const char *section = kind == BR_AXIAL ? "axial" : "bending";
    while (strcmp(br_scene_keys[row].section, section) != 0 ||
           br_scene_keys[row].kind != BR_KEY_SOLUTION)
        row++;
    return seen[row];
}

/* What a solution determines (reference/mms). */
static enum br_status apply_solutions(const struct reader *r, const size_t seen[MOST_KEYS])
{
    const char *const texts[2] = {r->scene->axial.solution, r->scene->bending.solution};
    struct br_function parsed[2] = {{0}, {0}};
    struct br_error inner = {0};
    enum br_field_kind culprit = BR_AXIAL;
    enum br_status status = BR_OK;
    for (int kind = BR_AXIAL; kind <= BR_BENDING && !status; kind++)
        if (texts[kind])
            status = br_expression(texts[kind], &parsed[kind], &inner);
    if (!status)
        status = br_manufactured_apply(r->scene, parsed, &culprit, &inner);
    br_function_free(&parsed[BR_AXIAL]);
    br_function_free(&parsed[BR_BENDING]);
    if (status == BR_BAD_INPUT)
        return refuse(r, solution_line(culprit, seen), "solution", "%s", inner.message);
    return status ? br_fail(r->err, status, "%s", inner.message) : BR_OK;
}

/* The scene's name is its file's, without folder and ending. */
static enum br_status set_name(const struct reader *r)
{
    const char *slash = strrchr(r->path, '/');
    const char *base = slash ? slash + 1 : r->path;
    const char *dot = strrchr(base, '.');
    const size_t length = dot && dot > base ? (size_t)(dot - base) : strlen(base);
    r->scene->name = br_allocate(length + 1, 1);
    if (!r->scene->name)
        return br_no_memory(r->err, "the scene");
    memcpy(r->scene->name, base, length);
    return BR_OK;
}

static enum br_status read_document(const struct reader *r)
{
    const yaml_node_t *root = yaml_document_get_root_node(r->document);
    if (!root)
        return refuse(r, 1, "scene", "the file is empty");
    size_t seen[MOST_KEYS] = {0};
    enum br_status status = read_section(r, "", root, seen);
    if (!status)
        status = set_name(r);
    struct br_error inner = {0};
    if (!status && br_scene_check(r->scene, &inner))
        status = refuse(r, line_of(root), "scene", "%s", inner.message);
    if (!status)
        status = apply_solutions(r, seen);
    if (!status && br_scene_check_initial(r->scene, &inner))
        status = refuse(r, line_of(root), "scene", "%s", inner.message);
    return status;
}

enum br_status br_scene_read(const char *path, struct br_scene *scene, struct br_error *err)
{
    *scene = (struct br_scene){0};
    FILE *file = fopen(path, "rb");
    if (!file)
        return br_fail(err, BR_BAD_INPUT, "%s: %s", path, strerror(errno));
    yaml_parser_t parser;
    yaml_document_t document;
    enum br_status status = BR_OK;
    if (!yaml_parser_initialize(&parser)) {
        fclose(file);
        return br_no_memory(err, "the YAML parser");
    }
    yaml_parser_set_input_file(&parser, file);
    if (!yaml_parser_load(&parser, &document)) {
        status =
            br_fail(err, BR_BAD_INPUT, "%s:%zu: not YAML: %s", path, parser.problem_mark.line + 1,
                    parser.problem ? parser.problem : "unreadable");
    } else {
        const struct reader r = {path, &document, scene, err};
        status = read_document(&r);
        yaml_document_delete(&document);
    }
    yaml_parser_delete(&parser);
    fclose(file);
    return status;
}
