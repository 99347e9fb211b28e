/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A check for programs, and for --compare, which reads it again. */
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <string.h>
#include <unistd.h>

#include "tables/check_emitter.h"
#include "tables/json_value.h"

static const char format_name[] = "beamrate check 1";

/* ---- writing ---- */

static json_t *point(const struct br_point *p)
{
    return json_pack("{s:I, s:I, s:I, s:I, s:o, s:o, s:s, s:o}", "n", (json_int_t)p->at.n, "steps",
                     (json_int_t)p->at.steps, "against_n", (json_int_t)p->against.n,
                     "against_steps", (json_int_t)p->against.steps, "error",
                     br_json_number(p->error), "constant", br_json_number(p->constant), "flag",
                     br_flag_name(p->flag), "failure", br_json_string(p->failure));
}

/* Appends, or makes the array NULL: without memory there is no document. */
static void append(json_t **array, json_t *value)
{
    if (json_array_append_new(*array, value) == 0)
        return;
    json_decref(*array);
    *array = NULL;
}

static json_t *points(const struct br_case *c)
{
    json_t *a = json_array();
    for (size_t i = 0; i < c->points; i++)
        append(&a, point(&c->point[i]));
    return a;
}

static json_t *case_object(const struct br_case *c)
{
    const struct br_expectation *e = &c->expected;
    return json_pack("{s:s, s:s, s:s, s:s, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o}",
                     "study", br_verify_names[c->kind], "norm", e->norm->name, "part",
                     br_part_names[e->part], "verdict", br_verdict_names[c->verdict], "order",
                     br_json_estimate(&c->order), "expected", br_json_number(e->order), "tolerance",
                     br_json_number(e->tolerance), "margin", br_json_number(c->margin), "constant",
                     br_json_number(c->constant), "floor", br_json_number(e->floor), "ceiling",
                     br_json_number(e->ceiling), "reason", br_json_string(c->reason), "note",
                     br_json_string(c->note), "points", points(c));
}

static json_t *cases(const struct br_check *check)
{
    json_t *a = json_array();
    for (size_t i = 0; i < check->count; i++)
        append(&a, case_object(&check->cases[i]));
    return a;
}

static json_t *methods(const struct br_check *check)
{
    json_t *o = json_object();
    for (int kind = 0; kind < BR_VERIFY_KINDS; kind++)
        if (check->verify->study[kind].count)
            json_object_set_new(o, br_verify_names[kind],
                                br_json_method(&check->verify->study[kind].method));
    return o;
}

static json_t *scene(const struct br_check *check)
{
    return json_pack("{s:o, s:o, s:o, s:b, s:o, s:o, s:o, s:o}", "scene",
                     br_json_string(check->scene->name), "failure",
                     br_json_string(check->failure.status ? check->failure.message : NULL), "path",
                     br_json_string(check->path), "by_default", check->verify->by_default,
                     "methods", methods(check), "seconds", br_json_number(check->seconds),
                     "element_steps", br_json_number(check->element_steps), "cases", cases(check));
}

static json_t *scenes(const struct br_check_page *page)
{
    json_t *a = json_array();
    for (size_t i = 0; i < page->count; i++)
        append(&a, scene(&page->checks[i]));
    return a;
}

static json_t *skipped(const struct br_check_page *page)
{
    json_t *a = json_array();
    for (size_t i = 0; i < page->skips; i++)
        append(&a, json_pack("{s:o, s:o}", "scene", br_json_string(page->skipped[i].scene),
                             "reason", br_json_string(page->skipped[i].reason)));
    return a;
}

static json_t *differences(const struct br_comparison *c)
{
    if (!c)
        return json_null();
    json_t *a = json_array();
    for (size_t i = 0; i < c->count; i++) {
        const struct br_difference *d = &c->difference[i];
        json_array_append_new(
            a, json_pack("{s:s, s:o, s:o, s:o, s:o}", "severity", br_severity_names[d->severity],
                         "subject", br_json_string(d->subject), "before", br_json_number(d->before),
                         "now", br_json_number(d->now), "remark", br_json_string(d->remark)));
    }
    return a;
}

static json_t *tally(const struct br_check_page *page)
{
    json_t *o = json_object();
    for (int v = BR_PASS; v <= BR_INCONCLUSIVE; v++)
        json_object_set_new(o, br_verdict_names[v],
                            json_integer((json_int_t)br_check_tally(page->checks, page->count,
                                                                    (enum br_verdict)v)));
    return o;
}

static enum br_status emit(FILE *out, const struct br_check_page *page, struct br_error *err)
{
    json_t *o = json_pack("{s:s, s:o, s:o, s:o, s:b, s:o, s:o, s:o}", "format", format_name,
                          "provenance", br_json_provenance(page->provenance), "tally", tally(page),
                          "wall_seconds", br_json_number(page->wall_seconds), "stopped",
                          page->stopped, "scenes", scenes(page), "skipped", skipped(page),
                          "differences", differences(page->comparison));
    if (!o)
        return br_no_memory(err, "the JSON document");
    const int failed =
        json_dumpf(o, out, JSON_INDENT(1) | JSON_ENSURE_ASCII | JSON_REAL_PRECISION(17));
    fputc('\n', out);
    json_decref(o);
    return failed ? br_no_memory(err, "the JSON document") : BR_OK;
}

const struct br_check_emitter br_check_emit_json = {
    .name = "json",
    .title = "everything, for programs and for --compare",
    .emit = emit,
};

/* ---- reading ---- */

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

static bool read_verdict(const json_t *o, enum br_verdict *verdict)
{
    for (int v = BR_PASS; v <= BR_INCONCLUSIVE && json_is_string(o); v++)
        if (strcmp(json_string_value(o), br_verdict_names[v]) == 0) {
            *verdict = (enum br_verdict)v;
            return true;
        }
    return false;
}

static bool read_case(const json_t *o, const char *scene_name, struct br_old_case *c)
{
    strcpy(c->scene, scene_name);
    return read_word(json_object_get(o, "study"), c->study, sizeof c->study) &&
           read_word(json_object_get(o, "norm"), c->norm, sizeof c->norm) &&
           read_word(json_object_get(o, "part"), c->part, sizeof c->part) &&
           read_number(json_object_get(json_object_get(o, "order"), "value"), -INFINITY,
                       &c->order) &&
           read_number(json_object_get(o, "constant"), 0, &c->constant) &&
           read_number(json_object_get(o, "expected"), 0, &c->expected) &&
           read_number(json_object_get(o, "tolerance"), 0, &c->tolerance) &&
           read_number(json_object_get(o, "floor"), 0, &c->floor) &&
           read_number(json_object_get(o, "ceiling"), 0, &c->ceiling) &&
           read_verdict(json_object_get(o, "verdict"), &c->verdict);
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

/* A key that is not there means what there was before it: the default. The rows of the registries
 * were always there, but for the time schemes. */
static bool read_method(const json_t *o, struct br_old_method *m)
{
    const struct br_method method = br_method_default();
    bool good = true;
    br_old_method_of(&method, m);
    m->known = o != NULL;
    for (size_t i = 0; i < BR_METHOD_FIELDS && m->known; i++) {
        const struct br_method_field *f = &br_method_fields[i];
        const json_t *in = f->group ? json_object_get(o, f->group) : o;
        char key[BR_METHOD_VALUE];
        const json_t *value =
            json_object_get(in, f->group ? f->member : br_method_field_key(f, key));
        const bool needed =
            i == BR_METHOD_SOLVER || i == BR_METHOD_CONTACT || i == BR_METHOD_FRICTION;
        if (value)
            good &= read_value(value, m->value[i]);
        else
            good &= !needed;
    }
    return good;
}

static bool read_methods(const json_t *o, struct br_old_cost *cost)
{
    bool good = true;
    for (int kind = 0; kind < BR_VERIFY_KINDS; kind++)
        good &= read_method(json_object_get(o, br_verify_names[kind]), &cost->method[kind]);
    return good;
}

static enum br_status read_scene(const char *path, const json_t *o, struct br_old_check *old,
                                 struct br_error *err)
{
    struct br_old_cost *cost = &old->costs[old->scenes++];
    const json_t *list = json_object_get(o, "cases");
    if (!read_word(json_object_get(o, "scene"), cost->scene, sizeof cost->scene) ||
        !read_number(json_object_get(o, "seconds"), 0, &cost->seconds) ||
        !read_number(json_object_get(o, "element_steps"), 0, &cost->element_steps) ||
        !read_methods(json_object_get(o, "methods"), cost) || !json_is_array(list))
        return refuse(path, "scenes", "scenes with a name, methods, a cost and cases", err);
    for (size_t i = 0; i + 1 < old->scenes; i++)
        if (strcmp(old->costs[i].scene, cost->scene) == 0)
            return refuse(path, cost->scene, "each scene once", err);
    for (size_t i = 0; i < json_array_size(list); i++)
        if (!read_case(json_array_get(list, i), cost->scene, &old->cases[old->count++]))
            return refuse(path, cost->scene,
                          "cases with a study, a norm, a part, an order, a "
                          "constant and a verdict",
                          err);
    return BR_OK;
}

static enum br_status read_document(const char *path, const json_t *root, struct br_old_check *old,
                                    struct br_error *err)
{
    const json_t *format = json_object_get(root, "format"), *list = json_object_get(root, "scenes");
    if (!json_is_string(format) || strcmp(json_string_value(format), format_name) != 0)
        return refuse(path, "format", format_name, err);
    if (!json_is_array(list))
        return refuse(path, "scenes", "a list", err);
    size_t count = 0;
    for (size_t i = 0; i < json_array_size(list); i++)
        count += json_array_size(json_object_get(json_array_get(list, i), "cases"));
    old->costs = br_allocate(json_array_size(list) + 1, sizeof *old->costs);
    old->cases = br_allocate(count + 1, sizeof *old->cases);
    if (!old->costs || !old->cases)
        return br_no_memory(err, "the earlier check");
    enum br_status status = BR_OK;
    for (size_t i = 0; i < json_array_size(list) && !status; i++)
        status = read_scene(path, json_array_get(list, i), old, err);
    return status;
}

enum br_status br_check_read_json(const char *path, struct br_old_check *old, struct br_error *err)
{
    *old = (struct br_old_check){0};
    json_error_t problem;
    const int file = open(path, O_RDONLY | O_CLOEXEC);
    if (file < 0)
        return br_fail(err, BR_BAD_INPUT, "%s:1: unable to open: %s", path, strerror(errno));
    json_t *root = br_json_read(file, &problem);
    close(file);
    if (!root)
        return br_fail(err, BR_BAD_INPUT, "%s:%d: %s", path, problem.line > 0 ? problem.line : 1,
                       problem.text);
    const enum br_status status = read_document(path, root, old, err);
    json_decref(root);
    return status;
}
