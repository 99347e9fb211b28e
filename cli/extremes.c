/* SPDX-License-Identifier: GPL-3.0-or-later */
/* beamrate extremes [PART...]: where does it break, and does it say so? */
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/command.h"
#include "cli/documents.h"
#include "cli/extremes_options.h"
#include "cli/picture_files.h"
#include "cli/progress.h"
#include "cli/provenance.h"
#include "cli/signals.h"
#include "study/ranks/ranks.h"

struct work {
    struct br_extremes_options options;
    struct br_extremes_wish wish;
    struct br_output output;
    struct br_provenance provenance;
    void *result[BR_EXTREMES_MOST];
    struct br_document document[BR_EXTREMES_MOST];
};

/* ---- what an interrupted part has left ---- */

enum { PATH = 1200 };

static void kept_path(const struct work *w, size_t i, char path[PATH])
{
    snprintf(path, PATH, "%s/%s.cases", w->output.folder, w->options.part[i]->name);
}

/* Hours of work are not thrown away without a word. */
static enum br_status check_kept(const struct work *w, struct br_error *err)
{
    char path[PATH];
    struct stat there;
    for (size_t i = 0; i < w->options.parts && !w->options.resume; i++) {
        kept_path(w, i, path);
        if (w->options.part[i]->heeds & BR_HEEDS_RESUME && stat(path, &there) == 0)
            return br_fail(err, BR_BAD_INPUT,
                           "%s is what an interrupted run has left: --resume goes on with it; "
                           "remove it to begin anew",
                           path);
    }
    return BR_OK;
}

static enum br_status remove_kept(const struct work *w, struct br_error *err)
{
    char path[PATH];
    for (size_t i = 0; i < w->options.parts; i++) {
        kept_path(w, i, path);
        if (w->options.part[i]->heeds & BR_HEEDS_RESUME && unlink(path) < 0 && errno != ENOENT)
            return br_fail(err, BR_IO, "%s: %s", path, strerror(errno));
    }
    return BR_OK;
}

/* ---- computing ---- */

static enum br_status run_part(struct work *w, size_t i, struct br_error *err)
{
    const struct br_extremes_part *part = w->options.part[i];
    const struct br_extremes_wish *wish = &w->wish;
    char kept[PATH], what[64];
    struct br_error inner = {0};
    kept_path(w, i, kept);
    snprintf(what, sizeof what, "%s (%zu of %zu)", part->name, i + 1, w->options.parts);
    const struct br_extremes_job job = {
        .cases = wish->cases,
        .seed = wish->seed,
        .threads = wish->threads,
        .n = wish->n,
        .k = wish->k,
        .n_count = wish->n_count,
        .k_count = wish->k_count,
        .rounding = wish->rounding,
        .kept = part->heeds & BR_HEEDS_RESUME ? kept : NULL,
        .folder = w->output.staging,
        .observer = br_progress_start(what, w->options.quiet),
    };
    const enum br_status status = part->run(&job, &w->result[i], &inner);
    br_progress_end();
    if (status)
        return br_fail(err, status, "%s: %.1000s", part->name, inner.message);
    return br_signals_caught() ? br_fail(err, BR_INTERRUPTED, "interrupted") : BR_OK;
}

/* ---- files ---- */

static void build_report(struct work *w, size_t i)
{
    struct br_document *d = &w->document[i];
    w->options.part[i]->report(w->result[i], d);
    br_put_provenance(d, &w->provenance);
}

static void clear_picture(struct br_extremes_picture *picture)
{
    if (picture->chart)
        br_chart_clear(picture->chart);
    if (picture->heat)
        br_heat_clear(picture->heat);
    free(picture->chart);
    free(picture->heat);
    *picture = (struct br_extremes_picture){NULL, NULL};
}

/* The pictures of one part: into files, and their names into its report. */
static enum br_status draw(struct work *w, size_t part, struct br_picture_files *files,
                           struct br_error *err)
{
    struct br_extremes_picture picture = {NULL, NULL};
    enum br_status status = BR_OK;
    for (size_t i = 0; !status; i++) {
        status = w->options.part[part]->draw(w->result[part], i, &picture, err);
        const bool last = !picture.chart && !picture.heat;
        if (!status && picture.chart) {
            br_put_picture(&w->document[part], picture.chart->stem, picture.chart->title);
            status = br_picture_files_chart(files, picture.chart, err);
        }
        if (!status && picture.heat) {
            br_put_picture(&w->document[part], picture.heat->stem, picture.heat->title);
            status = br_picture_files_heat(files, picture.heat, err);
        }
        clear_picture(&picture);
        if (last)
            break;
    }
    return status;
}

/* The pictures first: they are rendered while the tables are written. */
static enum br_status write_all(struct work *w, struct br_error *err)
{
    struct br_picture_files files = {.output = &w->output};
    enum br_status status = BR_OK;
    for (size_t i = 0; i < w->options.parts && !status && !w->options.no_plots; i++)
        if (w->options.part[i]->draw)
            status = draw(w, i, &files, err);
    if (!status)
        status =
            br_documents_write(&w->output, w->options.format, w->document, w->options.parts, err);
    const enum br_status drawn = br_picture_files_finish(&files, status ? NULL : err);
    return status ? status : drawn;
}

/* The first verdict that fails. */
static enum br_status judge(const struct work *w, struct br_error *err)
{
    for (size_t i = 0; i < w->options.parts; i++) {
        struct br_error inner = {0};
        const enum br_status status = w->options.part[i]->verdict(w->result[i], &inner);
        if (status)
            return br_fail(err, status, "%s: %.1000s", w->options.part[i]->name, inner.message);
    }
    return BR_OK;
}

static enum br_status work(struct work *w, struct br_error *err)
{
    enum br_status status = br_extremes_wish_read(&w->options, &w->wish, err);
    if (!status)
        status = br_output_open(&w->output, w->options.out ? w->options.out : "extremes", err);
    if (!status)
        status = check_kept(w, err);
    for (size_t i = 0; i < w->options.parts && !status; i++)
        status = run_part(w, i, err);
    if (status)
        return status;
    br_provenance_fill(&w->provenance, w->wish.threads);
    for (size_t i = 0; i < w->options.parts; i++)
        build_report(w, i);
    status = write_all(w, err);
    if (!status && !w->options.quiet)
        status = br_documents_show(w->document, w->options.parts, err);
    if (!status)
        status = br_output_commit(&w->output, err);
    if (!status)
        status = remove_kept(w, err);
    if (!status && !w->options.quiet)
        br_output_announce(&w->output);
    return status ? status : judge(w, err);
}

static enum br_status run(int argc, const char **argv, struct br_error *err)
{
    struct work w = {.options = {0}};
    enum br_status status = br_extremes_options_parse(argc, argv, &w.options, err);
    const bool works = !status && !w.options.help;
    if (works && br_ranks_size() > 1)
        status = br_fail(err, BR_BAD_INPUT,
                         "found %d ranks, expected one: its threads share the "
                         "work",
                         br_ranks_size());
    if (works && !status)
        status = work(&w, err);
    br_output_discard(&w.output);
    for (size_t i = 0; i < w.options.parts; i++) {
        br_document_clear(&w.document[i]);
        w.options.part[i]->free(w.result[i]);
    }
    br_extremes_wish_clear(&w.wish);
    br_extremes_options_clear(&w.options);
    return status;
}

const struct br_command br_command_extremes = {
    .name = "extremes",
    .arguments = "[PART...]",
    .title = "where does it break, and does it say so?",
    .run = run,
};
