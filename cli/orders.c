/* SPDX-License-Identifier: GPL-3.0-or-later */
/* beamrate orders FILE | --run COMMAND: the orders of any program's numbers. */
#include <stdio.h>
#include <string.h>

#include "base/clock.h"
#include "base/words.h"
#include "cli/command.h"
#include "cli/progress.h"
#include "cli/provenance.h"
#include "cli/verdicts.h"
#include "plots/pictures.h"

struct orders_run {
    const struct br_options *options; /* borrowed */
    struct br_session *session;       /* borrowed */
    struct br_study_file study;
    struct br_check check;
    struct br_verdicts verdicts;
    char cache[1100]; /* the folder of finished runs */
    double wall_seconds;
};

/* ---- the request ---- */

/* What a study file says, too; the first SETTINGS in the words of its keys. */
enum { SETTINGS = 10 };
static const enum br_option_id of_request[] = {
    BR_OPT_RUN,     BR_OPT_REPEAT, BR_OPT_COLUMN, BR_OPT_WHERE,      BR_OPT_FINEST,
    BR_OPT_WITHOUT, BR_OPT_ERROR,  BR_OPT_VALUE,  BR_OPT_DIMENSION,  BR_OPT_FORMAL,
    BR_OPT_N,       BR_OPT_K,      BR_OPT_READ,   BR_OPT_TIME_LIMIT, BR_OPTIONS};

static enum br_status read_settings(const struct br_options *o, struct br_orders_request *q,
                                    struct br_error *err)
{
    struct br_error inner = {0};
    for (size_t i = 0; i < SETTINGS; i++) {
        const char *name = br_first_given(o, (enum br_option_id[]){of_request[i], BR_OPTIONS});
        if (name && br_orders_request_set(q, name, br_option_text(o, of_request[i]), &inner))
            return br_fail(err, inner.status, "--%s: %s", name, inner.message);
    }
    return BR_OK;
}

/* Reads "NAME=WHAT", one on each line. */
static enum br_status read_readings(const char *text, struct br_orders_request *q,
                                    struct br_error *err)
{
    char *copy = text ? strdup(text) : NULL, *rest;
    bool failed = text && !copy && br_no_memory(err, "the options");
    for (char *line = copy ? strtok_r(copy, "\n", &rest) : NULL; line && !failed;
         line = strtok_r(NULL, "\n", &rest)) {
        char *equals = strchr(line, '=');
        if (!equals || equals == line)
            failed = br_fail(err, BR_BAD_INPUT,
                             "--read: found '%s', expected NAME=REGEX, NAME=json:POINTER or "
                             "NAME=csv:COLUMN",
                             line);
        else {
            *equals = '\0';
            failed = br_orders_request_reading(q, line, equals + 1, err);
        }
    }
    free(copy);
    return failed ? err->status : BR_OK;
}

/* Reads a list of resolutions, "10,20,40" or "dofs=100,400"; usual: what it has without a word. */
static enum br_status read_list(const char *list, const char *usual, struct br_orders_request *q,
                                struct br_error *err)
{
    const enum br_axis axis = br_resolution_column_find(usual)->axis;
    const char *equals = list ? strchr(list, '=') : NULL, *names[16];
    char word[32], expected[BR_EXPECTED];
    size_t count = 0;
    snprintf(word, sizeof word, "%.*s", equals ? (int)(equals - list) : 0, equals ? list : "");
    if (!equals)
        return list ? br_orders_request_axis(q, usual, list, err) : BR_OK;
    for (const struct br_resolution_column *c = br_resolution_columns; c->name; c++)
        if (c->axis == axis) {
            names[count++] = c->name;
            if (strcmp(c->name, word) == 0)
                return br_orders_request_axis(q, word, equals + 1, err);
        }
    return br_fail(err, BR_BAD_INPUT, "--%s: found '%s=', %s", usual, word,
                   br_expected(word, names, count, expected));
}

/* Reads the options that come with a table or with --run. A table refuses those of a run. */
static enum br_status read_options(const struct br_options *o, struct br_orders_request *q,
                                   struct br_error *err)
{
    static const enum br_option_id of_runs[] = {BR_OPT_N,      BR_OPT_K,      BR_OPT_TIME_LIMIT,
                                                BR_OPT_RESUME, BR_OPT_REPEAT, BR_OPTIONS};
    static const enum br_option_id of_tables[] = {BR_OPT_COLUMN, BR_OPT_WHERE, BR_OPTIONS};
    const char *unused = q->command ? NULL : br_first_given(o, of_runs);
    const char *of_table = q->command ? br_first_given(o, of_tables) : NULL;
    q->seconds = br_option_number(o, BR_OPT_TIME_LIMIT, q->seconds);
    if (unused)
        return br_fail(err, BR_BAD_INPUT, "--%s is given without --run", unused);
    if (of_table)
        return br_fail(err, BR_BAD_INPUT, "--%s is given beside --run, expected a table", of_table);
    if (br_option_given(o, BR_OPT_TRUST))
        return br_fail(err, BR_BAD_INPUT, "--trust is given without a study file");
    if (br_option_given(o, BR_OPT_READ) != !!q->command)
        return br_fail(err, BR_BAD_INPUT,
                       "--run needs --read, and --read needs --run: found one of the two");
    if (read_list(br_option_text(o, BR_OPT_N), "n", q, err) ||
        read_list(br_option_text(o, BR_OPT_K), "k", q, err))
        return err->status;
    return read_readings(br_option_text(o, BR_OPT_READ), q, err);
}

/* A study file refuses options for what it has. */
static enum br_status read_file(const char *path, const struct br_options *o,
                                struct br_study_file *study, struct br_error *err)
{
    if (br_is_yaml(path) && br_first_given(o, of_request))
        return br_fail(err, BR_BAD_INPUT,
                       "%s: an option repeats what the study file says: give it in one place",
                       path);
    return br_study_file_open(path, o, study, err);
}

static enum br_status begin_run(struct br_orders_request *q, struct br_error *err)
{
    *q = br_orders_request_default();
    q->path = strdup("--run");
    return q->path ? BR_OK : br_no_memory(err, "the options");
}

static enum br_status read_request(struct orders_run *r, struct br_error *err)
{
    const struct br_options *o = r->options;
    const char *word = o->words ? o->word[0] : NULL;
    struct br_orders_request *q = &r->study.request;
    if (br_option_given(o, BR_OPT_RUN) == !!word)
        return br_fail(err, BR_BAD_INPUT,
                       word ? "--run and a file are given, expected one of the two"
                            : "no file is given, expected a table, a study file, or --run");
    if ((word ? read_file(word, o, &r->study, err) : begin_run(q, err)) ||
        (!(word && br_is_yaml(word)) && (read_settings(o, q, err) || read_options(o, q, err))))
        return err->status;
    const char *expect = br_option_text(o, BR_OPT_EXPECT);
    struct br_error inner = {0};
    if (!expect || !br_expectations_read(expect, 0, &q->expectation, &q->expectations, &inner))
        return BR_OK;
    return br_fail(err, inner.status, "--expect: %s", inner.message);
}

/* Checks all that can be checked before a program is run. */
static enum br_status prepare(struct orders_run *r, struct br_error *err)
{
    const struct br_options *o = r->options;
    static const enum br_option_id of_verdicts[] = {BR_OPT_COMPARE, BR_OPT_UPDATE_BASELINE,
                                                    BR_OPT_JUNIT,   BR_OPT_MARKDOWN,
                                                    BR_OPT_GITHUB,  BR_OPTIONS};
    r->check = br_study_file_check(&r->study, o);
    if (r->study.request.expectations == 0 && br_first_given(o, of_verdicts))
        return br_fail(err, BR_BAD_INPUT,
                       "there is no verdict to write or compare: give --expect, or 'verify:' in "
                       "a study file");
    const bool failed = br_verdicts_open(&r->verdicts, o, &r->check, 1, err) ||
                        br_verdicts_spare(&r->verdicts, r->study.request.table_path, err) ||
                        br_session_open(r->session, err);
    const bool open = br_output_is_open(&r->session->output);
    snprintf(r->cache, sizeof r->cache, open ? "%s/.cache" : "%sorders-cache",
             open ? r->session->output.folder : "");
    r->study.request.cache = r->cache;
    return failed ? err->status : BR_OK;
}

/* ---- computing ---- */

static enum br_status compute(struct orders_run *r, struct br_error *err)
{
    const double start = br_seconds();
    const bool quiet = r->session->quiet || !r->study.request.command;
    r->study.request.observer = br_progress_start("running", quiet);
    const enum br_status status = br_study_file_run(&r->study, &r->check, err);
    r->wall_seconds = br_seconds() - start;
    br_progress_end();
    return br_progress_result(status, err);
}

/* ---- results ---- */

static enum br_status build_report(struct orders_run *r, struct br_document *d,
                                   struct br_error *err)
{
    const char *caption = r->check.name;
    struct br_estimate growth[BR_AXES];
    for (int axis = 0; axis < BR_AXES; axis++)
        if (br_orders_growth(&r->study.orders, (enum br_axis)axis, &growth[axis], err))
            return err->status;
    struct br_provenance provenance;
    br_provenance_fill(&provenance, r->session->threads);
    br_report_orders(&r->study.orders, growth, caption, d);
    if (br_output_is_open(&r->session->output))
        br_session_draw(r->session, d, br_orders_draw(&r->study.orders, caption),
                        "Errors, or values, over the size");
    br_put_provenance(d, &provenance);
    return BR_OK;
}

/* Writes the orders, and the verdicts where something is expected. */
static enum br_status write_all(struct orders_run *r, struct br_error *err)
{
    const struct br_check_findings findings = {
        .checks = &r->check, .count = 1, .wall_seconds = r->wall_seconds};
    const bool checked = r->study.request.expectations > 0;
    if (br_session_report(r->session, checked ? 2 : 1, err) ||
        build_report(r, &r->session->document[0], err))
        return err->status;
    return checked ? br_verdicts_finish(&r->verdicts, r->session, &findings, true, err)
                   : br_verdicts_write(&r->verdicts, r->session, NULL, err);
}

static enum br_status run(const struct br_options *options, struct br_session *session,
                          struct br_error *err)
{
    static struct orders_run r;
    r = (struct orders_run){.options = options, .session = session};
    const bool failed = br_session_alone(err) || read_request(&r, err) || prepare(&r, err) ||
                        compute(&r, err) || write_all(&r, err) ||
                        br_numbers_check_runs(&r.study.numbers, err);
    br_verdicts_clear(&r.verdicts);
    br_check_clear(&r.check);
    br_study_file_clear(&r.study);
    return failed ? err->status : BR_OK;
}

const struct br_command br_command_orders = {
    .bit = BR_FOR_ORDERS,
    .name = "orders",
    .arguments = "FILE",
    .title = "order of convergence of any program's errors, GCI of its values",
    .about = "The orders of convergence of numbers from any program: of a table in a file (- is "
             "standard input), of a program that is run at each resolution "
             "(--run), or of a study file (.yaml) that says either.",
    .more =
        "A table is read as programs write it: CSV, tabs, semicolons with decimal commas, blanks, "
        "Markdown, LaTeX, lines of 'h = 0.1  e = 0.2', exponents of Fortran. Columns h, n, level "
        "or dofs, or other usual names like dx, Mesh size, N, cells, ndofs, give the mesh; k, dt, "
        "nt or steps give the time step; a unit may follow in brackets. A line says how each "
        "column was read. Columns of rates, times and iterations are left aside. Errors get orders "
        "with 95 % intervals, along lines and jointly in h and k; values get the limit, and the "
        "grid convergence index. Rows at a floor are left out by name. With --expect or 'verify:' "
        "there are verdicts, as 'check' has them.",
    .example = {"orders errors.csv --error l2,h1 --expect 'l2: h 2 +- 0.1'",
                "orders drag.csv --value drag",
                "orders --run './poisson {n}' -n 10,20,40,80 --read 'l2=error ([^ ]+)'"},
    .most_words = 1,
    .run = run,
};
