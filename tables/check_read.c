/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A check's JSON, read for --compare. */
#include <jansson.h>
#include <math.h>
#include <string.h>

#include "base/load.h"
#include "orders/expectation/comparison.h"
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
    const json_t *tolerance = json_object_get(o, "tolerance"); /* null: the order is the least */
    return kind < BR_VERIFY_KINDS && verdict <= BR_INCONCLUSIVE && c->measure && c->part &&
           read_number(json_object_get(o, "order"), -INFINITY, &c->order.value) &&
           read_number(json_object_get(o, "constant"), 0, &c->constant) &&
           read_number(json_object_get(o, "expected"), 0, &e->order) &&
           (!highest || read_number(highest, 0, &e->highest)) &&
           (json_is_null(tolerance) || read_number(tolerance, 0, &e->tolerance)) &&
           read_number(json_object_get(o, "floor"), 0, &e->floor) &&
           read_number(json_object_get(o, "ceiling"), 0, &e->ceiling);
}

/* cases: of all scenes. */
static enum br_status read_scene(const char *path, const json_t *o, const json_t *cases,
                                 struct br_old_check *old, struct br_error *err)
{
    const json_t *problem = json_object_get(o, "problem"); /* null: of a scene; or of before */
    struct br_check *check = &old->check[old->count];
    check->name = json_string_value(json_object_get(o, "scene"));
    check->data = json_string_value(json_object_get(o, "data"));
    if (!check->name || !read_number(json_object_get(o, "seconds"), 0, &check->seconds) ||
        !read_number(json_object_get(o, "element_steps"), 0, &check->element_steps))
        return refuse(path, "scenes", "scenes with a name and a cost", err);
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
    if (!format || strcmp(format, "beamrate check") != 0 ||
        json_integer_value(json_object_get(document, "version")) != 2)
        return refuse(path, "format", "beamrate check, version 2", err);
    if (!json_is_array(list))
        return refuse(path, "scenes", "a list", err);
    enum br_status status = BR_OK;
    old->version =
        json_string_value(json_object_get(json_object_get(document, "provenance"), "version"));
    old->check = br_allocate(json_array_size(list) + 1, sizeof *old->check);
    if (!old->check)
        return br_no_memory(err, "the earlier check");
    for (size_t i = 0; i < json_array_size(list) && !status; i++)
        status =
            read_scene(path, json_array_get(list, i), json_object_get(tables, "orders"), old, err);
    return status;
}

enum br_status br_check_read_json(const char *path, struct br_old_check *old, struct br_error *err)
{
    *old = (struct br_old_check){.path = path};
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
