/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/parse.h"

#include "cli/suggest.h"

/* Reads options until the end; returns popt's verdict, -1 for all well. */
static int read_all(poptContext context, const struct br_parse *p)
{
    int code;
    while ((code = poptGetNextOpt(context)) > 0)
        if (code == BR_PARSE_HELP && !*p->help) {
            *p->help = 1;
            poptPrintHelp(context, stdout, 0);
            if (p->print_below)
                p->print_below(stdout);
        }
    return code;
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
    poptContext context = poptGetContext("beamrate", argc, argv, p->table, 0);
    if (!context)
        return br_no_memory(err, "the options");
    poptSetOtherOptionHelp(context, p->usage);
    const int code = read_all(context, p);
    enum br_status status = BR_OK;
    if (code < -1)
        status = br_bad_option(context, p->table, code, err);
    else if (!*p->help)
        status = read_words(context, p, err);
    poptFreeContext(context);
    return status;
}
