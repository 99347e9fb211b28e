/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One line a trial, the cheap ones (round 0) among them; a number that is not there is an empty
 * field (RFC 4180). */
#include <math.h>

#include "tables/plan_emitter.h"

static void field(FILE *out, const char *format, double value)
{
    fputc(',', out);
    if (isfinite(value))
        fprintf(out, format, value);
}

static void print_trial(FILE *out, const struct br_plan_page *page, size_t i)
{
    const struct br_plan *p = page->plan;
    const struct br_trial *t = &p->trial[i];
    const struct br_counts *c = &t->cost.counts;
    fprintf(out, "%zu,%s,%zu,%zu", p->forecast[i].round, t->contender->name, t->at.n, t->at.steps);
    field(out, "%.15g", br_plan_step(page, t));
    field(out, "%.15g", br_contender_adaptive(t->contender) ? t->tolerance : NAN);
    field(out, "%.10g", p->forecast[i].error);
    field(out, "%.10g", br_trial_bound(t, 0));
    field(out, "%.6g", p->forecast[i].seconds);
    field(out, "%.6g", p->seconds(t));
    fprintf(out, ",%zu,%zu,%zu,%s,%d\n", c->steps, c->stages, c->set_ups, br_trial_end_name(t->end),
            i == p->chosen);
}

enum br_status br_plan_csv(FILE *out, const struct br_plan_page *page, struct br_error *err)
{
    (void)err;
    fputs("round,method,n,steps_or_levels,k,tolerance,predicted_error,relative_error,"
          "predicted_seconds,seconds,steps,solves,set_ups,end,chosen\n",
          out);
    for (size_t i = 0; i < page->plan->count; i++)
        print_trial(out, page, i);
    return BR_OK;
}
