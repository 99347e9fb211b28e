/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/extreme_judge.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "study/extreme_random.h"
#include "study/extreme_track.h"
#include "study/model.h"
#include "study/rescale.h"
#include "study/scene_file.h"

static const double accurate = 0.05;    /* relative, of displacements */
static const double grown = 10;         /* relative error that is no inaccuracy any more */
static const double no_digit = 0.05;    /* predicted round-off that leaves none */
static const double noise = 1e-12;      /* of data, more than other units do to them */
static const double magnified = 8;      /* between two such noises */
static const double refined_work = 2e6; /* elements times linear solves */
static const size_t patience = 4000;    /* steps of the exact solution, and of adaptive schemes */

const char *br_extreme_word(enum br_extreme_class which)
{
    static const char *const words[] = {
#define X(name, word, title) [name] = word,
        BR_EXTREME_LIST(X)
#undef X
    };
    return words[which];
}

const char *br_extreme_title(enum br_extreme_class which)
{
    static const char *const titles[] = {
#define X(name, word, title) [name] = title,
        BR_EXTREME_LIST(X)
#undef X
    };
    return titles[which];
}

const char *br_extreme_by_name(enum br_extreme_by by)
{
    static const char *const names[] = {"nobody", "the exact solution", "refinement"};
    return names[by];
}

struct trial {
    const struct br_extreme_case *one;
    const struct br_extreme_court *court;
    struct br_extreme_verdict *verdict;
    struct br_scene scene, marched; /* the latter borrows */
    struct br_method method;
    struct br_track_places places;
    struct br_track *own, *other;
    struct br_warnings warnings;
    bool done;
};

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

static bool warned_of(const struct trial *t, enum br_warning_kind kind)
{
    return br_warnings_find(&t->warnings, kind) != NULL;
}

/* ---- before the march ---- */

/* What the program does with a failure of its own: it says so. */
static enum br_status refuse(struct trial *t, enum br_status status, const struct br_error *said,
                             struct br_error *err)
{
    if (status == BR_NO_MEMORY)
        return br_fail(err, status, "%s", said->message);
    decide(t, status == BR_INTERRUPTED ? BR_EXTREME_UNJUDGED : BR_EXTREME_REFUSED, "%.180s",
           said->message);
    return BR_OK;
}

static enum br_status read_case(struct trial *t, struct br_error *err)
{
    char text[BR_EXTREME_TEXT];
    struct br_error said = {0};
    br_extreme_scene(t->one, text);
    enum br_status status = br_scene_read_text("scene", text, &t->scene, &said);
    if (!status)
        status = br_model_select(&t->scene, t->one->wanted, &t->marched, &said);
    if (!status)
        status = br_method_check(&t->method, &said);
    const struct br_outlook outlook = {&t->marched, &t->method, t->one->n, t->one->steps};
    if (!status)
        status = br_look_ahead(&outlook, &t->warnings, &said);
    for (size_t i = 0; i < t->warnings.count; i++)
        t->verdict->warned |= 1u << t->warnings.list[i].kind;
    return status ? refuse(t, status, &said, err) : BR_OK;
}

/* ---- the march ---- */

static struct br_track_request request_of(const struct trial *t)
{
    return (struct br_track_request){.scene = &t->scene,
                                     .wanted = t->one->wanted,
                                     .method = &t->method,
                                     .places = &t->places,
                                     .finer = 1,
                                     .shorter = 1,
                                     .rounding = t->court->rounding};
}

/* The march with everything that checks it; none of the watchers knows an integrator's stages. */
static enum br_status march(struct trial *t, struct br_error *err)
{
    struct br_track_request request = request_of(t);
    const struct br_track *own = t->own;
    request.check = !t->method.scheme->integrator;
    enum br_status status = br_track_march(&request, t->own, err);
    if (status)
        return status;
    t->verdict->round_off = own->report.round_off;
    if (own->report.contact_unstable)
        t->verdict->warned |= 1u << BR_WARN_UNSTABLE;
    if (own->begun && own->report.bad_steps)
        decide(t, BR_EXTREME_WRONG, "certificate: %.160s", own->report.verdict.message);
    else if (own->failure.status)
        return refuse(t, own->failure.status, &own->failure, err);
    else if (!own->finite)
        decide(t, BR_EXTREME_WRONG, "values that are not finite");
    else if (!(own->report.round_off < no_digit) && !warned_of(t, BR_WARN_ROUND_OFF))
        decide(t, BR_EXTREME_WRONG, "no digit is left (round-off %.2g), and nothing is said",
               own->report.round_off);
    return BR_OK;
}

/* ---- accuracy ---- */

static double worst_distance(const struct trial *t)
{
    double most = 0;
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        const double d = br_track_distance(t->own, t->other, (enum br_field_kind)kind, 1);
        most = isnan(d) || d > most ? d : most;
    }
    return most;
}

/* The exact solution knows (12) alone. */
static bool exact_knows(const struct trial *t)
{
    return !t->court->quick && !(t->marched.friction.law != BR_FRICTIONLESS &&
                                 t->method.friction->needs_regularisation);
}

static enum br_status ask_exact(struct trial *t, struct br_error *err)
{
    if (!exact_knows(t))
        return BR_OK;
    const enum br_status status = br_track_exact(&t->marched, &t->places, patience, t->other, err);
    if (status || t->other->failure.status)
        return status;
    t->verdict->by = BR_BY_EXACT;
    t->verdict->error = worst_distance(t);
    return BR_OK;
}

/* By riccati, whose round-off is least, with contact at the new level, which has no limit. */
static enum br_status ask_refinement(struct trial *t, struct br_error *err)
{
    struct br_track_request request = request_of(t);
    struct br_method fine = t->method;
    fine.solver = br_linear_solvers[0];
    for (const struct br_contact_rule *const *rule = br_contact_rules; *rule; rule++)
        if ((*rule)->at_new_step)
            fine.contact = *rule;
    if (fine.scheme->integrator)
        fine.scheme = br_time_scheme_find("adaptive");
    fine.tolerance = fmax(1e-11, fine.tolerance / 100);
    fine.most_steps = 4 * patience;
    request.method = &fine;
    request.finer = 2;
    const double room = refined_work / (2 * br_extreme_work(t->one));
    request.shorter = fine.scheme->adaptive ? 1 : (size_t)fmin(64, fmax(2, room));
    const enum br_status status = br_track_march(&request, t->other, err);
    if (status || t->other->failure.status)
        return status;
    t->verdict->by = BR_BY_REFINEMENT;
    t->verdict->error = worst_distance(t);
    return BR_OK;
}

static void decide_accuracy(struct trial *t)
{
    const struct br_extreme_verdict *v = t->verdict;
    const unsigned helps = 1u << BR_WARN_ROUND_OFF | 1u << BR_WARN_INACCURATE |
                           1u << BR_WARN_LOAD_TIME | 1u << BR_WARN_LOAD_SPACE;
    if (v->by == BR_BY_NOBODY)
        decide(t, BR_EXTREME_UNJUDGED, "nobody can judge it: %.150s", t->other->failure.message);
    else if (v->error <= accurate)
        t->verdict->which = BR_EXTREME_RIGHT;
    else if (v->warned & 1u << BR_WARN_UNSTABLE)
        decide(t, BR_EXTREME_UNSTABLE, "beyond the stability limit");
    else if (v->warned & helps)
        decide(t, BR_EXTREME_WARNED, "error %.2g, and says so", v->error);
    else if (v->error <= grown)
        decide(t, BR_EXTREME_UNWARNED, "error %.2g by %s", v->error, br_extreme_by_name(v->by));
    else
        decide(t, BR_EXTREME_WRONG, "error %.2g by %s", v->error, br_extreme_by_name(v->by));
}

static enum br_status judge_accuracy(struct trial *t, struct br_error *err)
{
    enum br_status status = ask_exact(t, err);
    if (!status && t->verdict->by == BR_BY_NOBODY)
        status = ask_refinement(t, err);
    if (!status)
        decide_accuracy(t);
    return status;
}

/* ---- other units ---- */

static enum br_status march_changed(struct trial *t, const struct br_scene *changed, double unit,
                                    double *distance, struct br_error *err)
{
    struct br_track_request request = request_of(t);
    request.scene = changed;
    const enum br_status status = br_track_march(&request, t->other, err);
    *distance = 0;
    for (int kind = BR_AXIAL; kind <= BR_BENDING && !status; kind++) {
        const double d = br_track_distance(t->other, t->own, (enum br_field_kind)kind, unit);
        *distance = isnan(d) || d > *distance ? d : *distance;
    }
    return status;
}

static enum br_status march_in_other_units(struct trial *t, struct br_error *err)
{
    struct br_random r = br_random_of(t->one->seed ^ 0x5ca1e, t->one->index);
    const struct br_units_change units = {
        br_random_decades(&r, -3, 3), br_random_decades(&r, -3, 3), br_random_decades(&r, -3, 3)};
    struct br_scene changed = {0};
    enum br_status status = br_rescale(&t->scene, &units, &changed, err);
    if (!status)
        status = march_changed(t, &changed, units.metre, &t->verdict->units, err);
    br_scene_clear(&changed);
    return status == BR_BAD_INPUT ? BR_OK : status; /* there are no such units for it */
}

/* The most that little noise does to the answer. */
static enum br_status march_with_noise(struct trial *t, double *most, struct br_error *err)
{
    *most = 0;
    for (unsigned try = 0; try < 3; try++) {
        struct br_scene changed = {0};
        double distance = 0;
        enum br_status status =
            br_perturb(&t->scene, noise, t->one->seed + t->one->index + try, &changed, err);
        if (!status)
            status = march_changed(t, &changed, 1, &distance, err);
        br_scene_clear(&changed);
        if (status == BR_BAD_INPUT)
            continue;
        if (status)
            return status;
        *most = isnan(distance) ? INFINITY : fmax(*most, distance);
    }
    return BR_OK;
}

static enum br_status judge_units(struct trial *t, struct br_error *err)
{
    double by_noise;
    const double iteration = t->method.friction->iterates ? t->method.iteration.tolerance : 0;
    const double limit = 16 * t->verdict->round_off + 4 * iteration;
    enum br_status status = march_in_other_units(t, err);
    const double units = t->verdict->units;
    if (status || units <= limit || (isnan(units) && !t->other->begun))
        return status;
    char why[120];
    snprintf(why, sizeof why, "%.110s", t->other->failure.message);
    status = march_with_noise(t, &by_noise, err);
    if (!status && !(units <= magnified * by_noise))
        decide(t, BR_EXTREME_WRONG,
               "in other units it differs by %.2g; round-off explains %.2g, noise %.2g %s", units,
               limit, by_noise, why);
    return status;
}

/* ---- all of it ---- */

static enum br_status judge(struct trial *t, struct br_error *err)
{
    enum br_status status = read_case(t, err);
    if (!status && !t->done)
        status = march(t, err);
    if (!status && !t->done)
        status = judge_accuracy(t, err);
    if (!status && t->own->begun && !t->own->failure.status && !t->court->quick &&
        t->verdict->which != BR_EXTREME_WRONG)
        status = judge_units(t, err);
    return status;
}

enum br_status br_extreme_judge(const struct br_extreme_case *one,
                                const struct br_extreme_court *court,
                                struct br_extreme_verdict *verdict, struct br_error *err)
{
    *verdict = (struct br_extreme_verdict){.error = NAN, .units = NAN, .round_off = NAN};
    struct trial t = {.one = one, .court = court, .verdict = verdict, .method = one->method};
    t.method.most_steps = patience;
    t.places = br_track_places(one->n, one->steps);
    t.own = br_allocate(1, sizeof *t.own);
    t.other = br_allocate(1, sizeof *t.other);
    const enum br_status status =
        t.own && t.other ? judge(&t, err) : br_no_memory(err, "the judgement of a case");
    br_scene_clear(&t.scene);
    free(t.own);
    free(t.other);
    return status;
}
