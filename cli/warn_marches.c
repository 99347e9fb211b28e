/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/warn_marches.h"

#include <math.h>

#include "cli/warn.h"
#include "study/paper/paper.h"

/* Keeps the one with most elements and steps. */
static void keep_finest(const struct br_outlook *o, struct br_outlook *finest)
{
    if ((double)o->n * (double)o->steps > (double)finest->n * (double)finest->steps)
        *finest = *o;
}

static enum br_status look_at_cells(const struct br_study *study, struct br_warnings *warnings,
                                    struct br_error *err)
{
    enum br_status status = BR_OK;
    struct br_outlook finest = {0};
    for (size_t i = 0; i < study->n_count; i++)
        for (size_t j = 0; j < study->k_count && !status; j++) {
            const struct br_outlook outlook = {.scene = study->scene,
                                               .method = &study->method,
                                               .n = study->n[i],
                                               .steps = study->steps[j]};
            status = br_look_ahead_cheaply(&outlook, warnings, err);
            keep_finest(&outlook, &finest);
        }
    return status || !finest.n ? status : br_look_at_loads(&finest, warnings, err);
}

enum br_status br_warn_of_studies(const struct br_study *studies, size_t count,
                                  struct br_error *err)
{
    enum br_status status = BR_OK;
    for (size_t i = 0; i < count && !status; i++) {
        struct br_warnings warnings = {0};
        status = look_at_cells(&studies[i], &warnings, err);
        br_print_warnings_of(studies[i].scene->name, &warnings);
    }
    return status;
}

static void look_at_check(const struct br_check *check, const struct br_verify_study *study,
                          struct br_warnings *warnings)
{
    struct br_outlook finest = {0};
    struct br_error unsaid = {0};
    for (size_t i = 0; i < study->count; i++) {
        struct br_error refusal = {0};
        const struct br_outlook outlook = {.scene = check->scene,
                                           .method = &study->method,
                                           .n = study->n[i],
                                           .steps = study->steps[i]};
        br_look_ahead_cheaply(&outlook, warnings, &refusal);
        keep_finest(&outlook, &finest);
    }
    if (finest.n)
        br_look_at_loads(&finest, warnings, &unsaid);
}

void br_warn_of_checks(const struct br_check *checks, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        struct br_warnings warnings = {0};
        for (int kind = 0; kind < BR_VERIFY_KINDS; kind++)
            look_at_check(&checks[i], &checks[i].verify->study[kind], &warnings);
        br_print_warnings_of(checks[i].scene->name, &warnings);
    }
}

void br_warn_of_trade(const struct br_trade *trade)
{
    const struct br_scene *scene = trade->request.scene;
    struct br_warnings warnings = {0};
    struct br_outlook finest = {0};
    struct br_error refusal = {0};
    for (size_t i = 0; i < trade->count; i++) {
        const struct br_trial *t = &trade->trial[i];
        const struct br_outlook outlook = {
            .scene = scene, .method = &t->contender->method, .n = t->at.n, .steps = t->at.steps};
        br_look_ahead_cheaply(&outlook, &warnings, &refusal);
        keep_finest(&outlook, &finest);
    }
    if (finest.n)
        br_look_at_loads(&finest, &warnings, &refusal);
    br_print_warnings_of(scene->name, &warnings);
}

void br_warn_of_plan(const struct br_plan *plan)
{
    if (plan->chosen >= plan->count)
        return;
    const struct br_trial *t = &plan->trial[plan->chosen];
    struct br_warnings warnings = {0};
    struct br_error refusal = {0};
    const struct br_outlook outlook = {.scene = plan->request.scene,
                                       .method = &t->contender->method,
                                       .n = t->at.n,
                                       .steps = t->at.steps};
    br_look_ahead_cheaply(&outlook, &warnings, &refusal);
    br_look_at_loads(&outlook, &warnings, &refusal);
    br_print_warnings_of(plan->request.scene->name, &warnings);
}

enum br_status br_warn_of_splits(const struct br_split *splits, size_t count, struct br_error *err)
{
    struct br_warnings warnings = {0};
    struct br_outlook finest = {0};
    enum br_status status = BR_OK;
    for (size_t i = 0; i < count && !status; i++) {
        const struct br_split *s = &splits[i];
        const struct br_outlook outlook = {
            .scene = s->scene, .method = &s->method, .n = s->at.n, .steps = s->at.steps};
        status = br_look_ahead_cheaply(&outlook, &warnings, err);
        keep_finest(&outlook, &finest);
    }
    if (!status && finest.n)
        status = br_look_at_loads(&finest, &warnings, err);
    if (count)
        br_print_warnings_of(splits[0].scene->name, &warnings);
    return status;
}

enum br_status br_warn_of_paper(struct br_error *err)
{
    const struct br_paper_request request = br_paper_request_default();
    const struct br_method method = br_method_default();
    enum br_status status = BR_OK;
    for (size_t i = 0; i < BR_EXAMPLES && !status; i++) {
        struct br_warnings warnings = {0};
        struct br_scene scene;
        status = br_paper_scene(i, &scene, err);
        if (!status) {
            const struct br_outlook outlook = {.scene = &scene,
                                               .method = &method,
                                               .n = request.n,
                                               .steps = request.per_second *
                                                        (size_t)lround(scene.duration)};
            status = br_look_ahead_cheaply(&outlook, &warnings, err);
            br_print_warnings_of(scene.name, &warnings);
        }
        br_scene_clear(&scene);
    }
    return status;
}
