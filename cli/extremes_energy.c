/* SPDX-License-Identifier: GPL-3.0-or-later */
/* `beamrate extremes energy` */
#include <stdlib.h>

#include "cli/extremes_part.h"
#include "plots/pictures.h"
#include "study/extremes/energy_behaviour.h"
#include "tables/reports.h"

static void release(void *result)
{
    if (result)
        br_energy_behaviour_clear(result);
    free(result);
}

static enum br_status run(const struct br_extremes_job *job, void **result, struct br_error *err)
{
    struct br_energy_behaviour *b = *result = br_allocate(1, sizeof *b);
    if (!b)
        return br_no_memory(err, "the part energy");
    return br_energy_behaviour_run(b, job->threads, job->observer, err);
}

static void report(const void *result, struct br_document *d)
{
    br_report_energy(result, d);
}

static enum br_status draw(const void *result, size_t i, struct br_figure *figure,
                           struct br_error *err)
{
    return i == 0 ? br_energy_draw(result, figure, err) : BR_OK;
}

static enum br_status judge(const void *result, struct br_error *err)
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

const struct br_extremes_part br_extremes_part_energy = {
    .name = "energy",
    .title = "what every scheme takes from the energy or adds to it, each step's balance",
    .run = run,
    .free = release,
    .report = report,
    .draw = draw,
    .verdict = judge,
};
