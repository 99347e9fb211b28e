/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/option.h"

#include <errno.h>
#include <math.h>
#include <popt.h>
#include <stdlib.h>
#include <string.h>

#include "base/words.h"
#include "cli/command.h"

/* ---- what is refused ---- */

/* What other programs call an option: the name of an option here, and more to say of it. */
static const struct elsewhere {
    const char *word, *name, *more;
} elsewhere[] = {
    {"jobs", "cost", "runs are timed one at a time"},
    {"threads", "cost", "runs are timed one at a time"},
    {"dt", "k", ""},
    {"time-step", "k", ""},
    {"order", "expect",
     " It asks for a verdict on an order; --formal-order states that of values."},
    {"gci", "value", " It names the values that get a grid convergence index."},
    {"baseline", "compare", ""},
    {"output", "out", ""},
    {"plot", "out", " Pictures are among the results."},
    {"csv", "format", ""},
    {"html", "format", ""},
    {"latex", "format", ""},
    {"jobs", "threads", ""},
    {"steps", "k", " --k steps=LIST gives numbers of steps."},
    {"dofs", "n", " --n dofs=LIST gives numbers of unknowns."},
    {"level", "n", " --n level=LIST gives levels."},
};

struct rows {
    const struct br_option *row;
    size_t count;
};

static const struct br_option *find(const struct rows *rows, const char *name)
{
    for (size_t i = 0; i < rows->count; i++)
        if (strcmp(rows->row[i].name, name) == 0)
            return &rows->row[i];
    return NULL;
}

/* The name without its dashes and without a value. */
enum { WORD = 64 };
static bool long_name(const char *bad, char word[WORD])
{
    const char *begin = bad + strspn(bad, "-");
    snprintf(word, WORD, "%.*s", (int)strcspn(begin, "="), begin);
    return strncmp(bad, "--", 2) == 0;
}

/* The options whose names begin with a word: writes "--a or --b" (out, cut where it is full). */
static size_t beginning(const struct rows *rows, const char *word, const struct br_option **first,
                        char *text, size_t size)
{
    size_t found = 0;
    *text = '\0';
    for (size_t i = 0; i < rows->count; i++) {
        const struct br_option *row = &rows->row[i];
        if (!*word || strncmp(row->name, word, strlen(word)) != 0)
            continue;
        *first = found++ ? *first : row;
        br_append(text, size, "%s--%s", found > 1 ? " or " : "", row->name);
    }
    return found;
}

/* What stands behind "unknown option". */
static void suggest(const struct rows *rows, const char *word, char *text, size_t size)
{
    const char *names[BR_OPTIONS];
    const struct br_option *first;
    char all[512];
    *text = '\0';
    for (size_t i = 0; i < sizeof elsewhere / sizeof *elsewhere; i++)
        if (strcmp(elsewhere[i].word, word) == 0 && find(rows, elsewhere[i].name)) {
            const char *more = elsewhere[i].more; /* without a blank it is all that is said */
            const bool means = !*more || *more == ' ';
            br_append(text, size, "%s%s%s%s", means ? "did you mean --" : "",
                      means ? elsewhere[i].name : "", means ? "?" : "", more);
            return;
        }
    struct br_option theirs[BR_OPTIONS];
    for (const struct br_command *const *c = br_program.commands; *c; c++)
        if (find(&(struct rows){theirs, br_options_of(*c, theirs)}, word)) {
            br_append(text, size, "it is one of '%s %s'", br_program.name, (*c)->name);
            return;
        }
    for (size_t i = 0; i < rows->count; i++)
        names[i] = rows->row[i].name;
    const char *nearest = br_nearest(word, names, rows->count);
    if (beginning(rows, word, &first, all, sizeof all) > 1)
        br_append(text, size, "it may be %s", all);
    else if (nearest)
        br_append(text, size, "did you mean --%s?", nearest);
}

static enum br_status refuse(poptContext context, const struct rows *rows, int code,
                             struct br_error *err)
{
    char word[WORD], hint[640] = "";
    const char *bad = poptBadOption(context, POPT_BADOPTION_NOALIAS);
    if (code == POPT_ERROR_BADOPT && long_name(bad, word))
        suggest(rows, word, hint, sizeof hint);
    return br_fail(err, BR_BAD_INPUT, "%s: %s; %s", bad, poptStrerror(code),
                   *hint ? hint : "'--help' lists the options");
}

/* An option may be cut short where no other one begins so: gives popt the whole name. */
static bool complete(poptContext context, const struct rows *rows, int code)
{
    char word[WORD], all[512], *whole = NULL;
    const struct br_option *row;
    const char *bad =
        code == POPT_ERROR_BADOPT ? poptBadOption(context, POPT_BADOPTION_NOALIAS) : "";
    if (!long_name(bad, word) || beginning(rows, word, &row, all, sizeof all) != 1 ||
        asprintf(&whole, "--%s%s", row->name, bad + strcspn(bad, "=")) < 0)
        return false;
    const bool taken = poptStuffArgs(context, (const char *[]){whole, NULL}) == 0;
    free(whole);
    return taken;
}

/* ---- times ---- */

const char *br_read_time(const char *text, double duration, double *seconds)
{
    static const struct {
        const char *name;
        double seconds;
    } unit[] = {{"s", 1}, {"ms", 1e-3}, {"us", 1e-6}, {"min", 60}, {"h", 3600}};
    const char *rest = text + strspn(text, " ");
    if (*rest == 'T') {
        double parts = 1;
        if (*++rest == '/')
            rest = br_read_number(rest + 1, &parts);
        *seconds = duration / parts;
        if (!rest || !(parts > 0))
            return NULL;
    } else {
        rest = br_read_number(rest, seconds);
        if (!rest)
            return NULL;
        rest += strspn(rest, " ");
        for (size_t i = 0; i < sizeof unit / sizeof *unit; i++) {
            const size_t length = strlen(unit[i].name);
            if (strncmp(rest, unit[i].name, length) != 0)
                continue;
            rest += length;
            *seconds *= unit[i].seconds;
            break;
        }
    }
    rest += strspn(rest, " ");
    return *rest == '\0' || *rest == ',' ? rest : NULL;
}

enum br_status br_times_check(const char *text, struct br_error *err)
{
    bool bare = false, scaled = false;
    double seconds, number;
    const char *end;
    for (const char *rest = text; rest && (end = br_read_time(rest, 1, &seconds)); rest = end) {
        const char *unit = br_read_number(rest + strspn(rest, " "), &number);
        bare |= unit && number != 0 && unit + strspn(unit, " ") == end;
        scaled |= unit && number != seconds;
        end = *end ? end + 1 : NULL;
    }
    return bare && scaled ? br_fail(err, BR_BAD_INPUT,
                                    "found '%s', expected a unit with each time or none", text)
                          : BR_OK;
}

static enum br_status check_times(const struct br_option *row, const char *text,
                                  struct br_error *err)
{
    const bool one = strcmp(row->argument, "LIST") != 0;
    if (br_times_check(text, err))
        return err->status;
    for (const char *rest = text;; rest++) {
        double seconds;
        const char *end = br_read_time(rest, 1, &seconds);
        if (!end || !(seconds > 0) || (one && *end))
            return br_fail(err, BR_BAD_INPUT, "found '%s', expected %s", rest,
                           one ? "one time above 0, like 1e-3, 1 ms or T/1000"
                               : "times above 0 separated by commas, like 0.1,T/20");
        rest = end;
        if (!*rest)
            return BR_OK;
    }
}

/* ---- values ---- */

static enum br_status read_words(struct br_options *o, const struct br_option *row,
                                 const char *text, struct br_error *err)
{
    double *number = o->number[row->id] = br_allocate(strlen(text) + 1, sizeof *number);
    if (!number)
        return br_no_memory(err, "the options");
    for (const char *rest = text;; rest++) {
        size_t found;
        const size_t length = row->kind == BR_TAKES_WORD ? strlen(rest) : strcspn(rest, ",");
        const enum br_status status = br_words_read(row->words, rest, length, &found, err);
        if (status)
            return status;
        for (size_t i = 0; i < o->count[row->id]; i++)
            if (number[i] == (double)found)
                return br_fail(err, BR_BAD_INPUT, "%s is given twice", row->words->name(found));
        number[o->count[row->id]++] = (double)found;
        rest += length;
        if (!*rest)
            return BR_OK;
    }
}

static enum br_status read_numbers(struct br_options *o, const struct br_option *row,
                                   const char *name, struct br_error *err)
{
    double **number = &o->number[row->id];
    if (br_read_numbers(name, o->text[row->id], number, &o->count[row->id], err))
        return err->status;
    for (size_t i = 0; i < o->count[row->id]; i++)
        if (!((*number)[i] > row->range.low && (*number)[i] < row->range.high))
            return br_fail(err, BR_BAD_INPUT,
                           "%s: found %g, expected numbers above %g and below %g", name,
                           (*number)[i], row->range.low, row->range.high);
    return BR_OK;
}

static enum br_status read_value(struct br_options *o, const struct br_option *row,
                                 struct br_error *err)
{
    const char *text = o->text[row->id];
    double **number = &o->number[row->id];
    size_t *count = &o->count[row->id];
    char name[64];
    struct br_error inner = {0};
    snprintf(name, sizeof name, "--%s", row->name);
    if (!text)
        return BR_OK;
    if (row->kind == BR_TAKES_COUNTS)
        return br_read_counts(name, text, &o->whole[row->id], count, err);
    if (row->kind == BR_TAKES_NUMBERS)
        return read_numbers(o, row, name, err);
    if (row->kind == BR_TAKES_TIMES)
        check_times(row, text, &inner);
    else if (row->kind == BR_TAKES_WORD || row->kind == BR_TAKES_WORD_LIST)
        read_words(o, row, text, &inner);
    else if (row->kind == BR_TAKES_NUMBER || row->kind == BR_TAKES_SECONDS) {
        double seconds;
        char plain[40];
        const char *end = row->kind == BR_TAKES_SECONDS ? br_read_time(text, NAN, &seconds) : NULL;
        const bool is_time = end && !*end && isfinite(seconds);
        *number = br_allocate(1, sizeof **number);
        *count = *number ? 1 : 0;
        if (!*number)
            br_no_memory(&inner, "the options");
        else
            br_read_in_range(is_time ? br_shortest(seconds, plain, sizeof plain) : text,
                             &row->range, *number, &inner);
    }
    return inner.status ? br_fail(err, inner.status, "%s: %s", name, inner.message) : BR_OK;
}

static enum br_status read_values(struct br_options *o, const struct br_option *row, size_t count,
                                  struct br_error *err)
{
    for (size_t i = 0; i < count; i++) {
        if (!o->text[row[i].id])
            o->text[row[i].id] = row[i].standard;
        if (read_value(o, &row[i], err))
            return err->status;
    }
    return br_program.beam ? br_program.beam->check_options(o, err) : BR_OK;
}

/* ---- the command line ---- */

/* An option with a value that is given twice is refused: one value would be lost. */
static enum br_status take(poptContext context, struct br_options *o, const struct br_option *row,
                           struct br_error *err)
{
    char *text = row->kind == BR_TAKES_FLAG ? strdup("") : poptGetOptArg(context);
    const bool twice = o->given[row->id] && row->kind != BR_TAKES_FLAG && !row->repeats;
    if (text && row->repeats && o->given[row->id]) {
        char *both = NULL;
        const bool joined = asprintf(&both, "%s\n%s", o->given[row->id], text) >= 0;
        free(text);
        text = joined ? both : NULL;
    }
    if (!text)
        return br_no_memory(err, "the options");
    free((char *)o->given[row->id]);
    o->given[row->id] = o->text[row->id] = text;
    return twice ? br_fail(err, BR_BAD_INPUT, "--%s is given twice", row->name) : BR_OK;
}

static enum br_status read_rest(poptContext context, struct br_options *o, struct br_error *err)
{
    const struct br_command *c = o->command;
    const char **word = poptGetArgs(context);
    size_t given = 0;
    while (word && word[given])
        given++;
    if (given < c->least_words)
        return br_fail(err, BR_BAD_INPUT, "no %s is given, expected %s",
                       c->words ? "word" : "scene",
                       c->words            ? c->arguments
                       : c->most_words > 1 ? "files or names of bundled scenes"
                                           : "a file or the name of a bundled scene");
    if (given > c->most_words && c->most_words == 1 && !c->words)
        return br_fail(err, BR_BAD_INPUT, "one %s at a time; '%s' is a second one",
                       c->bit == BR_FOR_ORDERS ? "table" : "scene", word[1]);
    if (given > c->most_words)
        return br_fail(err, BR_BAD_INPUT, "found '%s', expected nothing more", word[c->most_words]);
    if (!(o->word = br_allocate(given + 1, sizeof *o->word)))
        return br_no_memory(err, "the options");
    for (; o->words < given; o->words++) {
        size_t row;
        const char *text = word[o->words];
        if (c->words && !c->or_scenes && br_words_read(c->words, text, strlen(text), &row, err))
            return err->status;
        if (!(o->word[o->words] = strdup(text)))
            return br_no_memory(err, "the options");
    }
    return BR_OK;
}

static enum br_status read_all(poptContext context, struct br_options *o, const struct rows *rows,
                               struct br_error *err)
{
    int code;
    while ((code = poptGetNextOpt(context)) > 0 || complete(context, rows, code)) {
        if (code < 0)
            continue;
        const struct br_option *row = &rows->row[code - 1];
        const enum br_status status = take(context, o, row, err);
        if (status || row->id == BR_OPT_HELP)
            return status;
    }
    if (code < -1)
        return refuse(context, rows, code, err);
    return read_values(o, rows->row, rows->count, err) ? err->status : read_rest(context, o, err);
}

enum br_status br_options_parse(int argc, const char **argv, const struct br_command *command,
                                struct br_options *o, struct br_error *err)
{
    struct br_option row[BR_OPTIONS];
    struct poptOption table[BR_OPTIONS + 1] = {POPT_TABLEEND};
    *o = (struct br_options){.command = command};
    const size_t count = br_options_of(command, row);
    for (size_t i = 0; i < count; i++)
        table[i] = (struct poptOption){.longName = row[i].name,
                                       .shortName = row[i].letter,
                                       .argInfo = row[i].kind == BR_TAKES_FLAG ? POPT_ARG_NONE
                                                                               : POPT_ARG_STRING,
                                       .val = (int)i + 1};
    errno = 0;
    poptContext context = poptGetContext(br_program.name, argc, argv, table, 0);
    enum br_status status = BR_OK;
    if (context && errno != ENOMEM) /* without memory popt forgets words */
        status = read_all(context, o, &(struct rows){row, count}, err);
    if (!context || errno == ENOMEM)
        status = br_no_memory(err, "the options");
    poptFreeContext(context);
    return status;
}

void br_options_clear(struct br_options *o)
{
    for (size_t i = 0; i < BR_OPTIONS; i++) {
        free((char *)o->given[i]);
        free(o->number[i]);
        free(o->whole[i]);
    }
    for (size_t i = 0; o->word && i < o->words; i++)
        free(o->word[i]);
    free(o->word);
    *o = (struct br_options){0};
}

bool br_option_given(const struct br_options *o, enum br_option_id id)
{
    return o->given[id];
}

const char *br_first_given(const struct br_options *o, const enum br_option_id *list)
{
    while (*list != BR_OPTIONS && !o->given[*list])
        list++;
    if (*list == BR_OPTIONS)
        return NULL;
    struct br_option row[BR_OPTIONS];
    size_t i = 0;
    for (br_options_of(o->command, row); row[i].id != *list;)
        i++;
    return row[i].name;
}

const char *br_option_text(const struct br_options *o, enum br_option_id id)
{
    return o->text[id];
}

double br_option_number(const struct br_options *o, enum br_option_id id, double otherwise)
{
    return o->count[id] ? o->number[id][0] : otherwise;
}
