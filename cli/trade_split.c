/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/trade_split.h"

#include <string.h>

#include "cli/progress.h"
#include "cli/session.h"
#include "cli/study_request.h"
#include "cli/warn.h"
#include "plots/pictures.h"
#include "study/trade/named_method.h"
#include "study/trade/split.h"
#include "tables/reports.h"

struct run {
    struct br_session session;
    struct br_study_request request;
    struct br_opened_scene opened;
    size_t *steps;           /* step_count; owned */
    const double *tolerance; /* tolerances */
    size_t step_count, tolerances;
    struct br_split *split; /* splits; owned */
    size_t splits;
};

/* Without --methods the first scheme marches. */
static enum br_status read_request(struct run *r, struct br_error *err)
{
    const struct br_options *o = r->session.options;
    struct br_named_methods *methods = &r->request.methods;
    r->tolerance = o->number[BR_OPT_TOLERANCES];
    r->tolerances = o->count[BR_OPT_TOLERANCES];
    if (br_study_request_read(o, &r->request, err) ||
        (methods->count == 0 &&
         br_named_methods_read("--methods", br_time_schemes[0]->name, methods, err)))
        return err->status;
    return br_check_tolerances(o, methods, err);
}

/* ---- the runs: methods, then meshes, then time steps, then tolerances ---- */

enum { DEFAULT_N = 100, DEFAULT_STEPS = 1000 };

static void add_runs(struct run *r, const struct br_named_method *c, size_t n)
{
    const bool chosen = c->method.scheme->adaptive && r->tolerances;
    for (size_t j = 0; j < (r->step_count ? r->step_count : 1); j++)
        for (size_t t = 0; t < (chosen ? r->tolerances : 1); t++) {
            struct br_split *split = &r->split[r->splits++];
            *split = (struct br_split){
                .scene = &r->opened.scene,
                .method = c->method,
                .at = {n, r->step_count ? r->steps[j] : DEFAULT_STEPS},
                .norms = r->request.norms,
            };
            memcpy(split->norm, r->request.norm, sizeof split->norm);
            if (chosen)
                split->method.tolerance = r->tolerance[t];
        }
}

static enum br_status lay_out(struct run *r, struct br_error *err)
{
    const struct br_options *o = r->session.options;
    if (br_option_steps(o, &r->opened.scene, &r->steps, &r->step_count, err))
        return err->status;
    const size_t meshes = o->count[BR_OPT_N] ? o->count[BR_OPT_N] : 1;
    const size_t steps = r->step_count ? r->step_count : 1;
    const size_t tolerances = r->tolerances ? r->tolerances : 1;
    r->split =
        br_allocate(r->request.methods.count * meshes * steps * tolerances, sizeof *r->split);
    if (!r->split)
        return br_no_memory(err, "the parts of the errors");
    for (size_t c = 0; c < r->request.methods.count; c++)
        for (size_t i = 0; i < meshes; i++)
            add_runs(r, &r->request.methods.list[c],
                     o->count[BR_OPT_N] ? o->whole[BR_OPT_N][i] : DEFAULT_N);
    return BR_OK;
}

/* ---- computing ---- */

static enum br_status compute(struct run *r, struct br_error *err)
{
    struct br_observer_share share = {.whole = br_progress_start("splitting", r->session.quiet),
                                      .length = 1 / (double)r->splits};
    const struct br_observer observer = br_observer_of(&share);
    enum br_status status = BR_OK;
    for (size_t i = 0; i < r->splits && !status; i++) {
        share.from = (double)i * share.length;
        status = br_split_run(&r->split[i], r->session.threads, &observer, err);
    }
    br_progress_end();
    return br_progress_result(status, err);
}

/* ---- results ---- */

/* The picture is over k or h, where the runs differ by one of them. */
static enum br_status write_all(struct run *r, struct br_error *err)
{
    const struct br_provenance provenance = br_provenance_of(&r->opened, r->session.threads);
    if (br_session_report(&r->session, 1, err))
        return err->status;
    br_report_split(r->split, r->splits, &provenance, r->session.document);
    br_session_draw(&r->session, r->session.document, br_split_draw(r->split, r->splits), NULL);
    return br_session_finish(&r->session, err);
}

enum br_status br_trade_split(const struct br_options *options, struct br_error *err)
{
    struct run r = {.session = br_session_begin(options)};
    const bool writes = r.session.writes;
    const bool failed = read_request(&r, err) ||
                        br_opened_scene_read(&r.opened, options->word[0], err) ||
                        lay_out(&r, err) || br_session_open(&r.session, err) ||
                        (writes && br_warn_of_splits(r.split, r.splits, err)) || compute(&r, err) ||
                        (writes && write_all(&r, err));
    br_session_close(&r.session);
    br_opened_scene_clear(&r.opened);
    free(r.steps);
    free(r.split);
    return failed ? err->status : BR_OK;
}
