/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "study/estimate/prediction.h"
#include "study/estimate/warnings.h"
#include "study/extremes/extremes.h"
#include "study/run/run.h"
#include "study/scene/file.h"
#include "study/scene/resolution.h"
#include "tests/lab/map.h"
#include "tests/lab/track.h"
#include "tests/support.h"

enum { MOST_STEPS = 2500 }; /* steps of the exact solution, and of adaptive schemes */

struct trial {
    const struct br_extreme_case *one;
    const struct br_extreme_options *options;
    struct br_extreme_verdict *verdict;
    struct br_scene scene, marched; /* the latter borrows */
    struct br_method method;
    struct br_track_samples samples;
    struct br_track *own, *other;
    struct br_prediction prediction;
    double reference_error[2]; /* of the other march, by br_field_kind, relative; 0: not known */
    double beyond;             /* an error over the stated one, if it is larger; otherwise 0 */
    struct br_warnings warnings;
    bool done;
};

static const double no_digit = 0.05; /* predicted round-off that leaves no correct digit */

const char *const br_extreme_words[] = {"right",   "inaccurate", "not-known", "unstable",
                                        "refused", "unchecked",  "wrong"};

const char *const br_extreme_sources[] = {"nobody", "the exact solution", "refinement"};

/* Sets the verdict of a case; the format is that of its reason. */
__attribute__((format(printf, 3, 4))) static void decide(struct trial *t,
                                                         enum br_extreme_class which,
                                                         const char *format, ...)
{
    va_list args;
    va_start(args, format);
    vsnprintf(t->verdict->why, sizeof t->verdict->why, format, args);
    va_end(args);
    for (char *c = t->verdict->why; *c; c++)
        if (*c == '\n' || *c == '\t')
            *c = ' ';
    t->verdict->which = which;
    t->done = true;
}

/* Whether a warning before the march says that perhaps no digit is right. */
static bool warned(const struct trial *t)
{
    return br_test_warning(&t->warnings, BR_WARN_ROUND_OFF) ||
           br_test_warning(&t->warnings, BR_WARN_INACCURATE) ||
           br_test_warning(&t->warnings, BR_WARN_UNKNOWN);
}

/* The request for a march of the unchanged case. */
static struct br_track_request request_of(const struct trial *t)
{
    return (struct br_track_request){.scene = &t->scene,
                                     .wanted = t->one->wanted,
                                     .method = &t->method,
                                     .samples = &t->samples,
                                     .finer = 1,
                                     .shorter = 1};
}

/* ---- how accurate it is: by the exact solution or by refinement, against what is stated ---- */

static const double accurate = 0.05;    /* relative, of displacements */
static const double refined_work = 3e6; /* elements times linear solves */
static const double of_distance = 1.5;  /* from a reference to a finer one, times this: its error */

double br_extreme_beyond(double error, double slack, double stated)
{
    return error <= slack + stated ? 0 : (error - slack) / fmax(stated, 1e-300);
}

/* Compares the distance of the march from the reference with the stated error. */
static void compare(struct trial *t)
{
    struct br_extreme_verdict *v = t->verdict;
    v->error = v->stated = v->nearest = 0;
    t->beyond = 0;
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        double sure;
        const double e = br_track_error(t->own, t->other, kind, &sure);
        const double divisor = t->options->stated_divisor > 0 ? t->options->stated_divisor : 1;
        const double stated = br_predicted_most(&t->prediction, kind) / divisor;
        const double slack = fmax(sure, of_distance * t->reference_error[kind]);
        const double beyond = br_extreme_beyond(e, slack, stated);
        if (isnan(beyond) || beyond > t->beyond || (beyond == t->beyond && !(e <= v->nearest))) {
            v->stated = stated;
            v->nearest = e;
        }
        v->error = br_worst(v->error, e);
        t->beyond = br_worst(t->beyond, beyond);
    }
}

/* The exact solution has no friction law but (12). */
static bool exact_knows(const struct trial *t)
{
    return !t->options->quick && !(t->marched.friction.law != BR_FRICTIONLESS &&
                                   t->method.friction->needs_regularisation);
}

/* Marches by a scheme that takes little energy from a vibration, but is not the one that predicts
 * errors. */
static enum br_status march_finer(struct trial *t, size_t finer, double times,
                                  struct br_track *track, struct br_error *why)
{
    struct br_track_request request = request_of(t);
    const bool chosen = t->method.scheme->adaptive;
    const bool at_once = br_follows_at_once(&t->marched, br_time_step(&t->marched, t->one->steps));
    struct br_method fine = br_accurate_method(&t->method, chosen    ? "adaptive"
                                                           : at_once ? "euler"
                                                                     : "esdirk3");
    fine.tolerance = fmax(1e-11, fine.tolerance / (100 * times));
    fine.most_steps = 4 * MOST_STEPS;
    request.method = &fine;
    request.finer = finer;
    const double solves =
        (double)t->one->n * (double)t->one->steps * br_time_scheme_stages(fine.scheme);
    const double room = refined_work / ((double)finer * solves);
    request.shorter = chosen ? 1 : (size_t)(times * floor(fmin(32, fmax(2, room))));
    return br_track_march(&request, track, why);
}

static size_t finer_mesh(const struct trial *t)
{
    return t->one->n < 16 ? 8 : t->one->n < 200 ? 4 : 2;
}

static enum br_status ask(struct trial *t, enum br_extreme_by by, struct br_error *why)
{
    const enum br_status status =
        by == BR_BY_EXACT ? br_track_exact(&t->marched, &t->samples, MOST_STEPS, t->other, why)
                          : march_finer(t, finer_mesh(t), 1, t->other, why);
    if (status || t->other->failure.status)
        return status;
    t->verdict->by = by;
    compare(t);
    return BR_OK;
}

/* Before a case is called wrong, a still finer march measures the reference's own error. */
static enum br_status ask_again(struct trial *t, struct br_error *why)
{
    struct br_track *finest = br_allocate(1, sizeof *finest), *other = t->other;
    if (!finest)
        return br_no_memory(why, "a march");
    const enum br_status status = march_finer(t, 2 * finer_mesh(t), 2, finest, why);
    if (!status && !finest->failure.status) {
        double sure;
        for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++)
            t->reference_error[kind] = br_track_error(other, finest, kind, &sure);
        t->other = finest;
        compare(t);
        t->other = other;
    }
    free(finest);
    return status;
}

enum br_extreme_class br_extreme_class_of(const struct br_extreme_verdict *v, double beyond)
{
    const unsigned helps = 1u << BR_WARN_LOAD_TIME | 1u << BR_WARN_LOAD_SPACE |
                           1u << BR_WARN_INITIAL | 1u << BR_WARN_BOUNCE;
    const bool is_accurate = v->error <= accurate;
    if (v->by == BR_BY_NOBODY)
        return BR_EXTREME_UNCHECKED;
    if (beyond <= 0 && is_accurate)
        return BR_EXTREME_RIGHT;
    if (v->warned & 1u << BR_WARN_UNSTABLE)
        return BR_EXTREME_UNSTABLE;
    if (!is_accurate && !v->known)
        return BR_EXTREME_UNKNOWN;
    return beyond <= 0 || v->warned & helps ? BR_EXTREME_WARNED : BR_EXTREME_WRONG;
}

static void decide_accuracy(struct trial *t)
{
    const struct br_extreme_verdict *v = t->verdict;
    const enum br_extreme_class which = br_extreme_class_of(v, t->beyond);
    if (which == BR_EXTREME_UNCHECKED)
        decide(t, which, "nothing can check it: %.150s", t->other->failure.message);
    else if (which == BR_EXTREME_UNSTABLE)
        decide(t, which, "beyond the stability limit");
    else if (which == BR_EXTREME_UNKNOWN)
        decide(t, which, "error %.2g, said to be not known: %.100s", v->error, t->prediction.why);
    else if (which == BR_EXTREME_WARNED)
        decide(t, which, "error %.2g, and says so", v->error);
    else if (which == BR_EXTREME_WRONG)
        decide(t, which, "error %.2g by %s, stated to be at most %.2g", v->nearest,
               br_extreme_sources[v->by], v->stated);
    t->verdict->which = which;
}

static enum br_status check_accuracy(struct trial *t, struct br_error *why)
{
    enum br_status status = exact_knows(t) ? ask(t, BR_BY_EXACT, why) : BR_OK;
    if (!status && t->verdict->by == BR_BY_NOBODY)
        status = ask(t, BR_BY_REFINEMENT, why);
    if (!status && t->verdict->by == BR_BY_REFINEMENT && !(t->beyond <= 0))
        status = ask_again(t, why);
    /* Refinements may both miss what happens within a step. The law that is not smoothed is what
     * the smoothed one stands for: who is as near to it as stated is right. */
    if (!status && !(t->beyond <= 0) && !t->options->quick && !exact_knows(t))
        status = ask(t, BR_BY_EXACT, why);
    if (!status)
        decide_accuracy(t);
    return status;
}

/* ---- before the march ---- */

/* A failure that the program reports: the case is refused. */
static enum br_status refuse(struct trial *t, enum br_status status, const struct br_error *said,
                             struct br_error *why)
{
    if (status == BR_NO_MEMORY)
        return br_fail(why, status, "%s", said->message);
    decide(t, status == BR_INTERRUPTED ? BR_EXTREME_UNCHECKED : BR_EXTREME_REFUSED, "%.180s",
           said->message);
    return BR_OK;
}

static enum br_status read_case(struct trial *t, struct br_error *why)
{
    char text[BR_EXTREME_TEXT];
    struct br_error said = {0};
    br_extreme_scene(t->one, text);
    enum br_status status = br_scene_read_text("scene", text, &t->scene, &said);
    if (!status)
        status = br_model_select(&t->scene, t->one->wanted, &t->marched, &said);
    if (!status)
        status = br_method_check(&t->method, NULL, &said);
    const struct br_planned_march planned = {.scene = &t->marched,
                                             .method = &t->method,
                                             .n = t->one->n,
                                             .steps = t->one->steps,
                                             .prediction = &t->prediction};
    if (!status)
        status = br_check_ahead(&planned, &t->warnings, &said);
    for (size_t i = 0; i < t->warnings.count; i++)
        t->verdict->warned |= 1u << t->warnings.list[i].kind;
    t->verdict->known = t->prediction.known;
    return status ? refuse(t, status, &said, why) : BR_OK;
}

/* ---- the march ---- */

/* Marches the case with all checks. */
static enum br_status march(struct trial *t, struct br_error *why)
{
    struct br_track_request request = request_of(t);
    const struct br_track *own = t->own;
    request.check = true;
    enum br_status status = br_track_march(&request, t->own, why);
    if (status)
        return status;
    if (own->report.contact_unstable)
        t->verdict->warned |= 1u << BR_WARN_UNSTABLE;
    if (own->failure.status)
        return refuse(t, own->failure.status, &own->failure, why);
    if (own->report.bad_steps)
        decide(t, BR_EXTREME_WRONG, "certificate: %.160s", own->report.verdict.message);
    else if (!own->finite)
        decide(t, BR_EXTREME_WRONG, "values that are not finite");
    else if (!(own->report.round_off < no_digit) && !warned(t))
        decide(t, BR_EXTREME_WRONG, "no digit is left (round-off %.2g), and nothing is said",
               own->report.round_off);
    return BR_OK;
}

/* ---- all of it ---- */

static enum br_status find_verdict(struct trial *t, struct br_error *why)
{
    enum br_status status = read_case(t, why);
    if (!status && !t->done)
        status = march(t, why);
    if (!status && !t->done)
        status = check_accuracy(t, why);
    return status;
}

enum br_status br_extreme_check(const struct br_extreme_case *one,
                                const struct br_extreme_options *options,
                                struct br_extreme_verdict *verdict, struct br_error *why)
{
    *verdict = (struct br_extreme_verdict){.error = NAN, .nearest = NAN, .stated = NAN};
    struct trial t = {.one = one, .options = options, .verdict = verdict, .method = one->method};
    t.method.most_steps = MOST_STEPS;
    t.samples = br_track_samples(one->n, one->steps);
    t.own = br_allocate(1, sizeof *t.own);
    t.other = br_allocate(1, sizeof *t.other);
    const enum br_status status =
        t.own && t.other ? find_verdict(&t, why) : br_no_memory(why, "the verdict on a case");
    br_scene_clear(&t.scene);
    free(t.own);
    free(t.other);
    return status;
}
