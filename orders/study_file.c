/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A study of any program in a YAML file; each key has a row in `keys`. */
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/load.h"
#include "base/words.h"
#include "base/yaml_text.h"
#include "orders/request.h"

/* A value of the study file. */
struct entry {
    struct br_orders_request *request;
    const struct key *of;
    const char *path;        /* of the study file */
    const char *name, *text; /* of the key, or of one of its pairs */
    size_t line;
    struct br_error *err;
};

struct key {
    const char *name;
    enum br_status (*take)(const struct entry *e); /* its error gets the file and the key */
    size_t at;                                     /* offset of a text or a number in the request */
    const char *unit;                              /* of a number; NULL: none */
    struct br_number_range range;                  /* of a number; zeros: above 0 */
    bool of_runs;                                  /* only for a command */
    bool pairs; /* a mapping of names to texts; each pair is taken */
};

static enum br_status take_text(const struct entry *e)
{
    char **to = (char **)((char *)e->request + e->of->at);
    *to = strdup(e->text);
    return *to ? BR_OK : br_no_memory(e->err, "the study");
}

static bool is_outside(const char *path, const char *folder)
{
    char file[PATH_MAX], in[PATH_MAX];
    if (!realpath(path, file) || !realpath(folder, in))
        return true;
    const size_t length = strcmp(in, "/") == 0 ? 0 : strlen(in);
    return strncmp(file, in, length) != 0 || file[length] != '/';
}

/* The length of a study file's folder in its path; 0: the folder is this one. So it is for a pipe,
 * whose name is /dev/stdin or /dev/fd/63. */
static int folder_length(const char *path)
{
    const char *slash = strncmp(path, "/dev/", 5) ? strrchr(path, '/') : NULL;
    return slash ? (int)(slash - path) + 1 : 0;
}

/* The path is relative to the folder of the study file. */
static enum br_status take_table(const struct entry *e)
{
    const int folder = *e->text != '/' ? folder_length(e->path) : 0;
    char **path = &e->request->table_path;
    if (asprintf(path, "%.*s%s", folder, e->path, e->text) < 0) {
        *path = NULL;
        return br_no_memory(e->err, "the study");
    }
    e->request->table_is_outside = is_outside(*path, e->request->folder);
    return br_text_load(*path, BR_LONGEST_TABLE, "table", &e->request->table, e->err);
}

static enum br_status take_list(const struct entry *e)
{
    return br_orders_request_axis(e->request, e->name, e->text, e->err);
}

/* A number above 0, with the unit that is expected behind it. */
static enum br_status take_number(const struct entry *e)
{
    double *value = (double *)((char *)e->request + e->of->at);
    const char *unit = e->of->unit ? e->of->unit : "", *end = br_read_number(e->text, value);
    end = end ? end + strspn(end, " ") : NULL;
    if (end && strcmp(end, unit) == 0 && *value > 0)
        return BR_OK;
    return br_fail(e->err, BR_BAD_INPUT, "found '%s', expected a number above 0%s%s", e->text,
                   *unit ? " and its unit, " : "", unit);
}

static enum br_status take_in_range(const struct entry *e)
{
    double *value = (double *)((char *)e->request + e->of->at);
    return br_read_in_range(e->text, &e->of->range, value, e->err);
}

static enum br_status take_dimension(const struct entry *e)
{
    e->request->assumed_dimension = false;
    return take_in_range(e);
}

static enum br_status take_reading(const struct entry *e)
{
    return br_orders_request_reading(e->request, e->name, e->text, e->err);
}

static enum br_status take_expectation(const struct entry *e)
{
    char *text;
    if (asprintf(&text, "%s: %s", e->name, e->text) < 0)
        return br_no_memory(e->err, "the study");
    const enum br_status status = br_expectations_read(text, e->line, &e->request->expectation,
                                                       &e->request->expectations, e->err);
    free(text);
    return status;
}

static const struct key keys[] = {
    {"title", take_text, .at = offsetof(struct br_orders_request, title)},
    {"run", take_text, .at = offsetof(struct br_orders_request, command)},
    {"table", .take = take_table},
    {"n", take_list, .of_runs = true},
    {"h", take_list, .of_runs = true},
    {"dofs", take_list, .of_runs = true},
    {"cells", take_list, .of_runs = true},
    {"points", take_list, .of_runs = true},
    {"interior", take_list, .of_runs = true},
    {"level", take_list, .of_runs = true},
    {"k", take_list, .of_runs = true},
    {"dt", take_list, .of_runs = true},
    {"steps", take_list, .of_runs = true},
    {"read", take_reading, .of_runs = true, .pairs = true},
    {"column", take_text, .at = offsetof(struct br_orders_request, columns)},
    {"where", take_text, .at = offsetof(struct br_orders_request, where)},
    {"finest", take_in_range, .at = offsetof(struct br_orders_request, finest),
     .range = {BR_ORDERS_LEAST, BR_MOST_SIZES, true}},
    {"without", take_text, .at = offsetof(struct br_orders_request, without)},
    {"error", take_text, .at = offsetof(struct br_orders_request, errors)},
    {"value", take_text, .at = offsetof(struct br_orders_request, values)},
    {"dimension", take_dimension, .at = offsetof(struct br_orders_request, dimension),
     .range = {1, BR_MOST_DIMENSIONS, true}},
    {"formal_order", take_in_range, .at = offsetof(struct br_orders_request, formal),
     .range = {0, 11, false}},
    {"repeat", take_in_range, .at = offsetof(struct br_orders_request, repeat), .of_runs = true,
     .range = {1, BR_MOST_SIZES, true}},
    {"time_limit", take_number, .at = offsetof(struct br_orders_request, seconds), .unit = "s",
     .of_runs = true},
    {"verify", take_expectation, .pairs = true},
};
enum { KEYS = sizeof keys / sizeof *keys };

/* name: of the key, or of a pair. */
static enum br_status take_scalar(const struct br_yaml *r, const struct key *key,
                                  const yaml_node_t *name, const yaml_node_t *value,
                                  struct br_orders_request *request)
{
    struct br_error inner = {0};
    const size_t line = br_yaml_line(value);
    if (name->type != YAML_SCALAR_NODE || value->type != YAML_SCALAR_NODE)
        return br_yaml_refuse(r, key->pairs ? br_yaml_line(name) : line, key->name, "expected %s",
                              key->pairs ? "names with a text each" : "one text");
    key->take(&(struct entry){request, key, r->path, br_yaml_text(name), br_yaml_text(value), line,
                              &inner});
    return br_yaml_pass_on(r, line, key->name, &inner);
}

static enum br_status take_pairs(const struct br_yaml *r, const struct key *key,
                                 const yaml_node_t *node, struct br_orders_request *request)
{
    enum br_status status = BR_OK;
    if (node->type != YAML_MAPPING_NODE)
        return br_yaml_refuse(r, br_yaml_line(node), key->name, "expected names with a text each");
    for (yaml_node_pair_t *p = node->data.mapping.pairs.start;
         p < node->data.mapping.pairs.top && !status; p++)
        status = take_scalar(r, key, yaml_document_get_node(r->document, p->key),
                             yaml_document_get_node(r->document, p->value), request);
    return status;
}

static enum br_status take_entry(const struct br_yaml *r, const yaml_node_pair_t *pair,
                                 bool given[KEYS], struct br_orders_request *request)
{
    const yaml_node_t *name = yaml_document_get_node(r->document, pair->key);
    const yaml_node_t *value = yaml_document_get_node(r->document, pair->value);
    if (name->type != YAML_SCALAR_NODE)
        return br_yaml_refuse(r, br_yaml_line(name), "study", "expected a key");
    const char *text = br_yaml_text(name), *names[KEYS];
    char expected[BR_EXPECTED];
    for (size_t i = 0; i < KEYS; i++) {
        names[i] = keys[i].name;
        if (strcmp(keys[i].name, text) != 0)
            continue;
        if (given[i])
            return br_yaml_refuse(r, br_yaml_line(name), text, "is given twice");
        given[i] = true;
        return keys[i].pairs ? take_pairs(r, &keys[i], value, request)
                             : take_scalar(r, &keys[i], name, value, request);
    }
    return br_yaml_refuse(r, br_yaml_line(name), text, "unknown key, %s",
                          br_expected(text, names, KEYS, expected));
}

/* Refuses keys of runs in a study of a table. */
static enum br_status check_table(const struct br_yaml *r, const bool given[KEYS])
{
    const yaml_node_t *root = yaml_document_get_root_node(r->document);
    for (size_t i = 0; i < KEYS; i++)
        if (given[i] && keys[i].of_runs)
            return br_yaml_refuse(r, br_yaml_line(root), keys[i].name,
                                  "is given beside 'table', expected beside 'run' only");
    return BR_OK;
}

static enum br_status take_study(const struct br_yaml *r, void *self)
{
    struct br_orders_request *request = self;
    const yaml_node_t *root = yaml_document_get_root_node(r->document);
    bool given[KEYS] = {false};
    enum br_status status = BR_OK;
    if (!root || root->type != YAML_MAPPING_NODE)
        return br_yaml_refuse(r, 1, "study", "expected a mapping of keys to values");
    for (yaml_node_pair_t *p = root->data.mapping.pairs.start;
         p < root->data.mapping.pairs.top && !status; p++)
        status = take_entry(r, p, given, request);
    if (!status && !request->command == !request->table)
        status = br_yaml_refuse(r, br_yaml_line(root), "study",
                                "expected 'run' or 'table', one of the two");
    if (!status && request->table)
        status = check_table(r, given);
    if (!status && request->command && request->readings == 0)
        status = br_yaml_refuse(r, br_yaml_line(root), "read",
                                "missing, expected what is read of the output");
    return status;
}

enum br_status br_orders_request_read(const char *path, const char *text,
                                      struct br_orders_request *request, struct br_error *err)
{
    *request = br_orders_request_default();
    const int folder = folder_length(path);
    request->path = strdup(path);
    request->folder = folder ? strndup(path, (size_t)folder) : strdup(".");
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
