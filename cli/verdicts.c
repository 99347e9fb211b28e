/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/verdicts.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "base/load.h"
#include "base/quote.h"
#include "cli/provenance.h"

/* Opens, for each format, the file that its option names. */
static enum br_status open_files(struct br_verdicts *v, const struct br_options *options,
                                 struct br_error *err)
{
    struct br_option row[BR_OPTIONS];
    const size_t count = br_options_of(options->command, row);
    for (size_t i = 1; br_check_formats[i]; i++)
        for (size_t j = 0; j < count; j++)
            if (strcmp(row[j].name, br_check_formats[i]->name) == 0 &&
                br_whole_file_open(&v->file[i], row[j].name, br_option_text(options, row[j].id),
                                   err))
                return err->status;
    return br_option_given(options, BR_OPT_UPDATE_BASELINE)
               ? br_whole_file_open(&v->baseline, "compare",
                                    br_option_text(options, BR_OPT_COMPARE), err)
               : BR_OK;
}

enum br_status br_verdicts_spare(const struct br_verdicts *v, const char *path,
                                 struct br_error *err)
{
    for (size_t i = 1; path && br_check_formats[i]; i++)
        if (br_whole_file_meets(&v->file[i], path))
            return br_fail(err, BR_BAD_INPUT, "--%s would replace %s, which is read",
                           br_check_formats[i]->name, path);
    return BR_OK;
}

/* Refuses a report at the path of another report, or of a file that is read. */
static enum br_status check_paths(const struct br_verdicts *v, const char *baseline,
                                  const struct br_check *checks, size_t count, struct br_error *err)
{
    for (size_t i = 1; br_check_formats[i]; i++) {
        const struct br_whole_file *f = &v->file[i];
        const char *name = br_check_formats[i]->name;
        for (size_t j = 1; j < i; j++)
            if (br_whole_file_same(f, &v->file[j]))
                return br_fail(err, BR_BAD_INPUT, "--%s and --%s both write %s",
                               br_check_formats[j]->name, name, f->path);
        if (baseline && (br_whole_file_meets(f, baseline) || br_whole_file_same(f, &v->baseline)))
            return br_fail(err, BR_BAD_INPUT, "--%s would replace what it is compared with, %s",
                           name, f->path);
    }
    for (size_t s = 0; s < count; s++)
        if (br_verdicts_spare(v, checks[s].path, err))
            return err->status;
    return BR_OK;
}

/* A baseline that will be written may be missing, or be of another problem; what is no baseline is
 * not replaced. */
static enum br_status read_baseline(struct br_verdicts *v, const struct br_options *options,
                                    const struct br_check *checks, size_t count,
                                    struct br_error *err)
{
    const bool update = br_option_given(options, BR_OPT_UPDATE_BASELINE);
    v->compare = br_option_text(options, BR_OPT_COMPARE);
    if (update && !v->compare)
        return br_fail(err, BR_BAD_INPUT,
                       "--update-baseline is given without --compare, expected its file");
    if (update && access(v->compare, F_OK) != 0)
        v->compare = NULL;
    if (!v->compare)
        return BR_OK;
    if (br_check_read_json(v->compare, &v->old, err)) {
        const struct br_error why = *err;
        if (why.status != BR_BAD_INPUT || (!update && access(v->compare, F_OK) == 0))
            return why.status;
        return br_fail(err, BR_BAD_INPUT,
                       update ? "%.400s; --update-baseline replaces no other file than a baseline"
                              : "%.400s (--update-baseline writes it)",
                       why.message);
    }
    if (!br_compare_check(checks, count, &v->old, err))
        return BR_OK;
    if (err->status != BR_BAD_INPUT || !update)
        return err->status;
    v->compare = NULL;
    return BR_OK;
}

enum br_status br_verdicts_open(struct br_verdicts *v, const struct br_options *options,
                                const struct br_check *checks, size_t count, struct br_error *err)
{
    const bool failed = read_baseline(v, options, checks, count, err) ||
                        open_files(v, options, err) ||
                        check_paths(v, br_option_text(options, BR_OPT_COMPARE), checks, count, err);
    return failed ? err->status : BR_OK;
}

static enum br_status write_files(struct br_verdicts *v, const struct br_document *d,
                                  struct br_error *err)
{
    for (size_t i = 1; br_check_formats[i]; i++)
        if (v->file[i].file &&
            br_document_print(v->file[i].file, br_check_formats[i], d, NULL, err))
            return err->status;
    if (v->baseline.file && br_document_print(v->baseline.file, &br_document_json, d, NULL, err))
        return err->status;
    for (size_t i = 1; br_check_formats[i]; i++)
        if (br_whole_file_commit(&v->file[i], err))
            return err->status;
    return br_whole_file_commit(&v->baseline, err);
}

/* The folder has a picture of the verdicts. The files, which may stand anywhere, name none. */
enum br_status br_verdicts_write(struct br_verdicts *v, struct br_session *session,
                                 const struct br_check_findings *findings, struct br_error *err)
{
    struct br_document *d = &session->document[session->documents - 1];
    for (size_t i = 1; br_check_formats[i]; i++)
        session->quiet |= v->file[i].file == stdout;
    if (findings && br_output_is_open(&session->output))
        br_session_draw(
            session, d, br_check_draw(findings->checks, findings->count),
            "Each observed order with its 95 % interval, on the band that is expected.");
    if (br_session_finish(session, err))
        return err->status;
    if (findings) {
        br_report_check(findings, d);
        br_session_put_set(session, d);
    }
    return write_files(v, d, err);
}

static enum br_status conclude(const struct br_verdicts *v, const struct br_check *checks,
                               size_t count, struct br_error *err)
{
    size_t all = 0;
    const size_t passed = br_check_tally(checks, count, BR_PASS);
    const struct br_check *refused;
    for (size_t i = 0; i < count; i++)
        all += checks[i].count;
    if (br_check_failures(checks, count, &refused) > 0)
        return br_fail(err, BR_BAD_INPUT, "%s", refused->failure.message);
    if (all == 0)
        return br_fail(err, BR_VERDICT, "no order was checked");
    if (passed < all)
        return br_fail(err, BR_VERDICT, "%zu of %zu orders do not pass", all - passed, all);
    if (v->comparison.tally[BR_SERIOUS])
        return br_fail(err, BR_VERDICT, "serious differences from %s: %zu; first: %s: %s",
                       v->compare, v->comparison.tally[BR_SERIOUS],
                       v->comparison.difference->subject, v->comparison.difference->remark);
    return BR_OK;
}

enum br_status br_verdicts_finish(struct br_verdicts *v, struct br_session *session,
                                  const struct br_check_findings *findings, bool whole,
                                  struct br_error *err)
{
    struct br_provenance provenance;
    br_provenance_fill(&provenance, session->threads);
    struct br_document *d = &session->document[session->documents - 1];
    struct br_check_findings all = *findings;
    if (v->compare && br_compare(all.checks, all.count, whole, &v->old, &v->comparison, err))
        return err->status;
    all.comparison = v->compare ? &v->comparison : NULL;
    all.provenance = &provenance;
    br_report_check(&all, d);
    br_session_put_set(session, d);
    const bool failed =
        br_verdicts_write(v, session, &all, err) || conclude(v, all.checks, all.count, err);
    return failed ? err->status : BR_OK;
}

void br_verdicts_clear(struct br_verdicts *v)
{
    for (size_t i = 1; br_check_formats[i]; i++)
        br_whole_file_discard(&v->file[i]);
    br_whole_file_discard(&v->baseline);
    br_old_check_clear(&v->old);
    br_comparison_clear(&v->comparison);
}

/* ---- study files ---- */

void br_study_file_clear(struct br_study_file *f)
{
    br_orders_clear(&f->orders);
    br_numbers_clear(&f->numbers);
    br_orders_request_clear(&f->request);
}

/* Says what to type: the command line with --trust, before a "--". */
static enum br_status refuse_untrusted(const char *path, const char *what, const char *named,
                                       struct br_error *err)
{
    const char *line = br_command_line(), *end = strstr(line, " -- ");
    const int length = (int)(end ? end - line : (long)strlen(line));
    char shown[300];
    br_quoted(shown, sizeof shown, &br_for_text, named);
    return br_fail(err, BR_BAD_INPUT,
                   "%s: it %s '%s', which needs --trust each time: read the file, then type: %.*s "
                   "--trust%.100s",
                   path, what, shown, length < 400 ? length : 0, line, end ? end : "");
}

static enum br_status check_trust(const struct br_orders_request *r,
                                  const struct br_options *options, struct br_error *err)
{
    char command[400], path[400];
    if (!br_option_given(options, BR_OPT_TRUST) && r->command)
        return refuse_untrusted(r->path, "runs the command", r->command, err);
    if (!br_option_given(options, BR_OPT_TRUST) && r->table_is_outside)
        return refuse_untrusted(r->path, "reads a table outside its folder,", r->table_path, err);
    if (r->command && !br_option_given(options, BR_OPT_QUIET))
        fprintf(stderr, "beamrate: %s runs %s\n",
                br_quoted(path, sizeof path, &br_for_text, r->path),
                br_quoted(command, sizeof command, &br_for_text, r->command));
    return BR_OK;
}

enum br_status br_study_file_read(const char *path, const char *text,
                                  const struct br_options *options, struct br_study_file *f,
                                  struct br_error *err)
{
    if (br_orders_request_read(path, text, &f->request, err))
        return err->status;
    return f->request.command && br_session_alone(err) ? err->status
                                                       : check_trust(&f->request, options, err);
}

bool br_is_yaml(const char *path)
{
    const char *dot = strrchr(path, '.');
    return dot && (strcmp(dot, ".yaml") == 0 || strcmp(dot, ".yml") == 0);
}

enum br_status br_study_file_open(const char *path, const struct br_options *options,
                                  struct br_study_file *f, struct br_error *err)
{
    const bool standard = strcmp(path, "-") == 0, study = br_is_yaml(path);
    char *text = NULL;
    if (br_text_load(standard ? BR_STANDARD_INPUT : path,
                     study ? BR_LONGEST_STUDY : BR_LONGEST_TABLE, study ? "study file" : "table",
                     &text, err))
        return err->status;
    if (study) {
        const enum br_status status = br_study_file_read(path, text, options, f, err);
        free(text);
        return status;
    }
    f->request = br_orders_request_default();
    f->request.table = text;
    f->request.path = strdup(standard ? "standard input" : path);
    return f->request.path ? BR_OK : br_no_memory(err, "the table");
}

struct br_check br_study_file_check(struct br_study_file *f, const struct br_options *o)
{
    struct br_orders_request *r = &f->request;
    r->jobs = (int)br_option_number(o, BR_OPT_THREADS, 0);
    r->anew = !br_option_given(o, BR_OPT_RESUME);
    const bool read = !r->command && strcmp(r->path, "standard input") != 0;
    struct br_check check = {.of_program = true,
                             .path = r->path,
                             .no_file = !read && !r->folder,
                             .name = r->title     ? r->title
                                     : r->command ? r->command
                                                  : r->path};
    br_orders_problem(r, check.problem);
    return check;
}

enum br_status br_study_file_run(struct br_study_file *f, struct br_check *check,
                                 struct br_error *err)
{
    struct br_orders_request *r = &f->request;
    const enum br_status status = br_orders_read(r, &f->numbers, err);
    for (size_t i = 0; i < f->numbers.rows; i++)
        check->seconds += isfinite(f->numbers.row[i].seconds) ? f->numbers.row[i].seconds : 0;
    if (status || br_orders_find(&f->numbers, r->formal, &f->orders, err))
        return err->status;
    return br_orders_check(&f->orders, r->expectation, r->expectations, check, err);
}
