/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parts of `extremes`, a section and a row each: what study/extremes/ computes, tables/ reports
 * and plots/ draws. */
#include "cli/extremes_part.h"

#include <stdio.h>

#include "cli/provenance.h"
#include "plots/pictures.h"
#include "tables/report_extremes.h"

/* ---- floors: round-off of the linear solvers ---- */

static enum br_status floors_run(const struct br_extremes_job *job, void *result,
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
    return br_floors_run(result, &plan, job->observer, err);
}

/* One picture for each k. */
static enum br_status floors_draw(const void *result, size_t i, struct br_figure *figure,
                                  struct br_error *err)
{
    const struct br_floors *floors = result;
    return i < floors->k_count && floors->n_count > 1 ? br_floors_draw(floors, i, figure, err)
                                                      : BR_OK;
}

static void floors_clear(void *result)
{
    br_floors_clear(result);
}

static void floors_report(const void *result, struct br_document *d)
{
    br_report_floors(result, d);
}

static enum br_status floors_verdict(const void *result, struct br_error *err)
{
    return br_floors_verdict(result, err);
}

static const struct br_extremes_part floors = {
    .name = "floors",
    .title = "round-off of every linear solver over n and k, measured and predicted",
    .heeds = BR_HEEDS_N | BR_HEEDS_K | BR_HEEDS_ROUNDING,
    .size = sizeof(struct br_floors),
    .run = floors_run,
    .clear = floors_clear,
    .report = floors_report,
    .draw = floors_draw,
    .verdict = floors_verdict,
};

/* ---- steps: round-off that many steps gather ---- */

static enum br_status steps_run(const struct br_extremes_job *job, void *result,
                                struct br_error *err)
{
    const struct br_drifts_plan plan = {
        .k = job->k_count ? job->k : NULL,
        .k_count = job->k_count,
        .threads = job->threads,
        .rounding = job->rounding,
    };
    return br_drifts_run(result, &plan, job->observer, err);
}

static enum br_status steps_draw(const void *result, size_t i, struct br_figure *figure,
                                 struct br_error *err)
{
    const struct br_drifts *drifts = result;
    return i == 0 && drifts->k_count > 1 ? br_drifts_draw(drifts, figure, err) : BR_OK;
}

static void steps_clear(void *result)
{
    br_drifts_clear(result);
}

static void steps_report(const void *result, struct br_document *d)
{
    br_report_drifts(result, d);
}

static enum br_status steps_verdict(const void *result, struct br_error *err)
{
    return br_drifts_verdict(result, err);
}

static const struct br_extremes_part steps = {
    .name = "steps",
    .title = "round-off that 1 to 1e7 steps gather, measured and predicted; time levels",
    .heeds = BR_HEEDS_K | BR_HEEDS_ROUNDING,
    .size = sizeof(struct br_drifts),
    .run = steps_run,
    .clear = steps_clear,
    .report = steps_report,
    .draw = steps_draw,
    .verdict = steps_verdict,
};

/* ---- stability: the lagged contact's limit ---- */

static enum br_status stability_run(const struct br_extremes_job *job, void *result,
                                    struct br_error *err)
{
    const struct br_stability_request request = {
        .n = job->n_count ? job->n[0] : 0,
        .k = job->k,
        .k_count = job->k_count,
        .threads = job->threads,
        .observer = job->observer,
    };
    if (job->n_count > 1)
        return br_fail(err, BR_BAD_INPUT, "--n: found %zu numbers, expected one", job->n_count);
    return br_stability_run(&request, result, err);
}

static enum br_status stability_draw(const void *result, size_t i, struct br_figure *figure,
                                     struct br_error *err)
{
    return i == 0 ? br_stability_draw(result, figure, err) : BR_OK;
}

static void stability_clear(void *result)
{
    br_stability_clear(result);
}

static void stability_report(const void *result, struct br_document *d)
{
    br_report_stability(result, d);
}

static enum br_status stability_verdict(const void *result, struct br_error *err)
{
    return br_stability_verdict(result, err);
}

static const struct br_extremes_part stability = {
    .name = "stability",
    .title = "the contact's stability limit over c_H and k, predicted and measured",
    .heeds = BR_HEEDS_N | BR_HEEDS_K,
    .size = sizeof(struct br_stability),
    .run = stability_run,
    .clear = stability_clear,
    .report = stability_report,
    .draw = stability_draw,
    .verdict = stability_verdict,
};

/* ---- energy: what every scheme takes from it or adds to it ---- */

static enum br_status energy_run(const struct br_extremes_job *job, void *result,
                                 struct br_error *err)
{
    return br_energy_behaviour_run(result, job->threads, job->observer, err);
}

static enum br_status energy_draw(const void *result, size_t i, struct br_figure *figure,
                                  struct br_error *err)
{
    return i == 0 ? br_energy_draw(result, figure, err) : BR_OK;
}

static enum br_status energy_verdict(const void *result, struct br_error *err)
{
    const struct br_energy_behaviour *b = result;
    for (size_t i = 0; i < b->vibrations; i++)
        if (!br_vibration_row_is_right(&b->vibration[i]))
            return br_fail(err, BR_VERDICT,
                           "scheme %s does not take from a free vibration what its stability "
                           "function tells, or a step's balance does not close",
                           b->vibration[i].scheme->name);
    for (size_t i = 0; i < b->balances; i++)
        if (!br_balance_row_is_right(&b->balance[i]))
            return br_fail(err, BR_VERDICT,
                           "%s by scheme %s: what is missing in the energy balance of a step is "
                           "%.3g of the terms' sum, expected at most %.3g",
                           br_balance_scenes[b->balance[i].scene], b->balance[i].scheme->name,
                           b->balance[i].worst, b->balance[i].limit);
    return BR_OK;
}

static void energy_clear(void *result)
{
    br_energy_behaviour_clear(result);
}

static void energy_report(const void *result, struct br_document *d)
{
    br_report_energy(result, d);
}

static const struct br_extremes_part energy = {
    .name = "energy",
    .title = "what every scheme takes from the energy or adds to it, each step's balance",
    .size = sizeof(struct br_energy_behaviour),
    .run = energy_run,
    .clear = energy_clear,
    .report = energy_report,
    .draw = energy_draw,
    .verdict = energy_verdict,
};

/* ---- map: thousands of cases at random, and none of them silently wrong ---- */

enum { CASES = 2000, SEED = 1 };

struct map {
    struct br_extreme_map map;
    struct br_extreme_counts counts;
};

static enum br_status map_run(const struct br_extremes_job *job, void *result, struct br_error *err)
{
    struct map *m = result;
    char program[300];
    snprintf(program, sizeof program, "beamrate %s %s", br_version(), br_commit());
    const struct br_extreme_wish wish = {
        .seed = job->seed ? job->seed : SEED,
        .cases = job->cases ? job->cases : CASES,
        .threads = job->threads,
        .court = {.rounding = job->rounding},
        .kept = job->kept,
        .program = program,
        .folder = job->folder,
        .observer = job->observer,
    };
    const enum br_status status = br_extreme_map_run(&wish, &m->map, err);
    return status ? status : br_extreme_count(&m->map, &m->counts, err);
}

static void map_clear(void *result)
{
    struct map *m = result;
    br_extreme_counts_clear(&m->counts);
    br_extreme_map_clear(&m->map);
}

static void map_report(const void *result, struct br_document *d)
{
    const struct map *m = result;
    br_report_map(&m->map, &m->counts, d);
}

static enum br_status map_draw(const void *result, size_t i, struct br_figure *figure,
                               struct br_error *err)
{
    const struct map *m = result;
    return i == 0 ? br_extreme_map_draw(&m->map, figure, err) : BR_OK;
}

static enum br_status map_verdict(const void *result, struct br_error *err)
{
    const struct br_extreme_map *m = &((const struct map *)result)->map;
    const size_t wrong = m->count[BR_EXTREME_WRONG];
    return wrong ? br_fail(err, BR_VERDICT,
                           "%zu of %zu cases are silently wrong, the first of them: %s", wrong,
                           m->cases, m->shrunk[0].command)
                 : BR_OK;
}

static const struct br_extremes_part map = {
    .name = "map",
    .title = "cases at random: right, inaccurate, unstable, refused, and none silently wrong",
    .heeds = BR_HEEDS_CASES | BR_HEEDS_SEED | BR_HEEDS_ROUNDING | BR_HEEDS_RESUME,
    .size = sizeof(struct map),
    .run = map_run,
    .clear = map_clear,
    .report = map_report,
    .draw = map_draw,
    .verdict = map_verdict,
};

const struct br_extremes_part *const br_extremes_parts[] = {&floors, &steps, &stability,
                                                            &energy, &map,   NULL};
