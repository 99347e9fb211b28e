/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/verify/verify.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "study/scene/method_fields.h"
#include "study/scene/value.h"
#include "study/scene/words.h"

/* One study on its way: its lists are put together when both are known. */
struct block {
    const struct br_scene_reader *r;
    enum br_verify_kind kind;
    struct br_verify_study *study;
    size_t *n, n_count, n_line; /* as given; line 0: not yet */
    double *k;
    size_t k_count, k_line;
    const char *text[BR_METHOD_FIELDS]; /* of the method; NULL: not given */
    size_t line[BR_METHOD_FIELDS];
    char keys[512]; /* for messages */
};

/* The keys of a study. */
static const char *expected_study(struct block *b)
{
    char *const text = b->keys;
    size_t used = (size_t)snprintf(text, sizeof b->keys, "n, k, ");
    for (size_t i = 0; i < BR_METHOD_FIELDS; i++)
        if (!br_method_fields[i].unsaid)
            used += (size_t)snprintf(text + used, sizeof b->keys - used, "%s, ",
                                     br_method_field_key(&br_method_fields[i]));
    snprintf(text + used, sizeof b->keys - used,
             "or a norm (l2, energy, tip) and a part (axial, bending; without one: the total)");
    return text;
}

/* ---- n and k ---- */

static enum br_status read_meshes(struct block *b, const yaml_node_t *node)
{
    struct br_error inner = {0};
    b->n_line = br_yaml_line(node);
    if (br_read_counts("the list", br_yaml_text(node), &b->n, &b->n_count, &inner))
        return br_scene_pass_on(b->r, b->n_line, "n", &inner);
    return BR_OK;
}

/* "8e-3, 4e-3 s" */
static enum br_status read_steps(struct block *b, const yaml_node_t *node)
{
    struct br_error inner = {0};
    b->k_line = br_yaml_line(node);
    const char *text = br_yaml_text(node);
    const size_t length = strlen(text);
    char numbers[1024];
    if (length < 2 || length >= sizeof numbers || strcmp(text + length - 2, " s") != 0)
        return br_scene_refuse(
            b->r, b->k_line, "k",
            "found '%s', expected time steps and their unit, like '8e-3, 4e-3 s'", text);
    snprintf(numbers, sizeof numbers, "%.*s", (int)(length - 2), text);
    if (br_read_numbers("the list", numbers, &b->k, &b->k_count, &inner))
        return br_scene_pass_on(b->r, b->k_line, "k", &inner);
    return BR_OK;
}

static enum br_status check_counts(const struct block *b)
{
    static const char *const expected[BR_VERIFY_KINDS] = {
        "expected meshes and one time step", "expected one mesh and time steps",
        "expected as many meshes as time steps, or one mesh for all"};
    const bool fits[BR_VERIFY_KINDS] = {b->k_count == 1, b->n_count == 1,
                                        b->n_count == 1 || b->n_count == b->k_count};
    if (fits[b->kind])
        return BR_OK;
    return br_scene_refuse(b->r, b->study->line, br_verify_names[b->kind],
                           "found %zu n and %zu k, %s", b->n_count, b->k_count, expected[b->kind]);
}

/* The cells from the two lists; a list of one goes with all of the other. */
static enum br_status make_cells(struct block *b)
{
    struct br_verify_study *v = b->study;
    const size_t count = b->n_count > b->k_count ? b->n_count : b->k_count;
    v->n = br_allocate(count, sizeof *v->n);
    v->steps = br_allocate(count, sizeof *v->steps);
    if (!v->n || !v->steps)
        return br_no_memory(b->r->err, "what is expected");
    v->count = count;
    if (b->kind == BR_VERIFY_JOINT && b->n_count == b->k_count)
        for (size_t i = 1; i < count; i++)
            if (!(b->n[i] >= b->n[i - 1] && b->k[i] < b->k[i - 1]))
                return br_scene_refuse(
                    b->r, v->line, "joint",
                    "n = %zu and k = %g s follow n = %zu and k = %g s, expected both "
                    "lists from coarse to fine",
                    b->n[i], b->k[i], b->n[i - 1], b->k[i - 1]);
    for (size_t i = 0; i < count; i++) {
        struct br_error inner = {0};
        v->n[i] = b->n[b->n_count == 1 ? 0 : i];
        if (br_steps_of(b->r->scene, b->k[b->k_count == 1 ? 0 : i], &v->steps[i], &inner))
            return br_scene_pass_on(b->r, b->k_line, "k", &inner);
    }
    br_sort_counts(v->n, count);
    br_sort_counts(v->steps, count);
    return BR_OK;
}

/* ---- expectations ---- */

/* "l2", "l2 axial": the norm and the part; false: it is neither. */
static bool parse_what(const char *text, struct br_expectation *e)
{
    char norm[64], part[64] = "total", rest;
    const int words = sscanf(text, "%63s %63s %c", norm, part, &rest);
    if (words < 1 || words > 2)
        return false;
    e->norm = br_norm_find(norm);
    for (int p = 0; p < BR_PARTS; p++)
        if (strcmp(br_part_names[p], part) == 0) {
            e->part = (enum br_part)p;
            return e->norm != NULL;
        }
    return false;
}

static const char *skip(const char *text, const char *word)
{
    while (text && *text == ' ')
        text++;
    const size_t length = strlen(word);
    if (!text || strncmp(text, word, length) != 0)
        return NULL;
    text += length;
    while (*text == ' ')
        text++;
    return text;
}

/* "at most 3e-4 m^(3/2)" or "constant 2e-4 to 3e-4 m^(3/2)" */
static bool parse_range(const char *text, struct br_expectation *e)
{
    const char *ceiling = skip(text, "at most");
    if (!ceiling) {
        const char *floor = skip(text, "constant");
        floor = floor ? br_read_number(floor, &e->floor) : NULL;
        ceiling = skip(floor, "to");
    }
    const char *end = ceiling ? br_read_number(ceiling, &e->ceiling) : NULL;
    end = skip(end, e->norm->unit);
    return end && !*end;
}

/* "2 +- 0.1", and perhaps a range of the constant behind a comma */
static bool parse_expectation(const char *text, struct br_expectation *e)
{
    e->floor = e->ceiling = NAN;
    const char *end = br_read_number(text, &e->order);
    end = skip(end, "+-");
    end = end ? br_read_number(end, &e->tolerance) : NULL;
    if (!end || !*end)
        return end != NULL;
    end = skip(end, ",");
    return end && parse_range(end, e);
}

static enum br_status read_expectation(struct block *b, const char *what, const yaml_node_t *node)
{
    const size_t line = br_yaml_line(node);
    struct br_expectation e = {.line = line};
    if (!parse_what(what, &e))
        return br_scene_refuse(b->r, line, what, "unknown key in verify %s, expected %s",
                               br_verify_names[b->kind], expected_study(b));
    if (!parse_expectation(br_yaml_text(node), &e))
        return br_scene_refuse(
            b->r, line, what,
            "found '%s', expected an order with its tolerance, and perhaps a range "
            "of the constant, like '2 +- 0.1, at most 3e-4 %s' or '2 +- 0.1, constant "
            "2e-4 to 3e-4 %s'",
            br_yaml_text(node), e.norm->unit, e.norm->unit);
    if (b->study->expectations == BR_MOST_EXPECTATIONS)
        return br_scene_refuse(b->r, line, what, "given twice");
    b->study->expectation[b->study->expectations++] = e;
    return BR_OK;
}

/* ---- a study ---- */

static bool is_key(const struct br_method_field *f, const char *key)
{
    return !f->unsaid && strcmp(br_method_field_key(f), key) == 0;
}

static enum br_status read_key(struct block *b, const yaml_node_t *name, const yaml_node_t *value)
{
    if (name->type != YAML_SCALAR_NODE || value->type != YAML_SCALAR_NODE)
        return br_scene_refuse(b->r, br_yaml_line(name), br_verify_names[b->kind],
                               "found a list or a mapping, expected one line each of %s",
                               expected_study(b));
    const char *key = br_yaml_text(name);
    const bool is_n = strcmp(key, "n") == 0;
    if (is_n || strcmp(key, "k") == 0) {
        if (is_n ? b->n_line : b->k_line)
            return br_scene_refuse(b->r, br_yaml_line(name), key, "given twice");
        return is_n ? read_meshes(b, value) : read_steps(b, value);
    }
    size_t field = 0;
    while (field < BR_METHOD_FIELDS && !is_key(&br_method_fields[field], key))
        field++;
    if (field == BR_METHOD_FIELDS)
        return read_expectation(b, key, value);
    if (b->text[field])
        return br_scene_refuse(b->r, br_yaml_line(name), key, "given twice");
    b->text[field] = br_yaml_text(value);
    b->line[field] = br_yaml_line(value);
    return BR_OK;
}

/* The fields one by one, which say in what line they are refused, then all together. */
static enum br_status read_method(struct block *b)
{
    struct br_method *m = &b->study->method;
    const struct br_method *const methods[] = {m};
    struct br_error inner = {0};
    *m = br_method_default();
    for (size_t i = 0; i < BR_METHOD_FIELDS; i++)
        if (b->text[i] && br_method_field_read(&br_method_fields[i], b->text[i], m, &inner))
            return br_scene_pass_on(b->r, b->line[i], br_method_field_key(&br_method_fields[i]),
                                    &inner);
    enum br_status status = br_method_read(b->text, BR_METHOD_IN_SCENE, m, &inner);
    if (!status)
        status = br_method_check_heeded(b->text, BR_METHOD_IN_SCENE, methods, 1, &inner);
    return br_scene_pass_on(b->r, b->study->line, br_verify_names[b->kind], &inner);
}

static enum br_status read_block(struct block *b, const yaml_node_t *node)
{
    const struct br_scene_reader *r = b->r;
    const char *name = br_verify_names[b->kind];
    if (b->study->line)
        return br_scene_refuse(r, br_yaml_line(node), name, "given twice");
    b->study->line = br_yaml_line(node);
    if (node->type != YAML_MAPPING_NODE)
        return br_scene_refuse(r, br_yaml_line(node), name, "expected a mapping with %s",
                               expected_study(b));
    enum br_status status = BR_OK;
    for (yaml_node_pair_t *p = node->data.mapping.pairs.start;
         p < node->data.mapping.pairs.top && !status; p++)
        status = read_key(b, yaml_document_get_node(r->document, p->key),
                          yaml_document_get_node(r->document, p->value));
    if (!status && (!b->n_line || !b->k_line))
        status =
            br_scene_refuse(r, b->study->line, b->n_line ? "k" : "n", "missing in verify %s", name);
    if (!status)
        status = read_method(b);
    if (!status)
        status = check_counts(b);
    return status ? status : make_cells(b);
}

enum br_status br_verify_read(const struct br_scene_reader *r, const yaml_node_t *node,
                              struct br_verify *verify)
{
    *verify = (struct br_verify){0};
    if (node->type != YAML_MAPPING_NODE)
        return br_scene_refuse(r, br_yaml_line(node), "verify",
                               "expected a mapping with space, time or joint");
    for (yaml_node_pair_t *p = node->data.mapping.pairs.start; p < node->data.mapping.pairs.top;
         p++) {
        const yaml_node_t *name = yaml_document_get_node(r->document, p->key);
        const char *key =
            name->type == YAML_SCALAR_NODE ? br_yaml_text(name) : "a list or a mapping";
        int kind = 0;
        while (kind < BR_VERIFY_KINDS && strcmp(key, br_verify_names[kind]) != 0)
            kind++;
        if (kind == BR_VERIFY_KINDS)
            return br_scene_refuse(r, br_yaml_line(name), key,
                                   "unknown key in verify, expected space, time or joint");
        struct block b = {.r = r, .kind = (enum br_verify_kind)kind, .study = &verify->study[kind]};
        const enum br_status status = read_block(&b, yaml_document_get_node(r->document, p->value));
        free(b.n);
        free(b.k);
        if (status)
            return status;
    }
    struct br_error inner = {0};
    size_t line;
    if (br_verify_check(r->scene, verify, &line, &inner))
        return br_scene_pass_on(r, line ? line : br_yaml_line(node), "verify", &inner);
    return BR_OK;
}
