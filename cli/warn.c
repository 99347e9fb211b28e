/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/session.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "study/paper/paper.h"
#include "study/scene/quote.h"

/* ---- printing ---- */

void br_print_warnings(const char *scene, const struct br_warnings *warnings)
{
    for (size_t i = 0; i < warnings->count; i++) {
        const struct br_warning *w = &warnings->list[i];
        fputs("beamrate: warning: ", stderr);
        br_quote(stderr, &br_for_text, scene);
        fputs(*scene ? ": " : "", stderr);
        br_quote(stderr, &br_for_text, w->text);
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

struct look {
    const struct br_scene *scene;
    struct br_warnings warnings;
    struct br_planned_march finest; /* the march with most elements and steps; n = 0: none */
};

static enum br_status look_at(struct look *l, const struct br_method *method, size_t n,
                              size_t steps, struct br_error *err)
{
    const struct br_planned_march o = {.scene = l->scene, .method = method, .n = n, .steps = steps};
    if ((double)n * (double)steps > (double)l->finest.n * (double)l->finest.steps)
        l->finest = o;
    return br_look_ahead_cheaply(&o, &l->warnings, err);
}

/* The loads as the finest march sees them; then all is printed. */
static enum br_status end(struct look *l, enum br_status status, struct br_error *err)
{
    if (!status && l->finest.n)
        status = br_look_at_loads(&l->finest, &l->warnings, err);
    br_print_warnings(l->scene->name, &l->warnings);
    return status;
}

enum br_status br_warn_of_studies(const struct br_study *studies, size_t count,
                                  struct br_error *err)
{
    enum br_status status = BR_OK;
    for (const struct br_study *s = studies; s < studies + count && !status; s++) {
        struct look look = {.scene = s->scene};
        for (size_t i = 0; i < s->n_count; i++)
            for (size_t j = 0; j < s->k_count && !status; j++)
                status = look_at(&look, &s->method, s->n[i], s->steps[j], err);
        status = end(&look, status, err);
    }
    return status;
}

enum br_status br_warn_of_splits(const struct br_split *splits, size_t count, struct br_error *err)
{
    struct look look = {.scene = splits->scene};
    enum br_status status = BR_OK;
    for (const struct br_split *s = splits; s < splits + count && !status; s++)
        status = look_at(&look, &s->method, s->at.n, s->at.steps, err);
    return end(&look, status, err);
}

/* Loads are not looked at: these scenes are known. */
enum br_status br_warn_of_paper(struct br_error *err)
{
    const struct br_paper_request request = br_paper_request_default();
    const struct br_method method = br_method_default();
    enum br_status status = BR_OK;
    for (size_t i = 0; i < BR_EXAMPLES && !status; i++) {
        struct br_scene scene;
        status = br_paper_scene(i, &scene, err);
        struct look look = {.scene = &scene};
        const size_t steps = status ? 0 : request.per_second * (size_t)lround(scene.duration);
        if (!status)
            status = look_at(&look, &method, request.n, steps, err);
        br_print_warnings(status ? "" : scene.name, &look.warnings);
        br_scene_clear(&scene);
    }
    return status;
}

void br_warn_of_checks(const struct br_check *checks, size_t count)
{
    for (const struct br_check *c = checks; c < checks + count; c++) {
        struct look look = {.scene = c->scene};
        struct br_error refusal = {0};
        for (int kind = 0; kind < BR_VERIFY_KINDS && c->verify; kind++) {
            const struct br_verify_study *v = &c->verify->study[kind];
            look.finest = (struct br_planned_march){0};
            for (size_t i = 0; i < v->count; i++)
                look_at(&look, &v->method, v->n[i], v->steps[i], &refusal);
            if (look.finest.n)
                br_look_at_loads(&look.finest, &look.warnings, &refusal);
        }
        br_print_warnings(c->name, &look.warnings);
    }
}

void br_warn_of_trials(const struct br_scene *scene, const struct br_trial *trials, size_t count)
{
    struct look look = {.scene = scene};
    struct br_error refusal = {0};
    for (const struct br_trial *t = trials; t < trials + count; t++)
        look_at(&look, &t->named->method, t->at.n, t->at.steps, &refusal);
    end(&look, BR_OK, &refusal);
}
