/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The options of orders and check, and those of all commands, a row each. */
#include "cli/command.h"

#include "orders/orders.h"
#include "tables/document.h"

BR_WORDS(format, br_document_formats)
const struct br_words br_format_words = {format_name, format_title, NULL};

#define WHOLE(low, high) BR_RANGE(low, high, true)
#define BETWEEN(low, high) BR_RANGE(low, high, false)
#define OWN BR_OWN

static const char folder[] = "folder of the results";

static const struct br_option rows[] = {
    /* orders: the numbers of any program */
    {BR_OPT_RUN, "run", 0, "COMMAND", "runs it at each resolution; {n}, {k}, ... are replaced",
     NULL, BR_TAKES_TEXT, .commands = BR_FOR_ORDERS,
     .more = "Words are as in a shell, with quotes and backslashes, but no shell is used. Each run "
             "has an empty folder of its own, no input and LC_ALL=C. A word that names a file "
             "becomes its whole path."},
    {BR_OPT_READ, "read", 0, "NAME=WHAT",
     "a number of its output: a regular expression with one group, json:POINTER or csv:COLUMN",
     NULL, BR_TAKES_TEXT, .commands = BR_FOR_ORDERS,
     .more =
         "May be given several times. last:REGEX takes the last match of many. stderr: before "
         "it reads standard error, file:PATH: a file that the run writes, as out_{n}.txt. The "
         "NAME h, n, dofs, cells, level, k, dt or steps is that of a resolution, which the run itself states.",
     .repeats = true},
    {BR_OPT_REPEAT, "repeat", 0, "COUNT", "number of runs of each resolution; their mean is used",
     "1", BR_TAKES_TEXT, .commands = BR_FOR_ORDERS,
     .more = "For programs that draw random numbers: {repeat} in the command is 1, 2, ..., for "
             "example a seed. The standard deviations of the means give their weights."},

    /* what is marched, or run */
    {BR_OPT_N, "n", 'n', "LIST",
     "elements along an edge; or h=LIST, level=LIST, dofs=LIST, cells=LIST", NULL, BR_TAKES_TEXT,
     .commands = BR_FOR_ORDERS,
     .more = "The word replaces {n} in the command: {h}, {level}, {dofs}."},
    {BR_OPT_K, "k", 'k', "LIST", "time steps; or dt=LIST, steps=LIST (numbers of steps)", NULL,
     BR_TAKES_TEXT, .commands = BR_FOR_ORDERS},

    /* what is wanted of numbers, what a march may take */
    {BR_OPT_ERROR, "error", 0, "LIST",
     "columns that are errors (default: all that fall as errors do)", NULL, BR_TAKES_TEXT,
     .commands = BR_FOR_ORDERS},
    {BR_OPT_VALUE, "value", 0, "LIST", "columns, or readings, whose limit is not known", NULL,
     BR_TAKES_TEXT, .commands = BR_FOR_ORDERS},
    {BR_OPT_COLUMN, "column", 0, "LIST", "what columns are, by heading or position: dx=h,3=l2",
     NULL, BR_TAKES_TEXT, .commands = BR_FOR_ORDERS,
     .more =
         "h, n, points (h = 1/(points - 1)), interior (nodes, h = 1/(interior + 1)), dofs, cells, "
         "level, k, dt and steps state the resolution; std has standard deviations, degree that of "
         "polynomials, aside has no part; any other name is that of an error, or with --value of a "
         "value. A column named here wins over all others of its axis."},
    {BR_OPT_WHERE, "where", 0, "COLUMN=WORD", "reads the rows of one study: method=P1", NULL,
     BR_TAKES_TEXT, .commands = BR_FOR_ORDERS,
     .more = "Without it, each study is answered, for each word or degree of a column."},
    {BR_OPT_FINEST, "finest", 0, "COUNT", "orders of so many of the finest sizes alone", NULL,
     BR_TAKES_TEXT, .commands = BR_FOR_ORDERS,
     .more = "Along each axis. The answer, verdicts and pictures say so; the other rows are shown "
             "as left out by hand."},
    {BR_OPT_WITHOUT, "without", 0, "LIST", "sizes that are left out: 8, or 8,16, or n=8", NULL,
     BR_TAKES_TEXT, .commands = BR_FOR_ORDERS, .more = "Before --finest counts."},
    {BR_OPT_COST, "cost", 0, "NAME",
     "cost of programs: cpu, wall, dofs, iterations, memory, or a column (default: the first that "
     "all have)",
     NULL, BR_TAKES_TEXT, .commands = BR_FOR_TRADE,
     .more =
         "Of a run, cpu and wall are measured, and so is memory. Other names are those of columns, "
         "or of numbers that 'read:' of a study file names."},
    {BR_OPT_DIMENSION, "dimension", 0, "D",
     "dimension of the mesh, for numbers of unknowns or cells", NULL, BR_TAKES_TEXT,
     .commands = BR_FOR_ORDERS,
     .more =
         "If it is not given, the growth of the numbers and the rates of a table decide it, or 2 "
         "is assumed for unknowns. The answer states what is assumed; a verdict then needs this "
         "option."},
    {BR_OPT_FORMAL, "formal-order", 0, "P", "order of the values in theory", NULL, BR_TAKES_TEXT,
     .commands = BR_FOR_ORDERS,
     .more = "For the uncertainty of limits, 1 to 10. If it is not given, 2 is assumed; the answer "
             "states this, and the result for 1."},
    {BR_OPT_EXPECT, "expect", 0, "TEXT", "verdicts: 'l2: h 2 +- 0.1, k 1; h1 >= 0.9', or '2'", NULL,
     BR_TAKES_TEXT, .commands = BR_FOR_ORDERS,
     .more = "'h 2 +- 0.1 down to 1e-9': errors that stop falling below that are expected."},
    {BR_OPT_TIME_LIMIT, "time-limit", 0, "SECONDS", "longest run or march, set-up included, s",
     "600", BR_TAKES_SECONDS, BETWEEN(0, 1e10), .commands = BR_FOR_ORDERS},

    /* what `check` takes and writes: the formats but for the text */
    {BR_OPT_TRUST, "trust", 0, NULL,
     "run the commands of the study files, and read their tables in any folder", NULL,
     BR_TAKES_FLAG, .commands = BR_FOR_ORDERS | BR_FOR_CHECK | BR_FOR_TRADE,
     .more = "Needed each time: a study file with a command is a program. Read it before."},
    {BR_OPT_JUNIT, "junit", 0, "FILE", "JUnit's XML, for CI systems", NULL, BR_TAKES_FILE,
     .commands = BR_FOR_CHECK | BR_FOR_ORDERS},
    {BR_OPT_JSON, "json", 0, "FILE", "all results, for programs and for --compare", NULL,
     BR_TAKES_FILE, .commands = BR_FOR_CHECK | BR_FOR_ORDERS | BR_FOR_RUN,
     OWN({BR_FOR_RUN, .help = "all results, for programs; - is standard output"})},
    {BR_OPT_GITHUB, "github", 0, "FILE", "annotations of what did not pass, for GitHub's pages",
     NULL, BR_TAKES_FILE, .commands = BR_FOR_CHECK | BR_FOR_ORDERS,
     .more = "GitHub reads them from a job's output: with /dev/stderr the report stays on standard "
             "output."},
    {BR_OPT_MARKDOWN, "markdown", 0, "FILE", "a summary for the page of a CI job", NULL,
     BR_TAKES_FILE, .commands = BR_FOR_CHECK | BR_FOR_ORDERS,
     .more = "Reports are written whole or not at all; - is standard output, and then no table is "
             "printed."},
    {BR_OPT_COMPARE, "compare", 0, "FILE",
     "JSON of an earlier check: shows what has changed since, and how serious it is", NULL,
     BR_TAKES_FILE, .commands = BR_FOR_CHECK | BR_FOR_ORDERS,
     .more = "Serious differences fail the check."},
    {BR_OPT_UPDATE_BASELINE, "update-baseline", 0, NULL,
     "write the results into the file of --compare", NULL, BR_TAKES_FLAG,
     .commands = BR_FOR_CHECK | BR_FOR_ORDERS, .more = "The file need not exist."},

    /* what is cached */
    {BR_OPT_RESUME, "resume", 0, NULL, "use finished runs that are cached", NULL, BR_TAKES_FLAG,
     .commands = BR_FOR_ORDERS,
     .more = "After an interruption, or for a larger grid. Finished runs are cached in DIR/.cache, "
             "or in orders-cache without --out. A run is used again if its words, its program and "
             "the files that its words name are the same. Other files that the program reads or "
             "starts are not checked: do not give this option if they have changed."},

    /* for all */
    {BR_OPT_OUT, "out", 'o', "DIR", "folder of the results (default: none are written)", NULL,
     BR_TAKES_DIR,
     .commands = BR_FOR_MARCHES | BR_FOR_TRADE | BR_FOR_EXTREMES | BR_FOR_FIGURES | BR_FOR_ORDERS,
     OWN({BR_FOR_TABLES, .standard = "results", .help = folder},
         {BR_FOR_STUDY, .standard = "results/study", .help = folder},
         {BR_FOR_TRADE, .standard = "trade", .help = folder},
         {BR_FOR_EXTREMES, .standard = "extremes", .help = folder},
         {BR_FOR_FIGURES, .standard = "figures", .help = folder})},
    {BR_OPT_FORMAT, "format", 0, "LIST", "formats to write (default: all)", NULL,
     BR_TAKES_WORD_LIST, .words = &br_format_words,
     .commands = BR_FOR_TABLES | BR_FOR_STUDY | BR_FOR_TRADE | BR_FOR_EXTREMES | BR_FOR_ORDERS |
                 BR_FOR_CHECK},
    {BR_OPT_NO_PLOTS, "no-plots", 0, NULL, "write no plots", NULL, BR_TAKES_FLAG,
     .commands = BR_FOR_TABLES | BR_FOR_STUDY | BR_FOR_RUN | BR_FOR_TRADE | BR_FOR_EXTREMES |
                 BR_FOR_ORDERS},
    {BR_OPT_THREADS, "threads", 'j', "COUNT", "threads; 0: all cores", "0", BR_TAKES_NUMBER,
     WHOLE(0, 4096),
     .commands = BR_FOR_TABLES | BR_FOR_STUDY | BR_FOR_CHECK | BR_FOR_EXTREMES | BR_FOR_FIGURES |
                 BR_FOR_ORDERS,
     .more = "The results are the same for any number, to the bit."},
    {BR_OPT_QUIET, "quiet", 'q', NULL, "no progress, no report on the terminal", NULL,
     BR_TAKES_FLAG,
     .commands = BR_FOR_MARCHES | BR_FOR_TRADE | BR_FOR_EXTREMES | BR_FOR_FIGURES | BR_FOR_ORDERS},
    {BR_OPT_HELP, "help", 'h', NULL, "this help", NULL, BR_TAKES_FLAG, .commands = ~0u},
};
enum { ROWS = sizeof rows / sizeof *rows };

/* The row as a command takes it. */
static struct br_option row_of(struct br_option row, const struct br_command *command)
{
    const struct br_own *own = row.own;
    while (own && own->commands && !(own->commands & command->bit))
        own++;
    if (!own || !own->commands)
        return row;
    row.standard = own->standard ? own->standard : row.standard;
    row.argument = own->argument ? own->argument : row.argument;
    row.help = own->help ? own->help : row.help;
    row.more = own->more ? own->more : row.more;
    if (own->kind != BR_TAKES_FLAG) {
        row.kind = own->kind;
        row.range = own->range;
    }
    return row;
}

/* Adds the rows of a list that a command takes. */
size_t br_options_add(const struct br_option *from, size_t rows_of,
                      const struct br_command *command, struct br_option row[BR_OPTIONS],
                      size_t count)
{
    for (size_t i = 0; i < rows_of; i++)
        if (from[i].commands & command->bit)
            row[count++] = row_of(from[i], command);
    return count;
}

static int by_id(const void *a, const void *b)
{
    const struct br_option *x = a, *y = b;
    return (x->id > y->id) - (x->id < y->id);
}

size_t br_options_of(const struct br_command *command, struct br_option row[BR_OPTIONS])
{
    size_t count = br_options_add(rows, ROWS, command, row, 0);
    if (br_program.beam)
        count = br_program.beam->add_options(command, row, count);
    qsort(row, count, sizeof *row, by_id);
    return count;
}

const char *br_option_default(const struct br_option *row, char text[BR_OPTION_TEXT])
{
    return row->kind == BR_TAKES_METHOD ? br_program.beam->standard(row, text) : row->standard;
}

const char *br_option_help(const struct br_option *row, char *text, size_t size)
{
    char value[BR_OPTION_TEXT];
    const char *standard = br_option_default(row, value);
    snprintf(text, size, "%s%s%s%s", row->help, standard ? " (default " : "",
             standard ? standard : "", standard ? ")" : "");
    return text;
}
