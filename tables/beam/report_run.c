/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <string.h>

#include "study/estimate/prediction.h"
#include "study/run/run.h"
#include "study/scene/method_fields.h"
#include "tables/beam/report_parts.h"

/* ---- facts ---- */

static bool has_friction(const struct br_run_report *r)
{
    return r->marched.friction.law != BR_FRICTIONLESS;
}

/* Puts a number of both fields: KEY.axial and KEY.bending. label: NULL, for programs alone. */
static void put_two(struct br_document *d, const struct br_run_report *r, const double x[2],
                    const char *label, const char *unit, const char *key)
{
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        const char *heading = label ? br_format(d, "%s, %s", label, br_field_names[kind]) : NULL;
        br_put_fact_as(d, br_if(r->marched.field[kind].modelled, br_number(x[kind])), heading, unit,
                       "%s.%s", key, br_field_names[kind]);
    }
}

static const char *direction(int sign)
{
    return sign > 0 ? " towards +w" : sign < 0 ? " towards -w" : "";
}

/* ---- the answer ---- */

/* The predicted error of the tip's displacement, m; NAN: not known. */
static double tip_error(const struct br_run_findings *f, enum br_field_kind kind)
{
    const double error = br_predicted_tip(f->prediction, kind, f->report->scene->length);
    return f->prediction->known ? error : NAN;
}

/* "-0.222 +- 0.014" */
static const char *with_error(struct br_document *d, double value, double error)
{
    if (isinf(error))
        return br_format(d, "%.1g (perhaps no digit is correct)", value);
    return br_format(d, "%s", br_uncertain_text(value, error, (char[64]){0}, 64));
}

/* Puts a number of the march with as many digits as its error allows. error: of this number; NaN:
 * the predicted error of the march, or three digits where that is not known. */
static void put_number(struct br_document *d, const struct br_run_findings *f, double value,
                       double error, const char *heading, const char *unit, const char *key)
{
    const struct br_prediction *p = f->prediction;
    const double digits = p->known ? 1 - floor(log10(p->whole.error)) : 3;
    char text[64];
    BR_FACT(d, br_number(value), .key = key, .heading = heading, .unit = unit);
    if (!isfinite(value))
        return;
    if (error > 0 || value == 0)
        br_put_shown(d, "%s", with_error(d, value, error));
    else
        br_put_shown(d, "%s",
                     br_digits_text(value, (int)fmax(2, fmin(digits, 6)), text, sizeof text));
}

static void answer_tip(struct br_document *d, const struct br_run_findings *f)
{
    const struct br_run_report *r = f->report;
    const struct br_tip_watch *w = &r->watch;
    br_put_list(d, ": ", ", ");
    br_put_answer(d, "Tip at t = %.10g s%s", r->end.last.time,
                  r->failure.status ? " (the last good step)" : "");
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        if (r->marched.field[kind].modelled)
            br_put_item(d, "%s = %s m", kind == BR_AXIAL ? "u" : "w",
                        with_error(d, r->end.last.displacement[kind], tip_error(f, kind)));
    if (w->contact)
        br_put_item(d, "contact %s", w->closed ? "closed" : "open");
    if (w->friction && w->steps)
        br_put_more(d, ", friction: %s%s", br_tip_regime_words[w->regime],
                    w->regime == BR_TIP_SLIP ? direction(w->direction) : "");
    br_put_more(d, ".");
    br_put_list(d, " Events: ", ", ");
    for (int kind = 0; kind < BR_TIP_EVENTS; kind++)
        if (w->count[kind])
            br_put_item(d, "%s %zu", br_tip_event_words[kind], w->count[kind]);
    br_put_more(d, "%s", d->items ? "." : "");
}

/* "Estimated error: 0.057 % of the solution (0.016 to 0.18 %), nearly all from the time steps". */
static void answer_error(struct br_document *d, const struct br_prediction *p)
{
    enum { NEARLY_ALL = 10 };
    const struct br_predicted *e = &p->whole;
    const bool percent = e->error >= 1e-4;
    const double in = percent ? 100 : 1;
    const char *unit = percent ? " %" : "";
    br_put_answer(d, "Estimated error: %.2g%s of the solution", in * e->error, unit);
    if (isfinite(e->high))
        br_put_more(d, " (%.2g to %.2g%s)", in * e->low, in * e->high, unit);
    else
        br_put_more(d, " (at least %.2g%s, perhaps more than the solution)", in * e->low, unit);
    if (p->time.error > NEARLY_ALL * p->space.error)
        br_put_more(d, ", nearly all from the time steps");
    else if (p->space.error > NEARLY_ALL * p->time.error)
        br_put_more(d, ", nearly all from the elements");
    else
        br_put_more(d, ", %.2g%s from the time steps and %.2g%s from the elements",
                    in * p->time.error, unit, in * p->space.error, unit);
}

/* NaN: not known. A lagged contact beyond its limit multiplies round-off in each closed step. */
static double round_off_of(const struct br_run_findings *f)
{
    return f->report->contact_unstable ? NAN : f->prediction->round_off;
}

static void put_answers(struct br_document *d, const struct br_run_findings *f)
{
    const struct br_run_report *r = f->report;
    const struct br_warnings *w = f->warnings;
    if (r->failure.status)
        br_put_answer(d, "STOPPED: %s", r->failure.message);
    answer_tip(d, f);

    if (f->prediction->known)
        answer_error(d, f->prediction);
    else if (f->prediction->bounded)
        br_put_answer(d, "The discretisation error is not known (between %.0e and %.0e): %s",
                      f->prediction->whole.low, f->prediction->whole.high, f->prediction->why);
    else
        br_put_answer(d, "The discretisation error is not known: %s", f->prediction->why);
    const double round_off = round_off_of(f);
    if (isfinite(round_off))
        br_put_more(d, f->prediction->known ? "; round-off %.1g." : "; round-off %.1e.", round_off);
    else
        br_put_more(d, "; nor is the round-off.");

    if (r->bad_steps)
        br_put_answer(d, "%zu of %zu steps are beyond the certificate's limits; the first: %s",
                      r->bad_steps, r->end.last.step, r->verdict.message);
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING && r->summed;
         kind++) { /* of the whole march */
        const double added = br_energy_added(&r->work, kind);
        const double in = br_energy_put_in(&r->energy_start, &r->work, kind);
        if (added <= 0)
            continue;
        br_put_answer(d, "The scheme ADDED %.3g J to the %s field", added, br_field_names[kind]);
        if (in > 0)
            br_put_more(d, " (%.2g %% of the initial energy and the work of the loads)",
                        100 * added / in);
        br_put_more(d, ".");
        if (kind == BR_AXIAL && r->work.scheme_contact < 0 && !r->method.contact->at_new_step)
            br_put_more(d, " The lagged contact added it: --contact implicit adds none.");
    }
    if (r->contact_unstable)
        br_put_answer(d, "The lagged contact is beyond its stability limit here: the tip may "
                         "chatter at the step's rate. --contact implicit has no such limit.");
    for (size_t i = 0; i < w->count; i++) {
        if (i == 0) /* their texts are below, and the terminal had them before the march */
            br_put_answer(d, "%zu warning%s before the march: ", w->count,
                          w->count == 1 ? "" : "s");
        br_put_more(d, "%s%s", br_warning_words[w->list[i].kind], i + 1 < w->count ? ", " : ".");
    }
}

/* ---- the march ---- */

/* "0.0014, between 0.00046 and 0.0042" */
static void put_predicted(struct br_document *d, bool known, const char *key, const char *label,
                          const struct br_predicted *e)
{
    char interval[BR_PREDICTED_TEXT];
    br_put_fact_as(d, br_if(known, br_number(e->error)), label, NULL, "prediction.%s.error", key);
    br_put_shown(d, "%s", br_predicted_interval(e, interval));
    br_hide_fact(d, br_if(known, br_number(e->low)), NULL, "prediction.%s.low", key);
    br_hide_fact(d, br_if(known, br_number(e->high)), NULL, "prediction.%s.high", key);
}

/* ---- the tip ---- */

static void put_extreme(struct br_document *d, const struct br_run_findings *f, bool known,
                        const char *key, const char *label, const struct br_extreme *e)
{
    put_number(d, f, known ? e->value : NAN, NAN, label, "N", br_format(d, "events.%s.value", key));
    br_put_fact_as(d, br_if(known, br_number(e->time)), "  at t", "s", "events.%s.t", key);
}

/* A bound that follows the contact is as wrong as the penetration; another one is given. */
static void put_friction(struct br_document *d, const struct br_run_findings *f)
{
    const struct br_run_report *r = f->report;
    const struct br_friction *law = &r->marched.friction;
    const struct br_tip_watch *w = &r->watch;
    const double force = r->end.last.friction_force, bound = r->end.last.friction_bound;
    const bool friction = has_friction(r), follows = br_friction_follows_contact(law) && bound > 0;
    const double depth = br_penetration(&r->marched.contact, r->end.last.displacement[BR_AXIAL]);
    const double error =
        follows ? br_friction_models[law->law].slope(law, depth) * tip_error(f, BR_AXIAL) : NAN;
    put_number(d, f, friction ? force : NAN, fabs(force) == bound ? error : NAN, "friction force",
               "N", "tip.friction_force");
    put_number(d, f, friction ? bound : NAN, error, "  its bound", "N", "tip.friction_bound");
    BR_FACT(d, br_if(friction, br_number(100 * fabs(force) / bound)), .key = "tip.friction_share",
            .heading = "  of the bound", .unit = "%", .format = "%.4g");
    BR_FACT(d, br_if(friction && w->steps, br_text(br_tip_regime_words[w->regime])),
            .key = "tip.regime", .heading = "friction");
    br_put_mark(d, w->regime == BR_TIP_SLIP ? direction(w->direction) : "");
    put_extreme(d, f, friction, "largest_friction_force", "largest friction force",
                &w->friction_force);
}

/* Whether the tip sticks and its velocity may be the round-off of displacements, over a step. */
static bool rests(const struct br_run_findings *f)
{
    const struct br_run_report *r = f->report;
    const double most = f->prediction->size[BR_BENDING] * sqrt(5 / r->scene->length);
    return r->watch.friction && r->watch.steps && r->watch.regime == BR_TIP_STICK &&
           fabs(r->end.last.velocity[BR_BENDING]) <= r->round_off * most / r->k;
}

static void put_tip(struct br_document *d, const struct br_run_findings *f)
{
    static const char *const displacements[] = {"axial displacement u", "bending displacement w"};
    const struct br_run_report *r = f->report;
    const struct br_history_row *row = &r->end.last;
    const bool contact = r->marched.contact.modelled;
    const double error[] = {tip_error(f, BR_AXIAL), tip_error(f, BR_BENDING)};
    br_put_section(d, "The tip");
    BR_FACT(d, br_number(row->time), .key = "tip.t", .heading = "t", .unit = "s");
    br_hide_fact(d, br_count(row->step), NULL, "tip.step");
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        br_put_fact_as(d,
                       br_if(r->marched.field[kind].modelled, br_number(row->displacement[kind])),
                       displacements[kind], "m", "tip.displacement.%s", br_field_names[kind]);
        br_put_shown(d, "%s", with_error(d, row->displacement[kind], error[kind]));
    }
    put_two(d, r, error, NULL, "m", "tip.predicted_error");
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        put_number(d, f, r->marched.field[kind].modelled ? row->velocity[kind] : NAN, NAN,
                   kind == BR_AXIAL ? "velocity, axial" : "velocity, bending", "m/s",
                   kind == BR_AXIAL ? "tip.velocity.axial" : "tip.velocity.bending");
    if (rests(f))
        br_put_shown(d, "0");
    put_number(d, f, contact ? row->contact_force : NAN,
               row->contact_force > 0
                   ? br_contact_slope(&r->marched.contact, row->contact_force) * error[BR_AXIAL]
                   : NAN,
               "contact force", "N", "tip.contact_force");
    BR_FACT(d, br_if(contact, br_truth(r->watch.closed)), .key = "tip.closed",
            .heading = "contact");
    br_put_shown(d, "%s", r->watch.closed ? "closed" : "open");
    put_extreme(d, f, contact, "largest_contact_force", "largest contact force",
                &r->watch.contact_force);
    put_friction(d, f);
}

/* ---- events ---- */

static void put_switch(struct br_document *d, const struct br_switch *s)
{
    const enum br_regime regime[] = {s->from, s->to};
    br_put_row(d);
    BR_PUT(d, br_number(s->time), .key = "t", .unit = "s", .format = "%.12g");
    BR_PUT(d, br_text(s->kind == BR_AXIAL ? "contact" : "friction"), .key = "law");
    for (int j = 0; j < 2; j++) {
        BR_PUT(d, br_text(br_regime_name(regime[j])), .key = j ? "to" : "from");
        if (regime[j] == BR_REGIME_NONE)
            br_put_shown(d, "no bound");
    }
}

static void put_switches(struct br_document *d, const struct br_run_report *r)
{
    BR_FACT(d, br_count(r->switches), .key = "events.switches",
            .heading = "switches that the scheme has found");
    br_put_table(d, "switches_found", "Switches that the scheme found within its steps", 0);
    put_switch(d, &(struct br_switch){0});
    br_put_no_row(d);
    for (size_t i = 0; i < r->switches && i < BR_MOST_SWITCHES; i++)
        put_switch(d, &r->switched[i]);
}

/* Puts a number of steps, and their share. */
static void put_steps(struct br_document *d, bool known, const char *word, size_t steps, size_t all)
{
    br_put_fact_as(d, br_count(steps), known && all ? br_format(d, "steps: %s", word) : NULL, NULL,
                   "events.steps.%s", word);
    br_put_shown(d, "%zu (%.4g %%)", steps, all ? 100 * (double)steps / (double)all : 0);
}

static void put_event(struct br_document *d, const struct br_tip_event *e)
{
    const struct br_value sign = {.kind = BR_COUNT, .count = e->direction};
    br_put_row(d);
    BR_PUT(d, br_number(e->time), .key = "t", .unit = "s", .format = "%.10g");
    BR_PUT(d, br_text(br_tip_event_words[e->kind]), .key = "event");
    BR_PUT(d, br_if(e->direction, sign), .key = "direction");
    br_put_shown(d, "%s", direction(e->direction) + (e->direction != 0)); /* no blank */
    BR_PUT(d, br_count(e->step), .key = "step");
}

static void put_events(struct br_document *d, const struct br_run_report *r)
{
    const struct br_tip_watch *w = &r->watch;
    br_put_section(d, "Events at the tip");
    br_put_note(d,
                "The time of an event is the first time level of the new regime. The event "
                "happened in the step before, up to k = %g s earlier.",
                r->k);
    br_hide_fact(d, br_number(r->k), "s", "events.resolution");
    BR_FACT(d, br_if(w->contact, br_truth(w->closed_at_start)), .key = "events.closed_at_start",
            .heading = "at first");
    br_put_shown(d, "%s", w->closed_at_start ? "closed" : "open");
    BR_FACT(d, br_if(w->friction && w->steps, br_text(br_tip_regime_words[w->regime_at_start])),
            .key = "events.regime_at_start", .heading = "in the first step");
    br_put_mark(d, direction(w->direction_at_start));
    for (int kind = 0; kind < BR_TIP_EVENTS; kind++) {
        const char *word = br_tip_event_words[kind];
        br_put_fact_as(d, br_count(w->count[kind]), w->contact || w->friction ? word : NULL, NULL,
                       "events.counts.%s", word);
    }
    put_steps(d, w->contact, "closed", w->closed_steps, w->steps);
    for (int regime = 0; regime < BR_TIP_REGIMES; regime++)
        put_steps(d, w->friction, br_tip_regime_words[regime], w->regime_steps[regime], w->steps);
    br_put_table(d, "events", "When", 0);
    put_event(d, &(struct br_tip_event){0});
    br_put_no_row(d);
    for (size_t i = 0; i < w->events; i++)
        put_event(d, &w->event[i]);
    if (r->method.scheme->adaptive)
        put_switches(d, r);
}

/* ---- energies ---- */

/* Puts the energies of a state; people see those of the end. */
static void put_state(struct br_document *d, const struct br_run_report *r, bool end,
                      const struct br_energy *e)
{
    const char *of = end ? "end" : "start";
    put_two(d, r, e->kinetic, end ? "kinetic" : NULL, "J", br_format(d, "energies.%s.kinetic", of));
    put_two(d, r, e->stored, end ? "stored" : NULL, "J", br_format(d, "energies.%s.stored", of));
    br_put_fact_as(d, br_if(r->marched.contact.modelled, br_number(e->contact)),
                   end ? "of the contact" : NULL, "J", "energies.%s.contact", of);
    br_put_fact_as(d, br_number(br_energy_total(e)), end ? "total" : "total at t = 0", "J",
                   "energies.%s.total", of);
}

static void put_works(struct br_document *d, const struct br_run_report *r)
{
    const struct br_work *w = &r->work;
    const double imbalance = br_energy_imbalance(&r->energy_start, &r->energy_now, w);
    const double added[] = {br_energy_added(w, BR_AXIAL), br_energy_added(w, BR_BENDING)};
    const double put_in[] = {br_energy_put_in(&r->energy_start, w, BR_AXIAL),
                             br_energy_put_in(&r->energy_start, w, BR_BENDING)};
    const double steps[] = {(double)w->gaining[BR_AXIAL], (double)w->gaining[BR_BENDING]};
    const bool any = steps[BR_AXIAL] + steps[BR_BENDING] > 0;
    put_two(d, r, w->loads, "work of the loads", "J", "energies.work_of_loads");
    put_two(d, r, w->viscous, "lost to viscosity", "J", "energies.lost_to_viscosity");
    put_two(d, r, w->scheme, "lost to the scheme", "J", "energies.lost_to_scheme");
    br_put_fact_as(d, br_if(r->marched.contact.modelled, br_number(w->scheme_contact)),
                   "  and by its contact", "J", "energies.lost_to_scheme_by_contact");
    br_put_fact_as(d, br_number(imbalance), "imbalance over the sum of the terms", NULL,
                   "energies.imbalance");
    br_put_fact_as(d, br_number(r->energy_worst), "  in one step at most", NULL,
                   "energies.largest_imbalance_of_a_step");
    put_two(d, r, added, NULL, "J", "energies.added_by_scheme.in_all");
    put_two(d, r, put_in, NULL, "J", "energies.added_by_scheme.put_in");
    put_two(d, r, steps, any ? "steps in which the scheme added energy" : NULL, NULL,
            "energies.added_by_scheme.steps_that_add");
    put_two(d, r, w->gained, any ? "  added in these" : NULL, "J",
            "energies.added_by_scheme.by_these_steps");
}

static void put_energies(struct br_document *d, const struct br_run_report *r)
{
    const double friction = r->summed ? r->work.friction : r->watch.friction_work;
    br_put_section(d, "Energies");
    put_state(d, r, false, &r->energy_start);
    if (r->at_end)
        put_state(d, r, true, &r->energy_now);
    else
        br_hide_fact(d, br_nothing(), NULL, "energies.end");
    BR_FACT(d, br_if(has_friction(r), br_number(friction)), .key = "energies.lost_to_friction",
            .heading = "lost to friction", .unit = "J");
    BR_FACT(d, br_truth(r->summed), .key = "energies.summed",
            .heading = r->summed ? NULL : "works, losses, balance");
    br_put_shown(d, "not summed; --check sums them");
    if (r->summed)
        put_works(d, r);
}

/* ---- the certificate ---- */

/* Puts the certificate, by code that the solver does not share; by stages where there are some. */
static void put_certificate(struct br_document *d, const struct br_run_report *r)
{
    const struct br_certificate *c = &r->worst, *limit = &r->limits;
    const struct {
        const char *key, *name;
        double worst, limit;
        bool modelled;
    } rows[] = {
        {"axial", "axial equation (27)", c->axial_residual, limit->axial_residual,
         r->marched.axial.modelled},
        {"bending", "bending equation (28)", c->bending_residual, limit->bending_residual,
         r->marched.bending.modelled},
        {"update", "update of the state", c->update, limit->update, true},
        {"contact", "contact law (10)", c->contact, limit->contact, r->marched.contact.modelled},
        {"friction", "friction law (12)", c->friction, limit->friction, has_friction(r)},
        {"energy", "energy balance", r->energy_worst, r->energy_limit, true},
    };
    if (!r->checked) {
        br_hide_fact(d, br_nothing(), NULL, "certificate");
        return;
    }
    br_put_section(d, r->method.scheme == br_time_schemes[0]
                          ? "Certificate of every step: the worst"
                          : "Certificate of every step, stage by stage: the worst");
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const double worst = rows[i].worst, most = rows[i].limit;
        br_put_fact_as(d, br_number(worst), rows[i].modelled ? rows[i].name : NULL, NULL,
                       "certificate.worst.%s", rows[i].key);
        if (isfinite(most))
            br_put_shown(d, "%.3g of at most %.3g: %s", worst, most,
                         worst <= most ? "good" : "BAD");
        else
            br_put_shown(d, "%.3g: not checked, round-off alone may be larger", worst);
        br_hide_fact(d, br_number(most), NULL, "certificate.limits.%s", rows[i].key);
    }
    BR_FACT(d, br_count(r->bad_steps), .key = "certificate.bad_steps",
            .heading = "steps beyond a limit");
    br_hide_fact(d, br_text(r->bad_steps ? r->verdict.message : NULL), NULL, "certificate.first");
}

void br_report_run(const struct br_run_findings *f, struct br_document *d)
{
    const struct br_run_report *r = f->report;
    const struct br_scene *scene = r->scene;
    br_document_begin(d, "summary", "beamrate run", 2, scene->title);
    put_answers(d, f);

    char method[BR_METHOD_TEXT];
    br_put_section(d, "The march");
    br_hide_fact(d, br_text(scene->name), NULL, "scene.name");
    br_hide_fact(d, br_text(scene->title), NULL, "scene.title");
    br_put_fact_as(d, br_text(scene->remark), "remark", NULL, "scene.remark");
    br_hide_fact(d, br_number(scene->length), "m", "scene.length");
    br_hide_fact(d, br_number(scene->duration), "s", "scene.duration");
    br_put_fact_as(d, br_count(r->n), "elements", NULL, "n");
    br_put_fact_as(d, br_number(r->h), "element size h", "m", "h");
    br_put_fact_as(d, br_count(r->steps), "steps", NULL, "steps");
    br_put_fact_as(d, br_number(r->k), "time step k", "s", "k");
    const struct br_meshes on = {&r->marched, &r->n, 1};
    BR_FACT(d, br_text(br_method_text(&on, &r->method, method)), .key = "words",
            .heading = "method", .flags = BR_FOR_PEOPLE);
    br_put_method_facts(d, "method", &r->method, &on);
    br_hide_fact(d, br_failure_text(&r->failure), NULL, "stopped");
    br_hide_fact(d, br_truth(r->contact_unstable), NULL, "contact_beyond_stability_limit");
    if (scene->derived->what)
        br_put_section(d, "Derived from what the scene gives");
    for (const struct br_derived *n = scene->derived; n->what; n++) {
        const char *dot = strchr(n->what, '.');
        const char *heading = br_format(d, "%.*s%s%s = %s", dot ? (int)(dot - n->what) : 0, n->what,
                                        dot ? " " : "", dot ? dot + 1 : n->what, n->from);
        br_put_fact_as(d, br_number(n->value), heading, n->unit, "derived.%s", n->what);
    }

    /* A remedy is an option that can be typed. */
    br_put_table(d, "warnings", "Warnings before the march", BR_FOR_PROGRAMS);
    for (size_t i = 0; i < f->warnings->count; i++) {
        const struct br_warning *w = &f->warnings->list[i];
        br_put_row(d);
        BR_PUT(d, br_text(br_warning_words[w->kind]), .key = "warning");
        BR_PUT(d, br_text(w->text), .key = "text");
        BR_PUT(d, br_text(*w->remedy ? w->remedy : NULL), .key = "remedy");
    }
    for (size_t i = 0; i < f->warnings->count; i++) {
        const struct br_warning *w = &f->warnings->list[i];
        br_put_note(d, "Warning: %s.", w->text);
        br_put_command(d, br_format(d, "remedies.%s", br_warning_words[w->kind]), "Remedy",
                       w->remedy);
    }

    static const char *const labels[] = {"  of the axial field", "  of the bending field"};
    const struct br_prediction *p = f->prediction;
    br_put_section(d, "Predicted before the march, for each field relative to its largest L2 norm");
    br_hide_fact(d, br_truth(p->known), NULL, "prediction.known");
    br_hide_fact(d, br_text(p->known ? NULL : p->why), NULL, "prediction.why_not");
    put_predicted(d, p->bounded, "discretisation", "discretisation error", &p->whole);
    put_predicted(d, p->bounded, "time", "  of the time steps", &p->time);
    put_predicted(d, p->bounded, "space", "  of the elements", &p->space);
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        const double most = br_predicted_most(p, kind);
        const bool marched = f->report->marched.field[kind].modelled;
        put_predicted(d, marched && p->bounded, br_field_names[kind], labels[kind],
                      &p->field[kind]);
        br_hide_fact(d, br_if(marched && p->known, br_number(most)), NULL, "prediction.%s.most",
                     br_field_names[kind]);
    }
    BR_FACT(d, br_number(round_off_of(f)), .key = "prediction.round_off", .heading = "round-off",
            .format = "%.1e");
    br_hide_fact(d, br_number(p->seconds), "s", "prediction.seconds");

    put_tip(d, f);
    put_events(d, r);
    put_energies(d, r);
    put_certificate(d, r);

    br_put_table(d, "model", "What is modelled, and what is left out", 0);
    for (size_t i = 0; i < r->model_rows; i++) {
        br_put_row(d);
        BR_PUT(d, br_text(r->model[i].key), .key = "part");
        br_put_shown(d, "%s", r->model[i].part);
        BR_PUT(d, br_truth(r->model[i].modelled), .key = "modelled");
        br_put_shown(d, "%s", r->model[i].modelled ? "modelled" : "skipped");
        BR_PUT(d, br_text(r->model[i].why), .key = "why", .heading = "how, or why it is left out");
    }

    const struct br_counts *c = &r->counts;
    const double march = r->end.march_seconds;
    const double a_step = march / (double)r->end.last.step; /* NAN: none */
    const bool iterates = r->method.friction->iterates && has_friction(r);
    const char *of_march = r->checked ? "  of the march, the check included" : "  of the march";
    br_put_section(d, "Time and work");
    br_put_fact_as(d, br_number(f->wall_seconds), "time", "s", "seconds.wall");
    br_put_fact_as(d, br_number(r->end.set_up_seconds), "  of setting up", "s", "seconds.set_up");
    br_put_fact_as(d, br_number(march), of_march, "s", "seconds.march");
    br_put_fact_as(d, br_number(a_step), "  a step", "s", "seconds.per_step");
    br_put_fact_as(d, br_number(a_step / (double)r->n), "  an element-step", "s",
                   "seconds.per_element_step");
    br_put_fact_as(d, br_count(c->steps), "steps of the scheme", NULL, "work.steps");
    br_put_fact_as(d, br_count(c->rejected), r->method.scheme->adaptive ? "  taken back" : NULL,
                   NULL, "work.steps_taken_back");
    br_put_fact_as(d, br_count(c->stages), "solves a field", NULL, "work.solves_a_field");
    br_put_fact_as(d, br_count(c->set_ups), c->set_ups ? "changes of the step" : NULL, NULL,
                   "work.changes_of_the_step");
    br_put_fact_as(d, br_count(c->iterations), iterates ? "friction iterations" : NULL, NULL,
                   "work.friction_iterations");

    br_put_provenance(d, f->provenance);
}
