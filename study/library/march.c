/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The library's functions for scenes and marches. */
#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "solver/march.h"
#include "study/foresee/prediction.h"
#include "study/foresee/warnings.h"
#include "study/library/library.h"
#include "study/scene/file.h"

static_assert((int)BEAMRATE_AXIAL == BR_AXIAL && (int)BEAMRATE_BENDING == BR_BENDING, "");
static_assert((int)BEAMRATE_FRICTIONLESS == BR_FRICTIONLESS, "");
static_assert((int)BEAMRATE_TRESCA == BR_TRESCA && (int)BEAMRATE_COULOMB == BR_COULOMB, "");
static_assert((int)BEAMRATE_MOST_WARNINGS >= BR_WARNINGS, "each warning has a place");

/* ---- scenes ---- */

static enum br_status read_scene(struct beamrate_scene *s, const char *path, const char *text,
                                 struct br_error *err)
{
    if (!path || !text)
        return br_fail(err, BR_BAD_INPUT, "%s: found NULL, expected a text",
                       path ? "text" : "name");
    s->path = strdup(path);
    return s->path ? br_verify_read(s->path, text, &s->scene, &s->verify, err)
                   : br_no_memory(err, "the scene");
}

enum beamrate_status beamrate_scene_parse(struct beamrate_scene **scene, const char *name,
                                          const char *text, struct beamrate_error *err)
{
    BR_MAKE_HANDLE(scene, BR_HANDLE_SCENE, beamrate_scene_free,
                   read_scene(*scene, name, text, &call.err));
}

/* "-" is an ordinary file name: a library does not read standard input. */
static enum br_status open_scene(struct beamrate_scene *s, const char *name, struct br_error *err)
{
    char path[1024], *text = NULL;
    if (!name)
        return read_scene(s, name, text, err);
    enum br_status status = br_scene_find(strcmp(name, "-") ? name : "./-", path, sizeof path, err);
    if (!status)
        status = br_scene_load(path, &text, err);
    if (!status)
        status = read_scene(s, path, text, err);
    free(text);
    return status;
}

enum beamrate_status beamrate_scene_open(struct beamrate_scene **scene, const char *name,
                                         struct beamrate_error *err)
{
    BR_MAKE_HANDLE(scene, BR_HANDLE_SCENE, beamrate_scene_free,
                   open_scene(*scene, name, &call.err));
}

void beamrate_scene_free(struct beamrate_scene *scene)
{
    if (!br_handle_is(scene, BR_HANDLE_SCENE))
        return;
    br_verify_clear(&scene->verify);
    br_scene_clear(&scene->scene);
    free(scene->path);
    free(scene);
}

enum beamrate_status beamrate_scene_info(const struct beamrate_scene *scene,
                                         struct beamrate_scene_info *info)
{
    if (info)
        *info = (struct beamrate_scene_info){.name = "", .title = ""};
    if (!info || !br_handle_is(scene, BR_HANDLE_SCENE))
        return BEAMRATE_BAD_INPUT;
    const struct br_scene *s = &scene->scene;
    *info = (struct beamrate_scene_info){
        .name = s->name,
        .title = s->title,
        .length = s->length,
        .duration = s->duration,
        .density = s->density,
        .modelled = {s->axial.modelled, s->bending.modelled},
        .contact = s->contact.modelled,
        .friction = (enum beamrate_friction)s->friction.law,
    };
    return BEAMRATE_OK;
}

/* ---- before a march ---- */

/* Reads the method of a march and refuses impossible marches. *planned (out) points to *method. */
static enum br_status plan_march(const struct br_scene *scene, size_t n, size_t steps,
                                 const char *const *list, struct br_method *method,
                                 struct br_planned_march *planned, struct br_error *err)
{
    *planned = (struct br_planned_march){.scene = scene, .method = method, .n = n, .steps = steps};
    if (n < 1 || steps < 1)
        return br_fail(err, BR_BAD_INPUT,
                       "found n = %zu and %zu steps, expected at least 1 of each", n, steps);
    enum br_status status = br_library_method(list, method, err);
    if (!status)
        status = br_method_check(method, scene, err);
    return status ? status
                  : br_damping_check(method, scene, n, scene->duration / (double)steps, err);
}

static void copy_warnings(const struct br_warnings *warnings, struct beamrate_forecast *f)
{
    f->warnings = warnings->count;
    for (size_t i = 0; i < warnings->count; i++) {
        const struct br_warning *w = &warnings->list[i];
        snprintf(f->warning[i].kind, sizeof f->warning[i].kind, "%s", br_warning_words[w->kind]);
        snprintf(f->warning[i].text, sizeof f->warning[i].text, "%s", w->text);
        snprintf(f->warning[i].remedy, sizeof f->warning[i].remedy, "%s", w->remedy);
    }
}

static void copy_prediction(const struct br_prediction *p, struct beamrate_forecast *f)
{
    f->known = p->known;
    snprintf(f->why, sizeof f->why, "%s", p->known ? "" : p->why);
    f->round_off = p->round_off;
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        const struct br_predicted *e = &p->field[kind];
        f->error[kind] = p->known ? (struct beamrate_estimate){e->error, e->low, e->high}
                                  : (struct beamrate_estimate){NAN, NAN, NAN};
    }
}

enum beamrate_status beamrate_foresee(const struct beamrate_scene *scene, size_t n, size_t steps,
                                      const char *const *list, struct beamrate_forecast *forecast,
                                      struct beamrate_error *err)
{
    struct br_call call;
    struct br_method method;
    struct br_planned_march planned;
    struct br_warnings warnings = {0};
    struct br_prediction prediction = {0};
    br_call_begin(&call);
    enum br_status status = br_call_take_scene(&call, scene);
    if (forecast)
        memset(forecast, 0, sizeof *forecast);
    else
        status = br_fail(&call.err, BR_BAD_INPUT, "forecast: found NULL, expected a struct");
    if (!status)
        status = plan_march(&call.scene, n, steps, list, &method, &planned, &call.err);
    planned.prediction = &prediction;
    if (!status)
        status = br_check_ahead(&planned, &warnings, &call.err);
    if (!status) {
        copy_prediction(&prediction, forecast);
        copy_warnings(&warnings, forecast);
    }
    return br_call_end(&call, status, err);
}

/* ---- marches ---- */

struct beamrate_march {
    enum br_handle kind;
    struct br_march *march;
    size_t n, steps;
    struct br_error failure; /* of a step: the state is lost */
};

static enum br_status create_march(struct beamrate_march *m, const struct beamrate_scene *of,
                                   size_t n, size_t steps, const char *const *list,
                                   struct br_error *err)
{
    struct br_method method;
    struct br_planned_march planned;
    struct br_warnings warnings = {0};
    if (br_handle_check(of, BR_HANDLE_SCENE, "scene", err))
        return err->status;
    const struct br_scene *scene = &of->scene;
    enum br_status status = plan_march(scene, n, steps, list, &method, &planned, err);
    m->n = n;
    m->steps = steps;
    if (!status)
        status = br_check_ahead_cheaply(&planned, &warnings, err); /* may refuse the march */
    return status ? status : br_march_create(&m->march, scene, n, steps, &method, err);
}

enum beamrate_status beamrate_march_create(struct beamrate_march **march,
                                           const struct beamrate_scene *scene, size_t n,
                                           size_t steps, const char *const *method,
                                           struct beamrate_error *err)
{
    BR_MAKE_HANDLE(march, BR_HANDLE_MARCH, beamrate_march_free,
                   create_march(*march, scene, n, steps, method, &call.err));
}

void beamrate_march_free(struct beamrate_march *march)
{
    if (!br_handle_is(march, BR_HANDLE_MARCH))
        return;
    br_march_free(march->march);
    free(march);
}

static enum br_status take_steps(struct beamrate_march *m, size_t count, struct br_error *err)
{
    if (br_handle_check(m, BR_HANDLE_MARCH, "march", err))
        return err->status;
    const size_t left = m->steps - br_march_steps_done(m->march);
    if (m->failure.status)
        return br_fail(err, m->failure.status, "%s", m->failure.message);
    if (count > left)
        return br_fail(err, BR_BAD_INPUT, "found %zu steps, expected at most the %zu that are left",
                       count, left);
    for (size_t i = 0; i < count && !m->failure.status; i++)
        if (br_march_step(m->march, &m->failure))
            br_fail(err, m->failure.status, "%s", m->failure.message);
    return m->failure.status;
}

enum beamrate_status beamrate_march_step(struct beamrate_march *march, size_t count,
                                         struct beamrate_error *err)
{
    struct br_call call;
    br_call_begin(&call);
    return br_call_end(&call, take_steps(march, count, &call.err), err);
}

enum beamrate_status beamrate_march_tip(const struct beamrate_march *march,
                                        struct beamrate_tip *tip)
{
    if (tip)
        memset(tip, 0, sizeof *tip);
    if (!tip || !br_handle_is(march, BR_HANDLE_MARCH))
        return BEAMRATE_BAD_INPUT;
    const size_t step = br_march_steps_done(march->march);
    const struct br_tip *t = step > 0 ? br_march_tip(march->march) : br_march_start(march->march);
    *tip = (struct beamrate_tip){
        .step = step,
        .time = br_march_time(march->march),
        .contact_force = t->contact_force,
        .friction_force = t->friction_force,
        .friction_bound = t->friction_bound,
    };
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        tip->displacement[kind] = br_march_tip_displacement(march->march, kind);
        tip->velocity[kind] = t->velocity[kind];
    }
    return BEAMRATE_OK;
}

static bool is_field_of(const struct beamrate_march *march, enum beamrate_field field)
{
    return br_handle_is(march, BR_HANDLE_MARCH) &&
           (field == BEAMRATE_AXIAL || field == BEAMRATE_BENDING);
}

size_t beamrate_march_columns(const struct beamrate_march *march, enum beamrate_field field)
{
    if (!is_field_of(march, field))
        return 0;
    return br_field_unknowns(br_march_field(march->march, (enum br_field_kind)field));
}

enum beamrate_status beamrate_march_get(const struct beamrate_march *march,
                                        enum beamrate_field field, double *displacement,
                                        double *velocity)
{
    if (!is_field_of(march, field))
        return BEAMRATE_BAD_INPUT;
    br_march_get(march->march, (enum br_field_kind)field, displacement, velocity);
    return BEAMRATE_OK;
}

enum beamrate_status beamrate_march_report(const struct beamrate_march *march,
                                           struct beamrate_march_report *report)
{
    if (report)
        memset(report, 0, sizeof *report);
    if (!report || !br_handle_is(march, BR_HANDLE_MARCH))
        return BEAMRATE_BAD_INPUT;
    const struct br_counts counts = br_march_counts(march->march);
    *report = (struct beamrate_march_report){
        .n = march->n,
        .steps = march->steps,
        .done = br_march_steps_done(march->march),
        .accepted = counts.steps,
        .rejected = counts.rejected,
        .stages = counts.stages,
        .round_off = br_march_round_off(march->march),
        .unstable = br_march_contact_unstable(march->march),
    };
    return BEAMRATE_OK;
}
