/* SPDX-License-Identifier: GPL-3.0-or-later */
/* beamrate extremes map: thousands of cases at random, and none of them silently wrong. */
#include <stdio.h>

#include "cli/extremes_part.h"
#include "cli/provenance.h"
#include "plots/pictures.h"
#include "tables/report_extremes.h"

enum { CASES = 2000, SEED = 1 };

struct result {
    struct br_extreme_map map;
    struct br_extreme_counts counts;
};

static void release(void *result)
{
    struct result *r = result;
    if (!r)
        return;
    br_extreme_counts_clear(&r->counts);
    br_extreme_map_clear(&r->map);
    free(r);
}

static enum br_status run(const struct br_extremes_job *job, void **result, struct br_error *err)
{
    struct result *r = *result = br_allocate(1, sizeof *r);
    char program[300];
    if (!r)
        return br_no_memory(err, "the map");
    snprintf(program, sizeof program, "beamrate %s %s", br_version(), br_commit());
    const struct br_extreme_request request = {
        .seed = job->seed ? job->seed : SEED,
        .cases = job->cases ? job->cases : CASES,
        .threads = job->threads,
        .judging = {.rounding = job->rounding},
        .kept = job->kept,
        .program = program,
        .folder = job->folder,
        .observer = job->observer,
    };
    const enum br_status status = br_extreme_map_run(&request, &r->map, err);
    return status ? status : br_extreme_count(&r->map, &r->counts, err);
}

static void report(const void *result, struct br_document *d)
{
    const struct result *r = result;
    br_report_map(&r->map, &r->counts, d);
}

static enum br_status draw(const void *result, size_t i, struct br_figure *figure,
                           struct br_error *err)
{
    const struct result *r = result;
    return i == 0 ? br_extreme_map_draw(&r->map, figure, err) : BR_OK;
}

static enum br_status verdict(const void *result, struct br_error *err)
{
    const struct br_extreme_map *m = &((const struct result *)result)->map;
    const size_t wrong = m->count[BR_EXTREME_WRONG];
    return wrong ? br_fail(err, BR_VERDICT,
                           "%zu of %zu cases are silently wrong, the first of them: %s", wrong,
                           m->cases, m->shrunk[0].command)
                 : BR_OK;
}

const struct br_extremes_part br_extremes_part_map = {
    .name = "map",
    .title = "cases at random: right, inaccurate, unstable, refused, and none silently wrong",
    .heeds = BR_HEEDS_CASES | BR_HEEDS_SEED | BR_HEEDS_ROUNDING | BR_HEEDS_RESUME,
    .run = run,
    .free = release,
    .report = report,
    .draw = draw,
    .verdict = verdict,
};
