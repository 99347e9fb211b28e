/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/check_options.h"

#include <popt.h>
#include <stdio.h>
#include <string.h>

#include "cli/number_option.h"
#include "cli/parse.h"
#include "cli/rounding_option.h"
#include "tables/report_check.h"

static const char usage[] =
    "SCENE... | --all [OPTION...]\n\nWhether scenes still converge as their 'verify' parts expect. "
    "Three studies that are\napart: over h at one time step, over k on one mesh, and both together "
    "against the\nsolution. The verdict on an order comes from its 95 % interval: PASS within the "
    "band,\nFAIL outside, INCONCLUSIVE across its end. Exit code 0: all PASS; 1: not so.\n\n"
    "Examples:\n  beamrate check --all --junit orders.xml --markdown summary.md\n"
    "  beamrate check my_scene.yaml --json new.json --compare old.json\n";

enum { FIRST_FILE = BR_PARSE_HELP + 1 }; /* FIRST_FILE + i: a file of format i */

/* One row an option: those of the formats, then the fixed ones. */
struct option_table {
    struct poptOption method[BR_METHOD_OPTIONS];
    struct poptOption row[BR_MOST_CHECK_FORMATS + 13];
    size_t rows;
};

static void add(struct option_table *t, const struct poptOption *row)
{
    t->row[t->rows++] = *row;
}

static void fill_table(struct option_table *t, struct br_check_options *o)
{
    const struct poptOption fixed[] = {
        {"all", 0, POPT_ARG_NONE, &o->all, 0, "all bundled scenes", NULL},
        {"compare", 0, POPT_ARG_STRING, &o->compare, 0,
         "an earlier check's JSON: what has moved since, and how serious that is", "FILE"},
        {"fail-fast", 0, POPT_ARG_NONE, &o->fail_fast, 0,
         "one scene after the other, the cheapest first, until one fails", NULL},
        {"rounding", 0, POPT_ARG_STRING, &o->rounding, 0,
         "rounding mode of the marches: nearest (the default), up, down or zero", "MODE"},
        {"threads", 0, POPT_ARG_STRING, &o->threads, 0, "threads; 0, the default: all cores",
         "COUNT"},
        {"quiet", 0, POPT_ARG_NONE, &o->quiet, 0, "no progress, no table on the terminal", NULL},
        BR_PARSE_HELP_ROW,
        BR_INCLUDE_METHOD(t->method),
    };
    br_method_options_table(&o->method, t->method);
    for (size_t i = 1; br_check_formats[i]; i++)
        add(t, &(struct poptOption){br_check_formats[i]->name, 0, POPT_ARG_STRING, NULL,
                                    FIRST_FILE + (int)i, br_check_formats[i]->title, "FILE"});
    for (size_t i = 0; i < sizeof fixed / sizeof *fixed; i++)
        add(t, &fixed[i]);
    add(t, &(struct poptOption)POPT_TABLEEND);
}

static enum br_status read_scenes(poptContext context, void *self, struct br_error *err)
{
    struct br_check_options *o = self;
    const enum br_status status = br_parse_words(context, &o->scene, &o->scenes, err);
    if (!status && (o->all ? o->scenes > 0 : o->scenes == 0))
        return br_fail(
            err, BR_BAD_INPUT,
            o->all ? "--all and scenes are given, expected one of the two"
                   : "no scene is given, expected files, names of bundled scenes, or --all");
    return status;
}

/* Whatever the scenes say: names and numbers must be some. */
static enum br_status read_values(struct br_check_options *o, struct br_error *err)
{
    struct br_method method = br_method_default();
    enum br_status status = br_method_options_read(&o->method, &method, err);
    if (!status)
        status = br_read_rounding(o->rounding, &o->rounding_mode, err);
    return status ? status
                  : br_read_count_option("threads", o->threads, 4096, &o->thread_count, err);
}

/* The file of a format, which would be lost if another one followed. */
static enum br_status keep_file(poptContext context, int val, void *self, struct br_error *err)
{
    struct br_check_options *o = self;
    const size_t format = (size_t)(val - FIRST_FILE);
    char *path = poptGetOptArg(context);
    if (o->file[format]) {
        free(path);
        return br_fail(err, BR_BAD_INPUT, "--%s is given twice", br_check_formats[format]->name);
    }
    o->file[format] = path;
    return BR_OK;
}

enum br_status br_check_options_parse(int argc, const char **argv, struct br_check_options *o,
                                      struct br_error *err)
{
    struct option_table table = {0};
    *o = (struct br_check_options){0};
    fill_table(&table, o);
    const enum br_status status =
        br_parse(argc, argv,
                 &(struct br_parse){.table = table.row,
                                    .usage = usage,
                                    .print_below = br_print_method_registries,
                                    .help = &o->help,
                                    .read_words = read_scenes,
                                    .take = keep_file,
                                    .self = o},
                 err);
    return status || o->help ? status : read_values(o, err);
}

void br_check_options_clear(struct br_check_options *o)
{
    for (size_t i = 0; i < BR_MOST_CHECK_FORMATS; i++)
        free(o->file[i]);
    for (size_t i = 0; o->scene && i < o->scenes; i++)
        free(o->scene[i]);
    free(o->scene);
    free(o->compare);
    br_method_options_clear(&o->method);
    free(o->threads);
    free(o->rounding);
    *o = (struct br_check_options){0};
}
