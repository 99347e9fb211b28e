/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/scene/file.h"

#include <stdio.h>
#include <string.h>
#include <yaml.h>

#include "reference/mms/mms.h"
#include "study/scene/products.h"
#include "study/scene/quote.h"
#include "study/scene/scan.h"
#include "study/scene/value.h"
#include "study/verify/verify_file.h"

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
static enum br_status read_section(const struct br_scene_reader *r, const char *section,
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

static enum br_status read_entry(const struct br_scene_reader *r, const char *section,
                                 const yaml_node_t *name, const yaml_node_t *value,
                                 size_t seen[MOST_KEYS])
{
    if (name->type != YAML_SCALAR_NODE)
        return br_scene_refuse(r, br_yaml_line(name), *section ? section : "scene",
                               "a key must be a word");
    for (const struct br_scene_key *k = br_scene_keys; k->name; k++) {
        if (strcmp(k->section, section) != 0 || strcmp(k->name, br_yaml_text(name)) != 0)
            continue;
        const size_t row = (size_t)(k - br_scene_keys);
        if (seen[row])
            return br_scene_refuse(r, br_yaml_line(name), k->name, "given twice");
        seen[row] = br_yaml_line(name);
        if (k->kind == BR_KEY_SECTION)
            return read_section(r, k->name, value, seen);
        if (k->kind == BR_KEY_VERIFY)
            return BR_OK; /* when the scene is whole */
        return br_scene_read_value(r, k, value);
    }
    char known[512];
    list_keys(section, known, sizeof known);
    return br_scene_refuse(r, br_yaml_line(name), br_yaml_text(name),
                           "unknown key%s%s, expected one of: %s", *section ? " in " : "", section,
                           known);
}

static enum br_status check_required(const struct br_scene_reader *r, const char *section,
                                     size_t line, const size_t seen[MOST_KEYS])
{
    for (const struct br_scene_key *k = br_scene_keys; k->name; k++) {
        if (strcmp(k->section, section) != 0 || seen[k - br_scene_keys] || !k->required)
            continue;
        if (k->law != BR_FRICTIONLESS && k->law != r->scene->friction.law)
            continue;
        return br_scene_refuse(r, line, k->name, "missing%s%s, expected %s%s%s",
                               *section ? " in " : "", section, k->help, *k->unit ? ", in " : "",
                               k->unit);
    }
    for (const struct br_scene_key *k = br_scene_keys; k->name; k++)
        if (seen[k - br_scene_keys] && strcmp(k->section, section) == 0 &&
            k->law != BR_FRICTIONLESS && k->law != r->scene->friction.law)
            return br_scene_refuse(r, line, k->name, "does not belong to this friction law: %s",
                                   k->help);
    return BR_OK;
}

static enum br_status read_section(const struct br_scene_reader *r, const char *section,
                                   const yaml_node_t *node, size_t seen[MOST_KEYS])
{
    if (node->type != YAML_MAPPING_NODE)
        return br_scene_refuse(r, br_yaml_line(node), *section ? section : "scene",
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
    return check_required(r, section, br_yaml_line(node), seen);
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
static enum br_status apply_solutions(const struct br_scene_reader *r, const size_t seen[MOST_KEYS])
{
    struct br_error inner = {0};
    enum br_field_kind culprit = BR_AXIAL;
    enum br_status status = br_manufactured_apply(r->scene, &culprit, &inner);
    if (status == BR_BAD_INPUT)
        return br_scene_refuse(r, solution_line(culprit, seen), "solution", "%s", inner.message);
    struct br_load *const load[] = {&r->scene->axial.load, &r->scene->bending.load};
    const bool derived[] = {r->scene->axial.solution, r->scene->bending.solution};
    for (int kind = BR_AXIAL; kind <= BR_BENDING && !status; kind++) {
        struct br_function whole = load[kind]->term[0].space;
        if (derived[kind])
            status = br_products(&whole, load[kind], &inner);
    }
    return status ? br_fail(r->err, status, "%s", inner.message) : BR_OK;
}

/* The scene's name is its file's, without folder and ending; the names of all files that are
 * written for it begin with it. */
static enum br_status set_name(const struct br_scene_reader *r)
{
    const char *slash = strrchr(r->path, '/');
    const char *base = slash ? slash + 1 : r->path;
    const char *dot = strrchr(base, '.');
    const size_t length = dot && dot > base ? (size_t)(dot - base) : strlen(base);
    r->scene->name = br_allocate(length + 1, 1);
    if (!r->scene->name)
        return br_no_memory(r->err, "the scene");
    memcpy(r->scene->name, base, length);
    br_make_name(r->scene->name);
    return BR_OK;
}

/* The value of a key at the top; NULL: not given. */
static const yaml_node_t *top_value(const struct br_scene_reader *r, const char *key)
{
    const yaml_node_t *root = yaml_document_get_root_node(r->document);
    for (yaml_node_pair_t *p = root->data.mapping.pairs.start; p < root->data.mapping.pairs.top;
         p++)
        if (strcmp(br_yaml_text(yaml_document_get_node(r->document, p->key)), key) == 0)
            return yaml_document_get_node(r->document, p->value);
    return NULL;
}

static enum br_status read_verify(const struct br_scene_reader *r, struct br_verify *verify)
{
    const yaml_node_t *node = top_value(r, "verify");
    return node ? br_verify_read(r, node, verify) : br_verify_default(r->scene, verify, r->err);
}

/* A zero byte, which YAML can write as \0 in quotes, would end a text early. */
static enum br_status check_texts(const struct br_scene_reader *r)
{
    for (const yaml_node_t *n = r->document->nodes.start; n < r->document->nodes.top; n++)
        if (n->type == YAML_SCALAR_NODE && strlen(br_yaml_text(n)) != n->data.scalar.length)
            return br_scene_refuse(r, br_yaml_line(n), "scene",
                                   "found '%s' followed by a zero byte, expected text",
                                   br_yaml_text(n));
    return BR_OK;
}

/* Every function that is given is finite, and the initial ones respect the clamp. */
static enum br_status check_functions(const struct br_scene_reader *r, size_t line,
                                      const size_t seen[MOST_KEYS])
{
    struct br_error inner = {0};
    for (const struct br_scene_key *k = br_scene_keys; k->name; k++)
        if (seen[k - br_scene_keys] && br_scene_scan(r->scene, k, &inner))
            return br_scene_refuse(r, seen[k - br_scene_keys], k->name, "%s", inner.message);
    size_t culprit = 0;
    if (!br_scene_check_initial(r->scene, &culprit, &inner))
        return BR_OK;
    for (const struct br_scene_key *k = br_scene_keys; k->name; k++)
        if ((k->kind == BR_KEY_INITIAL || k->kind == BR_KEY_HISTORY) && k->offset == culprit &&
            seen[k - br_scene_keys])
            return br_scene_refuse(r, seen[k - br_scene_keys], k->name, "%s", inner.message);
    return br_scene_refuse(r, line, "scene", "%s", inner.message); /* from a solution */
}

static enum br_status read_document(const struct br_scene_reader *r, struct br_verify *verify)
{
    const yaml_node_t *root = yaml_document_get_root_node(r->document);
    if (!root)
        return br_scene_refuse(r, 1, "scene", "the file is empty");
    size_t seen[MOST_KEYS] = {0};
    enum br_status status = check_texts(r);
    if (!status)
        status = read_section(r, "", root, seen);
    if (!status)
        status = set_name(r);
    struct br_error inner = {0};
    if (!status && br_scene_check(r->scene, &inner))
        status = br_scene_refuse(r, br_yaml_line(root), "scene", "%s", inner.message);
    if (!status)
        status = apply_solutions(r, seen);
    if (!status)
        status = check_functions(r, br_yaml_line(root), seen);
    if (!status && verify)
        status = read_verify(r, verify);
    return status;
}

/* Where libyaml's loader has no memory it fails, and says nothing. */
static bool lacks_memory(const yaml_parser_t *parser)
{
    return parser->error == YAML_MEMORY_ERROR || parser->error == YAML_NO_ERROR;
}

static enum br_status not_yaml(const struct br_scene_reader *r, const yaml_parser_t *parser)
{
    if (lacks_memory(parser))
        return br_no_memory(r->err, "the YAML parser");
    return br_fail(r->err, BR_BAD_INPUT, "%s:%zu: not YAML: %s", r->path,
                   parser->problem_mark.line + 1, parser->problem ? parser->problem : "unreadable");
}

/* A second document would be read by nobody. */
static enum br_status check_end(const struct br_scene_reader *r, yaml_parser_t *parser)
{
    yaml_document_t more;
    if (!yaml_parser_load(parser, &more))
        return not_yaml(r, parser);
    const yaml_node_t *root = yaml_document_get_root_node(&more);
    const size_t line = more.start_mark.line + 1;
    yaml_document_delete(&more);
    return root ? br_scene_refuse(r, line, "scene", "a second document begins, expected one")
                : BR_OK;
}

enum br_status br_scene_read(const char *path, struct br_scene *scene, struct br_error *err)
{
    return br_scene_read_verify(path, scene, NULL, err);
}

/* Deeper ones take libyaml a time that grows with the square of the depth. */
static enum br_status check_depth(const char *path, const char *text, struct br_error *err)
{
    enum { DEEPEST = 32 };
    yaml_parser_t parser;
    yaml_event_t event = {.type = YAML_NO_EVENT};
    int depth = 0;
    size_t line = 0;
    if (!yaml_parser_initialize(&parser))
        return br_no_memory(err, "the YAML parser");
    yaml_parser_set_input_string(&parser, (const unsigned char *)text, strlen(text));
    bool more = true, parsed = true;
    while (more && depth <= DEEPEST && (parsed = yaml_parser_parse(&parser, &event))) {
        line = event.start_mark.line + 1;
        depth += event.type == YAML_SEQUENCE_START_EVENT || event.type == YAML_MAPPING_START_EVENT;
        depth -= event.type == YAML_SEQUENCE_END_EVENT || event.type == YAML_MAPPING_END_EVENT;
        more = event.type != YAML_STREAM_END_EVENT;
        yaml_event_delete(&event);
    }
    const bool memory = !parsed && lacks_memory(&parser);
    yaml_parser_delete(&parser);
    if (memory)
        return br_no_memory(err, "the YAML parser");
    return depth <= DEEPEST ? BR_OK
                            : br_fail(err, BR_BAD_INPUT,
                                      "%s:%zu: scene: found lists or mappings nested more "
                                      "than %d deep, expected a scene",
                                      path, line, DEEPEST);
}

static enum br_status parse(const char *path, const char *text, struct br_scene *scene,
                            struct br_verify *verify, struct br_error *err)
{
    yaml_parser_t parser;
    yaml_document_t document;
    *scene = (struct br_scene){0};
    if (verify)
        *verify = (struct br_verify){0};
    enum br_status status = check_depth(path, text, err);
    if (status)
        return status;
    if (!yaml_parser_initialize(&parser))
        return br_no_memory(err, "the YAML parser");
    yaml_parser_set_input_string(&parser, (const unsigned char *)text, strlen(text));
    const struct br_scene_reader r = {path, &document, scene, err};
    if (!yaml_parser_load(&parser, &document))
        status = not_yaml(&r, &parser);
    else {
        status = read_document(&r, verify);
        yaml_document_delete(&document);
    }
    if (!status)
        status = check_end(&r, &parser);
    yaml_parser_delete(&parser);
    return status;
}

enum br_status br_scene_read_text(const char *path, const char *text, struct br_scene *scene,
                                  struct br_error *err)
{
    return parse(path, text, scene, NULL, err);
}

enum br_status br_scene_read_verify(const char *path, struct br_scene *scene,
                                    struct br_verify *verify, struct br_error *err)
{
    char *text;
    enum br_status status = br_scene_load(path, &text, err);
    if (status) {
        *scene = (struct br_scene){0};
        if (verify)
            *verify = (struct br_verify){0};
        return status;
    }
    status = parse(path, text, scene, verify, err);
    free(text);
    return status;
}
