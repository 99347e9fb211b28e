/* SPDX-License-Identifier: GPL-3.0-or-later */
/* beamrate plan SCENE --error E | --seconds S: proposes and tries the cheapest trial. */
#include <math.h>

#include "cli/command.h"
#include "cli/progress.h"
#include "cli/session.h"
#include "cli/study_request.h"
#include "study/scene/file.h"
#include "study/trade/plan.h"
#include "tables/reports.h"

struct run {
    const struct br_options *options; /* borrowed */
    struct br_session *session;       /* borrowed */
    struct br_study_request study;
    struct br_opened_scene opened;
    struct br_plan plan;
};

static enum br_status prepare(struct run *r, struct br_error *err)
{
    const struct br_options *o = r->options;
    const bool error = br_option_given(o, BR_OPT_ERROR);
    struct br_plan *p = &r->plan;
    if (br_session_alone(err) || br_study_request_read(o, &r->study, err))
        return err->status;
    const struct br_judge *judge = r->study.judge;
    if (judge && judge->nests)
        return br_fail(
            err, BR_BAD_INPUT,
            "--reference: found '%s', expected a reference for any mesh and time step: exact or "
            "mms",
            judge->name);
    if (error == br_option_given(o, BR_OPT_SECONDS))
        return br_fail(err, BR_BAD_INPUT, "expected one of --error and --seconds, found %s",
                       error ? "both" : "none");
    if (br_opened_scene_read(&r->opened, r->session, o->word[0], err))
        return err->status;
    br_plan_default(p, &r->opened.scene);
    p->goal = (struct br_plan_goal){br_option_number(o, BR_OPT_ERROR, NAN),
                                    br_option_number(o, BR_OPT_SECONDS, NAN)};
    p->request.norm = r->study.norm[0];
    p->request.judge = judge;
    p->request.threads = r->session->threads;
    p->request.time_limit = br_option_number(o, BR_OPT_TIME_LIMIT, 0);
    if (r->study.methods.count)
        p->methods = r->study.methods;
    return BR_OK;
}

static enum br_status compute(struct run *r, struct br_error *err)
{
    const char *name = r->opened.scene.name;
    r->plan.request.observer = br_progress_start(name, r->session->quiet);
    const enum br_status status = br_plan_make(&r->plan, err);
    br_progress_end();
    if (!status)
        return br_progress_result(status, err);
    br_failed_in(err, name);
    return status == BR_BAD_INPUT && br_option_given(r->options, BR_OPT_ERROR)
               ? br_failed_in(err, "--error")
               : status;
}

static enum br_status write_all(struct run *r, struct br_error *err)
{
    const struct br_provenance provenance = br_provenance_of(&r->opened, r->session->threads);
    if (br_session_report(r->session, 1, err))
        return err->status;
    if (r->plan.chosen < r->plan.count)
        br_warn_of_trials(&r->opened.scene, &r->plan.trial[r->plan.chosen], 1);
    const struct br_plan *p = &r->plan;
    char *scene = br_session_scene(r->session, r->options->word[0]);
    if (!scene)
        return br_no_memory(err, "the scene");
    struct br_document *d = r->session->document;
    br_report_plan(p, scene, &provenance, d);
    free(scene);
    const struct br_drawn_trials drawn = {&p->methods, p->request.norm, p->trial,       p->count,
                                          p->chosen,   p->goal.error,   p->goal.seconds};
    const struct br_trade_picture *const *picture = br_trade_pictures;
    while (*picture && !br_trade_picture_applies(*picture, &drawn))
        picture++;
    if (*picture)
        br_session_draw(r->session, d, br_trade_draw(*picture, &drawn, d->name, d->caption),
                        (*picture)->title);
    const enum br_status status = br_session_finish(r->session, err);
    if (!status && r->plan.chosen == r->plan.count)
        return br_fail(err, BR_NOT_FINITE, "%s: none of the %zu trials reaches the goal",
                       r->opened.scene.name, r->plan.count);
    return status;
}

static enum br_status run(const struct br_options *options, struct br_session *session,
                          struct br_error *err)
{
    static struct run r; /* large: all methods */
    r = (struct run){.options = options, .session = session};
    bool failed = prepare(&r, err);
    if (!failed)
        failed = br_session_open(r.session, err) || compute(&r, err) || write_all(&r, err);
    br_plan_clear(&r.plan);
    br_opened_scene_clear(&r.opened);
    return failed ? err->status : BR_OK;
}

const struct br_command br_command_plan = {
    .bit = BR_FOR_PLAN,
    .name = "plan",
    .arguments = "SCENE",
    .title = "the cheapest way to an error, or the least error for some seconds",
    .about = "Finds the cheapest way to a relative error, or the least error for some seconds of "
             "the processor. Every method is tried on a grid of n and k (or tolerances), from the "
             "cheapest on, until nothing cheaper is left, and then on a finer grid around the "
             "best. All errors and times are measured. The result is the method with n and k, its "
             "error and seconds, and a command line that marches it.",
    .more = "One of --error and --seconds is needed. If no trial reaches the goal, the exit code "
            "is 3.",
    .example = {"beamrate plan example2 --error 1e-3",
                "beamrate plan example3 --error 1e-4 --methods bdf2,esdirk3,adaptive --out plan",
                "beamrate plan example2 --seconds 1e-3 --methods euler+implicit,adaptive"},
    .least_words = 1,
    .most_words = 1,
    .run = run,
};
