/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Options: one row each (option_rows.c). From the rows come parsing, refusals, --help, the shells'
 * completions, the man page and docs/options.md. */
#ifndef BR_CLI_OPTION_H
#define BR_CLI_OPTION_H

#include <stdbool.h>
#include <stdio.h>

#include "base/words.h"

/* The commands that take an option. */
enum {
    BR_FOR_TABLES = 1,
    BR_FOR_STUDY = 2,
    BR_FOR_CHECK = 4,
    BR_FOR_RUN = 8,
    BR_FOR_TRADE = 16,
    BR_FOR_EXTREMES = 64,
    BR_FOR_FIGURES = 128,
    BR_FOR_SCENES = 256,
    BR_FOR_COMPLETIONS = 512,
    BR_FOR_HELP = 1024,
    BR_FOR_ORDERS = 2048,
    /* those that take the options of the method */
    BR_FOR_MARCHES = BR_FOR_TABLES | BR_FOR_STUDY | BR_FOR_CHECK | BR_FOR_RUN,
};

/* In the order of the help. */
enum br_option_id {
    BR_OPT_RUN,
    BR_OPT_READ,
    BR_OPT_REPEAT,
    BR_OPT_N,
    BR_OPT_K,
    BR_OPT_STEPS,
    BR_OPT_REFERENCE,
    BR_OPT_NORM,
    BR_OPT_METHODS,
    BR_OPT_TOLERANCES,
    BR_OPT_SPLIT,
    BR_OPT_ERROR,
    BR_OPT_VALUE,
    BR_OPT_COLUMN,
    BR_OPT_WHERE,
    BR_OPT_FINEST,
    BR_OPT_WITHOUT,
    BR_OPT_COST,
    BR_OPT_DIMENSION,
    BR_OPT_FORMAL,
    BR_OPT_EXPECT,
    BR_OPT_SECONDS,
    BR_OPT_TIME_LIMIT,
    BR_OPT_FIELDS,
    BR_OPT_CHECK,
    BR_OPT_AT,
    BR_OPT_ROWS,
    BR_OPT_TRUST,
    BR_OPT_ALL,
    BR_OPT_JUNIT,
    BR_OPT_JSON,
    BR_OPT_GITHUB,
    BR_OPT_MARKDOWN,
    BR_OPT_COMPARE,
    BR_OPT_UPDATE_BASELINE,
    BR_OPT_NEW,
    BR_OPT_RESUME,
    BR_OPT_SET,
    BR_OPT_OUT,
    BR_OPT_FORMAT,
    BR_OPT_NO_PLOTS,
    BR_OPT_THREADS,
    BR_OPT_QUIET,
    BR_OPT_HELP,
    BR_OPT_METHOD, /* BR_OPT_METHOD + i: field i of the beam's method */
    BR_OPT_LAST_OF_METHOD = BR_OPT_METHOD + 8,
    BR_OPTIONS
};

/* How the text is read while the command line is parsed; what needs a scene is read later. */
enum br_option_kind {
    BR_TAKES_FLAG,
    BR_TAKES_TEXT, /* any text: the command reads it */
    BR_TAKES_FILE,
    BR_TAKES_DIR,
    BR_TAKES_NUMBER,  /* a number of the range */
    BR_TAKES_SECONDS, /* the same, s, or with a unit: 5 min */
    BR_TAKES_COUNTS,  /* whole numbers, each once */
    BR_TAKES_NUMBERS, /* numbers of the range, each once */
    BR_TAKES_TIMES,   /* times above 0: seconds, or parts of the duration, T/100 */
    BR_TAKES_WORD,    /* a row of the registry */
    BR_TAKES_WORD_LIST,
    BR_TAKES_METHOD, /* a field of the method */
};

/* What a row has of its own for some of the commands that take it. */
struct br_own {
    unsigned commands;                             /* 0: the end of the list */
    const char *standard, *argument, *help, *more; /* NULL: as in the row */
    enum br_option_kind kind;                      /* BR_TAKES_FLAG: kind and range as in the row */
    struct br_number_range range;
};

struct br_option {
    enum br_option_id id;
    const char *name; /* without -- */
    char letter;      /* of the short option; 0: none */
    const char *argument;
    const char *help;     /* a line, without the default */
    const char *standard; /* the default, read as if it was given; NULL: none */
    enum br_option_kind kind;
    struct br_number_range range;
    const struct br_words *words;
    unsigned commands;        /* that take it */
    const char *more;         /* sentences for the manual; NULL: none */
    bool repeats;             /* it may be given several times: its text has a line for each */
    const struct br_own *own; /* NULL: all commands have the same */
};

#define BR_RANGE(low, high, whole) \
    {                              \
        low, high, whole           \
    }
#define BR_OWN(...)                \
    .own = (const struct br_own[]) \
    {                              \
        __VA_ARGS__,               \
        {                          \
            0                      \
        }                          \
    }

struct br_command;

/* The rows that a command takes, in the help's order (out); returns how many. */
size_t br_options_of(const struct br_command *command, struct br_option row[BR_OPTIONS]);

/* Adds the rows of a list that a command takes behind `count` others; returns how many there are
 * then. */
size_t br_options_add(const struct br_option *from, size_t rows, const struct br_command *command,
                      struct br_option row[BR_OPTIONS], size_t count);

/* The default as the help shows it, or NULL. text: workspace. */
enum { BR_OPTION_TEXT = 64 };
const char *br_option_default(const struct br_option *row, char text[BR_OPTION_TEXT]);

/* The help of an option, as "elements (default 100)"; returns text (out). */
const char *br_option_help(const struct br_option *row, char *text, size_t size);

/* ---- registries that options name ---- */

extern const struct br_words br_format_words;

/* ---- a command line ---- */

/* By br_option_id. */
struct br_options {
    const struct br_command *command;
    const char *given[BR_OPTIONS]; /* the text as given, owned; NULL: not given */
    const char *text[BR_OPTIONS];  /* the same, or the default; NULL: neither */
    double *number[BR_OPTIONS];    /* count of them, owned: numbers, or rows of the registry */
    size_t *whole[BR_OPTIONS];     /* count of them, owned: BR_TAKES_COUNTS */
    size_t count[BR_OPTIONS];
    char **word; /* arguments that are no options; owned */
    size_t words;
};

/* Parses argv (argv[0] is "beamrate COMMAND"). Fails with BR_BAD_INPUT, naming the option, what was
 * found and what was expected, or BR_NO_MEMORY. A name may be cut short where no other one begins
 * so. With --help the rest is not checked. Clear the
 * options even after a failure. */
enum br_status br_options_parse(int argc, const char **argv, const struct br_command *command,
                                struct br_options *options, struct br_error *err);
void br_options_clear(struct br_options *options);

bool br_option_given(const struct br_options *o, enum br_option_id id);

/* The name of the first option of the list that is given; NULL: none. BR_OPTIONS ends the list. */
const char *br_first_given(const struct br_options *o, const enum br_option_id *list);

/* The text as given, or the default; NULL: neither. */
const char *br_option_text(const struct br_options *o, enum br_option_id id);

/* The number, or the row; `otherwise` where there is none. */
double br_option_number(const struct br_options *o, enum br_option_id id, double otherwise);

/* ---- times: "0.1", "0.1 s", "100 ms", "T/20" ---- */

/* Reads a time, s, at the start of text; duration: of the scene, s. Returns the text that follows,
 * the end or a comma; NULL: it is no time. */
const char *br_read_time(const char *text, double duration, double *seconds);

/* Refuses a list in which one time has no unit and another one a unit that is not s: "50,25 ms". */
enum br_status br_times_check(const char *text, struct br_error *err);

#endif
