/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A run's summary for a person. */
#include <math.h>
#include <string.h>

#include "study/scene/method_fields.h"
#include "study/scene/quote.h"
#include "tables/run_page.h"

enum { SHOWN_EVENTS = 20 };

static const char *direction(int sign)
{
    return sign > 0 ? " towards +w" : sign < 0 ? " towards -w" : "";
}

static void head(FILE *out, const struct br_run_page *page)
{
    const struct br_run_report *p = page->report;
    char method[BR_METHOD_TEXT];
    br_quote(out, &br_for_text, p->scene->title);
    fprintf(out, "\n");
    br_quote(out, &br_for_text, page->provenance->scene_path);
    fprintf(out, "\n%zu elements, h = %g m; %zu steps of k = %g s\n%s\n", p->n, p->h, p->steps,
            p->k, br_method_text(&p->marched, &p->method, method));
    if (p->failure.status) {
        fprintf(out, "\nSTOPPED: ");
        br_quote(out, &br_for_text, p->failure.message);
        fprintf(out, "\n");
    }
    if (p->contact_unstable)
        fprintf(out, "\nThe lagged contact is beyond its stability limit here: the tip may chatter "
                     "at the step's rate.\n--contact implicit has no such limit.\n");
}

/* ---- what was expected ---- */

static void discretisation(FILE *out, const struct br_prediction *p)
{
    fprintf(out, "  discretisation error  ");
    if (p->known)
        fprintf(out, "%.1e, between %.1e and %.1e: time %.1e, space %.1e\n", p->whole.error,
                p->whole.low, p->whole.high, p->time.error, p->space.error);
    else if (p->bounded)
        fprintf(out, "not known, between %.0e and %.0e: ", p->whole.low, p->whole.high);
    else
        fprintf(out, "not known: ");
    if (!p->known) {
        br_quote(out, &br_for_text, p->why);
        fputc('\n', out);
    }
}

/* Each field's own, where there are two. */
static void fields(FILE *out, const struct br_run_page *page)
{
    static const char *const names[2] = {"axial", "bending"};
    const struct br_prediction *p = page->prediction;
    const struct br_scene *s = &page->report->marched;
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        if (p->known && s->axial.modelled && s->bending.modelled)
            fprintf(out, "    %-7s             %.1e, between %.1e and %.1e\n", names[kind],
                    p->field[kind].error, p->field[kind].low, p->field[kind].high);
}

static void expected(FILE *out, const struct br_run_page *page)
{
    fprintf(out, "\nPredicted before the march, of each field relative to its largest (L2)\n");
    discretisation(out, page->prediction);
    fields(out, page);
    fprintf(out, "  round-off             %.1e\n", page->prediction->round_off);
    for (size_t i = 0; i < page->warnings->count; i++) {
        const struct br_warning *w = &page->warnings->list[i];
        fprintf(out, "  Warning: %s%s\n", w->text, w->remedy[0] ? "; remedy:" : "");
        for (const char *line = w->remedy; *line;
             line += strcspn(line, "\n"), line += *line == '\n')
            fprintf(out, "    %.*s\n", (int)strcspn(line, "\n"), line);
    }
}

/* ---- the tip ---- */

static void value(FILE *out, bool marched, double x)
{
    if (marched)
        fprintf(out, "  %22.15g", x);
    else
        fprintf(out, "  %22s", "not marched");
}

static void friction_now(FILE *out, const struct br_run_report *p)
{
    const struct br_history_row *row = &p->end.last;
    if (p->marched.friction.law == BR_FRICTIONLESS)
        return;
    fprintf(out, "  friction force, N     %22.15g  of a bound of %.15g", row->friction_force,
            row->friction_bound);
    if (row->friction_bound > 0)
        fprintf(out, " (%.4g %%)", 100 * fabs(row->friction_force) / row->friction_bound);
    if (p->watch.steps > 0)
        fprintf(out, ": %s%s", br_tip_regime_word(p->watch.regime),
                p->watch.regime == BR_TIP_SLIP ? direction(p->watch.direction) : "");
    fprintf(out, "\n");
}

static void tip(FILE *out, const struct br_run_report *p)
{
    const struct br_history_row *row = &p->end.last;
    const bool axial = p->marched.axial.modelled, bending = p->marched.bending.modelled;
    fprintf(out, "\nTip at t = %.15g s%s\n", row->time,
            p->failure.status ? " (the last good step)" : "");
    fprintf(out, "                          %20s  %22s\n", "axial, u", "bending, w");
    fprintf(out, "  displacement, m     ");
    value(out, axial, row->displacement[BR_AXIAL]);
    value(out, bending, row->displacement[BR_BENDING]);
    fprintf(out, "\n  velocity, m/s       ");
    value(out, axial, row->velocity[BR_AXIAL]);
    value(out, bending, row->velocity[BR_BENDING]);
    fprintf(out, "\n");
    if (p->marched.contact.modelled)
        fprintf(out, "  contact force, N      %22.15g  %s\n", row->contact_force,
                p->watch.closed ? "closed" : "open");
    friction_now(out, p);
    if (p->marched.contact.modelled)
        fprintf(out, "  largest contact force  %.10g N at t = %.10g s\n",
                p->watch.contact_force.value, p->watch.contact_force.time);
    if (p->marched.friction.law != BR_FRICTIONLESS)
        fprintf(out, "  largest friction force %.10g N at t = %.10g s\n",
                p->watch.friction_force.value, p->watch.friction_force.time);
}

/* ---- events ---- */

static void at_start(FILE *out, const struct br_tip_watch *w)
{
    fprintf(out, "  at first              %s%s",
            w->contact ? w->closed_at_start ? "closed" : "open" : "",
            w->contact && w->friction ? ", " : "");
    if (w->friction && w->steps > 0)
        fprintf(out, "%s%s in the first step", br_tip_regime_word(w->regime_at_start),
                direction(w->direction_at_start));
    fprintf(out, "\n");
}

static void shares(FILE *out, const struct br_tip_watch *w)
{
    const double percent = w->steps ? 100 / (double)w->steps : 0;
    fprintf(out, "  of the time:");
    if (w->contact)
        fprintf(out, " closed %.4g %%%s", percent * (double)w->closed_steps,
                w->friction ? "," : "");
    if (w->friction)
        fprintf(out, " stick %.4g %%, slip %.4g %%, no bound %.4g %%",
                percent * (double)w->regime_steps[BR_TIP_STICK],
                percent * (double)w->regime_steps[BR_TIP_SLIP],
                percent * (double)w->regime_steps[BR_TIP_FREE]);
    fprintf(out, "\n");
}

static const char *regime(enum br_regime r)
{
    return r == BR_REGIME_NONE ? "no bound" : br_regime_name(r);
}

/* What the scheme has found within its steps. */
static void switches(FILE *out, const struct br_run_report *p)
{
    if (!p->method.scheme->adaptive)
        return;
    fprintf(out, "\nSwitches, as scheme %s has found them: %zu\n", p->method.scheme->name,
            p->switches);
    for (size_t i = 0; i < p->switches && i < SHOWN_EVENTS; i++) {
        const struct br_switch *s = &p->switched[i];
        fprintf(out, "  t = %-16.12g  %s: %s -> %s\n", s->time,
                s->kind == BR_AXIAL ? "contact " : "friction", regime(s->from), regime(s->to));
    }
    if (p->switches > SHOWN_EVENTS)
        fprintf(out, "  ... and %zu more\n", p->switches - SHOWN_EVENTS);
}

static void events(FILE *out, const struct br_run_report *p)
{
    const struct br_tip_watch *w = &p->watch;
    if (!w->contact && !w->friction)
        return;
    switches(out, p);
    fprintf(out,
            "\nEvents at the tip (told at the first time level of the new regime: each happened in "
            "the step\nbefore it, up to k = %g s earlier)\n",
            p->k);
    at_start(out, w);
    size_t all = 0;
    for (int kind = 0; kind < BR_TIP_EVENTS; kind++)
        all += w->count[kind];
    for (size_t i = 0; i < w->events && i < SHOWN_EVENTS; i++)
        fprintf(out, "  t = %-16.10g  %s%s\n", w->event[i].time,
                br_tip_event_word(w->event[i].kind), direction(w->event[i].direction));
    if (all > SHOWN_EVENTS)
        fprintf(out, "  ... and %zu more\n", all - SHOWN_EVENTS);
    fprintf(out, "  in all:");
    for (int kind = 0; kind < BR_TIP_EVENTS; kind++)
        fprintf(out, "%s %s %zu", kind ? "," : "", br_tip_event_word((enum br_tip_event_kind)kind),
                w->count[kind]);
    fprintf(out, "\n");
    shares(out, w);
}

/* ---- energies ---- */

static void two(FILE *out, const struct br_run_report *p, const char *name, const double x[2])
{
    fprintf(out, "  %-20s", name);
    value(out, p->marched.axial.modelled, x[BR_AXIAL]);
    value(out, p->marched.bending.modelled, x[BR_BENDING]);
    fprintf(out, "\n");
}

static void one(FILE *out, const char *name, double x)
{
    fprintf(out, "  %-20s  %22.15g\n", name, x);
}

/* What a scheme adds, in all or in single steps. */
static void gain(FILE *out, const struct br_run_report *p, enum br_field_kind kind)
{
    const struct br_work *w = &p->work;
    const char *field = kind == BR_AXIAL ? "axial" : "bending";
    const double added = br_energy_added(w, kind),
                 put_in = br_energy_put_in(&p->energy_start, w, kind);
    if (added > 0) {
        fprintf(out, "  The scheme ADDED %.3g J to the %s field", added, field);
        if (put_in > 0)
            fprintf(out, " (%.2g %% of what was there at first and of the loads' work)",
                    100 * added / put_in);
        fprintf(out, ".\n");
        if (kind == BR_AXIAL && w->scheme_contact < 0 && !p->method.contact->at_new_step)
            fprintf(out, "  It is the lagged contact's: --contact implicit adds none.\n");
    }
    if (w->gaining[kind])
        fprintf(out, "  In %zu of its %zu steps it added to the %s field, %.3g J in all%s.\n",
                w->gaining[kind], w->steps[kind], field, w->gained[kind],
                added > 0 ? "" : "; others took more");
}

static void works(FILE *out, const struct br_run_report *p)
{
    const struct br_work *w = &p->work;
    two(out, p, "work of the loads", w->loads);
    two(out, p, "lost to viscosity", w->viscous);
    if (p->marched.friction.law != BR_FRICTIONLESS)
        one(out, "lost to friction", w->friction);
    two(out, p, "lost to the scheme", w->scheme);
    if (w->remainder) {
        fprintf(out, "  The works are sums by the trapezoidal rule; what is lost to the scheme is "
                     "what they leave of the\n  balance, that rule's error included.\n");
        return;
    }
    if (p->marched.contact.modelled)
        one(out, "  and by its contact", w->scheme_contact);
    fprintf(out,
            "  balance: from %.15g at t = 0 to %.15g; what is missing is %.2g of the terms' sum,\n"
            "  in one step at most %.2g\n",
            br_energy_total(&p->energy_start), br_energy_total(&p->energy_now),
            fabs(br_energy_imbalance(&p->energy_start, &p->energy_now, w)), p->energy_worst);
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        gain(out, p, (enum br_field_kind)kind);
}

static void energies(FILE *out, const struct br_run_report *p)
{
    if (!p->at_end)
        return;
    fprintf(out, "\nEnergies at t = %.15g s, J\n", p->end.last.time);
    fprintf(out, "                          %20s  %22s\n", "axial", "bending");
    two(out, p, "kinetic", p->energy_now.kinetic);
    two(out, p, "stored", p->energy_now.stored);
    if (p->marched.contact.modelled)
        one(out, "of the contact", p->energy_now.contact);
    if (p->summed) {
        works(out, p);
        return;
    }
    if (p->marched.friction.law != BR_FRICTIONLESS)
        one(out, "lost to friction", p->watch.friction_work);
    fprintf(out, "  work of the loads, losses to viscosity and to the scheme, and the balance need "
                 "the fields\n  of every step: --energies or --check sums them\n");
}

/* ---- the certificate ---- */

static void certificate(FILE *out, const struct br_run_report *p)
{
    if (!p->checked)
        return;
    const struct br_certificate *c = &p->worst, *limit = &p->limits;
    const struct {
        const char *name;
        double worst, limit;
        bool modelled;
    } rows[] = {
        {"axial equation (27)", c->axial_residual, limit->axial_residual,
         p->marched.axial.modelled},
        {"bending equation (28)", c->bending_residual, limit->bending_residual,
         p->marched.bending.modelled},
        {"update of the state", c->update, limit->update, true},
        {"contact law (10)", c->contact, limit->contact, p->marched.contact.modelled},
        {"friction law (12)", c->friction, limit->friction,
         p->marched.friction.law != BR_FRICTIONLESS},
        {"energy balance", p->energy_worst, p->energy_limit, isfinite(p->energy_limit)},
    };
    fprintf(out,
            "\nCertificate of every step%s, by code that the solver does not share: the worst, "
            "and its limit\n",
            p->method.scheme == br_time_schemes[0] ? "" : ", stage by stage");
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        if (rows[i].modelled)
            fprintf(out, "  %-30s %10.3g  %10.3g  %s\n", rows[i].name, rows[i].worst, rows[i].limit,
                    rows[i].worst <= rows[i].limit ? "good" : "BAD");
    if (p->bad_steps)
        fprintf(out, "  %zu of %zu steps are beyond a limit; the first: %s\n", p->bad_steps,
                p->end.last.step, p->verdict.message);
}

/* ---- what is modelled, and what it costs ---- */

static void model(FILE *out, const struct br_run_report *p)
{
    fprintf(out, "\nWhat is modelled, and what is skipped\n");
    for (size_t i = 0; i < p->model_rows; i++)
        fprintf(out, "  %-18s  %-8s  %s\n", p->model[i].part,
                p->model[i].modelled ? "modelled" : "skipped", p->model[i].why);
}

static void cost(FILE *out, const struct br_run_report *p)
{
    const struct br_step_cost *c = &p->cost;
    const double steps = (double)p->end.last.step;
    if (!p->explained || steps == 0)
        return;
    double all = 0;
    for (int part = 0; part < BR_COST_PARTS; part++)
        all += c->seconds[part];
    fprintf(out,
            "\nCost of the parts of a step, as measured (a reading of the clock, %.0f ns, is "
            "taken off)\n  %-26s %12s %14s %8s\n",
            1e9 * c->lap_seconds, "", "ns a step", "ns an element", "share");
    for (int part = 0; part < BR_COST_PARTS; part++) {
        if (c->laps[part] == 0)
            continue;
        const double ns = 1e9 * c->seconds[part] / steps;
        fprintf(out, "  %-26s %12.1f %14.4f %6.1f %%\n", br_cost_part_text((enum br_cost_part)part),
                ns, ns / (double)p->n, all > 0 ? 100 * c->seconds[part] / all : 0);
    }
    fprintf(out, "  %-26s %12.1f %14.4f\n", "sum", 1e9 * all / steps,
            1e9 * all / steps / (double)p->n);
}

static void time_used(FILE *out, const struct br_run_page *page)
{
    const struct br_run_report *p = page->report;
    const double steps = (double)p->end.last.step;
    fprintf(out, "\nTime: %.3g s, of it %.3g s of setting up", page->wall_seconds,
            p->end.set_up_seconds);
    if (steps > 0)
        fprintf(out, " and %.4g us a step, %.4g ns an element-step%s",
                1e6 * p->end.march_seconds / steps,
                1e9 * p->end.march_seconds / steps / (double)p->n,
                p->checked  ? ", the check included"
                : p->summed ? ", the energies included"
                            : "");
    fprintf(out, "\nWork: %zu steps", p->counts.steps);
    if (p->method.scheme->adaptive)
        fprintf(out, " of the scheme's own and %zu taken back", p->counts.rejected);
    fprintf(out, ", %zu solves a field", p->counts.stages);
    if (p->counts.set_ups)
        fprintf(out, ", %zu changes of the step", p->counts.set_ups);
    if (p->method.friction->iterates && p->marched.friction.law != BR_FRICTIONLESS)
        fprintf(out, ", %zu friction iterations", p->counts.iterations);
    fprintf(out, "\n");
}

void br_run_text(FILE *out, const struct br_run_page *page)
{
    const struct br_run_report *p = page->report;
    head(out, page);
    expected(out, page);
    tip(out, p);
    events(out, p);
    energies(out, p);
    certificate(out, p);
    model(out, p);
    cost(out, p);
    if (p->scene->remark) {
        fprintf(out, "\nRemark: ");
        br_quote(out, &br_for_text, p->scene->remark);
        fprintf(out, "\n");
    }
    time_used(out, page);
}
