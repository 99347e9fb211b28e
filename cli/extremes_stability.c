/* SPDX-License-Identifier: GPL-3.0-or-later */
/* beamrate extremes stability: the contact's stability limit, predicted and measured. */
#include "cli/extremes_part.h"
#include "plots/pictures.h"
#include "study/extremes/stability.h"
#include "tables/reports.h"

static void release(void *result)
{
    if (result)
        br_stability_clear(result);
    free(result);
}

static enum br_status run(const struct br_extremes_job *job, void **result, struct br_error *err)
{
    struct br_stability *s = *result = br_allocate(1, sizeof *s);
    if (!s)
        return br_no_memory(err, "the contact's stability");
    if (job->n_count > 1)
        return br_fail(err, BR_BAD_INPUT, "--n: found %zu numbers, expected one", job->n_count);
    const struct br_stability_request request = {
        .n = job->n_count ? job->n[0] : 0,
        .k = job->k,
        .k_count = job->k_count,
        .threads = job->threads,
        .observer = job->observer,
    };
    return br_stability_run(&request, s, err);
}

static void report(const void *result, struct br_document *d)
{
    br_report_stability(result, d);
}

static enum br_status draw(const void *result, size_t i, struct br_figure *figure,
                           struct br_error *err)
{
    return i == 0 ? br_stability_draw(result, figure, err) : BR_OK;
}

static enum br_status verdict(const void *result, struct br_error *err)
{
    return br_stability_verdict(result, err);
}

const struct br_extremes_part br_extremes_part_stability = {
    .name = "stability",
    .title = "the contact's stability limit over c_H and k, predicted and measured",
    .heeds = BR_HEEDS_N | BR_HEEDS_K,
    .run = run,
    .free = release,
    .report = report,
    .draw = draw,
    .verdict = verdict,
};
