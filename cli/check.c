/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/check.h"

#include <stdio.h>
#include <string.h>

#include "base/clock.h"
#include "base/load.h"
#include "cli/command.h"
#include "cli/progress.h"
#include "cli/verdicts.h"

struct item {
    char path[1024];
    struct br_study_file study; /* zeros: it is another source */
    struct br_check *check;     /* of that study; NULL: it is another source */
};

struct check_run {
    const struct br_options *options; /* borrowed, as the next three */
    struct br_session *session;
    const struct br_other_sources *other;
    char *const *name;
    size_t most;            /* names */
    struct item *item;      /* room for `most` */
    struct br_check *check; /* one an item */
    size_t count;
    double wall_seconds;
    struct br_verdicts verdicts;
};

/* ---- reading ---- */

static enum br_status read_study(struct check_run *r, struct item *item, const char *text,
                                 struct br_error *err)
{
    const struct br_options *o = r->options;
    if (r->session->set)
        return br_fail(err, BR_BAD_INPUT, "--set: %s is a study file, expected a scene",
                       item->path);
    if (br_study_file_read(item->path, text, o, &item->study, err))
        return err->status;
    if (item->study.request.expectations == 0)
        return br_fail(err, BR_BAD_INPUT,
                       "%s: verify: missing, expected at least one study to check", item->path);
    item->check = &r->check[r->count++];
    *item->check = br_study_file_check(&item->study, o);
    return BR_OK;
}

static enum br_status find(const struct check_run *r, const char *name, struct item *item,
                           struct br_error *err)
{
    const char *dot = strrchr(name, '.');
    if (dot && (strcmp(dot, ".csv") == 0 || strcmp(dot, ".tsv") == 0))
        return br_fail(err, BR_BAD_INPUT,
                       "found the table %s, expected a %sstudy file (.yaml) that names it; orders "
                       "of a table: %s orders %s",
                       name, r->other ? "scene or a " : "", br_program.name, name);
    if (r->other)
        return r->other->find(name, item->path, sizeof item->path, err);
    if (snprintf(item->path, sizeof item->path, "%s",
                 strcmp(name, "-") ? name : BR_STANDARD_INPUT) < (int)sizeof item->path)
        return BR_OK;
    return br_fail(err, BR_BAD_INPUT, "%.200s...: a path of more than %zu bytes", name,
                   sizeof item->path - 1);
}

static enum br_status read_source(struct check_run *r, size_t i, struct br_error *err)
{
    struct item *item = &r->item[i];
    char *text = NULL;
    if (find(r, r->name[i], item, err) ||
        br_text_load(item->path, BR_LONGEST_STUDY, r->other ? "scene" : "study file", &text, err))
        return err->status;
    bool failed;
    if (br_is_study_file(text))
        failed = read_study(r, item, text, err);
    else if (r->other)
        failed = r->other->read(r->other->self, item->path, text, &r->check[r->count++], err);
    else
        failed = br_fail(err, BR_BAD_INPUT,
                         "%s: found neither 'run:' nor 'table:' at the start of a line, expected a "
                         "study file",
                         item->path);
    free(text);
    return failed ? err->status : BR_OK;
}

static enum br_status read_all(struct check_run *r, struct br_error *err)
{
    r->item = br_allocate(r->most + 1, sizeof *r->item);
    r->check = br_allocate(r->most + 1, sizeof *r->check);
    if (!r->item || !r->check)
        return br_no_memory(err, "the sources");
    for (size_t i = 0; i < r->most; i++)
        if (read_source(r, i, err))
            return err->status;
    return r->other ? r->other->begin(r->other->self, err) : BR_OK;
}

/* ---- computing ---- */

/* Runs the studies of other programs. */
static enum br_status run_studies(struct check_run *r, const struct br_observer *observer,
                                  struct br_error *err)
{
    for (struct item *item = r->item; item < r->item + r->most; item++) {
        item->study.request.observer = observer;
        if (item->check && br_study_file_run(&item->study, item->check, err))
            return err->status;
    }
    return BR_OK;
}

static enum br_status compute(struct check_run *r, struct br_error *err)
{
    const double start = br_seconds();
    const struct br_observer *observer = br_progress_start("checking", r->session->quiet);
    enum br_status status = run_studies(r, observer, err);
    if (!status && r->other)
        status = r->other->run(r->other->self, r->session->threads, observer, err);
    br_progress_end();
    r->wall_seconds = br_seconds() - start;
    return br_progress_result(status, err);
}

/* ---- results ---- */

static enum br_status write_all(struct check_run *r, bool whole, struct br_error *err)
{
    const struct br_check_findings findings = {
        .checks = r->check,
        .count = r->count,
        .wall_seconds = r->wall_seconds,
    };
    if (br_session_report(r->session, 1, err))
        return err->status;
    return br_verdicts_finish(&r->verdicts, r->session, &findings, whole, err);
}

/* Prepares what the reports need, so that a failure comes before the long computation. */
static enum br_status prepare_reports(struct check_run *r, struct br_error *err)
{
    bool failed = br_verdicts_open(&r->verdicts, r->options, r->check, r->count, err);
    for (size_t i = 0; i < r->most && !failed; i++)
        failed = br_verdicts_spare(&r->verdicts, r->item[i].study.request.table_path, err);
    if (failed || br_session_open(r->session, err))
        return err->status;
    if (r->other)
        r->other->warn(r->other->self);
    return BR_OK;
}

static void clear(struct check_run *r)
{
    for (size_t i = 0; r->check && i < r->count; i++)
        br_check_clear(&r->check[i]);
    for (size_t i = 0; r->item && i < r->most; i++)
        br_study_file_clear(&r->item[i].study);
    free(r->item);
    free(r->check);
    br_verdicts_clear(&r->verdicts);
}

/* Of several ranks only the first one writes and gives the verdict. */
enum br_status br_check_sources(const struct br_options *options, struct br_session *session,
                                char *const *name, size_t count, bool whole,
                                const struct br_other_sources *other, struct br_error *err)
{
    static struct check_run r;
    r = (struct check_run){
        .options = options, .session = session, .other = other, .name = name, .most = count};
    const bool writes = session->writes;
    bool failed = read_all(&r, err) || (writes && prepare_reports(&r, err)) || compute(&r, err) ||
                  (writes && write_all(&r, whole, err));
    for (size_t i = 0; i < r.most && !failed && writes; i++)
        if (br_numbers_check_runs(&r.item[i].study.numbers, err))
            failed = br_failed_in(err, r.item[i].path);
    clear(&r);
    return failed ? err->status : BR_OK;
}
