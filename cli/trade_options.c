/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/trade_options.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/names.h"
#include "cli/number_option.h"
#include "cli/parse.h"
#include "study/scene/number_list.h"
#include "tables/document.h"

static const char usage[] =
    "SCENE... [OPTION...]\n\nWhat a digit costs: the relative error of many methods at many "
    "resolutions against the CPU\nseconds of their marches, one thread, alone. Out come "
    "work-precision diagrams with the Pareto\nfront, the cheapest way to an error of 1e-2, 1e-3, "
    "... 1e-10, and all trials, those that\nfailed among them. Without --methods all time schemes "
    "are tried, and other friction rules and\nlinear solvers with one of them; without --n and --k "
    "a coarse grid, and what the paper's table\nprints.\n\nExamples:\n"
    "  beamrate trade example2 --methods euler+lagged,euler+implicit --n 25,100 "
    "--k 0.1,0.01 --out trade\n"
    "  beamrate trade example1 example3 --methods bdf2,adaptive --n 50 --k 0.05,0.01 "
    "--time-limit 2\n"
    "  beamrate trade example2 --split --methods euler+lagged,euler+implicit --k 0.1,0.01\n";

static const double least_tolerance = 1e-14;

static void print_names(FILE *out)
{
    br_print_contender_words(out);
    fprintf(out, "Formats (--format):\n ");
    for (const struct br_document_format *const *e = br_document_formats; *e; e++)
        fprintf(out, " %s", (*e)->name);
    fputc('\n', out);
}

static enum br_status read_scenes(poptContext context, void *self, struct br_error *err)
{
    struct br_trade_options *o = self;
    const enum br_status status = br_parse_words(context, &o->scene, &o->scenes, err);
    if (!status && o->scenes == 0)
        return br_fail(err, BR_BAD_INPUT,
                       "no scene is given, expected files or names of bundled scenes");
    return status;
}

enum br_status br_trade_options_parse(int argc, const char **argv, struct br_trade_options *o,
                                      struct br_error *err)
{
    struct br_study_options *s = &o->study;
    struct poptOption table[] = {
        {"split", 0, POPT_ARG_NONE, &o->split, 0,
         "where the error of each run comes from, instead (by default one run: n = 100, a "
         "thousandth of the duration, the first time scheme)",
         NULL},
        {"n", 0, POPT_ARG_STRING, &s->n, 0, "elements of the meshes", "LIST"},
        {"k", 0, POPT_ARG_STRING, &s->k, 0, "time steps, s", "LIST"},
        {"tolerances", 0, POPT_ARG_STRING, &o->tolerances, 0,
         "tolerances of schemes that choose their steps", "LIST"},
        {"methods", 0, POPT_ARG_STRING, &o->methods, 0, "methods, by the names below", "LIST"},
        {"norm", 0, POPT_ARG_STRING, &s->norm, 0,
         "norm of the error (default l2); with --split a list", "LIST"},
        {"reference", 0, POPT_ARG_STRING, &s->reference, 0,
         "judge of the errors: exact, mms, or fine:N,K by the scheme of the highest order", "NAME"},
        {"repeats", 0, POPT_ARG_STRING, &o->repeats, 0,
         "timed marches of a trial after a warm-up, at most (default 3)", "COUNT"},
        {"time-limit", 0, POPT_ARG_STRING, &o->time_limit, 0,
         "longest march and set-up, s (default 10)", "SECONDS"},
        {"threads", 0, POPT_ARG_STRING, &s->threads, 0,
         "threads of the errors; 0, the default: all cores", "COUNT"},
        {"out", 0, POPT_ARG_STRING, &s->out, 0, "folder of the results (default trade)", "DIR"},
        {"format", 0, POPT_ARG_STRING, &s->format, 0,
         "formats to write (default all): any of those below", "LIST"},
        {"no-plots", 0, POPT_ARG_NONE, &s->no_plots, 0, "write no plots", NULL},
        {"quiet", 0, POPT_ARG_NONE, &s->quiet, 0, "no progress, no table on the terminal", NULL},
        BR_PARSE_HELP_ROW,
        POPT_TABLEEND,
    };
    return br_parse(argc, argv,
                    &(struct br_parse){.table = table,
                                       .usage = usage,
                                       .print_below = print_names,
                                       .help = &s->help,
                                       .read_words = read_scenes,
                                       .self = o},
                    err);
}

void br_trade_options_clear(struct br_trade_options *o)
{
    char **texts[] = {&o->methods, &o->tolerances, &o->repeats, &o->time_limit};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        free(*texts[i]);
        *texts[i] = NULL;
    }
    for (size_t i = 0; i < o->scenes; i++)
        free(o->scene[i]);
    free(o->scene);
    o->scene = NULL;
    o->scenes = 0;
    br_study_options_clear(&o->study);
}

static enum br_status read_limit(const char *text, double *limit, struct br_error *err)
{
    double value = NAN;
    const char *end = text ? br_read_number(text, &value) : "";
    if (!end || *end || (text && !(value > 0)))
        return br_fail(err, BR_BAD_INPUT, "--time-limit: found '%s', expected seconds > 0", text);
    *limit = value;
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

/* As of `run`. */
static enum br_status read_tolerances(const char *text, struct br_trade_wish *w,
                                      struct br_error *err)
{
    const enum br_status status =
        br_read_numbers("--tolerances", text, &w->tolerance, &w->tolerances, err);
    for (size_t i = 0; i < w->tolerances && !status; i++)
        if (!(w->tolerance[i] > least_tolerance && w->tolerance[i] < 1))
            return br_fail(err, BR_BAD_INPUT,
                           "--tolerances: found %g, expected numbers above %g and below 1",
                           w->tolerance[i], least_tolerance);
    return status;
}

/* A list that no method heeds is refused. */
static enum br_status check_heeded(const struct br_trade_options *o, const struct br_trade_wish *w,
                                   struct br_error *err)
{
    size_t adaptive = 0;
    for (size_t i = 0; i < w->contenders.count; i++)
        adaptive += br_contender_adaptive(&w->contenders.list[i]);
    if (w->contenders.count && adaptive == 0 && o->tolerances)
        return br_fail(err, BR_BAD_INPUT, "--tolerances: no method of --methods heeds it");
    if (w->contenders.count && adaptive == w->contenders.count && o->study.k)
        return br_fail(err, BR_BAD_INPUT, "--k: no method of --methods heeds it");
    return BR_OK;
}

static enum br_status check_study(const struct br_study_request *r, struct br_error *err)
{
    if (r->norms > 1)
        return br_fail(err, BR_BAD_INPUT, "--norm: found %zu norms, expected one", r->norms);
    if (r->judge && !r->judge->create)
        return br_fail(err, BR_BAD_INPUT,
                       "--reference: found '%s', expected a judge that gives errors: exact, mms or "
                       "fine:N,K",
                       r->judge->name);
    return BR_OK;
}

enum br_status br_trade_wish_read(const struct br_trade_options *o, struct br_trade_wish *w,
                                  struct br_error *err)
{
    *w = (struct br_trade_wish){.time_limit = NAN};
    enum br_status status = br_study_request_read(&o->study, &w->study, err);
    if (!status)
        status = check_study(&w->study, err);
    if (!status && o->methods)
        status = br_contenders_read("--methods", o->methods, &w->contenders, err);
    if (!status && o->tolerances)
        status = read_tolerances(o->tolerances, w, err);
    if (!status)
        status = read_repeats(o->repeats, &w->repeats, err);
    if (!status)
        status = read_limit(o->time_limit, &w->time_limit, err);
    return status ? status : check_heeded(o, w, err);
}

void br_trade_wish_clear(struct br_trade_wish *w)
{
    free(w->tolerance);
    br_study_request_clear(&w->study);
    *w = (struct br_trade_wish){0};
}
