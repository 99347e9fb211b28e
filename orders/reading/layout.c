/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The layout of a table, by measure. Each way to separate fields, with each mark of decimals,
 * splits the lines; the one whose rows of the commonest width have most numbers, and fewest words,
 * is taken. The rows are the lines of this width whose numbers stand in the columns of numbers. The
 * heading is the line above them, or the comment there. All else is named in fields->left, or
 * refused: what stands between rows, or has numbers that are no row, may be a second table. */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "base/words.h"
#include "orders/reading/lines.h"
#include "orders/reading/roles.h"

/* A line, split as the table is. */
struct row {
    struct br_token *token;
    size_t count;          /* of tokens */
    size_t numbers, words; /* of tokens that are neither missing nor empty */
    bool is_row, is_used;
};

enum { WIDEST = BR_MOST_COLUMNS + 3 /* tokens */, SAMPLE = 100 /* lines at each end */ };

struct layout {
    const char *path;
    const struct br_observer *observer;
    struct br_error *err;
    struct br_fields *fields;
    struct br_line *line;
    struct row *row; /* by line */
    size_t lines;
    char *room; /* for the longest line */
    enum br_separator by;
    size_t width, rows;
    size_t first, last;            /* rows, as lines */
    struct br_token token[WIDEST]; /* of the last line that was split */
    long gain[WIDEST];             /* by width: how well it explains the lines */
    size_t like[WIDEST];           /* by width: lines with a number */
    size_t names[WIDEST];          /* by width: lines without a number */
    bool skipped[WIDEST];          /* by column: the heading has no name of it */
    size_t has_number[WIDEST];     /* by column: the rows that have one there, or a missing one */
};

/* ---- the way to separate fields ---- */

/* Splits a line into l->token. Empty tokens behind the width are none. */
static struct row look_at(struct layout *l, size_t line, char *room)
{
    struct row r = {.token = l->token};
    r.count = br_line_split(l->line[line].text, l->by, l->fields->mark, room, l->token);
    while (l->width && r.count > l->width && l->token[r.count - 1].content == BR_NOTHING)
        r.count--;
    for (size_t i = 0; i < r.count; i++) {
        r.numbers += l->token[i].content == BR_NUMBER;
        r.words += l->token[i].content >= BR_WORD;
    }
    return r;
}

/* How well this way explains the lines; l->width (out): the commonest. A number counts three, and a
 * word costs one. Each line counts with and without its empty tokens at the end; a heading decides
 * between the two. */
static long measure(struct layout *l)
{
    memset(l->gain, 0, sizeof l->gain);
    memset(l->names, 0, sizeof l->names);
    memset(l->like, 0, sizeof l->like);
    l->width = 0;
    for (size_t i = 0; i < l->lines; i++) {
        if (i == SAMPLE && l->lines > 2 * SAMPLE)
            i = l->lines - SAMPLE;
        if (l->line[i].kind != BR_LINE_TEXT)
            continue;
        const struct row r = look_at(l, i, l->room);
        const bool is_lone = l->by == BR_BY_WORDS && r.count < 2;
        const long more = r.numbers && !is_lone ? 3 * (long)r.numbers - (long)r.words : 0;
        size_t filled = r.count;
        while (filled > 1 && l->token[filled - 1].content == BR_NOTHING)
            filled--;
        l->gain[r.count] += more;
        l->gain[filled] += filled < r.count ? more : 0;
        l->names[r.count] += !r.numbers;
        l->like[r.count] += more > 0;
    }
    size_t best = 1;
    for (size_t i = 1; i < WIDEST; i++)
        best = l->gain[i] > l->gain[best] ||
                       (l->gain[i] == l->gain[best] && l->names[i] > l->names[best])
                   ? i
                   : best;
    l->width = best;
    return l->gain[best];
}

/* Whether all rows, by words, have the names of the first one: "dt 0.25  error 0.078". */
static bool have_names(struct layout *l)
{
    const struct br_token *first = NULL;
    size_t rows = 0;
    for (size_t i = 0; i < l->lines; i++) {
        char *room =
            first ? l->room : br_store_take(&l->fields->store, BR_ROOM(l->line[i].text), 1);
        if (l->line[i].kind != BR_LINE_TEXT || !room || look_at(l, i, room).count != l->width)
            continue;
        for (size_t c = 0; c < l->width && first; c++)
            if (strcmp(first[c].name, l->token[c].name) != 0)
                return false;
        struct br_token *const copy =
            first ? NULL : br_store_take(&l->fields->store, l->width, sizeof *copy);
        if (copy)
            first = memcpy(copy, l->token, l->width * sizeof *copy);
        rows++;
    }
    return l->width > 1 && rows > 1 && rows == l->like[l->width];
}

/* Chooses the way. Where none has numbers, the first line tells the widest. Refuses lines that are
 * too wide, before anything takes time. */
static enum br_status choose(struct layout *l, size_t first)
{
    long most = 0;
    size_t widest = 0, width = 0, rows = 0;
    int best = 0;
    for (int i = 2 * BR_BY_EQUALS; i < 2 * BR_SEPARATORS; i++) {
        l->by = (enum br_separator)(i / 2);
        l->fields->mark = ".,"[i % 2];
        const long score = measure(l);
        if (score > most && (i % 2 == 0 || l->width > 1)) {
            most = score;
            best = i;
            width = l->width;
            rows = l->like[width];
        }
        const size_t count = l->by < BR_BY_TABS ? 0 : look_at(l, first, l->room).count;
        widest = count > widest ? count : widest;
    }
    l->by = BR_BY_WORDS;
    l->fields->mark = '.';
    if (measure(l) > most &&
        (rows < 2 ? !rows || l->like[l->width] > 1 : l->like[l->width] == rows && have_names(l))) {
        width = l->width;
    } else {
        l->by = (enum br_separator)(best / 2);
        l->fields->mark = ".,"[best % 2];
    }
    l->width = l->fields->columns = width;
    const bool wide = width > BR_MOST_COLUMNS || (!width && widest > BR_MOST_COLUMNS);
    return width && !wide
               ? BR_OK
               : br_fail(l->err, BR_BAD_INPUT, "%s:%zu: found %s", l->path, l->line[first].number,
                         wide ? "more than 1000 columns, expected fewer" : "no row of numbers");
}

/* ---- rows ---- */

/* A line beside pairs: with its first number alone, as "N = 128: diverged in step 3". */
static struct row look_at_sentence(struct layout *l, size_t line, char *room)
{
    const enum br_separator by = l->by;
    l->by = BR_BY_WORDS;
    struct row r = look_at(l, line, room);
    l->by = by;
    r.count = r.count > 0;
    r.numbers = r.words = 0;
    return r;
}

/* Splits all lines, and counts the numbers of columns. */
static enum br_status split_lines(struct layout *l)
{
    struct br_store *store = &l->fields->store;
    for (size_t i = 0; i < l->lines; i++) {
        if (l->line[i].kind != BR_LINE_TEXT)
            continue;
        if (br_observer_check(l->observer, l->err))
            return l->err->status;
        char *room = br_store_take(store, BR_ROOM(l->line[i].text), 1);
        if (!room)
            return br_no_memory(l->err, "the table");
        struct row *r = &l->row[i];
        *r = look_at(l, i, room);
        if (!r->count && l->by <= BR_BY_COLONS)
            *r = look_at_sentence(l, i, room);
        r->token = br_store_take(store, r->count + 1, sizeof *r->token);
        if (!r->token)
            return br_no_memory(l->err, "the table");
        memcpy(r->token, l->token, r->count * sizeof *r->token);
        if (r->count != l->width || !r->numbers)
            continue;
        if (++l->rows > BR_MOST_TABLE_ROWS)
            return br_fail(l->err, BR_BAD_INPUT, "%s:%zu: found row %zu, expected at most %d",
                           l->path, l->line[i].number, l->rows, BR_MOST_TABLE_ROWS);
        if (l->rows * l->width > BR_MOST_FIELDS)
            return br_fail(l->err, BR_BAD_INPUT,
                           "%s:%zu: found row %zu of %zu fields, expected at most %d fields in all",
                           l->path, l->line[i].number, l->rows, l->width, BR_MOST_FIELDS);
        for (size_t c = 0; c < l->width; c++)
            l->has_number[c] +=
                r->token[c].content == BR_NUMBER || r->token[c].content == BR_MISSING;
    }
    return BR_OK;
}

/* Whether a line has numbers in half of the columns of numbers, or nothing at all. */
static bool is_like_rows(const struct layout *l, const struct row *r)
{
    size_t all = 0, there = 0;
    for (size_t c = 0; c < l->width && r->count == l->width; c++) {
        all += 2 * l->has_number[c] > l->rows;
        there += 2 * l->has_number[c] > l->rows && r->token[c].content < BR_WORD;
    }
    return r->count == l->width && 2 * there >= all && (r->numbers || !r->words);
}

static enum br_status find_rows(struct layout *l)
{
    if (split_lines(l))
        return l->err->status;
    l->first = l->lines;
    for (size_t i = 0; i < l->lines; i++) {
        l->row[i].is_row = l->line[i].kind == BR_LINE_TEXT && is_like_rows(l, &l->row[i]);
        l->first = l->row[i].is_row && l->first == l->lines ? i : l->first;
        l->last = l->row[i].is_row ? i : l->last;
    }
    return l->first < l->lines
               ? BR_OK
               : br_fail(l->err, BR_BAD_INPUT, "%s:1: found no row of numbers", l->path);
}

/* Whether the first word of a row is one of means, where others have a number. */
static bool is_summary(const struct row *r)
{
    static const char *const words[] = {"mean",  "average", "avg", "overall", "slope",
                                        "order", "eoc",     "fit", "total",   "median",
                                        "min",   "max",     "std", "rate"};
    const char *const text = r->count ? r->token->text + strspn(r->token->text, "*_ ") : "";
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (strncasecmp(text, words[i], strlen(words[i])) == 0)
            return true;
    return false;
}

/* The next line of text above (step -1) or below one; l->lines: there is none. */
static size_t next_text(const struct layout *l, size_t line, int step)
{
    do
        line += (size_t)step;
    while (line < l->lines && l->line[line].kind != BR_LINE_TEXT);
    return line < l->lines ? line : l->lines;
}

static bool is_short(const struct layout *l, size_t line)
{
    const struct row *r = &l->row[line];
    return line < l->lines && l->by > BR_BY_COLONS && r->count < l->width && r->count > 1 &&
           r->numbers && !r->words;
}

static bool is_taken(const struct layout *l, size_t line)
{
    return line >= l->first && line <= l->last && (l->row[line].is_row || is_short(l, line));
}

/* Whether a row has a word where others have a number. */
static bool has_other_words(const struct layout *l, size_t line)
{
    bool words = false;
    for (size_t i = 0; i < l->width; i++)
        words |= l->has_number[i] > 1 && l->row[line].token[i].content >= BR_WORD;
    return words;
}

/* Finds the ends of the table: without titles and rows of means; with a first or last row that is
 * short. */
static void find_ends(struct layout *l)
{
    while (l->first < l->last && !l->row[next_text(l, l->first, 1)].is_row &&
           has_other_words(l, l->first)) {
        l->row[l->first].is_row = false;
        while (!l->row[l->first].is_row)
            l->first = next_text(l, l->first, 1);
    }
    while (l->last > l->first && l->has_number[0] && is_summary(&l->row[l->last]))
        for (l->row[l->last].is_row = false; !l->row[l->last].is_row;)
            l->last = next_text(l, l->last, -1);
    const size_t above = next_text(l, l->first, -1), below = next_text(l, l->last, 1);
    l->first = is_short(l, above) ? above : l->first;
    l->last = is_short(l, below) ? below : l->last;
}

static enum br_status refuse_row(const struct layout *l, size_t line, const char *like)
{
    return br_fail(l->err, BR_BAD_INPUT, "%s:%zu: found %s than the %zu fields of the %s", l->path,
                   l->line[line].number, l->row[line].count > l->width ? "more" : "fewer", l->width,
                   like);
}

/* Whether two columns rise or fall through all rows: they are one sequence, whatever stands between
 * them. */
static bool is_sequence(const struct layout *l)
{
    size_t columns = 0, rows = 0;
    for (size_t c = 0; c < l->width; c++, rows = 0) {
        struct br_field_number number, before = {0};
        size_t up = 0, down = 0, read = 0;
        for (size_t i = l->first; i <= l->last; i++) {
            const struct row *r = &l->row[i];
            rows += r->is_row;
            if (!r->is_row || !br_field_read(r->token[c].text, l->fields->mark, &number))
                continue;
            up += read && number.value > before.value;
            down += read && number.value < before.value;
            before = number;
            read++;
        }
        columns += read > 2 && read + 1 >= rows && (up + 1 == read || down + 1 == read);
    }
    return columns > 1;
}

static bool read_size(const struct layout *l, size_t line, size_t column, double *value)
{
    char text[64];
    struct br_field_number number = {0};
    const bool is_there = column < l->row[line].count;
    const char *const field = is_there ? l->row[line].token[column].text : "";
    snprintf(text, sizeof text, "%s", strchr(field, '=') ? strchr(field, '=') + 1 : field);
    const size_t length = strlen(text);
    text[length - (length && text[length - 1] == ':')] = '\0'; /* "128: out of memory" */
    const bool reads = br_field_read(text, l->fields->mark, &number);
    *value = number.value;
    return reads;
}

/* Whether a name is another one, or ends with it as a word: "Run N". */
static bool ends_with(const char *name, const char *word)
{
    const size_t all = strlen(name), size = strlen(word);
    return all >= size && strcmp(name + all - size, word) == 0 &&
           (all == size || name[all - size - 1] == ' ');
}

/* Whether a line that is no row has a size that the rows do not have, as where a run failed: the
 * first name of pairs again, or behind the rows the next number of their first column of numbers.
 */
static bool is_failed_run(const struct layout *l, size_t line)
{
    const struct row *r = &l->row[line];
    const bool pairs = l->by <= BR_BY_COLONS;
    size_t column = 0;
    double first, last, next, row;
    while (!pairs && column + 1 < l->width && l->has_number[column] < l->rows)
        column++;
    if (!read_size(l, line, column, &next) || !(next > 0) || is_summary(r) ||
        (pairs && !ends_with(r->token->name, l->row[l->first].token->name)))
        return false;
    for (size_t i = l->first; i <= l->last; i++)
        if (l->row[i].is_row && read_size(l, i, column, &row) && row == next)
            return false;
    return pairs || (line > l->last && read_size(l, l->first, column, &first) &&
                     read_size(l, l->last, column, &last) && (last - first) * (next - last) > 0);
}

/* Refuses what is no row between rows, but text in a sequence, and rows beside them that are
 * others. */
static enum br_status check_one_table(const struct layout *l)
{
    size_t before = l->first, others = 0;
    const bool sequence = is_sequence(l);
    for (size_t i = 0; i < l->lines; i++) {
        const struct row *r = &l->row[i];
        const bool inside = i >= l->first && i <= l->last;
        if (l->line[i].kind != BR_LINE_TEXT || is_taken(l, i)) {
            before = is_taken(l, i) ? i : before;
            continue;
        }
        const bool is_data =
            (r->numbers > 1 || i > l->last) && r->numbers > r->words && l->by > BR_BY_COLONS;
        if (r->count != l->width && is_data && !(r->words && !inside))
            return refuse_row(l, i, l->fields->heading_line ? "heading" : "first row");
        if (is_failed_run(l, i))
            return br_fail(l->err, BR_BAD_INPUT,
                           "%s:%zu: found '%.40s', expected a row of %zu fields: write nan for a "
                           "number that is missing, or # before a line that is no row",
                           l->path, l->line[i].number, l->line[i].text, l->width);
        others += is_data;
        if ((inside && !(sequence && r->numbers <= r->words)) || others > 1)
            return br_fail(l->err, BR_BAD_INPUT,
                           "%s:%zu: found '%.40s' between or beside the rows of lines %zu to %zu, "
                           "expected one table",
                           l->path, l->line[i].number, l->line[i].text, l->line[l->first].number,
                           l->line[inside ? before : l->last].number);
    }
    return BR_OK;
}

static bool is_rate(const char *name)
{
    const enum br_kind kind = br_kind_of(name);
    return kind == BR_KIND_RATE || kind == BR_KIND_FACTOR;
}

/* Whether a row has the size of the first one again: a number that the second row does not have,
 * beside the same words. */
static bool begins_again(const struct layout *l, size_t line)
{
    bool again = false;
    const struct row *first = &l->row[l->first], *next = &l->row[next_text(l, l->first, 1)];
    for (size_t i = 0; i < l->width; i++) {
        const char *const text = first->token[i].text;
        const bool is_same = strcmp(text, l->row[line].token[i].text) == 0;
        if (2 * l->has_number[i] <= l->rows && !is_same)
            return false;
        again |= is_same && !br_field_is_missing(text) && !is_rate(l->fields->heading[i]) &&
                 (i >= next->count || strcmp(text, next->token[i].text) != 0);
    }
    return again;
}

/* Refuses rows that begin again behind a gap or a rule: a table of its own. */
static enum br_status check_blocks(const struct layout *l)
{
    for (size_t i = l->first + 1; i <= l->last && l->row[l->first].count == l->width; i++)
        if (l->row[i].is_row && l->line[i].number > l->line[next_text(l, i, -1)].number + 1 &&
            begins_again(l, i))
            return br_fail(l->err, BR_BAD_INPUT,
                           "%s:%zu: the rows begin again as on line %zu, expected one table",
                           l->path, l->line[i].number, l->line[l->first].number);
    return BR_OK;
}

/* ---- the heading ---- */

/* Whether the first column counts the rows or has words, as an index in front of them. */
static bool has_index(const struct layout *l)
{
    struct br_field_number one, two;
    const size_t next = next_text(l, l->first, 1);
    if (next > l->last || l->width < 2)
        return false;
    const char *const text = l->row[l->first].token->text;
    if (!br_field_read(text, '.', &one))
        return !br_field_is_missing(text);
    return (one.value == 0 || one.value == 1) &&
           (!br_field_read(l->row[next].token->text, '.', &two) || two.value == one.value + 1);
}

/* Which columns begin with a gap, as those of rates do (l->skipped); returns how many. */
static size_t find_gaps(struct layout *l)
{
    const struct row *r = &l->row[l->first];
    size_t gaps = 0;
    for (size_t i = 0; i < l->width; i++) {
        l->skipped[i] = i >= r->count || r->token[i].content == BR_NOTHING ||
                        (r->token[i].content == BR_MISSING && *r->token[i].text == '-');
        gaps += l->skipped[i];
    }
    return r->count == l->width || l->rows > 1 ? gaps : 0;
}

/* Splits a line in the way of the rows or another one, so that it has `wanted` tokens (l->token).
 */
static bool split_names(struct layout *l, size_t line, size_t wanted)
{
    const char *const text = l->line[line].text;
    char *room = br_store_take(&l->fields->store, BR_ROOM(text), 1);
    for (int i = BR_BY_TABS - 1; room && i < BR_SEPARATORS; i++) {
        const enum br_separator by = i < BR_BY_TABS ? l->by : (enum br_separator)i;
        size_t count = br_line_split(text, by, '.', room, l->token);
        while (count > wanted && l->token[count - 1].content == BR_NOTHING)
            count--;
        if (count == wanted)
            return true;
    }
    return false;
}

/* A name without the stars and quotes of Markdown around it, and without gnuplot's "1:", in place;
 * NULL: it is empty. */
static const char *plain_name(char *name, size_t column)
{
    char counted[24];
    snprintf(counted, sizeof counted, "%zu:", column + 1);
    if (strncmp(name, counted, strlen(counted)) == 0 && name[strlen(counted)])
        name += strlen(counted);
    name += strspn(name, "*`");
    size_t length = strlen(name);
    while (length && strchr("*`", name[length - 1]))
        name[--length] = '\0';
    return length ? name : NULL;
}

/* Whether a line names all columns but those that are skipped; then takes it. */
static bool take_names(struct layout *l, size_t line)
{
    size_t wanted = 0, used = 0;
    for (size_t i = 0; i < l->width; i++)
        wanted += !l->skipped[i];
    if (!wanted || !split_names(l, line, wanted))
        return false;
    for (size_t i = 0; i < wanted && l->line[line].kind == BR_LINE_COMMENT; i++) {
        const size_t length = strlen(l->token[i].text);
        if (l->token[i].content == BR_NUMBER || (length && l->token[i].text[length - 1] == ':'))
            return false;
    }
    for (size_t i = 0; i < l->width; i++)
        l->fields->heading[i] = l->skipped[i] ? NULL : plain_name(l->token[used++].text, i);
    l->fields->heading_line = l->line[line].number;
    return l->row[line].is_used = true;
}

/* Whether the words of a line above aligned columns name them, "L2 error" as well; then takes it.
 * Rates have no names there, as their columns begin with a gap. */
static bool take_names_above(struct layout *l, size_t line)
{
    struct br_store *store = &l->fields->store;
    const struct br_line *heading = &l->line[line];
    const char **name = l->fields->heading;
    struct br_span *span = br_store_take(store, l->width, sizeof *span);
    char *room = br_store_take(store, BR_ROOM(heading->text), 1);
    bool named = l->by >= BR_BY_WIDE_BLANKS && span && room && strstr(heading->text, "  ") &&
                 !l->row[line].numbers;
    for (size_t i = l->first; named && i <= l->last; i++)
        named = !l->row[i].is_row || br_spans_widen(span, l->width, &l->line[i]);
    const size_t gaps = find_gaps(l);
    named = named && br_names_above(heading, span, l->skipped, l->width, room, name);
    for (size_t i = 0; i < l->width && gaps; i++)
        named &= !name[i] || !is_rate(name[i]);
    l->fields->heading_line = named ? heading->number : 0;
    if (!named) {
        memset(l->skipped, 0, sizeof l->skipped);
        memset(name, 0, l->width * sizeof *name);
    }
    return l->row[line].is_used = named;
}

/* Whether the line above the rows names all columns but an index or rates; then takes it. Pandas
 * has the name of an index alone below the others. */
static bool take_short_heading(struct layout *l, size_t above)
{
    const struct row *r = &l->row[above];
    if (find_gaps(l) && take_names(l, above))
        return true;
    memset(l->skipped, 0, sizeof l->skipped);
    const size_t title = next_text(l, above, -1);
    const bool is_index = l->by >= BR_BY_WIDE_BLANKS && r->count == 1 && !r->numbers &&
                          title < l->lines && !l->row[title].numbers;
    l->skipped[0] = true;
    bool found = has_index(l) && take_names(l, above);
    if (!found && is_index && take_names(l, title)) {
        l->fields->heading[0] = r->token->text;
        found = l->row[above].is_used = true;
    }
    l->skipped[0] = false;
    return found;
}

/* Of names that repeat, "N error EOC error EOC": how many are in each of the groups; 0: none. */
static size_t period_of(const struct layout *l, size_t groups)
{
    const char *const *name = l->fields->heading;
    for (size_t p = groups > 1 ? l->width / groups : 0; p > 0; p--) {
        bool repeats = true;
        for (size_t i = l->width - p * groups; i + p < l->width && repeats; i++)
            repeats = name[i] && name[i + p] && strcmp(name[i], name[i + p]) == 0;
        if (repeats)
            return p;
    }
    return 0;
}

/* How many columns a token stands above, as LaTeX has it; the token (out) becomes its text. */
static size_t columns_of(char **text)
{
    size_t columns = 1;
    int from = 0;
    char *const at = strstr(*text, "\\multicolumn{");
    if (!at || sscanf(at, "\\multicolumn{%4zu}{%*[^}]}{%n", &columns, &from) < 1 || !from)
        return 1;
    *text = at + from;
    (*text)[strcspn(*text, "}")] = '\0';
    return columns;
}

/* Finds the group of each column (out; NULL: none) in a line above the heading. */
static bool find_groups(const struct layout *l, size_t line, const char **group)
{
    const struct row *r = &l->row[line];
    const size_t period = period_of(l, r->count);
    size_t column = 0;
    if (period && !r->numbers) {
        for (size_t i = 0; i < r->count * period; i++)
            group[l->width - r->count * period + i] = r->token[i / period].text;
        return true;
    }
    for (size_t i = 0; i < r->count && column < l->width; i++) {
        char *text = r->token[i].text;
        const size_t columns = columns_of(&text);
        for (size_t j = 0; j < columns && column < l->width; j++, column++)
            group[column] = *text ? text : column ? group[column - 1] : NULL;
    }
    return column == l->width;
}

/* Whether the names need those of the line above: two are the same, or all are units. */
static bool lack_groups(const struct layout *l)
{
    const char *const *name = l->fields->heading;
    bool units = true, same = false;
    for (size_t i = 0; i < l->width; i++) {
        units &= name[i] && strchr("[(", *name[i]);
        for (size_t j = 0; j < i && l->width < 100; j++)
            same |= name[i] && name[j] && strcmp(name[i], name[j]) == 0;
    }
    return units || same;
}

/* Puts a line of groups before the names below it: rho, and error, EOC. */
static enum br_status join_groups(struct layout *l, size_t line)
{
    const char **name = l->fields->heading;
    if (!lack_groups(l))
        return BR_OK;
    const char **group = br_store_take(&l->fields->store, l->width, sizeof *group);
    if (!group)
        return br_no_memory(l->err, "the table");
    if (!find_groups(l, line, group))
        return BR_OK;
    for (size_t i = 0; i < l->width; i++) {
        const char *own = name[i] ? name[i] : "", *above = group[i] ? group[i] : "";
        char *joined = br_store_take(&l->fields->store, strlen(own) + strlen(above) + 2, 1);
        if (!joined)
            return br_no_memory(l->err, "the table");
        sprintf(joined, "%s%s%s", above, *own && *above ? " " : "", own);
        name[i] = *joined ? joined : NULL;
    }
    l->row[line].is_used = true;
    return BR_OK;
}

/* Whether the first row is a heading of words and numbers: "p,1,2,3". */
static bool has_names_in_row(const struct layout *l)
{
    bool words = false;
    const struct row *r = &l->row[l->first];
    for (size_t i = 0; i < l->width && l->rows > 2 && r->count == l->width; i++)
        words |= r->token[i].content >= BR_WORD && l->has_number[i] + 1 >= l->rows;
    return words;
}

/* Whether a line without the rows' number of names may be a title, and is no heading that lacks
 * some. */
static bool is_title(const struct layout *l, size_t line)
{
    const char *const text = l->line[line].text;
    return l->row[line].count < 2 || strchr(":.[({=", text[strlen(text) - 1]) ||
           (l->by >= BR_BY_WIDE_BLANKS && l->line[line].number + 1 < l->line[l->first].number);
}

static enum br_status find_heading(struct layout *l)
{
    const size_t above = next_text(l, l->first, -1), first = l->first;
    for (size_t i = 0; i < l->width && l->by <= BR_BY_COLONS; i++) {
        l->fields->heading[i] = l->row[first].token[i].name;
        l->fields->heading_line = l->line[first].number;
    }
    if (l->by <= BR_BY_COLONS)
        return BR_OK;
    if (above < l->lines && (take_names_above(l, above) || take_names(l, above))) {
        const size_t group = next_text(l, above, -1);
        return group < l->lines ? join_groups(l, group) : BR_OK;
    }
    for (size_t i = l->first; i-- > 0;)
        if (l->line[i].kind == BR_LINE_COMMENT && take_names(l, i))
            return BR_OK;
    if (above < l->lines && take_short_heading(l, above))
        return BR_OK;
    if (has_names_in_row(l)) {
        l->row[first].is_row = false;
        l->first = next_text(l, first, 1);
        take_names(l, first);
        return BR_OK;
    }
    if (above == l->lines || is_title(l, above))
        return BR_OK;
    if (l->row[above].numbers)
        return refuse_row(l, above, "first row");
    const size_t count = l->row[above].count;
    const size_t row = l->width > count && is_short(l, first) ? next_text(l, first, 1) : first;
    return br_fail(l->err, BR_BAD_INPUT, "%s:%zu: found %s than the %zu fields of the heading",
                   l->path, l->line[row].number, l->width > count ? "more" : "fewer", count);
}

/* ---- fields ---- */

/* The column of each token of a row that has fewer than columns: the gaps are in columns of rates,
 * by their names, or behind the first row of a table without names; false: they are not known. */
static bool place_tokens(const struct layout *l, size_t line, size_t *column)
{
    const size_t count = l->row[line].count;
    size_t rates = 0, used = 0;
    for (size_t i = 0; i < l->width; i++)
        rates += l->skipped[i] || is_rate(l->fields->heading[i]);
    const bool behind = count == l->width || (line == l->first && !l->fields->heading_line) ||
                        (line == l->first && l->by < BR_BY_WIDE_BLANKS);
    if (!behind && count + rates != l->width)
        return false;
    for (size_t i = 0; i < l->width && used < count; i++)
        if (behind || !(l->skipped[i] || is_rate(l->fields->heading[i])))
            column[used++] = i;
    return true;
}

static enum br_status take_row(struct layout *l, size_t line, size_t *column)
{
    struct br_fields *f = l->fields;
    const size_t row = f->rows++;
    l->row[line].is_used = true;
    if (!place_tokens(l, line, column))
        return refuse_row(l, line, f->heading_line ? "heading" : "first row");
    f->line[row] = l->line[line].number;
    for (size_t i = 0; i < l->row[line].count; i++) {
        const struct br_token *token = &l->row[line].token[i];
        const char *const name = f->heading[column[i]];
        if (token->name && strcmp(token->name, name) != 0)
            return br_fail(l->err, BR_BAD_INPUT, "%s:%zu: found '%s=%s', expected '%s = ...'",
                           l->path, f->line[row], token->name, token->text, name);
        if (token->content == BR_BROKEN)
            return br_fail(l->err, BR_BAD_INPUT, "%s:%zu: found text behind a quote in its field",
                           l->path, f->line[row]);
        f->field[row * f->columns + column[i]] = *token->text ? token->text : NULL;
    }
    return BR_OK;
}

/* Whether a column has fractions. */
static bool has_fractions(const struct br_fields *f, size_t column)
{
    bool fractions = false;
    for (size_t i = column; i < f->rows * f->columns && !fractions; i += f->columns)
        fractions = f->field[i] && strchr(f->field[i], f->mark);
    return fractions;
}

/* Refuses numbers whose sign before decimals is not the table's. The other sign may stand before
 * thousands: a point in counts only, a comma beside points. */
static enum br_status check_marks(const struct layout *l)
{
    const struct br_fields *f = l->fields;
    const char other = f->mark == '.' ? ',' : '.';
    size_t doubt = 0;
    bool points = f->mark == ',';
    for (size_t i = 0; i < f->rows * f->columns; i++) {
        const char *const text = f->field[i] ? f->field[i] : "";
        struct br_field_number number;
        const size_t line = f->line[i / f->columns], digits = strspn(text, "+-0123456789.");
        points |= memchr(text, '.', digits) != NULL;
        if (!strchr(text, other) || strspn(text, "+-0123456789.,eE") < strlen(text))
            continue;
        const bool reads = br_field_read(text, f->mark, &number);
        if (reads ? f->mark == ',' && has_fractions(f, i % f->columns)
                  : br_field_read(text, other, &number) || strchr(text, f->mark))
            return br_fail(l->err, BR_BAD_INPUT,
                           "%s:%zu: found '%.40s' beside numbers with '%c': use one decimal mark "
                           "in the whole table, and no thousands separators",
                           l->path, line, text, f->mark);
        doubt = doubt || !reads || strlen(strchr(text, other)) != 4 ? doubt : line;
    }
    return !doubt || points
               ? BR_OK
               : br_fail(l->err, BR_BAD_INPUT,
                         "%s:%zu: each comma stands before three digits: remove thousands "
                         "separators, or write decimals with a point",
                         l->path, doubt);
}

static bool is_empty(const struct br_fields *f, size_t column)
{
    bool empty = !f->heading[column];
    for (size_t i = 0; i < f->rows && empty; i++)
        empty = !f->field[i * f->columns + column];
    return empty;
}

/* Drops empty columns at the sides; refuses one between two tables. */
static enum br_status trim_columns(const struct layout *l)
{
    struct br_fields *f = l->fields;
    size_t from = 0, to = f->columns;
    while (from < to && is_empty(f, from))
        from++;
    while (to > from && is_empty(f, to - 1))
        to--;
    for (size_t i = from; i < to; i++)
        if (is_empty(f, i))
            return br_fail(l->err, BR_BAD_INPUT,
                           "%s:%zu: found an empty column %zu between others, expected one table",
                           l->path, f->heading_line ? f->heading_line : f->line[0], i + 1);
    const size_t columns = f->columns;
    f->columns = to - from;
    memmove(f->heading, f->heading + from, f->columns * sizeof *f->heading);
    for (size_t i = 0; i < f->rows && f->columns < columns; i++)
        memmove(f->field + i * f->columns, f->field + i * columns + from,
                f->columns * sizeof *f->field);
    return BR_OK;
}

static enum br_status take_fields(struct layout *l)
{
    struct br_fields *f = l->fields;
    size_t rows = 0;
    for (size_t i = l->first; i <= l->last; i++)
        rows += is_taken(l, i);
    size_t *column = br_store_take(&f->store, l->width, sizeof *column);
    f->field = br_store_take(&f->store, rows * l->width, sizeof *f->field);
    f->line = br_store_take(&f->store, rows, sizeof *f->line);
    f->is_words = br_store_take(&f->store, l->width, sizeof *f->is_words);
    if (f->store.failed)
        return br_no_memory(l->err, "the table");
    for (size_t i = 0; i < l->width; i++)
        column[i] = i;
    for (size_t i = l->first; i <= l->last; i++)
        if (is_taken(l, i) && take_row(l, i, column))
            return l->err->status;
    return check_marks(l) || trim_columns(l) ? l->err->status : BR_OK;
}

/* Whether numbers behind a name halve, or double. */
static bool halves(const struct br_fields *f, const char *const *field)
{
    double last = NAN;
    for (size_t j = 1; j < f->columns; j++) {
        struct br_field_number number;
        if (!field[j] || !br_field_read(field[j], f->mark, &number) ||
            (j > 1 && !(number.value == 2 * last || last == 2 * number.value)))
            return false;
        last = number.value;
    }
    return true;
}

/* Whether the rows are the sizes and the errors: "h,1/2,1/4,1/8", numbers behind names. "h" may
 * also be a method, beside "p" and "hp", or a case of several rows: so another row is called an
 * error, or the first one has sizes that halve. */
static bool is_turned(const struct br_fields *f)
{
    bool has_size = false, has_error = false;
    for (size_t i = 0; i < f->rows; i++) {
        const char *const *field = &f->field[i * f->columns];
        struct br_field_number number;
        for (size_t j = 0; j < f->columns; j++)
            if ((j == 0) != (field[j] && !br_field_is_missing(field[j]) &&
                             !br_field_read(field[j], f->mark, &number)))
                return false;
        const bool is_size = br_size_name_odds(field[0]) > BR_ANY_NAME;
        for (size_t k = 0; k < i && is_size; k++)
            if (strcmp(f->field[k * f->columns], field[0]) == 0)
                return false;
        has_size |= is_size;
        has_error |= br_kind_of(field[0]) == BR_KIND_ERROR;
    }
    return has_size &&
           (has_error || (br_size_name_odds(f->field[0]) > BR_ANY_NAME && halves(f, f->field)));
}

static enum br_status turn(const struct layout *l)
{
    enum { LEAST_SIZES = 3 };
    struct br_fields *f = l->fields;
    const size_t rows = f->columns ? f->columns - 1 : 0, columns = f->rows;
    if (f->heading_line || rows < LEAST_SIZES || columns > BR_MOST_COLUMNS || !is_turned(f))
        return BR_OK;
    const char **turned = br_store_take(&f->store, rows * columns, sizeof *turned);
    size_t *line = br_store_take(&f->store, rows, sizeof *line);
    f->is_words = br_store_take(&f->store, columns, sizeof *f->is_words);
    if (f->store.failed)
        return br_no_memory(l->err, "the table");
    for (size_t i = 0; i < columns; i++)
        f->heading[i] = f->field[i * f->columns];
    for (size_t i = 0; i < rows * columns; i++)
        turned[i] = f->field[i % columns * f->columns + i / columns + 1];
    for (size_t i = 0; i < rows; i++)
        line[i] = f->line[0];
    f->heading_line = f->line[0];
    f->field = turned;
    f->line = line;
    f->rows = rows;
    f->columns = columns;
    return BR_OK;
}

/* Names all lines that are in no row, but comments at the top. */
static void leave_lines(const struct layout *l)
{
    for (size_t i = 0; i < l->lines; i++) {
        const struct row *r = &l->row[i];
        const bool is_comment = l->line[i].kind == BR_LINE_COMMENT;
        if (l->line[i].kind == BR_LINE_EMPTY || r->is_used || (is_comment && i < l->first))
            continue;
        for (char *c = l->line[i].text; (c = strchr(c, BR_BOX_BAR));)
            *c = '|';
        l->fields->left[l->fields->lefts++] =
            (struct br_left_line){l->line[i].number, l->line[i].text,
                                  is_comment                              ? "comment"
                                  : i < l->first                          ? "title"
                                  : i < l->last                           ? "between rows"
                                  : r->count == l->width && is_summary(r) ? "summary"
                                                                          : "footer"};
    }
}

static enum br_status lay_out(struct layout *l)
{
    struct br_store *store = &l->fields->store;
    size_t first = l->lines, longest = 0;
    for (size_t i = l->lines; i-- > 0;)
        if (l->line[i].kind == BR_LINE_TEXT) {
            const size_t size = BR_ROOM(l->line[i].text);
            longest = size > longest ? size : longest;
            first = i;
        }
    if (first == l->lines)
        return br_fail(l->err, BR_BAD_INPUT, "%s:1: the table is empty", l->path);
    l->row = br_store_take(store, l->lines + 1, sizeof *l->row);
    l->room = br_store_take(store, longest, 1);
    l->fields->left = br_store_take(store, l->lines, sizeof *l->fields->left);
    l->fields->heading = br_store_take(store, WIDEST, sizeof *l->fields->heading);
    if (store->failed)
        return br_no_memory(l->err, "the table");
    if (choose(l, first) || find_rows(l))
        return l->err->status;
    find_ends(l);
    const enum br_status status = find_heading(l);
    if (store->failed)
        return br_no_memory(l->err, "the table");
    if (status || check_one_table(l) || check_blocks(l) || take_fields(l) || turn(l))
        return l->err->status;
    leave_lines(l);
    return BR_OK;
}

enum br_status br_fields_read(const char *text, const char *path,
                              const struct br_observer *observer, struct br_fields *fields,
                              struct br_error *err)
{
    *fields = (struct br_fields){.mark = '.'};
    err->status = BR_OK;
    if (br_json_is_table(text))
        return br_json_fields(text, path, fields, err);
    struct layout *l = br_store_take(&fields->store, 1, sizeof *l);
    char *copy = br_store_copy(&fields->store, text);
    if (!l || !copy)
        return br_no_memory(err, "the table");
    *l = (struct layout){.path = path, .observer = observer, .err = err, .fields = fields};
    const enum br_status status =
        br_lines_cut(copy, path, &fields->store, &l->line, &l->lines, err);
    return status ? status : lay_out(l);
}

void br_fields_clear(struct br_fields *fields)
{
    br_store_clear(&fields->store);
    *fields = (struct br_fields){0};
}
