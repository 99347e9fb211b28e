/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The experiments of `extremes`, a function and a row each: study/extremes/ computes, tables/
 * reports and plots/ draws. */
#include "cli/extremes_experiment.h"

#include "plots/pictures.h"
#include "study/extremes/map.h"
#include "tables/reports.h"

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

/* The lagged contact's limit. */
static enum br_status run_stability(const struct br_extremes_job *job,
                                    const struct br_extremes_output *to, struct br_error *err)
{
    struct br_stability s = {0};
    const enum br_status status = br_stability_run(&s, job, err);
    if (!status) {
        br_report_stability(&s, to->report);
        br_stability_verdict(&s, to->verdict);
        br_session_draw(to->session, to->report, br_stability_draw(&s), NULL);
    }
    br_stability_clear(&s);
    return status;
}

static enum br_status judge_energy(const struct br_energy_behaviour *b, struct br_error *err)
{
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
                           b->balance[i].scene->name, b->balance[i].scheme->name,
                           b->balance[i].worst, b->balance[i].limit);
    return BR_OK;
}

/* What every scheme takes from the energy or adds to it. */
static enum br_status run_energy(const struct br_extremes_job *job,
                                 const struct br_extremes_output *to, struct br_error *err)
{
    struct br_energy_behaviour b = {0};
    const enum br_status status = br_energy_behaviour_run(&b, job, err);
    if (!status) {
        br_report_energy(&b, to->report);
        judge_energy(&b, to->verdict);
        br_session_draw(to->session, to->report, br_energy_draw(&b), NULL);
    }
    br_energy_behaviour_clear(&b);
    return status;
}

/* Thousands of cases at random, and none of them silently wrong. */
static enum br_status run_map(const struct br_extremes_job *job,
                              const struct br_extremes_output *to, struct br_error *err)
{
    struct br_extreme_map map = {0};
    const enum br_status status = br_extreme_map_run(&map, job, br_extreme_judge, err);
    if (!status) {
        br_report_map(&map, to->report);
        if (map.count[BR_EXTREME_WRONG])
            br_fail(to->verdict, BR_VERDICT,
                    "%zu of %zu cases are silently wrong, the first of them: %s",
                    map.count[BR_EXTREME_WRONG], map.cases, map.shrunk[0].command);
        br_session_draw(to->session, to->report, br_extreme_map_draw(&map), NULL);
    }
    br_extreme_map_clear(&map);
    return status;
}

const struct br_extremes_experiment br_extremes_experiments[] = {
    {
        .name = "floors",
        .title = "round-off of every linear solver over n and k, measured and predicted",
        .accepts = BR_ACCEPTS(N) | BR_ACCEPTS(K) | BR_ACCEPTS(ROUNDING),
        .run = run_floors,
    },
    {
        .name = "steps",
        .title = "round-off that 1 to 1e7 steps gather, measured and predicted; time levels",
        .accepts = BR_ACCEPTS(K) | BR_ACCEPTS(ROUNDING),
        .run = run_steps,
    },
    {
        .name = "stability",
        .title = "the contact's stability limit over c_H and k, predicted and measured",
        .accepts = BR_ACCEPTS(N) | BR_ACCEPTS(K),
        .run = run_stability,
    },
    {
        .name = "energy",
        .title = "what every scheme takes from the energy or adds to it, each step's balance",
        .run = run_energy,
    },
    {
        .name = "map",
        .title = "cases at random: right, inaccurate, unstable, refused, and none silently wrong",
        .accepts = BR_ACCEPTS(CASES) | BR_ACCEPTS(SEED) | BR_ACCEPTS(ROUNDING) | BR_ACCEPTS(RESUME),
        .run = run_map,
    },
    {0},
};
