/* SPDX-License-Identifier: GPL-3.0-or-later */
/* beamrate trade SCENE|PROGRAM...: what a digit costs. */
#include <stdio.h>
#include <string.h>

#include "base/quote.h"
#include "base/text.h"
#include "base/words.h"
#include "cli/beam/session.h"
#include "cli/beam/study_request.h"
#include "cli/command.h"
#include "cli/progress.h"
#include "cli/trade.h"
#include "plots/beam/pictures.h"
#include "study/scene/file.h"
#include "study/scene/units.h"
#include "study/trade/split.h"
#include "study/trade/trade.h"
#include "tables/beam/reports.h"

/* A scene and its trials; must not be moved after br_trade_lay_out. */
struct item {
    struct br_opened_scene opened;
    size_t *steps; /* as --k has them; owned */
    struct br_trade trade;
};

struct trade_run {
    const struct br_options *options; /* borrowed */
    struct br_session *session;       /* borrowed */
    struct br_study_request study;
    struct item *item; /* items, one a scene; owned */
    size_t items;
    struct br_trade_goal goal;
    struct br_split *split; /* splits, of --split; owned */
    size_t splits;
};

/* ---- what is tried ---- */

/* All trials take about so many seconds, if neither a list nor --all asks for more. */
static const double usual_seconds = 10;

static enum br_status set_request(const struct trade_run *r, struct item *item,
                                  struct br_error *err)
{
    static const enum br_option_id listed[] = {BR_OPT_N, BR_OPT_K, BR_OPT_TOLERANCES,
                                               BR_OPTIONS}; /* given lists are tried as they are */
    const struct br_options *o = r->options;
    const struct br_scene *scene = &item->opened.scene;
    struct br_trial_request *q = &item->trade.request;
    struct br_named_method fine;
    *q = br_trial_request_default(scene);
    q->reference_kind = r->study.reference_kind;
    q->threads = r->session->threads;
    q->time_limit = br_option_number(o, BR_OPT_TIME_LIMIT, 0);
    if (!br_first_given(o, listed) && !br_option_given(o, BR_OPT_ALL))
        q->seconds = usual_seconds;
    q->norm = r->study.norm[0];
    if (!q->reference_kind || !q->reference_kind->nests)
        return BR_OK;
    if (br_named_method_read(br_highest_scheme()->name, &fine, err))
        return err->status;
    q->reference_method = fine.method;
    return br_study_request_fine(&r->study, scene, &q->reference, err);
}

/* The paper's printed table of a scene; NULL: there is none. They are of the bundled scenes only.
 */
static const struct br_printed *printed_of(const struct item *item)
{
    char path[1024];
    br_data_path("study/scenes/example1.yaml", path, sizeof path);
    if (strcmp(path, item->opened.path) == 0)
        return &br_printed_table1;
    br_data_path("study/scenes/example2.yaml", path, sizeof path);
    return strcmp(path, item->opened.path) == 0 ? &br_printed_table2 : NULL;
}

/* Keeps the methods with the default solver and friction rule: the others are never cheaper. */
static void keep_usual(struct br_named_methods *all)
{
    const struct br_method usual = br_method_default();
    size_t kept = 0;
    for (size_t i = 0; i < all->count; i++)
        if (all->list[i].method.solver == usual.solver &&
            all->list[i].method.friction == usual.friction)
            all->list[kept++] = all->list[i];
    all->count = kept;
}

static enum br_status lay_out(const struct trade_run *r, struct item *item, struct br_error *err)
{
    const struct br_options *o = r->options;
    const struct br_scene *scene = &item->opened.scene;
    size_t steps = 0;
    if (set_request(r, item, err))
        return err->status;
    if (br_steps_read(r->study.k, scene, &item->steps, &steps, err))
        return br_failed_in(err, scene->name);
    item->trade.goal = r->goal;
    if (r->study.methods.count)
        item->trade.methods = r->study.methods;
    else
        br_named_methods_default(scene, &item->trade.methods);
    if (!r->study.methods.count && br_trade_has_goal(&item->trade))
        keep_usual(&item->trade.methods);
    const struct br_trade_grid grid = {
        .n = o->whole[BR_OPT_N],
        .steps = item->steps,
        .tolerance = o->number[BR_OPT_TOLERANCES],
        .n_count = o->count[BR_OPT_N],
        .step_count = steps,
        .tolerances = o->count[BR_OPT_TOLERANCES],
        .printed = printed_of(item),
    };
    return br_trade_lay_out(&item->trade, &grid, err);
}

/* Refuses a list that no method uses. */
static enum br_status check_used(const struct trade_run *r, bool split, struct br_error *err)
{
    const struct br_options *o = r->options;
    const struct br_named_methods *methods = &r->study.methods;
    bool fixed = methods->count == 0 || split, adaptive = methods->count == 0;
    for (size_t i = 0; i < methods->count; i++) {
        fixed |= !methods->list[i].method.scheme->adaptive;
        adaptive |= methods->list[i].method.scheme->adaptive;
    }
    static const enum br_option_id of_fixed[] = {BR_OPT_STEPS, BR_OPT_K, BR_OPTIONS};
    const char *dropped = !adaptive && br_option_given(o, BR_OPT_TOLERANCES) ? "tolerance"
                          : fixed                                            ? NULL
                                  : br_first_given(o, of_fixed);
    return dropped ? br_fail(err, BR_BAD_INPUT, "--%s: no method of --methods uses it", dropped)
                   : BR_OK;
}

/* A relative error as scenes have a ratio: 1e-3, 5 %. */
static enum br_status read_error(const char *text, double *error, struct br_error *err)
{
    double value;
    struct br_unit unit;
    struct br_si_number number;
    const char *end = br_read_number(text, &value);
    if (!end || !br_unit_read(end + strspn(end, " "), &unit) ||
        !br_dimension_is(unit.of, (struct br_dimension){0}) ||
        !br_unit_convert(&unit, text, (size_t)(end - text), &number) ||
        !(number.value > 0 && number.value < 1))
        return br_fail(err, BR_BAD_INPUT,
                       "--error: found '%s', expected a relative error above 0 and below 1, like "
                       "1e-3 or 5 %%",
                       text);
    *error = number.value;
    return BR_OK;
}

/* What --error or --seconds asks for, of one scene and by a reference for all meshes and steps. */
static enum br_status read_goal(struct trade_run *r, struct br_error *err)
{
    static const enum br_option_id goals[] = {BR_OPT_ERROR, BR_OPT_SECONDS, BR_OPTIONS};
    const struct br_options *o = r->options;
    const char *error = br_option_text(o, BR_OPT_ERROR), *goal = br_first_given(o, goals);
    if (!goal)
        return BR_OK;
    if (error && br_option_given(o, BR_OPT_SECONDS))
        return br_fail(err, BR_BAD_INPUT, "expected one of --error and --seconds, found both");
    if (o->words != 1)
        return br_fail(err, BR_BAD_INPUT, "--%s: found %zu scenes, expected one", goal, o->words);
    if (r->study.reference_kind && r->study.reference_kind->nests)
        return br_fail(err, BR_BAD_INPUT,
                       "--reference: found '%s', expected a reference for any mesh and time step: "
                       "exact or mms",
                       r->study.reference_kind->name);
    r->goal.seconds = br_option_number(o, BR_OPT_SECONDS, 0);
    return error ? read_error(error, &r->goal.error, err) : BR_OK;
}

static enum br_status read_scenes(struct trade_run *r, struct br_error *err)
{
    const struct br_options *o = r->options;
    if (!(r->item = br_allocate(o->words, sizeof *r->item)))
        return br_no_memory(err, "the scenes");
    for (size_t w = 0; w < o->words; w++) {
        const size_t i = r->items;
        const struct br_scene *scene = &r->item[i].opened.scene;
        if (br_is_trade_source(o->word[w]))
            continue;
        r->items++;
        if (br_opened_scene_read(&r->item[i].opened, r->session, o->word[w], err))
            return err->status;
        for (size_t j = 0; j < i; j++)
            if (strcmp(r->item[j].opened.scene.name, scene->name) == 0)
                return br_fail(err, BR_BAD_INPUT, "scene %s is given twice", scene->name);
        if (o->words > 1 && strcmp(scene->name, BR_SUMMARY) == 0)
            return br_fail(err, BR_BAD_INPUT,
                           "%s: several scenes have a report of this name; rename the file",
                           scene->name);
    }
    return BR_OK;
}

/* ---- computing ---- */

/* A shorter forecast is not printed, s. */
static const double worth_printing = 3;

static enum br_status run_one(struct trade_run *r, struct item *item, struct br_error *err)
{
    struct br_trade *trade = &item->trade;
    const struct br_trial_forecast *o = &trade->forecast;
    const char *name = item->opened.scene.name;
    trade->request.observer = br_progress_start(name, r->session->quiet);
    enum br_status status = br_trade_estimate(trade, err);
    if (!status && !r->session->quiet && !br_trade_has_goal(trade) &&
        (o->seconds >= worth_printing || o->left > 0)) {
        br_progress_end();
        fprintf(stderr, "%s: %zu trials take about %.0f s", name, o->planned, o->seconds);
        if (o->left)
            fprintf(stderr,
                    "; %zu more, the most expensive, are left out (about %.0f s); --all tries all",
                    o->left, o->left_seconds);
        fputc('\n', stderr);
    }
    if (!status)
        status = br_trade_run(trade, err);
    br_progress_end();
    return status ? br_failed_in(err, name) : br_progress_result(status, err);
}

static enum br_status run_all(struct trade_run *r, struct br_error *err)
{
    for (size_t i = 0; i < r->items; i++) {
        const struct br_trade *t = &r->item[i].trade;
        if (!br_trade_has_goal(t))
            br_warn_of_trials(t->request.scene, t->trial, t->count);
        if (run_one(r, &r->item[i], err))
            return err->status;
        br_warn_of_trials(t->request.scene, &t->trial[t->chosen], t->chosen < t->count);
    }
    return BR_OK;
}

/* ---- results ---- */

/* A scene and what --set has set in it, as words of a command line. Owned by the caller; NULL: out
 * of memory. */
static char *words_of(const struct br_session *s, const char *name)
{
    char *text, *set = s->set ? strdup(s->set) : NULL, *rest = set;
    size_t size;
    FILE *out = s->set && !set ? NULL : br_text_open(&text, &size);
    if (out)
        br_quote(out, &br_for_shell, name);
    while (out && rest)
        br_print(out, &br_for_shell, " --set %s", strsep(&rest, "\n"));
    free(set);
    return out && fclose(out) == 0 ? text : NULL;
}

/* A report of each scene, and where there are several one of all. */
static enum br_status write_all(struct trade_run *r, struct br_error *err)
{
    const struct br_trade **trade = br_allocate(r->items, sizeof *trade);
    enum br_status status = trade ? br_session_report(r->session, r->items + (r->items > 1), err)
                                  : br_no_memory(err, "the reports");
    struct br_document *d = r->session->document;
    struct br_provenance provenance;
    for (size_t i = 0; i < r->items && !status; i++) {
        trade[i] = &r->item[i].trade;
        provenance = br_provenance_of(&r->item[i].opened, r->session->threads);
        char *words = words_of(r->session, r->options->word[i]);
        if (!words) {
            status = br_no_memory(err, "the reports");
            break;
        }
        br_report_trade(trade[i], words, &provenance, &d[i]);
        free(words);
        for (const struct br_trade_picture *p = br_trade_pictures; p->name; p++)
            br_session_draw(r->session, &d[i], br_trade_draw(p, trade[i], d[i].name, d[i].caption),
                            p->title);
    }
    if (!status && r->items > 1) {
        provenance = br_provenance_of(&r->item[0].opened, r->session->threads);
        br_report_trade_summary(trade, r->items, &provenance, &d[r->items]);
        br_session_put_set(r->session, &d[r->items]);
    }
    free(trade);
    return status ? status : br_session_finish(r->session, err);
}

/* Failed trials are results; a scene in which all failed is a failure. */
static enum br_status check(const struct trade_run *r, struct br_error *err)
{
    for (size_t i = 0; i < r->items; i++) {
        const struct br_trade *t = &r->item[i].trade;
        if (br_trade_tally(t, BR_TRIAL_FAILED) + br_trade_tally(t, BR_TRIAL_OVER) +
                br_trade_tally(t, BR_TRIAL_LEFT) ==
            t->count)
            return br_fail(err, BR_NOT_FINITE, "%s: no trial was completed; the first: %.900s",
                           r->item[i].opened.scene.name, t->trial[0].failure.message);
        if (br_trade_has_goal(t) && t->chosen == t->count)
            return br_fail(err, BR_NOT_FINITE, "%s: none of the %zu trials reaches the goal",
                           r->item[i].opened.scene.name, t->count);
    }
    return BR_OK;
}

/* ---- --split: where the error of each of some runs comes from ---- */

/* Refuses options that --split does not use. */
static enum br_status check_split(const struct br_options *o, struct br_error *err)
{
    static const enum br_option_id others[] = {BR_OPT_TIME_LIMIT, BR_OPT_ERROR,     BR_OPT_SECONDS,
                                               BR_OPT_ALL,        BR_OPT_REFERENCE, BR_OPTIONS};
    const char *other = br_first_given(o, others);
    if (other)
        return br_fail(err, BR_BAD_INPUT, "--%s: --split does not use it", other);
    if (o->words != 1)
        return br_fail(err, BR_BAD_INPUT, "--split: found %zu scenes, expected one", o->words);
    if (br_is_trade_source(o->word[0]))
        return br_fail(err, BR_BAD_INPUT, "--split: found '%s', expected a scene", o->word[0]);
    return BR_OK;
}

/* Adds the runs of a method on a mesh: by time steps or by tolerances. */
static void add_runs(struct trade_run *r, const struct br_named_method *c, size_t n,
                     size_t step_count)
{
    enum { DEFAULT_STEPS = 1000 };
    const struct br_options *o = r->options;
    const size_t tolerances = c->method.scheme->adaptive ? o->count[BR_OPT_TOLERANCES] : 0;
    for (size_t j = 0; j < (step_count ? step_count : 1); j++)
        for (size_t t = 0; t < (tolerances ? tolerances : 1); t++) {
            struct br_split *split = &r->split[r->splits++];
            *split = (struct br_split){
                .scene = &r->item->opened.scene,
                .method = c->method,
                .at = {n, step_count ? r->item->steps[j] : DEFAULT_STEPS},
                .norms = r->study.norms,
            };
            memcpy(split->norm, r->study.norm, sizeof split->norm);
            if (tolerances)
                split->method.tolerance = o->number[BR_OPT_TOLERANCES][t];
        }
}

static enum br_status lay_out_split(struct trade_run *r, struct br_error *err)
{
    static const size_t default_n[] = {100};
    const struct br_options *o = r->options;
    const struct br_named_methods *methods = &r->study.methods;
    const size_t *n = o->count[BR_OPT_N] ? o->whole[BR_OPT_N] : default_n;
    const size_t meshes = o->count[BR_OPT_N] ? o->count[BR_OPT_N] : 1;
    size_t steps;
    if (check_split(o, err) || br_study_request_read(o, &r->study, err) ||
        (r->study.methods.count == 0 && /* default: the first scheme */
         br_named_methods_read(br_time_schemes[0]->name, &r->study.methods, err)) ||
        check_used(r, true, err) || read_scenes(r, err) ||
        br_steps_read(r->study.k, &r->item->opened.scene, &r->item->steps, &steps, err))
        return err->status;
    r->split =
        br_allocate(methods->count * meshes * (steps + 1) * (o->count[BR_OPT_TOLERANCES] + 1),
                    sizeof *r->split);
    if (!r->split)
        return br_no_memory(err, "the parts of the errors");
    for (size_t c = 0; c < methods->count; c++)
        for (size_t i = 0; i < meshes; i++)
            add_runs(r, &methods->list[c], n[i], steps);
    return BR_OK;
}

static enum br_status compute_split(struct trade_run *r, struct br_error *err)
{
    const struct br_observer *observer = br_progress_start("splitting", r->session->quiet);
    enum br_status status = BR_OK;
    for (size_t i = 0; i < r->splits && !status; i++) {
        br_progress_part(i, r->splits);
        status = br_split_run(&r->split[i], r->session->threads, observer, err);
    }
    br_progress_end();
    return br_progress_result(status, err);
}

/* The picture is over k or h, where the runs differ by one of them. */
static enum br_status write_split(struct trade_run *r, struct br_error *err)
{
    const struct br_provenance provenance = br_provenance_of(&r->item->opened, r->session->threads);
    if (br_session_report(r->session, 1, err))
        return err->status;
    br_report_split(r->split, r->splits, &provenance, r->session->document);
    br_session_draw(r->session, r->session->document, br_split_draw(r->split, r->splits), NULL);
    return br_session_finish(r->session, err);
}

static bool split(struct trade_run *r, struct br_error *err)
{
    const bool writes = r->session->writes;
    return lay_out_split(r, err) || br_session_open(r->session, err) ||
           (writes && br_warn_of_splits(r->split, r->splits, err)) || compute_split(r, err) ||
           (writes && write_split(r, err));
}

/* ---- beside other programs ---- */

/* The trials of a method as the numbers of a program: bounds of their errors, in the norm's unit.
 */
static enum br_status make_numbers(const struct br_trade *t, const struct br_named_method *method,
                                   struct br_numbers *n, struct br_error *err)
{
    static const struct br_resolution_column tolerance = {"tolerance", "tolerance", BR_AXIS_TIME,
                                                          .is_size = true};
    const bool adaptive = method->method.scheme->adaptive;
    const struct br_norm *norm = t->request.norm;
    size_t rows = 0;
    for (size_t i = 0; i < t->count; i++)
        rows += t->trial[i].named == method && t->trial[i].end != BR_TRIAL_LEFT;
    if (br_numbers_make_room(n, rows, 2, err) ||
        br_numbers_add_quantity(n, norm->name, norm->unit, false, err) ||
        br_numbers_add_quantity(n, "cpu", NULL, false, err))
        return err->status;
    n->quantities = n->costs = 1;
    n->column[BR_AXIS_SPACE] = br_resolution_column_find("n");
    n->column[BR_AXIS_TIME] = adaptive ? &tolerance : br_resolution_column_find("k");
    struct br_numbers_row *row = n->row;
    for (const struct br_trial *trial = t->trial; trial < t->trial + t->count; trial++) {
        if (trial->named != method || trial->end == BR_TRIAL_LEFT)
            continue;
        row->given[BR_AXIS_SPACE] = (double)trial->at.n;
        row->z[BR_AXIS_SPACE] = 1 / (double)trial->at.n;
        row->given[BR_AXIS_TIME] = row->z[BR_AXIS_TIME] =
            adaptive ? trial->tolerance : t->request.scene->duration / (double)trial->at.steps;
        *row->number = br_trial_bound(trial) * trial->scale;
        row->number[1] = br_trial_seconds(trial);
        row->failure = trial->failure.status ? strdup(trial->failure.message) : NULL;
        row++;
    }
    br_numbers_sort(n);
    return BR_OK;
}

/* Of the methods that are named; else of those that are the cheapest ones to some error. */
static bool is_shown(const struct trade_run *r, const struct br_trade *t, size_t method)
{
    bool shown = r->study.methods.count;
    for (size_t i = 0; i < BR_TRADE_DIGITS && !shown; i++)
        shown = t->best[i] < t->count && t->trial[t->best[i]].named == &t->methods.list[method];
    return shown;
}

/* Scenes and programs: what digits cost in all. */
static enum br_status beside(struct trade_run *r, struct br_error *err)
{
    size_t most = 1, count = 0;
    for (size_t i = 0; i < r->items; i++)
        most += r->item[i].trade.methods.count;
    struct br_work_source *source = br_allocate(most, sizeof *source);
    enum br_status status = source ? BR_OK : br_no_memory(err, "the trials");
    for (size_t i = 0; i < r->items && !status; i++) {
        const struct br_trade *t = &r->item[i].trade;
        for (size_t m = 0; m < t->methods.count && !status; m++) {
            if (!is_shown(r, t, m))
                continue;
            struct br_work_source *s = &source[count++];
            s->path = t->request.scene->name;
            snprintf(s->name, sizeof s->name, "%.100s %s", s->path, t->methods.list[m].name);
            status = make_numbers(t, &t->methods.list[m], &s->numbers, err);
        }
    }
    if (!status)
        status = br_trade_sources(r->options, r->session, source, count, err);
    br_work_sources_clear(source, count);
    return status;
}

/* Refuses what programs do not use. */
static enum br_status check_programs(const struct br_options *o, size_t programs,
                                     struct br_error *err)
{
    enum { OF_SCENES = 10 }; /* scenes beside programs use them */
    static const enum br_option_id of_programs[] = {BR_OPT_COST, BR_OPT_TRUST, BR_OPTIONS};
    static const enum br_option_id unused[] = {
        BR_OPT_N,       BR_OPT_K,          BR_OPT_STEPS,      BR_OPT_REFERENCE, BR_OPT_NORM,
        BR_OPT_METHODS, BR_OPT_TOLERANCES, BR_OPT_TIME_LIMIT, BR_OPT_ALL,       BR_OPT_SET,
        BR_OPT_THREADS, BR_OPT_ERROR,      BR_OPT_SECONDS,    BR_OPT_SPLIT,     BR_OPTIONS};
    const size_t from = programs < o->words ? OF_SCENES : 0;
    const char *name = br_first_given(o, programs ? unused + from : of_programs);
    return !name       ? BR_OK
           : !programs ? br_fail(err, BR_BAD_INPUT,
                                 "--%s: found scenes alone, expected a study file or a table", name)
           : strcmp(name, "threads") == 0
               ? br_fail(err, BR_BAD_INPUT, "--threads: runs are timed one at a time")
               : br_fail(err, BR_BAD_INPUT, "--%s: programs do not use it", name);
}

static bool trade(struct trade_run *r, struct br_error *err)
{
    size_t programs = 0;
    for (size_t i = 0; i < r->options->words; i++)
        programs += br_is_trade_source(r->options->word[i]);
    if (check_programs(r->options, programs, err))
        return true;
    if (programs == r->options->words)
        return br_trade_sources(r->options, r->session, NULL, 0, err);
    if (br_session_alone(err) || br_study_request_read(r->options, &r->study, err))
        return true;
    if (r->study.norms > 1)
        return br_fail(err, BR_BAD_INPUT, "--norm: found %zu norms, expected one", r->study.norms);
    if (check_used(r, false, err) || read_goal(r, err) || read_scenes(r, err))
        return true;
    for (size_t i = 0; i < r->items; i++)
        if (lay_out(r, &r->item[i], err))
            return true;
    if (programs)
        return run_all(r, err) || check(r, err) || beside(r, err);
    return br_session_open(r->session, err) || run_all(r, err) || write_all(r, err) ||
           check(r, err);
}

static enum br_status run(const struct br_options *options, struct br_session *session,
                          struct br_error *err)
{
    struct trade_run r = {.options = options, .session = session};
    const bool failed = br_option_given(options, BR_OPT_SPLIT) ? split(&r, err) : trade(&r, err);
    for (size_t i = 0; i < r.items; i++) {
        br_trade_clear(&r.item[i].trade);
        br_opened_scene_clear(&r.item[i].opened);
        free(r.item[i].steps);
    }
    free(r.item);
    free(r.split);
    return failed ? err->status : BR_OK;
}

const struct br_command br_command_trade = {
    .bit = BR_FOR_TRADE,
    .name = "trade",
    .arguments = "SCENE|PROGRAM...",
    .title = "what a digit costs: errors against seconds of many methods, or of any programs",
    .about =
        "Measures the relative error of many methods at many resolutions, and the CPU seconds of "
        "their marches in one thread. The results are work-precision diagrams with the Pareto "
        "front, the cheapest way to an error of 1e-2, 1e-3, ... 1e-10, and all trials. Without "
        "--methods all time schemes are tried, and with one of them the other friction rules and "
        "linear solvers. Without -n and -k the trials are on a coarse grid and at the cells of the "
        "paper's table. With --error or --seconds the answer is the way to take: the cheapest one "
        "to that error, or the most accurate one within these seconds, and command lines that "
        "march it.",
    .more = BR_TRADE_ABOUT
    " Scenes may stand beside programs that measure the error in their norm, by "
    "the name of the norm. For several scenes there is a summary, too. A goal is searched from the cheapest "
    "trials on, until nothing cheaper is left, then on a finer grid around the best two "
    "methods; meshes and steps that are given are tried as they are. If no trial reaches "
    "it, the exit code is 3.",
    .example = {"trade example2 --methods euler+lagged,euler+implicit -n 25,100 -k 0.1,0.01",
                "trade example1 example3 --methods bdf2,adaptive -n 50 -k 0.05,0.01 --time-limit 2",
                "trade example2 --error 1e-3", "trade fd.csv sparse4.csv",
                "trade example2 --split --methods euler+lagged,euler+implicit -k 0.1,0.01"},
    .least_words = 1,
    .most_words = BR_MOST_WORDS,
    .run = run,
};
