/* SPDX-License-Identifier: GPL-3.0-or-later */
/* beamrate check SCENE... | --all: whether scenes still converge as they should. */
#include <stdio.h>
#include <string.h>

#include "base/clock.h"
#include "cli/beam/session.h"
#include "cli/command.h"
#include "cli/progress.h"
#include "cli/verdicts.h"
#include "study/scene/file.h"

/* One scene or study file of the command; checks point into it. */
struct item {
    char path[1024];
    struct br_scene scene;
    struct br_verify verify;
    struct br_study_file study; /* a study of another program, instead of scene and verify */
    struct br_check *check;     /* of that study; NULL: it is a scene */
};

struct run {
    const struct br_options *options; /* borrowed */
    struct br_session *session;       /* borrowed */
    bool all;
    char **listed;     /* with --all: the bundled scenes; owned; NULL: the command line has them */
    struct item *item; /* room for `most` */
    size_t most;
    struct br_check *check; /* of the items that can be checked */
    size_t count;
    double wall_seconds;
    struct br_verdicts verdicts;
};

/* ---- scenes ---- */

/* The options' method instead of the scene's own. */
static enum br_status choose_method(const struct run *r, struct item *item, struct br_error *err)
{
    for (int kind = 0; kind < BR_VERIFY_KINDS; kind++) {
        struct br_verify_study *v = &item->verify.study[kind];
        struct br_error inner = {0};
        if (v->n &&
            br_method_read(&r->options->given[BR_OPT_METHOD], BR_METHOD_OPTION, &v->method, &inner))
            return br_fail(err, inner.status, "%s: verify: %s: %s", item->path,
                           br_verify_names[kind], inner.message);
    }
    if (item->verify.by_default)
        br_verify_expect_default(&item->scene, &item->verify);
    return BR_OK;
}

static enum br_status read_study(struct run *r, struct item *item, const char *text,
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

static enum br_status read_scene(struct run *r, size_t i, const char *name, struct br_error *err)
{
    struct item *item = &r->item[i];
    char *text = NULL;
    const char *dot = strrchr(name, '.');
    if (dot && (strcmp(dot, ".csv") == 0 || strcmp(dot, ".tsv") == 0))
        return br_fail(err, BR_BAD_INPUT,
                       "found the table %s, expected a scene or a study file (.yaml) that names "
                       "it; orders of a table: beamrate orders %s",
                       name, name);
    if (br_scene_find(name, item->path, sizeof item->path, err) ||
        br_scene_load(item->path, &text, err))
        return err->status;
    const bool foreign = br_is_study_file(text);
    const bool failed = foreign ? read_study(r, item, text, err)
                                : br_verify_read_set(item->path, text, r->session->set,
                                                     &item->scene, &item->verify, err) ||
                                      choose_method(r, item, err);
    free(text);
    if (failed || foreign)
        return failed ? err->status : BR_OK;
    r->check[r->count++] = (struct br_check){.path = item->path,
                                             .name = item->scene.name,
                                             .scene = &item->scene,
                                             .verify = &item->verify,
                                             .data = item->verify.data};
    return BR_OK;
}

static enum br_status read_scenes(struct run *r, struct br_error *err)
{
    const struct br_options *o = r->options;
    r->most = o->words;
    if (r->all && br_scene_list(&r->listed, &r->most, err))
        return err->status;
    r->item = br_allocate(r->most + 1, sizeof *r->item);
    r->check = br_allocate(r->most + 1, sizeof *r->check);
    if (!r->item || !r->check)
        return br_no_memory(err, "the scenes");
    for (size_t i = 0; i < r->most; i++)
        if (read_scene(r, i, r->all ? r->listed[i] : o->word[i], err))
            return err->status;
    return BR_OK;
}

/* An option that no study would use is refused, not ignored. */
static enum br_status check_accepted(const struct run *r, struct br_error *err)
{
    const struct br_method **method = br_allocate(r->count * BR_VERIFY_KINDS + 1, sizeof *method);
    size_t count = 0;
    if (!method)
        return br_no_memory(err, "the options");
    for (size_t i = 0; i < r->count; i++)
        for (int kind = 0; kind < BR_VERIFY_KINDS; kind++)
            if (r->check[i].verify && r->check[i].verify->study[kind].count)
                method[count++] = &r->check[i].verify->study[kind].method;
    const enum br_status status = br_method_check_used(&r->options->given[BR_OPT_METHOD],
                                                       BR_METHOD_OPTION, method, count, err);
    free(method);
    return status;
}

static void announce(const struct run *r)
{
    struct br_foreseen work = {.together = true};
    for (const struct br_check *c = r->check; c < r->check + r->count; c++) {
        for (int kind = 0; kind < BR_VERIFY_KINDS && c->verify; kind++) {
            const size_t cells = c->verify->study[kind].count;
            const size_t heads = kind == BR_VERIFY_JOINT && cells ? 1 : cells ? cells - 1 : 0;
            for (size_t h = 0; h < heads; h++) {
                const struct br_study study = br_check_study(c, (enum br_verify_kind)kind, h);
                br_foreseen_add_study(&work, &study);
            }
        }
    }
    br_session_announce(r->session, &work);
}

/* ---- computing ---- */

/* Runs the studies of other programs. */
static enum br_status run_studies(struct run *r, const struct br_observer *observer,
                                  struct br_error *err)
{
    for (struct item *item = r->item; item < r->item + r->most; item++) {
        item->study.request.observer = observer;
        if (item->check && br_study_file_run(&item->study, item->check, err))
            return err->status;
    }
    return BR_OK;
}

static enum br_status compute(struct run *r, struct br_error *err)
{
    const double start = br_seconds();
    const struct br_observer *observer = br_progress_start("checking", r->session->quiet);
    enum br_status status = run_studies(r, observer, err);
    if (!status)
        status = br_check_run(r->check, r->count, r->session->threads, observer, err);
    br_progress_end();
    r->wall_seconds = br_seconds() - start;
    return br_progress_result(status, err);
}

/* ---- results ---- */

static enum br_status write_all(struct run *r, struct br_error *err)
{
    const struct br_check_findings findings = {
        .checks = r->check,
        .count = r->count,
        .wall_seconds = r->wall_seconds,
    };
    if (br_session_report(r->session, 1, err))
        return err->status;
    return br_verdicts_finish(&r->verdicts, r->session, &findings, r->all, err);
}

/* Prepares what the reports need, so that a failure comes before the long computation. */
static enum br_status prepare_reports(struct run *r, struct br_error *err)
{
    bool failed = br_verdicts_open(&r->verdicts, r->options, r->check, r->count, err);
    for (size_t i = 0; i < r->most && !failed; i++)
        failed = br_verdicts_spare(&r->verdicts, r->item[i].study.request.table_path, err);
    if (failed || br_session_open(r->session, err))
        return err->status;
    br_warn_of_checks(r->check, r->count);
    return BR_OK;
}

static void clear(struct run *r)
{
    for (size_t i = 0; r->check && i < r->count; i++)
        br_check_clear(&r->check[i]);
    for (size_t i = 0; r->item && i < r->most; i++) {
        br_study_file_clear(&r->item[i].study);
        br_verify_clear(&r->item[i].verify);
        br_scene_clear(&r->item[i].scene);
    }
    free(r->item);
    free(r->check);
    br_verdicts_clear(&r->verdicts);
    br_scene_list_free(r->listed, r->listed ? r->most : 0);
}

/* Only rank 0 writes and gives the verdict. */
static enum br_status run(const struct br_options *options, struct br_session *session,
                          struct br_error *err)
{
    static struct run r;
    r = (struct run){
        .options = options, .session = session, .all = br_option_given(options, BR_OPT_ALL)};
    if (r.all == (options->words > 0))
        return br_fail(
            err, BR_BAD_INPUT,
            r.all ? "--all and scenes are given, expected one of the two"
                  : "no scene is given, expected files, names of bundled scenes, or --all");
    const bool writes = r.session->writes;
    bool failed = read_scenes(&r, err) || check_accepted(&r, err);
    if (!failed) {
        announce(&r);
        failed = (writes && prepare_reports(&r, err)) || compute(&r, err) ||
                 (writes && write_all(&r, err));
        for (size_t i = 0; i < r.most && !failed && writes; i++)
            failed = br_numbers_check_runs(&r.item[i].study.numbers, err);
    }
    clear(&r);
    return failed ? err->status : BR_OK;
}

const struct br_command br_command_check = {
    .bit = BR_FOR_CHECK,
    .name = "check",
    .arguments = "SCENE...",
    .title = "checks that the orders are as expected: a verdict for CI",
    .about =
        "Checks that scenes still converge as their 'verify' parts expect. A scene without such a "
        "part is checked against theory. There are three kinds of study: over h at one time step, "
        "over k on one mesh, and over both against the solution. An order has the verdict PASS if "
        "its 95 % interval lies within the band, FAIL if its 99 % interval lies outside, and else "
        "INCONCLUSIVE. Exit code 0: all orders pass; 1: some do not; 3: they pass, but a run of a "
        "program has failed.",
    .more = "The options of the method replace what the scenes say.",
    .example = {"beamrate check --all --junit orders.xml --markdown summary.md",
                "beamrate check my_scene.yaml --json new.json --compare old.json"},
    .most_words = BR_MOST_WORDS,
    .run = run,
};
