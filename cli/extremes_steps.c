/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The part `steps`. */
#include "cli/extremes_part.h"
#include "plots/pictures.h"
#include "study/extremes/steps.h"
#include "tables/reports.h"

static void drifts_free(void *result)
{
    struct br_drifts *drifts = result;
    if (drifts)
        br_drifts_clear(drifts);
    free(drifts);
}

static enum br_status drifts_run(const struct br_extremes_job *job, void **result,
                                 struct br_error *err)
{
    const struct br_drifts_plan plan = {
        .k = job->k_count ? job->k : NULL,
        .k_count = job->k_count,
        .threads = job->threads,
        .rounding = job->rounding,
    };
    struct br_drifts *drifts = br_allocate(1, sizeof *drifts);
    *result = drifts;
    if (!drifts)
        return br_no_memory(err, "the drifts");
    return br_drifts_run(drifts, &plan, job->observer, err);
}

static void report(const void *result, struct br_document *d)
{
    br_report_drifts(result, d);
}

static enum br_status drifts_draw(const void *result, size_t i, struct br_figure *figure,
                                  struct br_error *err)
{
    const struct br_drifts *drifts = result;
    return i == 0 && drifts->k_count > 1 ? br_drifts_draw(drifts, figure, err) : BR_OK;
}

static enum br_status drifts_verdict(const void *result, struct br_error *err)
{
    return br_drifts_verdict(result, err);
}

const struct br_extremes_part br_extremes_part_steps = {
    .name = "steps",
    .title = "round-off that 1 to 1e7 steps gather, measured and predicted; time levels",
    .heeds = BR_HEEDS_K | BR_HEEDS_ROUNDING,
    .run = drifts_run,
    .free = drifts_free,
    .report = report,
    .draw = drifts_draw,
    .verdict = drifts_verdict,
};
