/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/scene/vary.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "study/scene/file.h"
#include "study/scene/value.h"
#include "study/scene/words.h"

/* ---- what is varied ---- */

static bool is_number(const struct br_scene_key *k)
{
    return k->kind == BR_KEY_POSITIVE || k->kind == BR_KEY_NOT_NEGATIVE;
}

/* As on the command line. */
static const char *full_name(const struct br_scene_key *k, char name[64])
{
    snprintf(name, 64, "%s%s%s", k->section, *k->section ? "." : "", k->name);
    return name;
}

static enum br_status find_key(const char *text, size_t length, struct br_varied *v,
                               struct br_error *err)
{
    char known[600] = "";
    for (const struct br_scene_key *k = br_scene_keys; k->name; k++) {
        const size_t used = strlen(known);
        full_name(k, v->name);
        const bool found = strlen(v->name) == length && strncmp(text, v->name, length) == 0;
        if (found && !is_number(k) && k->kind != BR_KEY_SECTION)
            return br_fail(err, BR_BAD_INPUT,
                           "--vary: %s: it is %s, expected a key whose value is a number", v->name,
                           k->help);
        if (found && is_number(k))
            v->key = k;
        if (found && v->key)
            return BR_OK;
        if (is_number(k))
            snprintf(known + used, sizeof known - used, "%s%s", used ? ", " : "", v->name);
    }
    return br_fail(err, BR_BAD_INPUT, "--vary: found key '%.*s', expected one of: %s",
                   (int)(length < 100 ? length : 100), text, known);
}

/* Of the unit 1, which nobody prints. */
static bool is_bare(const struct br_scene_key *key)
{
    return strcmp(key->unit, "1") == 0;
}

/* A number and perhaps its unit; returns what follows, or NULL. */
static const char *read_value(struct br_varied *v, const char *text, double *value)
{
    const char *unit = v->key->unit, *rest = br_read_number(text, value);
    if (!rest)
        return NULL;
    rest += strspn(rest, " ");
    const bool given = strncmp(rest, unit, strlen(unit)) == 0;
    const bool bare = is_bare(v->key) || (v->key->need == BR_OR_RATIO && !given);
    const char *meant = bare ? "" : unit;
    if (v->unit && *v->unit != *meant) /* what a bare number is depends on its neighbours */
        return NULL;
    v->unit = meant;
    rest += given ? strlen(unit) : 0;
    return rest + strspn(rest, " ");
}

static enum br_status refuse_values(const struct br_varied *v, const char *found,
                                    struct br_error *err)
{
    return br_fail(err, BR_BAD_INPUT,
                   "--vary: %s: found '%.200s', expected LOW..HIGH log COUNT, LOW..HIGH lin COUNT, "
                   "or numbers %s%s separated by commas, like '%s=1e2..1e6 log 9'",
                   v->name, found, is_bare(v->key) ? "without unit" : "in ",
                   is_bare(v->key) ? "" : v->key->unit, v->name);
}

static enum br_status make_room(struct br_varied *v, size_t count, struct br_error *err)
{
    v->value = br_allocate(count, sizeof *v->value);
    return v->value ? BR_OK : br_no_memory(err, "the values of --vary");
}

static enum br_status check_count(const struct br_varied *v, double count, double least,
                                  struct br_error *err)
{
    if (count >= least && count <= BR_MOST_VARIED && count == floor(count))
        return BR_OK;
    return br_fail(err, BR_BAD_INPUT, "--vary: %s: found %g values, expected %g to %d", v->name,
                   count, least, BR_MOST_VARIED);
}

static enum br_status read_list(struct br_varied *v, const char *text, struct br_error *err)
{
    size_t most = 1;
    for (const char *c = text; *c; c++)
        most += *c == ',';
    if (check_count(v, (double)most, 1, err) || make_room(v, most, err))
        return err->status;
    for (const char *rest = text;; rest++) {
        double *value = &v->value[v->count];
        rest += strspn(rest, " ");
        const char *end = read_value(v, rest, value);
        if (!end || (*end && *end != ','))
            return refuse_values(v, rest, err);
        for (size_t i = 0; i < v->count; i++)
            if (v->value[i] == *value)
                return br_fail(err, BR_BAD_INPUT, "--vary: %s: %g is given twice", v->name, *value);
        v->count++;
        rest = end;
        if (!*rest)
            return BR_OK;
    }
}

/* 15 digits: 1000, not 1000.0000000000001. */
static double rounded(double value)
{
    char text[40];
    snprintf(text, sizeof text, "%.15g", value);
    br_read_number(text, &value);
    return value;
}

/* Ends that are too near each other leave no room for values between them. */
static enum br_status check_rise(const struct br_varied *v, struct br_error *err)
{
    for (size_t i = 1; i < v->count; i++)
        if (!(v->value[i] > v->value[i - 1]))
            return br_fail(
                err, BR_BAD_INPUT,
                "--vary: %s: found %zu values from %.17g to %.17g, expected fewer: in 15 "
                "digits some are the same",
                v->name, v->count, v->value[0], v->value[v->count - 1]);
    return BR_OK;
}

/* "LOW..HIGH log 9", with its dots. */
static enum br_status read_range(struct br_varied *v, const char *text, const char *dots,
                                 struct br_error *err)
{
    double low = NAN, high = NAN, count = NAN;
    char first[100]; /* "1..2" has no number "1." */
    snprintf(first, sizeof first, "%.*s", (int)(dots - text < 99 ? dots - text : 99), text);
    const char *rest = read_value(v, first, &low);
    if (v->unit && !*v->unit) /* 100..300 N/m: the unit is that of both */
        v->unit = NULL;
    const char *word = rest && !*rest ? read_value(v, dots + 2, &high) : NULL;
    const bool lin = word && strncmp(word, "lin ", 4) == 0;
    v->logarithmic = word && strncmp(word, "log ", 4) == 0;
    const char *end = lin || v->logarithmic ? br_read_number(word + 4, &count) : NULL;
    if (!end || *end)
        return refuse_values(v, text, err);
    if (!(low < high) || (v->logarithmic && !(low > 0)))
        return br_fail(err, BR_BAD_INPUT, "--vary: %s: found %g..%g, expected %s", v->name, low,
                       high,
                       low < high ? "numbers above 0 for log" : "a lower and then a higher number");
    if (check_count(v, count, 2, err) || make_room(v, (size_t)count, err))
        return err->status;
    for (v->count = 0; (double)v->count < count; v->count++) {
        const double part = (double)v->count / (count - 1);
        v->value[v->count] =
            rounded(v->logarithmic ? pow(10, log10(low) + part * (log10(high) - log10(low)))
                                   : low + part * (high - low));
    }
    v->value[0] = low;
    v->value[v->count - 1] = high;
    return check_rise(v, err);
}

enum br_status br_varied_read(const char *text, struct br_varied *v, struct br_error *err)
{
    const size_t length = strcspn(text, "=");
    *v = (struct br_varied){0};
    if (find_key(text, length, v, err))
        return err->status;
    const char *values = text[length] ? text + length + 1 : "";
    const char *dots = strstr(values, "..");
    return dots ? read_range(v, values, dots, err) : read_list(v, values, err);
}

void br_varied_clear(struct br_varied *v)
{
    free(v->value);
    *v = (struct br_varied){0};
}

/* ---- the scene ---- */

/* One value in a document. */
struct change {
    const struct br_varied *varied;
    size_t value;
    struct br_scene *scene;
};

/* The pair of a mapping with that key, or NULL. */
static yaml_node_pair_t *find_pair(yaml_document_t *document, int mapping, const char *key)
{
    yaml_node_t *node = yaml_document_get_node(document, mapping);
    if (!node || node->type != YAML_MAPPING_NODE)
        return NULL;
    for (yaml_node_pair_t *p = node->data.mapping.pairs.start; p < node->data.mapping.pairs.top;
         p++) {
        const yaml_node_t *name = yaml_document_get_node(document, p->key);
        if (name->type == YAML_SCALAR_NODE && strcmp(br_yaml_text(name), key) == 0)
            return p;
    }
    return NULL;
}

/* A new scalar, on a line for messages; 0: no memory. */
static int add_scalar(yaml_document_t *document, const char *text, const yaml_mark_t *mark)
{
    const yaml_mark_t at = *mark; /* of a node that may move */
    const int id = yaml_document_add_scalar(document, NULL, (const yaml_char_t *)text, -1,
                                            YAML_PLAIN_SCALAR_STYLE);
    if (id)
        yaml_document_get_node(document, id)->start_mark = at;
    return id;
}

/* A mapping of the same pairs: an alias may stand for the old one elsewhere. */
static int copy_mapping(yaml_document_t *document, int mapping)
{
    const yaml_mark_t at = yaml_document_get_node(document, mapping)->start_mark;
    const int copy = yaml_document_add_mapping(document, NULL, YAML_BLOCK_MAPPING_STYLE);
    const yaml_node_t *old = yaml_document_get_node(document, mapping);
    bool whole = copy;
    for (const yaml_node_pair_t *p = old->data.mapping.pairs.start;
         p < old->data.mapping.pairs.top && whole; p++)
        whole = yaml_document_append_mapping_pair(document, copy, p->key, p->value);
    if (copy)
        yaml_document_get_node(document, copy)->start_mark = at;
    return whole ? copy : 0;
}

/* Gives a key of a mapping another text, or, where it has none, its first one. */
static bool set_text(yaml_document_t *document, int mapping, const char *key, const char *text)
{
    yaml_node_pair_t *pair = find_pair(document, mapping, key);
    const yaml_mark_t at =
        yaml_document_get_node(document, pair ? pair->value : mapping)->start_mark;
    const int value = add_scalar(document, text, &at);
    if (pair && value) {
        pair->value = value;
        return true;
    }
    const int name = value ? add_scalar(document, key, &at) : 0;
    return name && yaml_document_append_mapping_pair(document, mapping, name, value);
}

static enum br_status take(const struct br_scene_reader *reader, void *self)
{
    enum { ROOT = 1 };
    const struct change *c = self;
    const struct br_scene_key *key = c->varied->key;
    yaml_document_t *document = reader->document;
    const yaml_node_t *root = yaml_document_get_root_node(document);
    struct br_scene_reader r = *reader;
    int mapping = ROOT;
    char text[100];
    r.scene = c->scene;
    if (!root || root->type != YAML_MAPPING_NODE)
        return br_scene_refuse(&r, 1, "scene", "expected a mapping of keys to values");
    if (*key->section) {
        yaml_node_pair_t *section = find_pair(document, ROOT, key->section);
        if (!section)
            return br_fail(r.err, BR_BAD_INPUT,
                           "%s: --vary: %s: the scene has no '%s', expected one", r.path,
                           c->varied->name, key->section);
        const int old = section->value;
        if (yaml_document_get_node(document, old)->type == YAML_MAPPING_NODE &&
            !(mapping = section->value = copy_mapping(document, old)))
            return br_no_memory(r.err, "the YAML parser");
        if (section->value == old)
            return br_scene_document(&r); /* no mapping: the reader refuses it */
    }
    snprintf(text, sizeof text, "%.17g %s", c->varied->value[c->value], c->varied->unit);
    return set_text(document, mapping, key->name, text) ? br_scene_document(&r)
                                                        : br_no_memory(r.err, "the YAML parser");
}

enum br_status br_varied_scene(const struct br_varied *v, size_t i, const char *path,
                               const char *text, struct br_scene *scene, struct br_error *err)
{
    struct change c = {v, i, scene};
    *scene = (struct br_scene){0};
    return br_yaml_read(path, text, take, &c, err);
}

/* ---- what is found ---- */

const char *br_varied_text(const struct br_varied *v, size_t i, char text[BR_VARIED_TEXT])
{
    snprintf(text, BR_VARIED_TEXT, "%s = %.15g%s%s", v->name, v->value[i], *v->unit ? " " : "",
             v->unit);
    return text;
}

enum br_status br_variation_create(struct br_variation *s, const struct br_scene *scene,
                                   struct br_error *err)
{
    const size_t numbers = s->varied->count * s->columns;
    snprintf(s->name, sizeof s->name, "%.200s-%s%s%s", scene->name, s->varied->key->section,
             *s->varied->key->section ? "-" : "", s->varied->key->name);
    snprintf(s->caption, sizeof s->caption, "%.300s, over %s", scene->title, s->varied->name);
    s->value = br_allocate(numbers, sizeof *s->value);
    s->remark = br_allocate(s->varied->count, sizeof(char *));
    s->unstable = br_allocate(s->varied->count, sizeof *s->unstable);
    s->failure = br_allocate(s->varied->count, sizeof *s->failure);
    for (size_t i = 0; s->value && i < numbers; i++)
        s->value[i] = NAN;
    return s->value && s->remark && s->unstable && s->failure
               ? BR_OK
               : br_no_memory(err, "the values of --vary");
}

void br_variation_clear(struct br_variation *s)
{
    free(s->value);
    free(s->remark);
    free(s->unstable);
    free(s->failure);
    *s = (struct br_variation){0};
}

size_t br_variation_failures(const struct br_variation *s, size_t *first)
{
    size_t failures = 0;
    for (size_t i = s->failure ? s->varied->count : 0; i-- > 0;)
        if (s->failure[i].status) {
            failures++;
            *first = i;
        }
    return failures;
}
