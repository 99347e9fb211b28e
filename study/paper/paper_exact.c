/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The exact solutions of the examples, and two cells of each table judged by them. */
#include <string.h>

#include "reference/printed.h"
#include "study/grid/sweep.h"
#include "study/paper/paper.h"
#include "study/scene/file.h"

static struct br_exact_point point_at(const struct br_exact *exact, double time,
                                      struct br_exact_state *state)
{
    br_exact_at(exact, time, state);
    struct br_exact_point point = {
        .time = time,
        .friction_force = state->friction_force,
        .friction_bound = state->friction_bound,
    };
    for (int kind = 0; kind < 2; kind++) {
        point.displacement[kind] = state->tip[kind].displacement;
        point.velocity[kind] = state->tip[kind].velocity;
    }
    return point;
}

/* The same time levels as the scheme's, and for Example 1 the first instants. */
static enum br_status sample(struct br_paper *p, size_t i, const struct br_exact *exact,
                             struct br_error *err)
{
    struct br_example *e = &p->example[i];
    struct br_exact_state *state = NULL;
    const size_t steps = p->request.per_second * (size_t)(e->scene.duration + 0.5);
    enum br_status status = br_exact_state_create(&state, exact, err);
    if (status)
        return status;
    e->exact = br_allocate(steps + 1, sizeof *e->exact);
    if (e->exact) {
        e->exacts = steps + 1;
        for (size_t j = 0; j <= steps; j++)
            e->exact[j] = point_at(exact, (double)j / (double)steps * e->scene.duration, state);
        for (size_t j = 0; j <= BR_EXACT_EARLY && i == 0; j++)
            p->early.exact[j] = point_at(exact, (double)j / BR_EXACT_EARLY * 1e-4, state);
    }
    br_exact_state_free(state);
    return e->exact ? BR_OK : br_no_memory(err, "the exact solution");
}

static enum br_status keep_events(struct br_example *e, const struct br_exact *exact,
                                  struct br_error *err)
{
    const struct br_exact_event *event = br_exact_events(exact, &e->events);
    e->event = br_allocate(e->events + 1, sizeof *event);
    if (!e->event)
        return br_no_memory(err, "the events");
    memcpy(e->event, event, e->events * sizeof *event);
    for (int f = 0; f < BR_EXACT_FIELDS; f++)
        e->report[f] = br_exact_report(exact, (enum br_exact_field)f);
    return BR_OK;
}

enum br_status br_paper_exact(struct br_paper *p, size_t i, const struct br_observer *observer,
                              struct br_error *err)
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
        status = keep_events(&p->example[i], exact, err);
    if (!status)
        status = sample(p, i, exact, err);
    br_exact_free(exact);
    return status;
}

static enum br_status read_printed(struct br_paper_table *t, const char *file, struct br_error *err)
{
    char path[1024];
    struct br_printed printed;
    br_data_path(file, path, sizeof path);
    const enum br_status status = br_printed_read(path, &printed, err);
    for (size_t j = 0; j < 2 && !status; j++)
        t->printed[j] =
            br_printed_error(&printed, t->n[0], br_time_step(t->study.scene, t->steps[j]));
    if (!status)
        br_printed_clear(&printed);
    return status;
}

enum br_status br_paper_tables(struct br_paper *p, const struct br_observer *observer,
                               struct br_error *err)
{
    static const char *const file[BR_PAPER_TABLES] = {"reference/printed/table1.csv",
                                                      "reference/printed/table2.csv"};
    enum br_status status = BR_OK;
    for (size_t i = 0; i < BR_PAPER_TABLES && !status; i++) {
        struct br_paper_table *t = &p->table[i];
        t->n[0] = 100, t->steps[0] = 100, t->steps[1] = 200;
        t->study = (struct br_study){
            .scene = &p->example[i].scene,
            .norm = &br_norm_l2,
            .method = br_method_default(),
            .judge = &br_judge_exact,
            .n_count = 1,
            .k_count = 2,
            .n = t->n,
            .steps = t->steps,
        };
        status = read_printed(t, file[i], err);
        if (!status)
            status = br_study_run(&t->study, 1, p->request.threads,
                                  observer ? &(struct br_observer){.stop = observer->stop,
                                                                   .self = observer->self,
                                                                   .preparing = observer->preparing}
                                           : NULL,
                                  err);
    }
    return status;
}
