/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The list of a plan's trials. */
#include <math.h>
#include <string.h>

#include "study/trade/plan_steps.h"

double br_plan_y(const struct br_trial *t)
{
    return br_named_method_adaptive(t->named) ? -log(t->tolerance) : log((double)t->at.steps);
}

struct br_trial br_plan_trial(const struct br_plan_candidate *c)
{
    struct br_trial t = {.named = c->named, .at = {(size_t)(c->n + 0.5), BR_PLAN_LEVELS}};
    if (br_named_method_adaptive(c->named))
        t.tolerance = exp(-c->y);
    else
        t.at.steps = (size_t)(exp(c->y) + 0.5);
    return t;
}

static enum br_status grow(struct br_plan *p, struct br_error *err)
{
    const size_t capacity = p->capacity ? 2 * p->capacity : 256;
    struct br_trial *trial = br_allocate(capacity, sizeof *trial);
    struct br_plan_forecast *forecast = br_allocate(capacity, sizeof *forecast);
    if (!trial || !forecast) {
        free(trial);
        free(forecast);
        return br_no_memory(err, "the trials");
    }
    if (p->count) {
        memcpy(trial, p->trial, p->count * sizeof *trial);
        memcpy(forecast, p->forecast, p->count * sizeof *forecast);
    }
    free(p->trial);
    free(p->forecast);
    p->trial = trial;
    p->forecast = forecast;
    p->capacity = capacity;
    return BR_OK;
}

enum br_status br_plan_add(struct br_plan *p, const struct br_trial *trial,
                           const struct br_plan_forecast *forecast, bool *added,
                           struct br_error *err)
{
    *added = false;
    for (size_t i = 0; i < p->count; i++)
        if ((p->forecast[i].round > 0 || forecast->round == 0) &&
            p->trial[i].named == trial->named && p->trial[i].at.n == trial->at.n &&
            fabs(br_plan_y(&p->trial[i]) - br_plan_y(trial)) <= 1e-12)
            return BR_OK;
    if (p->count == p->capacity && grow(p, err))
        return BR_NO_MEMORY;
    p->trial[p->count] = *trial;
    p->forecast[p->count++] = *forecast;
    *added = true;
    return BR_OK;
}
