/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Everything, for programs, by jansson; a number that is not there is null. */
#include <jansson.h>
#include <math.h>

#include "tables/json_value.h"
#include "tables/trade_emitter.h"

static void put(json_t *o, const char *key, json_t *value)
{
    json_object_set_new(o, key, value);
}

static json_t *count(size_t value)
{
    return json_integer((json_int_t)value);
}

static void put_cost(json_t *o, const struct br_trial *t)
{
    const struct br_counts *c = &t->cost.counts;
    put(o, "seconds", br_json_number(br_trial_seconds(t)));
    put(o, "set_up", br_json_number(t->cost.set_up));
    put(o, "march", br_json_number(t->cost.march));
    put(o, "repeats", count(t->cost.repeats));
    put(o, "steps", count(c->steps));
    put(o, "rejected", count(c->rejected));
    put(o, "solves", count(c->stages));
    put(o, "iterations", count(c->iterations));
    put(o, "set_ups", count(c->set_ups));
}

static json_t *trial(const struct br_trade *trade, size_t i)
{
    static const char *const names[] = {"error", "axial", "bending"};
    const struct br_trial *t = &trade->trial[i];
    const bool adaptive = br_contender_adaptive(t->contender);
    json_t *o = json_object();
    put(o, "method", json_string(t->contender->name));
    put(o, "n", count(t->at.n));
    put(o, adaptive ? "levels" : "k_steps", count(t->at.steps));
    put(o, "k", br_json_number(adaptive ? NAN : br_trade_step(trade, t)));
    put(o, "tolerance", br_json_number(adaptive ? t->tolerance : NAN));
    put(o, "relative_error", br_json_number(br_trial_relative(t, 0, BR_PART_TOTAL)));
    for (int part = 0; part < BR_PARTS; part++)
        put(o, names[part], br_json_number(t->error[0][part]));
    put(o, "own_error", br_json_number(t->own[0]));
    put_cost(o, t);
    put(o, "digits_per_second", br_json_number(br_trade_digits_per_second(t)));
    put(o, "end", json_string(br_trial_end_name(t->end)));
    put(o, "front", json_boolean(trade->front[i]));
    put(o, "printed", json_boolean(t->printed));
    put(o, "failure", br_json_string(t->failure.status ? t->failure.message : NULL));
    return o;
}

static json_t *trials(const struct br_trade *trade)
{
    json_t *a = json_array();
    for (size_t i = 0; i < trade->count; i++)
        json_array_append_new(a, trial(trade, i));
    return a;
}

/* The places of the cheapest trials in the list of all; null: none is good enough. */
static json_t *cheapest(const struct br_trade *trade, const size_t best[BR_TRADE_DIGITS])
{
    json_t *a = json_array();
    for (size_t d = 0; d < BR_TRADE_DIGITS; d++) {
        json_t *o = json_object();
        put(o, "target", json_real(br_trade_target(d)));
        put(o, "trial", best[d] < trade->count ? count(best[d]) : json_null());
        json_array_append_new(a, o);
    }
    return a;
}

static json_t *methods(const struct br_trade *trade)
{
    json_t *a = json_array();
    for (size_t i = 0; i < trade->contenders.count; i++) {
        const struct br_contender *c = &trade->contenders.list[i];
        json_t *o = br_json_method(&c->method);
        put(o, "name", json_string(c->name));
        put(o, "scheme", json_string(c->method.scheme->name));
        put(o, "axial_degree", json_integer(c->method.axial_degree));
        put(o, "cheapest", cheapest(trade, trade->best_of[i]));
        json_array_append_new(a, o);
    }
    return a;
}

static json_t *page_of(const struct br_trade_page *page)
{
    const struct br_trade *t = page->trade;
    const struct br_judge *judge =
        t->request.judge ? t->request.judge : br_judge_best(t->request.scene);
    json_t *o = json_object();
    put(o, "scene", br_json_string(page->name));
    put(o, "caption", br_json_string(page->caption));
    put(o, "norm", json_string(t->norm[0]->name));
    put(o, "unit", json_string(t->norm[0]->unit));
    put(o, "judge", json_string(judge->name));
    put(o, "repeats", count(t->request.repeats));
    put(o, "repeat_seconds", br_json_number(t->request.repeat_seconds));
    put(o, "time_limit", br_json_number(t->request.time_limit));
    put(o, "wall_seconds", br_json_number(t->wall_seconds));
    put(o, "cheapest", cheapest(t, t->best));
    put(o, "methods", methods(t));
    put(o, "trials", trials(t));
    put(o, "path", br_json_string(page->provenance->scene_path));
    put(o, "text", br_json_string(page->provenance->scene_text));
    return o;
}

static enum br_status dump(FILE *out, json_t *root, struct br_error *err)
{
    char *text = json_dumps(root, JSON_INDENT(1) | JSON_ENSURE_ASCII);
    json_decref(root);
    if (!text)
        return br_no_memory(err, "the JSON text");
    fprintf(out, "%s\n", text);
    free(text);
    return BR_OK;
}

enum br_status br_trade_json(FILE *out, const struct br_trade_page *page, struct br_error *err)
{
    json_t *root = page_of(page);
    put(root, "provenance", br_json_provenance(page->provenance));
    return dump(out, root, err);
}

/* The cheapest trials of every scene. */
enum br_status br_trade_json_summary(FILE *out, const struct br_trade_page *page, size_t pages,
                                     struct br_error *err)
{
    json_t *root = json_object(), *rows = json_array();
    for (size_t p = 0; p < pages; p++)
        for (size_t d = 0; d < BR_TRADE_DIGITS; d++) {
            const struct br_trade *t = page[p].trade;
            json_t *o = json_object();
            put(o, "scene", br_json_string(page[p].name));
            put(o, "target", json_real(br_trade_target(d)));
            put(o, "trial", t->best[d] < t->count ? trial(t, t->best[d]) : json_null());
            json_array_append_new(rows, o);
        }
    put(root, "cheapest", rows);
    put(root, "provenance", br_json_provenance(page->provenance));
    return dump(out, root, err);
}
