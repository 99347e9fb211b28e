/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/vary.h"

#include <string.h>

#include "cli/progress.h"
#include "plots/pictures.h"
#include "study/ranks/ranks.h"
#include "tables/reports.h"

enum br_status br_vary_scene(const struct br_vary *v, size_t i, struct br_opened_scene *s,
                             struct br_error *err)
{
    *s = (struct br_opened_scene){.text = strdup(v->base.text)};
    strcpy(s->path, v->base.path);
    return s->text ? br_varied_scene(&v->varied, i, s->path, s->text, &s->scene, err)
                   : br_no_memory(err, "the scene");
}

static void *point_at(const struct br_vary_command *c, void *points, size_t i)
{
    return (char *)points + i * c->size;
}

/* Prepares all points before the first march, so that a refusal comes early. */
static enum br_status prepare(struct br_vary *v, const struct br_options *o,
                              const struct br_vary_command *c, void **points, struct br_error *err)
{
    char text[BR_VARIED_TEXT];
    if (c->read(o, &v->request, err) || br_opened_scene_read(&v->base, o->word[0], err) ||
        br_varied_read(br_option_text(o, BR_OPT_VARY), &v->varied, err))
        return err->status;
    if (!(*points = br_allocate(v->varied.count, c->size)))
        return br_no_memory(err, "the values");
    while (v->points < v->varied.count) {
        const size_t i = v->points++;
        if (c->prepare(v, i, point_at(c, *points, i), err))
            return br_failed_in(err, br_varied_text(&v->varied, i, text));
    }
    v->found = (struct br_variation){
        .varied = &v->varied, .format = c->format, .column = v->column, .columns = c->columns};
    return br_variation_create(&v->found, &v->base.scene, err);
}

static void announce(const struct br_vary *v, const struct br_vary_command *c, void *points)
{
    struct br_foreseen work = {.alone = c->alone};
    for (size_t i = 0; i < v->points; i++)
        c->foresee(point_at(c, points, i), &work);
    br_session_announce(v->session, &work);
}

static enum br_status march(struct br_vary *v, const struct br_vary_command *c, void *points,
                            struct br_error *err)
{
    enum br_status status = br_session_open(v->session, err);
    for (size_t i = 0; i < v->points && !status; i++) {
        const struct br_error *failure = &v->found.failure[i];
        status = c->march(v, i, point_at(c, points, i), &v->found.failure[i], err);
        if (failure->status == BR_NO_MEMORY || failure->status == BR_IO ||
            failure->status == BR_INTERRUPTED)
            return br_fail(err, failure->status, "%s", failure->message);
        status = br_progress_result(status, err);
    }
    return status;
}

static enum br_status write_all(struct br_vary *v, struct br_error *err)
{
    struct br_session *s = v->session;
    const struct br_variation *found = &v->found;
    const struct br_provenance provenance = br_provenance_of(&v->base, s->threads);
    size_t first;
    if (br_session_report(s, 1, err))
        return err->status;
    br_report_variation(found, s->document);
    br_session_draw(s, s->document, br_variation_draw(found), NULL);
    br_put_provenance(s->document, &provenance);
    if (br_session_finish(s, err))
        return err->status;
    const size_t failures = br_variation_failures(found, &first);
    return failures ? br_fail(err, BR_NOT_FINITE, "%zu of %zu values failed; the first, %g %s: %s",
                              failures, found->varied->count, found->varied->value[first],
                              found->varied->unit, found->failure[first].message)
                    : BR_OK;
}

enum br_status br_vary_run(const struct br_options *options, struct br_session *session,
                           const struct br_vary_command *c, struct br_error *err)
{
    if (c->alone && !br_ranks_first())
        return BR_OK; /* one rank does single marches */
    struct br_vary v = {.session = session};
    void *points = NULL;
    bool failed = prepare(&v, options, c, &points, err);
    if (!failed) {
        announce(&v, c, points);
        failed = march(&v, c, points, err) || (v.session->writes && write_all(&v, err));
    }
    for (size_t i = 0; i < v.points; i++)
        c->clear(point_at(c, points, i));
    free(points);
    br_variation_clear(&v.found);
    br_varied_clear(&v.varied);
    br_opened_scene_clear(&v.base);
    return failed ? err->status : BR_OK;
}
