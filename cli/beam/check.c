/* SPDX-License-Identifier: GPL-3.0-or-later */
/* beamrate check SCENE... | --all: whether scenes still converge as they should. */
#include "cli/check.h"

#include "cli/beam/session.h"
#include "cli/command.h"
#include "study/scene/file.h"
#include "study/scene/method_fields.h"

struct one {
    struct br_scene scene;
    struct br_verify verify;
};

struct scenes {
    const struct br_options *options; /* borrowed */
    struct br_session *session;       /* borrowed */
    struct one *one;                  /* room for all names */
    struct br_scene_check *check;     /* count of them */
    size_t count;
};

/* The options' method instead of the scene's own. */
static enum br_status choose_method(const struct scenes *s, const char *path, struct one *one,
                                    struct br_error *err)
{
    for (int kind = 0; kind < BR_VERIFY_KINDS; kind++) {
        struct br_verify_study *v = &one->verify.study[kind];
        struct br_error inner = {0};
        if (v->n &&
            br_method_read(&s->options->given[BR_OPT_METHOD], BR_METHOD_OPTION, &v->method, &inner))
            return br_fail(err, inner.status, "%s: verify: %s: %s", path, br_verify_names[kind],
                           inner.message);
    }
    if (one->verify.by_default)
        br_verify_expect_default(&one->scene, &one->verify);
    return BR_OK;
}

static enum br_status read(void *self, const char *path, const char *text, struct br_check *check,
                           struct br_error *err)
{
    struct scenes *s = self;
    struct one *one = &s->one[s->count];
    struct br_scene_check *c = &s->check[s->count++];
    *c = (struct br_scene_check){.scene = &one->scene, .verify = &one->verify, .check = check};
    if (br_verify_read(path, text, s->session->set, &one->scene, &one->verify, err) ||
        choose_method(s, path, one, err))
        return err->status;
    return br_scene_check_begin(c, path, err);
}

/* An option that no study would use is refused, not ignored. */
static enum br_status check_accepted(const struct scenes *s, struct br_error *err)
{
    const struct br_method **method = br_allocate(s->count * BR_VERIFY_KINDS + 1, sizeof *method);
    size_t count = 0;
    if (!method)
        return br_no_memory(err, "the options");
    for (size_t i = 0; i < s->count; i++)
        for (int kind = 0; kind < BR_VERIFY_KINDS; kind++)
            if (s->check[i].verify->study[kind].count)
                method[count++] = &s->check[i].verify->study[kind].method;
    const enum br_status status = br_method_check_used(&s->options->given[BR_OPT_METHOD],
                                                       BR_METHOD_OPTION, method, count, err);
    free(method);
    return status;
}

static enum br_status begin(void *self, struct br_error *err)
{
    const struct scenes *s = self;
    struct br_costs work = {.together = true};
    if (check_accepted(s, err))
        return err->status;
    for (const struct br_scene_check *c = s->check; c < s->check + s->count; c++) {
        for (int kind = 0; kind < BR_VERIFY_KINDS; kind++) {
            const size_t cells = c->verify->study[kind].count;
            const size_t cases = kind == BR_VERIFY_JOINT && cells ? 1 : cells ? cells - 1 : 0;
            for (size_t h = 0; h < cases; h++) {
                const struct br_study study = br_check_study(c, (enum br_verify_kind)kind, h);
                br_costs_add_study(&work, &study);
            }
        }
    }
    br_session_announce(s->session, &work);
    return BR_OK;
}

/* Of bundled scenes nothing can be changed: their coarse meshes are meant. */
static void warn(void *self)
{
    const struct scenes *s = self;
    if (!br_option_given(s->options, BR_OPT_ALL))
        br_warn_of_checks(s->check, s->count);
}

static enum br_status march(void *self, int threads, const struct br_observer *observer,
                            struct br_error *err)
{
    const struct scenes *s = self;
    return br_check_run(s->check, s->count, threads, observer, err);
}

static enum br_status run(const struct br_options *options, struct br_session *session,
                          struct br_error *err)
{
    struct scenes s = {.options = options, .session = session};
    const bool all = br_option_given(options, BR_OPT_ALL);
    char **listed = NULL;
    size_t count = options->words;
    if (all == (options->words > 0))
        return br_fail(
            err, BR_BAD_INPUT,
            all ? "--all and scenes are given, expected one of the two"
                : "no scene is given, expected files, names of bundled scenes, or --all");
    if (all && br_scene_list(&listed, &count, err))
        return err->status;
    s.one = br_allocate(count + 1, sizeof *s.one);
    s.check = br_allocate(count + 1, sizeof *s.check);
    enum br_status status = s.one && s.check ? BR_OK : br_no_memory(err, "the scenes");
    if (!status)
        status = br_check_sources(
            options, session, all ? listed : options->word, count, all,
            &(struct br_other_sources){&s, br_scene_find, read, begin, warn, march}, err);
    for (size_t i = 0; i < s.count; i++) {
        br_scene_check_clear(&s.check[i]);
        br_verify_clear(&s.one[i].verify);
        br_scene_clear(&s.one[i].scene);
    }
    free(s.one);
    free(s.check);
    br_scene_list_free(listed, listed ? count : 0);
    return status;
}

const struct br_command br_command_check = {
    .bit = BR_FOR_CHECK,
    .name = "check",
    .arguments = "SCENE...",
    .title = "a verdict for CI: are the orders as expected?",
    .about =
        "Checks that scenes still converge as their 'verify' parts expect. A scene without such a "
        "part is checked against theory. There are three kinds of study: over h at one time step, "
        "over k on one mesh, and over both against the solution. An order has the verdict PASS if "
        "its 95 % interval lies within the band, FAIL if its 99 % interval lies outside, and else "
        "INCONCLUSIVE. Exit code 0: all orders pass; 1: some do not; 3: they pass, but a run of a "
        "program has failed.",
    .more = "The options of the method replace what the scenes say.",
    .example = {"check --all --junit orders.xml --markdown summary.md",
                "check my_scene.yaml --json new.json --compare old.json"},
    .most_words = BR_MOST_WORDS,
    .run = run,
};
