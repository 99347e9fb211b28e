/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "solver/scene.h"
#include "study/trade/trade.h"
#include "tables/beam/report_parts.h"

/* k, s; NaN where the scheme chooses its steps. */
static double step_of(const struct br_scene *scene, const struct br_trial *t)
{
    return t->named->method.scheme->adaptive ? (double)NAN : br_time_step(scene, t->at.steps);
}

/* Cells: method, n, steps_or_levels, k and tolerance; people see a tolerance instead of k. */
static void put_trial(struct br_document *d, const struct br_scene *scene, const struct br_trial *t)
{
    const bool adaptive = t->named->method.scheme->adaptive;
    BR_PUT(d, br_text(t->named->name), .key = "method");
    BR_PUT(d, br_count(t->at.n), .key = "n");
    char taken[BR_METHOD_TEXT];
    br_hide(d, "solver_taken", NULL,
            br_text(br_method_taken(&(struct br_meshes){scene, &t->at.n, 1}, &t->named->method,
                                    taken)));
    br_hide(d, "steps_or_levels", NULL, br_count(t->at.steps));
    br_hide(d, "tolerance", NULL, br_if(adaptive, br_number(t->tolerance)));
    BR_PUT(d, br_number(step_of(scene, t)), .key = "k", .unit = "s");
    if (adaptive)
        br_put_shown(d, "tol %.4g", t->tolerance);
}

/* "bdf2, n = 100, k = 0.01 s", or "adaptive, n = 100, tolerance 0.0001" */
static const char *trial_text(struct br_document *d, const struct br_scene *scene,
                              const struct br_trial *t)
{
    if (t->named->method.scheme->adaptive)
        return br_format(d, "%s, n = %zu, tolerance %.4g", t->named->name, t->at.n, t->tolerance);
    return br_format(d, "%s, n = %zu, k = %.6g s", t->named->name, t->at.n, step_of(scene, t));
}

/* "bdf2, n = 100, k = 0.01 s; 1.2e-05 CPU s, relative error 3.45e-04" */
static const char *describe(struct br_document *d, const struct br_trade *t, size_t i)
{
    return br_format(d, "%s; %.3g CPU s, relative error %.2e",
                     trial_text(d, t->request.scene, &t->trial[i]), br_trial_seconds(&t->trial[i]),
                     br_trial_relative(&t->trial[i]));
}

/* Errors that an answer names: 1e-3, 1e-6, 1e-9. */
static const size_t answered[] = {1, 4, 7};
enum { ANSWERED = sizeof answered / sizeof *answered };

static void answer_cheapest(struct br_document *d, const struct br_trade *t)
{
    for (size_t i = 0; i < ANSWERED; i++) {
        const size_t best = t->best[answered[i]];
        const double target = br_trade_target(answered[i]);
        if (best == t->count) {
            br_put_answer(d, "No trial has an error of %.0e or less.", target);
            return;
        }
        br_put_answer(d, "To an error of %.0e: %s.", target, describe(d, t, best));
    }
}

static void answer_front(struct br_document *d, const struct br_trade *t)
{
    const size_t fastest = br_work_next(t->point, t->count, t->count);
    size_t best = fastest;
    for (size_t i = best; i < t->count; i = br_work_next(t->point, t->count, i))
        best = i;
    if (best < t->count)
        br_put_answer(d, "Fastest%s: %s.", best == fastest ? " and most accurate" : "",
                      describe(d, t, fastest));
    if (best != fastest)
        br_put_answer(d, "Most accurate: %s.", describe(d, t, best));
}

/* The cost of the paper's method to the smallest target that it reaches. */
static void answer_paper(struct br_document *d, const struct br_trade *t)
{
    for (size_t c = 0; c < t->methods.count; c++) {
        const struct br_named_method *paper = &t->methods.list[c];
        size_t digit = BR_TRADE_DIGITS;
        if (!br_trade_is_printed_method(paper))
            continue;
        while (digit > 0 && t->best_of[c][digit - 1] == t->count)
            digit--;
        if (digit == 0) {
            br_put_answer(d, "The paper's method, %s, reaches none of these errors.", paper->name);
            return;
        }
        const double seconds = br_trial_seconds(&t->trial[t->best_of[c][digit - 1]]);
        const double least = br_trial_seconds(&t->trial[t->best[digit - 1]]);
        br_put_answer(d,
                      "The paper's method, %s, reaches %.0e in %.3g CPU s, %.3g times as much as "
                      "the cheapest.",
                      paper->name, br_trade_target(digit - 1), seconds, seconds / least);
        return;
    }
}

/* A trial and its results. */
static void put_outcome(struct br_document *d, const struct br_trade *t, size_t i)
{
    const struct br_trial *trial = &t->trial[i];
    const struct br_counts *c = &trial->cost.counts;
    const double *error = trial->error;
    const char *unit = t->request.norm->unit;
    put_trial(d, t->request.scene, trial);
    BR_PUT(d, br_number(br_trial_relative(trial)), .key = "relative_error",
           .heading = "relative error", .format = "%.2e");
    BR_PUT(d, br_number(error[BR_PART_TOTAL]), .key = "error", .unit = unit, .format = "%.3e");
    br_hide(d, "axial", unit, br_number(error[BR_PART_AXIAL]));
    br_hide(d, "bending", unit, br_number(error[BR_PART_BENDING]));
    br_hide(d, "own_error", unit, br_number(trial->own));
    br_hide(d, "scale", unit, br_number(trial->scale));
    BR_PUT(d, br_number(br_trial_seconds(trial)), .key = "seconds", .heading = "CPU", .unit = "s",
           .format = "%.3g");
    br_hide(d, "set_up", "s", br_number(trial->cost.set_up));
    br_hide(d, "march", "s", br_number(trial->cost.march));
    br_hide(d, "repeats", NULL, br_count(trial->cost.repeats));
    br_hide(d, "steps", NULL, br_count(c->steps));
    br_hide(d, "rejected", NULL, br_count(c->rejected));
    BR_PUT(d, br_count(c->stages), .key = "solves");
    BR_PUT(d, br_count(c->iterations), .key = "iterations");
    br_hide(d, "set_ups", NULL, br_count(c->set_ups));
    BR_PUT(d, br_number(br_trade_digits_per_second(trial)), .key = "digits_per_second",
           .heading = "digits/s", .format = "%.3g", .flags = BR_FILES_ONLY);
    br_hide(d, "end", NULL, br_text(br_trial_end_names[trial->end]));
    br_hide(d, "front", NULL, br_truth(t->point[i].front));
    br_hide(d, "printed", NULL, br_truth(trial->printed));
    br_hide(d, "failure", NULL, br_failure_text(&trial->failure));
}

/* A row for each target; without a trial that reaches it, all cells but the target are blank.
 * scene: the value of a column of scenes; NULL: no such column. */
static void put_targets(struct br_document *d, const struct br_trade *t, const char *scene)
{
    for (size_t digit = 0; digit < BR_TRADE_DIGITS; digit++) {
        const size_t best = t->best[digit];
        br_put_row(d);
        if (scene)
            BR_PUT(d, br_text(scene), .key = "scene");
        BR_PUT(d, br_number(br_trade_target(digit)), .key = "target", .heading = "to error",
               .format = "%.0e");
        br_put_blank(d, best == t->count);
        /* its index in the list of all trials, from 0 */
        br_hide(d, "trial", NULL, br_count(best));
        put_outcome(d, t, best < t->count ? best : 0);
    }
}

/* For people the Pareto front, for programs all trials. */
static void put_trials(struct br_document *d, const struct br_trade *t, bool front)
{
    if (front)
        br_put_table(d, "front", "Pareto front: no trial is better in error and in seconds",
                     BR_FOR_PEOPLE);
    else
        br_put_table(d, "trials", "All trials", BR_FOR_PROGRAMS | BR_MAIN);
    for (size_t i = front ? br_work_next(t->point, t->count, t->count) : 0; i < t->count;
         i = front ? br_work_next(t->point, t->count, i) : i + 1) {
        br_put_row(d);
        put_outcome(d, t, i);
    }
}

/* ---- a goal ---- */

/* "1e-3", or of an achieved error two digits, "4.5e-4" */
static const char *error_text(struct br_document *d, double error, bool achieved)
{
    char text[32];
    int digits = achieved;
    do {
        snprintf(text, sizeof text, "%.*e", digits, error);
    } while (!achieved && strtod(text, NULL) != error && digits++ < 16);
    char *power = strchr(text, 'e');
    if (power && power[1] == '-' && power[2] == '0')
        memmove(power + 2, power + 3, strlen(power + 3) + 1);
    return br_format(d, "%s", text);
}

/* "Cheapest way to 1e-3: bdf2+p2, n = 3, k = 0.1 s (error 4.5e-4)." */
static void answer_goal(struct br_document *d, const struct br_trade *t)
{
    const struct br_trial *best = &t->trial[t->chosen];
    const char *goal = error_text(d, t->goal.error, false);
    if (t->chosen == t->count) {
        if (t->goal.error > 0)
            br_put_answer(d, "No trial has an error of %s or less.", goal);
        else
            br_put_answer(d, "No trial takes at most %g CPU s.", t->goal.seconds);
        answer_front(d, t);
        return;
    }
    if (t->goal.error > 0)
        br_put_answer(d, "Cheapest way to %s: ", goal);
    else
        br_put_answer(d, "Least error within %g CPU s: ", t->goal.seconds);
    br_put_more(d, "%s (error %s).", trial_text(d, t->request.scene, best),
                error_text(d, br_trial_bound(best), true));
    br_put_answer(d, "It takes %.3g CPU s for %zu steps.", br_trial_seconds(best),
                  best->cost.counts.steps);
}

/* Command lines that repeat the chosen trial: its march, and its error and seconds. */
static void put_commands(struct br_document *d, const struct br_trade *t, const char *words)
{
    enum { LONGEST = 1024 };
    if (t->chosen == t->count || strlen(words) > LONGEST)
        return;
    const struct br_trial *best = &t->trial[t->chosen];
    const struct br_method method = br_trial_method(best);
    char options[BR_METHOD_TEXT];
    br_put_command(d, "run", "To march it",
                   br_format(d, "beamrate run %s --n %zu --k T/%zu%s", words, best->at.n,
                             best->at.steps,
                             br_method_options(t->request.scene, &method, options)));
    br_put_command(d, "trade", "To measure it again",
                   br_format(d, "beamrate trade %s --methods %s --n %zu ", words, best->named->name,
                             best->at.n));
    if (best->named->method.scheme->adaptive)
        br_put_more(d, "--tolerance %.15g", best->tolerance);
    else
        br_put_more(d, "--k T/%zu", best->at.steps);
    if (t->request.norm != br_norms[0])
        br_put_more(d, " --norm %s", t->request.norm->name);
}

/* The trial of each method that is best for the goal. */
static void put_best_of_methods(struct br_document *d, const struct br_trade *t)
{
    br_put_table(d, "goal", "The best of each method", BR_FOR_PEOPLE);
    for (size_t m = 0; m < t->methods.count; m++) {
        const size_t best = br_trials_for_goal(t->trial, t->count, &t->goal, &t->methods.list[m]);
        if (best == t->count)
            continue;
        br_put_row(d);
        put_outcome(d, t, best);
        BR_PUT(d, br_text(best == t->chosen ? "chosen" : NULL), .key = "remark");
    }
}

/* The first trial with an error has the norm of the solution and the reference's own error. */
static void note_reference(struct br_document *d, const struct br_trade *t)
{
    const struct br_trial *known = t->trial;
    while (known < t->trial + t->count && !isfinite(known->scale))
        known++;
    br_put_note(d, "%s", t->request.norm->title);
    br_put_note(d, "Reference: %s.", br_trials_reference(&t->request)->title);
    if (known == t->trial + t->count)
        return;
    br_put_note(d, "Relative errors are divided by the norm of the solution, %.4g %s.",
                known->scale, t->request.norm->unit);
    if (isfinite(known->own))
        br_put_note(d,
                    "The reference's own error is at most %.1e of that. It is added to the error "
                    "of a trial before the trial counts as good enough.",
                    known->own / known->scale);
}

static void put_answers(struct br_document *d, const struct br_trade *t, const char *words)
{
    if (br_trade_has_goal(t)) {
        answer_goal(d, t);
    } else {
        answer_cheapest(d, t);
        answer_front(d, t);
        answer_paper(d, t);
    }
    br_put_answer(d, "Trials: ");
    br_put_list(d, "", ", ");
    for (enum br_trial_end end = BR_TRIAL_DONE; end < BR_TRIAL_ENDS; end++)
        if (br_trade_tally(t, end))
            br_put_item(d, "%zu %s", br_trade_tally(t, end), br_trial_end_names[end]);
    br_put_more(d, ".");
    if (t->forecast.left)
        br_put_answer(d,
                      "Left out to save time, the most expensive first: %zu of %zu trials, about "
                      "%.0f s; --all tries all.",
                      t->forecast.left, t->count, t->forecast.left_seconds);
    put_commands(d, t, words);
}

static void put_methods(struct br_document *d, const struct br_trade *t)
{
    br_put_table(d, "methods", "CPU seconds to an error, by method", BR_FILES_ONLY);
    for (size_t c = 0; c < t->methods.count; c++) {
        br_put_row(d);
        BR_PUT(d, br_text(t->methods.list[c].name), .key = "method");
        br_put_method_cells(d, &t->methods.list[c].method);
        for (size_t i = 0; i < BR_TRADE_DIGITS; i++) {
            const size_t best = t->best_of[c][i];
            const bool reached = best < t->count;
            const char *target = br_format(d, "%.0e", br_trade_target(i));
            BR_PUT(d, br_number(reached ? br_trial_seconds(&t->trial[best]) : NAN),
                   .key = br_format(d, "seconds_to_%s", target), .heading = target, .unit = "s",
                   .format = "%.2g");
        }
    }
}

void br_report_trade(const struct br_trade *t, const char *words,
                     const struct br_provenance *provenance, struct br_document *d)
{
    char caption[512];
    snprintf(caption, sizeof caption, "What a digit costs: %.400s", t->request.scene->title);
    br_document_begin(d, t->request.scene->name, "beamrate trade", 1, caption);
    put_answers(d, t, words);
    if (br_trade_has_goal(t)) {
        put_best_of_methods(d, t);
    } else {
        br_put_table(d, "cheapest", "Cheapest way to an error",
                     t->best[0] < t->count ? 0 : BR_FOR_PROGRAMS);
        put_targets(d, t, NULL);
    }
    put_trials(d, t, true);
    if (!br_trade_has_goal(t))
        put_methods(d, t);

    br_put_table(d, "failures", "Trials that were not completed", BR_FOR_PEOPLE);
    for (size_t i = 0; i < t->count; i++) {
        const struct br_trial *trial = &t->trial[i];
        if (!trial->failure.status)
            continue;
        br_put_row(d);
        put_trial(d, t->request.scene, trial);
        BR_PUT(d, br_text(br_trial_end_names[trial->end]), .key = "end");
        BR_PUT(d, br_text(trial->failure.message), .key = "why", .flags = BR_WRAP);
    }

    put_trials(d, t, false);

    br_hide_fact(d, br_text(t->request.scene->name), NULL, "scene.name");
    if (br_trade_has_goal(t)) {
        br_hide_fact(d, br_if(t->goal.error > 0, br_number(t->goal.error)), NULL, "goal_error");
        br_hide_fact(d, br_if(t->goal.seconds > 0, br_number(t->goal.seconds)), NULL,
                     "goal_seconds");
        br_hide_fact(d, br_if(t->chosen < t->count, br_count(t->chosen)), NULL, "chosen");
    }
    br_hide_fact(d, br_text(t->request.norm->name), NULL, "norm");
    br_hide_fact(d, br_text(t->request.norm->unit), NULL, "unit");
    br_hide_fact(d, br_text(br_trials_reference(&t->request)->name), NULL, "reference");
    br_hide_fact(d, br_count(t->request.repeats), NULL, "repeats");
    br_hide_fact(d, br_number(t->request.repeat_seconds), NULL, "repeat_seconds");
    br_hide_fact(d, br_number(t->request.time_limit), NULL, "time_limit");
    br_hide_fact(d, br_number(t->wall_seconds), NULL, "wall_seconds");

    br_put_section(d, "What is measured");
    note_reference(d, t);
    br_put_note(d,
                "CPU: set-up and march, seconds of the processor in one thread, the least of up to "
                "%zu marches after a warm-up. A march longer than %g s is not repeated. On %s.",
                t->request.repeats, t->request.repeat_seconds, provenance->machine);
    br_put_note(d, "Digits/s: -log10 of the relative error, over these seconds.");
    br_put_note(d, "The error of a trial is the largest at its own time levels; the error between "
                   "them is not measured.");
    br_put_note(d, "The name of a method consists of its time scheme and all that differs from the "
                   "defaults. A scheme that chooses its steps has a tolerance (tol) instead of k.");
    if (br_trade_tally(t, BR_TRIAL_DOUBTFUL))
        br_put_note(d, "Doubtful: the reference's own error is more than a third of the trial's.");
    if (br_trade_tally(t, BR_TRIAL_UNSTABLE))
        br_put_note(d, "Unstable: beyond the stability limit of the lagged contact.");
    br_put_note(d, "All trials are in the CSV and JSON files.");

    br_put_provenance(d, provenance);
}

/* "example1: to 1e-03 bdf2, n = 100, k = 0.01 s (1e-05 CPU s); to 1e-06 ..." */
static void answer_scene(struct br_document *d, const struct br_trade *t)
{
    br_put_answer(d, "%s:", t->request.scene->name);
    br_put_list(d, " ", "; ");
    for (size_t i = 0; i < ANSWERED; i++) {
        const size_t best = t->best[answered[i]];
        if (best < t->count)
            br_put_item(d, "to %.0e %s (%.3g CPU s)", br_trade_target(answered[i]),
                        trial_text(d, t->request.scene, &t->trial[best]),
                        br_trial_seconds(&t->trial[best]));
    }
    br_put_more(d, d->items ? "." : " no trial has an error of 1e-03 or less.");
}

void br_report_trade_summary(const struct br_trade *const *trade, size_t scenes,
                             const struct br_provenance *provenance, struct br_document *d)
{
    br_document_begin(d, BR_SUMMARY, "beamrate trade, several scenes", 1, "What a digit costs");
    for (size_t i = 0; i < scenes; i++)
        answer_scene(d, trade[i]);
    br_put_table(d, "cheapest", "Cheapest way to an error, by scene", BR_MAIN);
    for (size_t i = 0; i < scenes; i++)
        put_targets(d, trade[i], trade[i]->request.scene->name);
    br_put_provenance(d, provenance);
}
