/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tables/plan_emitter.h"

#include <math.h>

extern const struct br_plan_emitter br_plan_text, br_plan_csv, br_plan_markdown, br_plan_latex,
    br_plan_json;

const struct br_plan_emitter *const br_plan_emitters[] = {
    &br_plan_text, &br_plan_csv, &br_plan_markdown, &br_plan_latex, &br_plan_json, NULL};

double br_plan_step(const struct br_plan_page *page, const struct br_trial *t)
{
    return br_contender_adaptive(t->contender)
               ? NAN
               : br_time_step(page->plan->request.scene, t->at.steps);
}
