/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/verify/verify.h"

#include <stdio.h>
#include <string.h>

#include "base/words.h"
#include "study/scene/file.h"
#include "study/scene/method_fields.h"
#include "study/scene/value.h"

enum { MESHES, STEPS, FIELDS, KEYS = FIELDS + BR_METHOD_FIELDS };

/* One study while it is read. */
struct study_part {
    const struct br_scene_reader *r;
    enum br_verify_kind kind;
    struct br_verify_study *study;
    const char *text[KEYS]; /* n, k and the method's fields; NULL: not given */
    size_t line[KEYS];
    size_t *n, n_count;
    double *k;
    size_t k_count;
    char keys[512]; /* for messages */
};

/* The name of a key; NULL: it is none of a scene's. */
static const char *name_of(size_t key)
{
    if (key < FIELDS)
        return key == MESHES ? "n" : "k";
    const struct br_method_field *f = &br_method_fields[key - FIELDS];
    return f->unsaid ? NULL : br_method_field_key(f);
}

/* The keys of a study. */
static const char *expected_study(struct study_part *b)
{
    b->keys[0] = '\0';
    for (size_t i = 0; i < KEYS; i++)
        if (name_of(i))
            br_append(b->keys, sizeof b->keys, "%s, ", name_of(i));
    return br_append(
        b->keys, sizeof b->keys,
        "or a norm (l2, energy, tip) and a part (axial, bending; without one: the total)");
}

/* The nearest of these keys, for a message. */
static const char *suggestion(const char *word, char text[BR_SUGGESTION])
{
    char line[BR_PARTS * 8][64];
    const char *names[KEYS + BR_PARTS * 8];
    size_t count = 0, lines = 0;
    for (size_t i = 0; i < KEYS; i++)
        if ((names[count] = name_of(i)))
            count++;
    for (size_t i = 0; br_norms[i] && i < 8; i++)
        for (int part = 0; part < BR_PARTS; part++, lines++) {
            snprintf(line[lines], sizeof *line, "%s %s", br_norms[i]->name, br_part_names[part]);
            names[count++] = part == BR_PART_TOTAL ? br_norms[i]->name : line[lines];
        }
    return br_suggestion(word, names, count, text);
}

/* ---- n and k ---- */

/* "8e-3, 4e-3 s" */
static enum br_status read_steps(struct study_part *b, struct br_error *err)
{
    const char *text = b->text[STEPS];
    const size_t length = strlen(text);
    char numbers[1024];
    if (length < 2 || length >= sizeof numbers || strcmp(text + length - 2, " s") != 0)
        return br_fail(err, BR_BAD_INPUT,
                       "found '%s', expected time steps and their unit, like '8e-3, 4e-3 s'", text);
    snprintf(numbers, sizeof numbers, "%.*s", (int)(length - 2), text);
    return br_read_numbers("the list", numbers, &b->k, &b->k_count, err);
}

static enum br_status read_lists(struct study_part *b)
{
    struct br_error inner = {0};
    if (b->text[MESHES] && br_read_counts("the list", b->text[MESHES], &b->n, &b->n_count, &inner))
        return br_scene_pass_on(b->r, b->line[MESHES], "n", &inner);
    if (b->text[STEPS] && read_steps(b, &inner))
        return br_scene_pass_on(b->r, b->line[STEPS], "k", &inner);
    if (!b->text[MESHES] || !b->text[STEPS])
        return br_scene_refuse(b->r, b->study->line, b->text[MESHES] ? "k" : "n",
                               "missing in verify %s", br_verify_names[b->kind]);
    return BR_OK;
}

static enum br_status check_counts(const struct study_part *b)
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
static enum br_status make_cells(struct study_part *b)
{
    struct br_verify_study *v = b->study;
    const size_t count = b->n_count > b->k_count ? b->n_count : b->k_count;
    v->n = br_allocate(count, sizeof *v->n);
    v->steps = br_allocate(count, sizeof *v->steps);
    if (!v->n || !v->steps)
        return br_no_memory(b->r->yaml.err, "what is expected");
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
            return br_scene_pass_on(b->r, b->line[STEPS], "k", &inner);
    }
    br_sort_counts(v->n, count);
    br_sort_counts(v->steps, count);
    return BR_OK;
}

/* ---- expectations ---- */

/* "l2", "l2 axial": the norm and the component; false: it is neither. */
static bool parse_what(const char *text, struct br_verify_expectation *e)
{
    char norm[64], part[64] = "total", rest;
    const int words = sscanf(text, "%63s %63s %c", norm, part, &rest);
    if (words < 1 || words > 2)
        return false;
    for (size_t i = 0; br_norms[i]; i++)
        if (strcmp(br_norms[i]->name, norm) == 0)
            e->norm = br_norms[i];
    for (int p = 0; p < BR_PARTS; p++)
        if (strcmp(br_part_names[p], part) == 0) {
            e->part = (enum br_part)p;
            return e->norm != NULL;
        }
    return false;
}

/* The axis of the study may stand before the order: of h and k together the order is one in k. */
static enum br_status read_band(struct study_part *b, const char *text,
                                struct br_verify_expectation *e, struct br_error *err)
{
    const enum br_axis refined = b->kind == BR_VERIFY_SPACE ? BR_AXIS_SPACE : BR_AXIS_TIME;
    enum br_axis axis;
    if (br_expectation_read(&text, e->norm->unit, &axis, &e->band, err))
        return err->status;
    if (axis != BR_AXES && axis != refined)
        return br_fail(err, BR_BAD_INPUT, "found an order in %s, expected one in %s",
                       br_axis_letters[axis], br_axis_letters[refined]);
    return !*text ? BR_OK
                  : br_fail(err, BR_BAD_INPUT,
                            "found '%s' behind the order, expected its end, or a range of the "
                            "constant, like ', at most 3e-4 %s' or ', constant 2e-4 to 3e-4 %s'",
                            text, e->norm->unit, e->norm->unit);
}

static enum br_status read_expectation(struct study_part *b, const char *what,
                                       const yaml_node_t *node)
{
    const size_t line = br_yaml_line(node);
    struct br_verify_expectation e = {.band.line = line};
    struct br_error inner = {0};
    char text[BR_SUGGESTION];
    if (!parse_what(what, &e))
        return br_scene_refuse(b->r, line, what, "unknown key in verify %s, expected %s%s",
                               br_verify_names[b->kind], expected_study(b), suggestion(what, text));
    if (read_band(b, br_yaml_text(node), &e, &inner))
        return br_scene_pass_on(b->r, line, what, &inner);
    if (b->study->expectations == BR_MOST_EXPECTATIONS)
        return br_scene_refuse(b->r, line, what, "given twice");
    b->study->expectation[b->study->expectations++] = e;
    return BR_OK;
}

/* ---- a study ---- */

static enum br_status read_key(struct study_part *b, const yaml_node_t *name,
                               const yaml_node_t *value)
{
    if (name->type != YAML_SCALAR_NODE || value->type != YAML_SCALAR_NODE)
        return br_scene_refuse(b->r, br_yaml_line(name), br_verify_names[b->kind],
                               "found a list or a mapping, expected one line each of %s",
                               expected_study(b));
    const char *text = br_yaml_text(name);
    size_t key = 0;
    while (key < KEYS && (!name_of(key) || strcmp(name_of(key), text) != 0))
        key++;
    if (key == KEYS)
        return read_expectation(b, text, value);
    if (b->text[key])
        return br_scene_refuse(b->r, br_yaml_line(name), text, "given twice");
    b->text[key] = br_yaml_text(value);
    b->line[key] = br_yaml_line(value);
    return BR_OK;
}

/* Reads the fields one by one, so that an error has its line; then all together. */
static enum br_status read_method(struct study_part *b)
{
    struct br_method *m = &b->study->method;
    const struct br_method *const methods[] = {m};
    struct br_error inner = {0};
    *m = br_method_default();
    for (size_t i = FIELDS; i < KEYS; i++)
        if (b->text[i] &&
            br_method_field_read(&br_method_fields[i - FIELDS], b->text[i], m, &inner))
            return br_scene_pass_on(b->r, b->line[i], name_of(i), &inner);
    const char *const *text = b->text + FIELDS;
    if (!br_method_read(text, BR_METHOD_IN_SCENE, m, &inner))
        br_method_check_used(text, BR_METHOD_IN_SCENE, methods, 1, &inner);
    return br_scene_pass_on(b->r, b->study->line, br_verify_names[b->kind], &inner);
}

static enum br_status read_block(struct study_part *b, const yaml_node_t *node)
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
        status = read_key(b, yaml_document_get_node(r->yaml.document, p->key),
                          yaml_document_get_node(r->yaml.document, p->value));
    return status || read_lists(b) || read_method(b) || check_counts(b) || make_cells(b)
               ? r->yaml.err->status
               : BR_OK;
}

/* What --set has set has no line in the file. */
static void drop_lines(struct br_verify *verify)
{
    for (int kind = 0; kind < BR_VERIFY_KINDS; kind++) {
        struct br_verify_study *v = &verify->study[kind];
        v->line = v->line > BR_LAST_LINE ? 0 : v->line;
        for (size_t i = 0; i < v->expectations; i++)
            if (v->expectation[i].band.line > BR_LAST_LINE)
                v->expectation[i].band.line = 0;
    }
}

static enum br_status read_studies(const struct br_scene_reader *r, const yaml_node_t *node,
                                   struct br_verify *verify)
{
    if (node->type != YAML_MAPPING_NODE)
        return br_scene_refuse(r, br_yaml_line(node), "verify",
                               "expected a mapping with space, time or joint");
    for (yaml_node_pair_t *p = node->data.mapping.pairs.start; p < node->data.mapping.pairs.top;
         p++) {
        const yaml_node_t *name = yaml_document_get_node(r->yaml.document, p->key);
        const char *key =
            name->type == YAML_SCALAR_NODE ? br_yaml_text(name) : "a list or a mapping";
        char expected[BR_EXPECTED];
        int kind = 0;
        while (kind < BR_VERIFY_KINDS && strcmp(key, br_verify_names[kind]) != 0)
            kind++;
        if (kind == BR_VERIFY_KINDS)
            return br_scene_refuse(r, br_yaml_line(name), key, "unknown key in verify, %s",
                                   br_expected(key, br_verify_names, BR_VERIFY_KINDS, expected));
        struct study_part b = {
            .r = r, .kind = (enum br_verify_kind)kind, .study = &verify->study[kind]};
        const enum br_status status =
            read_block(&b, yaml_document_get_node(r->yaml.document, p->value));
        free(b.n);
        free(b.k);
        if (status)
            return status;
    }
    struct br_error inner = {0};
    size_t line;
    if (br_verify_check(r->scene, verify, &line, &inner))
        return br_scene_pass_on(r, line ? line : br_yaml_line(node), "verify", &inner);
    drop_lines(verify);
    return BR_OK;
}

static enum br_status take(const struct br_scene_reader *r, const yaml_node_t *node, void *self)
{
    struct br_verify *verify = self;
    const enum br_status status =
        node ? read_studies(r, node, verify) : br_verify_default(r->scene, verify, r->yaml.err);
    return status ? status : br_scene_data(r, &verify->data);
}

enum br_status br_verify_read(const char *name, const char *text, const char *set,
                              struct br_scene *scene, struct br_verify *verify,
                              struct br_error *err)
{
    const struct br_scene_asked asked = {.take_verify = take, .self = verify, .set = set};
    *verify = (struct br_verify){0};
    return br_scene_parse(name, text, &asked, scene, err);
}
