/* SPDX-License-Identifier: GPL-3.0-or-later */
/* beamrate extremes [PART...] [SCENE]: where does it break, and does it say so? */
#include <stdio.h>
#include <string.h>

#include "base/words.h"
#include "cli/beam/extremes_experiment.h"
#include "cli/beam/session.h"
#include "cli/beam/study_request.h"
#include "cli/command.h"
#include "cli/progress.h"
#include "study/ranks/ranks.h"
#include "study/scene/file.h"

enum { MOST_PARTS = 16 };

/* A chosen experiment and its scenes. Not to be moved. */
struct part {
    const struct br_extremes_experiment *experiment;
    struct br_opened_scene opened[BR_EXTREMES_SCENES]; /* scenes */
    const struct br_scene *scene[BR_EXTREMES_SCENES];
    size_t scenes;
    size_t *steps, step_count; /* of --k; owned */
    struct br_error verdict;
};

struct extremes_run {
    const struct br_options *options; /* borrowed */
    struct br_session *session;       /* borrowed */
    struct part part[MOST_PARTS];     /* parts, in registry order */
    size_t parts;
    const char *scene_word; /* NULL: none is given */
    struct br_named_methods methods;
    struct br_extremes_job job; /* as the options have it */
};

/* ---- what the options say ---- */

static const struct {
    const char *option;
    enum br_option_id id;
} own_options[] = {{"--n", BR_OPT_N}, {"--k", BR_OPT_K}, {"--methods", BR_OPT_METHODS}};
enum { OPTIONS = sizeof own_options / sizeof *own_options };

static bool accepts(const struct br_extremes_experiment *experiment, enum br_option_id option)
{
    return experiment->accepts >> option & 1;
}

/* The experiments that accept an option, as in the help: "floors, steps". */
static const char *accepting(enum br_option_id option)
{
    static char text[256];
    text[0] = '\0';
    for (const struct br_extremes_experiment *e = br_extremes_experiments; e->name; e++)
        if (accepts(e, option))
            br_append(text, sizeof text, "%s%s", *text ? ", " : "", e->name);
    return *text ? text : "no part";
}

/* With the options that it accepts. */
static const char *experiment_title(size_t row)
{
    static char text[256];
    const struct br_extremes_experiment *experiment = &br_extremes_experiments[row];
    snprintf(text, sizeof text, "%.150s.", experiment->title);
    for (size_t i = 0; i < OPTIONS; i++)
        if (accepts(experiment, own_options[i].id))
            br_append(text, sizeof text, " %s", own_options[i].option);
    return text;
}

static const char *experiment_name(size_t row)
{
    return br_extremes_experiments[row].name;
}

static const struct br_words experiments = {experiment_name, experiment_title, NULL};

/* Refuses an option that no chosen experiment accepts. */
static enum br_status check_options(const struct extremes_run *r, struct br_error *err)
{
    for (size_t i = 0; i < OPTIONS; i++) {
        bool wanted = !br_option_given(r->options, own_options[i].id);
        for (size_t e = 0; e < r->parts; e++)
            wanted |= accepts(r->part[e].experiment, own_options[i].id);
        if (!wanted)
            return br_fail(err, BR_BAD_INPUT, "%s: no chosen part uses it; it is for %s",
                           own_options[i].option, accepting(own_options[i].id));
    }
    return BR_OK;
}

/* A word that is no part is a scene. */
static enum br_status read_scene_word(struct extremes_run *r, const char *word,
                                      struct br_error *err)
{
    char path[1024];
    size_t row;
    if (r->scene_word)
        return br_fail(err, BR_BAD_INPUT, "found the scenes '%s' and '%s', expected one at most",
                       r->scene_word, word);
    r->scene_word = word;
    if (br_scene_find(word, path, sizeof path, err) == BR_OK)
        return BR_OK;
    if (!strstr(err->message, "did you mean")) {
        br_words_read(&experiments, word, strlen(word), &row, err);
        snprintf(path, sizeof path, "%.900s", err->message);
        br_fail(err, BR_BAD_INPUT, "%s; or a scene, a file or a bundled one", path);
    }
    return err->status;
}

/* Chooses the named experiments, in the registry's order; without names, all. */
static enum br_status choose_parts(struct extremes_run *r, struct br_error *err)
{
    const struct br_options *o = r->options;
    size_t named = 0;
    for (const struct br_extremes_experiment *e = br_extremes_experiments; e->name; e++) {
        size_t times = 0;
        for (size_t i = 0; i < o->words; i++)
            times += strcmp(o->word[i], e->name) == 0;
        if (times > 1)
            return br_fail(err, BR_BAD_INPUT, "part %s is given twice", e->name);
        if (times && r->parts < MOST_PARTS)
            r->part[r->parts++].experiment = e;
        named += times;
    }
    for (size_t i = 0; i < o->words && named < o->words; i++) {
        struct br_error ignored;
        size_t row;
        if (br_words_read(&experiments, o->word[i], strlen(o->word[i]), &row, &ignored) &&
            read_scene_word(r, o->word[i], err))
            return err->status;
    }
    for (size_t i = 0; !named && br_extremes_experiments[i].name && r->parts < MOST_PARTS; i++)
        r->part[r->parts++].experiment = &br_extremes_experiments[i];
    return BR_OK;
}

/* Opens the given scene for a part, or the part's own ones, and reads the time steps. */
static enum br_status open_scenes(struct extremes_run *r, struct part *p, struct br_error *err)
{
    const char *const *usual = p->experiment->scene;
    for (; p->scenes < BR_EXTREMES_SCENES && usual[p->scenes]; p->scenes++) {
        struct br_opened_scene *opened = &p->opened[p->scenes];
        if (p->scenes > 0 && r->scene_word)
            break;
        if (br_opened_scene_read(opened, r->session,
                                 r->scene_word ? r->scene_word : usual[p->scenes], err))
            return err->status;
        p->scene[p->scenes] = &opened->scene;
    }
    const char *k = r->options->text[BR_OPT_K];
    return p->scenes ? br_steps_read(k, p->scene[0], &p->steps, &p->step_count, err) : BR_OK;
}

static enum br_status read_request(struct extremes_run *r, struct br_error *err)
{
    const struct br_options *o = r->options;
    const char *methods = br_option_text(o, BR_OPT_METHODS);
    if (br_ranks_size() > 1)
        return br_fail(err, BR_BAD_INPUT,
                       "found %d ranks, expected one: its threads share the work", br_ranks_size());
    r->job = (struct br_extremes_job){
        .threads = r->session->threads,
        .n = o->whole[BR_OPT_N],
        .n_count = o->count[BR_OPT_N],
        .methods = &r->methods,
    };
    if (choose_parts(r, err) || check_options(r, err) ||
        (methods && br_named_methods_read(methods, &r->methods, err)))
        return err->status;
    for (size_t i = 0; i < r->parts; i++)
        if (open_scenes(r, &r->part[i], err))
            return err->status;
    return BR_OK;
}

/* ---- computing and writing ---- */

static enum br_status run_part(struct extremes_run *r, size_t i, struct br_error *err)
{
    struct part *p = &r->part[i];
    const struct br_extremes_experiment *experiment = p->experiment;
    const struct br_provenance provenance =
        br_provenance_of(p->scenes == 1 ? p->opened : NULL, r->session->threads);
    struct br_extremes_job job = r->job;
    char what[64];
    snprintf(what, sizeof what, "%s (%zu of %zu)", experiment->name, i + 1, r->parts);
    job.scene = p->scene;
    job.scenes = p->scenes;
    job.steps = p->steps;
    job.step_count = p->step_count;
    job.observer = br_progress_start(what, r->session->quiet);
    const struct br_extremes_output to = {r->session, &r->session->document[i], &p->verdict};
    const enum br_status status = experiment->run(&job, &to, err);
    br_progress_end();
    if (status)
        return br_failed_in(err, experiment->name);
    br_session_put_set(r->session, to.report);
    br_put_provenance(to.report, &provenance);
    return br_progress_result(status, err);
}

static enum br_status run_parts(struct extremes_run *r, struct br_error *err)
{
    enum br_status status = br_session_report(r->session, r->parts, err);
    for (size_t i = 0; i < r->parts && !status; i++)
        status = run_part(r, i, err);
    return status;
}

/* The first verdict that fails. */
static enum br_status find_verdicts(const struct extremes_run *r, struct br_error *err)
{
    for (size_t i = 0; i < r->parts; i++)
        if (r->part[i].verdict.status) {
            *err = r->part[i].verdict;
            return br_failed_in(err, r->part[i].experiment->name);
        }
    return BR_OK;
}

static void close_scenes(struct extremes_run *r)
{
    for (size_t i = 0; i < r->parts; i++) {
        for (size_t j = 0; j < BR_EXTREMES_SCENES; j++)
            br_opened_scene_clear(&r->part[i].opened[j]);
        free(r->part[i].steps);
    }
}

static enum br_status run(const struct br_options *options, struct br_session *session,
                          struct br_error *err)
{
    struct extremes_run r = {.options = options, .session = session};
    const bool failed = read_request(&r, err) || br_session_open(r.session, err) ||
                        run_parts(&r, err) || br_session_finish(r.session, err) ||
                        find_verdicts(&r, err);
    close_scenes(&r);
    return failed ? err->status : BR_OK;
}

const struct br_command br_command_extremes = {
    .bit = BR_FOR_EXTREMES,
    .name = "extremes",
    .arguments = "[PART...] [SCENE]",
    .title = "finds where a scene breaks, and whether round-off is as predicted",
    .about =
        "Each part tests one kind of extreme: it compares predictions with measurements, and "
        "writes tables and pictures. The verdict fails if a result is wrong without a warning. "
        "Without a PART all parts run. A SCENE is a file or the name of a bundled scene; without "
        "one, the paper's examples are used.",
    .more =
        "Part floors compares every linear solver with the solver plain in long double; part steps "
        "compares the round-off that many steps accumulate. Part stability marches the scene over "
        "n and k, and over c_H and k, and finds the marches that break: they are not finite, or "
        "the scheme itself adds energy. An option that no chosen part uses is refused.",
    .example = {"extremes stability impact --out stability",
                "extremes stability my_scene.yaml --methods euler+lagged,bdf2",
                "extremes floors -n 100,1000 -k 0.01"},
    .most_words = BR_MOST_WORDS,
    .words = &experiments,
    .or_scenes = true,
    .run = run,
};
