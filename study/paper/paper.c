/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/paper/paper.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/each.h"
#include "reference/printed.h"
#include "reference/textbook.h"
#include "study/grid/sweep.h"
#include "study/scene/file.h"

/* ---- Figure 10 ---- */

/* Example 4 with other coefficients of contact and friction. The paper does not say which ones, nor
 * at what time: c_H from 1 to 1e8 N/m, c_V from 10 to 1e9 N/m; norms at t = T and their maximum. */
enum { SAMPLES = 300 };

static const struct range {
    double low;
    size_t decades;
} ranges[BR_SWEEPS] = {{1, 8}, {10, 8}};

static enum br_status create_sweeps(struct br_paper *p, struct br_error *err)
{
    const struct br_scene *scene = &p->example[3].scene;
    p->sweep[BR_SWEEP_CONTACT].paper = scene->contact.stiffness;
    p->sweep[BR_SWEEP_FRICTION].paper = scene->friction.coefficient;
    for (size_t s = 0; s < BR_SWEEPS; s++) {
        struct br_sweep *sweep = &p->sweep[s];
        const size_t count = ranges[s].decades * p->request.per_decade + 1;
        sweep->point = br_allocate(count, sizeof *sweep->point);
        if (!sweep->point)
            return br_no_memory(err, "the sweep");
        sweep->points = count;
        for (size_t i = 0; i < count; i++)
            sweep->point[i].coefficient =
                ranges[s].low * pow(10, (double)i / (double)p->request.per_decade);
    }
    return BR_OK;
}

/* |u| + |w| of a march, in L2. */
struct size {
    double *nodal;
    double last, most; /* m^(3/2) */
};

/* The square of the L2 norm of nodal values, by the element's mass. */
static double square(const struct br_field *field, const double *nodal)
{
    const struct br_element *e = br_element_of(field->kind, 1);
    long double sum = 0;
    for (size_t i = 0; i < field->n * e->unknowns; i += e->unknowns)
        sum += br_element_product(e, BR_MASS, nodal + i, nodal + i);
    return field->h * (double)sum;
}

static enum br_status measure(void *self, const struct br_march *march,
                              const struct br_history_row *row, struct br_error *err)
{
    (void)row, (void)err;
    struct size *s = self;
    s->last = 0;
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        br_march_get(march, kind, s->nodal, NULL);
        s->last += sqrt(square(br_march_field(march, kind), s->nodal));
    }
    s->most = s->last <= s->most ? s->most : s->last; /* keeps a NaN */
    return BR_OK;
}

/* How a point is marched: as printed, or with the contact force at the new step; coarser: factor of
 * h and k. */
static const struct way {
    const char *contact;
    size_t coarser;
} ways[BR_SWEEP_WAYS] = {{"lagged", 1}, {"implicit", 1}, {"implicit", 2}};

static enum br_status run(const struct br_paper *p, const struct br_scene *scene,
                          const struct way *way, struct size *size, bool *unstable,
                          struct br_error *err)
{
    struct br_method method = br_method_default();
    method.contact = br_contact_rule_find(way->contact);
    size_t level[SAMPLES];
    const size_t steps = p->request.per_second * (size_t)lround(scene->duration) / way->coarser;
    const size_t samples = steps < SAMPLES ? steps : SAMPLES;
    for (size_t i = 0; i < samples; i++)
        level[i] = (i + 1) * steps / samples;
    const struct br_history_observer observer = {.self = size, .sample = measure};
    const struct br_history_request request = {
        .scene = scene,
        .method = &method,
        .n = p->request.n / way->coarser,
        .steps = steps,
        .level = level,
        .levels = samples,
        .observer = &observer,
        .observers = 1,
    };
    struct br_march *march = NULL;
    struct br_history_end end;
    const enum br_status status = br_history_run(&request, &march, &end, err);
    if (march)
        *unstable = br_march_contact_unstable(march);
    br_march_free(march);
    return status;
}

static enum br_status run_sweep_point(struct br_paper *p, size_t sweep, size_t i,
                                      struct br_error *err)
{
    struct br_sweep_point *point = &p->sweep[sweep].point[i];
    struct br_scene scene = p->example[3].scene; /* borrows its functions */
    if (sweep == BR_SWEEP_CONTACT)
        scene.contact.stiffness = point->coefficient;
    else
        scene.friction.coefficient = point->coefficient;
    struct size size = {.nodal = br_allocate(2 * (p->request.n + 1), sizeof *size.nodal)};
    if (!size.nodal)
        return br_no_memory(err, "the sweep");
    enum br_status status = BR_OK;
    for (int way = 0; way < BR_SWEEP_WAYS && !status; way++) {
        bool unstable = false;
        size.last = size.most = 0;
        status = run(p, &scene, &ways[way], &size, &unstable, err);
        point->last[way] = size.last;
        point->most[way] = size.most;
        point->unstable |= unstable && way == 0;
    }
    free(size.nodal);
    return status;
}

/* ---- exact solutions ---- */

static struct br_history_row row_at(const struct br_exact *exact, double time,
                                    struct br_exact_state *state)
{
    br_exact_at(exact, time, state);
    return (struct br_history_row){
        .time = time,
        .displacement = {state->tip[BR_AXIAL].displacement, state->tip[BR_BENDING].displacement},
        .velocity = {state->tip[BR_AXIAL].velocity, state->tip[BR_BENDING].velocity},
        .friction_force = state->friction_force,
        .friction_bound = state->friction_bound,
    };
}

/* Samples the exact solution: events, values at the time levels of the scheme, and for Example 1
 * the first instants. */
static enum br_status sample(struct br_paper *p, size_t i, const struct br_exact *exact,
                             struct br_error *err)
{
    struct br_example *e = &p->example[i];
    struct br_exact_state *state = NULL;
    const struct br_exact_event *event = br_exact_events(exact, &e->events);
    const size_t steps = p->request.per_second * (size_t)(e->scene.duration + 0.5);
    e->exact = br_allocate(steps + 1, sizeof *e->exact);
    e->event = br_allocate(e->events + 1, sizeof *e->event);
    if (!e->exact || !e->event)
        return br_no_memory(err, "the exact solution");
    memcpy(e->event, event, e->events * sizeof *event);
    const enum br_status status = br_exact_state_create(&state, exact, err);
    e->exacts = status ? 0 : steps + 1;
    for (size_t j = 0; j < e->exacts; j++)
        e->exact[j] = row_at(exact, (double)j / (double)steps * e->scene.duration, state);
    for (size_t j = 0; j <= BR_EXACT_EARLY && i == 0 && !status; j++)
        p->early.exact[j] = row_at(exact, (double)j / BR_EXACT_EARLY * 1e-4, state);
    br_exact_state_free(state);
    return status;
}

static enum br_status solve_exactly(struct br_paper *p, size_t i,
                                    const struct br_observer *observer, struct br_error *err)
{
    struct br_exact *exact = NULL;
    struct br_exact_options options = {0};
    if (observer) {
        options.stop = observer->stop;
        options.progress = observer->preparing;
        options.stop_self = observer->self;
    }
    enum br_status status = br_exact_create(&exact, &p->example[i].scene, &options, err);
    if (!status)
        status = sample(p, i, exact, err);
    br_exact_free(exact);
    return status;
}

static enum br_status run_tables(struct br_paper *p, const struct br_observer *observer,
                                 struct br_error *err)
{
    static const struct br_printed *const printed[BR_PAPER_TABLES] = {&br_printed_table1,
                                                                      &br_printed_table2};
    enum br_status status = BR_OK;
    for (size_t i = 0; i < BR_PAPER_TABLES && !status; i++) {
        struct br_paper_table *t = &p->table[i];
        t->n[0] = 100, t->steps[0] = 100, t->steps[1] = 200;
        t->study = (struct br_study){
            .scene = &p->example[i].scene,
            .norm = &br_norm_l2,
            .method = br_method_default(),
            .reference_kind = &br_reference_exact,
            .n_count = 1,
            .k_count = 2,
            .n = t->n,
            .steps = t->steps,
        };
        for (size_t j = 0; j < 2; j++)
            t->printed[j] =
                br_printed_error(printed[i], t->n[0], br_time_step(t->study.scene, t->steps[j]));
        status = br_study_run(&t->study, 1, p->request.threads,
                              observer ? &(struct br_observer){.stop = observer->stop,
                                                               .self = observer->self,
                                                               .preparing = observer->preparing}
                                       : NULL,
                              err);
    }
    return status;
}

/* ---- the marches ---- */

/* The times of the curves, s. Example 3 has the two at which its tip is said to let go. */
static const double figure_times[BR_EXAMPLES][BR_FIGURE_TIMES] = {
    {0.2, 0.4, 0.6, 0.8, 1},
    {0.2, 0.4, 0.6, 0.8, 1},
    {0.2, 0.4, 0.68, 0.8, 0.9, 1},
    {0.5, 1, 1.5, 2, 2.5, 3},
};

struct br_paper_request br_paper_request_default(void)
{
    return (struct br_paper_request){.n = 1000, .per_second = 1000, .per_decade = 4};
}

/* ---- examples ---- */

/* All rows, and the fields at the figures' times. */
static enum br_status record(const struct br_scene *scene, size_t n, size_t steps,
                             const double *time, size_t times, struct br_history_record *out,
                             struct br_error *err)
{
    size_t level[BR_FIGURE_TIMES];
    for (size_t i = 0; i < times; i++)
        level[i] = (size_t)lround(time[i] / scene->duration * (double)steps);
    const struct br_method method = br_method_default();
    const struct br_history_observer recorder = br_history_recorder(out, n);
    const struct br_history_request request = {
        .scene = scene,
        .method = &method,
        .n = n,
        .steps = steps,
        .stride = 1,
        .level = level,
        .levels = times,
        .observer = &recorder,
        .observers = 1,
    };
    struct br_history_end end;
    return br_history_run(&request, NULL, &end, err);
}

static enum br_status run_example(struct br_paper *p, size_t i, struct br_error *err)
{
    struct br_example *e = &p->example[i];
    const size_t steps = p->request.per_second * (size_t)lround(e->scene.duration);
    const double *time = figure_times[i];
    size_t times = 0;
    while (times < BR_FIGURE_TIMES && time[times] > 0)
        times++;
    return record(&e->scene, p->request.n, steps, time, times, &e->record, err);
}

/* Example 1 up to 100 microseconds, with k = 0.1 microseconds. */
static enum br_status run_early(struct br_paper *p, struct br_error *err)
{
    struct br_scene scene = p->example[0].scene; /* borrows its functions */
    scene.duration = 1e-4;
    return record(&scene, p->request.n, 1000, NULL, 0, &p->early.record, err);
}

/* Example 3 with the axial field, contact and load of Example 1 added: bending must not notice. */
static enum br_status run_coupled(struct br_paper *p, struct br_error *err)
{
    struct br_scene scene = p->example[2].scene;
    scene.axial = p->example[0].scene.axial;
    scene.contact = p->example[0].scene.contact;
    struct br_history_record both = {0}, alone = {0};
    const size_t n = p->request.n, steps = p->request.per_second;
    enum br_status status = record(&scene, n, steps, NULL, 0, &both, err);
    if (!status)
        status = record(&p->example[2].scene, n, steps, NULL, 0, &alone, err);
    p->coupled = 0;
    for (size_t i = 0; i < both.rows && !status; i++) {
        const double moved =
            fabs(both.row[i].displacement[BR_BENDING] - alone.row[i].displacement[BR_BENDING]);
        p->coupled = moved <= p->coupled ? p->coupled : moved; /* keeps a NaN */
    }
    br_history_record_clear(&both);
    br_history_record_clear(&alone);
    return status;
}

/* ---- tasks ---- */

struct figures_work {
    struct br_paper *paper;
    const struct br_observer *observer;
};

/* The long ones first: exact solutions, examples, the sweep, the rest. */
static enum br_status run_task(void *self, size_t task, struct br_error *err)
{
    const struct figures_work *w = self;
    if (task < BR_EXAMPLES)
        return solve_exactly(w->paper, task, w->observer, err);
    task -= BR_EXAMPLES;
    if (task < BR_EXAMPLES)
        return run_example(w->paper, task, err);
    task -= BR_EXAMPLES;
    for (size_t s = 0; s < BR_SWEEPS; task -= w->paper->sweep[s++].points)
        if (task < w->paper->sweep[s].points)
            return run_sweep_point(w->paper, s, task, err);
    return task ? run_coupled(w->paper, err) : run_early(w->paper, err);
}

static enum br_status run_tasks(struct br_paper *p, const struct br_observer *observer,
                                struct br_error *err)
{
    struct figures_work work = {p, observer};
    const struct br_each each = {
        .count = 2 * BR_EXAMPLES + p->sweep[0].points + p->sweep[1].points + 2,
        .threads = p->request.threads,
        .observer = observer,
        .turn = run_task,
        .self = &work,
    };
    return br_each(&each, err);
}

enum br_status br_paper_scene(size_t i, struct br_scene *scene, struct br_error *err)
{
    char name[32], path[1024];
    *scene = (struct br_scene){0};
    snprintf(name, sizeof name, "example%zu", i + 1);
    const enum br_status status = br_scene_find(name, path, sizeof path, err);
    return status ? status : br_scene_read(path, scene, err);
}

enum br_status br_paper_run(struct br_paper *p, const struct br_paper_request *request,
                            const struct br_observer *observer, struct br_error *err)
{
    *p = (struct br_paper){.request = *request};
    for (size_t i = 0; i < BR_EXAMPLES; i++)
        if (br_paper_scene(i, &p->example[i].scene, err))
            return err->status;
    const bool failed =
        create_sweeps(p, err) || run_tasks(p, observer, err) || run_tables(p, observer, err);
    return failed ? err->status : BR_OK;
}

void br_paper_clear(struct br_paper *p)
{
    for (size_t i = 0; i < BR_EXAMPLES; i++) {
        struct br_example *e = &p->example[i];
        br_scene_clear(&e->scene);
        br_history_record_clear(&e->record);
        free(e->exact);
        free(e->event);
    }
    br_history_record_clear(&p->early.record);
    for (size_t s = 0; s < BR_SWEEPS; s++)
        free(p->sweep[s].point);
    for (size_t t = 0; t < BR_PAPER_TABLES; t++)
        br_study_clear(&p->table[t].study);
    *p = (struct br_paper){0};
}
