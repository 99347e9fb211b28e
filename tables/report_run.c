/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tables/report_run.h"

#include <math.h>
#include <stdarg.h>
#include <string.h>

#include "study/scene/method_fields.h"
#include "tables/report_method.h"

enum { KEY = 80, LABEL = 120, VALUE = 80, SENTENCE = 1000 };

static const char *const field_names[2] = {"axial", "bending"};

/* ---- facts ---- */

/* Without a label, and what is not known: for programs alone. The key is formatted. */
__attribute__((format(printf, 5, 6))) static void put(struct br_document *d, struct br_value value,
                                                      const char *label, const char *unit,
                                                      const char *key, ...)
{
    char name[KEY];
    va_list arguments;
    va_start(arguments, key);
    vsnprintf(name, sizeof name, key, arguments);
    va_end(arguments);
    const bool lacks =
        value.kind == BR_NOTHING || (value.kind == BR_NUMBER && !isfinite(value.number));
    br_put_fact(d,
                &(struct br_column){.key = name,
                                    .heading = label,
                                    .unit = unit,
                                    .flags = label && !lacks ? 0 : BR_FOR_PROGRAMS},
                value);
}

static struct br_value if_known(bool known, struct br_value value)
{
    return known ? value : br_nothing();
}

static bool is_marched(const struct br_run_report *r, int kind)
{
    return kind == BR_AXIAL ? r->marched.axial.modelled : r->marched.bending.modelled;
}

static bool has_friction(const struct br_run_report *r)
{
    return r->marched.friction.law != BR_FRICTIONLESS;
}

/* Of both fields: KEY.axial and KEY.bending. */
static void put_two(struct br_document *d, const struct br_run_report *r, const double x[2],
                    const char *label, const char *unit, const char *key)
{
    char whole[LABEL];
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        snprintf(whole, sizeof whole, "%s, %s", label ? label : "", field_names[kind]);
        put(d, if_known(is_marched(r, kind), br_number(x[kind])), label ? whole : NULL, unit,
            "%s.%s", key, field_names[kind]);
    }
}

static const char *direction(int sign)
{
    return sign > 0 ? " towards +w" : sign < 0 ? " towards -w" : "";
}

/* ---- the answer ---- */

/* What the tip's displacement is predicted to be off, m; NAN: not known. */
static double tip_error(const struct br_run_findings *f, int kind)
{
    const double error =
        br_predicted_tip(f->prediction, (enum br_field_kind)kind, f->report->scene->length);
    return f->prediction->known ? error : NAN;
}

/* "-0.2216 +- 0.014": the value to the error's second digit. */
static const char *with_error(double value, double error, char text[VALUE])
{
    if (isinf(error)) {
        snprintf(text, VALUE, "%.1g (perhaps no digit is right)", value);
        return text;
    }
    if (!(error > 0) || value == 0) {
        snprintf(text, VALUE, error > 0 ? "%.6g +- %.2g" : "%.6g", value, error);
        return text;
    }
    const int first = (int)floor(log10(fabs(value))), last = (int)floor(log10(error)) - 1;
    if (first < -4 || first > 6 || last > 0 || last < -15)
        snprintf(text, VALUE, "%.*e +- %.1e", first > last ? first - last : 0, value, error);
    else
        snprintf(text, VALUE, "%.*f +- %.*f", -last, value, -last, error);
    return text;
}

__attribute__((format(printf, 2, 3))) static void append(char text[SENTENCE], const char *format,
                                                         ...)
{
    const size_t used = strlen(text);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text + used, SENTENCE - used, format, arguments);
    va_end(arguments);
}

static void answer_tip(struct br_document *d, const struct br_run_findings *f)
{
    const struct br_run_report *r = f->report;
    const struct br_tip_watch *w = &r->watch;
    char text[SENTENCE] = "", value[VALUE];
    append(text, "Tip at t = %.10g s%s:", r->end.last.time,
           r->failure.status ? " (the last good step)" : "");
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        if (is_marched(r, kind))
            append(text, " %s = %s m,", kind == BR_AXIAL ? "u" : "w",
                   with_error(r->end.last.displacement[kind], tip_error(f, kind), value));
    if (w->contact)
        append(text, " contact %s,", w->closed ? "closed" : "open");
    if (w->friction && w->steps)
        append(text, " friction: %s%s,", br_tip_regime_word(w->regime),
               w->regime == BR_TIP_SLIP ? direction(w->direction) : "");
    text[strlen(text) - 1] = '.';
    for (int kind = 0, told = 0; kind < BR_TIP_EVENTS; kind++)
        if (w->count[kind])
            append(text, "%s %s %zu",
                   told++ ? "," : " Events:", br_tip_event_word((enum br_tip_event_kind)kind),
                   w->count[kind]);
    br_put_answer(d, "%s%s", text, text[strlen(text) - 1] == '.' ? "" : ".");
}

static void answer_prediction(struct br_document *d, const struct br_prediction *p)
{
    char interval[BR_PREDICTED_TEXT];
    if (p->known)
        br_put_answer(d,
                      "Predicted before the march, of each field relative to its largest (L2): "
                      "discretisation error %s (time %.2g, space %.2g); round-off %.2g. +- is what "
                      "this may make at the tip, an estimate.",
                      br_predicted_interval(&p->whole, interval), p->time.error, p->space.error,
                      p->round_off);
    else if (p->bounded)
        br_put_answer(d,
                      "The discretisation error is not known, between %.0e and %.0e: %s; "
                      "round-off %.1e.",
                      p->whole.low, p->whole.high, p->why, p->round_off);
    else
        br_put_answer(d, "The discretisation error is not known: %s; round-off %.1e.", p->why,
                      p->round_off);
}

/* Their texts stand below, and were on the terminal before the march. */
static void answer_warnings(struct br_document *d, const struct br_warnings *w)
{
    char text[SENTENCE] = "";
    for (size_t i = 0; i < w->count; i++)
        append(text, "%s%s", i ? ", " : "", br_warning_word(w->list[i].kind));
    if (w->count)
        br_put_answer(d, "%zu warning%s before the march: %s.", w->count, w->count == 1 ? "" : "s",
                      text);
}

/* What the scheme has added in all. */
static void answer_gain(struct br_document *d, const struct br_run_report *r, int kind)
{
    const double added = br_energy_added(&r->work, (enum br_field_kind)kind);
    const double put_in = br_energy_put_in(&r->energy_start, &r->work, (enum br_field_kind)kind);
    char share[LABEL] = "";
    if (!(added > 0))
        return;
    if (put_in > 0)
        snprintf(share, sizeof share,
                 " (%.2g %% of what was there at first and of the loads' work)",
                 100 * added / put_in);
    br_put_answer(d, "The scheme ADDED %.3g J to the %s field%s.%s", added, field_names[kind],
                  share,
                  kind == BR_AXIAL && r->work.scheme_contact < 0 && !r->method.contact->at_new_step
                      ? " It is the lagged contact's: --contact implicit adds none."
                      : "");
}

static void put_answers(struct br_document *d, const struct br_run_findings *f)
{
    const struct br_run_report *r = f->report;
    if (r->failure.status)
        br_put_answer(d, "STOPPED: %s", r->failure.message);
    answer_tip(d, f);
    answer_prediction(d, f->prediction);
    if (r->bad_steps)
        br_put_answer(d, "%zu of %zu steps are beyond the certificate's limits; the first: %s",
                      r->bad_steps, r->end.last.step, r->verdict.message);
    for (int kind = BR_AXIAL; kind <= BR_BENDING && r->summed; kind++)
        answer_gain(d, r, kind);
    if (r->contact_unstable)
        br_put_answer(d, "The lagged contact is beyond its stability limit here: the tip may "
                         "chatter at the step's rate. --contact implicit has no such limit.");
    answer_warnings(d, f->warnings);
}

/* ---- the march ---- */

static void put_march(struct br_document *d, const struct br_run_findings *f)
{
    const struct br_run_report *r = f->report;
    char method[BR_METHOD_TEXT];
    br_put_section(d, "The march");
    put(d, br_text(r->scene->name), NULL, NULL, "scene.name");
    put(d, br_text(r->scene->title), NULL, NULL, "scene.title");
    put(d, br_text(r->scene->remark), "remark", NULL, "scene.remark");
    put(d, br_number(r->scene->length), NULL, "m", "scene.length");
    put(d, br_number(r->scene->duration), NULL, "s", "scene.duration");
    put(d, br_count(r->n), "elements", NULL, "n");
    put(d, br_number(r->h), "element size h", "m", "h");
    put(d, br_count(r->steps), "steps", NULL, "steps");
    put(d, br_number(r->k), "time step k", "s", "k");
    br_put_fact(d, &(struct br_column){.key = "words", .heading = "method", .flags = BR_FOR_PEOPLE},
                br_text(br_method_text(&r->marched, &r->method, method)));
    br_put_method(d, "method", &r->method);
    put(d, br_text(r->failure.status ? r->failure.message : NULL), NULL, NULL, "stopped");
    put(d, br_truth(r->contact_unstable), NULL, NULL, "contact_beyond_stability_limit");
}

/* "0.0014, between 0.00046 and 0.0042" */
static void put_predicted(struct br_document *d, bool known, const char *key, const char *label,
                          const struct br_predicted *e)
{
    char interval[BR_PREDICTED_TEXT];
    put(d, if_known(known, br_number(e->error)), label, NULL, "prediction.%s.error", key);
    br_put_shown(d, "%s", br_predicted_interval(e, interval));
    put(d, if_known(known, br_number(e->low)), NULL, NULL, "prediction.%s.low", key);
    put(d, if_known(known, br_number(e->high)), NULL, NULL, "prediction.%s.high", key);
}

static void put_prediction(struct br_document *d, const struct br_run_findings *f)
{
    const struct br_prediction *p = f->prediction;
    const double most[] = {br_predicted_most(p, BR_AXIAL), br_predicted_most(p, BR_BENDING)};
    br_put_section(d, "Predicted before the march, of each field relative to its largest (L2)");
    put(d, br_truth(p->known), NULL, NULL, "prediction.known");
    put(d, br_text(p->known ? NULL : p->why), NULL, NULL, "prediction.why_not");
    put_predicted(d, p->bounded, "discretisation", "discretisation error", &p->whole);
    put_predicted(d, p->bounded, "time", "  of the time steps", &p->time);
    put_predicted(d, p->bounded, "space", "  of the elements", &p->space);
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        const bool marched = is_marched(f->report, kind);
        put_predicted(d, marched && p->bounded, field_names[kind],
                      kind == BR_AXIAL ? "  of the axial field" : "  of the bending field",
                      &p->field[kind]);
        put(d, if_known(marched && p->known, br_number(most[kind])), NULL, NULL,
            "prediction.%s.most", field_names[kind]);
    }
    put(d, br_number(p->round_off), "round-off", NULL, "prediction.round_off");
    br_put_shown(d, "%.1e", p->round_off);
    put(d, br_number(p->seconds), NULL, "s", "prediction.seconds");
}

/* Remedies are options that can be typed. */
static void put_warnings(struct br_document *d, const struct br_warnings *w)
{
    static const struct br_column columns[] = {
        {.key = "warning"}, {.key = "text"}, {.key = "remedy"}};
    char key[KEY];
    br_put_table(d, "warnings", "Warnings before the march", BR_FOR_PROGRAMS, BR_COLUMNS(columns));
    for (size_t i = 0; i < w->count; i++) {
        br_put_row(d);
        br_put(d, "warning", br_text(br_warning_word(w->list[i].kind)));
        br_put(d, "text", br_text(w->list[i].text));
        br_put(d, "remedy", br_text(w->list[i].remedy[0] ? w->list[i].remedy : NULL));
    }
    for (size_t i = 0; i < w->count; i++) {
        snprintf(key, sizeof key, "remedies.%s", br_warning_word(w->list[i].kind));
        br_put_note(d, "Warning: %s.", w->list[i].text);
        br_put_command(d, key, "Remedy", w->list[i].remedy);
    }
}

/* ---- the tip ---- */

static void put_extreme(struct br_document *d, bool known, const char *key, const char *label,
                        const struct br_extreme *e)
{
    put(d, if_known(known, br_number(e->value)), label, "N", "events.%s.value", key);
    put(d, if_known(known, br_number(e->time)), "  at t", "s", "events.%s.t", key);
}

static void put_friction(struct br_document *d, const struct br_run_report *r)
{
    const struct br_history_row *row = &r->end.last;
    const double share = 100 * fabs(row->friction_force) / row->friction_bound;
    const bool friction = has_friction(r);
    put(d, if_known(friction, br_number(row->friction_force)), "friction force", "N",
        "tip.friction_force");
    put(d, if_known(friction, br_number(row->friction_bound)), "  its bound", "N",
        "tip.friction_bound");
    put(d, if_known(friction, br_number(share)), "  of the bound", "%", "tip.friction_share");
    put(d, if_known(friction && r->watch.steps, br_text(br_tip_regime_word(r->watch.regime))),
        "friction", NULL, "tip.regime");
    br_put_mark(d, r->watch.regime == BR_TIP_SLIP ? direction(r->watch.direction) : "");
    put_extreme(d, friction, "largest_friction_force", "largest friction force",
                &r->watch.friction_force);
}

static void put_tip(struct br_document *d, const struct br_run_findings *f)
{
    static const char *const labels[] = {"axial displacement u", "bending displacement w"};
    const struct br_run_report *r = f->report;
    const struct br_history_row *row = &r->end.last;
    const bool contact = r->marched.contact.modelled;
    const double error[] = {tip_error(f, BR_AXIAL), tip_error(f, BR_BENDING)};
    char text[VALUE];
    br_put_section(d, "The tip");
    put(d, br_number(row->time), "t", "s", "tip.t");
    put(d, br_count(row->step), NULL, NULL, "tip.step");
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        put(d, if_known(is_marched(r, kind), br_number(row->displacement[kind])), labels[kind], "m",
            "tip.displacement.%s", field_names[kind]);
        br_put_shown(d, "%s", with_error(row->displacement[kind], error[kind], text));
    }
    put_two(d, r, error, NULL, "m", "tip.predicted_error");
    put_two(d, r, row->velocity, "velocity", "m/s", "tip.velocity");
    put(d, if_known(contact, br_number(row->contact_force)), "contact force", "N",
        "tip.contact_force");
    put(d, if_known(contact, br_truth(r->watch.closed)), "contact", NULL, "tip.closed");
    br_put_shown(d, "%s", r->watch.closed ? "closed" : "open");
    put_extreme(d, contact, "largest_contact_force", "largest contact force",
                &r->watch.contact_force);
    put_friction(d, r);
}

/* ---- events ---- */

static void put_switches(struct br_document *d, const struct br_run_report *r)
{
    static const struct br_column columns[] = {{.key = "t", .unit = "s", .format = "%.12g"},
                                               {.key = "law"},
                                               {.key = "from"},
                                               {.key = "to"}};
    if (!r->method.scheme->adaptive)
        return;
    put(d, br_count(r->switches), "switches that the scheme has found", NULL, "events.switches");
    br_put_table(d, "switches_found", "Switches within its steps, as the scheme has found them", 0,
                 BR_COLUMNS(columns));
    for (size_t i = 0; i < r->switches && i < BR_MOST_SWITCHES; i++) {
        const struct br_switch *s = &r->switched[i];
        br_put_row(d);
        br_put(d, "t", br_number(s->time));
        br_put(d, "law", br_text(s->kind == BR_AXIAL ? "contact" : "friction"));
        br_put(d, "from", br_text(br_regime_name(s->from)));
        br_put_shown(d, "%s", s->from == BR_REGIME_NONE ? "no bound" : br_regime_name(s->from));
        br_put(d, "to", br_text(br_regime_name(s->to)));
        br_put_shown(d, "%s", s->to == BR_REGIME_NONE ? "no bound" : br_regime_name(s->to));
    }
}

static void put_event_list(struct br_document *d, const struct br_tip_watch *w)
{
    static const struct br_column columns[] = {
        {.key = "t", .unit = "s", .format = "%.10g"},
        {.key = "event"},
        {.key = "direction"},
        {.key = "step"},
    };
    br_put_table(d, "events", "When", 0, BR_COLUMNS(columns));
    for (size_t i = 0; i < w->events; i++) {
        const struct br_tip_event *e = &w->event[i];
        const struct br_value sign = {.kind = BR_COUNT, .count = e->direction};
        br_put_row(d);
        br_put(d, "t", br_number(e->time));
        br_put(d, "event", br_text(br_tip_event_word(e->kind)));
        br_put(d, "direction", e->direction ? sign : br_nothing());
        br_put_shown(d, "%s", direction(e->direction) + (e->direction != 0)); /* no blank */
        br_put(d, "step", br_count(e->step));
    }
}

/* How many steps, and what share that is. */
static void put_steps(struct br_document *d, bool known, const char *word, size_t steps, size_t all)
{
    char label[LABEL];
    snprintf(label, sizeof label, "steps: %s", word);
    put(d, br_count(steps), known && all ? label : NULL, NULL, "events.steps.%s", word);
    br_put_shown(d, "%zu (%.4g %%)", steps, all ? 100 * (double)steps / (double)all : 0);
}

static void put_events(struct br_document *d, const struct br_run_report *r)
{
    const struct br_tip_watch *w = &r->watch;
    br_put_section(d, "Events at the tip");
    br_put_note(d,
                "An event is told at the first time level of the new regime: it happened in the "
                "step before, up to k = %g s earlier.",
                r->k);
    put(d, br_number(r->k), NULL, "s", "events.resolution");
    put(d, if_known(w->contact, br_truth(w->closed_at_start)), "at first", NULL,
        "events.closed_at_start");
    br_put_shown(d, "%s", w->closed_at_start ? "closed" : "open");
    put(d, if_known(w->friction && w->steps, br_text(br_tip_regime_word(w->regime_at_start))),
        "in the first step", NULL, "events.regime_at_start");
    br_put_mark(d, direction(w->direction_at_start));
    for (int kind = 0; kind < BR_TIP_EVENTS; kind++) {
        const char *word = br_tip_event_word((enum br_tip_event_kind)kind);
        put(d, br_count(w->count[kind]), w->contact || w->friction ? word : NULL, NULL,
            "events.counts.%s", word);
    }
    put_steps(d, w->contact, "closed", w->closed_steps, w->steps);
    for (int regime = 0; regime < BR_TIP_REGIMES; regime++)
        put_steps(d, w->friction, br_tip_regime_word((enum br_tip_regime)regime),
                  w->regime_steps[regime], w->steps);
    put_event_list(d, w);
    put_switches(d, r);
}

/* ---- energies ---- */

/* People see that of the end. */
static void put_state(struct br_document *d, const struct br_run_report *r, const char *when,
                      bool people, const struct br_energy *e)
{
    const struct {
        const char *key, *label;
        const double *x;
    } rows[] = {{"kinetic", "kinetic", e->kinetic}, {"stored", "stored", e->stored}};
    for (size_t i = 0; i < 2; i++) {
        char key[KEY];
        snprintf(key, sizeof key, "energies.%s.%s", when, rows[i].key);
        put_two(d, r, rows[i].x, people ? rows[i].label : NULL, "J", key);
    }
    put(d, if_known(r->marched.contact.modelled, br_number(e->contact)),
        people ? "of the contact" : NULL, "J", "energies.%s.contact", when);
    put(d, br_number(br_energy_total(e)), people ? "total" : "total at t = 0", "J",
        "energies.%s.total", when);
}

static void put_added(struct br_document *d, const struct br_run_report *r)
{
    const struct br_work *w = &r->work;
    const double all[] = {br_energy_added(w, BR_AXIAL), br_energy_added(w, BR_BENDING)};
    const double put_in[] = {br_energy_put_in(&r->energy_start, w, BR_AXIAL),
                             br_energy_put_in(&r->energy_start, w, BR_BENDING)};
    const double steps[] = {(double)w->gaining[BR_AXIAL], (double)w->gaining[BR_BENDING]};
    const bool any = steps[BR_AXIAL] + steps[BR_BENDING] > 0;
    put_two(d, r, all, NULL, "J", "energies.added_by_scheme.in_all");
    put_two(d, r, put_in, NULL, "J", "energies.added_by_scheme.put_in");
    put_two(d, r, steps, any ? "steps in which the scheme added" : NULL, NULL,
            "energies.added_by_scheme.steps_that_add");
    put_two(d, r, w->gained, any ? "  added in these" : NULL, "J",
            "energies.added_by_scheme.by_these_steps");
}

static void put_works(struct br_document *d, const struct br_run_report *r)
{
    const struct br_work *w = &r->work;
    put_two(d, r, w->loads, "work of the loads", "J", "energies.work_of_loads");
    put_two(d, r, w->viscous, "lost to viscosity", "J", "energies.lost_to_viscosity");
    put_two(d, r, w->scheme, "lost to the scheme", "J", "energies.lost_to_scheme");
    put(d, if_known(r->marched.contact.modelled, br_number(w->scheme_contact)),
        "  and by its contact", "J", "energies.lost_to_scheme_by_contact");
    put(d, br_number(br_energy_imbalance(&r->energy_start, &r->energy_now, w)),
        "missing in the balance, of the terms' sum", NULL, "energies.imbalance");
    put(d, br_number(r->energy_worst), "  in one step at most", NULL,
        "energies.largest_imbalance_of_a_step");
    put_added(d, r);
}

static void put_energies(struct br_document *d, const struct br_run_report *r)
{
    br_put_section(d, "Energies");
    put_state(d, r, "start", false, &r->energy_start);
    if (r->at_end)
        put_state(d, r, "end", true, &r->energy_now);
    else
        put(d, br_nothing(), NULL, NULL, "energies.end");
    put(d,
        if_known(has_friction(r), br_number(r->summed ? r->work.friction : r->watch.friction_work)),
        "lost to friction", "J", "energies.lost_to_friction");
    put(d, br_truth(r->summed), r->summed ? NULL : "works, losses, balance", NULL,
        "energies.summed");
    br_put_shown(d, "not summed, they need the fields of every step: --energies or --check");
    if (r->summed)
        put_works(d, r);
}

/* ---- the certificate ---- */

/* By code that the solver does not share; by stages where the scheme has some. */
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
        put(d, br_nothing(), NULL, NULL, "certificate");
        return;
    }
    br_put_section(d, r->method.scheme == br_time_schemes[0]
                          ? "Certificate of every step: the worst"
                          : "Certificate of every step, stage by stage: the worst");
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        put(d, br_number(rows[i].worst), rows[i].modelled ? rows[i].name : NULL, NULL,
            "certificate.worst.%s", rows[i].key);
        if (isfinite(rows[i].limit))
            br_put_shown(d, "%.3g of at most %.3g: %s", rows[i].worst, rows[i].limit,
                         rows[i].worst <= rows[i].limit ? "good" : "BAD");
        else
            br_put_shown(d, "%.3g: not judged, round-off alone may be more", rows[i].worst);
        put(d, br_number(rows[i].limit), NULL, NULL, "certificate.limits.%s", rows[i].key);
    }
    put(d, br_count(r->bad_steps), "steps beyond a limit", NULL, "certificate.bad_steps");
    put(d, br_text(r->bad_steps ? r->verdict.message : NULL), NULL, NULL, "certificate.first");
}

/* ---- what is modelled, and what it costs ---- */

static void put_model(struct br_document *d, const struct br_run_report *r)
{
    static const struct br_column columns[] = {
        {.key = "part"}, {.key = "modelled"}, {.key = "why", .heading = "how, or why not"}};
    br_put_table(d, "model", "What is modelled, and what is skipped", 0, BR_COLUMNS(columns));
    for (size_t i = 0; i < r->model_rows; i++) {
        br_put_row(d);
        br_put(d, "part", br_text(r->model[i].key));
        br_put_shown(d, "%s", r->model[i].part);
        br_put(d, "modelled", br_truth(r->model[i].modelled));
        br_put_shown(d, "%s", r->model[i].modelled ? "modelled" : "skipped");
        br_put(d, "why", br_text(r->model[i].why));
    }
}

static void put_cost(struct br_document *d, const struct br_run_report *r)
{
    static const struct br_column columns[] = {
        {.key = "part"},
        {.key = "ns_per_step", .heading = "a step", .unit = "ns", .format = "%.1f"},
        {.key = "ns_per_element_step", .heading = "an element", .unit = "ns", .format = "%.4f"},
        {.key = "share", .unit = "%", .format = "%.1f"},
    };
    const double steps = (double)r->end.last.step;
    double all = 0;
    if (!r->explained || steps == 0)
        return;
    for (int part = 0; part < BR_COST_PARTS; part++)
        all += r->cost.seconds[part];
    br_put_table(d, "cost", "Cost of the parts of a step, as measured", 0, BR_COLUMNS(columns));
    for (int part = 0; part < BR_COST_PARTS; part++) {
        const double ns = 1e9 * r->cost.seconds[part] / steps;
        if (r->cost.laps[part] == 0)
            continue;
        br_put_row(d);
        br_put(d, "part", br_text(br_cost_part_text((enum br_cost_part)part)));
        br_put(d, "ns_per_step", br_number(ns));
        br_put(d, "ns_per_element_step", br_number(ns / (double)r->n));
        br_put(d, "share", br_number(100 * r->cost.seconds[part] / all));
    }
    put(d, br_number(1e9 * all / steps), "sum of the parts of a step", "ns", "cost.ns_per_step");
    put(d, br_number(1e9 * r->cost.lap_seconds), "a reading of the clock, which is taken off", "ns",
        "cost.ns_per_reading");
}

static void put_time(struct br_document *d, const struct br_run_findings *f)
{
    const struct br_run_report *r = f->report;
    const double a_step = r->end.march_seconds / (double)r->end.last.step; /* NAN: none */
    const bool iterates = r->method.friction->iterates && has_friction(r);
    br_put_section(d, "Time and work");
    put(d, br_number(f->wall_seconds), "time", "s", "seconds.wall");
    put(d, br_number(r->end.set_up_seconds), "  of setting up", "s", "seconds.set_up");
    put(d, br_number(r->end.march_seconds),
        r->checked  ? "  of the march, the check included"
        : r->summed ? "  of the march, the energies included"
                    : "  of the march",
        "s", "seconds.march");
    put(d, br_number(a_step), "  a step", "s", "seconds.per_step");
    put(d, br_number(a_step / (double)r->n), "  an element-step", "s", "seconds.per_element_step");
    put(d, br_count(r->counts.steps), "steps of the scheme", NULL, "work.steps");
    put(d, br_count(r->counts.rejected), r->method.scheme->adaptive ? "  taken back" : NULL, NULL,
        "work.steps_taken_back");
    put(d, br_count(r->counts.stages), "solves a field", NULL, "work.solves_a_field");
    put(d, br_count(r->counts.set_ups), r->counts.set_ups ? "changes of the step" : NULL, NULL,
        "work.changes_of_the_step");
    put(d, br_count(r->counts.iterations), iterates ? "friction iterations" : NULL, NULL,
        "work.friction_iterations");
}

void br_report_run(const struct br_run_findings *f, struct br_document *d)
{
    br_document_begin(d, "summary", "beamrate run", 2, f->report->scene->title);
    put_answers(d, f);
    put_march(d, f);
    put_warnings(d, f->warnings);
    put_prediction(d, f);
    put_tip(d, f);
    put_events(d, f->report);
    put_energies(d, f->report);
    put_certificate(d, f->report);
    put_model(d, f->report);
    put_cost(d, f->report);
    put_time(d, f);
    br_put_provenance(d, f->provenance);
}
