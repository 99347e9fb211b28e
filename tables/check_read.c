/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A check's JSON, read for --compare. */
#include <jansson.h>
#include <math.h>
#include <string.h>

#include "study/scene/file.h"
#include "study/verify/comparison.h"
#include "tables/json_value.h"
#include "tables/reports.h"

enum { LARGEST = 1 << 26 }; /* bytes */

static enum br_status refuse(const char *path, const char *where, const char *expected,
                             struct br_error *err)
{
    return br_fail(err, BR_BAD_INPUT, "%s: %s: expected %s, as 'beamrate check --json' writes it",
                   path, where, expected);
}

/* A number, or NaN for null; false: it is neither, or below `least`. */
static bool read_number(const json_t *o, double least, double *value)
{
    *value = json_is_number(o) ? json_number_value(o) : NAN;
    return json_is_null(o) || *value >= least;
}

static bool read_word(const json_t *o, char *word, size_t size)
{
    if (!json_is_string(o) || strlen(json_string_value(o)) >= size)
        return false;
    strcpy(word, json_string_value(o));
    return true;
}

static int index_of(const json_t *word, const char *const *names, int count)
{
    int i = 0;
    while (i < count && (!json_is_string(word) || strcmp(json_string_value(word), names[i]) != 0))
        i++;
    return i;
}

static bool read_case(const json_t *o, struct br_case *c)
{
    const int kind = index_of(json_object_get(o, "study"), br_verify_names, BR_VERIFY_KINDS);
    const int verdict =
        index_of(json_object_get(o, "verdict"), br_verdict_names, BR_INCONCLUSIVE + 1);
    const json_t *highest = json_object_get(o, "highest"); /* older reports do not have it */
    struct br_expectation *e = &c->expected;
    c->kind = (enum br_verify_kind)kind;
    c->verdict = (enum br_verdict)verdict;
    c->measure = json_string_value(json_object_get(o, "norm"));
    c->part = json_string_value(json_object_get(o, "part"));
    return kind < BR_VERIFY_KINDS && verdict <= BR_INCONCLUSIVE && c->measure && c->part &&
           read_number(json_object_get(o, "order"), -INFINITY, &c->order.value) &&
           read_number(json_object_get(o, "constant"), 0, &c->constant) &&
           read_number(json_object_get(o, "expected"), 0, &e->order) &&
           (!highest || read_number(highest, 0, &e->highest)) &&
           read_number(json_object_get(o, "tolerance"), 0, &e->tolerance) &&
           read_number(json_object_get(o, "floor"), 0, &e->floor) &&
           read_number(json_object_get(o, "ceiling"), 0, &e->ceiling);
}

/* A value of a method as br_method_field_text has it. */
static bool read_value(const json_t *o, char value[BR_METHOD_VALUE])
{
    double number;
    *value = '\0';
    if (json_is_null(o))
        return true;
    if (json_is_string(o))
        return read_word(o, value, BR_METHOD_VALUE);
    if (!read_number(o, -INFINITY, &number))
        return false;
    br_shortest(number, value, BR_METHOD_VALUE);
    return true;
}

/* A missing key means the default, as before the key existed. The rows of the registries were
 * always there, but for the time schemes. */
static bool read_method(const json_t *o, struct br_old_method *m)
{
    const struct br_method method = br_method_default();
    bool good = true;
    br_old_method_of(&method, m);
    m->known = o != NULL;
    for (size_t i = 0; i < BR_METHOD_FIELDS && m->known; i++) {
        const struct br_method_field *f = &br_method_fields[i];
        const json_t *in = f->group ? json_object_get(o, f->group) : o;
        const json_t *value = json_object_get(in, f->group ? f->member : br_method_field_key(f));
        const bool needed =
            i == BR_METHOD_SOLVER || i == BR_METHOD_CONTACT || i == BR_METHOD_FRICTION;
        if (value)
            good &= read_value(value, m->value[i]);
        else
            good &= !needed;
    }
    return good;
}

/* cases: of all scenes. */
static enum br_status read_scene(const char *path, const json_t *o, const json_t *methods,
                                 const json_t *cases, struct br_old_check *old,
                                 struct br_error *err)
{
    const json_t *problem = json_object_get(o, "problem"); /* null: of a scene; or of before */
    struct br_check *check = &old->check[old->count];
    bool good = true;
    for (int kind = 0; kind < BR_VERIFY_KINDS; kind++)
        good &= read_method(json_object_get(methods, br_verify_names[kind]),
                            &old->method[old->count][kind]);
    check->name = json_string_value(json_object_get(o, "scene"));
    check->data = json_string_value(json_object_get(o, "data"));
    if (!good || !check->name || !read_number(json_object_get(o, "seconds"), 0, &check->seconds) ||
        !read_number(json_object_get(o, "element_steps"), 0, &check->element_steps))
        return refuse(path, "scenes", "scenes with a name, methods and a cost", err);
    if (json_is_string(problem) && !read_word(problem, check->problem, sizeof check->problem))
        return refuse(path, "problem", "a hash", err);
    for (size_t i = 0; i < old->count; i++)
        if (strcmp(old->check[i].name, check->name) == 0)
            return refuse(path, check->name, "each scene once", err);
    old->count++;
    check->cases = br_allocate(json_array_size(cases) + 1, sizeof *check->cases);
    if (!check->cases)
        return br_no_memory(err, "the earlier check");
    for (size_t i = 0; i < json_array_size(cases); i++) {
        const json_t *row = json_array_get(cases, i);
        if (!json_equal(json_object_get(row, "scene"), json_object_get(o, "scene")))
            continue;
        if (!read_case(row, &check->cases[check->count]))
            return refuse(path, check->name,
                          "cases with a study, a norm, a part, an order, a constant and a verdict",
                          err);
        check->count++;
    }
    return BR_OK;
}

static enum br_status read_document(const char *path, const json_t *document,
                                    struct br_old_check *old, struct br_error *err)
{
    const char *format = json_string_value(json_object_get(document, "format"));
    const json_t *tables = json_object_get(document, "tables");
    const json_t *list = json_object_get(tables, "scenes");
    const json_t *methods = json_object_get(document, "methods");
    if (!format || strcmp(format, "beamrate check") != 0 ||
        json_integer_value(json_object_get(document, "version")) != 2)
        return refuse(path, "format", "beamrate check, version 2", err);
    if (!json_is_array(list))
        return refuse(path, "scenes", "a list", err);
    enum br_status status = BR_OK;
    old->version =
        json_string_value(json_object_get(json_object_get(document, "provenance"), "version"));
    old->check = br_allocate(json_array_size(list) + 1, sizeof *old->check);
    old->method = br_allocate(json_array_size(list) + 1, sizeof *old->method);
    if (!old->check || !old->method)
        return br_no_memory(err, "the earlier check");
    for (size_t i = 0; i < json_array_size(list) && !status; i++) {
        char number[32];
        snprintf(number, sizeof number, "%zu", i);
        status = read_scene(path, json_array_get(list, i), json_object_get(methods, number),
                            json_object_get(tables, "orders"), old, err);
    }
    return status;
}

enum br_status br_check_read_json(const char *path, struct br_old_check *old, struct br_error *err)
{
    *old = (struct br_old_check){0};
    json_error_t problem;
    char *text;
    if (br_text_load(path, LARGEST, "report of 'check' in JSON", &text, err))
        return err->status;
    old->json = br_json_parse(text, &problem);
    free(text);
    if (!old->json)
        return br_fail(err, BR_BAD_INPUT, "%s:%d: %s", path, problem.line > 0 ? problem.line : 1,
                       problem.text);
    return read_document(path, old->json, old, err);
}
