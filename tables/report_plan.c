/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>

#include "study/scene/method_fields.h"
#include "study/scene/quote.h"
#include "study/trade/plan.h"
#include "tables/report_parts.h"

static double error_of(const struct br_plan *p, size_t i)
{
    return br_trial_bound(&p->trial[i]);
}

static void answer_trial(struct br_document *d, const struct br_plan *p, const char *what, size_t i)
{
    char trial[BR_TRIAL_TEXT];
    br_put_answer(
        d, "%s: %s. Error %.3e (predicted %.3e), CPU %.3g s (predicted %.3g s), %zu steps.", what,
        br_trial_text(p->request.scene, &p->trial[i], trial), error_of(p, i), p->forecast[i].error,
        p->seconds(&p->trial[i]), p->forecast[i].seconds, p->trial[i].cost.counts.steps);
}

static void answer_missed(struct br_document *d, const struct br_plan *p)
{
    char trial[BR_TRIAL_TEXT];
    size_t best = p->count;
    if (isfinite(p->goal.error))
        br_put_answer(d,
                      "Missed: nothing that was tried has a relative error of %g within the time "
                      "limit of %g s a march.",
                      p->goal.error, p->request.time_limit);
    else
        br_put_answer(d, "Missed: nothing that was tried takes at most %g CPU s.", p->goal.seconds);
    for (size_t i = 0; i < p->count; i++)
        if (isfinite(error_of(p, i)) && (best == p->count || error_of(p, i) < error_of(p, best)))
            best = i;
    if (best < p->count)
        br_put_answer(d, "Most accurate: %s. Error %.3e, CPU %.3g s.",
                      br_trial_text(p->request.scene, &p->trial[best], trial), error_of(p, best),
                      p->seconds(&p->trial[best]));
}

/* Command lines that repeat the chosen trial: its march, and its error and seconds. */
static void put_commands(struct br_document *d, const struct br_plan *p, const char *scene_word)
{
    if (p->chosen == p->count)
        return;
    const struct br_trial *t = &p->trial[p->chosen];
    const struct br_method method = br_trial_method(t);
    const bool usual = p->request.norm == br_norms[0];
    char scene[1024], options[BR_METHOD_TEXT], step[64], line[2048];
    br_quoted(scene, sizeof scene, &br_for_shell, scene_word);
    snprintf(line, sizeof line, "beamrate run %s --n %zu --k T/%zu%s", scene, t->at.n, t->at.steps,
             br_method_options(p->request.scene, &method, options));
    br_put_command(d, "run", "To march it", line);
    if (t->named->method.scheme->adaptive)
        snprintf(step, sizeof step, "--tolerances %.15g", t->tolerance);
    else
        snprintf(step, sizeof step, "--k T/%zu", t->at.steps);
    snprintf(line, sizeof line, "beamrate trade %s --methods %s --n %zu %s%s%s", scene,
             t->named->name, t->at.n, step, usual ? "" : " --norm ",
             usual ? "" : p->request.norm->name);
    br_put_command(d, "trade", "To measure it again", line);
}

static const char *remark_on(const struct br_plan *p, size_t i)
{
    if (p->trial[i].end != BR_TRIAL_DONE)
        return br_trial_end_names[p->trial[i].end];
    if (i == p->chosen)
        return i == p->first ? "first, chosen" : "chosen";
    return i == p->first ? "first" : NULL;
}

/* All trials, or only the proposed ones, which come after the cheap trials of round 0. */
static void put_trials(struct br_document *d, const struct br_plan *p, bool proposed)
{
    if (proposed)
        br_put_table(d, "proposals", "What was proposed", BR_FOR_PEOPLE);
    else
        br_put_table(d, "trials", "All trials", BR_FOR_PROGRAMS | BR_MAIN);
    for (size_t i = 0; i < p->count; i++) {
        const struct br_trial *t = &p->trial[i];
        const struct br_counts *c = &t->cost.counts;
        if (proposed && p->forecast[i].round == 0)
            continue;
        br_put_row(d);
        BR_PUT(d, br_count(p->forecast[i].round), .key = "round");
        br_put_trial(d, p->request.scene, t);
        BR_PUT(d, br_number(p->forecast[i].error), .key = "predicted_error",
               .heading = "predicted error", .format = "%.3e");
        BR_PUT(d, br_number(error_of(p, i)), .key = "relative_error", .heading = "relative error",
               .format = "%.3e");
        BR_PUT(d, br_number(p->forecast[i].seconds), .key = "predicted_seconds",
               .heading = "predicted CPU", .unit = "s", .format = "%.3g");
        BR_PUT(d, br_number(p->seconds(t)), .key = "seconds", .heading = "CPU", .unit = "s",
               .format = "%.3g");
        BR_PUT(d, br_count(c->steps), .key = "steps");
        br_hide(d, "solves", NULL, br_count(c->stages));
        br_hide(d, "set_ups", NULL, br_count(c->set_ups));
        br_hide(d, "end", NULL, br_text(br_trial_end_names[t->end]));
        br_hide(d, "chosen", NULL, br_truth(i == p->chosen));
        br_hide(d, "failure", NULL, br_failure_text(&t->failure));
        BR_PUT(d, br_text(remark_on(p, i)), .key = "remark", .flags = BR_FOR_PEOPLE);
    }
}

/* A root mean square of logarithms; the table for people has it in per cent. NaN: not known. */
static void put_scatter(struct br_document *d, const char *key, const char *heading, double scatter)
{
    BR_PUT(d, br_number(scatter), .key = key, .heading = heading);
    if (isfinite(scatter))
        br_put_shown(d, "%.2g %%", 100 * expm1(scatter));
}

void br_report_plan(const struct br_plan *p, const char *scene_word,
                    const struct br_provenance *provenance, struct br_document *d)
{
    const struct br_scene *scene = p->request.scene;
    char name[512], caption[512];
    snprintf(name, sizeof name, "%.500s-plan", scene->name);
    snprintf(caption, sizeof caption, "A plan: %.400s", scene->title);
    br_document_begin(d, name, "beamrate plan", 1, caption);

    const double share = p->chosen < p->count ? error_of(p, p->chosen) / p->goal.error : NAN;
    if (p->end == BR_PLAN_MISSED)
        answer_missed(d, p);
    else if (!isfinite(p->goal.error))
        br_put_answer(d, "Met: the least error that was found within %g CPU s.", p->goal.seconds);
    else if (p->end == BR_PLAN_MET)
        br_put_answer(d, "Met: the achieved error is %.2f of the goal, a relative error of %g.",
                      share, p->goal.error);
    else
        br_put_answer(d,
                      "Met, and better: the achieved error is %.2g of the goal, a relative error "
                      "of %g; %s.",
                      share, p->goal.error,
                      p->end == BR_PLAN_COARSEST
                          ? "the mesh is the coarsest, nothing costs less"
                          : "nothing nearer to the goal was found that costs as little");
    if (p->chosen < p->count)
        answer_trial(d, p, "Proposal", p->chosen);
    if (p->first < p->count && p->first != p->chosen)
        answer_trial(d, p, "First proposal, by the cheap trials alone", p->first);

    size_t cheap = 0, failed = 0;
    for (size_t i = 0; i < p->count; i++) {
        cheap += p->forecast[i].round == 0;
        failed += isfinite(error_of(p, i)) ? 0 : 1;
    }
    br_put_answer(
        d,
        "The planning took %.3g s: %zu cheap trials and %zu proposal%s (%zu failed), which "
        "take %.3g CPU s when marched once.",
        p->wall_seconds, cheap, p->count - cheap, p->count - cheap == 1 ? "" : "s", failed,
        br_plan_spent(p));

    put_commands(d, p, scene_word); /* first: a file has them below the answer */
    put_trials(d, p, true);

    br_put_table(d, "models", "How far the models are off (root mean square over the trials)", 0);
    for (size_t i = 0; i < p->methods.count; i++) {
        const struct br_plan_model *m = &p->model[i];
        const double *c = m->cost;
        br_put_row(d);
        BR_PUT(d, br_text(p->methods.list[i].name), .key = "method");
        BR_PUT(d, br_count(m->points), .key = "trials");
        br_put_blank(d, !m->known);
        BR_PUT(d, br_number(m->r), .key = "r", .format = "%.2f");
        put_scatter(d, "error_scatter", "error", m->scatter[BR_PLAN_ERROR]);
        put_scatter(d, "cost_scatter", "CPU", m->scatter[BR_PLAN_SECONDS]);
        br_hide(d, "seconds_set_up", "s", br_number(c[0]));
        br_hide(d, "seconds_element", "s", br_number(c[1]));
        BR_PUT(d, br_number(c[2]), .key = "seconds_solve", .heading = "a solve", .unit = "s",
               .format = "%.3g");
        BR_PUT(d, br_number(c[3]), .key = "seconds_element_solve",
               .heading = "an element and solve", .unit = "s", .format = "%.3g");
    }

    put_trials(d, p, false);

    /* Logarithms: of n, steps or 1/tolerance; and of an error or solves. */
    static const struct br_column curves_columns[] = {
        {.key = "method"}, {.key = "curve"}, {.key = "at"}, {.key = "value"}};
    static const char *const names[] = {"log_space_error", "log_time_error", "log_solves"};
    BR_TABLE(d, "curves", "Knots of the models", BR_FOR_PROGRAMS, curves_columns);
    for (size_t i = 0; i < p->methods.count; i++) {
        const struct br_plan_model *m = &p->model[i];
        const struct br_plan_curve *const curves[] = {&m->component[BR_PLAN_X],
                                                      &m->component[BR_PLAN_Y], &m->solves};
        for (size_t c = 0; c < 3 && m->known; c++)
            for (size_t j = 0; j < curves[c]->count; j++)
                BR_PUT_ROW(d, br_text(p->methods.list[i].name), br_text(names[c]),
                           br_number(curves[c]->at[j]), br_number(curves[c]->value[j]));
    }

    const struct br_plan_components components = br_plan_chosen_components(p);
    br_hide_fact(d, br_text(scene->name), NULL, "scene.name");
    br_hide_fact(d, br_number(p->goal.error), NULL, "goal_error");
    br_hide_fact(d, br_number(p->goal.seconds), NULL, "goal_seconds");
    br_hide_fact(d, br_text(p->request.norm->name), NULL, "norm");
    br_hide_fact(d, br_text(br_plan_end_names[p->end]), NULL, "end");
    br_hide_fact(d, br_number(p->own), NULL, "own_error");
    br_hide_fact(d, br_count(p->rounds), NULL, "rounds");
    br_hide_fact(d, br_if(p->first < p->count, br_count(p->first)), NULL, "first");
    br_hide_fact(d, br_if(p->chosen < p->count, br_count(p->chosen)), NULL, "chosen");
    br_hide_fact(d, br_number(br_plan_spent(p)), NULL, "marched_seconds");
    br_hide_fact(d, br_number(p->wall_seconds), NULL, "wall_seconds");
    br_hide_fact(d, br_number(components.error[BR_PLAN_X]), NULL, "space_error");
    br_hide_fact(d, br_number(components.error[BR_PLAN_Y]), NULL, "time_error");
    br_hide_fact(d, br_number(components.order[BR_PLAN_X]), NULL, "space_order");
    br_hide_fact(d, br_number(components.order[BR_PLAN_Y]), NULL, "time_order");

    br_put_section(d, "What is measured");
    if (isfinite(components.error[BR_PLAN_X]))
        br_put_note(
            d,
            "By the model, the proposal has a space error of %.2e and a time error of %.2e, "
            "both relative. The observed order in h is %.2f, in %s it is %.2f.",
            components.error[BR_PLAN_X], components.error[BR_PLAN_Y], components.order[BR_PLAN_X],
            p->trial[p->chosen].named->method.scheme->adaptive ? "the tolerance" : "k",
            components.order[BR_PLAN_Y]);
    br_put_note(d, "%s", p->request.norm->title);
    br_put_note(d,
                "Relative errors are over the norm of the solution; the judge's own error, %.1e, "
                "is added.",
                isfinite(p->own) ? p->own : 0.0);
    br_put_note(d, "An error is the largest at a run's own time levels: nobody asks long steps "
                   "about what happens between them. There are at least 10 steps, and 20 levels "
                   "where the scheme chooses its steps.");
    br_put_note(d,
                "CPU: set-up and march, seconds of the processor in one thread, the least of up to "
                "%zu marches after a warm-up. On %s.",
                p->request.repeats, provenance->machine);

    br_put_provenance(d, provenance);
}
