/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A study of any program as a YAML file: one row a key. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "study/orders/request.h"
#include "study/scene/file.h"
#include "study/scene/value.h"
#include "study/scene/words.h"

/* A key on its way. */
struct entry {
    const struct br_scene_reader *r;
    struct br_orders_request *request;
    const struct key *of;
    const char *text; /* NULL where the value is a mapping */
    const yaml_node_t *node;
};

struct key {
    const char *name;
    enum br_status (*take)(const struct entry *e);
    size_t at;        /* of a text or a number in the request */
    const char *unit; /* of a number; NULL: none */
    bool of_runs;
    /* Of a mapping of names to texts, instead: takes each pair. */
    enum br_status (*take_pair)(const struct entry *e, const char *name, const yaml_node_t *value);
};

static enum br_status refuse_inner(const struct entry *e, size_t line, const struct br_error *inner)
{
    if (inner->status != BR_BAD_INPUT)
        return br_fail(e->r->err, inner->status, "%s", inner->message);
    return br_scene_refuse(e->r, line, e->of->name, "%s", inner->message);
}

static enum br_status take_text(const struct entry *e)
{
    char **to = (char **)((char *)e->request + e->of->at);
    *to = strdup(e->text);
    return *to ? BR_OK : br_no_memory(e->r->err, "the study");
}

/* In the folder of the study file. */
static enum br_status take_table(const struct entry *e)
{
    const char *slash = strrchr(e->r->path, '/');
    const int folder = slash && *e->text != '/' ? (int)(slash - e->r->path) + 1 : 0;
    struct br_error inner = {0};
    char **path = &e->request->table_path;
    if (asprintf(path, "%.*s%s", folder, e->r->path, e->text) < 0) {
        *path = NULL;
        return br_no_memory(e->r->err, "the study");
    }
    return br_text_load(*path, BR_LONGEST_TABLE, "table", &e->request->table, &inner)
               ? refuse_inner(e, br_yaml_line(e->node), &inner)
               : BR_OK;
}

static enum br_status take_list(const struct entry *e)
{
    struct br_error inner = {0};
    return br_orders_request_axis(e->request, e->of->name, e->text, &inner)
               ? refuse_inner(e, br_yaml_line(e->node), &inner)
               : BR_OK;
}

/* A number above 0, with the unit that is expected behind it. */
static enum br_status take_number(const struct entry *e)
{
    double *value = (double *)((char *)e->request + e->of->at);
    const char *unit = e->of->unit ? e->of->unit : "", *end = br_read_number(e->text, value);
    end = end ? end + strspn(end, " ") : NULL;
    if (end && strcmp(end, unit) == 0 && *value > 0)
        return BR_OK;
    return br_scene_refuse(e->r, br_yaml_line(e->node), e->of->name,
                           "found '%s', expected a number above 0%s%s", e->text,
                           *unit ? " and its unit, " : "", unit);
}

static enum br_status take_formal(const struct entry *e)
{
    const enum br_status status = take_number(e);
    return status || (e->request->formal >= 1 && e->request->formal <= 10)
               ? status
               : br_scene_refuse(e->r, br_yaml_line(e->node), e->of->name,
                                 "found '%s', expected an order from 1 to 10", e->text);
}

static enum br_status take_pairs(const struct entry *e)
{
    enum br_status status = BR_OK;
    for (yaml_node_pair_t *p = e->node->data.mapping.pairs.start;
         p < e->node->data.mapping.pairs.top && !status; p++) {
        const yaml_node_t *name = yaml_document_get_node(e->r->document, p->key);
        const yaml_node_t *value = yaml_document_get_node(e->r->document, p->value);
        status = name->type != YAML_SCALAR_NODE || value->type != YAML_SCALAR_NODE
                     ? br_scene_refuse(e->r, br_yaml_line(name), e->of->name,
                                       "expected names with a text each")
                     : e->of->take_pair(e, br_yaml_text(name), value);
    }
    return status;
}

static enum br_status take_reading(const struct entry *e, const char *name,
                                   const yaml_node_t *value)
{
    struct br_error inner = {0};
    return br_orders_request_reading(e->request, name, br_yaml_text(value), &inner)
               ? refuse_inner(e, br_yaml_line(value), &inner)
               : BR_OK;
}

static enum br_status take_expectation(const struct entry *e, const char *name,
                                       const yaml_node_t *value)
{
    const size_t line = br_yaml_line(value);
    char *where = NULL, *text = NULL;
    enum br_status status = BR_NO_MEMORY;
    if (asprintf(&where, "%s:%zu: verify", e->r->path, line) < 0)
        where = NULL;
    else if (asprintf(&text, "%s: %s", name, br_yaml_text(value)) < 0)
        text = NULL;
    else
        status = br_expectations_read(where, text, line, &e->request->expectation,
                                      &e->request->expectations, e->r->err);
    free(where);
    free(text);
    return status == BR_NO_MEMORY ? br_no_memory(e->r->err, "the study") : status;
}

static const struct key keys[] = {
    {"title", take_text, .at = offsetof(struct br_orders_request, title)},
    {"run", take_text, .at = offsetof(struct br_orders_request, command)},
    {"table", .take = take_table},
    {"n", take_list, .of_runs = true},
    {"h", take_list, .of_runs = true},
    {"dofs", take_list, .of_runs = true},
    {"k", take_list, .of_runs = true},
    {"dt", take_list, .of_runs = true},
    {"steps", take_list, .of_runs = true},
    {"read", take_pairs, .of_runs = true, .take_pair = take_reading},
    {"error", take_text, .at = offsetof(struct br_orders_request, errors)},
    {"value", take_text, .at = offsetof(struct br_orders_request, values)},
    {"dimension", take_number, .at = offsetof(struct br_orders_request, dimension)},
    {"formal_order", take_formal, .at = offsetof(struct br_orders_request, formal)},
    {"time_limit", take_number, .at = offsetof(struct br_orders_request, seconds), .unit = "s",
     .of_runs = true},
    {"verify", take_pairs, .take_pair = take_expectation},
};
enum { KEYS = sizeof keys / sizeof *keys };

static enum br_status take_entry(const struct br_scene_reader *r, const yaml_node_pair_t *pair,
                                 bool seen[KEYS], struct br_orders_request *request)
{
    const yaml_node_t *name = yaml_document_get_node(r->document, pair->key);
    const yaml_node_t *value = yaml_document_get_node(r->document, pair->value);
    if (name->type != YAML_SCALAR_NODE)
        return br_scene_refuse(r, br_yaml_line(name), "study", "expected a key");
    const char *text = br_yaml_text(name);
    for (size_t i = 0; i < KEYS; i++) {
        if (strcmp(keys[i].name, text) != 0)
            continue;
        if (seen[i])
            return br_scene_refuse(r, br_yaml_line(name), text, "is given twice");
        if (value->type != (keys[i].take_pair ? YAML_MAPPING_NODE : YAML_SCALAR_NODE))
            return br_scene_refuse(r, br_yaml_line(value), text, "expected %s",
                                   keys[i].take_pair ? "names with a text each" : "one text");
        seen[i] = true;
        return keys[i].take(&(struct entry){r, request, &keys[i],
                                            keys[i].take_pair ? NULL : br_yaml_text(value), value});
    }
    char known[400] = "";
    for (size_t i = 0; i < KEYS; i++)
        snprintf(known + strlen(known), sizeof known - strlen(known), "%s%s", i ? ", " : "",
                 keys[i].name);
    return br_scene_refuse(r, br_yaml_line(name), text, "unknown key, expected one of: %s", known);
}

/* What is said of runs alone. */
static enum br_status check_table(const struct br_scene_reader *r, const bool seen[KEYS])
{
    const yaml_node_t *root = yaml_document_get_root_node(r->document);
    for (size_t i = 0; i < KEYS; i++)
        if (seen[i] && keys[i].of_runs)
            return br_scene_refuse(r, br_yaml_line(root), keys[i].name,
                                   "is given beside 'table', expected beside 'run' only");
    return BR_OK;
}

static enum br_status take_study(const struct br_scene_reader *r, void *self)
{
    struct br_orders_request *request = self;
    const yaml_node_t *root = yaml_document_get_root_node(r->document);
    bool seen[KEYS] = {false};
    enum br_status status = BR_OK;
    if (!root || root->type != YAML_MAPPING_NODE)
        return br_scene_refuse(r, 1, "study", "expected a mapping of keys to values");
    for (yaml_node_pair_t *p = root->data.mapping.pairs.start;
         p < root->data.mapping.pairs.top && !status; p++)
        status = take_entry(r, p, seen, request);
    if (!status && !request->command == !request->table)
        status = br_scene_refuse(r, br_yaml_line(root), "study",
                                 "expected 'run' or 'table', one of the two");
    if (!status && request->table)
        status = check_table(r, seen);
    if (!status && request->command && request->readings == 0)
        status = br_scene_refuse(r, br_yaml_line(root), "read",
                                 "missing, expected what is read of the output");
    return status;
}

enum br_status br_orders_request_read(const char *path, const char *text,
                                      struct br_orders_request *request, struct br_error *err)
{
    *request = br_orders_request_default();
    const char *slash = strrchr(path, '/');
    request->path = strdup(path);
    request->folder = slash ? strndup(path, (size_t)(slash - path) + 1) : strdup(".");
    return request->path && request->folder ? br_yaml_read(path, text, take_study, request, err)
                                            : br_no_memory(err, "the study");
}

bool br_is_study_file(const char *text)
{
    for (const char *line = text; line; line = strchr(line, '\n')) {
        line += *line == '\n';
        if (strncmp(line, "run:", 4) == 0 || strncmp(line, "table:", 6) == 0)
            return true;
    }
    return false;
}
