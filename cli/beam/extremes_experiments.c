/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The experiments of `extremes`, a function and a row each: study/extremes/ computes, tables/
 * reports and plots/ draws. */
#include "cli/beam/extremes_experiment.h"

#include "plots/beam/pictures.h"
#include "tables/beam/reports.h"

/* Round-off: a picture for each k of the solvers' floors, or one of the round-off that steps
 * gather. */
static enum br_status run_round_off(const struct br_extremes_job *job, bool gathered,
                                    const struct br_extremes_output *to, struct br_error *err)
{
    struct br_floors f = {0};
    const enum br_status status = br_floors_run(&f, gathered, job, err);
    if (!status) {
        br_report_floors(&f, to->report);
        br_floors_verdict(&f, to->verdict);
    }
    const size_t points = gathered ? f.k_count : f.n_count, pictures = gathered ? 1 : f.k_count;
    for (size_t i = 0; i < pictures && points > 1 && !status; i++)
        br_session_draw(to->session, to->report, br_floors_draw(&f, i), NULL);
    br_floors_clear(&f);
    return status;
}

static enum br_status run_floors(const struct br_extremes_job *job,
                                 const struct br_extremes_output *to, struct br_error *err)
{
    return run_round_off(job, false, to, err);
}

static enum br_status run_steps(const struct br_extremes_job *job,
                                const struct br_extremes_output *to, struct br_error *err)
{
    return run_round_off(job, true, to, err);
}

/* Where a scene breaks. */
static enum br_status run_stability(const struct br_extremes_job *job,
                                    const struct br_extremes_output *to, struct br_error *err)
{
    struct br_stability s = {0};
    const enum br_status status = br_stability_run(&s, job, err);
    if (!status) {
        br_report_stability(&s, to->report);
        br_stability_verdict(&s, to->verdict);
        br_session_draw(to->session, to->report, br_stability_draw(&s),
                        "Stable and unstable marches, and the largest stable k beside theory.");
    }
    br_stability_clear(&s);
    return status;
}

const struct br_extremes_experiment br_extremes_experiments[] = {
    {
        .name = "floors",
        .title = "round-off of every linear solver over n and k, measured and predicted",
        .accepts = BR_ACCEPTS(N) | BR_ACCEPTS(K),
        .scene = {"example2"},
        .run = run_floors,
    },
    {
        .name = "steps",
        .title = "round-off that 1 to 1e7 steps accumulate, measured and predicted; time levels",
        .accepts = BR_ACCEPTS(K),
        .scene = {"example1", "example2"},
        .run = run_steps,
    },
    {
        .name = "stability",
        .title = "where a scene breaks, over n and k and over c_H and k",
        .accepts = BR_ACCEPTS(N) | BR_ACCEPTS(K) | BR_ACCEPTS(METHODS),
        .scene = {"example2"},
        .run = run_stability,
    },
    {0},
};
