/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/extremes_options.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "cli/formats.h"
#include "cli/number_option.h"
#include "cli/parse.h"
#include "cli/rounding_option.h"
#include "cli/suggest.h"
#include "study/scene/number_list.h"

static const char usage[] =
    "[PART...] [OPTION...]\n\nWhere does it break, and does it say so? Each part goes to one kind "
    "of extremes, compares what\nthe theory predicts with what is measured, and writes tables and "
    "pictures. The verdict fails where\na result is wrong and nothing said so. Without a PART all "
    "of those below are tried.\n\nExamples:\n  beamrate extremes\n  beamrate extremes map --cases 10 --seed 7\n"
    "  beamrate extremes floors --n 100,1000 --k 0.01\n";

enum { MOST_CASES = 1000000000 };

/* Which parts heed an option, as in the help: "map". */
static const char *heeders(unsigned option)
{
    static char text[256];
    text[0] = '\0';
    for (const struct br_extremes_part *const *p = br_extremes_parts; *p; p++) {
        const size_t used = strlen(text);
        if ((*p)->heeds & option)
            snprintf(text + used, sizeof text - used, "%s%s", used ? ", " : "", (*p)->name);
    }
    return *text ? text : "no part";
}

static const struct {
    const char *option;
    unsigned bit;
} heeded[] = {{"--n", BR_HEEDS_N},
              {"--k", BR_HEEDS_K},
              {"--cases", BR_HEEDS_CASES},
              {"--seed", BR_HEEDS_SEED},
              {"--rounding", BR_HEEDS_ROUNDING},
              {"--resume", BR_HEEDS_RESUME}};
enum { HEEDED = sizeof heeded / sizeof *heeded };

static void print_parts(FILE *out)
{
    fprintf(out, "\nParts:\n");
    for (const struct br_extremes_part *const *p = br_extremes_parts; *p; p++)
        fprintf(out, "  %-12s %s\n", (*p)->name, (*p)->title);
    fprintf(out, "Heeded by:\n"); /* without --: else they are options, for completions */
    for (size_t i = 0; i < HEEDED; i++)
        fprintf(out, "  %-12s %s\n", heeded[i].option + 2, heeders(heeded[i].bit));
    fprintf(out, "Formats (--format):\n ");
    for (const struct br_document_format *const *e = br_document_formats; *e; e++)
        fprintf(out, " %s", (*e)->name);
    fputc('\n', out);
}

/* ---- parts ---- */

const struct br_extremes_part *br_extremes_part_find(const char *name)
{
    for (const struct br_extremes_part *const *p = br_extremes_parts; *p; p++)
        if (strcmp((*p)->name, name) == 0)
            return *p;
    return NULL;
}

static enum br_status unknown_part(const char *word, struct br_error *err)
{
    const char *names[BR_EXTREMES_MOST];
    char all[256] = "";
    size_t count = 0;
    for (const struct br_extremes_part *const *p = br_extremes_parts;
         *p && count < BR_EXTREMES_MOST; p++) {
        const size_t used = strlen(all);
        names[count++] = (*p)->name;
        snprintf(all + used, sizeof all - used, "%s%s", used ? ", " : "", (*p)->name);
    }
    const char *nearest = br_nearest(word, names, count);
    if (nearest)
        return br_fail(err, BR_BAD_INPUT, "'%s' is no part; did you mean '%s'?", word, nearest);
    return br_fail(err, BR_BAD_INPUT, "'%s' is no part, expected any of: %s", word, all);
}

/* All that are wanted, in the registry's order whatever that of the words; none: all. */
static enum br_status read_parts(poptContext context, void *self, struct br_error *err)
{
    struct br_extremes_options *o = self;
    const struct br_extremes_part *wanted[BR_EXTREMES_MOST] = {NULL};
    size_t count = 0;
    for (const char *word; (word = poptGetArg(context));) {
        const struct br_extremes_part *part = br_extremes_part_find(word);
        if (!part)
            return unknown_part(word, err);
        for (size_t i = 0; i < count; i++)
            if (wanted[i] == part)
                return br_fail(err, BR_BAD_INPUT, "part %s is given twice", word);
        wanted[count++] = part;
    }
    for (const struct br_extremes_part *const *p = br_extremes_parts;
         *p && o->parts < BR_EXTREMES_MOST; p++) {
        bool is_wanted = count == 0;
        for (size_t i = 0; i < count; i++)
            is_wanted |= wanted[i] == *p;
        if (is_wanted)
            o->part[o->parts++] = *p;
    }
    return BR_OK;
}

enum br_status br_extremes_options_parse(int argc, const char **argv, struct br_extremes_options *o,
                                         struct br_error *err)
{
    const struct poptOption table[] = {
        {"n", 0, POPT_ARG_STRING, &o->n, 0, "elements of the meshes", "LIST"},
        {"k", 0, POPT_ARG_STRING, &o->k, 0, "time steps, s", "LIST"},
        {"cases", 0, POPT_ARG_STRING, &o->cases, 0, "cases of a map that is drawn at random",
         "COUNT"},
        {"seed", 0, POPT_ARG_STRING, &o->seed, 0,
         "seed of what is drawn: a whole number, or 0x and hexadecimal digits", "SEED"},
        {"rounding", 0, POPT_ARG_STRING, &o->rounding, 0,
         "rounding mode of the marches: nearest (the default), up, down or zero", "MODE"},
        {"threads", 0, POPT_ARG_STRING, &o->threads, 0, "threads; 0, the default: all cores",
         "COUNT"},
        {"resume", 0, POPT_ARG_NONE, &o->resume, 0,
         "goes on with what an interrupted run has left in the folder", NULL},
        {"out", 0, POPT_ARG_STRING, &o->out, 0, "folder of the results (default extremes)", "DIR"},
        {"format", 0, POPT_ARG_STRING, &o->format, 0,
         "formats to write (default all): any of those below", "LIST"},
        {"no-plots", 0, POPT_ARG_NONE, &o->no_plots, 0, "write no plots", NULL},
        {"quiet", 0, POPT_ARG_NONE, &o->quiet, 0, "no progress, no table on the terminal", NULL},
        BR_PARSE_HELP_ROW,
        POPT_TABLEEND,
    };
    return br_parse(argc, argv,
                    &(struct br_parse){.table = table,
                                       .usage = usage,
                                       .print_below = print_parts,
                                       .help = &o->help,
                                       .read_words = read_parts,
                                       .self = o},
                    err);
}

void br_extremes_options_clear(struct br_extremes_options *o)
{
    char *texts[] = {o->n, o->k, o->cases, o->seed, o->rounding, o->threads, o->out, o->format};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++)
        free(texts[i]);
    *o = (struct br_extremes_options){0};
}

/* ---- what they say ---- */

/* An option that no chosen part heeds would be dropped silently. */
static enum br_status check_heeded(const struct br_extremes_options *o, struct br_error *err)
{
    const bool given[HEEDED] = {o->n, o->k, o->cases, o->seed, o->rounding, o->resume};
    unsigned all = 0;
    for (size_t i = 0; i < o->parts; i++)
        all |= o->part[i]->heeds;
    for (size_t i = 0; i < HEEDED; i++)
        if (given[i] && !(all & heeded[i].bit))
            return br_fail(err, BR_BAD_INPUT, "%s: no chosen part heeds it; it is for %s",
                           heeded[i].option, heeders(heeded[i].bit));
    return BR_OK;
}

static enum br_status read_seed(const char *text, uint64_t *seed, struct br_error *err)
{
    char *end = NULL;
    const bool hexadecimal = text && text[0] == '0' && (text[1] == 'x' || text[1] == 'X');
    const char *digits = text + (hexadecimal ? 2 : 0);
    if (!text)
        return BR_OK;
    errno = 0;
    const bool signless = *digits && strspn(digits, "0123456789abcdefABCDEF") == strlen(digits);
    const unsigned long long value = strtoull(text, &end, hexadecimal ? 16 : 10);
    if (!signless || *end || errno || value == 0)
        return br_fail(err, BR_BAD_INPUT,
                       "--seed: found '%s', expected a whole number from 1 to 2^64 - 1, decimal or "
                       "0x and hexadecimal",
                       text);
    *seed = value;
    return BR_OK;
}

static enum br_status read_cases(const char *text, size_t *cases, struct br_error *err)
{
    int value = 0;
    const enum br_status status = br_read_count_option("cases", text, MOST_CASES, &value, err);
    if (!status && text && value == 0)
        return br_fail(err, BR_BAD_INPUT,
                       "--cases: found '%s', expected a whole number from 1 to %d", text,
                       MOST_CASES);
    *cases = (size_t)value;
    return status;
}

enum br_status br_extremes_wish_read(const struct br_extremes_options *o,
                                     struct br_extremes_wish *w, struct br_error *err)
{
    *w = (struct br_extremes_wish){0};
    enum br_status status = br_read_count_option("threads", o->threads, 4096, &w->threads, err);
    if (!status)
        status = br_formats_check(o->format, err);
    if (!status)
        status = read_cases(o->cases, &w->cases, err);
    if (!status)
        status = read_seed(o->seed, &w->seed, err);
    if (!status)
        status = br_read_rounding(o->rounding, &w->rounding, err);
    if (!status && o->n)
        status = br_read_counts("--n", o->n, &w->n, &w->n_count, err);
    if (!status && o->k)
        status = br_read_numbers("--k", o->k, &w->k, &w->k_count, err);
    return status ? status : check_heeded(o, err);
}

void br_extremes_wish_clear(struct br_extremes_wish *w)
{
    free(w->n);
    free(w->k);
    *w = (struct br_extremes_wish){0};
}
