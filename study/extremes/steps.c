/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Round-off that steps gather, for every scheme, over the number of steps. */
#include "study/extremes/floors.h"

#include <float.h>
#include <stdio.h>

#include "study/scene/file.h"

static const char *const scenes[BR_DRIFT_SCENES] = {"example1", "example2"};
static const char *const solvers[] = {"riccati", "plain"}; /* others lose more in one step */
enum { SOLVERS = sizeof solvers / sizeof *solvers };
static const size_t usual_steps[] = {1, 10, 100, 1000, 10000, 100000, 1000000, 10000000};

/* By default, so that a minute or two is enough: schemes of several solves a step, of one, and, in
 * the scene that sticks, implicit Euler with implicit contact. */
static const size_t most_of_many = 100000, most_of_one = 1000000;

/* ---- what is measured ---- */

static void add_named_method(struct br_drifts *d, const char *scheme, const char *contact,
                             const char *solver)
{
    char name[BR_METHOD_NAME_SIZE];
    struct br_error ignored;
    snprintf(name, sizeof name, "%s+%s+%s", scheme, contact, solver);
    if (d->methods < BR_DRIFT_METHODS &&
        br_named_method_read(name, &d->named[d->methods], &ignored) == BR_OK)
        d->methods++;
}

static void add_named_methods(struct br_drifts *d)
{
    d->solvers = SOLVERS;
    for (const struct br_time_scheme *const *s = br_time_schemes; *s; s++)
        for (size_t c = 0; br_contact_rules[c]; c++)
            for (size_t i = 0; i < SOLVERS; i++)
                if (!(*s)->adaptive && ((*s)->may_lag || br_contact_rules[c]->at_new_step))
                    add_named_method(d, (*s)->name, br_contact_rules[c]->name, solvers[i]);
}

static enum br_status read_scenes(struct br_drifts *d, struct br_error *err)
{
    enum br_status status = BR_OK;
    for (size_t i = 0; i < BR_DRIFT_SCENES && !status; i++) {
        char path[1024];
        status = br_scene_find(scenes[i], path, sizeof path, err);
        if (!status)
            status = br_scene_read(path, &d->scene[i], err);
    }
    return status;
}

static enum br_status prepare(struct br_drifts *d, const struct br_drifts_plan *plan,
                              struct br_error *err)
{
    enum br_status status = read_scenes(d, err);
    if (status)
        return status;
    add_named_methods(d);
    for (size_t i = 0; i < d->methods; i++)
        d->named[i].method.rounding = plan->rounding;
    d->k_count = plan->k ? plan->k_count : sizeof usual_steps / sizeof *usual_steps;
    d->steps = br_allocate(d->k_count, sizeof *d->steps);
    d->drift = br_allocate(BR_DRIFT_SCENES * d->methods * d->k_count, sizeof *d->drift);
    if (!d->steps || !d->drift)
        return br_no_memory(err, "the drifts");
    for (size_t j = 0; j < d->k_count && !status; j++)
        if (plan->k)
            status = br_steps_of(&d->scene[0], plan->k[j], &d->steps[j], err);
        else
            d->steps[j] = usual_steps[j];
    return status;
}

void br_drifts_clear(struct br_drifts *d)
{
    for (size_t i = 0; i < BR_DRIFT_SCENES; i++)
        br_scene_clear(&d->scene[i]);
    free(d->steps);
    free(d->drift);
    *d = (struct br_drifts){0};
}

/* first: the named method that stands for its scheme and contact. */
static bool is_usual(const struct br_named_method *first, size_t scene, size_t steps)
{
    const struct br_method *m = &first->method;
    if (br_time_scheme_stages(m->scheme) > 1)
        return steps <= most_of_many;
    return steps <= most_of_one || (m->scheme->may_lag && m->contact->at_new_step && scene == 0);
}

/* A task for each scene, scheme and contact, and number of steps. Returns how many. */
static size_t list_tasks(struct br_drifts *d, bool chosen, struct br_floor_task *tasks)
{
    size_t count = 0;
    for (size_t scene = 0; scene < BR_DRIFT_SCENES; scene++)
        for (size_t first = 0; first < d->methods; first += d->solvers)
            for (size_t j = 0; j < d->k_count; j++)
                if (chosen || is_usual(&d->named[first], scene, d->steps[j]))
                    tasks[count++] = (struct br_floor_task){
                        .scene = &d->scene[scene],
                        .n = BR_DRIFT_N,
                        .steps = d->steps[j],
                        .taken = d->steps[j],
                        .by = &d->named[first],
                        .solvers = d->solvers,
                        .floor = &d->drift[(scene * d->methods + first) * d->k_count + j],
                        .stride = d->k_count};
    return count;
}

enum br_status br_drifts_run(struct br_drifts *d, const struct br_drifts_plan *plan,
                             const struct br_observer *observer, struct br_error *err)
{
    *d = (struct br_drifts){0};
    enum br_status status = prepare(d, plan, err);
    if (status)
        return status;
    struct br_floor_task *tasks =
        br_allocate(BR_DRIFT_SCENES * d->methods * d->k_count, sizeof *tasks);
    if (!tasks)
        return br_no_memory(err, "the drifts");
    status = br_floor_tasks_run(tasks, list_tasks(d, plan->k != NULL, tasks), plan->threads,
                                observer, err);
    free(tasks);
    return status;
}

/* ---- looking ---- */

const struct br_floor *br_drift_at(const struct br_drifts *d, size_t scene, size_t named, size_t k)
{
    return &d->drift[(scene * d->methods + named) * d->k_count + k];
}

static enum br_status check(const struct br_drifts *d, size_t scene, size_t named, size_t k,
                            struct br_error *err)
{
    const struct br_floor *drift = br_drift_at(d, scene, named, k);
    const char *name = d->named[named].name, *of = d->scene[scene].name;
    if (!drift->steps || drift->refused.status == BR_BAD_INPUT)
        return BR_OK; /* a step that is too long for the scheme is refused by rule */
    if (drift->refused.status)
        return br_fail(err, BR_VERDICT, "%s of %s in %zu steps: %.700s", name, of, drift->steps,
                       drift->refused.message);
    if (!(br_floor_deviation(drift) <= drift->predicted))
        return br_fail(err, BR_VERDICT,
                       "%s of %s in %zu steps: the round-off is %.2g, expected at most %.2g", name,
                       of, drift->steps, br_floor_deviation(drift), drift->predicted);
    if (!(drift->time_error <= DBL_EPSILON))
        return br_fail(err, BR_VERDICT,
                       "%s of %s in %zu steps: a time level is %.2g of the duration off, expected "
                       "at most %.2g",
                       name, of, drift->steps, drift->time_error, DBL_EPSILON);
    return BR_OK;
}

enum br_status br_drifts_verdict(const struct br_drifts *d, struct br_error *err)
{
    enum br_status status = BR_OK;
    for (size_t s = 0; s < BR_DRIFT_SCENES; s++)
        for (size_t c = 0; c < d->methods; c++)
            for (size_t k = 0; k < d->k_count && !status; k++)
                status = check(d, s, c, k, err);
    return status;
}
