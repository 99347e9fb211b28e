/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <string.h>

#include "solver/scene.h"
#include "study/scene/method_fields.h"
#include "study/trade/plan.h"
#include "tables/report_parts.h"

static double error_of(const struct br_plan *p, size_t i)
{
    return br_trial_bound(&p->trial[i]);
}

static void answer_chosen(struct br_document *d, const struct br_plan *p)
{
    char text[BR_TRIAL_TEXT];
    const struct br_trial *t = &p->trial[p->chosen];
    br_put_answer(d, "Take %s: error %.3e, CPU %.3g s, %zu steps.",
                  br_trial_text(p->request.scene, t, text), br_trial_bound(t), p->seconds(t),
                  t->cost.counts.steps);
}

static void answer_missed(struct br_document *d, const struct br_plan *p)
{
    char trial[BR_TRIAL_TEXT];
    size_t best = p->count;
    if (isfinite(p->goal.error))
        br_put_answer(d,
                      "Missed: no trial has a relative error of %g within the time limit of %g s "
                      "for a march.",
                      p->goal.error, p->request.time_limit);
    else
        br_put_answer(d, "Missed: no trial takes at most %g CPU s.", p->goal.seconds);
    for (size_t i = 0; i < p->count; i++)
        if (isfinite(error_of(p, i)) && (best == p->count || error_of(p, i) < error_of(p, best)))
            best = i;
    if (best < p->count)
        br_put_answer(d, "Most accurate: %s. Error %.3e, CPU %.3g s.",
                      br_trial_text(p->request.scene, &p->trial[best], trial), error_of(p, best),
                      p->seconds(&p->trial[best]));
}

/* Command lines that repeat the chosen trial: its march, and its error and seconds. */
static void put_commands(struct br_document *d, const struct br_plan *p, const char *words)
{
    enum { LONGEST = 1024 };
    if (p->chosen == p->count || strlen(words) > LONGEST)
        return;
    const struct br_trial *t = &p->trial[p->chosen];
    const struct br_method method = br_trial_method(t);
    const bool usual = p->request.norm == br_norms[0];
    char options[BR_METHOD_TEXT], step[64], line[2 * LONGEST];
    snprintf(line, sizeof line, "beamrate run %s --n %zu --k T/%zu%s", words, t->at.n, t->at.steps,
             br_method_options(p->request.scene, &method, options));
    br_put_command(d, "run", "To march it", line);
    if (t->named->method.scheme->adaptive)
        snprintf(step, sizeof step, "--tolerance %.15g", t->tolerance);
    else
        snprintf(step, sizeof step, "--k T/%zu", t->at.steps);
    snprintf(line, sizeof line, "beamrate trade %s --methods %s --n %zu %s%s%s", words,
             t->named->name, t->at.n, step, usual ? "" : " --norm ",
             usual ? "" : p->request.norm->name);
    br_put_command(d, "trade", "To measure it again", line);
}

/* The place of a trial in the search. */
static const char *part_of(const struct br_plan *p, size_t i)
{
    return i == p->chosen ? "chosen" : i < p->grid ? "grid" : "around the best";
}

/* All trials, or for people those of the methods' front: no other trial of the same method is both
 * cheaper and more accurate. */
static void put_trials(struct br_document *d, const struct br_plan *p)
{
    br_put_table(d, "trials", "All trials", BR_FOR_PROGRAMS | BR_MAIN);
    for (size_t i = 0; i < p->count; i++) {
        const struct br_trial *t = &p->trial[i];
        const struct br_counts *c = &t->cost.counts;
        br_put_row(d);
        BR_PUT(d, br_text(part_of(p, i)), .key = "part");
        br_put_trial(d, p->request.scene, t);
        BR_PUT(d, br_number(error_of(p, i)), .key = "relative_error");
        BR_PUT(d, br_number(p->seconds(t)), .key = "seconds", .unit = "s");
        BR_PUT(d, br_count(c->steps), .key = "steps");
        BR_PUT(d, br_count(c->stages), .key = "solves");
        BR_PUT(d, br_count(c->set_ups), .key = "set_ups");
        BR_PUT(d, br_text(br_trial_end_names[t->end]), .key = "end");
        BR_PUT(d, br_truth(i == p->chosen), .key = "chosen");
        BR_PUT(d, br_failure_text(&t->failure), .key = "failure");
    }
}

/* What is nearest to the goal: for a goal of error the cheapest trial of each method that meets it,
 * for one of seconds the most accurate one. */
static void put_methods(struct br_document *d, const struct br_plan *p)
{
    const bool by_error = isfinite(p->goal.error);
    br_put_table(d, "methods", "The best of each method", BR_FOR_PEOPLE);
    for (size_t m = 0; m < p->methods.count; m++) {
        size_t best = p->count;
        for (size_t i = 0; i < p->count; i++) {
            const struct br_trial *t = &p->trial[i];
            const bool met = by_error
                                 ? error_of(p, i) <= p->goal.error
                                 : p->seconds(t) <= p->goal.seconds && isfinite(error_of(p, i));
            if (t->named == &p->methods.list[m] && met &&
                (best == p->count || (by_error ? p->seconds(t) < p->seconds(&p->trial[best])
                                               : error_of(p, i) < error_of(p, best))))
                best = i;
        }
        if (p->chosen < p->count && p->trial[p->chosen].named == &p->methods.list[m])
            best = p->chosen;
        if (best == p->count)
            continue;
        const struct br_trial *t = &p->trial[best];
        br_put_row(d);
        br_put_trial(d, p->request.scene, t);
        BR_PUT(d, br_number(error_of(p, best)), .key = "relative_error",
               .heading = "relative error", .format = "%.3e");
        BR_PUT(d, br_number(p->seconds(t)), .key = "seconds", .heading = "CPU", .unit = "s",
               .format = "%.3g");
        BR_PUT(d, br_count(t->cost.counts.steps), .key = "steps");
        BR_PUT(d, br_text(best == p->chosen ? "chosen" : NULL), .key = "remark");
    }
}

void br_report_plan(const struct br_plan *p, const char *words,
                    const struct br_provenance *provenance, struct br_document *d)
{
    const struct br_scene *scene = p->request.scene;
    char name[512], caption[512];
    snprintf(name, sizeof name, "%.500s-plan", scene->name);
    snprintf(caption, sizeof caption, "A plan: %.400s", scene->title);
    br_document_begin(d, name, "beamrate plan", 2, caption);

    const bool met = p->chosen < p->count;
    if (!met)
        answer_missed(d, p);
    else if (!isfinite(p->goal.error))
        br_put_answer(d, "Met: the least error that was found within %g CPU s.", p->goal.seconds);
    else
        br_put_answer(d, "Met: the achieved error is %.2g of the goal, a relative error of %g.",
                      error_of(p, p->chosen) / p->goal.error, p->goal.error);
    if (met)
        answer_chosen(d, p);
    size_t failed = 0;
    for (size_t i = 0; i < p->count; i++)
        failed += isfinite(error_of(p, i)) ? 0 : 1;
    br_put_answer(
        d,
        "The planning took %.3g s: %zu trials on a grid and %zu around the best (%zu failed), "
        "which take %.3g CPU s when marched once.",
        p->wall_seconds, p->grid, p->count - p->grid, failed, br_plan_spent(p));

    put_commands(d, p, words); /* first: a file has them below the answer */
    put_methods(d, p);
    put_trials(d, p);

    br_hide_fact(d, br_text(scene->name), NULL, "scene.name");
    br_hide_fact(d, br_number(p->goal.error), NULL, "goal_error");
    br_hide_fact(d, br_number(p->goal.seconds), NULL, "goal_seconds");
    br_hide_fact(d, br_text(p->request.norm->name), NULL, "norm");
    br_hide_fact(d, br_truth(met), NULL, "met");
    br_hide_fact(d, br_number(p->own), NULL, "own_error");
    br_hide_fact(d, br_if(p->chosen < p->count, br_count(p->chosen)), NULL, "chosen");
    br_hide_fact(d, br_number(br_plan_spent(p)), NULL, "marched_seconds");
    br_hide_fact(d, br_number(p->wall_seconds), NULL, "wall_seconds");

    br_put_section(d, "What is measured");
    br_put_note(d, "%s", p->request.norm->title);
    br_put_note(d,
                "Relative errors are divided by the norm of the solution; the reference's own "
                "error, %.1e, is added.",
                isfinite(p->own) ? p->own : 0.0);
    br_put_note(d, "The error of a run is the largest at its own time levels; the error between "
                   "them is not measured. A run has at least 10 steps, or 20 time levels if the "
                   "scheme chooses its steps.");
    br_put_note(d,
                "CPU: set-up and march, seconds of the processor in one thread, the least of up to "
                "%zu marches after a warm-up. On %s.",
                p->request.repeats, provenance->machine);

    br_put_provenance(d, provenance);
}
