/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/plan_options.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/names.h"
#include "cli/number_option.h"
#include "cli/parse.h"
#include "tables/document.h"

static const char usage[] =
    "SCENE --error E | --seconds S [OPTION...]\n\nThe cheapest way to a relative error, or the "
    "least error for some seconds of the processor:\nmodels of errors and costs are fitted to "
    "cheap runs, and propose a method with n and k (or a\ntolerance); that is run, and what it "
    "shows improves the models, until nothing that would cost\nless is likely to do. Out come what "
    "was predicted and what was achieved, and a command line\nthat repeats it.\n\nExamples:\n"
    "  beamrate plan example2 --error 1e-3\n"
    "  beamrate plan example3 --error 1e-4 --methods bdf2,esdirk3,adaptive --out plan\n"
    "  beamrate plan example2 --seconds 1e-3 --methods euler+implicit,adaptive\n";

static void print_names(FILE *out)
{
    br_print_contender_words(out);
    fprintf(out, "Formats (--format):\n ");
    for (const struct br_document_format *const *e = br_document_formats; *e; e++)
        fprintf(out, " %s", (*e)->name);
    fputc('\n', out);
}

enum br_status br_plan_options_parse(int argc, const char **argv, struct br_plan_options *o,
                                     struct br_error *err)
{
    struct br_study_options *s = &o->study;
    struct poptOption table[] = {
        {"error", 0, POPT_ARG_STRING, &o->error, 0, "relative error that is wanted, at most", "E"},
        {"seconds", 0, POPT_ARG_STRING, &o->seconds, 0, "seconds of a march, at most", "S"},
        {"methods", 0, POPT_ARG_STRING, &o->methods, 0,
         "methods to choose from, by the names below (default: all time schemes)", "LIST"},
        {"norm", 0, POPT_ARG_STRING, &s->norm, 0, "norm of the error (default l2)", "NAME"},
        {"reference", 0, POPT_ARG_STRING, &s->reference, 0, "judge of the errors: exact or mms",
         "NAME"},
        {"repeats", 0, POPT_ARG_STRING, &o->repeats, 0,
         "timed marches of a proposal after a warm-up, at most (default 3)", "COUNT"},
        {"time-limit", 0, POPT_ARG_STRING, &o->time_limit, 0,
         "longest march and set-up, s (default 60)", "SECONDS"},
        {"threads", 0, POPT_ARG_STRING, &s->threads, 0,
         "threads of the errors; 0, the default: all cores", "COUNT"},
        {"out", 0, POPT_ARG_STRING, &s->out, 0, "folder of the results (default: none written)",
         "DIR"},
        {"format", 0, POPT_ARG_STRING, &s->format, 0,
         "formats to write (default all): any of those below", "LIST"},
        {"quiet", 0, POPT_ARG_NONE, &s->quiet, 0, "no progress, nothing on the terminal", NULL},
        BR_PARSE_HELP_ROW,
        POPT_TABLEEND,
    };
    return br_parse(argc, argv,
                    &(struct br_parse){.table = table,
                                       .usage = usage,
                                       .print_below = print_names,
                                       .help = &s->help,
                                       .read_words = br_parse_scene,
                                       .self = &o->scene},
                    err);
}

void br_plan_options_clear(struct br_plan_options *o)
{
    char **texts[] = {&o->methods, &o->error, &o->seconds, &o->repeats, &o->time_limit, &o->scene};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        free(*texts[i]);
        *texts[i] = NULL;
    }
    br_study_options_clear(&o->study);
}

static enum br_status read_goal(const struct br_plan_options *o, struct br_plan_goal *goal,
                                struct br_error *err)
{
    if (!o->error == !o->seconds)
        return br_fail(err, BR_BAD_INPUT, "expected one of --error and --seconds, found %s",
                       o->error ? "both" : "none");
    *goal = (struct br_plan_goal){NAN, NAN};
    const enum br_status status = br_read_number_option("error", o->error, 0, 1, &goal->error, err);
    return status ? status
                  : br_read_number_option("seconds", o->seconds, 0, INFINITY, &goal->seconds, err);
}

static enum br_status check_study(const struct br_study_request *r, struct br_error *err)
{
    if (r->norms > 1)
        return br_fail(err, BR_BAD_INPUT, "--norm: found %zu norms, expected one", r->norms);
    if (r->judge && (!r->judge->create || r->judge->nests))
        return br_fail(
            err, BR_BAD_INPUT,
            "--reference: found '%s', expected a judge of any mesh and step: exact or mms",
            r->judge->name);
    return BR_OK;
}

static enum br_status read_repeats(const char *text, size_t *repeats, struct br_error *err)
{
    int value = 0;
    const enum br_status status = br_read_count_option("repeats", text, 1000, &value, err);
    if (!status && text && value == 0)
        return br_fail(err, BR_BAD_INPUT,
                       "--repeats: found '%s', expected a whole number from 1 to 1000", text);
    *repeats = (size_t)value;
    return status;
}

enum br_status br_plan_wish_read(const struct br_plan_options *o, struct br_plan_wish *w,
                                 struct br_error *err)
{
    *w = (struct br_plan_wish){.time_limit = NAN};
    enum br_status status = br_study_request_read(&o->study, &w->study, err);
    if (!status)
        status = check_study(&w->study, err);
    if (!status)
        status = read_goal(o, &w->goal, err);
    if (!status && o->methods)
        status = br_contenders_read("--methods", o->methods, &w->contenders, err);
    if (!status)
        status = read_repeats(o->repeats, &w->repeats, err);
    if (!status)
        status =
            br_read_number_option("time-limit", o->time_limit, 0, INFINITY, &w->time_limit, err);
    return status;
}

void br_plan_wish_clear(struct br_plan_wish *w)
{
    br_study_request_clear(&w->study);
    *w = (struct br_plan_wish){0};
}
