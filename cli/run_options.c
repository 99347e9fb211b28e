/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/run_options.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/number_option.h"
#include "cli/parse.h"
#include "study/run/history.h"
#include "study/run/model.h"
#include "study/scene/number_list.h"

static const char usage[] =
    "SCENE [OPTION...]\n\nMarches one scene and says what happened at its tip: displacements, "
    "forces, when it\nstuck, slipped, reversed, closed and opened, energies, and what was modelled "
    "and what not.\nTimes are in seconds, with their unit or without: --k 1e-3, --k '1e-3 s'.\n\n"
    "Examples:\n  beamrate run example3\n  beamrate run example2 --n 400 --k 1e-4 --check\n"
    "  beamrate run example1 --at 0.5,1 --out results --json -\n";

enum br_status br_run_options_parse(int argc, const char **argv, struct br_run_options *o,
                                    struct br_error *err)
{
    struct br_study_options *m = &o->method;
    struct poptOption method[BR_METHOD_OPTIONS];
    br_method_options_table(&m->method, method);
    const struct poptOption table[] = {
        {"n", 0, POPT_ARG_STRING, &m->n, 0, "elements (default 100)", "COUNT"},
        {"k", 0, POPT_ARG_STRING, &m->k, 0, "time step (default: a thousandth of the duration)",
         "TIME"},
        {"fields", 0, POPT_ARG_STRING, &o->fields, 0,
         "fields to march: axial, bending or both (default: what the scene has, but not the axial "
         "field beside Tresca's friction, whose bound does not need it)",
         "LIST"},
        {"check", 0, POPT_ARG_NONE, &o->check, 0,
         "recompute the certificate and the energy balance of every step; exit code 1 where a step "
         "is beyond a limit",
         NULL},
        {"energies", 0, POPT_ARG_NONE, &o->energies, 0, "the energy balance alone", NULL},
        {"explain", 0, POPT_ARG_NONE, &o->explain, 0, "what the parts of a step cost, as measured",
         NULL},
        {"out", 0, POPT_ARG_STRING, &o->out, 0,
         "folder for history.csv (the tip), fields.h5 or fields.csv, summary.txt and summary.json",
         "DIR"},
        {"at", 0, POPT_ARG_STRING, &o->at, 0, "times of the fields, multiples of k", "LIST"},
        {"every", 0, POPT_ARG_STRING, &o->every, 0,
         "the same, from 0 on, so far apart (default: a tenth of the duration)", "TIME"},
        {"rows", 0, POPT_ARG_STRING, &o->rows, 0,
         "rows of history.csv, at most (default 10000): every step, every second, ...", "COUNT"},
        {"json", 0, POPT_ARG_STRING, &o->json, 0, "the summary for programs; - is standard output",
         "FILE"},
        {"animate", 0, POPT_ARG_STRING, &o->animate, 0,
         "a moving picture of beam, obstacle and forces: a .gif or .webp, or a folder (its name ends "
         "with a /) of PNG frames",
         "FILE"},
        {"plot", 0, POPT_ARG_NONE, &o->plot, 0, "the tip's history in the terminal", NULL},
        {"quiet", 0, POPT_ARG_NONE, &o->quiet, 0, "no progress, no summary on the terminal", NULL},
        BR_PARSE_HELP_ROW,
        BR_INCLUDE_METHOD(method),
        POPT_TABLEEND,
    };
    return br_parse(argc, argv,
                    &(struct br_parse){.table = table,
                                       .usage = usage,
                                       .print_below = br_print_method_registries,
                                       .help = &o->help,
                                       .read_words = br_parse_scene,
                                       .self = &o->scene},
                    err);
}

void br_run_options_clear(struct br_run_options *o)
{
    br_study_options_clear(&o->method);
    free(o->scene);
    free(o->fields);
    free(o->at);
    free(o->every);
    free(o->rows);
    free(o->json);
    free(o->out);
    free(o->animate);
    *o = (struct br_run_options){0};
}

/* ---- times ---- */

/* Reads "0.1" or "0.1 s" at the start of text; returns what follows, NULL where it is neither. */
static const char *read_time(const char *text, double *seconds)
{
    while (*text == ' ')
        text++;
    const char *rest = br_read_number(text, seconds);
    if (!rest)
        return NULL;
    while (*rest == ' ')
        rest++;
    if (*rest == 's')
        rest++;
    while (*rest == ' ')
        rest++;
    return *rest == '\0' || *rest == ',' ? rest : NULL;
}

/* The time level at t, s; the option names where it was found. */
static enum br_status read_level(const char *option, double t, const struct br_scene *scene,
                                 size_t steps, size_t *level, struct br_error *err)
{
    const double T = scene->duration, place = t / T * (double)steps;
    if (!(t >= 0 && t <= T))
        return br_fail(err, BR_BAD_INPUT, "%s: found %g s, expected a time of [0, %g] s", option, t,
                       T);
    const double nearest = round(place);
    *level = (size_t)nearest;
    if (fabs(place - nearest) <= 1e-6)
        return BR_OK;
    const double below = floor(place);
    return br_fail(
        err, BR_BAD_INPUT,
        "%s: found %.10g s, expected a multiple of k = %g s; the nearest are %.15g s and "
        "%.15g s",
        option, t, T / (double)steps, T * below / (double)steps, T * (below + 1) / (double)steps);
}

static enum br_status not_a_time(const char *option, const char *found, const char *example,
                                 struct br_error *err)
{
    return br_fail(err, BR_BAD_INPUT, "%s: found '%s', expected %s", option, found, example);
}

static int by_level(const void *a, const void *b)
{
    const size_t x = *(const size_t *)a, y = *(const size_t *)b;
    return (x > y) - (x < y);
}

static enum br_status read_at(const char *text, const struct br_scene *scene,
                              struct br_run_plan *plan, struct br_error *err)
{
    size_t most = 1;
    for (const char *c = text; *c; c++)
        most += *c == ',';
    if (!(plan->level = br_allocate(most, sizeof *plan->level)))
        return br_no_memory(err, "the output times");
    for (const char *rest = text;; rest++) {
        double t;
        const char *end = read_time(rest, &t);
        if (!end)
            return not_a_time("--at", rest, "times separated by commas, like 0.1,0.5", err);
        const enum br_status status =
            read_level("--at", t, scene, plan->steps, &plan->level[plan->levels++], err);
        if (status)
            return status;
        rest = end;
        if (!*rest)
            break;
    }
    qsort(plan->level, plan->levels, sizeof *plan->level, by_level);
    for (size_t i = 1; i < plan->levels; i++)
        if (plan->level[i] == plan->level[i - 1])
            return br_fail(err, BR_BAD_INPUT, "--at: %g s is given twice",
                           scene->duration * (double)plan->level[i] / (double)plan->steps);
    return BR_OK;
}

/* Every `interval` levels from 0 on. */
static enum br_status fill_levels(struct br_run_plan *plan, size_t interval, struct br_error *err)
{
    plan->levels = plan->steps / interval + 1;
    if (!(plan->level = br_allocate(plan->levels, sizeof *plan->level)))
        return br_no_memory(err, "the output times");
    for (size_t i = 0; i < plan->levels; i++)
        plan->level[i] = i * interval;
    return BR_OK;
}

static enum br_status read_every(const char *text, const struct br_scene *scene,
                                 struct br_run_plan *plan, struct br_error *err)
{
    double t;
    size_t interval;
    const char *end = read_time(text, &t);
    if (!end || *end || !(t > 0))
        return not_a_time("--every", text, "a time above 0, like 0.1", err);
    const enum br_status status = read_level("--every", t, scene, plan->steps, &interval, err);
    if (status)
        return status;
    if (interval == 0)
        return br_fail(err, BR_BAD_INPUT, "--every: found '%s', expected a multiple of k = %g s",
                       text, scene->duration / (double)plan->steps);
    return fill_levels(plan, interval, err);
}

/* Ten of about the same length, whatever the number of steps. */
static enum br_status default_levels(struct br_run_plan *plan, struct br_error *err)
{
    enum { PARTS = 10 };
    if (!(plan->level = br_allocate(PARTS + 1, sizeof *plan->level)))
        return br_no_memory(err, "the output times");
    for (size_t i = 0; i <= PARTS; i++) {
        const size_t level =
            (size_t)llround((double)plan->steps * (double)i / PARTS); /* exact below 2^49 */
        if (plan->levels == 0 || level > plan->level[plan->levels - 1])
            plan->level[plan->levels++] = level;
    }
    return BR_OK;
}

static enum br_status make_levels(const struct br_run_options *o, const struct br_scene *scene,
                                  struct br_run_plan *plan, struct br_error *err)
{
    if (o->at && o->every)
        return br_fail(err, BR_BAD_INPUT, "--at and --every are given, expected one of the two");
    if ((o->at || o->every) && !o->out)
        return br_fail(err, BR_BAD_INPUT, "%s needs --out, the folder for the fields",
                       o->at ? "--at" : "--every");
    if (o->at)
        return read_at(o->at, scene, plan, err);
    if (o->every)
        return read_every(o->every, scene, plan, err);
    return o->out ? default_levels(plan, err) : BR_OK;
}

/* ---- the plan ---- */

static enum br_status read_fields(const char *text, unsigned *wanted, struct br_error *err)
{
    static const struct {
        const char *name;
        unsigned bits;
    } names[] = {{"axial", BR_WANT_AXIAL},
                 {"bending", BR_WANT_BENDING},
                 {"axial,bending", BR_WANT_AXIAL | BR_WANT_BENDING},
                 {"bending,axial", BR_WANT_AXIAL | BR_WANT_BENDING}};
    *wanted = 0;
    for (size_t i = 0; text && i < sizeof names / sizeof *names; i++)
        if (strcmp(text, names[i].name) == 0)
            *wanted = names[i].bits;
    if (text && !*wanted)
        return br_fail(err, BR_BAD_INPUT,
                       "--fields: found '%s', expected axial, bending or axial,bending", text);
    return BR_OK;
}

static enum br_status read_step(const char *text, const struct br_scene *scene, size_t *steps,
                                struct br_error *err)
{
    double k;
    struct br_error inner = {0};
    const char *end = read_time(text, &k);
    if (!end || *end || !(k > 0))
        return not_a_time("--k", text, "one time above 0, like 1e-3", err);
    if (br_steps_of(scene, k, steps, &inner))
        return br_fail(err, BR_BAD_INPUT, "--k: %s", inner.message);
    return BR_OK;
}

static enum br_status read_resolution(const struct br_run_options *o,
                                      const struct br_study_request *r,
                                      const struct br_scene *scene, struct br_run_plan *plan,
                                      struct br_error *err)
{
    plan->n = 100;
    plan->steps = 1000;
    if (r->n && r->n_count != 1)
        return br_fail(err, BR_BAD_INPUT, "--n: found '%s', expected one number of elements",
                       o->method.n);
    if (r->n)
        plan->n = r->n[0];
    return o->method.k ? read_step(o->method.k, scene, &plan->steps, err) : BR_OK;
}

static enum br_status read_rows(const struct br_run_options *o, struct br_run_plan *plan,
                                struct br_error *err)
{
    int rows = 10000;
    const enum br_status status = br_read_count_option("rows", o->rows, 1000000000, &rows, err);
    if (status)
        return status;
    if (rows < 2)
        return br_fail(err, BR_BAD_INPUT, "--rows: found '%s', expected 2 or more", o->rows);
    plan->stride = o->out ? br_history_stride(plan->steps, (size_t)rows) : 0;
    return BR_OK;
}

enum br_status br_run_plan_make(const struct br_run_options *o, const struct br_scene *scene,
                                struct br_run_plan *plan, struct br_error *err)
{
    struct br_study_options method = o->method;
    struct br_study_request request;
    *plan = (struct br_run_plan){0};
    method.k = NULL; /* read here, with its unit */
    enum br_status status = br_study_request_read(&method, &request, err);
    plan->method = request.method;
    if (!status)
        status = read_resolution(o, &request, scene, plan, err);
    br_study_request_clear(&request);
    if (!status)
        status = read_fields(o->fields, &plan->wanted, err);
    if (!status)
        status = read_rows(o, plan, err);
    return status ? status : make_levels(o, scene, plan, err);
}

void br_run_plan_clear(struct br_run_plan *plan)
{
    free(plan->level);
    *plan = (struct br_run_plan){0};
}
