/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Warnings of errors that are predicted: round-off above the discretisation error, a discretisation
 * error that is large, and one that is not known. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "study/foresee/prediction.h"
#include "study/grid/study.h"

static const double large = 0.05;       /* relative to the solution */
static const double doubtful = 0.2;     /* the same of an upper bound */
static const double aim = 0.02;         /* what a remedy is to reach */
static const double negligible = 1e-12; /* round-off that nobody minds */

/* ---- round-off ---- */

static bool heeds_refinement(const struct br_method *m)
{
    return br_linear_solver_heeds(m->solver, "--refinement");
}

static void round_off_remedy(const struct br_planned_march *o, double floor, char remedy[400])
{
    struct br_method other = *o->method;
    struct br_planned_march alternative = *o;
    alternative.method = &other;
    other.solver = br_linear_solvers[0];
    const double least = br_predict_round_off(&alternative);
    other = *o->method;
    other.linear.refinement = 2;
    int used = 0;
    if (least < floor / 2)
        used = snprintf(remedy, 400, "--solver %s  # %.1e\n", br_linear_solvers[0]->name, least);
    if (heeds_refinement(&other) && o->method->linear.refinement < 2 &&
        br_predict_round_off(&alternative) < floor / 2)
        used += snprintf(remedy + used, 400 - (size_t)used, "--refinement 2  # %.1e\n",
                         br_predict_round_off(&alternative));
    snprintf(remedy + used, 400 - (size_t)used, "fewer elements, which round-off grows with");
}

static void warn_of_round_off(const struct br_planned_march *o, const struct br_prediction *p,
                              struct br_warnings *w)
{
    char remedy[400];
    /* Of marches without that round-off. */
    const double parts = p->time.error + p->space.error;
    const double error = p->known ? fmin(p->whole.error, parts) : p->whole.high;
    if (p->round_off <= fmax(p->bounded ? error : aim, negligible))
        return;
    round_off_remedy(o, p->round_off, remedy);
    char beside[128] = "";
    if (p->bounded)
        snprintf(beside, sizeof beside, ", above the predicted discretisation error, %s%.1e",
                 p->known ? "" : "at most ", error);
    br_warn(w, BR_WARN_ROUND_OFF, remedy,
            "the predicted round-off of --solver %s at n = %zu is %.1e of the solution%s",
            o->method->solver->name, o->n, p->round_off, beside);
}

/* ---- accuracy ---- */

/* The least of 1, 2 and 5 times a power of ten that is not less. */
static double round_up(double x)
{
    const double power = pow(10, floor(log10(x)));
    return power * (x <= power ? 1 : x <= 2 * power ? 2 : x <= 5 * power ? 5 : 10);
}

/* Steps with which the time error reaches the aim, by an order of at most the scheme's. */
static double steps_needed(const struct br_planned_march *o, const struct br_prediction *p)
{
    const double order = p->time.order >= 0.5 ? fmin(p->time.order, o->method->scheme->order) : 1;
    return round_up((double)o->steps * pow(p->time.error / aim, 1 / order));
}

static double elements_needed(const struct br_planned_march *o, const struct br_prediction *p)
{
    return round_up((double)o->n * sqrt(p->space.error / aim));
}

/* Whether contact at u_n would do. */
static bool lag_is_to_blame(const struct br_planned_march *o)
{
    struct br_method method = *o->method;
    struct br_planned_march other = *o;
    struct br_prediction p;
    struct br_error err;
    if (method.contact->at_new_step || !o->scene->contact.modelled)
        return false;
    method.contact = br_contact_rule_find("implicit");
    other.method = &method;
    return br_predict(&other, &p, &err) == BR_OK && p.known && p.whole.error <= large;
}

static void accuracy_remedy(const struct br_planned_march *o, const struct br_prediction *p,
                            char remedy[400])
{
    int used = 0;
    remedy[0] = '\0';
    if (lag_is_to_blame(o)) {
        snprintf(remedy, 400, "--contact implicit");
        return;
    }
    if (o->method->scheme->adaptive && p->time.error > aim)
        used =
            snprintf(remedy, 400, "--tolerance %.1g", o->method->tolerance * aim / p->time.error);
    else if (p->time.error > aim && isfinite(steps_needed(o, p)))
        used = snprintf(remedy, 400, "--k T/%.0f", steps_needed(o, p));
    if (p->space.error > aim && isfinite(elements_needed(o, p)))
        snprintf(remedy + used, 400 - (size_t)used, "%s--n %.0f", used ? " " : "",
                 elements_needed(o, p));
}

static void warn_of_inaccuracy(const struct br_planned_march *o, const struct br_prediction *p,
                               struct br_warnings *w)
{
    char remedy[400], interval[BR_PREDICTED_TEXT];
    const bool likely = p->whole.error > large || p->whole.high > doubtful;
    if (!p->bounded || !(p->known ? likely : p->whole.low > large))
        return;
    accuracy_remedy(o, p, remedy);
    br_warn(w, BR_WARN_INACCURATE, remedy,
            "the predicted discretisation error at n = %zu, k = %.4g s, relative to the "
            "solution, is %s (of time %.2g, of space %.2g)",
            o->n, br_time_step(o->scene, o->steps), br_predicted_interval(&p->whole, interval),
            p->time.error, p->space.error);
}

static void warn_of_ignorance(const struct br_planned_march *o, const struct br_prediction *p,
                              struct br_warnings *w)
{
    char most[80] = "";
    if (p->known)
        return;
    if (p->bounded)
        snprintf(most, sizeof most, ", and may be %.2g of the solution", p->whole.high);
    br_warn(w, BR_WARN_UNKNOWN, "",
            "the discretisation error at n = %zu, k = %.4g s is not known%s: %s", o->n,
            br_time_step(o->scene, o->steps), most, p->why);
}

static enum br_status look(const struct br_planned_march *o, struct br_warnings *w,
                           struct br_error *err)
{
    struct br_prediction p;
    const enum br_status status = br_predict(o, &p, err);
    if (status)
        return status;
    warn_of_round_off(o, &p, w);
    warn_of_inaccuracy(o, &p, w);
    warn_of_ignorance(o, &p, w);
    if (o->prediction)
        *o->prediction = p;
    return BR_OK;
}

const struct br_warning_source br_warn_prediction = {
    .title = "errors of discretisation and of round-off, as predicted",
    .look = look,
};
