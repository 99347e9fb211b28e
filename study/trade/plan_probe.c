/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The cheap trials that the first models of a plan are made from. */
#include <math.h>

#include "study/trade/plan_steps.h"

static const size_t meshes[] = {2, 4, 12, 36, 108, 324, 972, 2916};

/* All of them on one mesh, every other one on the rest: steps that happen to end where the solution
 * switches are better than their neighbours. Many time levels in common spare the judge work. */
static const size_t steps[] = {10, 15, 20, 30, 40, 60, 80, 120, 160, 240};
static const size_t mesh_of_all_steps = 108;

static const double tolerances[] = {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10};

/* A solve costs as much as so many elements more than it has; a cheap trial's solves times elements
 * at most; solves of an adaptive scheme where they are not known yet. */
static const double overhead = 700, most_work = 5e5, guessed_solves = 150;

enum { MESHES = sizeof meshes / sizeof *meshes, STEPS = sizeof steps / sizeof *steps };
enum { TOLERANCES = sizeof tolerances / sizeof *tolerances };

static bool is_cheap(size_t n, double solves)
{
    return ((double)n + overhead) * solves <= most_work;
}

static enum br_status add(struct br_plan *plan, const struct br_trial *trial, struct br_error *err)
{
    bool added;
    return br_plan_add(plan, trial, &(struct br_plan_forecast){0, NAN, NAN}, &added, err);
}

static enum br_status add_fixed(struct br_plan *plan, const struct br_named_method *c, size_t n,
                                struct br_error *err)
{
    const double stages = br_time_scheme_stages(c->method.scheme);
    enum br_status status = BR_OK;
    for (size_t j = 0; j < STEPS && !status; j += n == mesh_of_all_steps ? 1 : 2)
        if (is_cheap(n, stages * (double)steps[j]))
            status = add(plan, &(struct br_trial){.named = c, .at = {n, steps[j]}}, err);
    return status;
}

static enum br_status add_adaptive(struct br_plan *plan, const struct br_named_method *c, size_t n,
                                   struct br_error *err)
{
    enum br_status status = BR_OK;
    for (size_t j = 0; j < TOLERANCES && !status; j += n == mesh_of_all_steps ? 1 : 3)
        if (is_cheap(n, guessed_solves))
            status = add(plan,
                         &(struct br_trial){
                             .named = c, .at = {n, BR_PLAN_LEVELS}, .tolerance = tolerances[j]},
                         err);
    return status;
}

enum br_status br_plan_add_probes(struct br_plan *plan, struct br_error *err)
{
    enum br_status status = BR_OK;
    for (size_t c = 0; c < plan->methods.count; c++)
        for (size_t i = 0; i < MESHES && !status; i++) {
            const struct br_named_method *one = &plan->methods.list[c];
            status = br_named_method_adaptive(one) ? add_adaptive(plan, one, meshes[i], err)
                                                   : add_fixed(plan, one, meshes[i], err);
        }
    return status;
}
