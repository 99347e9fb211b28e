/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The part `floors`. */
#include "cli/extremes_part.h"
#include "plots/pictures.h"
#include "study/extremes/floors.h"
#include "tables/reports.h"

static void floors_free(void *result)
{
    struct br_floors *floors = result;
    if (floors)
        br_floors_clear(floors);
    free(floors);
}

static enum br_status floors_run(const struct br_extremes_job *job, void **result,
                                 struct br_error *err)
{
    const struct br_floors_plan plan = {
        .n = job->n_count ? job->n : NULL,
        .k = job->k_count ? job->k : NULL,
        .n_count = job->n_count,
        .k_count = job->k_count,
        .threads = job->threads,
        .rounding = job->rounding,
    };
    struct br_floors *floors = br_allocate(1, sizeof *floors);
    *result = floors;
    if (!floors)
        return br_no_memory(err, "the floors");
    return br_floors_run(floors, &plan, job->observer, err);
}

static void report(const void *result, struct br_document *d)
{
    br_report_floors(result, d);
}

static enum br_status floors_draw(const void *result, size_t i, struct br_figure *figure,
                                  struct br_error *err)
{
    const struct br_floors *floors = result;
    return i < floors->k_count && floors->n_count > 1 ? br_floors_draw(floors, i, figure, err)
                                                      : BR_OK;
}

static enum br_status floors_verdict(const void *result, struct br_error *err)
{
    return br_floors_verdict(result, err);
}

const struct br_extremes_part br_extremes_part_floors = {
    .name = "floors",
    .title = "round-off of every linear solver over n and k, measured and predicted",
    .heeds = BR_HEEDS_N | BR_HEEDS_K | BR_HEEDS_ROUNDING,
    .run = floors_run,
    .free = floors_free,
    .report = report,
    .draw = floors_draw,
    .verdict = floors_verdict,
};
