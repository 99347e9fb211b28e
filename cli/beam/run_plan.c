/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/beam/run.h"

#include <math.h>
#include <string.h>

#include "cli/beam/study_request.h"
#include "study/scene/method_fields.h"

/* ---- times ---- */

/* The time level (out) at t, s. */
static enum br_status read_level(double t, const struct br_scene *scene, size_t steps,
                                 size_t *level, struct br_error *err)
{
    const double T = scene->duration, position = t / T * (double)steps;
    if (!(t >= 0 && t <= T))
        return br_fail(err, BR_BAD_INPUT, "--at: found %g s, expected a time of [0, %g] s", t, T);
    const double nearest = round(position);
    *level = (size_t)nearest;
    if (fabs(position - nearest) <= 1e-6)
        return BR_OK;
    const double below = floor(position);
    return br_fail(
        err, BR_BAD_INPUT,
        "--at: found %.10g s, expected a multiple of k = %g s; the nearest are %.15g s and %.15g s",
        t, T / (double)steps, T * below / (double)steps, T * (below + 1) / (double)steps);
}

static enum br_status read_times(const char *text, struct br_run_plan *plan, struct br_error *err)
{
    struct br_run_request *q = &plan->request;
    struct br_error inner = {0};
    if (br_times_check(text, &inner))
        return br_fail(err, BR_BAD_INPUT, "--at: %s", inner.message);
    for (const char *rest = text; rest; rest = *rest ? rest + 1 : NULL) {
        double t;
        const char *end = br_read_time(rest, q->scene->duration, &t);
        if (!end)
            return br_fail(err, BR_BAD_INPUT,
                           "--at: found '%s', expected times separated by commas, like 0.1,0.5, or "
                           "'every:TIME'",
                           rest);
        if (read_level(t, q->scene, q->steps, &plan->level[q->levels++], err))
            return err->status;
        rest = end;
    }
    br_sort_counts(plan->level, q->levels);
    for (size_t i = 1; i < q->levels; i++)
        if (plan->level[i] == plan->level[i - 1])
            return br_fail(err, BR_BAD_INPUT, "--at: %g s is given twice",
                           q->scene->duration * (double)plan->level[i] / (double)q->steps);
    return BR_OK;
}

/* The steps (out) between two times of 'every:TIME'. */
static enum br_status read_every(const char *text, const struct br_run_request *q, size_t *interval,
                                 struct br_error *err)
{
    double t;
    const char *end = br_read_time(text, q->scene->duration, &t);
    if (!end || *end || !(t > 0))
        return br_fail(err, BR_BAD_INPUT,
                       "--at: found 'every:%s', expected a time above 0, like every:0.1", text);
    if (read_level(t, q->scene, q->steps, interval, err))
        return err->status;
    return *interval ? BR_OK
                     : br_fail(err, BR_BAD_INPUT,
                               "--at: found 'every:%s', expected a multiple of k = %g s", text,
                               q->scene->duration / (double)q->steps);
}

/* By default ten intervals of about the same length, whatever the number of steps. */
static enum br_status make_levels(struct br_run_plan *plan, const struct br_options *o,
                                  struct br_error *err)
{
    enum { PARTS = 10 };
    static const char word[] = "every:";
    struct br_run_request *q = &plan->request;
    const char *at = br_option_text(o, BR_OPT_AT);
    const bool every = at && strncmp(at, word, strlen(word)) == 0;
    size_t room = at ? strlen(at) + 1 : PARTS + 1, interval = 1;
    if (at && !br_option_given(o, BR_OPT_OUT))
        return br_fail(err, BR_BAD_INPUT, "--at needs --out, the folder for the fields");
    if (every && read_every(at + strlen(word), q, &interval, err))
        return err->status;
    if (every)
        room = q->steps / interval + 1;
    q->level = plan->level = br_allocate(room, sizeof *plan->level);
    if (!plan->level)
        return br_no_memory(err, "the output times");
    if (at && !every)
        return read_times(at, plan, err);
    for (size_t i = 0; i < room && br_option_given(o, BR_OPT_OUT); i++) {
        const size_t level =
            every ? i * interval
                  : (size_t)llround((double)q->steps * (double)i / PARTS); /* exact below 2^49 */
        if (q->levels == 0 || level > plan->level[q->levels - 1])
            plan->level[q->levels++] = level;
    }
    return BR_OK;
}

/* ---- the plan ---- */

static enum br_status read_fields(const char *text, unsigned *wanted, struct br_error *err)
{
    static const struct {
        const char *name;
        unsigned bits;
    } names[] = {{"axial", BR_WANT_AXIAL},
                 {"bending", BR_WANT_BENDING},
                 {"axial,bending", BR_WANT_AXIAL | BR_WANT_BENDING},
                 {"bending,axial", BR_WANT_AXIAL | BR_WANT_BENDING}};
    *wanted = 0;
    for (size_t i = 0; text && i < sizeof names / sizeof *names; i++)
        if (strcmp(text, names[i].name) == 0)
            *wanted = names[i].bits;
    if (text && !*wanted)
        return br_fail(err, BR_BAD_INPUT,
                       "--fields: found '%s', expected axial, bending or axial,bending", text);
    return BR_OK;
}

enum br_status br_run_plan_make(struct br_run_plan *plan, const struct br_options *o,
                                struct br_error *err)
{
    const char *const *given = &o->given[BR_OPT_METHOD];
    struct br_run_request *q = &plan->request;
    const struct br_method *const methods[] = {&q->method};
    *q = (struct br_run_request){
        .scene = &plan->opened.scene,
        .method = br_method_default(),
        .n = (size_t)br_option_number(o, BR_OPT_N, 0),
        .check = br_option_given(o, BR_OPT_CHECK),
    };
    if (br_method_read(given, BR_METHOD_OPTION, &q->method, err) ||
        br_method_check_used(given, BR_METHOD_OPTION, methods, 1, err) ||
        read_fields(br_option_text(o, BR_OPT_FIELDS), &q->wanted, err) ||
        br_read_step("--k", br_option_text(o, BR_OPT_K), q->scene, &q->steps, err) ||
        make_levels(plan, o, err) || br_model_select(q->scene, q->wanted, &plan->marched, err))
        return err->status;
    if (br_option_given(o, BR_OPT_OUT))
        q->stride = br_history_stride(q->steps, (size_t)br_option_number(o, BR_OPT_ROWS, 0));
    return q->method.axial_degree == 1 || plan->marched.axial.modelled
               ? BR_OK
               : br_fail(err, BR_BAD_INPUT, "--axial-degree: no axial field is marched");
}

void br_run_plan_clear(struct br_run_plan *plan)
{
    free(plan->level);
    br_opened_scene_clear(&plan->opened);
}
