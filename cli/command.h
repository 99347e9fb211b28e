/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Commands: one const record and one file each. Help, man page and completions come from the record
 * and the rows of its options. */
#ifndef BR_CLI_COMMAND_H
#define BR_CLI_COMMAND_H

#include "cli/option.h"

enum { BR_MOST_EXAMPLES = 8, BR_MOST_WORDS = 1 << 20 };

struct br_session;

struct br_command {
    unsigned bit; /* its bit in br_option.commands */
    const char *name;
    const char *arguments; /* for the usage line */
    const char *title;     /* one line for a person */
    const char *about;     /* what it does: sentences for the help */
    const char *more;      /* further sentences for the manual; NULL: none */
    /* without the name of the program */
    const char *example[BR_MOST_EXAMPLES];
    size_t least_words, most_words; /* number of arguments that are no options */
    const struct br_words *words;   /* the values that these may have; NULL: scenes */
    bool or_scenes;                 /* or scenes; `run` reads which is which */
    /* The options are parsed; the session is closed afterwards. On failure err says why. */
    enum br_status (*run)(const struct br_options *options, struct br_session *session,
                          struct br_error *err);
};

struct br_registry {
    const char *option, *title;
    const struct br_words *words;
};

/* What the program has of the beam. beam/beam.h says it of each. */
struct br_beam {
    size_t (*add_options)(const struct br_command *command, struct br_option row[BR_OPTIONS],
                          size_t count);
    const char *(*standard)(const struct br_option *row, char text[BR_OPTION_TEXT]);
    enum br_status (*check_options)(struct br_options *options, struct br_error *err);
    enum br_status (*start)(struct br_error *err);
    enum br_status (*end)(enum br_status status, struct br_error *err);
    bool (*first)(void);
    int (*size)(void);
    const char *const *topics; /* of the help, besides the commands; NULL-terminated */
    void (*print_topic)(const char *topic);
};

/* A program; its main.c has it. */
struct br_program {
    const char *name, *about, *hint;          /* hint: the last sentence of the help */
    const struct br_command *const *commands; /* NULL-terminated, in the order of the help */
    const char *example[BR_MOST_EXAMPLES];
    const struct br_beam *beam;     /* NULL: none */
    const char *const *of_beamrate; /* commands that only beamrate has; NULL-terminated, or NULL */
};
extern const struct br_program br_program;

/* Runs the program: its exit code. */
int br_run_program(int argc, const char **argv);

/* Whether this process prints and writes: the first of several ranks. */
static inline bool br_is_first(void)
{
    return !br_program.beam || br_program.beam->first();
}

/* NULL: there is none. */
const struct br_command *br_find_command(const char *name);

/* ---- the documentation and the completions, made from commands, options and registries ---- */

/* Of the program: its commands. */
void br_print_help(FILE *out);
void br_print_command_help(FILE *out, const struct br_command *command);

/* Writes words in lines of the terminal's width. The first line has `at` letters already. */
void br_print_wrapped(FILE *out, const char *text, size_t at, size_t indent);

#endif
