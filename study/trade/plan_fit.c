/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The models of a plan's named methods, from their trials. */
#include <math.h>

#include "study/trade/plan_steps.h"

void br_plan_forget(struct br_plan *p)
{
    for (size_t c = 0; c < p->methods.count; c++) {
        br_plan_model_clear(&p->model[c].error);
        p->model[c].known = false;
    }
}

/* What is seen of one named method's trials, in room for all. */
struct seen {
    struct br_plan_point *point;
    struct br_plan_work *work;
    size_t points, works;
};

static void see(const struct br_plan *p, const struct br_named_method *c, struct seen *seen)
{
    seen->points = seen->works = 0;
    for (size_t i = 0; i < p->count; i++) {
        const struct br_trial *t = &p->trial[i];
        const double error = br_trial_bound(t, 0), seconds = p->seconds(t);
        if (t->named != c)
            continue;
        if (error > 0 && isfinite(error))
            seen->point[seen->points++] =
                (struct br_plan_point){log((double)t->at.n), br_plan_y(t), error};
        if (seconds > 0 && isfinite(seconds) && t->cost.counts.stages > 0)
            seen->work[seen->works++] = (struct br_plan_work){
                (double)t->at.n, br_plan_y(t), (double)t->cost.counts.stages, seconds};
    }
}

/* The space error's order is 2 for elements of degree 1; of more it is measured. */
static enum br_status fit_one(struct br_plan *p, size_t c, struct seen *seen, struct br_error *err)
{
    const struct br_named_method *named = &p->methods.list[c];
    struct br_plan_models *m = &p->model[c];
    const double p_order = 1.0 + named->method.axial_degree;
    const double q = br_named_method_adaptive(named) ? 1 : named->method.scheme->order;
    see(p, named, seen);
    if (seen->points < 4 || seen->works == 0)
        return BR_OK;
    enum br_status status =
        br_plan_model_fit(&m->error, seen->point, seen->points, p_order, q, err);
    if (!status)
        status = br_plan_cost_fit(&m->cost, seen->work, seen->works, err);
    m->known = !status;
    return status == BR_NO_MEMORY ? status : BR_OK;
}

enum br_status br_plan_fit(struct br_plan *p, struct br_error *err)
{
    struct seen seen = {.point = br_allocate(p->count + 1, sizeof *seen.point),
                        .work = br_allocate(p->count + 1, sizeof *seen.work)};
    enum br_status status = seen.point && seen.work ? BR_OK : br_no_memory(err, "the models");
    br_plan_forget(p);
    for (size_t c = 0; c < p->methods.count && !status; c++)
        status = fit_one(p, c, &seen, err);
    free(seen.point);
    free(seen.work);
    return status;
}
