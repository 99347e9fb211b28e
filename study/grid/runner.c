/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/grid/runner.h"
#include "solver/clock.h"

#include "study/grid/study.h"

void br_runner_clear(struct br_runner *r)
{
    br_march_free(r->march);
    free(r->view.values);
    *r = (struct br_runner){0};
}

enum br_status br_runner_start(struct br_runner *r, const struct br_scene *scene,
                               struct br_resolution at, const struct br_method *method)
{
    const double start = br_seconds();
    const enum br_status status =
        br_march_create(&r->march, scene, at.n, at.steps, method, &r->error);
    r->seconds += br_seconds() - start;
    if (status)
        return r->error.status = status;
    r->view.values = br_allocate_aligned(BR_MOST_MODES * at.n, sizeof *r->view.values);
    if (!r->view.values)
        return br_no_memory(&r->error, "a cell");
    return BR_OK;
}

enum br_status br_runner_advance(struct br_runner *r, size_t step)
{
    const double start = br_seconds();
    while (!r->error.status && br_march_steps_done(r->march) < step)
        br_march_step(r->march, &r->error);
    r->seconds += br_seconds() - start;
    return r->error.status;
}

void br_runner_look(struct br_runner *r, enum br_field_kind kind, enum br_measure measure)
{
    br_look(r->march, kind, measure, &r->view);
}
