/* SPDX-License-Identifier: GPL-3.0-or-later */
/* beamrate check SCENE... | --all: whether scenes still converge as they should. */
#include <stdio.h>
#include <string.h>

#include "cli/command.h"
#include "cli/progress.h"
#include "cli/session.h"
#include "cli/warn.h"
#include "solver/clock.h"
#include "study/scene/file.h"
#include "study/verify/comparison.h"
#include "tables/reports.h"

/* A scene on its way; checks point into it. */
struct item {
    char path[1024];
    struct br_scene scene;
    struct br_verify verify;
};

/* A format's name is an option's. */
enum { MOST_FORMATS = 8 };

struct run {
    struct br_session session;
    const char *compare; /* --compare; NULL: not given */
    bool all, fail_fast;
    char **listed;     /* all bundled scenes; owned; NULL: those that are given */
    struct item *item; /* most */
    size_t most;
    struct br_check *check; /* of the items that can be checked */
    size_t count;
    size_t done; /* checks that have been run */
    double wall_seconds;
    struct br_whole_file file[MOST_FORMATS];
    struct br_old_check old;
    struct br_comparison comparison;
};

/* The file that a format's option names, or NULL. */
static const char *file_of(const struct run *r, const char *format)
{
    struct br_option row[BR_OPTIONS];
    const size_t count = br_options_of(r->session.options->command, row);
    for (size_t i = 0; i < count; i++)
        if (strcmp(row[i].name, format) == 0)
            return br_option_text(r->session.options, row[i].id);
    return NULL;
}

/* ---- scenes ---- */

/* The options' method instead of the scene's own. */
static enum br_status choose_method(const struct run *r, struct item *item, struct br_error *err)
{
    enum br_status status = BR_OK;
    for (int kind = 0; kind < BR_VERIFY_KINDS && !status; kind++) {
        struct br_verify_study *v = &item->verify.study[kind];
        struct br_error inner = {0};
        v->method.rounding =
            br_rounding_mode((size_t)br_option_number(r->session.options, BR_OPT_ROUNDING, 0));
        if (v->count && br_method_read(&r->session.options->given[BR_OPT_METHOD], BR_METHOD_OPTION,
                                       &v->method, &inner))
            status = br_fail(err, inner.status, "%s: verify: %s: %s", item->path,
                             br_verify_names[kind], inner.message);
    }
    if (!status && item->verify.by_default)
        br_verify_expect_default(&item->scene, &item->verify);
    return status;
}

static enum br_status read_scene(struct run *r, size_t i, const char *name, struct br_error *err)
{
    struct item *item = &r->item[i];
    if (br_scene_find(name, item->path, sizeof item->path, err) ||
        br_scene_read_verify(item->path, &item->scene, &item->verify, err) ||
        choose_method(r, item, err))
        return err->status;
    r->check[r->count++] = (struct br_check){.path = item->path,
                                             .name = item->scene.name,
                                             .scene = &item->scene,
                                             .verify = &item->verify};
    return BR_OK;
}

static enum br_status read_scenes(struct run *r, struct br_error *err)
{
    const struct br_options *o = r->session.options;
    r->most = o->words;
    if (r->all && br_scene_list(&r->listed, &r->most, err))
        return err->status;
    r->item = br_allocate(r->most + 1, sizeof *r->item);
    r->check = br_allocate(r->most + 1, sizeof *r->check);
    if (!r->item || !r->check)
        return br_no_memory(err, "the scenes");
    enum br_status status = BR_OK;
    for (size_t i = 0; i < r->most && !status; i++)
        status = read_scene(r, i, r->all ? r->listed[i] : o->word[i], err);
    return status;
}

/* An option that no study would heed is refused, not ignored. */
static enum br_status check_heeded(const struct run *r, struct br_error *err)
{
    const struct br_method **method = br_allocate(r->count * BR_VERIFY_KINDS + 1, sizeof *method);
    size_t count = 0;
    if (!method)
        return br_no_memory(err, "the options");
    for (size_t i = 0; i < r->count; i++)
        for (int kind = 0; kind < BR_VERIFY_KINDS; kind++)
            if (r->check[i].verify->study[kind].count)
                method[count++] = &r->check[i].verify->study[kind].method;
    const enum br_status status = br_method_check_heeded(&r->session.options->given[BR_OPT_METHOD],
                                                         BR_METHOD_OPTION, method, count, err);
    free(method);
    return status;
}

/* ---- computing ---- */

static int by_work(const void *a, const void *b)
{
    const double x = br_check_work(a), y = br_check_work(b);
    return (x > y) - (x < y);
}

static size_t orders(const struct run *r)
{
    size_t orders = 0;
    for (size_t i = 0; i < r->done; i++)
        orders += r->check[i].count;
    return orders;
}

static bool failed_so_far(const struct run *r)
{
    const struct br_check *first;
    return br_check_tally(r->check, r->done, BR_PASS) < orders(r) ||
           br_check_failures(r->check, r->done, &first) > 0;
}

/* With --fail-fast one after the other, the cheapest first, else all at once. */
static enum br_status compute(struct run *r, struct br_error *err)
{
    const double start = br_seconds();
    const size_t at_once = r->fail_fast ? 1 : r->count;
    if (r->fail_fast)
        qsort(r->check, r->count, sizeof *r->check, by_work);
    const struct br_observer *observer = br_progress_start("checking", r->session.quiet);
    enum br_status status = BR_OK;
    while (r->done < r->count && !status && !(r->fail_fast && failed_so_far(r))) {
        status = br_check_run(&r->check[r->done], at_once, r->session.threads, observer, err);
        r->done += status ? 0 : at_once;
    }
    br_progress_end();
    r->wall_seconds = br_seconds() - start;
    return br_progress_result(status, err);
}

/* ---- results ---- */

static enum br_status open_files(struct run *r, struct br_error *err)
{
    enum br_status status = BR_OK;
    for (size_t i = 1; br_check_formats[i] && !status; i++)
        status = br_whole_file_open(&r->file[i], br_check_formats[i]->name,
                                    file_of(r, br_check_formats[i]->name), err);
    return status;
}

/* No report may end where another one does, or in the place of what is read. */
static enum br_status check_places(const struct run *r, struct br_error *err)
{
    for (size_t i = 1; br_check_formats[i]; i++) {
        const struct br_whole_file *f = &r->file[i];
        const char *name = br_check_formats[i]->name;
        for (size_t j = 1; j < i; j++)
            if (br_whole_file_same(f, &r->file[j]))
                return br_fail(err, BR_BAD_INPUT, "--%s and --%s both write %s",
                               br_check_formats[j]->name, name, f->path);
        for (size_t s = 0; s < r->count; s++)
            if (br_whole_file_replaces(f, r->check[s].path))
                return br_fail(err, BR_BAD_INPUT, "--%s would replace the scene %s", name, f->path);
        if (r->compare && br_whole_file_replaces(f, r->compare))
            return br_fail(err, BR_BAD_INPUT, "--%s would replace what it is compared with, %s",
                           name, f->path);
    }
    return BR_OK;
}

static enum br_status print(struct run *r, const struct br_document *d, struct br_error *err)
{
    bool quiet = r->session.quiet;
    for (size_t i = 1; br_check_formats[i]; i++)
        quiet |= r->file[i].file == stdout;
    enum br_status status = quiet ? BR_OK : br_document_show(stdout, d, err);
    for (size_t i = 1; br_check_formats[i] && !status; i++)
        if (r->file[i].file)
            status = br_document_print(r->file[i].file, br_check_formats[i], d, NULL, err);
    for (size_t i = 1; br_check_formats[i] && !status; i++)
        status = br_whole_file_commit(&r->file[i], err);
    return status;
}

static enum br_status write_all(struct run *r, struct br_error *err)
{
    const struct br_provenance provenance = br_provenance_of(NULL, r->session.threads);
    struct br_document d = {0};
    if (r->compare &&
        br_compare(r->check, r->done, r->all && r->done == r->count, &r->old, &r->comparison, err))
        return err->status;
    const struct br_check_findings findings = {
        .checks = r->check,
        .count = r->done,
        .stopped = r->done < r->count,
        .wall_seconds = r->wall_seconds,
        .comparison = r->compare ? &r->comparison : NULL,
        .provenance = &provenance,
    };
    br_report_check(&findings, &d);
    const enum br_status status = print(r, &d, err);
    br_document_clear(&d);
    return status;
}

/* What has not passed, for the exit code. */
static enum br_status conclude(const struct run *r, struct br_error *err)
{
    const size_t all = orders(r), passed = br_check_tally(r->check, r->done, BR_PASS);
    const struct br_check *refused;
    if (br_check_failures(r->check, r->done, &refused) > 0)
        return br_fail(err, BR_BAD_INPUT, "%s", refused->failure.message);
    if (all == 0)
        return br_fail(err, BR_VERDICT, "no order was checked");
    if (passed < all)
        return br_fail(err, BR_VERDICT, "%zu of %zu orders do not pass", all - passed, all);
    if (r->comparison.tally[BR_SERIOUS])
        return br_fail(err, BR_VERDICT, "%zu serious differences from %s",
                       r->comparison.tally[BR_SERIOUS], r->compare);
    return BR_OK;
}

/* What the reports need, before a long computation. */
static enum br_status prepare_reports(struct run *r, struct br_error *err)
{
    if ((r->compare && (br_check_read_json(r->compare, &r->old, err) ||
                        br_compare_check(r->check, r->count, &r->old, err))) ||
        open_files(r, err) || check_places(r, err))
        return err->status;
    br_warn_of_checks(r->check, r->count);
    return BR_OK;
}

static void clear(struct run *r)
{
    for (size_t i = 0; i < r->done; i++)
        br_check_clear(&r->check[i]);
    for (size_t i = 0; r->item && i < r->most; i++) {
        br_verify_clear(&r->item[i].verify);
        br_scene_clear(&r->item[i].scene);
    }
    for (size_t i = 1; br_check_formats[i]; i++)
        br_whole_file_discard(&r->file[i]);
    free(r->item);
    free(r->check);
    br_old_check_clear(&r->old);
    br_comparison_clear(&r->comparison);
    br_scene_list_free(r->listed, r->listed ? r->most : 0);
}

/* Rank 0 writes, and has the verdict. */
static enum br_status run(const struct br_options *options, struct br_error *err)
{
    static struct run r;
    r = (struct run){.session = br_session_begin(options),
                     .compare = br_option_text(options, BR_OPT_COMPARE),
                     .all = br_option_given(options, BR_OPT_ALL),
                     .fail_fast = br_option_given(options, BR_OPT_FAIL_FAST)};
    if (r.all == (options->words > 0))
        return br_fail(
            err, BR_BAD_INPUT,
            r.all ? "--all and scenes are given, expected one of the two"
                  : "no scene is given, expected files, names of bundled scenes, or --all");
    const bool writes = r.session.writes;
    const bool failed = read_scenes(&r, err) || check_heeded(&r, err) ||
                        (writes && prepare_reports(&r, err)) || compute(&r, err) ||
                        (writes && (write_all(&r, err) || conclude(&r, err)));
    clear(&r);
    return failed ? err->status : BR_OK;
}

const struct br_command br_command_check = {
    .bit = BR_FOR_CHECK,
    .name = "check",
    .arguments = "SCENE...",
    .title = "whether the orders are as expected: a verdict for CI",
    .about =
        "Whether scenes still converge as their 'verify' parts expect, or, where a scene has "
        "none, as the scheme should. Three studies that are apart: over h at one time step, over "
        "k on one mesh, and both together against the solution. The verdict on an order comes "
        "from its 95 % interval: PASS within the band, FAIL outside, INCONCLUSIVE across its "
        "end. Exit code 0: all PASS; 1: not so.",
    .more = "The options of the method are taken instead of what the scenes say.",
    .example = {"beamrate check --all --junit orders.xml --markdown summary.md",
                "beamrate check my_scene.yaml --json new.json --compare old.json"},
    .most_words = BR_MOST_WORDS,
    .run = run,
};
