/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/beam/session.h"

#include "base/each.h"
#include "cli/provenance.h"
#include "study/scene/file.h"

enum br_status br_opened_scene_read(struct br_opened_scene *s, const struct br_session *session,
                                    const char *name, struct br_error *err)
{
    char *text = NULL;
    const struct br_scene_asked asked = {.set = session->set, .text = &text};
    if (br_scene_find(name, s->path, sizeof s->path, err) || br_scene_load(s->path, &s->text, err))
        return err->status;
    const enum br_status status = br_scene_parse(s->path, s->text, &asked, &s->scene, err);
    if (text) {
        free(s->text);
        s->text = text;
    }
    return status;
}

void br_opened_scene_clear(struct br_opened_scene *s)
{
    br_scene_clear(&s->scene);
    free(s->text);
    s->text = NULL;
}

struct br_provenance br_provenance_of(const struct br_opened_scene *s, int threads)
{
    struct br_provenance p;
    br_provenance_fill(&p, threads);
    p.scene_path = s ? s->path : NULL;
    p.scene_text = s ? s->text : NULL;
    return p;
}

/* A shorter forecast is not measured, and not printed, s. */
static const double worth_measuring = 1, worth_printing = 3;

void br_session_announce(const struct br_session *s, const struct br_costs *w)
{
    struct br_costs here = *w;
    if (s->quiet || !(br_costs_seconds(w, br_threads(s->threads)) >= worth_measuring))
        return;
    br_costs_measure(&here);
    const double seconds = br_costs_seconds(&here, br_threads(s->threads));
    if (!(seconds >= worth_printing))
        return;
    fprintf(stderr, "%zu march%s, about %.2g s, %.2g GB", w->marches, w->marches == 1 ? "" : "es",
            seconds, w->bytes / 1e9);
    if (w->untimed)
        fprintf(stderr, "; the time of %zu that choose%s their steps is not counted", w->untimed,
                w->untimed == 1 ? "s" : "");
    fputc('\n', stderr);
}
