/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The options of the commands that march, a row each, and what single commands have of their own:
 * defaults, limits, words. */
#include <math.h>

#include "cli/beam/beam.h"
#include "study/grid/study.h"

/* ---- registries ---- */

BR_WORDS(norm, br_norms)
BR_WORDS(reference, br_references)

/* The name with its arguments: fine:N,K. */
static const char *reference_syntax(size_t row)
{
    return reference_name(row) ? br_references[row]->syntax : NULL;
}

static const struct br_words norm_words = {norm_name, norm_title, NULL};
const struct br_words br_reference_words = {reference_syntax, reference_title, NULL};

size_t br_registries(struct br_registry list[BR_REGISTRIES])
{
    size_t count = 0;
    for (size_t i = 0; i < BR_METHOD_FIELDS; i++) {
        const struct br_method_field *f = &br_method_fields[i];
        if (f->words && (f->words->title || f->words->available))
            list[count++] = (struct br_registry){f->name, f->help, f->words};
    }
    list[count++] =
        (struct br_registry){"reference", "what errors are measured against", &br_reference_words};
    list[count++] = (struct br_registry){"norm", "norms of the error", &norm_words};
    list[count++] = (struct br_registry){"format", "formats of the results", &br_format_words};
    return count;
}

/* ---- options ---- */

_Static_assert(BR_OPT_METHOD + BR_METHOD_FIELDS == BR_OPTIONS, "an option for each field");

#define WHOLE(low, high) BR_RANGE(low, high, true)
#define BETWEEN(low, high) BR_RANGE(low, high, false)
#define OWN BR_OWN

static const char nests[] = "Each must divide the number of elements of a fine reference.",
                  divides[] = "Each must divide the duration, and be a multiple of the time step "
                              "of a fine reference.";

static const struct br_option rows[] = {
    /* what is marched, or run */
    {BR_OPT_N, "n", 'n', "LIST", "elements of the mesh", NULL, BR_TAKES_COUNTS,
     .commands = BR_FOR_TABLES | BR_FOR_STUDY | BR_FOR_RUN | BR_FOR_TRADE | BR_FOR_EXTREMES,
     OWN({BR_FOR_TABLES, .standard = "100,200,400,800,1600,3200", .more = nests},
         {BR_FOR_STUDY, .standard = "25,50,100,200", .more = nests},
         {BR_FOR_RUN, .standard = "100", .argument = "COUNT", .kind = BR_TAKES_NUMBER,
          .range = WHOLE(1, 1e9)})},
    {BR_OPT_K, "k", 'k', "LIST", "time steps, s, or T/100, T: duration", NULL, BR_TAKES_TIMES,
     .commands = BR_FOR_TABLES | BR_FOR_STUDY | BR_FOR_RUN | BR_FOR_TRADE | BR_FOR_EXTREMES,
     OWN({BR_FOR_TABLES, .standard = "0.01,0.005,0.002,0.001,0.0005,0.0001", .more = divides},
         {BR_FOR_STUDY, .standard = "T/100,T/200,T/400,T/800", .more = divides},
         {BR_FOR_RUN, .standard = "T/1000", .argument = "TIME"})},
    {BR_OPT_STEPS, "steps", 0, "LIST", "numbers of time steps: 10,20 is --k T/10,T/20", NULL,
     BR_TAKES_COUNTS, .commands = BR_FOR_TABLES | BR_FOR_STUDY | BR_FOR_RUN | BR_FOR_TRADE,
     OWN({BR_FOR_RUN, .argument = "COUNT", .help = "number of time steps: 10 is --k T/10",
          .kind = BR_TAKES_NUMBER, .range = WHOLE(1, 1e12)})},
    {BR_OPT_REFERENCE, "reference", 0, "NAME",
     "the reference solution of the errors: exact, fine:N,K or mms", NULL, BR_TAKES_TEXT,
     .words = &br_reference_words, .commands = BR_FOR_TABLES | BR_FOR_STUDY | BR_FOR_TRADE,
     .more =
         "exact is the default; for a scene that was manufactured from a solution, it is mms. "
         "fine:N,K is a run of N elements and steps of K seconds (or T/100), whose own error is "
         "then measured against the exact solution.",
     OWN({BR_FOR_TABLES, .standard = "fine:12800,1e-5",
          .more = "The errors against the exact solution are shown, too."},
         {BR_FOR_TRADE, .more = "exact is the default; fine:N,K marches the scheme of the highest "
                                "order, and is not possible with a goal."})},
    {BR_OPT_NORM, "norm", 0, "LIST", "norms of the error", "l2", BR_TAKES_WORD_LIST,
     .words = &norm_words, .commands = BR_FOR_TABLES | BR_FOR_STUDY | BR_FOR_TRADE,
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
    {BR_OPT_ERROR, "error", 0, "E",
     "goal: the cheapest way to this relative error, like 1e-3 or 5%", NULL, BR_TAKES_TEXT,
     .commands = BR_FOR_TRADE,
     .more = "The norm of the error, divided by the norm of the solution. Without -n, -k, "
             "--steps, --tolerance and --methods all meshes, steps and time schemes are tried."},
    {BR_OPT_SECONDS, "seconds", 0, "S",
     "goal: the smallest error within so many seconds, set-up included", NULL, BR_TAKES_SECONDS,
     BETWEEN(0, INFINITY), .commands = BR_FOR_TRADE,
     .more = "One of --error and --seconds, for one scene."},
    {BR_OPT_TIME_LIMIT, "time-limit", 0, "SECONDS", "longest run or march, set-up included, s",
     "10", BR_TAKES_SECONDS, BETWEEN(0, 1e10), .commands = BR_FOR_TRADE,
     .more = "A run or march that will surely take longer is stopped early, and the report says "
             "so."},

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
    {BR_OPT_ALL, "all", 0, NULL, "all bundled scenes", NULL, BR_TAKES_FLAG,
     .commands = BR_FOR_CHECK | BR_FOR_TRADE,
     OWN({BR_FOR_TRADE, .help = "try all trials (default: what takes about 10 s a scene)",
          .more =
              "The most expensive trials are left out, unless -n, -k, --steps or --tolerance choose "
              "the trials."})},

    /* scenes */
    {BR_OPT_NEW, "new", 0, "FILE", "write a template with every key; - is standard output", NULL,
     BR_TAKES_FILE, .commands = BR_FOR_SCENES,
     .more =
         "A valid scene, with the meaning, unit and default of each key. An existing file is not "
         "replaced."},

    {BR_OPT_THREADS, "threads", 'j', "COUNT", "threads; 0: all cores", "0", BR_TAKES_NUMBER,
     WHOLE(0, 4096), .commands = BR_FOR_TRADE,
     .more = "Of the errors: trials, and programs, are timed one at a time."},

    /* another scene */
    {BR_OPT_SET, "set", 0, "KEY=VALUE",
     "a key of the scene gets another value, with its unit: 'contact.stiffness=2e3 N/m'", NULL,
     BR_TAKES_TEXT,
     .commands = BR_FOR_STUDY | BR_FOR_CHECK | BR_FOR_RUN | BR_FOR_TRADE | BR_FOR_EXTREMES,
     .more =
         "May be given several times. KEY is any key of the scene, with its section: length, "
         "friction.coefficient. A key that the scene does not have is added. VALUE is written as in "
         "the file. With several scenes, each gets it.",
     .repeats = true},
};
enum { ROWS = sizeof rows / sizeof *rows };

size_t br_beam_add_options(const struct br_command *command, struct br_option row[BR_OPTIONS],
                           size_t count)
{
    count = br_options_add(rows, ROWS, command, row, count);
    for (size_t i = 0; i < BR_METHOD_FIELDS && BR_FOR_MARCHES & command->bit; i++) {
        const struct br_method_field *f = &br_method_fields[i];
        if (!f->argument)
            continue;
        row[count++] = (struct br_option){.id = (enum br_option_id)(BR_OPT_METHOD + i),
                                          .name = f->name,
                                          .argument = f->argument,
                                          .help = f->help,
                                          .kind = BR_TAKES_METHOD,
                                          .words = f->words,
                                          .commands = BR_FOR_MARCHES,
                                          .more = f->more};
    }
    return count;
}

const char *br_beam_standard(const struct br_option *row, char text[BR_OPTION_TEXT])
{
    const struct br_method_field *f = &br_method_fields[row->id - BR_OPT_METHOD];
    const struct br_method usual = br_method_default();
    return f->standard ? f->standard : br_method_field_text(f, &usual, text);
}

/* --steps 10,20 is --k T/10,T/20. */
static enum br_status take_steps(struct br_options *o, struct br_error *err)
{
    enum { WIDTH = 24 };
    const size_t count = o->count[BR_OPT_STEPS];
    if (br_option_given(o, BR_OPT_K))
        return br_fail(err, BR_BAD_INPUT, "--k and --steps are given, expected one of the two");
    char *text = br_allocate(count, WIDTH);
    if (!text)
        return br_no_memory(err, "the options");
    for (size_t i = 0; i < count; i++)
        br_append(text, count * WIDTH, "%sT/%zu", i ? "," : "",
                  o->whole[BR_OPT_STEPS] ? o->whole[BR_OPT_STEPS][i]
                                         : (size_t)o->number[BR_OPT_STEPS][i]);
    o->given[BR_OPT_K] = o->text[BR_OPT_K] = text;
    return BR_OK;
}

enum br_status br_beam_check_options(struct br_options *o, struct br_error *err)
{
    if (br_option_given(o, BR_OPT_STEPS) && take_steps(o, err))
        return err->status;
    struct br_method method = br_method_default();
    return br_method_read(&o->given[BR_OPT_METHOD], BR_METHOD_OPTION, &method, err);
}
