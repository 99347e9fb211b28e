/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tables/plan_emitter.h"

#include <math.h>

enum br_status br_plan_emit(const struct br_page_emitter *format, FILE *out,
                            const struct br_plan_page *page, struct br_error *err)
{
    struct br_page sheets;
    if (format == &br_page_csv)
        return br_plan_csv(out, page, err);
    if (format == &br_page_json)
        return br_plan_json(out, page, err);
    br_plan_fill(page, &sheets);
    return format->emit(out, &sheets, err);
}

double br_plan_step(const struct br_plan_page *page, const struct br_trial *t)
{
    return br_contender_adaptive(t->contender)
               ? NAN
               : br_time_step(page->plan->request.scene, t->at.steps);
}
