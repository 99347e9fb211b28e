/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The options, a row each, and what single commands have of their own: defaults, limits, words. */
#include <math.h>

#include "cli/command.h"
#include "study/grid/study.h"
#include "tables/document.h"

/* ---- registries ---- */

BR_WORDS(norm, br_norms)
BR_WORDS(format, br_document_formats)
BR_WORDS(judge, br_judges)

/* The name with its arguments: fine:N,K. */
static const char *judge_syntax(size_t row)
{
    return judge_name(row) ? br_judges[row]->syntax : NULL;
}

const struct br_words br_norm_words = {norm_name, norm_title, NULL};
const struct br_words br_format_words = {format_name, format_title, NULL};
const struct br_words br_judge_words = {judge_syntax, judge_title, NULL};

/* ---- options ---- */

enum {
    MARCHES = BR_FOR_TABLES | BR_FOR_STUDY | BR_FOR_CHECK | BR_FOR_RUN
}; /* who takes the method's options */

#define WHOLE(low, high) \
    {                    \
        low, high, true  \
    }
#define BETWEEN(low, high) \
    {                      \
        low, high, false   \
    }

static const char nests[] = "Each must divide the number of elements of a fine reference.",
                  divides[] = "Each must divide the duration, and be a multiple of the time step "
                              "of a fine reference.";
static const char folder[] = "folder of the results";

#define OWN(...)                   \
    .own = (const struct br_own[]) \
    {                              \
        __VA_ARGS__,               \
        {                          \
            0                      \
        }                          \
    }

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
     "1", BR_TAKES_NUMBER, WHOLE(1, 1000), .commands = BR_FOR_ORDERS,
     .more = "For programs that draw random numbers: {repeat} in the command is 1, 2, ..., for "
             "example a seed. The standard deviations of the means give their weights."},

    /* what is marched, or run */
    {BR_OPT_N, "n", 'n', "LIST", "elements of the mesh", NULL, BR_TAKES_COUNTS,
     .commands =
         BR_FOR_TABLES | BR_FOR_STUDY | BR_FOR_RUN | BR_FOR_TRADE | BR_FOR_EXTREMES | BR_FOR_ORDERS,
     OWN({BR_FOR_TABLES, .standard = "100,200,400,800,1600,3200", .more = nests},
         {BR_FOR_STUDY, .standard = "25,50,100,200", .more = nests},
         {BR_FOR_RUN, .standard = "100", .argument = "COUNT", .kind = BR_TAKES_NUMBER,
          .range = WHOLE(1, 1e9)},
         {BR_FOR_ORDERS,
          .help = "elements along an edge; or h=LIST, level=LIST, dofs=LIST, cells=LIST",
          .more = "The word replaces {n} in the command: {h}, {level}, {dofs}.",
          .kind = BR_TAKES_TEXT})},
    {BR_OPT_K, "k", 'k', "LIST", "time steps, s, or T/100, T: duration", NULL, BR_TAKES_TIMES,
     .commands =
         BR_FOR_TABLES | BR_FOR_STUDY | BR_FOR_RUN | BR_FOR_TRADE | BR_FOR_EXTREMES | BR_FOR_ORDERS,
     OWN({BR_FOR_TABLES, .standard = "0.01,0.005,0.002,0.001,0.0005,0.0001", .more = divides},
         {BR_FOR_STUDY, .standard = "T/100,T/200,T/400,T/800", .more = divides},
         {BR_FOR_RUN, .standard = "T/1000", .argument = "TIME"},
         {BR_FOR_ORDERS, .help = "time steps; or dt=LIST, steps=LIST (numbers of steps)",
          .kind = BR_TAKES_TEXT})},
    {BR_OPT_STEPS, "steps", 0, "LIST", "numbers of time steps, instead of --k", NULL,
     BR_TAKES_COUNTS, .commands = BR_FOR_TABLES | BR_FOR_STUDY | BR_FOR_RUN | BR_FOR_TRADE,
     OWN({BR_FOR_RUN, .argument = "COUNT", .kind = BR_TAKES_NUMBER, .range = WHOLE(1, 1e12)})},
    {BR_OPT_REFERENCE, "reference", 0, "NAME",
     "what errors are measured against: exact, fine:N,K or mms", NULL, BR_TAKES_TEXT,
     .words = &br_judge_words, .commands = BR_FOR_TABLES | BR_FOR_STUDY | BR_FOR_TRADE,
     .more =
         "exact is the default; for a scene that was manufactured from a solution, it is mms. "
         "fine:N,K is a run of N elements and steps of K seconds (or T/100), whose own error is "
         "then measured against the exact solution.",
     OWN({BR_FOR_TABLES, .standard = "fine:12800,1e-5",
          .more = "The errors against the exact solution are shown, too."},
         {BR_FOR_TRADE, .more = "exact is the default; fine:N,K marches the scheme of the highest "
                                "order, and is not possible with a goal."})},
    {BR_OPT_NORM, "norm", 0, "LIST", "norms of the error", "l2", BR_TAKES_WORD_LIST,
     .words = &br_norm_words, .commands = BR_FOR_TABLES | BR_FOR_STUDY | BR_FOR_TRADE,
     .more = "Reports in other norms than l2 are called NAME-energy, NAME-tip.",
     OWN({BR_FOR_TRADE, .more = "One norm; with --split, several."})},
    {BR_OPT_METHODS, "methods", 0, "LIST",
     "methods, by names like bdf2+implicit ('beamrate help methods')", NULL, BR_TAKES_TEXT,
     .commands = BR_FOR_TRADE | BR_FOR_EXTREMES,
     .more =
         "A name is made of words joined by +, in any order, at most one of a kind: a time scheme, "
         "a contact rule, a friction rule, a linear solver, p1 or p2 (the degree of the axial "
         "elements): euler+lagged, bdf2+uzawa, bdf2+umfpack."},
    {BR_OPT_TOLERANCES, "tolerance", 0, "LIST", "tolerances of schemes that choose their steps",
     NULL, BR_TAKES_NUMBERS, BETWEEN(1e-14, 1), .commands = BR_FOR_TRADE},
    {BR_OPT_SPLIT, "split", 0, NULL,
     "splits the error of each run by its sources instead (one run: n = 100, T/1000)", NULL,
     BR_TAKES_FLAG, .commands = BR_FOR_TRADE,
     .more =
         "The sources are round-off of the linear solver, tolerance of an iteration of friction, "
         "mu, contact force from the step before, time steps, and elements. A chain of marches "
         "leads from the run to the exact solution; each has one source less than the one before. "
         "A part is the norm of a difference. The differences add up to the whole error as "
         "functions, and at the tip as numbers with signs. A part below its floor cannot be "
         "determined. One scene; by default the first scheme. With several k or n a plot shows the "
         "parts over them."},

    /* what is wanted of numbers, what a march may take */
    {BR_OPT_ERROR, "error", 0, "LIST",
     "columns that are errors (default: all that fall as errors do)", NULL, BR_TAKES_TEXT,
     .commands = BR_FOR_ORDERS | BR_FOR_TRADE,
     OWN({BR_FOR_TRADE, .argument = "E",
          .help = "goal: the cheapest way to this relative error, like 1e-3 or 5%",
          .more = "The norm of the error, divided by the norm of the solution. Without -n, -k, "
                  "--steps, --tolerance and --methods all meshes, steps and time schemes are "
                  "tried."})},
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
    {BR_OPT_DIMENSION, "dimension", 0, "D",
     "dimension of the mesh, for numbers of unknowns or cells", NULL, BR_TAKES_NUMBER, WHOLE(1, 16),
     .commands = BR_FOR_ORDERS,
     .more =
         "If it is not given, the growth of the numbers and the rates of a table decide it, or 2 "
         "is assumed for unknowns. The answer states what is assumed; a verdict then needs this "
         "option."},
    {BR_OPT_FORMAL, "formal-order", 0, "P", "order of the values in theory", NULL, BR_TAKES_NUMBER,
     BETWEEN(0, 11), .commands = BR_FOR_ORDERS,
     .more = "For the uncertainty of limits, 1 to 10. If it is not given, 2 is assumed; the answer "
             "states this, and the result for 1."},
    {BR_OPT_EXPECT, "expect", 0, "TEXT", "verdicts: 'l2: h 2 +- 0.1, k 1 +- 0.05; h1: h 1 +- 0.1'",
     NULL, BR_TAKES_TEXT, .commands = BR_FOR_ORDERS,
     .more = "'h 2 +- 0.1 down to 1e-9': errors that stop falling below that are expected."},
    {BR_OPT_SECONDS, "seconds", 0, "S",
     "goal: the least error with so many seconds of a march, set-up included", NULL,
     BR_TAKES_NUMBER, BETWEEN(0, INFINITY), .commands = BR_FOR_TRADE,
     .more = "One of --error and --seconds, for one scene."},
    {BR_OPT_TIME_LIMIT, "time-limit", 0, "SECONDS", "longest run or march, set-up included, s",
     NULL, BR_TAKES_NUMBER, BETWEEN(0, 1e10), .commands = BR_FOR_TRADE | BR_FOR_ORDERS,
     OWN({BR_FOR_TRADE, .standard = "10",
          .more = "A run or march that will surely take longer is stopped early, and the report "
                  "says so."},
         {BR_FOR_ORDERS, .standard = "600"})},

    /* what `run` shows */
    {BR_OPT_FIELDS, "fields", 0, "LIST",
     "fields to march: axial, bending or both (default: what the scene has)", NULL, BR_TAKES_TEXT,
     .commands = BR_FOR_RUN,
     .more =
         "With Tresca's friction the axial field is not marched by default: neither the friction "
         "bound nor bending needs it."},
    {BR_OPT_CHECK, "check", 0, NULL,
     "certificate and energy balance of every step; exit code 1 "
     "beyond a limit",
     NULL, BR_TAKES_FLAG, .commands = BR_FOR_RUN,
     .more = "Recomputes the residuals and laws of every step from nodal values, stage by stage, "
             "with code that the solver does not share."},
    {BR_OPT_AT, "at", 0, "LIST", "times of the fields, multiples of k, or 'every:TIME' from 0 on",
     NULL, BR_TAKES_TEXT, .commands = BR_FOR_RUN, .more = "By default about every T/10."},
    {BR_OPT_ROWS, "rows", 0, "COUNT", "rows of history.csv, at most", "10000", BR_TAKES_NUMBER,
     WHOLE(2, 1e9), .commands = BR_FOR_RUN},

    /* what `check` takes and writes: the formats but for the text */
    {BR_OPT_TRUST, "trust", 0, NULL,
     "run the commands of the study files, and read their tables in any folder", NULL,
     BR_TAKES_FLAG, .commands = BR_FOR_ORDERS | BR_FOR_CHECK,
     .more = "Needed each time: a study file with a command is a program. Read it before."},
    {BR_OPT_ALL, "all", 0, NULL, "all bundled scenes", NULL, BR_TAKES_FLAG,
     .commands = BR_FOR_CHECK | BR_FOR_TRADE,
     OWN({BR_FOR_TRADE, .help = "try all trials (default: what takes about 10 s a scene)",
          .more = "The most expensive trials are left out, unless -n, -k, --steps or --tolerance "
                  "choose the trials."})},
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

    /* scenes */
    {BR_OPT_NEW, "new", 0, "FILE", "write a template with every key; - is standard output", NULL,
     BR_TAKES_FILE, .commands = BR_FOR_SCENES,
     .more =
         "A valid scene, with the meaning, unit and default of each key. An existing file is not "
         "replaced."},

    /* what is kept */
    {BR_OPT_RESUME, "resume", 0, NULL, "use finished work that is kept in the folder of --out",
     NULL, BR_TAKES_FLAG, .commands = BR_FOR_TABLES | BR_FOR_STUDY | BR_FOR_TRADE | BR_FOR_ORDERS,
     .more = "After an interruption, or for a larger grid: finished cells and trials are kept in "
             "DIR/.kept, and only the others are marched. Work that another version of the program "
             "or another machine has kept is not used.",
     OWN({BR_FOR_ORDERS,
          .more =
              "After an interruption, or for a larger grid. Finished runs are kept in DIR/.kept, "
              "or in orders-kept without --out. A run is used again if its words, its program and "
              "the files that its words name are the same. Other files that the program reads or "
              "starts are not checked: do not give this option if they have changed."})},

    /* another scene */
    {BR_OPT_SET, "set", 0, "KEY=VALUE",
     "a key of the scene gets another value, with its unit: 'contact.stiffness=2e3 N/m'", NULL,
     BR_TAKES_TEXT,
     .commands = BR_FOR_STUDY | BR_FOR_CHECK | BR_FOR_RUN | BR_FOR_TRADE | BR_FOR_EXTREMES,
     .more = "May be given several times. KEY is any key of the scene, with its section: length, "
             "friction.coefficient. It is added if the scene does not have it. VALUE is read as if "
             "it stood in the file. Of several scenes each has it.",
     .repeats = true},

    /* for all */
    {BR_OPT_OUT, "out", 'o', "DIR", "folder of the results (default: none are written)", NULL,
     BR_TAKES_DIR,
     .commands = MARCHES | BR_FOR_TRADE | BR_FOR_EXTREMES | BR_FOR_FIGURES | BR_FOR_ORDERS,
     OWN({BR_FOR_TABLES | BR_FOR_STUDY, .standard = "results", .help = folder},
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
     .commands = BR_FOR_TABLES | BR_FOR_STUDY | BR_FOR_CHECK | BR_FOR_TRADE | BR_FOR_EXTREMES |
                 BR_FOR_FIGURES | BR_FOR_ORDERS,
     .more = "The results are the same for any number, to the bit."},
    {BR_OPT_QUIET, "quiet", 'q', NULL, "no progress, no report on the terminal", NULL,
     BR_TAKES_FLAG,
     .commands = MARCHES | BR_FOR_TRADE | BR_FOR_EXTREMES | BR_FOR_FIGURES | BR_FOR_ORDERS},
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

size_t br_options_of(const struct br_command *command, struct br_option row[BR_OPTIONS])
{
    size_t count = 0;
    for (size_t i = 0; i < ROWS; i++)
        if (rows[i].commands & command->bit)
            row[count++] = row_of(rows[i], command);
    for (size_t i = 0; i < BR_METHOD_FIELDS && MARCHES & command->bit; i++) {
        const struct br_method_field *f = &br_method_fields[i];
        if (!f->argument)
            continue;
        row[count++] = (struct br_option){.id = (enum br_option_id)(BR_OPT_METHOD + i),
                                          .name = f->name,
                                          .argument = f->argument,
                                          .help = f->help,
                                          .kind = BR_TAKES_METHOD,
                                          .words = f->words,
                                          .commands = MARCHES,
                                          .more = f->more};
    }
    return count;
}

const char *br_option_name(enum br_option_id id)
{
    size_t i = 0;
    while (rows[i].id != id)
        i++;
    return rows[i].name;
}

const char *br_option_default(const struct br_option *row, char text[BR_METHOD_VALUE])
{
    if (row->kind != BR_TAKES_METHOD)
        return row->standard;
    const struct br_method_field *f = &br_method_fields[row->id - BR_OPT_METHOD];
    const struct br_method usual = br_method_default();
    return f->standard ? f->standard : br_method_field_text(f, &usual, text);
}
