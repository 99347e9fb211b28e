/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/extremes/steps.h"

#include "reference/discrete.h"
#include "study/grid/observer.h"
#include "study/grid/threads.h"
#include "study/scene/file.h"
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { N = BR_DRIFT_N };

static const char *const scenes[BR_DRIFT_SCENES] = {"example1", "example2"};
static const char *const solvers[] = {"riccati", "plain"}; /* others lose more in one step */
enum { SOLVERS = sizeof solvers / sizeof *solvers };
static const size_t usual_steps[] = {1, 10, 100, 1000, 10000, 100000, 1000000, 10000000};

/* By default, so that a minute or two is enough: schemes of several solves a step, of one, and, in
 * the scene that sticks, implicit Euler with implicit contact. */
static const size_t most_of_many = 100000, most_of_one = 1000000;

/* ---- what is measured ---- */

static void add_contender(struct br_drifts *d, const char *scheme, const char *contact,
                          const char *solver)
{
    char name[BR_CONTENDER_NAME];
    struct br_error ignored;
    snprintf(name, sizeof name, "%s+%s+%s", scheme, contact, solver);
    if (d->contenders < BR_DRIFT_CONTENDERS &&
        br_contender_read(name, &d->contender[d->contenders], &ignored) == BR_OK)
        d->contenders++;
}

static void add_contenders(struct br_drifts *d)
{
    d->solvers = SOLVERS;
    for (const struct br_time_scheme *const *s = br_time_schemes; *s; s++)
        for (size_t c = 0; br_contact_rules[c]; c++)
            for (size_t i = 0; i < SOLVERS; i++)
                if (!(*s)->adaptive && ((*s)->may_lag || br_contact_rules[c]->at_new_step))
                    add_contender(d, (*s)->name, br_contact_rules[c]->name, solvers[i]);
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
    if (!br_discrete_judges())
        return br_fail(err, BR_UNSUPPORTED,
                       "long double has no more digits than double on this machine: there is "
                       "nothing to measure round-off by");
    enum br_status status = read_scenes(d, err);
    if (status)
        return status;
    add_contenders(d);
    for (size_t i = 0; i < d->contenders; i++)
        d->contender[i].method.rounding = plan->rounding;
    d->k_count = plan->k ? plan->k_count : sizeof usual_steps / sizeof *usual_steps;
    d->steps = br_allocate(d->k_count, sizeof *d->steps);
    d->drift = br_allocate(BR_DRIFT_SCENES * d->contenders * d->k_count, sizeof *d->drift);
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

/* ---- a measurement: one scene, scheme and contact, and number of steps; all solvers ---- */

struct task {
    struct br_drifts *drifts;
    size_t scene, first, j; /* first: contender */
    long double exact[2][2 * (N + 1)];
    const struct br_observer *observer;
};

/* Looked at every so many steps. */
static bool stopped(const struct br_observer *o, size_t step)
{
    return step % 4096 == 0 && o && o->stop && o->stop(o->self);
}

static enum br_status interrupted(struct br_error *err)
{
    return br_fail(err, BR_INTERRUPTED, "interrupted");
}

static enum br_status find_exact(struct task *t, size_t steps, struct br_error *err)
{
    const struct br_drifts *d = t->drifts;
    struct br_discrete *exact;
    enum br_status status = br_discrete_create(&exact, &d->scene[t->scene], N, steps,
                                               &d->contender[t->first].method, err);
    for (size_t i = 0; i < steps && !status; i++)
        status = stopped(t->observer, i) ? interrupted(err) : br_discrete_step(exact, err);
    for (int kind = BR_AXIAL; kind <= BR_BENDING && !status; kind++)
        br_discrete_get(exact, (enum br_field_kind)kind, t->exact[kind], NULL);
    br_discrete_free(exact);
    return status;
}

static double compare(const struct task *t, const struct br_march *march, enum br_field_kind kind)
{
    const size_t stride = kind == BR_AXIAL ? 1 : 2;
    double w[2 * (N + 1)];
    long double most = 0, largest = 0;
    br_march_get(march, kind, w, NULL);
    for (size_t i = 0; i <= stride * N; i += stride) {
        const long double error = fabsl(t->exact[kind][i] - w[i]);
        largest = fmaxl(largest, fabsl(t->exact[kind][i]));
        most = isnan(most) || error <= most ? most : error;
    }
    return (double)(most / largest);
}

/* How far the time told is from i T/N, which long double has to 64 bits. */
static double time_error(const struct br_scene *scene, const struct br_march *march, size_t i,
                         size_t steps)
{
    const long double exact = (long double)scene->duration * (long double)i / (long double)steps;
    return (double)fabsl(br_march_time(march) - exact) / scene->duration;
}

static enum br_status measure(struct task *t, const struct br_method *method, size_t steps,
                              struct br_drift *drift, struct br_error *err)
{
    const struct br_scene *scene = &t->drifts->scene[t->scene];
    struct br_march *march;
    bool stop = false;
    enum br_status status = br_march_create(&march, scene, N, steps, method, &drift->refused);
    for (size_t i = 0; i < steps && !status && !stop; i++) {
        stop = stopped(t->observer, i);
        status = br_march_step(march, &drift->refused);
        drift->time_error = fmax(drift->time_error, time_error(scene, march, i + 1, steps));
    }
    if (march)
        drift->predicted = br_march_round_off(march);
    for (int kind = BR_AXIAL; kind <= BR_BENDING && !status; kind++)
        drift->deviation[kind] = compare(t, march, (enum br_field_kind)kind);
    br_march_free(march);
    return stop ? interrupted(err) : BR_OK;
}

static bool is_usual(const struct task *t, size_t steps)
{
    const struct br_method *m = &t->drifts->contender[t->first].method;
    if (br_time_scheme_stages(m->scheme) > 1)
        return steps <= most_of_many;
    return steps <= most_of_one || (m->scheme->may_lag && m->contact->at_new_step && t->scene == 0);
}

static enum br_status run_task(struct task *t, bool chosen, struct br_error *err)
{
    struct br_drifts *d = t->drifts;
    const size_t steps = d->steps[t->j];
    struct br_drift *drift = &d->drift[(t->scene * d->contenders + t->first) * d->k_count + t->j];
    if (!chosen && !is_usual(t, steps))
        return BR_OK;
    enum br_status status = find_exact(t, steps, err);
    for (size_t s = 0; s < d->solvers && !status; s++, drift += d->k_count) {
        *drift = (struct br_drift){.steps = steps, .deviation = {NAN, NAN}, .predicted = NAN};
        status = measure(t, &d->contender[t->first + s].method, steps, drift, err);
    }
    return status;
}

/* Task number i, the most steps first. */
static struct task task_of(struct br_drifts *d, size_t i)
{
    const size_t marches = d->contenders / d->solvers, each = marches * BR_DRIFT_SCENES;
    struct task t = {
        .drifts = d, .scene = i % each / marches, .first = i % marches * d->solvers, .j = 0};
    for (size_t rank = i / each; t.j < d->k_count; t.j++) {
        size_t more = 0;
        for (size_t other = 0; other < d->k_count; other++)
            more += d->steps[other] > d->steps[t.j] ||
                    (d->steps[other] == d->steps[t.j] && other < t.j);
        if (more == rank)
            break;
    }
    return t;
}

enum br_status br_drifts_run(struct br_drifts *d, const struct br_drifts_plan *plan,
                             const struct br_observer *observer, struct br_error *err)
{
    *d = (struct br_drifts){0};
    const enum br_status status = prepare(d, plan, err);
    if (status)
        return status;
    const size_t tasks = BR_DRIFT_SCENES * (d->contenders / d->solvers) * d->k_count;
    struct br_error first = {0};
    double done = 0, all = 0;
    const int threads = br_threads(plan->threads);
    for (size_t i = 0; i < tasks; i++)
        all += (double)d->steps[task_of(d, i).j];
    (void)threads;
#pragma omp parallel for schedule(dynamic) num_threads(threads)
    for (size_t i = 0; i < tasks; i++) {
        struct br_error failure = {0};
        struct task t = task_of(d, i);
        t.observer = observer;
        run_task(&t, plan->k != NULL, &failure);
#pragma omp critical(drifts)
        {
            if (failure.status && !first.status)
                first = failure;
            done += (double)d->steps[t.j];
            if (observer && observer->progress)
                observer->progress(observer->self, done / all);
        }
    }
    return first.status ? br_fail(err, first.status, "%s", first.message) : BR_OK;
}

/* ---- looking ---- */

const struct br_drift *br_drift_at(const struct br_drifts *d, size_t scene, size_t contender,
                                   size_t k)
{
    return &d->drift[(scene * d->contenders + contender) * d->k_count + k];
}

double br_drift_deviation(const struct br_drift *drift)
{
    const double *d = drift->deviation;
    return isnan(d[0]) || d[0] > d[1] ? d[0] : d[1];
}

static enum br_status check(const struct br_drifts *d, size_t scene, size_t contender, size_t k,
                            struct br_error *err)
{
    const struct br_drift *drift = br_drift_at(d, scene, contender, k);
    const char *name = d->contender[contender].name, *of = d->scene[scene].name;
    if (!drift->steps || drift->refused.status == BR_BAD_INPUT)
        return BR_OK; /* a step that is too long for the scheme is refused by rule */
    if (drift->refused.status)
        return br_fail(err, BR_VERDICT, "%s of %s in %zu steps: %.700s", name, of, drift->steps,
                       drift->refused.message);
    if (!(br_drift_deviation(drift) <= drift->predicted))
        return br_fail(err, BR_VERDICT,
                       "%s of %s in %zu steps: the round-off is %.2g, expected at most %.2g", name,
                       of, drift->steps, br_drift_deviation(drift), drift->predicted);
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
        for (size_t c = 0; c < d->contenders; c++)
            for (size_t k = 0; k < d->k_count && !status; k++)
                status = check(d, s, c, k, err);
    return status;
}
