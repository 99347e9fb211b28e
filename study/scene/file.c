/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/scene/file.h"

#include <dirent.h>
#include <dlfcn.h>
#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <yaml.h>

#include "study/base/quote.h"
#include "study/base/text.h"
#include "study/base/words.h"
#include "study/known/expression.h"
#include "study/scene/schema.h"
#include "study/scene/value.h"

/* ---- paths and files of scenes ---- */

/* The path in share/beamrate above the file of this code, which is the program or the shared
 * library: what is installed may be moved as a whole. */
static bool find_above(const char *relative, char *path, size_t size)
{
    static const char here;
    char file[PATH_MAX];
    Dl_info own;
    if (!dladdr(&here, &own) ||
        !realpath(own.dli_fname[0] == '/' ? own.dli_fname : "/proc/self/exe", file))
        return false;
    for (char *end; (end = strrchr(file, '/'));) {
        *end = '\0';
        snprintf(path, size, "%s/share/beamrate/%s", file, relative);
        if (access(path, R_OK) == 0)
            return true;
    }
    return false;
}

void br_data_path(const char *relative, char *path, size_t size)
{
    const char *folder = getenv("BEAMRATE_DATA");
    if (!folder || !*folder)
        folder = access(BR_SOURCE_DIR "/study/scenes", R_OK) == 0 ? BR_SOURCE_DIR : NULL;
    if (folder || !find_above(relative, path, size))
        snprintf(path, size, "%s/%s", folder ? folder : BR_DATA_DIR, relative);
}

/* Suggests the bundled scene with the most similar name, if there is one. */
static enum br_status refuse(const char *name, const char *path, struct br_error *err)
{
    char **names, suggestion[BR_SUGGESTION] = "";
    size_t count;
    if (!br_scene_list(&names, &count, NULL))
        br_suggestion(name, (const char *const *)names, count, suggestion);
    const enum br_status status =
        br_fail(err, BR_BAD_INPUT, "scene '%s' is no file and no bundled scene (looked for %s)%s",
                name, path, suggestion);
    br_scene_list_free(names, count);
    return status;
}

enum br_status br_scene_find(const char *name, char *path, size_t size, struct br_error *err)
{
    if (strcmp(name, "-") == 0)
        name = BR_STANDARD_INPUT;
    if (access(name, F_OK) == 0) {
        if ((size_t)snprintf(path, size, "%s", name) >= size)
            return br_fail(err, BR_BAD_INPUT, "the path '%s' is too long", name);
        return BR_OK;
    }
    char relative[512];
    snprintf(relative, sizeof relative, "study/scenes/%s.yaml", name);
    br_data_path(relative, path, size);
    if (access(path, R_OK) == 0)
        return BR_OK;
    return refuse(name, path, err);
}

enum br_status br_scene_load(const char *path, char **text, struct br_error *err)
{
    return br_text_load(path, BR_LONGEST_SCENE, "scene", text, err);
}

enum br_status br_scene_open(const char *name, char *path, size_t size, char **text,
                             struct br_scene *scene, struct br_error *err)
{
    *text = NULL;
    *scene = (struct br_scene){0};
    enum br_status status = br_scene_find(name, path, size, err);
    if (!status)
        status = br_scene_load(path, text, err);
    return status ? status : br_scene_read_text(path, *text, scene, err);
}

static int is_scene(const struct dirent *entry)
{
    const char *dot = strrchr(entry->d_name, '.');
    return dot && dot > entry->d_name && strcmp(dot, ".yaml") == 0;
}

enum br_status br_scene_list(char ***names, size_t *count, struct br_error *err)
{
    char folder[1024];
    struct dirent **entry;
    *names = NULL;
    *count = 0;
    br_data_path("study/scenes", folder, sizeof folder);
    const int found = scandir(folder, &entry, is_scene, alphasort);
    if (found < 0 && errno == ENOMEM)
        return br_no_memory(err, "the list of scenes");
    if (found < 0)
        return br_fail(err, BR_BAD_INPUT, "the bundled scenes: %s: %s", folder, strerror(errno));
    *names = br_allocate((size_t)found + 1, sizeof **names);
    for (int i = 0; i < found; i++) {
        const size_t length = strlen(entry[i]->d_name) - strlen(".yaml");
        if (*names && ((*names)[*count] = br_allocate(length + 1, 1)))
            memcpy((*names)[(*count)++], entry[i]->d_name, length);
        free(entry[i]);
    }
    free(entry);
    return *count == (size_t)found ? BR_OK : br_no_memory(err, "the list of scenes");
}

void br_scene_list_free(char **names, size_t count)
{
    for (size_t i = 0; names && i < count; i++)
        free(names[i]);
    free(names);
}

/* ---- contents of scenes ---- */

/* Reads one mapping. */
static enum br_status read_section(const struct br_scene_reader *r, const char *section,
                                   const yaml_node_t *node);

/* The line on which a key is given; 0: it is not. */
static size_t line_of(const struct br_scene_reader *r, const struct br_scene_key *key)
{
    return r->given->row[key - br_scene_keys].line;
}

/* The text that replaces the value of the varied key gets a node of its own. */
static enum br_status read_key(const struct br_scene_reader *r, const struct br_scene_key *key,
                               const yaml_node_t *at, const yaml_node_t *value)
{
    const size_t row = (size_t)(key - br_scene_keys);
    yaml_node_t varied = *value;
    r->given->row[row] = (struct br_scene_number){.line = br_yaml_line(at), .origin = row};
    if (key->kind == BR_KEY_SECTION) {
        if (key->offset)
            *(bool *)((char *)r->scene + key->offset) = true;
        return read_section(r, key->name, value);
    }
    if (key->kind == BR_KEY_VERIFY)
        return BR_OK; /* read_document reads it after the scene */
    if (key != r->varied)
        return br_scene_read_value(r, key, value);
    varied.type = YAML_SCALAR_NODE;
    varied.data.scalar.value = (yaml_char_t *)r->text;
    return br_scene_read_value(r, key, &varied);
}

static enum br_status read_entry(const struct br_scene_reader *r, const char *section,
                                 const yaml_node_t *name, const yaml_node_t *value)
{
    if (name->type != YAML_SCALAR_NODE)
        return br_scene_refuse(r, br_yaml_line(name), *section ? section : "scene",
                               "a key must be a word");
    const char *names[BR_MOST_SCENE_KEYS];
    char expected[BR_EXPECTED];
    size_t count = 0;
    for (const struct br_scene_key *k = br_scene_keys; k->name; k++) {
        if (strcmp(k->section, section) != 0)
            continue;
        names[count++] = k->name;
        if (strcmp(k->name, br_yaml_text(name)) == 0)
            return line_of(r, k) ? br_scene_refuse(r, br_yaml_line(name), k->name, "given twice")
                                 : read_key(r, k, name, value);
    }
    return br_scene_refuse(r, br_yaml_line(name), br_yaml_text(name), "unknown key%s%s, %s",
                           *section ? " in " : "", section,
                           br_expected(br_yaml_text(name), names, count, expected));
}

static enum br_status check_required(const struct br_scene_reader *r, const char *section,
                                     size_t line)
{
    for (const struct br_scene_key *k = br_scene_keys; k->name; k++) {
        const bool needed = k->need == BR_REQUIRED || k->need == BR_OR_RATIO;
        if (strcmp(k->section, section) != 0 || line_of(r, k) || !needed)
            continue;
        if (k->law != BR_FRICTIONLESS && k->law != r->scene->friction.law)
            continue;
        return br_scene_refuse(r, line, k->name, "missing%s%s, expected %s%s%s",
                               *section ? " in " : "", section, k->help, *k->unit ? ", in " : "",
                               k->unit);
    }
    for (const struct br_scene_key *k = br_scene_keys; k->name; k++)
        if (line_of(r, k) && strcmp(k->section, section) == 0 && k->law != BR_FRICTIONLESS &&
            k->law != r->scene->friction.law)
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
        status = read_entry(r, section, yaml_document_get_node(r->document, p->key),
                            yaml_document_get_node(r->document, p->value));
    const struct br_scene_key *varied = r->varied;
    if (!status && varied && strcmp(varied->section, section) == 0 && !line_of(r, varied))
        status = read_key(r, varied, node, node);
    return status ? status : check_required(r, section, br_yaml_line(node));
}

/* Derives loads, tip forces and initial data from a solution (manufactured.c). */
static enum br_status apply_solutions(const struct br_scene_reader *r)
{
    struct br_error inner = {0};
    enum br_field_kind culprit = BR_AXIAL;
    enum br_status status = br_manufactured_apply(r->scene, &culprit, &inner);
    const size_t row = br_scene_row(culprit == BR_AXIAL ? "axial.solution" : "bending.solution");
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING && !status; kind++) {
        struct br_scene_field *field = &r->scene->field[kind];
        struct br_function whole = field->load.term[0].space;
        if (field->solution)
            status = br_products(&whole, &field->load, &inner);
    }
    return br_scene_pass_on(r, r->given->row[row].line, "solution", &inner);
}

/* The scene's name is its file's name without folder and extension. All output files of the scene
 * have names that begin with it. */
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

/* The value of a key in a mapping; NULL: not given. */
static const yaml_node_t *value_in(const struct br_scene_reader *r, const yaml_node_t *node,
                                   const char *key)
{
    for (yaml_node_pair_t *p = node->data.mapping.pairs.start; p < node->data.mapping.pairs.top;
         p++)
        if (strcmp(br_yaml_text(yaml_document_get_node(r->document, p->key)), key) == 0)
            return yaml_document_get_node(r->document, p->value);
    return NULL;
}

/* The value of a key outside of sections; NULL: not given. */
static const yaml_node_t *top_value(const struct br_scene_reader *r, const char *key)
{
    return value_in(r, yaml_document_get_root_node(r->document), key);
}

/* One line of br_scene_data: a number in the unit of its key, however the file writes it; other
 * values as they are. */
static void print_value(const struct br_scene_reader *r, const struct br_scene_key *k, FILE *out)
{
    const yaml_node_t *section = *k->section ? top_value(r, k->section) : NULL;
    const yaml_node_t *node = section ? value_in(r, section, k->name) : top_value(r, k->name);
    fprintf(out, "%s%s%s:", k->section, *k->section ? "." : "", k->name);
    if (k->kind == BR_KEY_POSITIVE || k->kind == BR_KEY_NOT_NEGATIVE)
        fprintf(out, " %.15g %s", *(const double *)((const char *)r->scene + k->offset), k->unit);
    else if (node->type == YAML_SCALAR_NODE)
        fprintf(out, " %s", br_yaml_text(node));
    else
        for (int factor = 0; factor < 2; factor++)
            fprintf(out, "%s %s", factor ? " times" : "",
                    br_yaml_text(value_in(r, node, factor ? "history" : "shape")));
    fputc('\n', out);
}

enum br_status br_scene_data(const struct br_scene_reader *r, char **data)
{
    size_t size;
    FILE *out = br_text_open(data, &size);
    for (const struct br_scene_key *k = br_scene_keys; out && k->name; k++)
        if (line_of(r, k) && k->need != BR_MAKES && k->kind != BR_KEY_SECTION &&
            k->kind != BR_KEY_TEXT && k->kind != BR_KEY_VERIFY)
            print_value(r, k, out);
    return out && fclose(out) == 0 ? BR_OK : br_no_memory(r->err, "the scene's data");
}

/* Checks that every given function is finite and that initial data respect the clamp. */
static enum br_status check_functions(const struct br_scene_reader *r, size_t line)
{
    struct br_error inner = {0};
    for (const struct br_scene_key *k = br_scene_keys; k->name; k++)
        if (line_of(r, k) && br_scene_scan(r->scene, k, &inner))
            return br_scene_pass_on(r, line_of(r, k), k->name, &inner);
    size_t culprit = 0;
    br_scene_check_initial(r->scene, &culprit, &inner);
    for (const struct br_scene_key *k = br_scene_keys; k->name; k++)
        if ((k->kind == BR_KEY_INITIAL || k->kind == BR_KEY_HISTORY) && k->offset == culprit &&
            line_of(r, k))
            return br_scene_pass_on(r, line_of(r, k), k->name, &inner);
    return br_scene_pass_on(r, line, "scene", &inner); /* derived from a solution */
}

static enum br_status read_document(const struct br_scene_reader *r,
                                    const struct br_scene_asked *asked)
{
    const yaml_node_t *root = yaml_document_get_root_node(r->document);
    if (!root)
        return br_scene_refuse(r, 1, "scene", "the file is empty");
    enum br_status status = read_section(r, "", root);
    if (!status && r->varied && *r->varied->section && !top_value(r, r->varied->section))
        status =
            br_fail(r->err, BR_BAD_INPUT, "%s: --vary: %s.%s: the scene has no '%s', expected one",
                    r->path, r->varied->section, r->varied->name, r->varied->section);
    if (!status)
        status = set_name(r);
    if (!status)
        status = br_scene_derive(r);
    struct br_error inner = {0};
    if (!status && br_scene_check(r->scene, &inner))
        status = br_scene_pass_on(r, br_yaml_line(root), "scene", &inner);
    if (!status)
        status = apply_solutions(r);
    if (!status)
        status = check_functions(r, br_yaml_line(root));
    if (!status && asked->take_verify)
        status = asked->take_verify(r, top_value(r, "verify"), asked->self);
    return status;
}

/* libyaml's loader states no error when it has no memory. */
static enum br_status not_yaml(const struct br_scene_reader *r, const yaml_parser_t *parser)
{
    if (parser->error == YAML_MEMORY_ERROR || parser->error == YAML_NO_ERROR)
        return br_no_memory(r->err, "the YAML parser");
    return br_fail(r->err, BR_BAD_INPUT, "%s:%zu: not YAML: %s", r->path,
                   parser->problem_mark.line + 1, parser->problem ? parser->problem : "unreadable");
}

/* Checks what the loader does not. The loader's time grows with the square of the nesting depth. A
 * second document would be ignored. A zero byte, which YAML can write as \0 in quotes, would end a
 * text early. */
static enum br_status check_event(const struct br_scene_reader *r, const yaml_event_t *event,
                                  int depth, int documents)
{
    enum { DEEPEST = 32 };
    const size_t line = event->start_mark.line + 1;
    const char *text = (const char *)event->data.scalar.value;
    if (depth > DEEPEST)
        return br_scene_refuse(r, line, "scene",
                               "found lists or mappings nested more than %d deep, expected a scene",
                               DEEPEST);
    if (documents > 1)
        return br_scene_refuse(r, line, "scene", "a second document begins, expected one");
    if (event->type == YAML_SCALAR_EVENT && strlen(text) != event->data.scalar.length)
        return br_scene_refuse(r, line, "scene",
                               "found '%s' followed by a zero byte, expected text", text);
    return BR_OK;
}

static enum br_status check_events(const struct br_scene_reader *r, yaml_parser_t *parser)
{
    enum br_status status = BR_OK;
    int depth = 0, documents = 0;
    for (bool more = true; more && !status;) {
        yaml_event_t event;
        if (!yaml_parser_parse(parser, &event))
            return not_yaml(r, parser);
        depth += event.type == YAML_SEQUENCE_START_EVENT || event.type == YAML_MAPPING_START_EVENT;
        depth -= event.type == YAML_SEQUENCE_END_EVENT || event.type == YAML_MAPPING_END_EVENT;
        documents += event.type == YAML_DOCUMENT_START_EVENT;
        more = event.type != YAML_STREAM_END_EVENT;
        status = check_event(r, &event, depth, documents);
        yaml_event_delete(&event);
    }
    return status;
}

static enum br_status load(const struct br_scene_reader *r, yaml_parser_t *parser,
                           br_yaml_take *take, void *self)
{
    if (!yaml_parser_load(parser, r->document))
        return not_yaml(r, parser);
    const enum br_status status = take(r, self);
    yaml_document_delete(r->document);
    return status;
}

enum br_status br_yaml_read(const char *path, const char *text, br_yaml_take *take, void *self,
                            struct br_error *err)
{
    yaml_document_t document;
    const struct br_scene_reader r = {.path = path, .document = &document, .err = err};
    enum br_status status = BR_OK;
    for (int pass = 0; pass < 2 && !status; pass++) {
        yaml_parser_t parser;
        if (!yaml_parser_initialize(&parser))
            return br_no_memory(err, "the YAML parser");
        yaml_parser_set_input_string(&parser, (const unsigned char *)text, strlen(text));
        status = pass == 0 ? check_events(&r, &parser) : load(&r, &parser, take, self);
        yaml_parser_delete(&parser);
    }
    return status;
}

/* The scene that a file is read into, and further requests. */
struct target {
    struct br_scene *scene;
    const struct br_scene_asked *asked;
};

static enum br_status take_scene(const struct br_scene_reader *reader, void *self)
{
    const struct target *to = self;
    struct br_scene_given given = {0};
    struct br_scene_reader r = *reader;
    r.scene = to->scene;
    r.given = &given;
    r.varied = to->asked->varied;
    r.text = to->asked->value;
    return read_document(&r, to->asked);
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
