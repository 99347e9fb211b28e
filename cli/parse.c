/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/parse.h"

#include <errno.h>
#include <string.h>

#include "cli/suggest.h"

static void print_help(poptContext context, const struct br_parse *p)
{
    if (!*p->help) {
        poptPrintHelp(context, stdout, 0);
        if (p->print_below)
            p->print_below(stdout);
    }
    *p->help = 1;
}

static enum br_status read_options(poptContext context, const struct br_parse *p,
                                   struct br_error *err)
{
    int code;
    enum br_status status = BR_OK;
    while (!status && (code = poptGetNextOpt(context)) > 0)
        if (code == BR_PARSE_HELP)
            print_help(context, p);
        else
            status = p->take(context, code, p->self, err);
    return !status && code < -1 ? br_bad_option(context, p->table, code, err) : status;
}

static enum br_status read_words(poptContext context, const struct br_parse *p,
                                 struct br_error *err)
{
    if (p->read_words)
        return p->read_words(context, p->self, err);
    const char *word = poptGetArg(context);
    return word ? br_fail(err, BR_BAD_INPUT, "found '%s', expected nothing more", word) : BR_OK;
}

enum br_status br_parse(int argc, const char **argv, const struct br_parse *p, struct br_error *err)
{
    errno = 0;
    poptContext context = poptGetContext("beamrate", argc, argv, p->table, 0);
    if (!context || errno == ENOMEM) { /* without memory popt forgets words */
        poptFreeContext(context);
        return br_no_memory(err, "the options");
    }
    poptSetOtherOptionHelp(context, p->usage);
    enum br_status status = read_options(context, p, err);
    if (!status && !*p->help)
        status = read_words(context, p, err);
    if (errno == ENOMEM)
        status = br_no_memory(err, "the options");
    poptFreeContext(context);
    return status;
}

enum br_status br_parse_scene(poptContext context, void *self, struct br_error *err)
{
    char **scene = self;
    const char *word = poptGetArg(context);
    if (!word)
        return br_fail(err, BR_BAD_INPUT,
                       "no scene is given, expected a file or the name of a bundled scene");
    if (!(*scene = strdup(word)))
        return br_no_memory(err, "the options");
    word = poptGetArg(context);
    return word ? br_fail(err, BR_BAD_INPUT, "found '%s', expected nothing more", word) : BR_OK;
}

enum br_status br_parse_words(poptContext context, char ***word, size_t *count,
                              struct br_error *err)
{
    const char **words = poptGetArgs(context);
    size_t given = 0;
    while (words && words[given])
        given++;
    *count = 0;
    *word = br_allocate(given + 1, sizeof **word);
    if (!*word)
        return br_no_memory(err, "the options");
    for (; *count < given; ++*count)
        if (!((*word)[*count] = strdup(words[*count])))
            return br_no_memory(err, "the options");
    return BR_OK;
}
