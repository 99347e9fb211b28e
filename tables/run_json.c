/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A run's summary for programs: one object, SI units; what is not known or not modelled is null. */
#include "tables/json_value.h"
#include "tables/run_page.h"

static void put(json_t *object, const char *key, json_t *value)
{
    json_object_set_new(object, key, value);
}

static void put_number(json_t *object, const char *key, double value)
{
    put(object, key, br_json_number(value));
}

static json_t *count(size_t value)
{
    return json_integer((json_int_t)value);
}

static json_t *if_marched(bool marched, double value)
{
    return marched ? br_json_number(value) : json_null();
}

static json_t *two(const struct br_run_report *p, const double x[2])
{
    json_t *o = json_object();
    put(o, "axial", if_marched(p->marched.axial.modelled, x[BR_AXIAL]));
    put(o, "bending", if_marched(p->marched.bending.modelled, x[BR_BENDING]));
    return o;
}

static json_t *tip(const struct br_run_report *p)
{
    const struct br_history_row *row = &p->end.last;
    const bool contact = p->marched.contact.modelled;
    const bool friction = p->marched.friction.law != BR_FRICTIONLESS;
    json_t *o = json_object();
    put_number(o, "t", row->time);
    put(o, "step", count(row->step));
    put(o, "displacement", two(p, row->displacement));
    put(o, "velocity", two(p, row->velocity));
    put(o, "contact_force", if_marched(contact, row->contact_force));
    put(o, "closed", contact ? json_boolean(p->watch.closed) : json_null());
    put(o, "friction_force", if_marched(friction, row->friction_force));
    put(o, "friction_bound", if_marched(friction, row->friction_bound));
    put(o, "regime",
        friction && p->watch.steps ? json_string(br_tip_regime_word(p->watch.regime))
                                   : json_null());
    return o;
}

static json_t *extreme(bool known, const struct br_extreme *e)
{
    if (!known)
        return json_null();
    json_t *o = json_object();
    put_number(o, "value", e->value);
    put_number(o, "t", e->time);
    return o;
}

static json_t *event_list(const struct br_tip_watch *w)
{
    json_t *list = json_array();
    for (size_t i = 0; i < w->events; i++) {
        json_t *o = json_object();
        put(o, "event", json_string(br_tip_event_word(w->event[i].kind)));
        put_number(o, "t", w->event[i].time);
        put(o, "step", count(w->event[i].step));
        put(o, "direction",
            w->event[i].direction ? json_integer(w->event[i].direction) : json_null());
        json_array_append_new(list, o);
    }
    return list;
}

static json_t *switches(const struct br_run_report *p)
{
    json_t *list = json_array();
    for (size_t i = 0; i < p->switches && i < BR_MOST_SWITCHES; i++) {
        const struct br_switch *s = &p->switched[i];
        json_t *o = json_object();
        put_number(o, "t", s->time);
        put(o, "law", json_string(s->kind == BR_AXIAL ? "contact" : "friction"));
        put(o, "from", json_string(br_regime_name(s->from)));
        put(o, "to", json_string(br_regime_name(s->to)));
        json_array_append_new(list, o);
    }
    return list;
}

/* What the march has cost beside time. */
static json_t *work(const struct br_run_report *p)
{
    json_t *o = json_object();
    put(o, "steps", count(p->counts.steps));
    put(o, "steps_taken_back", count(p->counts.rejected));
    put(o, "solves_a_field", count(p->counts.stages));
    put(o, "changes_of_the_step", count(p->counts.set_ups));
    put(o, "friction_iterations", count(p->counts.iterations));
    return o;
}

static json_t *events(const struct br_run_report *p)
{
    const struct br_tip_watch *w = &p->watch;
    json_t *counts = json_object(), *steps = json_object(), *o = json_object();
    for (int kind = 0; kind < BR_TIP_EVENTS; kind++)
        put(counts, br_tip_event_word((enum br_tip_event_kind)kind), count(w->count[kind]));
    for (int regime = 0; regime < BR_TIP_REGIMES; regime++)
        put(steps, br_tip_regime_word((enum br_tip_regime)regime), count(w->regime_steps[regime]));
    put(steps, "closed", count(w->closed_steps));
    put_number(o, "resolution", p->k);
    put(o, "closed_at_start", w->contact ? json_boolean(w->closed_at_start) : json_null());
    put(o, "regime_at_start",
        w->friction && w->steps ? json_string(br_tip_regime_word(w->regime_at_start))
                                : json_null());
    put(o, "counts", counts);
    put(o, "steps", steps);
    put(o, "list", event_list(w));
    put(o, "switches_found", p->method.scheme->adaptive ? switches(p) : json_null());
    put(o, "largest_contact_force", extreme(w->contact, &w->contact_force));
    put(o, "largest_friction_force", extreme(w->friction, &w->friction_force));
    return o;
}

static json_t *state(const struct br_run_report *p, const struct br_energy *e)
{
    json_t *o = json_object();
    put(o, "kinetic", two(p, e->kinetic));
    put(o, "stored", two(p, e->stored));
    put(o, "contact", if_marched(p->marched.contact.modelled, e->contact));
    put_number(o, "total", br_energy_total(e));
    return o;
}

/* Of each field: in all, and by the steps that add. */
static json_t *added(const struct br_run_report *p)
{
    const struct br_work *w = &p->work;
    const double all[] = {br_energy_added(w, BR_AXIAL), br_energy_added(w, BR_BENDING)};
    const double put_in[] = {br_energy_put_in(&p->energy_start, w, BR_AXIAL),
                             br_energy_put_in(&p->energy_start, w, BR_BENDING)};
    json_t *o = json_object(), *steps = json_array();
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        json_array_append_new(steps, count(w->gaining[kind]));
    put(o, "in_all", two(p, all));
    put(o, "put_in", two(p, put_in));
    put(o, "steps_that_add", steps);
    put(o, "by_these_steps", two(p, w->gained));
    return o;
}

static json_t *energies(const struct br_run_report *p)
{
    const bool friction = p->marched.friction.law != BR_FRICTIONLESS;
    json_t *o = json_object();
    put(o, "start", state(p, &p->energy_start));
    put(o, "end", p->at_end ? state(p, &p->energy_now) : json_null());
    put(o, "lost_to_friction",
        if_marched(friction, p->summed ? p->work.friction : p->watch.friction_work));
    put(o, "summed", json_boolean(p->summed));
    if (!p->summed)
        return o;
    put(o, "work_of_loads", two(p, p->work.loads));
    put(o, "lost_to_viscosity", two(p, p->work.viscous));
    put(o, "lost_to_scheme", two(p, p->work.scheme));
    put(o, "lost_to_scheme_is_the_remainder", json_boolean(p->work.remainder));
    put(o, "lost_to_scheme_by_contact",
        if_marched(p->marched.contact.modelled && !p->work.remainder, p->work.scheme_contact));
    put(o, "imbalance",
        if_marched(!p->work.remainder,
                   br_energy_imbalance(&p->energy_start, &p->energy_now, &p->work)));
    put(o, "largest_imbalance_of_a_step", if_marched(!p->work.remainder, p->energy_worst));
    put(o, "added_by_scheme", p->work.remainder ? json_null() : added(p));
    return o;
}

static json_t *numbers(const struct br_certificate *c, double energy)
{
    json_t *o = json_object();
    put_number(o, "axial", c->axial_residual);
    put_number(o, "bending", c->bending_residual);
    put_number(o, "update", c->update);
    put_number(o, "contact", c->contact);
    put_number(o, "friction", c->friction);
    put(o, "energy", br_json_number(energy));
    return o;
}

static json_t *certificate(const struct br_run_report *p)
{
    if (!p->checked)
        return json_null();
    json_t *o = json_object();
    put(o, "worst", numbers(&p->worst, p->energy_worst));
    put(o, "limits", numbers(&p->limits, p->energy_limit));
    put(o, "bad_steps", count(p->bad_steps));
    put(o, "first", p->bad_steps ? br_json_string(p->verdict.message) : json_null());
    return o;
}

static json_t *model(const struct br_run_report *p)
{
    json_t *list = json_array();
    for (size_t i = 0; i < p->model_rows; i++) {
        json_t *o = json_object();
        put(o, "part", json_string(p->model[i].key));
        put(o, "modelled", json_boolean(p->model[i].modelled));
        put(o, "why", br_json_string(p->model[i].why));
        json_array_append_new(list, o);
    }
    return list;
}

static json_t *cost(const struct br_run_report *p)
{
    if (!p->explained || p->end.last.step == 0)
        return json_null();
    json_t *list = json_array();
    const double steps = (double)p->end.last.step;
    for (int part = 0; part < BR_COST_PARTS; part++) {
        if (p->cost.laps[part] == 0)
            continue;
        json_t *o = json_object();
        put(o, "part", json_string(br_cost_part_text((enum br_cost_part)part)));
        put_number(o, "ns_per_step", 1e9 * p->cost.seconds[part] / steps);
        put_number(o, "ns_per_element_step", 1e9 * p->cost.seconds[part] / steps / (double)p->n);
        json_array_append_new(list, o);
    }
    return list;
}

static json_t *predicted(bool known, const struct br_predicted *e)
{
    json_t *o = json_object();
    put(o, "error", if_marched(known, e->error));
    put(o, "low", if_marched(known, e->low));
    put(o, "high", if_marched(known, e->high));
    return o;
}

/* A field's error, and the most that it is stated to be, with round-off. */
static json_t *predicted_field(const struct br_run_page *page, enum br_field_kind kind)
{
    const struct br_prediction *p = page->prediction;
    const struct br_scene *s = &page->report->marched;
    if (kind == BR_AXIAL ? !s->axial.modelled : !s->bending.modelled)
        return json_null();
    json_t *o = predicted(p->bounded, &p->field[kind]);
    put(o, "most", if_marched(p->known, br_predicted_most(p, kind)));
    return o;
}

/* Relative to the solution of the field. */
static json_t *prediction(const struct br_run_page *page)
{
    const struct br_prediction *p = page->prediction;
    json_t *o = json_object();
    put(o, "known", json_boolean(p->known));
    put(o, "why_not", p->known ? json_null() : br_json_string(p->why));
    put(o, "discretisation", predicted(p->bounded, &p->whole));
    put(o, "axial", predicted_field(page, BR_AXIAL));
    put(o, "bending", predicted_field(page, BR_BENDING));
    put(o, "time", predicted(p->bounded, &p->time));
    put(o, "space", predicted(p->bounded, &p->space));
    put_number(o, "round_off", p->round_off);
    put_number(o, "seconds", p->seconds);
    return o;
}

static json_t *warnings(const struct br_warnings *w)
{
    json_t *list = json_array();
    for (size_t i = 0; i < w->count; i++) {
        json_t *o = json_object();
        put(o, "warning", json_string(br_warning_word(w->list[i].kind)));
        put(o, "text", br_json_string(w->list[i].text));
        put(o, "remedy", w->list[i].remedy[0] ? br_json_string(w->list[i].remedy) : json_null());
        json_array_append_new(list, o);
    }
    return list;
}

static json_t *time_used(const struct br_run_page *page)
{
    const struct br_history_end *end = &page->report->end;
    const double steps = (double)end->last.step;
    json_t *o = json_object();
    put_number(o, "wall", page->wall_seconds);
    put_number(o, "set_up", end->set_up_seconds);
    put_number(o, "march", end->march_seconds);
    put(o, "per_step", steps > 0 ? br_json_number(end->march_seconds / steps) : json_null());
    put(o, "per_element_step",
        steps > 0 ? br_json_number(end->march_seconds / steps / (double)page->report->n)
                  : json_null());
    return o;
}

static json_t *scene(const struct br_run_page *page)
{
    const struct br_scene *s = page->report->scene;
    json_t *o = json_object();
    put(o, "name", br_json_string(s->name));
    put(o, "title", br_json_string(s->title));
    put(o, "path", br_json_string(page->provenance->scene_path));
    put(o, "text", br_json_string(page->provenance->scene_text));
    put(o, "remark", br_json_string(s->remark));
    put_number(o, "length", s->length);
    put_number(o, "duration", s->duration);
    return o;
}

enum br_status br_run_json(FILE *out, const struct br_run_page *page, struct br_error *err)
{
    const struct br_run_report *p = page->report;
    json_t *root = json_object();
    put(root, "format", json_string("beamrate run 1"));
    put(root, "scene", scene(page));
    put(root, "n", count(p->n));
    put(root, "steps", count(p->steps));
    put_number(root, "h", p->h);
    put_number(root, "k", p->k);
    put(root, "method", br_json_method(&p->method));
    put(root, "stopped", p->failure.status ? br_json_string(p->failure.message) : json_null());
    put(root, "contact_beyond_stability_limit", json_boolean(p->contact_unstable));
    put(root, "prediction", prediction(page));
    put(root, "warnings", warnings(page->warnings));
    put(root, "tip", tip(p));
    put(root, "events", events(p));
    put(root, "work", work(p));
    put(root, "energies", energies(p));
    put(root, "certificate", certificate(p));
    put(root, "model", model(p));
    put(root, "cost", cost(p));
    put(root, "seconds", time_used(page));
    put(root, "provenance", br_json_provenance(page->provenance));
    const int failed =
        json_dumpf(root, out, JSON_INDENT(2) | JSON_ENSURE_ASCII | JSON_REAL_PRECISION(17));
    json_decref(root);
    fputc('\n', out);
    return failed && !ferror(out) ? br_no_memory(err, "the summary") : BR_OK;
}
