/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/estimate/warnings.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/words.h"
#include "reference/energy/energy.h"
#include "solver/laws.h"
#include "solver/linear/linear_solver.h"
#include "study/estimate/prediction.h"
#include "study/grid/study.h"
#include "study/run/run.h"

const char *const br_warning_words[] = {
    "unstable",     "bounce",        "round-off",    "inaccurate", "error-not-known",
    "load-in-time", "load-in-space", "initial-data", "long",
};

void br_warn(struct br_warnings *w, enum br_warning_kind kind, const char *remedy,
             const char *format, ...)
{
    for (size_t i = 0; i < w->count; i++)
        if (w->list[i].kind == kind) {
            w->list[i].more++;
            return;
        }
    struct br_warning *added = &w->list[w->count++];
    *added = (struct br_warning){.kind = kind};
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(added->text, sizeof added->text, format, arguments);
    va_end(arguments);
    snprintf(added->remedy, sizeof added->remedy, "%s", remedy ? remedy : "");
}

/* ---- lagged contact beyond its limit ---- */

double br_round_steps(double least)
{
    static const double round_ones[] = {1, 1.25, 1.6, 2, 2.5, 4, 5, 8};
    for (double power = 1; power <= 1e12; power *= 10)
        for (size_t i = 0; i < sizeof round_ones / sizeof *round_ones; i++) {
            const double steps = round_ones[i] * power;
            if (steps >= least && steps == floor(steps))
                return steps;
        }
    return INFINITY;
}

/* Rounds x down to four digits. */
static double cut(double x)
{
    const double unit = pow(10, floor(log10(x)) - 3);
    return isfinite(x / unit) ? floor(x / unit) * unit : x;
}

static void contact_remedy(const struct br_planned_march *o, const struct br_field *field,
                           char text[400])
{
    const double longest = br_contact_limit_step(field, br_contact_stiffness(&o->scene->contact));
    const double steps = br_round_steps(o->scene->duration / longest);
    strcpy(text, "--contact implicit  # has no limit\n");
    if (longest > 0 && isfinite(steps))
        br_append(text, 400, "--k T/%.0f  # time steps of at most %.4g s\n", steps, cut(longest));
    br_append(text, 400, "a contact stiffness of at most %.4g N/m",
              cut(br_contact_limit_stiffness(field)));
}

void br_check_contact(const struct br_planned_march *o, struct br_warnings *warnings)
{
    const struct br_scene *scene = o->scene;
    const double k = scene->duration / (double)o->steps;
    const struct br_field field =
        br_field_of_scene(scene, BR_AXIAL, o->n, k, o->method->axial_degree);
    if (!br_lagged_contact_grows(o->method, scene, o->n, k))
        return;
    char text[400];
    contact_remedy(o, &field, text);
    br_warn(
        warnings, BR_WARN_UNSTABLE, text,
        "the lagged contact is beyond its stability limit: with k = %g s it is stable up to a "
        "stiffness of %.4g N/m, the scene has %g N/m; while it is closed, every step multiplies "
        "its error by -%.4g, and the tip chatters",
        k, br_contact_limit_stiffness(&field), br_contact_stiffness(&scene->contact),
        br_contact_growth(&field, br_contact_stiffness(&scene->contact)));
}

/* ---- lagged contact that may gain energy ---- */

/* Warns of a lagged contact that may gain energy as it opens and closes: its stiffness is below the
 * stability limit of a closed contact, but above the limit without inertia, below which no energy
 * is gained. A march with the same steps on a coarse mesh measures the gain: the limit does not
 * depend on the mesh. */

enum { MOST_ELEMENTS = 4, MOST_STEPS = 4000 };

static const double little = 0.01; /* share of the energy that was put in */

/* *share (out): the largest ratio, over all steps, of the energy that the scheme has added to the
 * axial field to the energy that was put into it; NaN: not known. Fails with BR_NO_MEMORY. */
static enum br_status measure_gain(const struct br_planned_march *o, double *share,
                                   struct br_error *err)
{
    struct br_scene axial;
    struct br_march *march = NULL;
    struct br_energy_meter *meter = NULL;
    struct br_error failure = {0};
    const size_t n = o->n < MOST_ELEMENTS ? o->n : MOST_ELEMENTS;
    *share = o->steps > MOST_STEPS ? (double)NAN : 0;
    if (o->steps > MOST_STEPS)
        return BR_OK;
    bool failed = br_model_select(o->scene, BR_WANT_AXIAL, &axial, &failure) ||
                  br_march_create(&march, &axial, n, o->steps, o->method, &failure) ||
                  br_energy_meter_create(&meter, march, &axial, o->method, &failure);
    for (size_t i = 0; i < o->steps && !failed; i++) {
        struct br_energy start, now;
        struct br_work work;
        failed = br_march_step(march, &failure);
        if (failed)
            break;
        br_energy_meter_step(meter);
        br_energy_meter_read(meter, &start, &now, &work);
        const double put_in = br_energy_put_in(&start, &work, BR_AXIAL);
        const double added = br_energy_added(&work, BR_AXIAL) / put_in;
        if (put_in > 0 && !(added <= *share))
            *share = added;
    }
    br_energy_meter_free(meter);
    br_march_free(march);
    if (failed)
        *share = NAN;
    return failed && failure.status == BR_NO_MEMORY
               ? br_fail(err, BR_NO_MEMORY, "%s", failure.message)
               : BR_OK;
}

static enum br_status check_bounces(const struct br_planned_march *o, struct br_warnings *w,
                                    struct br_error *err)
{
    const struct br_scene *s = o->scene;
    const struct br_field field = br_field_of_scene(
        s, BR_AXIAL, o->n, s->duration / (double)o->steps, o->method->axial_degree);
    if (!s->contact.modelled || o->method->contact->at_new_step ||
        !(br_contact_stiffness(&s->contact) > br_contact_limit_bouncing(&field)) ||
        br_lagged_contact_grows(o->method, s, o->n, field.k))
        return BR_OK;
    double share;
    char found[120] = "";
    if (measure_gain(o, &share, err))
        return err->status;
    if (share <= little)
        return BR_OK;
    if (share > little)
        snprintf(found, sizeof found,
                 "; on a coarse mesh it gains %.2g %% of the energy that is put into the axial "
                 "field",
                 100 * share);
    br_warn(w, BR_WARN_BOUNCE, "--contact implicit  # gains none",
            "the lagged contact may gain energy as it opens and closes: with k = %.4g s it gains "
            "none up to a stiffness of %.4g N/m, the scene has %g N/m%s",
            field.k, br_contact_limit_bouncing(&field), br_contact_stiffness(&s->contact), found);
    return BR_OK;
}

/* ---- predicted errors ---- */

/* Warnings of errors that are predicted: round-off above the discretisation error, a discretisation
 * error that is large, and one that is not known. */

static const double large_error = 0.05; /* relative to the solution */
static const double doubtful = 0.2;     /* the same of an upper bound */
static const double aim = 0.02;         /* the error that a remedy should reach */
static const double negligible = 1e-12; /* round-off that is not worth a warning */

/* ---- round-off ---- */

static void round_off_remedy(const struct br_planned_march *o, double floor, char remedy[400])
{
    struct br_method other = *o->method;
    struct br_planned_march alternative = *o;
    alternative.method = &other;
    other.solver = br_linear_solvers[0];
    const double least = br_predict_round_off(&alternative);
    remedy[0] = '\0';
    if (least < floor / 2)
        br_append(remedy, 400, "--solver %s  # %.1e\n", br_linear_solvers[0]->name, least);
    br_append(remedy, 400, "fewer elements, since round-off grows with their number");
}

static void warn_of_round_off(const struct br_planned_march *o, const struct br_prediction *p,
                              struct br_warnings *w)
{
    char remedy[400];
    /* The discretisation error, from marches without that round-off. */
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

/* The least number >= x of the form 1, 2 or 5 times a power of ten. */
static double round_up(double x)
{
    const double power = pow(10, floor(log10(x)));
    return power * (x <= power ? 1 : x <= 2 * power ? 2 : x <= 5 * power ? 5 : 10);
}

/* The number of steps for a time error of `aim`; the order is at most the scheme's. */
static double steps_needed(const struct br_planned_march *o, const struct br_prediction *p)
{
    const double order = p->time.order >= 0.5 ? fmin(p->time.order, o->method->scheme->order) : 1;
    return round_up((double)o->steps * pow(p->time.error / aim, 1 / order));
}

static double elements_needed(const struct br_planned_march *o, const struct br_prediction *p)
{
    return round_up((double)o->n * sqrt(p->space.error / aim));
}

/* *blamed (out): whether implicit contact would make the error small. Fails with BR_NO_MEMORY. */
static enum br_status blame_lag(const struct br_planned_march *o, bool *blamed,
                                struct br_error *err)
{
    struct br_method method = *o->method;
    struct br_planned_march other = *o;
    struct br_prediction p = {0};
    *blamed = false;
    if (method.contact->at_new_step || !o->scene->contact.modelled)
        return BR_OK;
    method.contact = br_contact_rule_find("implicit");
    other.method = &method;
    if (br_predict(&other, &p, err))
        return err->status;
    *blamed = p.known && p.whole.error <= large_error;
    return BR_OK;
}

static void accuracy_remedy(const struct br_planned_march *o, const struct br_prediction *p,
                            char remedy[400])
{
    remedy[0] = '\0';
    if (o->method->scheme->adaptive && p->time.error > aim)
        br_append(remedy, 400, "--tolerance %.1g", o->method->tolerance * aim / p->time.error);
    else if (p->time.error > aim && isfinite(steps_needed(o, p)))
        br_append(remedy, 400, "--k T/%.0f", steps_needed(o, p));
    if (p->space.error > aim && isfinite(elements_needed(o, p)))
        br_append(remedy, 400, "%s--n %.0f", *remedy ? " " : "", elements_needed(o, p));
}

static enum br_status warn_of_inaccuracy(const struct br_planned_march *o,
                                         const struct br_prediction *p, struct br_warnings *w,
                                         struct br_error *err)
{
    bool lagged;
    char remedy[400] = "--contact implicit", interval[BR_PREDICTED_TEXT];
    const bool likely = p->whole.error > large_error || p->whole.high > doubtful;
    if (!p->bounded || !(p->known ? likely : p->whole.low > large_error))
        return BR_OK;
    if (blame_lag(o, &lagged, err))
        return err->status;
    if (!lagged)
        accuracy_remedy(o, p, remedy);
    br_warn(w, BR_WARN_INACCURATE, remedy,
            "the predicted discretisation error at n = %zu, k = %.4g s, relative to the "
            "solution, is %s (of time %.2g, of space %.2g)",
            o->n, br_time_step(o->scene, o->steps), br_predicted_interval(&p->whole, interval),
            p->time.error, p->space.error);
    return BR_OK;
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

static enum br_status check_prediction(const struct br_planned_march *o, struct br_warnings *w,
                                       struct br_error *err)
{
    struct br_prediction p;
    if (br_predict(o, &p, err))
        return err->status;
    warn_of_round_off(o, &p, w);
    if (warn_of_inaccuracy(o, &p, w, err))
        return err->status;
    warn_of_ignorance(o, &p, w);
    if (o->prediction)
        *o->prediction = p;
    return BR_OK;
}

/* ---- all sources ---- */

static enum br_status check_time(const struct br_planned_march *o, struct br_warnings *w,
                                 struct br_error *err)
{
    static const double day = 86400, most_days = 36525; /* a century */
    const double days = br_march_seconds(o) / day;
    if (days > most_days)
        return br_fail(err, BR_BAD_INPUT,
                       "n = %zu and %zu steps take about %.2g years, expected at most a hundred: "
                       "longer steps or fewer elements",
                       o->n, o->steps, days / 365.25);
    if (days > 1)
        br_warn(w, BR_WARN_LONG, "longer steps or fewer elements, or a scheme of higher order",
                "n = %zu and %zu steps take about %.2g days", o->n, o->steps, days);
    return BR_OK;
}

enum br_status br_check_ahead_cheaply(const struct br_planned_march *o, struct br_warnings *w,
                                      struct br_error *err)
{
    if (br_fits_memory(o, br_memory_available(), err) || check_time(o, w, err))
        return err->status;
    br_check_contact(o, w);
    return check_bounces(o, w, err);
}

enum br_status br_check_ahead(const struct br_planned_march *o, struct br_warnings *w,
                              struct br_error *err)
{
    const bool refused = br_march_check(o->scene, o->n, o->steps, o->method, err) ||
                         br_check_ahead_cheaply(o, w, err) || br_check_loads(o, w, err) ||
                         check_prediction(o, w, err);
    return refused ? err->status : BR_OK;
}
