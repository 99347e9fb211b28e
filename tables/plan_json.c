/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Everything, for programs, by jansson; a number that is not there is null. */
#include <jansson.h>
#include <math.h>

#include "tables/json_value.h"
#include "tables/plan_emitter.h"

static void put(json_t *o, const char *key, json_t *value)
{
    json_object_set_new(o, key, value);
}

static json_t *count(size_t value)
{
    return json_integer((json_int_t)value);
}

static json_t *trial(const struct br_plan_page *page, size_t i)
{
    const struct br_plan *p = page->plan;
    const struct br_trial *t = &p->trial[i];
    const bool adaptive = br_contender_adaptive(t->contender);
    json_t *o = json_object();
    put(o, "round", count(p->forecast[i].round));
    put(o, "method", json_string(t->contender->name));
    put(o, "n", count(t->at.n));
    put(o, adaptive ? "levels" : "k_steps", count(t->at.steps));
    put(o, "k", br_json_number(br_plan_step(page, t)));
    put(o, "tolerance", br_json_number(adaptive ? t->tolerance : NAN));
    put(o, "predicted_error", br_json_number(p->forecast[i].error));
    put(o, "relative_error", br_json_number(br_trial_bound(t, 0)));
    put(o, "predicted_seconds", br_json_number(p->forecast[i].seconds));
    put(o, "seconds", br_json_number(p->seconds(t)));
    put(o, "steps", count(t->cost.counts.steps));
    put(o, "solves", count(t->cost.counts.stages));
    put(o, "set_ups", count(t->cost.counts.set_ups));
    put(o, "end", json_string(br_trial_end_name(t->end)));
    put(o, "failure", br_json_string(t->failure.status ? t->failure.message : NULL));
    return o;
}

static json_t *curve(const struct br_plan_curve *c)
{
    json_t *a = json_array();
    for (size_t i = 0; i < c->count; i++) {
        json_t *pair = json_array();
        json_array_append_new(pair, br_json_number(c->at[i]));
        json_array_append_new(pair, br_json_number(c->value[i]));
        json_array_append_new(a, pair);
    }
    return a;
}

/* Curves are pairs of logarithms: of n, steps or 1/tolerance, and of an error or solves. */
static json_t *model(const struct br_plan *p, size_t i)
{
    const struct br_plan_models *m = &p->model[i];
    json_t *o = json_object(), *costs = json_array();
    put(o, "method", json_string(p->contenders.list[i].name));
    put(o, "points", count(m->error.points));
    put(o, "error_scatter", br_json_number(m->known ? m->error.scatter : NAN));
    put(o, "cost_scatter", br_json_number(m->known ? m->cost.scatter : NAN));
    put(o, "r", br_json_number(m->known ? m->error.r : NAN));
    put(o, "log_space_error", m->known ? curve(&m->error.space) : json_null());
    put(o, "log_time_error", m->known ? curve(&m->error.time) : json_null());
    put(o, "log_solves", m->known ? curve(&m->cost.solves) : json_null());
    for (int c = 0; c < BR_PLAN_COSTS && m->known; c++)
        json_array_append_new(costs, br_json_number(m->cost.c[c]));
    put(o, "seconds", costs);
    return o;
}

static void put_goal(json_t *o, const struct br_plan *p)
{
    put(o, "goal_error", br_json_number(p->goal.error));
    put(o, "goal_seconds", br_json_number(p->goal.seconds));
    put(o, "norm", json_string(p->norm[0]->name));
    put(o, "end", json_string(br_plan_end_name(p->end)));
    put(o, "own_error", br_json_number(p->own));
    put(o, "rounds", count(p->rounds));
    put(o, "first", p->first < p->count ? count(p->first) : json_null());
    put(o, "chosen", p->chosen < p->count ? count(p->chosen) : json_null());
    put(o, "marched_seconds", br_json_number(br_plan_spent(p)));
    put(o, "wall_seconds", br_json_number(p->wall_seconds));
}

static void put_parts(json_t *o, const struct br_plan *p)
{
    const struct br_plan_parts parts = br_plan_chosen_parts(p);
    put(o, "space_error", br_json_number(parts.space));
    put(o, "time_error", br_json_number(parts.time));
    put(o, "space_order", br_json_number(parts.p));
    put(o, "time_order", br_json_number(parts.q));
}

enum br_status br_plan_json(FILE *out, const struct br_plan_page *page, struct br_error *err)
{
    const struct br_plan *p = page->plan;
    char line[BR_PLAN_LINE];
    json_t *root = json_object(), *trials = json_array(), *models = json_array();
    put(root, "scene", br_json_string(page->name));
    put_goal(root, p);
    put_parts(root, p);
    br_plan_run_line(page, line);
    put(root, "run", br_json_string(*line ? line : NULL));
    br_plan_trade_line(page, line);
    put(root, "trade", br_json_string(*line ? line : NULL));
    for (size_t i = 0; i < p->count; i++)
        json_array_append_new(trials, trial(page, i));
    for (size_t i = 0; i < p->contenders.count; i++)
        json_array_append_new(models, model(p, i));
    put(root, "trials", trials);
    put(root, "models", models);
    put(root, "provenance", br_json_provenance(page->provenance));
    char *text = json_dumps(root, JSON_INDENT(1) | JSON_ENSURE_ASCII);
    json_decref(root);
    if (!text)
        return br_no_memory(err, "the JSON text");
    fprintf(out, "%s\n", text);
    free(text);
    return BR_OK;
}
