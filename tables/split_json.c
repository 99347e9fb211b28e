/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Everything, to repeat the run; what is not there is null. */
#include <math.h>

#include "tables/json_value.h"
#include "tables/split_emitter.h"

static void put(json_t *object, const char *key, json_t *value)
{
    json_object_set_new(object, key, value);
}

static json_t *by_part(const double value[BR_PARTS])
{
    json_t *o = json_object();
    for (int part = 0; part < BR_PARTS; part++)
        put(o, br_part_names[part], br_json_number(value[part]));
    return o;
}

static json_t *by_kind(const double value[2])
{
    json_t *o = json_object();
    put(o, "axial", br_json_number(value[BR_AXIAL]));
    put(o, "bending", br_json_number(value[BR_BENDING]));
    return o;
}

static json_t *norms(const struct br_split *s, size_t i)
{
    json_t *list = json_array();
    for (size_t m = 0; m < s->norms; m++) {
        const struct br_split_line line = br_split_line(s, m, i);
        json_t *o = json_object();
        put(o, "norm", json_string(s->norm[m]->name));
        put(o, "error", by_part(line.error));
        put(o, "floor", i == s->shares ? json_null() : by_part(line.floor));
        put(o, "share", br_json_number(i > s->shares ? NAN : line.share));
        json_array_append_new(list, o);
    }
    return list;
}

static json_t *line_object(const struct br_split *s, size_t i)
{
    const struct br_split_line line = br_split_line(s, 0, i);
    json_t *o = json_object();
    put(o, "part", json_string(line.name));
    put(o, "applies", json_boolean(line.none == NULL));
    put(o, "none", br_json_string(line.none));
    put(o, "tip", by_kind(line.tip));
    put(o, "norms", norms(s, i));
    return o;
}

static void add_sentence(void *self, const char *text)
{
    json_array_append_new(self, br_json_string(text));
}

static json_t *run(const struct br_split *s)
{
    json_t *o = json_object(), *parts = json_array(), *said = json_array();
    const struct br_writer w = {add_sentence, said};
    char text[256];
    for (size_t i = 0; i < s->shares; i++)
        json_array_append_new(parts, line_object(s, i));
    br_split_say_run(s, &w);
    put(o, "run", br_json_string(br_split_run_text(s, text, sizeof text)));
    put(o, "n", json_integer((json_int_t)s->at.n));
    put(o, "steps", json_integer((json_int_t)s->at.steps));
    put(o, "k", br_json_number(br_time_step(s->scene, s->at.steps)));
    put(o, "scheme", json_string(s->method.scheme->name));
    put(o, "method", br_json_method(&s->method));
    put(o, "reference", json_string(s->judge->name));
    put(o, "refined", br_json_string(s->refined.name));
    put(o, "predicted_round_off", br_json_number(s->predicted_round_off));
    put(o, "unstable", json_boolean(s->unstable));
    put(o, "parts", parts);
    put(o, "sum", line_object(s, s->shares));
    put(o, "whole", line_object(s, s->shares + 1));
    put(o, "tip", by_kind(s->tip));
    put(o, "solution_tip", by_kind(s->solution_tip));
    put(o, "findings", said);
    return o;
}

static json_t *norm_list(const struct br_split *s)
{
    json_t *list = json_array();
    for (size_t m = 0; m < s->norms; m++)
        json_array_append_new(list, json_pack("{s:s, s:s, s:s}", "name", s->norm[m]->name, "unit",
                                              s->norm[m]->unit, "title", s->norm[m]->title));
    return list;
}

static enum br_status emit(FILE *out, const struct br_split_page *page, struct br_error *err)
{
    const struct br_provenance *p = page->provenance;
    json_t *o = json_object(), *runs = json_array(), *said = json_array();
    const struct br_writer w = {add_sentence, said};
    for (size_t i = 0; i < page->count; i++)
        json_array_append_new(runs, run(&page->split[i]));
    if (!o || !runs || !said)
        return br_no_memory(err, "the JSON document");
    put(o, "provenance", br_json_provenance(p));
    put(o, "scene",
        json_pack("{s:o, s:o, s:o}", "name", br_json_string(page->split->scene->name), "path",
                  br_json_string(p->scene_path), "text", br_json_string(p->scene_text)));
    put(o, "norms", norm_list(page->split));
    br_split_say_chain(page->split, &w);
    put(o, "runs", runs);
    put(o, "findings", said);
    json_dumpf(o, out, JSON_INDENT(1) | JSON_ENSURE_ASCII | JSON_REAL_PRECISION(17));
    fputc('\n', out);
    json_decref(o);
    return BR_OK;
}

const struct br_split_emitter br_split_json = {"json", ".json", "everything, to repeat the run",
                                               emit};
