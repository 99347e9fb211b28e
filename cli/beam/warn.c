/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/beam/session.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/quote.h"
#include "study/paper/paper.h"

/* ---- printing ---- */

void br_print_warnings(const char *scene, const struct br_warnings *warnings)
{
    for (size_t i = 0; i < warnings->count; i++) {
        const struct br_warning *w = &warnings->list[i];
        br_print(stderr, &br_for_text, "beamrate: warning: %s%s%s", scene, *scene ? ": " : "",
                 w->text);
        if (w->more)
            fprintf(stderr, " (and so %zu more of these marches)", w->more);
        fprintf(stderr, "%s\n", w->remedy[0] ? "; remedy:" : "");
        for (const char *line = w->remedy; *line; line += *line == '\n') {
            const int length = (int)strcspn(line, "\n");
            fprintf(stderr, "    %.*s\n", length, line); /* alone, so that it can be copied */
            line += length;
        }
    }
}

/* ---- the marches of a scene ---- */

struct scene_check {
    const struct br_scene *scene;
    struct br_warnings warnings;
    struct br_planned_march finest; /* the march with most elements and steps; n = 0: none */
};

static enum br_status check_march(struct scene_check *check, const struct br_method *method,
                                  struct br_resolution at, struct br_error *err)
{
    const struct br_planned_march o = br_planned(check->scene, method, at);
    if ((double)at.n * (double)at.steps > (double)check->finest.n * (double)check->finest.steps)
        check->finest = o;
    return br_check_ahead_cheaply(&o, &check->warnings, err);
}

/* Checks the loads at the finest march, then prints all warnings. */
static enum br_status end(struct scene_check *check, enum br_status status, struct br_error *err)
{
    if (!status && check->finest.n)
        status = br_check_loads(&check->finest, &check->warnings, err);
    br_print_warnings(check->scene->name, &check->warnings);
    return status;
}

enum br_status br_warn_of_studies(const struct br_study *studies, size_t count,
                                  struct br_error *err)
{
    enum br_status status = BR_OK;
    for (const struct br_study *s = studies; s < studies + count && !status; s++) {
        struct scene_check check = {.scene = s->scene};
        for (size_t c = 0; c < br_study_cells(s) && !status; c++)
            status = check_march(&check, &s->method, br_study_resolution(s, c), err);
        status = end(&check, status, err);
    }
    return status;
}

enum br_status br_warn_of_splits(const struct br_split *splits, size_t count, struct br_error *err)
{
    struct scene_check check = {.scene = splits->scene};
    enum br_status status = BR_OK;
    for (const struct br_split *s = splits; s < splits + count && !status; s++)
        status = check_march(&check, &s->method, s->at, err);
    return end(&check, status, err);
}

/* Loads are not checked: these scenes are known. */
enum br_status br_warn_of_paper(struct br_error *err)
{
    const struct br_paper_request request = br_paper_request_default();
    const struct br_method method = br_method_default();
    enum br_status status = BR_OK;
    for (size_t i = 0; i < BR_EXAMPLES && !status; i++) {
        struct br_scene scene;
        status = br_paper_scene(i, &scene, err);
        struct scene_check check = {.scene = &scene};
        const size_t steps = status ? 0 : request.per_second * (size_t)lround(scene.duration);
        if (!status)
            status = check_march(&check, &method, (struct br_resolution){request.n, steps}, err);
        br_print_warnings(status ? "" : scene.name, &check.warnings);
        br_scene_clear(&scene);
    }
    return status;
}

void br_warn_of_checks(const struct br_scene_check *checks, size_t count)
{
    for (const struct br_scene_check *c = checks; c < checks + count; c++) {
        struct scene_check check = {.scene = c->scene};
        struct br_error refusal = {0};
        for (int kind = 0; kind < BR_VERIFY_KINDS; kind++) {
            const struct br_verify_study *v = &c->verify->study[kind];
            check.finest = (struct br_planned_march){0};
            for (size_t i = 0; i < v->count; i++)
                check_march(&check, &v->method, (struct br_resolution){v->n[i], v->steps[i]},
                            &refusal);
            if (check.finest.n)
                br_check_loads(&check.finest, &check.warnings, &refusal);
        }
        br_print_warnings(c->scene->name, &check.warnings);
    }
}

void br_warn_of_trials(const struct br_scene *scene, const struct br_trial *trials, size_t count)
{
    struct scene_check check = {.scene = scene};
    struct br_error refusal = {0};
    for (const struct br_trial *t = trials; t < trials + count; t++)
        check_march(&check, &t->named->method, t->at, &refusal);
    end(&check, BR_OK, &refusal);
}
