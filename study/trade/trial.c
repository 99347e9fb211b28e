/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/trade/trial.h"

#include <math.h>
#include <string.h>

#include "base/clock.h"
#include "base/each.h"
#include "study/fit/fit.h"
#include "study/grid/costs.h"
#include "study/grid/sweep.h"

const char *const br_trial_end_names[BR_TRIAL_ENDS] = {
    [BR_TRIAL_DONE] = "done",         [BR_TRIAL_DOUBTFUL] = "doubtful",
    [BR_TRIAL_UNSTABLE] = "unstable", [BR_TRIAL_OVER] = "over limit",
    [BR_TRIAL_FAILED] = "failed",     [BR_TRIAL_LEFT] = "left out"};

struct br_trial br_trial_at(const struct br_named_method *named, size_t n, size_t steps,
                            double tolerance)
{
    if (named->method.scheme->adaptive)
        return (struct br_trial){
            .named = named, .at = {n, BR_TRIAL_LEVELS}, .tolerance = tolerance};
    return (struct br_trial){.named = named, .at = {n, steps}};
}

struct br_trial_request br_trial_request_default(const struct br_scene *scene)
{
    return (struct br_trial_request){
        .scene = scene,
        .reference_method = br_method_default(),
        .norm = br_norms[0],
        .repeats = 3,
        .repeat_seconds = 0.01,
        .time_limit = 10,
    };
}

/* ---- seconds ---- */

/* Element-steps between two readings of the clock; a reading takes some 0.3 us. */
static const double between_readings = 1e5;

/* A trial that is being marched. */
struct clocked {
    struct br_trial *trial;
    const struct br_trial_request *request;
    struct br_march *march;
    double set_up; /* s */
    double start;  /* of its steps, s of this thread */
    size_t every;  /* steps between two readings of the clock */
    size_t asked;  /* steps of an adaptive scheme since the last reading */
};

/* Equal steps cost the same, so that some of them show the time of all. A rule that iterates does
 * not. The error is measured in a march of its own, which need not be timed. */
static bool is_even(const struct br_method *m)
{
    return !m->scheme->adaptive && !m->friction->iterates;
}

/* Seconds of the whole march with its set-up, as far as its steps show. */
static double estimated(const struct clocked *c)
{
    const double steps = br_thread_seconds() - c->start;
    const double done = (double)br_march_steps_done(c->march), all = (double)c->trial->at.steps;
    return c->set_up + steps * (is_even(&c->trial->named->method) && done > 0 ? all / done : 1);
}

static bool is_over(const struct clocked *c)
{
    return c->request->time_limit > 0 && !(estimated(c) <= c->request->time_limit);
}

/* Asked by br_march_step within the steps of an adaptive scheme. */
static bool stops(void *self)
{
    struct clocked *c = self;
    if (++c->asked < c->every)
        return false;
    c->asked = 0;
    return br_observer_stops(c->request->observer) || is_over(c);
}

/* Ends a march that takes too long. */
static enum br_status check_clock(struct clocked *c, struct br_error *err)
{
    if (br_observer_stops(c->request->observer))
        return br_fail(err, BR_INTERRUPTED, "interrupted");
    if (!is_over(c))
        return BR_OK;
    c->trial->end = BR_TRIAL_OVER;
    return br_fail(&c->trial->failure, BR_VERDICT,
                   "over the time limit of %g s: at least %.2g s, by %zu of %zu time levels",
                   c->request->time_limit, estimated(c), br_march_steps_done(c->march),
                   c->trial->at.steps);
}

/* Marches to the end, or as many equal steps as show the time of all. */
static enum br_status make_steps(struct clocked *c, struct br_error *err)
{
    const struct br_method *m = &c->trial->named->method;
    const size_t steps = c->trial->at.steps;
    enum br_status status = BR_OK;
    bool enough = false;
    for (size_t i = 1; i <= steps && !enough && !status; i++) {
        status = br_march_step(c->march, &c->trial->failure);
        if (status && status != BR_INTERRUPTED)
            return status;
        const bool reads = i % c->every == 0 || i == steps || m->scheme->adaptive || status;
        enough = reads && is_even(m) && br_thread_seconds() - c->start > c->request->repeat_seconds;
        if (enough || i == steps || (reads && !is_even(m))) {
            const enum br_status said = check_clock(c, err);
            status = said ? said : status;
        }
    }
    return status;
}

/* A difference of two readings in the clock's own digits: which of two equal times is less may not
 * follow the last bit. */
static double between(double begin, double end)
{
    return round(1e9 * (end - begin)) / 1e9;
}

/* Marches once, until the end or the time limit; *cost (out). Fails as the march does, with the
 * reason in t->failure; with BR_VERDICT, where t->end is BR_TRIAL_OVER; or with BR_INTERRUPTED. */
static enum br_status march(struct br_trial *t, const struct br_trial_request *r,
                            struct br_trial_cost *cost, struct br_error *err)
{
    struct clocked c = {
        .trial = t, .request = r, .every = 1 + (size_t)(between_readings / (double)t->at.n)};
    const struct br_method method = br_trial_method(t);
    const struct br_planned_march planned = br_planned(r->scene, &method, t->at);
    *cost = (struct br_trial_cost){.set_up = NAN, .march = NAN};
    enum br_status status = br_fits_memory(&planned, br_memory_available(), &t->failure);
    c.start = br_thread_seconds();
    if (!status)
        status = br_march_create(&c.march, r->scene, t->at.n, t->at.steps, &method, &t->failure);
    if (status)
        return status;
    const double begin = br_thread_seconds();
    cost->set_up = c.set_up = between(c.start, begin);
    c.start = begin;
    br_march_stop_when(c.march, stops, &c);
    status = make_steps(&c, err);
    cost->march = between(begin, br_thread_seconds());
    cost->counts = br_march_counts(c.march);
    const size_t done = br_march_steps_done(c.march), others = t->at.steps - done;
    if (!status && others) {
        cost->march *= (double)t->at.steps / (double)done;
        cost->counts.steps += others;
        cost->counts.stages += others * (size_t)br_time_scheme_stages(method.scheme);
    }
    br_march_free(c.march);
    return status;
}

/* The first march warms up; it counts only where it takes so long that it is not repeated. */
static enum br_status repeat(struct br_trial *t, const struct br_trial_request *r,
                             struct br_error *err)
{
    struct br_trial_cost least = {.set_up = INFINITY}, now;
    enum br_status status = BR_OK;
    bool warm = false;
    for (double spent = 0;
         !status && (!warm || (least.repeats < r->repeats && spent <= r->repeat_seconds));) {
        status = march(t, r, &now, err);
        const double seconds = now.set_up + now.march;
        const bool counts = warm || !(seconds <= r->repeat_seconds);
        warm = true;
        if (!counts)
            continue;
        spent += seconds;
        now.repeats = least.repeats + 1;
        if (seconds < least.set_up + least.march)
            least = now;
        least.repeats = now.repeats;
    }
    if (!status)
        t->cost = least;
    return status;
}

/* One trial or more, and their request. */
struct trials {
    struct br_trial *trial;
    const struct br_trial_request *request;
};

/* Times one trial: sets `cost` and, if the march is not complete, `end` and `failure`. A failure of
 * the march is a result of the trial; an interruption ends the call. */
static enum br_status time_one(void *self, size_t i, struct br_error *err)
{
    const struct trials *all = self;
    struct br_trial *t = &all->trial[i];
    if (t->end == BR_TRIAL_LEFT)
        return BR_OK;
    const enum br_status status = repeat(t, all->request, err);
    if (status == BR_INTERRUPTED)
        return status;
    if (status && t->end != BR_TRIAL_OVER)
        t->end = BR_TRIAL_FAILED;
    return BR_OK;
}

/* The approximate cost of a trial, for the observer. */
static double work_of(const void *self, size_t i)
{
    const struct trials *all = self;
    const struct br_trial *t = &all->trial[i];
    if (t->end == BR_TRIAL_LEFT)
        return 0;
    return t->estimated > 0 ? t->estimated : br_trial_work(all->request->scene, t);
}

static void begin(struct br_trial *t)
{
    t->end = t->end == BR_TRIAL_LEFT ? BR_TRIAL_LEFT : BR_TRIAL_DONE;
    t->cost = (struct br_trial_cost){.set_up = NAN, .march = NAN};
    t->failure = (struct br_error){0};
    t->scale = t->own = NAN;
    for (enum br_part part = 0; part < BR_PARTS; part++)
        t->error[part] = NAN;
}

/* ---- errors ---- */

/* Complete trials as cells of studies: one study for each mesh and degree, so that the reference
 * samples that mesh once, or more, where the time levels have too few in common. Each cell has its
 * own method. All arrays are owned. */
struct groups {
    size_t count, cells;
    struct br_study *study;
    struct br_trial **member; /* by cell, study after study; borrowed */
    size_t *steps;
    struct br_method *method;
};

/* By elements, by degree, then in the order of the list. */
static int by_elements(const void *a, const void *b)
{
    const struct br_trial *x = *(struct br_trial *const *)a, *y = *(struct br_trial *const *)b;
    const int p = x->named->method.axial_degree, q = y->named->method.axial_degree;
    if (x->at.n != y->at.n)
        return x->at.n < y->at.n ? -1 : 1;
    return p != q ? p - q : (x > y) - (x < y);
}

static void lay_out(struct groups *g, struct br_trial *trial, size_t count,
                    const struct br_trial_request *r)
{
    for (struct br_trial *t = trial; t < trial + count; t++)
        if (t->end == BR_TRIAL_DONE)
            g->member[g->cells++] = t;
    qsort(g->member, g->cells, sizeof(struct br_trial *), by_elements);
    size_t levels = 0; /* of the study's cells */
    for (size_t c = 0; c < g->cells; c++) {
        const struct br_trial *t = g->member[c];
        levels = c == 0 ? 0 : br_common_levels(levels, t->at.steps);
        struct br_study *s = g->count > 0 ? &g->study[g->count - 1] : NULL;
        g->steps[c] = t->at.steps;
        g->method[c] = br_trial_method(t);
        if (levels == 0 || t->at.n != *s->n ||
            g->method[c].axial_degree != s->method.axial_degree) {
            levels = t->at.steps;
            s = &g->study[g->count++];
            *s = (struct br_study){.scene = r->scene,
                                   .norm = r->norm,
                                   .method = g->method[c],
                                   .cell_method = &g->method[c],
                                   .reference_kind = br_trials_reference(r),
                                   .reference_method = r->reference_method,
                                   .reference = r->reference,
                                   .n_count = 1,
                                   .n = &t->at.n,
                                   .steps = &g->steps[c]};
            s->reference_method.axial_degree = s->method.axial_degree;
        }
        s->k_count++;
    }
}

/* The reference's own error and its round-off. */
static double own_error(const struct br_study *s)
{
    const double known =
        br_norm_of_constant(s->norm, s->scene, s->reference_report.own_error, BR_PART_TOTAL);
    return isfinite(known) ? known + s->reference_report.round_off * s->reference_scale : NAN;
}

static void take_cell(struct br_trial *t, const struct br_study *s, const struct br_cell *cell)
{
    t->scale = s->reference_scale;
    t->own = own_error(s);
    memcpy(t->error, cell->error, sizeof cell->error);
    const double error = cell->error[BR_PART_TOTAL];
    if (cell->failure.status || !isfinite(error)) {
        t->end = BR_TRIAL_FAILED;
        t->failure = cell->failure;
        if (!cell->failure.status)
            br_fail(&t->failure, BR_NOT_FINITE, "its error is not a number");
    } else if (!(s->reference_scale > 0)) {
        t->end = BR_TRIAL_FAILED;
        br_fail(&t->failure, BR_NOT_FINITE, "the solution is zero: no error is relative to it");
    } else if (t->end == BR_TRIAL_DONE && cell->unstable) {
        t->end = BR_TRIAL_UNSTABLE;
        br_fail(&t->failure, BR_VERDICT,
                "the lagged contact is beyond its stability limit: bounded chatter");
    } else if (t->end == BR_TRIAL_DONE && !(error >= br_flag_margin * t->own) && isfinite(t->own)) {
        t->end = BR_TRIAL_DOUBTFUL;
    }
}

static void take_cells(const struct groups *g)
{
    struct br_trial **member = g->member;
    for (const struct br_study *s = g->study; s < g->study + g->count; s++)
        for (size_t c = 0; c < s->k_count; c++)
            take_cell(*member++, s, &s->cell[c]);
}

static void clear(struct groups *g)
{
    for (size_t i = 0; i < g->count; i++)
        br_study_clear(&g->study[i]);
    free(g->study);
    free(g->member);
    free(g->steps);
    free(g->method);
}

/* Finds the errors of the complete trials. */
static enum br_status find_errors(struct br_trial *trial, size_t count,
                                  const struct br_trial_request *request, struct br_error *err)
{
    if (count == 0)
        return BR_OK;
    struct groups g = {.study = br_allocate(count, sizeof *g.study),
                       .member = br_allocate(count, sizeof(struct br_trial *)),
                       .steps = br_allocate(count, sizeof *g.steps),
                       .method = br_allocate(count, sizeof *g.method)};
    enum br_status status = BR_OK;
    if (!g.study || !g.member || !g.steps || !g.method)
        status = br_no_memory(err, "the trials");
    else
        lay_out(&g, trial, count, request);
    if (g.count && !status)
        status = br_study_run(g.study, g.count, request->threads, request->observer, err);
    if (!status)
        take_cells(&g);
    clear(&g);
    return status;
}

/* ---- both ---- */

/* Timing, in one thread, takes about half of the time. */
enum br_status br_trials_run(struct br_trial *trial, size_t count,
                             const struct br_trial_request *request, struct br_error *err)
{
    struct br_observer_share share = {.whole = request->observer, .length = 0.5};
    const struct br_observer part = br_observer_of(&share);
    struct br_trial_request own = *request;
    own.observer = &part;
    for (size_t i = 0; i < count; i++)
        begin(&trial[i]);
    const struct br_each each = {.count = count,
                                 .threads = 1,
                                 .observer = own.observer,
                                 .turn = time_one,
                                 .work = work_of,
                                 .self = &(struct trials){trial, &own}};
    enum br_status status = br_each(&each, err);
    share = (struct br_observer_share){request->observer, 0.5, 0.5};
    return status ? status : find_errors(trial, count, &own, err);
}
