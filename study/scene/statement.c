/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/scene/statement.h"

#include <stdio.h>
#include <stdlib.h>

#include "base/text.h"
#include "study/known/expression.h"
#include "study/scene/method_fields.h"
#include "study/scene/value.h"

static void state_number(struct br_statement *s, const char *name, double value)
{
    if (s->everywhere)
        br_state(s, name, "%.9g", value);
    else
        br_state(s, name, "%a", value);
}

static void state_function(struct br_statement *s, size_t i, const struct br_function *f)
{
    const struct br_tree *tree = br_tree_of(f);
    s->failed |= f->ops && !tree;
    br_state(s, "function", "%zu", i);
    if (!tree)
        state_number(s, "number", f->constant);
    for (size_t k = 0; tree && k < tree->count; k++) {
        const struct br_node *n = &tree->node[k];
        if (n->operation == BR_OP_NUMBER)
            state_number(s, "number", n->number);
        else
            br_state(s, "node", "%s%u %u %u %u", br_operations[n->operation].word,
                     br_operations[n->operation].arguments, n->argument[0], n->argument[1],
                     n->argument[2]);
    }
}

/* The compiler warns here of a new kind of key. */
static void state_key(struct br_statement *s, const struct br_scene_key *key,
                      const struct br_scene *scene)
{
    const void *at = (const char *)scene + key->offset;
    char name[64];
    snprintf(name, sizeof name, "%s.%s", key->section, key->name);
    switch (key->kind) {
    case BR_KEY_POSITIVE:
    case BR_KEY_NOT_NEGATIVE:
        if (key->need != BR_MAKES)
            state_number(s, name, *(const double *)at);
        break;
    case BR_KEY_SECTION:
        if (key->offset)
            br_state(s, name, "%d", *(const bool *)at);
        break;
    case BR_KEY_TEXT:
    case BR_KEY_SOLUTION: {
        const char *text = *(char *const *)at;
        br_state(s, name, "%s", text ? text : "");
        break;
    }
    case BR_KEY_LAW:
        br_state(s, name, "%d", (int)scene->friction.law);
        break;
    case BR_KEY_LOAD: /* functions follow */
    case BR_KEY_INITIAL:
    case BR_KEY_HISTORY:
    case BR_KEY_SHAPE: /* other numbers are made of it */
    case BR_KEY_VERIFY:
        break;
    }
}

void br_state_scene(struct br_statement *s, const struct br_scene *scene)
{
    struct br_scene borrowed = *scene;
    const struct br_function *f;
    for (const struct br_scene_key *key = br_scene_keys; key->name; key++)
        state_key(s, key, scene);
    for (size_t i = 0; (f = br_scene_function(&borrowed, i)); i++)
        if (!br_function_is_zero(f))
            state_function(s, i, f);
}

/* ---- a method ---- */

void br_state_method(struct br_statement *s, const struct br_method *m)
{
    char value[BR_METHOD_VALUE];
    for (const struct br_method_field *f = br_method_fields;
         f < br_method_fields + BR_METHOD_FIELDS; f++)
        if (!f->unsaid || !s->everywhere)
            br_state(s, f->name, "%s", br_method_field_text(f, m, value));
    br_state(s, "iterations", "%zu", m->iteration.most);
    br_state(s, "most_steps", "%zu", m->most_steps);
}

/* ---- a scene's file ---- */

/* One line of br_scene_data: a number in the unit of its key, however the file writes it; other
 * values as they are. */
static void print_value(const struct br_scene_reader *r, const struct br_scene_key *k, FILE *out)
{
    const yaml_node_t *section = *k->section ? br_yaml_value(&r->yaml, NULL, k->section) : NULL;
    const yaml_node_t *node = br_yaml_value(&r->yaml, section, k->name);
    fprintf(out, "%s%s%s:", k->section, *k->section ? "." : "", k->name);
    if (k->kind == BR_KEY_POSITIVE || k->kind == BR_KEY_NOT_NEGATIVE)
        fprintf(out, " %.15g %s", *(const double *)((const char *)r->scene + k->offset), k->unit);
    else if (node->type == YAML_SCALAR_NODE)
        fprintf(out, " %s", br_yaml_text(node));
    else
        for (int factor = 0; factor < 2; factor++)
            fprintf(out, "%s %s", factor ? " times" : "",
                    br_yaml_text(br_yaml_value(&r->yaml, node, factor ? "history" : "shape")));
    fputc('\n', out);
}

enum br_status br_scene_data(const struct br_scene_reader *r, char **data)
{
    size_t size;
    FILE *out = br_text_open(data, &size);
    for (const struct br_scene_key *k = br_scene_keys; out && k->name; k++)
        if (br_scene_line(r, k) && k->need != BR_MAKES && k->kind != BR_KEY_SECTION &&
            k->kind != BR_KEY_TEXT && k->kind != BR_KEY_VERIFY)
            print_value(r, k, out);
    return out && fclose(out) == 0 ? BR_OK : br_no_memory(r->yaml.err, "the scene's data");
}
