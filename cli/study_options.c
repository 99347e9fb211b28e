/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/study_options.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/formats.h"
#include "cli/names.h"
#include "cli/number_option.h"
#include "cli/parse.h"
#include "study/scene/number_list.h"
#include "tables/document.h"

/* One line a row of each registry, below the options. */
static void print_registries(FILE *out)
{
    br_print_method_registries(out);
    fprintf(out, "References (--reference):\n");
    for (const struct br_judge *const *j = br_judges; *j; j++)
        fprintf(out, "  %-12s %s\n", (*j)->syntax, (*j)->title);
    fprintf(out, "Norms (--norm):\n");
    for (const struct br_norm *const *n = br_norms; *n; n++)
        fprintf(out, "  %-12s %s\n", (*n)->name, (*n)->title);
    fprintf(out, "Formats (--format):\n");
    for (const struct br_document_format *const *e = br_document_formats; *e; e++)
        fprintf(out, "  %-12s %s\n", (*e)->name, (*e)->title);
}

enum br_status br_study_options_parse(int argc, const char **argv, const char *usage,
                                      struct br_study_options *o, char **argument,
                                      struct br_error *err)
{
    struct poptOption method[BR_METHOD_OPTIONS];
    br_method_options_table(&o->method, method);
    const struct poptOption table[] = {
        {"n", 0, POPT_ARG_STRING, &o->n, 0, "elements of the meshes", "LIST"},
        {"k", 0, POPT_ARG_STRING, &o->k, 0, "time steps, s", "LIST"},
        {"reference", 0, POPT_ARG_STRING, &o->reference, 0,
         "what the cells are judged by: exact, fine:N,K, mms or none", "NAME"},
        {"norm", 0, POPT_ARG_STRING, &o->norm, 0,
         "norms of the error (default l2), one table each: any of those below", "LIST"},
        {"reference-solver", 0, POPT_ARG_STRING, &o->reference_solver, 0,
         "that of the reference, where it differs", "NAME"},
        {"threads", 0, POPT_ARG_STRING, &o->threads, 0, "threads; 0, the default: all cores",
         "COUNT"},
        {"out", 0, POPT_ARG_STRING, &o->out, 0, "folder of the results (default results)", "DIR"},
        {"format", 0, POPT_ARG_STRING, &o->format, 0,
         "formats to write (default all): any of those below", "LIST"},
        {"no-plots", 0, POPT_ARG_NONE, &o->no_plots, 0, "write no plots", NULL},
        {"quiet", 0, POPT_ARG_NONE, &o->quiet, 0, "no progress, no table on the terminal", NULL},
        BR_PARSE_HELP_ROW,
        BR_INCLUDE_METHOD(method),
        POPT_TABLEEND,
    };
    return br_parse(argc, argv,
                    &(struct br_parse){.table = table,
                                       .usage = usage,
                                       .print_below = print_registries,
                                       .help = &o->help,
                                       .read_words = argument ? br_parse_scene : NULL,
                                       .self = argument},
                    err);
}

void br_study_options_clear(struct br_study_options *o)
{
    char **texts[] = {&o->n,   &o->k,      &o->reference, &o->reference_solver,
                      &o->out, &o->format, &o->norm,      &o->threads};
    br_method_options_clear(&o->method);
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        free(*texts[i]);
        *texts[i] = NULL;
    }
}

static enum br_status unknown(const char *option, const char *found, const char *names,
                              struct br_error *err)
{
    return br_fail(err, BR_BAD_INPUT, "--%s: found '%s', expected one of: %s", option, found,
                   names);
}

/* "fine:N,K" behind the colon */
static enum br_status read_fine(const char *text, const char *arguments, struct br_study_request *r,
                                struct br_error *err)
{
    double n = 0, k = 0;
    const char *comma = br_read_number(arguments, &n);
    const char *end = comma && *comma == ',' ? br_read_number(comma + 1, &k) : NULL;
    if (!end || *end || !(n >= 1 && n <= 1e9) || n != floor(n) || !(k > 0))
        return br_fail(
            err, BR_BAD_INPUT,
            "--reference: found '%s', expected fine:N,K with a number of elements N >= 1 "
            "and a time step K > 0 in seconds, like fine:12800,1e-5",
            text);
    r->reference_n = (size_t)n;
    r->reference_k = k;
    return BR_OK;
}

/* A judge's name, and for a fine run its arguments. */
static enum br_status read_reference(const char *text, struct br_study_request *r,
                                     struct br_error *err)
{
    char name[32];
    const size_t length = strcspn(text, ":");
    snprintf(name, sizeof name, "%.*s", (int)(length < 31 ? length : 31), text);
    r->judge = br_judge_find(name);
    if (!r->judge || (text[length] == ':' && !r->judge->nests))
        return unknown("reference", text, br_judge_names(), err);
    if (!r->judge->nests)
        return BR_OK;
    return read_fine(text, text + length + (text[length] == ':'), r, err);
}

static enum br_status read_method(const struct br_study_options *o, struct br_study_request *r,
                                  struct br_error *err)
{
    r->method = br_method_default();
    const enum br_status status = br_method_options_read(&o->method, &r->method, err);
    if (status)
        return status;
    r->reference_method = r->method;
    if (o->reference_solver &&
        !(r->reference_method.solver = br_linear_solver_find(o->reference_solver)))
        return unknown("reference-solver", o->reference_solver, br_solver_names(), err);
    const struct br_method *const methods[] = {&r->method, &r->reference_method};
    return br_method_options_check(&o->method, methods, o->reference_solver ? 2 : 1, err);
}

/* "l2,energy"; NULL: the first of the registry */
static enum br_status read_norms(const char *text, struct br_study_request *r, struct br_error *err)
{
    if (!text) {
        r->norm[r->norms++] = br_norms[0];
        return BR_OK;
    }
    for (const char *rest = text;; rest++) {
        char name[64];
        const size_t length = strcspn(rest, ",");
        snprintf(name, sizeof name, "%.*s", (int)(length < 63 ? length : 63), rest);
        const struct br_norm *norm = br_norm_find(name);
        if (!norm)
            return unknown("norm", name, br_norm_names(), err);
        for (size_t i = 0; i < r->norms; i++)
            if (r->norm[i] == norm)
                return br_fail(err, BR_BAD_INPUT, "--norm: %s is given twice", name);
        r->norm[r->norms++] = norm;
        rest += length;
        if (!*rest)
            return BR_OK;
    }
}

enum br_status br_study_request_read(const struct br_study_options *o, struct br_study_request *r,
                                     struct br_error *err)
{
    *r = (struct br_study_request){0};
    enum br_status status = br_read_count_option("threads", o->threads, 4096, &r->threads, err);
    if (!status)
        status = br_formats_check(o->format, err);
    if (!status)
        status = read_norms(o->norm, r, err);
    if (!status)
        status = read_method(o, r, err);
    if (!status && o->n)
        status = br_read_counts("--n", o->n, &r->n, &r->n_count, err);
    if (!status && o->k)
        status = br_read_numbers("--k", o->k, &r->k, &r->k_count, err);
    if (!status && o->reference)
        status = read_reference(o->reference, r, err);
    return status;
}

void br_study_request_clear(struct br_study_request *r)
{
    free(r->n);
    free(r->k);
    *r = (struct br_study_request){0};
}
