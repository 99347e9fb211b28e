/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/session.h"

#include <string.h>

#include "cli/provenance.h"
#include "plots/pictures.h"
#include "study/grid/each.h"
#include "study/ranks/ranks.h"
#include "study/scene/file.h"
#include "tables/reports.h"

enum br_status br_opened_scene_read(struct br_opened_scene *s, const char *name,
                                    struct br_error *err)
{
    return br_scene_open(name, s->path, sizeof s->path, &s->text, &s->scene, err);
}

enum br_status br_opened_scene_vary(struct br_opened_scene *s, const struct br_opened_scene *base,
                                    const struct br_varied *varied, size_t i, struct br_error *err)
{
    *s = (struct br_opened_scene){.text = strdup(base->text)};
    strcpy(s->path, base->path);
    return s->text ? br_varied_scene(varied, i, s->path, s->text, &s->scene, err)
                   : br_no_memory(err, "the scene");
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

struct br_session br_session_begin(const struct br_options *options)
{
    const bool writes = br_ranks_first();
    return (struct br_session){
        .options = options,
        .writes = writes,
        .quiet = br_option_given(options, BR_OPT_QUIET) || !writes,
        .threads = (int)br_option_number(options, BR_OPT_THREADS, 0),
    };
}

enum br_status br_session_alone(struct br_error *err)
{
    const int ranks = br_ranks_size();
    return ranks == 1 ? BR_OK
                      : br_fail(err, BR_BAD_INPUT,
                                "%d ranks would disturb one another's clocks, expected one", ranks);
}

enum br_status br_session_open(struct br_session *s, struct br_error *err)
{
    const char *folder = br_option_text(s->options, BR_OPT_OUT);
    return s->writes && folder ? br_output_open(&s->output, folder, err) : BR_OK;
}

enum br_status br_session_keep(const struct br_session *s, const char *text, const char *more,
                               struct br_kept *kept, struct br_error *err)
{
    const bool resume = br_option_given(s->options, BR_OPT_RESUME);
    struct br_provenance here;
    *kept = (struct br_kept){0};
    if (!br_output_is_open(&s->output) || br_ranks_size() > 1)
        return resume ? br_fail(err, BR_BAD_INPUT, "--resume: expected %s",
                                br_ranks_size() > 1 ? "one rank: several keep nothing"
                                                    : "--out, the folder of what is kept")
                      : BR_OK;
    br_provenance_fill(&here, 0);
    if (br_kept_open(kept, s->output.folder, resume, here.machine, err))
        return err->status;
    br_kept_add(&kept->base, text);
    br_kept_add(&kept->base, more);
    return BR_OK;
}

void br_session_tell_kept(const struct br_session *s, const struct br_kept *k)
{
    const size_t taken = atomic_load(&k->taken), bad = atomic_load(&k->bad);
    const size_t lost = atomic_load(&k->lost);
    if (taken && !s->quiet)
        fprintf(stderr, "beamrate: finished cells, trials and cases taken from %s: %zu\n",
                k->folder, taken);
    if (lost)
        fprintf(
            stderr,
            "beamrate: warning: finished cells, trials and cases that could not be kept in %s: %zu\n",
            k->folder, lost);
    if (bad)
        fprintf(stderr,
                "beamrate: warning: %zu entries in %s are damaged or not what their names "
                "say: they were not taken\n",
                bad, k->folder);
}

enum br_status br_session_report(struct br_session *s, size_t documents, struct br_error *err)
{
    s->document = br_allocate(documents, sizeof *s->document);
    s->documents = s->document ? documents : 0;
    return s->document ? BR_OK : br_no_memory(err, "the reports");
}

void br_session_draw(struct br_session *s, struct br_document *report, struct br_figure figure,
                     const char *title)
{
    struct br_session_picture **last = &s->picture;
    if (!figure.panels || br_option_given(s->options, BR_OPT_NO_PLOTS)) {
        br_figure_clear(&figure);
        return;
    }
    br_put_picture(report, figure.stem, title ? title : figure.title);
    while (*last)
        last = &(*last)->next;
    *last = br_allocate(1, sizeof **last);
    if (*last)
        (*last)->figure = figure;
    else
        br_figure_clear(&figure);
    s->lost |= !*last;
}

/* They are rendered while the reports are written. */
static enum br_status draw_all(struct br_session *s, struct br_error *err)
{
    enum br_status status = s->lost ? br_no_memory(err, "a figure") : BR_OK;
    s->files.output = &s->output;
    for (struct br_session_picture *p = s->picture; p && !status; p = p->next)
        status = br_picture_files_draw(&s->files, &p->figure, err);
    return status;
}

static enum br_status write_all(struct br_session *s, struct br_error *err)
{
    if (draw_all(s, err) ||
        br_documents_write(&s->files, s->options, s->document, s->documents, err) ||
        br_picture_files_finish(&s->files, err) || br_output_commit(&s->output, err))
        return err->status;
    if (!s->quiet)
        br_output_announce(&s->output);
    return BR_OK;
}

enum br_status br_session_foresee(const struct br_session *s, struct br_foreseen *work,
                                  struct br_error *err)
{
    struct br_document d = {0};
    br_report_foreseen(work, br_command_line(), br_threads(s->threads), &d);
    const enum br_status status =
        work->lost ? br_no_memory(err, "what would be run") : br_document_show(stdout, &d, err);
    br_document_clear(&d);
    br_foreseen_clear(work);
    return status;
}

enum br_status br_session_finish(struct br_session *s, struct br_error *err)
{
    const enum br_status status =
        s->quiet ? BR_OK : br_documents_show(s->document, s->documents, err);
    return !status && br_output_is_open(&s->output) ? write_all(s, err) : status;
}

enum br_status br_session_variation(struct br_session *s, const struct br_variation *found,
                                    const struct br_opened_scene *base, struct br_error *err)
{
    const struct br_provenance provenance = br_provenance_of(base, s->threads);
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

void br_session_close(struct br_session *s)
{
    br_picture_files_finish(&s->files, NULL);
    br_output_discard(&s->output);
    for (struct br_session_picture *p = s->picture, *next; p; p = next) {
        next = p->next;
        br_figure_clear(&p->figure);
        free(p);
    }
    s->picture = NULL;
    for (size_t i = 0; i < s->documents; i++)
        br_document_clear(&s->document[i]);
    free(s->document);
    s->document = NULL;
    s->documents = 0;
}

enum br_status br_failed_in(struct br_error *err, const char *name)
{
    const struct br_error inner = *err;
    return br_fail(err, inner.status, "%s: %.1000s", name, inner.message);
}
