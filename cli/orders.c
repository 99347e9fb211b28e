/* SPDX-License-Identifier: GPL-3.0-or-later */
/* beamrate orders FILE | --run COMMAND: the orders of any program's numbers. */
#include <stdio.h>
#include <string.h>

#include "cli/command.h"
#include "cli/progress.h"
#include "cli/study_file.h"
#include "cli/verdicts.h"
#include "plots/pictures.h"
#include "solver/clock.h"
#include "study/scene/file.h"

struct run {
    struct br_session session;
    struct br_study_file study;
    struct br_check check;
    struct br_verdicts verdicts;
    double wall_seconds;
};

/* ---- what is asked ---- */

static enum br_status copy_text(const char *text, char **to, struct br_error *err)
{
    *to = text ? strdup(text) : NULL;
    return text && !*to ? br_no_memory(err, "the options") : BR_OK;
}

/* "NAME=WHAT", a line each. */
static enum br_status read_readings(const char *text, struct br_orders_request *q,
                                    struct br_error *err)
{
    enum br_status status = BR_OK;
    for (const char *at = text; at && *at && !status;) {
        const size_t length = strcspn(at, "\n"), name = strcspn(at, "=\n");
        char *line = strndup(at, length);
        if (!line)
            return br_no_memory(err, "the options");
        if (name == 0 || name >= length)
            status = br_fail(err, BR_BAD_INPUT,
                             "--read: found '%s', expected NAME=REGEX, NAME=json:POINTER or "
                             "NAME=csv:COLUMN",
                             line);
        line[name < length ? name : 0] = '\0';
        if (!status)
            status = br_orders_request_reading(q, line, line + name + 1, err);
        free(line);
        at += length + (at[length] == '\n');
    }
    return status;
}

/* The options beside the file. Those of a run are refused beside a file. */
static enum br_status read_options(const struct br_options *o, struct br_orders_request *q,
                                   struct br_error *err)
{
    static const struct {
        enum br_option_id id;
        const char *column;
    } lists[] = {{BR_OPT_N, "n"}, {BR_OPT_DOFS, "dofs"}, {BR_OPT_K, "k"}, {BR_OPT_STEPS, "steps"}};
    enum br_status status = BR_OK;
    q->dimension = br_option_number(o, BR_OPT_DIMENSION, q->dimension);
    q->formal = br_option_number(o, BR_OPT_FORMAL, q->formal);
    q->seconds = br_option_number(o, BR_OPT_TIME_LIMIT, q->seconds);
    for (size_t i = 0; i < sizeof lists / sizeof *lists && !status; i++) {
        const char *list = br_option_text(o, lists[i].id);
        if (list && !q->command)
            status = br_fail(err, BR_BAD_INPUT, "--%s is given without --run", lists[i].column);
        else if (list)
            status = br_orders_request_axis(q, lists[i].column, list, err);
    }
    static const struct {
        enum br_option_id id;
        const char *name;
    } of_runs[] = {{BR_OPT_TIME_LIMIT, "time-limit"},
                   {BR_OPT_KEEP, "keep"},
                   {BR_OPT_RESUME, "resume"},
                   {BR_OPT_TRUST, "trust"}};
    for (size_t i = 0; i < sizeof of_runs / sizeof *of_runs && !status; i++)
        if (br_option_given(o, of_runs[i].id) && (!q->command || of_runs[i].id == BR_OPT_TRUST))
            status = br_fail(err, BR_BAD_INPUT, "--%s is given without %s", of_runs[i].name,
                             of_runs[i].id == BR_OPT_TRUST ? "a study file" : "--run");
    if (!status && br_option_given(o, BR_OPT_READ) != !!q->command)
        status =
            br_fail(err, BR_BAD_INPUT, "--run and --read belong together, found one of the two");
    if (!status)
        status = read_readings(br_option_text(o, BR_OPT_READ), q, err);
    if (!status)
        status = copy_text(br_option_text(o, BR_OPT_ERROR), &q->errors, err);
    if (!status)
        status = copy_text(br_option_text(o, BR_OPT_VALUE), &q->values, err);
    return status;
}

static enum br_status read_program(const struct br_options *o, struct br_orders_request *q,
                                   struct br_error *err)
{
    *q = br_orders_request_default();
    enum br_status status = copy_text(br_option_text(o, BR_OPT_RUN), &q->command, err);
    if (!status)
        status = copy_text("--run", &q->path, err);
    return status ? status : read_options(o, q, err);
}

static enum br_status read_table(const char *path, const struct br_options *o,
                                 struct br_orders_request *q, struct br_error *err)
{
    *q = br_orders_request_default();
    const bool standard = strcmp(path, "-") == 0;
    enum br_status status = copy_text(standard ? "standard input" : path, &q->path, err);
    if (!status)
        status =
            br_text_load(standard ? "/dev/stdin" : path, BR_LONGEST_TABLE, "table", &q->table, err);
    return status ? status : read_options(o, q, err);
}

static bool ends_with(const char *text, const char *end)
{
    const size_t length = strlen(text), wanted = strlen(end);
    return length >= wanted && strcmp(text + length - wanted, end) == 0;
}

/* A study file says all by itself. */
static enum br_status read_study(const char *path, const struct br_options *o,
                                 struct br_study_file *study, struct br_error *err)
{
    static const enum br_option_id refused[] = {
        BR_OPT_N,     BR_OPT_DOFS,      BR_OPT_K,      BR_OPT_STEPS, BR_OPT_ERROR,
        BR_OPT_VALUE, BR_OPT_DIMENSION, BR_OPT_FORMAL, BR_OPT_READ,  BR_OPT_TIME_LIMIT};
    char *text = NULL;
    for (size_t i = 0; i < sizeof refused / sizeof *refused; i++)
        if (br_option_given(o, refused[i]))
            return br_fail(err, BR_BAD_INPUT,
                           "%s: what the study file says is given as an option, too, expected one "
                           "of the two",
                           path);
    enum br_status status = br_scene_load(path, &text, err);
    if (!status)
        status = br_study_file_read(path, text, o, study, err);
    free(text);
    return status;
}

static enum br_status read_request(struct run *r, struct br_error *err)
{
    const struct br_options *o = r->session.options;
    const char *word = o->words ? o->word[0] : NULL;
    struct br_orders_request *q = &r->study.request;
    if (br_option_given(o, BR_OPT_RUN) == !!word)
        return br_fail(err, BR_BAD_INPUT,
                       word ? "--run and a file are given, expected one of the two"
                            : "no file is given, expected a table, a study file, or --run");
    enum br_status status = !word ? read_program(o, q, err)
                            : ends_with(word, ".yaml") || ends_with(word, ".yml")
                                ? read_study(word, o, &r->study, err)
                                : read_table(word, o, q, err);
    const char *expect = br_option_text(o, BR_OPT_EXPECT);
    if (!status && expect)
        status =
            br_expectations_read("--expect", expect, 0, &q->expectation, &q->expectations, err);
    q->jobs = r->session.threads;
    q->kept = br_option_text(o, BR_OPT_KEEP);
    q->anew = !br_option_given(o, BR_OPT_RESUME);
    return status;
}

/* What can be refused is refused before a program is run. */
static enum br_status prepare(struct run *r, struct br_error *err)
{
    const struct br_options *o = r->session.options;
    static const enum br_option_id of_verdicts[] = {
        BR_OPT_COMPARE, BR_OPT_UPDATE_BASELINE, BR_OPT_JUNIT, BR_OPT_JSON,
        BR_OPT_TAP,     BR_OPT_MARKDOWN,        BR_OPT_GITHUB};
    r->check = br_study_file_check(&r->study);
    for (size_t i = 0; i < sizeof of_verdicts / sizeof *of_verdicts; i++)
        if (br_option_given(o, of_verdicts[i]) && r->study.request.expectations == 0)
            return br_fail(err, BR_BAD_INPUT,
                           "nothing is expected, so there are no verdicts to be written or "
                           "compared: give --expect, or 'verify:' in a study file");
    enum br_status status = br_verdicts_open(&r->verdicts, o, &r->check, 1, err);
    if (!status)
        status = br_verdicts_spare(&r->verdicts, r->study.request.table_path, err);
    return status ? status : br_session_open(&r->session, err);
}

/* ---- computing ---- */

static enum br_status compute(struct run *r, struct br_error *err)
{
    const double start = br_seconds();
    const bool runs = r->study.request.command;
    if (runs)
        r->study.request.observer = br_progress_start("running", r->session.quiet);
    const enum br_status status = br_study_file_run(&r->study, &r->check, err);
    r->wall_seconds = br_seconds() - start;
    if (!runs)
        return status;
    br_progress_end();
    return br_progress_result(status, err);
}

/* ---- results ---- */

static enum br_status build_report(struct run *r, struct br_document *d, struct br_error *err)
{
    const char *caption = r->check.name;
    struct br_estimate growth[BR_AXES];
    for (int axis = 0; axis < BR_AXES; axis++)
        if (br_orders_growth(&r->study.orders, (enum br_axis)axis, &growth[axis], err))
            return err->status;
    const struct br_provenance provenance = br_provenance_of(NULL, r->session.threads);
    br_report_orders(&r->study.orders, growth, caption, d);
    if (br_output_is_open(&r->session.output))
        br_session_draw(&r->session, d, br_orders_draw(&r->study.orders, caption),
                        "Errors over the size of elements and steps");
    br_put_provenance(d, &provenance);
    return BR_OK;
}

/* The orders, and where something is expected the verdicts behind them. */
static enum br_status write_all(struct run *r, struct br_error *err)
{
    const struct br_check_findings findings = {
        .checks = &r->check, .count = 1, .wall_seconds = r->wall_seconds};
    const bool judged = r->study.request.expectations > 0;
    enum br_status status = br_session_report(&r->session, judged ? 2 : 1, err);
    if (!status)
        status = build_report(r, &r->session.document[0], err);
    if (!status && !judged)
        return br_session_finish(&r->session, err);
    if (!status)
        status = br_verdicts_report(&r->verdicts, &findings, true, r->session.threads,
                                    &r->session.document[1], err);
    if (!status)
        status = br_verdicts_finish(&r->verdicts, &r->session, err);
    return status ? status : br_verdicts_conclude(&r->verdicts, &r->check, 1, err);
}

/* Runs without a number fail the command, after everything has been written. */
static enum br_status check_rows(const struct run *r, struct br_error *err)
{
    size_t failed = 0;
    const struct br_numbers_row *first = NULL;
    for (size_t i = 0; i < r->study.numbers.rows; i++)
        if (r->study.numbers.row[i].failure) {
            first = first ? first : &r->study.numbers.row[i];
            failed++;
        }
    return failed ? br_fail(err, BR_NOT_FINITE, "%zu of %zu runs failed; the first: %s", failed,
                            r->study.numbers.rows, first->failure)
                  : BR_OK;
}

static enum br_status run(const struct br_options *options, struct br_error *err)
{
    static struct run r;
    r = (struct run){.session = br_session_begin(options)};
    const bool failed = br_session_alone(err) || read_request(&r, err) || prepare(&r, err) ||
                        compute(&r, err) || write_all(&r, err) || check_rows(&r, err);
    const enum br_status status = failed ? err->status : BR_OK;
    br_verdicts_clear(&r.verdicts);
    br_check_clear(&r.check);
    br_study_file_clear(&r.study);
    br_session_close(&r.session);
    return status;
}

const struct br_command br_command_orders = {
    .bit = BR_FOR_ORDERS,
    .name = "orders",
    .arguments = "FILE",
    .title = "the orders of any program's errors or values",
    .about = "The orders of convergence of numbers from any program: of a table in a file (CSV, "
             "TSV, JSON lines; - is standard input), of a program that is run at each resolution "
             "(--run), or of a study file (.yaml) that says either.",
    .more =
        "Columns h, n or dofs tell the mesh, k, dt or steps the time step; a unit may follow in "
        "brackets. Errors get orders with 95 % intervals, along lines and jointly in h and k; "
        "values get the limit, and the grid convergence index. Rows at a floor are left out by "
        "name. With --expect or 'verify:' there are verdicts, as 'check' has them.",
    .example = {"beamrate orders errors.csv --error l2,h1 --expect 'l2: h 2 +- 0.1'",
                "beamrate orders drag.csv --value drag",
                "beamrate orders --run './poisson {n}' -n 10,20,40,80 --read 'l2=error ([^ ]+)'"},
    .most_words = 1,
    .run = run,
};
