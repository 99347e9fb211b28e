/* SPDX-License-Identifier: GPL-3.0-or-later */
/* --set KEY=VALUE: keys of a scene's document have other values before the scene is read. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/quote.h"
#include "base/text.h"
#include "base/words.h"
#include "study/scene/value.h"

/* Places the new node, if there is one, at a line; returns it. */
static int placed(const struct br_scene_reader *r, int node, size_t line)
{
    if (node)
        yaml_document_get_node(r->yaml.document, node)->start_mark.line = line - 1;
    return node;
}

static int add_text(const struct br_scene_reader *r, const char *text, size_t line)
{
    return placed(r,
                  yaml_document_add_scalar(r->yaml.document, NULL, (const yaml_char_t *)text,
                                           (int)strlen(text), YAML_ANY_SCALAR_STYLE),
                  line);
}

/* A new mapping with the pairs of another one, for which another key may stand by an alias. from 0:
 * without pairs. Returns 0 without memory. */
static int add_mapping(const struct br_scene_reader *r, int from, size_t line)
{
    yaml_document_t *d = r->yaml.document;
    const int to = yaml_document_add_mapping(d, NULL, YAML_ANY_MAPPING_STYLE);
    const yaml_node_t *old = from ? yaml_document_get_node(d, from) : NULL;
    bool whole = placed(r, to, old ? br_yaml_line(old) : line);
    for (size_t i = 0;
         old && whole && old->data.mapping.pairs.start + i < old->data.mapping.pairs.top; i++) {
        const yaml_node_pair_t *p = old->data.mapping.pairs.start + i;
        whole = yaml_document_append_mapping_pair(d, to, p->key, p->value);
    }
    return whole ? to : 0;
}

static yaml_node_pair_t *find(const struct br_scene_reader *r, int mapping, const char *name)
{
    const yaml_node_t *node = yaml_document_get_node(r->yaml.document, mapping);
    for (yaml_node_pair_t *p = node->data.mapping.pairs.start; p < node->data.mapping.pairs.top;
         p++) {
        const yaml_node_t *key = yaml_document_get_node(r->yaml.document, p->key);
        if (key->type == YAML_SCALAR_NODE && strcmp(br_yaml_text(key), name) == 0)
            return p;
    }
    return NULL;
}

/* Goes from a mapping (*at) to the value of one of its keys, which is made where there is none.
 * value NULL: a mapping. */
static enum br_status descend(const struct br_scene_reader *r, int *at, const char *name,
                              const char *value, size_t line)
{
    yaml_node_pair_t *pair = find(r, *at, name);
    const int old = pair ? pair->value : 0;
    if (old && !value && yaml_document_get_node(r->yaml.document, old)->type != YAML_MAPPING_NODE)
        return br_scene_refuse(r, line, name, "has a value, expected a mapping of keys to values");
    const int new = value ? add_text(r, value, line) : add_mapping(r, old, line);
    const int key = pair ? pair->key : add_text(r, name, line);
    if (!new || !key ||
        (!pair && !yaml_document_append_mapping_pair(r->yaml.document, *at, key, new)))
        return br_no_memory(r->yaml.err, "the scene");
    if (pair)
        pair->value = new;
    *at = new;
    return BR_OK;
}

/* Without the blanks before the '='. */
static size_t key_length(const char *set)
{
    size_t length = strcspn(set, "=\n");
    while (length && set[length - 1] == ' ')
        length--;
    return length;
}

/* set: one KEY=VALUE, which is taken apart. */
static enum br_status put(const struct br_scene_reader *r, char *set, size_t line)
{
    char *value = strchr(set, '='), *rest = set;
    if (!value || br_not_utf8(set))
        return br_fail(r->yaml.err, BR_BAD_INPUT,
                       "--set: found '%.200s', expected KEY=VALUE in UTF-8, like "
                       "'contact.stiffness=2e3 N/m'",
                       set);
    set[key_length(set)] = '\0';
    value++;
    value += strspn(value, " ");
    for (size_t length = strlen(value); length && value[length - 1] == ' ';)
        value[--length] = '\0';
    for (int at = 1; rest;) {
        const char *name = strsep(&rest, ".");
        if (descend(r, &at, name, rest ? NULL : value, line))
            return r->yaml.err->status;
    }
    return BR_OK;
}

/* Whether two of them set the same key, or one sets a part of what the other one sets. */
static bool meet(const char *a, const char *b)
{
    const size_t m = key_length(a), n = key_length(b), least = m < n ? m : n;
    return strncmp(a, b, least) == 0 && (m == n || (m < n ? b : a)[least] == '.');
}

enum br_status br_scene_put_sets(const struct br_scene_reader *r, bool verifies)
{
    const yaml_node_t *root = yaml_document_get_root_node(r->yaml.document);
    char place[2][BR_PLACE];
    size_t line = BR_LAST_LINE + 1;
    if (!root || root->type != YAML_MAPPING_NODE)
        return BR_OK; /* the reader refuses the file */
    for (const char *set = r->yaml.set; set; line++) {
        size_t before = BR_LAST_LINE + 1;
        for (const char *other = r->yaml.set; other < set;
             other = strchr(other, '\n') + 1, before++)
            if (meet(other, set))
                return br_fail(r->yaml.err, BR_BAD_INPUT,
                               "%s and %s are given, expected one of the two",
                               br_yaml_place(&r->yaml, before, place[0]),
                               br_yaml_place(&r->yaml, line, place[1]));
        if (!verifies && meet(set, "verify="))
            return br_scene_refuse(r, line, "verify", "only 'beamrate check' uses it");
        const char *end = strchr(set, '\n');
        char *word = strndup(set, strcspn(set, "\n"));
        const enum br_status status =
            word ? put(r, word, line) : br_no_memory(r->yaml.err, "the scene");
        free(word);
        if (status)
            return status;
        set = end ? end + 1 : NULL;
    }
    return BR_OK;
}

enum br_status br_scene_add_to_title(const struct br_scene_reader *r)
{
    char *title;
    size_t size;
    FILE *out = br_text_open(&title, &size);
    if (out)
        fprintf(out, "%s, with ", r->scene->title);
    for (const char *c = r->yaml.set; out && *c; c++)
        *c == '\n' ? fputs("; ", out) : fputc(*c, out);
    if (!out || fclose(out) != 0)
        return br_no_memory(r->yaml.err, "the scene");
    free(r->scene->title);
    r->scene->title = title;
    return BR_OK;
}

enum br_status br_scene_write_text(const struct br_scene_reader *r, char **text)
{
    yaml_emitter_t emitter;
    size_t size;
    FILE *out = br_text_open(text, &size);
    bool done = out && yaml_emitter_initialize(&emitter);
    if (done) {
        yaml_emitter_set_output_file(&emitter, out);
        yaml_emitter_set_unicode(&emitter, 1);
        yaml_emitter_set_width(&emitter, -1);
        done = yaml_emitter_open(&emitter);
        if (done) { /* which releases the document, but leaves its directives in it */
            done = yaml_emitter_dump(&emitter, r->yaml.document) && yaml_emitter_close(&emitter);
            *r->yaml.document = (yaml_document_t){0};
        }
        yaml_emitter_delete(&emitter);
    }
    if (out && fclose(out) == 0 && done)
        return BR_OK;
    if (out)
        free(*text);
    *text = NULL;
    return br_no_memory(r->yaml.err, "the scene");
}
