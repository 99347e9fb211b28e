/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The frame of every command's options: popt's loop, the help, and what is refused. */
#ifndef BR_CLI_PARSE_H
#define BR_CLI_PARSE_H

#include <popt.h>
#include <stdio.h>

#include "solver/status.h"

/* The row of --help in a table. */
enum { BR_PARSE_HELP = 1 };
#define BR_PARSE_HELP_ROW                                                \
    {                                                                    \
        "help", 0, POPT_ARG_NONE, NULL, BR_PARSE_HELP, "this help", NULL \
    }

struct br_parse {
    const struct poptOption *table; /* with BR_PARSE_HELP_ROW, ended */
    const char *usage;              /* arguments, text and examples */
    void (*print_below)(FILE *out); /* below the options in the help; NULL: nothing */
    int *help;                      /* out: set to 1 with --help */
    /* Reads the words that are no options; NULL: there are none. Not called with --help. */
    enum br_status (*read_words)(poptContext context, void *self, struct br_error *err);
    /* Takes an option whose `val` in the table is above BR_PARSE_HELP; NULL: there is none. */
    enum br_status (*take)(poptContext context, int val, void *self, struct br_error *err);
    void *self;
};

/* Parses argv (argv[0] is "beamrate COMMAND"); with --help it prints the help. Fails with
 * BR_BAD_INPUT, naming the option, or BR_NO_MEMORY. */
enum br_status br_parse(int argc, const char **argv, const struct br_parse *parse,
                        struct br_error *err);

/* A read_words: one scene and no more; self: a char * (out), owned by the caller. */
enum br_status br_parse_scene(poptContext context, void *self, struct br_error *err);

/* Copies all words; *word (out, count) and its words are owned by the caller, even after a failure,
 * which is BR_NO_MEMORY. */
enum br_status br_parse_words(poptContext context, char ***word, size_t *count,
                              struct br_error *err);

#endif
