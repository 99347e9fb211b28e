/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/extremes/judge.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "study/extremes/trial.h"
#include "study/run/model.h"
#include "study/scene/file.h"

static const double no_digit = 0.05; /* predicted round-off that leaves none */

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

void br_extreme_decide(struct br_extreme_trial *t, enum br_extreme_class which, const char *format,
                       ...)
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

/* Whether it was said before the march that no digit may be right. */
static bool warned(const struct br_extreme_trial *t)
{
    return br_warnings_find(&t->warnings, BR_WARN_ROUND_OFF) ||
           br_warnings_find(&t->warnings, BR_WARN_INACCURATE) ||
           br_warnings_find(&t->warnings, BR_WARN_UNKNOWN);
}

struct br_track_request br_extreme_request(const struct br_extreme_trial *t)
{
    return (struct br_track_request){.scene = &t->scene,
                                     .wanted = t->one->wanted,
                                     .method = &t->method,
                                     .places = &t->places,
                                     .finer = 1,
                                     .shorter = 1,
                                     .rounding = t->court->rounding};
}

/* ---- before the march ---- */

/* What the program does with a failure of its own: it says so. */
static enum br_status refuse(struct br_extreme_trial *t, enum br_status status,
                             const struct br_error *said, struct br_error *err)
{
    if (status == BR_NO_MEMORY)
        return br_fail(err, status, "%s", said->message);
    br_extreme_decide(t, status == BR_INTERRUPTED ? BR_EXTREME_UNJUDGED : BR_EXTREME_REFUSED,
                      "%.180s", said->message);
    return BR_OK;
}

static enum br_status read_case(struct br_extreme_trial *t, struct br_error *err)
{
    char text[BR_EXTREME_TEXT];
    struct br_error said = {0};
    br_extreme_scene(t->one, text);
    enum br_status status = br_scene_read_text("scene", text, &t->scene, &said);
    if (!status)
        status = br_model_select(&t->scene, t->one->wanted, &t->marched, &said);
    if (!status)
        status = br_method_check(&t->method, &said);
    const struct br_outlook outlook = {.scene = &t->marched,
                                       .method = &t->method,
                                       .n = t->one->n,
                                       .steps = t->one->steps,
                                       .prediction = &t->prediction};
    if (!status)
        status = br_look_ahead(&outlook, &t->warnings, &said);
    for (size_t i = 0; i < t->warnings.count; i++)
        t->verdict->warned |= 1u << t->warnings.list[i].kind;
    t->verdict->known = t->prediction.known;
    return status ? refuse(t, status, &said, err) : BR_OK;
}

/* ---- the march ---- */

/* The march with everything that checks it. */
static enum br_status march(struct br_extreme_trial *t, struct br_error *err)
{
    struct br_track_request request = br_extreme_request(t);
    const struct br_track *own = t->own;
    request.check = true;
    enum br_status status = br_track_march(&request, t->own, err);
    if (status)
        return status;
    t->verdict->round_off = own->report.round_off;
    if (own->report.contact_unstable)
        t->verdict->warned |= 1u << BR_WARN_UNSTABLE;
    if (own->failure.status)
        return refuse(t, own->failure.status, &own->failure, err);
    if (own->report.bad_steps)
        br_extreme_decide(t, BR_EXTREME_WRONG, "certificate: %.160s", own->report.verdict.message);
    else if (!own->finite)
        br_extreme_decide(t, BR_EXTREME_WRONG, "values that are not finite");
    else if (!(own->report.round_off < no_digit) && !warned(t))
        br_extreme_decide(t, BR_EXTREME_WRONG,
                          "no digit is left (round-off %.2g), and nothing is said",
                          own->report.round_off);
    return BR_OK;
}

/* ---- all of it ---- */

static enum br_status judge(struct br_extreme_trial *t, struct br_error *err)
{
    enum br_status status = read_case(t, err);
    if (!status && !t->done)
        status = march(t, err);
    if (!status && !t->done)
        status = br_extreme_judge_accuracy(t, err);
    if (!status && t->own->begun && !t->own->failure.status && !t->court->quick &&
        t->verdict->which != BR_EXTREME_WRONG)
        status = br_extreme_judge_units(t, err);
    return status;
}

enum br_status br_extreme_judge(const struct br_extreme_case *one,
                                const struct br_extreme_court *court,
                                struct br_extreme_verdict *verdict, struct br_error *err)
{
    *verdict =
        (struct br_extreme_verdict){.error = NAN, .stated = NAN, .units = NAN, .round_off = NAN};
    struct br_extreme_trial t = {
        .one = one, .court = court, .verdict = verdict, .method = one->method};
    t.method.most_steps = BR_EXTREME_PATIENCE;
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
