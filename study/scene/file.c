/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/scene/file.h"

#include <stdlib.h>
#include <string.h>

#include "base/quote.h"
#include "base/words.h"
#include "study/scene/value.h"

/* Reads one mapping. */
static enum br_status read_section(const struct br_scene_reader *r, const char *section,
                                   const yaml_node_t *node);

static enum br_status read_key(const struct br_scene_reader *r, const struct br_scene_key *key,
                               const yaml_node_t *at, const yaml_node_t *value)
{
    const size_t row = (size_t)(key - br_scene_keys);
    r->given->row[row] = (struct br_scene_number){.line = br_yaml_line(at), .origin = row};
    if (key->kind == BR_KEY_SECTION) {
        if (key->offset)
            *(bool *)((char *)r->scene + key->offset) = true;
        return read_section(r, key->name, value);
    }
    if (key->kind == BR_KEY_VERIFY)
        return BR_OK; /* read_document reads it after the scene */
    return br_scene_read_value(r, key, value);
}

/* "; did you mean 'coefficient'?" of a symbol that stands for a key; in another section
 * 'friction.coefficient'; else "". Returns text (out). */
static const char *key_of_symbol(const char *section, const char *symbol, char text[BR_SUGGESTION])
{
    static const struct {
        const char *section, *symbol, *key;
    } known[] = {
        {"", "L", "length"},
        {"", "T", "duration"},
        {"", "rho", "density"},
        {"", "E", "young"},
        {"axial", "EA", "stiffness"},
        {"bending", "EI", "stiffness"},
        {"friction", "mu", "coefficient"},
    };
    *text = '\0';
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (strcmp(known[i].section, section) == 0 && strcmp(known[i].symbol, symbol) == 0)
            br_append(text, BR_SUGGESTION, "; did you mean '%s'?", known[i].key);
    for (size_t i = 0; i < sizeof known / sizeof *known && !*text; i++)
        if (strcmp(known[i].symbol, symbol) == 0)
            br_append(text, BR_SUGGESTION, "; did you mean '%s%s%s'?", known[i].section,
                      *known[i].section ? "." : "", known[i].key);
    return text;
}

/* Names the sections that have this key. */
static char *key_elsewhere(const char *section, const char *name, char text[BR_SUGGESTION])
{
    *text = '\0';
    for (const struct br_scene_key *k = br_scene_keys; k->name; k++)
        if (strcmp(k->name, name) == 0 && strcmp(k->section, section) != 0)
            br_append(text, BR_SUGGESTION, "%s%s%s%s", *text ? " or " : "; did you mean ",
                      k->section, *k->section ? "." : "", k->name);
    return *text ? br_append(text, BR_SUGGESTION, "?") : text;
}

static enum br_status read_entry(const struct br_scene_reader *r, const char *section,
                                 const yaml_node_t *name, const yaml_node_t *value)
{
    if (name->type != YAML_SCALAR_NODE)
        return br_scene_refuse(r, br_yaml_line(name), *section ? section : "scene",
                               "a key must be a word");
    const char *names[BR_MOST_SCENE_KEYS];
    char expected[BR_EXPECTED], meant[BR_SUGGESTION], elsewhere[BR_SUGGESTION];
    size_t count = 0;
    for (const struct br_scene_key *k = br_scene_keys; k->name; k++) {
        if (strcmp(k->section, section) != 0)
            continue;
        names[count++] = k->name;
        if (strcmp(k->name, br_yaml_text(name)) == 0)
            return br_scene_line(r, k)
                       ? br_scene_refuse(r, br_yaml_line(name), k->name, "given twice")
                       : read_key(r, k, name, value);
    }
    return br_scene_refuse(r, br_yaml_line(name), br_yaml_text(name), "unknown key%s%s, %s%s%s",
                           *section ? " in " : "", section,
                           br_expected(br_yaml_text(name), names, count, expected),
                           key_of_symbol(section, br_yaml_text(name), meant),
                           key_elsewhere(section, br_yaml_text(name), elsewhere));
}

static enum br_status check_required(const struct br_scene_reader *r, const char *section,
                                     size_t line)
{
    for (const struct br_scene_key *k = br_scene_keys; k->name; k++) {
        const bool needed = k->need == BR_REQUIRED || k->need == BR_OR_RATIO;
        if (strcmp(k->section, section) != 0 || br_scene_line(r, k) || !needed)
            continue;
        if (k->laws && !(k->laws & 1u << r->scene->friction.law))
            continue;
        return br_scene_refuse(
            r, line, k->name, "missing%s%s, expected %s%s%s", *section ? " in " : "", section,
            br_scene_key_help(k, (char[BR_KEY_HELP]){0}), *k->unit ? ", in " : "", k->unit);
    }
    for (const struct br_scene_key *k = br_scene_keys; k->name; k++)
        if (br_scene_line(r, k) && strcmp(k->section, section) == 0 && k->laws &&
            !(k->laws & 1u << r->scene->friction.law))
            return br_scene_refuse(r, line, k->name, "does not belong to this friction law: %s",
                                   k->help);
    return BR_OK;
}

static enum br_status read_section(const struct br_scene_reader *r, const char *section,
                                   const yaml_node_t *node)
{
    if (node->type != YAML_MAPPING_NODE)
        return br_scene_refuse(r, br_yaml_line(node), *section ? section : "scene",
                               "expected a mapping of keys to values");
    enum br_status status = BR_OK;
    for (yaml_node_pair_t *p = node->data.mapping.pairs.start;
         p < node->data.mapping.pairs.top && !status; p++)
        status = read_entry(r, section, yaml_document_get_node(r->yaml.document, p->key),
                            yaml_document_get_node(r->yaml.document, p->value));
    return status ? status : check_required(r, section, br_yaml_line(node));
}

/* The scene's name is its file's name without folder and extension. All output files of the scene
 * have names that begin with it. */
static enum br_status set_name(const struct br_scene_reader *r)
{
    const char *slash = strrchr(r->yaml.path, '/');
    const char *base = slash ? slash + 1 : r->yaml.path;
    const char *dot = strrchr(base, '.');
    const size_t length = dot && dot > base ? (size_t)(dot - base) : strlen(base);
    r->scene->name = br_allocate(length + 1, 1);
    if (!r->scene->name)
        return br_no_memory(r->yaml.err, "the scene");
    memcpy(r->scene->name, base, length);
    br_make_name(r->scene->name);
    return BR_OK;
}

/* The line of the section that a message names first ("axial: ..."), else that of the scene. */
static size_t line_of(const struct br_scene_reader *r, const yaml_node_t *root, const char *message)
{
    char section[16];
    const yaml_node_t *named =
        sscanf(message, "%15[a-z]:", section) == 1 ? br_yaml_value(&r->yaml, NULL, section) : NULL;
    return br_yaml_line(named ? named : root);
}

static enum br_status read_document(const struct br_scene_reader *r,
                                    const struct br_scene_asked *asked)
{
    const yaml_node_t *root = yaml_document_get_root_node(r->yaml.document);
    if (!root)
        return br_scene_refuse(r, 1, "scene", "the file is empty");
    struct br_error inner = {0};
    if (read_section(r, "", root) || set_name(r) || br_scene_derive(r))
        return r->yaml.err->status;
    if (br_scene_check(r->scene, &inner))
        return br_scene_pass_on(r, line_of(r, root, inner.message), "scene", &inner);
    if (br_scene_apply_solutions(r) || br_scene_check_functions(r, br_yaml_line(root)))
        return r->yaml.err->status;
    return asked->take_verify
               ? asked->take_verify(r, br_yaml_value(&r->yaml, NULL, "verify"), asked->self)
               : BR_OK;
}

/* The scene that a file is read into, and further requests. */
struct target {
    struct br_scene *scene;
    const struct br_scene_asked *asked;
};

static enum br_status take_scene(const struct br_yaml *yaml, void *self)
{
    const struct target *to = self;
    struct br_scene_given given = {0};
    struct br_scene_reader r = {*yaml, to->scene, &given};
    r.yaml.set = to->asked->set;
    const bool failed = (r.yaml.set && br_scene_put_sets(&r, to->asked->take_verify)) ||
                        read_document(&r, to->asked) || (r.yaml.set && br_scene_add_to_title(&r)) ||
                        (r.yaml.set && to->asked->text && br_scene_write_text(&r, to->asked->text));
    return failed ? r.yaml.err->status : BR_OK;
}

enum br_status br_scene_parse(const char *name, const char *text,
                              const struct br_scene_asked *asked, struct br_scene *scene,
                              struct br_error *err)
{
    struct target to = {scene, asked};
    *scene = (struct br_scene){0};
    return br_yaml_read(name, text, take_scene, &to, err);
}

enum br_status br_scene_read_text(const char *name, const char *text, struct br_scene *scene,
                                  struct br_error *err)
{
    return br_scene_parse(name, text, &(struct br_scene_asked){0}, scene, err);
}

enum br_status br_scene_read(const char *path, struct br_scene *scene, struct br_error *err)
{
    char *text;
    *scene = (struct br_scene){0};
    enum br_status status = br_scene_load(path, &text, err);
    if (!status)
        status = br_scene_read_text(path, text, scene, err);
    free(text);
    return status;
}

/* ---- files ---- */

enum br_status br_scene_load(const char *path, char **text, struct br_error *err)
{
    return br_text_load(path, BR_LONGEST_SCENE, "scene", text, err);
}
