/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The layout of a table, by measure. Each way to separate fields, with each mark of decimals,
 * splits the lines; the one whose rows of the commonest width have most numbers, and fewest words,
 * is taken. The rows are the lines of this width whose numbers stand in the columns of numbers. The
 * heading is the line above them, or the comment there. All else is named in fields->left, or
 * refused: what stands between rows, or has numbers that are no row, may be a second table. */
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "study/base/words.h"
#include "study/reading/json.h"
#include "study/reading/lines.h"
#include "study/reading/reading.h"

/* What a line has, split as the table is. */
struct seen {
    size_t count;          /* of pieces */
    size_t numbers, words; /* of pieces that are neither missing nor empty */
    bool is_row, is_used;
};

struct layout {
    const char *path;
    const struct br_observer *observer;
    struct br_error *err;
    struct br_fields *fields;
    struct br_line *line;
    size_t lines;
    struct seen *seen;      /* by line */
    struct br_piece *piece; /* of the last line that was split */
    enum br_separator by;
    size_t width;
    bool *gap, *index;  /* by column: it is one of rates without a name; of row numbers */
    size_t *has_number; /* by column: the rows that have one there, or a missing one */
    size_t first, last; /* rows, as lines */
};

/* ---- pieces ---- */

enum content { NOTHING, MISSING, NUMBER, WORD };

static enum content content_of(const struct br_piece *piece, char mark)
{
    char text[512];
    struct br_field_number number;
    const char *at = piece->text;
    size_t length = piece->length;
    if (length >= 2 && *at == '"' && at[length - 1] == '"') {
        at++;
        length -= 2;
    }
    if (!length)
        return NOTHING;
    if (length >= sizeof text)
        return WORD;
    memcpy(text, at, length);
    text[length] = '\0';
    return br_field_is_missing(text) ? MISSING : br_field_read(text, mark, &number) ? NUMBER : WORD;
}

/* Splits a line into l->piece. Empty pieces behind the width are none. */
static struct seen look_at(const struct layout *l, size_t line)
{
    struct seen s = {.count = br_line_split(l->line[line].text, l->by, l->piece)};
    while (l->width && s.count > l->width && !l->piece[s.count - 1].length)
        s.count--;
    for (size_t i = 0; i < s.count; i++) {
        const enum content content = content_of(&l->piece[i], l->fields->mark);
        s.numbers += content == NUMBER;
        s.words += content == WORD;
    }
    return s;
}

/* ---- the way to separate fields ---- */

enum { SAMPLE = 100 /* lines at each end of the text */ };

/* How well this way explains the lines; l->width (out): the commonest. A number counts three, and a
 * word costs one. Each line counts with and without its empty pieces at the end. */
static long measure(struct layout *l, long *gain)
{
    memset(gain, 0, (BR_MOST_COLUMNS + 2) * sizeof *gain);
    l->width = 0;
    for (size_t i = 0; i < l->lines; i++) {
        if (i == SAMPLE && l->lines > 2 * SAMPLE)
            i = l->lines - SAMPLE;
        if (l->line[i].kind != BR_LINE_TEXT)
            continue;
        const struct seen s = look_at(l, i);
        const long more = s.numbers ? 3 * (long)s.numbers - (long)s.words : 0;
        size_t filled = s.count;
        while (filled > 1 && !l->piece[filled - 1].length)
            filled--;
        gain[s.count] += more;
        gain[filled] += filled < s.count ? more : 0;
    }
    size_t best = 1;
    for (size_t i = 1; i <= BR_MOST_COLUMNS + 1; i++)
        best = gain[i] > gain[best] ? i : best;
    l->width = best;
    return gain[best];
}

static void choose(struct layout *l, long *gain)
{
    struct layout best = *l;
    char mark = '.';
    long most = 0;
    for (int i = 0; i < 2 * BR_SEPARATORS; i++) {
        l->by = (enum br_separator)(i / 2);
        l->fields->mark = ".,"[i % 2];
        const long score = measure(l, gain);
        if (score <= most || (i % 2 && l->width == 1))
            continue;
        most = score;
        mark = l->fields->mark;
        best = *l;
    }
    *l = best;
    l->fields->mark = mark;
}

/* Refuses lines that are too wide, before anything takes time. Without numbers, the first line
 * tells the way that makes most of it. */
static enum br_status settle_width(struct layout *l, size_t first)
{
    size_t most = 0;
    for (int i = BR_SEPARATORS - 1; i >= BR_BY_TABS && !l->width; i--) {
        const size_t count = br_line_split(l->line[first].text, (enum br_separator)i, l->piece);
        most = count > most ? count : most;
    }
    if (l->width > BR_MOST_COLUMNS || most > BR_MOST_COLUMNS)
        return br_fail(l->err, BR_BAD_INPUT, "%s:%zu: found more than %d columns, expected fewer",
                       l->path, l->line[first].number, BR_MOST_COLUMNS);
    return l->width ? BR_OK
                    : br_fail(l->err, BR_BAD_INPUT, "%s:%zu: found no row of numbers", l->path,
                              l->line[first].number);
}

/* ---- rows ---- */

/* How many columns of numbers there are; how many of them the line in l->piece has one for. */
static size_t in_columns_of_numbers(const struct layout *l, const size_t rows, size_t *all)
{
    size_t there = 0;
    *all = 0;
    for (size_t i = 0; i < l->width; i++)
        if (2 * l->has_number[i] > rows) {
            ++*all;
            there += content_of(&l->piece[i], l->fields->mark) != WORD;
        }
    return there;
}

static enum br_status find_rows(struct layout *l)
{
    size_t rows = 0, all;
    for (size_t i = 0; i < l->lines; i++) {
        if (l->line[i].kind != BR_LINE_TEXT)
            continue;
        if (br_observer_stops(l->observer))
            return br_fail(l->err, BR_INTERRUPTED, "interrupted");
        l->seen[i] = look_at(l, i);
        if (l->seen[i].count != l->width || !l->seen[i].numbers)
            continue;
        rows++;
        for (size_t c = 0; c < l->width; c++) {
            const enum content content = content_of(&l->piece[c], l->fields->mark);
            l->has_number[c] += content == NUMBER || content == MISSING;
        }
    }
    l->first = l->lines;
    for (size_t i = 0; i < l->lines; i++) {
        if (l->line[i].kind != BR_LINE_TEXT || l->seen[i].count != l->width)
            continue;
        look_at(l, i);
        const size_t there = in_columns_of_numbers(l, rows, &all);
        l->seen[i].is_row = 2 * there >= all && (l->seen[i].numbers || !l->seen[i].words);
        if (!l->seen[i].is_row)
            continue;
        l->first = l->first < i ? l->first : i;
        l->last = i;
    }
    return l->first < l->lines
               ? BR_OK
               : br_fail(l->err, BR_BAD_INPUT, "%s:1: found no row of numbers", l->path);
}

static bool begins_with(const char *text, const char *word)
{
    return strncasecmp(text, word, strlen(word)) == 0;
}

/* Whether the last row is one of means: its first word, where others have a number. */
static bool is_summary(const struct layout *l, size_t line)
{
    static const char *const words[] = {"mean",  "average", "avg", "overall", "slope",
                                        "order", "eoc",     "fit", "total",   "median",
                                        "min",   "max",     "std", "rate"};
    look_at(l, line);
    const char *text = l->piece[0].text + (*l->piece[0].text == '"');
    text += strspn(text, "*_ ");
    if (content_of(&l->piece[0], l->fields->mark) != WORD)
        return false;
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (begins_with(text, words[i]))
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
    return line < l->lines && l->by > BR_BY_COLONS && l->seen[line].count < l->width &&
           l->seen[line].count > 1 && l->seen[line].numbers && !l->seen[line].words;
}

static void leave(struct layout *l, size_t line, const char *why)
{
    for (char *c = l->line[line].text; (c = strchr(c, BR_BOX_BAR));)
        *c = '|';
    l->fields->left[l->fields->lefts++] =
        (struct br_left_line){l->line[line].number, l->line[line].text, why};
    l->seen[line].is_used = true;
}

/* Whether a row has a word where others have a number. */
static bool has_other_words(const struct layout *l, size_t line)
{
    size_t words = 0;
    look_at(l, line);
    for (size_t i = 0; i < l->width; i++)
        words += l->has_number[i] > 1 && content_of(&l->piece[i], l->fields->mark) == WORD;
    return words > 0;
}

/* Finds the ends of the table: without titles and rows of means; with a first or last row that is
 * short. */
static void find_ends(struct layout *l)
{
    for (size_t next; l->first < l->last && !l->seen[next = next_text(l, l->first, 1)].is_row &&
                      has_other_words(l, l->first);) {
        l->seen[l->first].is_row = false;
        while (!l->seen[next].is_row)
            next = next_text(l, next, 1);
        l->first = next;
    }
    while (l->last > l->first && l->has_number[0] && is_summary(l, l->last) &&
           next_text(l, l->last, -1) < l->lines) {
        l->seen[l->last].is_row = false;
        l->last = next_text(l, l->last, -1);
    }
    const size_t above = next_text(l, l->first, -1), below = next_text(l, l->last, 1);
    l->first = is_short(l, above) ? above : l->first;
    l->last = is_short(l, below) ? below : l->last;
}

static enum br_status refuse_row(const struct layout *l, size_t line, const char *like)
{
    return br_fail(l->err, BR_BAD_INPUT, "%s:%zu: found %s than %zu fields, as the %s has", l->path,
                   l->line[line].number, l->seen[line].count > l->width ? "more" : "fewer",
                   l->width, like);
}

/* Refuses what is no row between rows, and rows beside them that are others. */
static enum br_status check_one_table(const struct layout *l)
{
    size_t before = l->first, others = 0;
    for (size_t i = 0; i < l->lines; i++) {
        const struct seen *s = &l->seen[i];
        const bool inside = i >= l->first && i <= l->last;
        if (l->line[i].kind != BR_LINE_TEXT || (inside && (s->is_row || is_short(l, i)))) {
            before = inside && l->line[i].kind == BR_LINE_TEXT ? i : before;
            continue;
        }
        const bool is_data =
            (s->numbers > 1 || i > l->last) && s->numbers > s->words && l->by > BR_BY_COLONS;
        if (s->count != l->width && is_data && !(s->words && !inside))
            return br_fail(l->err, BR_BAD_INPUT, "%s:%zu: found %s than %zu fields, as %s has",
                           l->path, l->line[i].number, s->count > l->width ? "more" : "fewer",
                           l->width, l->fields->heading_line ? "the heading" : "the first row");
        others += is_data;
        if (inside || others > 1)
            return br_fail(l->err, BR_BAD_INPUT,
                           "%s:%zu: found '%.40s' between or beside the rows of lines %zu to %zu, "
                           "expected one table",
                           l->path, l->line[i].number, l->line[i].text, l->line[l->first].number,
                           l->line[inside ? before : l->last].number);
    }
    return BR_OK;
}

/* Whether a name says that its column is an order from row to row. */
static bool is_rate(const char *name)
{
    static const char *const words[] = {"rate",  "rates",  "eoc",      "ooc",   "roc",
                                        "order", "orders", "conv",     "slope", "ratio",
                                        "r",     "factor", "reduction"};
    static const char letters[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ";
    for (size_t length; name && *(name += strcspn(name, letters)); name += length) {
        length = strspn(name, letters);
        for (size_t i = 0; i < sizeof words / sizeof *words; i++)
            if (strlen(words[i]) == length && strncasecmp(words[i], name, length) == 0)
                return true;
    }
    return false;
}

static size_t count_rows(const struct layout *l)
{
    size_t rows = 0;
    for (size_t i = l->first; i <= l->last; i++)
        rows += l->seen[i].is_row;
    return rows;
}

/* The text of a piece of a line. */
static const char *text_at(const struct layout *l, size_t line, size_t column, char text[64])
{
    look_at(l, line);
    const struct br_piece *piece = &l->piece[column];
    snprintf(text, 64, "%.*s", (int)(piece->length < 63 ? piece->length : 63), piece->text);
    return text;
}

/* Whether a row has the size of the first one again: a number that the second row does not have,
 * beside the same words. */
static bool begins_again(const struct layout *l, size_t line, size_t rows)
{
    char first[64], second[64], here[64];
    bool again = false;
    const size_t next = next_text(l, l->first, 1);
    for (size_t i = 0; i < l->width; i++) {
        const bool is_same = strcmp(text_at(l, l->first, i, first), text_at(l, line, i, here)) == 0;
        if (2 * l->has_number[i] <= rows && !is_same)
            return false;
        again |= is_same && *first && !br_field_is_missing(first) &&
                 !is_rate(l->fields->heading[i]) && strcmp(first, text_at(l, next, i, second)) != 0;
    }
    return again;
}

/* Refuses rows that begin again behind a gap or a rule: a table of its own. */
static enum br_status check_blocks(const struct layout *l)
{
    const size_t rows = count_rows(l);
    if (l->seen[l->first].count < l->width)
        return BR_OK;
    for (size_t i = l->first + 1; i <= l->last; i++)
        if (l->seen[i].is_row && l->line[i - 1].kind != BR_LINE_TEXT && begins_again(l, i, rows))
            return br_fail(l->err, BR_BAD_INPUT,
                           "%s:%zu: found rows that begin again as on line %zu, expected one table",
                           l->path, l->line[i].number, l->line[l->first].number);
    return BR_OK;
}

/* ---- the heading ---- */

/* Whether the first column counts the rows or has words, as an index in front of them. */
static bool has_index(const struct layout *l)
{
    struct br_field_number one, two = {0, 0};
    const size_t next = next_text(l, l->first, 1);
    if (next > l->last)
        return false;
    char text[2][32] = {"", ""};
    for (int i = 0; i < 2; i++) {
        br_line_split(l->line[i ? next : l->first].text, l->by, l->piece);
        const bool quoted = *l->piece[0].text == '"';
        snprintf(text[i], sizeof text[i], "%.*s", (int)l->piece[0].length - 2 * quoted,
                 l->piece[0].text + quoted);
    }
    if (!br_field_read(text[0], '.', &one))
        return !br_field_is_missing(text[0]);
    return (one.value == 0 || one.value == 1) &&
           (!br_field_read(text[1], '.', &two) || two.value == one.value + 1);
}

/* Which columns begin with a gap (out); returns how many. */
static size_t find_gaps(const struct layout *l, bool *gap)
{
    const struct seen s = look_at(l, l->first);
    size_t gaps = 0;
    for (size_t i = 0; i < l->width; i++) {
        const enum content content =
            i < s.count ? content_of(&l->piece[i], l->fields->mark) : NOTHING;
        gap[i] = content == NOTHING || (content == MISSING && *l->piece[i].text == '-');
        gaps += gap[i];
    }
    return gaps;
}

/* The pieces that a line has, split in the way that makes `wanted` of it, or else as the rows. */
static size_t split_names(const struct layout *l, size_t line, size_t wanted, enum br_separator *by)
{
    for (int i = -1; i < BR_SEPARATORS; i++) {
        *by = i < 0 ? l->by : (enum br_separator)i;
        if (i >= 0 && i < BR_BY_TABS)
            continue;
        size_t count = br_line_split(l->line[line].text, *by, l->piece);
        while (count > wanted && !l->piece[count - 1].length)
            count--;
        if (count == wanted)
            return count;
    }
    *by = l->by;
    return br_line_split(l->line[line].text, l->by, l->piece);
}

/* A name without the stars and quotes of Markdown around it, in place; NULL: it is empty. */
static const char *without_emphasis(char *name)
{
    name += name ? strspn(name, "*`") : 0;
    size_t length = name ? strlen(name) : 0;
    while (length && strchr("*`", name[length - 1]))
        name[--length] = '\0';
    return length ? name : NULL;
}

/* Takes the pieces of a line as names of the columns that are not skipped. */
static void take_names(struct layout *l, size_t line, enum br_separator by, const bool *skipped)
{
    size_t used = 0;
    l->seen[line].is_used = true;
    l->fields->heading_line = l->line[line].number;
    for (size_t i = 0; i < l->width; i++) {
        if (skipped && skipped[i])
            continue;
        char *name = br_piece_close(&l->piece[used++], by);
        char counted[24]; /* gnuplot: "1:n" */
        snprintf(counted, sizeof counted, "%zu:", i + 1);
        if (name && strncmp(name, counted, strlen(counted)) == 0 && name[strlen(counted)])
            name += strlen(counted);
        l->fields->heading[i] = without_emphasis(name);
    }
}

/* Whether the line names all columns; then takes it. */
static bool take_heading(struct layout *l, size_t line)
{
    enum br_separator by;
    if (split_names(l, line, l->width, &by) != l->width)
        return false;
    for (size_t i = 0; i < l->width && l->line[line].kind == BR_LINE_COMMENT; i++)
        if (content_of(&l->piece[i], '.') == NUMBER ||
            (l->piece[i].length && l->piece[i].text[l->piece[i].length - 1] == ':'))
            return false;
    take_names(l, line, by, NULL);
    return true;
}

/* Whether the line names all columns but an index or rates; then takes it. */
static bool take_short_heading(struct layout *l, size_t line)
{
    enum br_separator by;
    const size_t gaps = find_gaps(l, l->gap);
    const bool enough = l->seen[l->first].count == l->width || count_rows(l) > 1;
    if (gaps && gaps < l->width && enough &&
        split_names(l, line, l->width - gaps, &by) == l->width - gaps) {
        take_names(l, line, by, l->gap);
        return true;
    }
    memset(l->gap, 0, l->width * sizeof *l->gap);
    bool *index = l->index;
    index[0] = l->width > 1 && has_index(l);
    if (!index[0] || split_names(l, line, l->width - 1, &by) != l->width - 1)
        return false;
    take_names(l, line, by, index);
    return true;
}

/* Whether the line has the name of an index alone, below the names of the other columns, as pandas
 * prints it; then takes both. */
static bool take_named_index(struct layout *l, size_t line)
{
    enum br_separator by;
    const size_t above = next_text(l, line, -1), wanted = l->width - 1;
    if (l->by < BR_BY_WIDE_BLANKS || l->seen[line].count != 1 || l->seen[line].numbers)
        return false;
    if (above == l->lines || wanted < 1 || split_names(l, line, 1, &by) != 1 ||
        split_names(l, above, wanted, &by) != wanted || l->seen[above].numbers)
        return false;
    l->index[0] = true;
    take_names(l, above, by, l->index);
    split_names(l, line, 1, &by);
    l->fields->heading[0] = br_piece_close(&l->piece[0], by);
    l->seen[line].is_used = true;
    return true;
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

/* How many columns a piece stands above, as LaTeX has it; the piece (out) becomes its text. */
static size_t columns_of(struct br_piece *piece)
{
    static const char command[] = "\\multicolumn{";
    char *text = strstr(piece->text, command);
    if (!text || text >= piece->text + piece->length)
        return 1;
    const size_t columns = strtoul(text + strlen(command), &text, 10);
    for (int i = 0; i < 2; i++)
        text += strcspn(text, "{") + (text[strcspn(text, "{")] == '{');
    piece->text = text;
    piece->length = strcspn(text, "}");
    return columns > 0 && columns <= BR_MOST_COLUMNS ? columns : 1;
}

/* Finds the group of each column (out; NULL: none) in a line above the heading. */
static bool find_groups(const struct layout *l, size_t line, const char **group)
{
    const size_t count = br_line_split(l->line[line].text, l->by, l->piece);
    const size_t period = period_of(l, count);
    size_t column = 0;
    if (period && !l->seen[line].numbers) {
        for (size_t i = 0; i < count * period; i++)
            group[l->width - count * period + i] = br_piece_close(&l->piece[i / period], l->by);
        return true;
    }
    for (size_t i = 0; i < count && column < l->width; i++) {
        const size_t columns = columns_of(&l->piece[i]);
        const char *text = br_piece_close(&l->piece[i], l->by);
        for (size_t j = 0; j < columns && column < l->width; j++, column++)
            group[column] = text && *text ? text : column ? group[column - 1] : NULL;
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
    l->seen[line].is_used = true;
    return BR_OK;
}

/* Names in the rows. */
static enum br_status name_pairs(struct layout *l)
{
    br_line_split(l->line[l->first].text, l->by, l->piece);
    for (size_t i = 0; i < l->width; i++) {
        char *name = br_store_take(&l->fields->store, l->piece[i].name_length + 1, 1);
        if (!name)
            return br_no_memory(l->err, "the table");
        memcpy(name, l->piece[i].name, l->piece[i].name_length);
        l->fields->heading[i] = name;
    }
    l->fields->heading_line = l->line[l->first].number;
    return BR_OK;
}

/* Whether the first row is a heading of words and numbers: "p,1,2,3". */
static bool has_names_in_row(const struct layout *l)
{
    size_t words = 0;
    const size_t rows = count_rows(l);
    look_at(l, l->first);
    for (size_t i = 0; i < l->width && rows > 2; i++)
        words += content_of(&l->piece[i], l->fields->mark) == WORD && l->has_number[i] + 1 >= rows;
    return words > 0 && l->seen[l->first].count == l->width;
}

/* Whether a line without the rows' number of names may be a title, and is no heading that lacks
 * some. */
static bool is_title(const struct layout *l, size_t line)
{
    const size_t count = br_line_split(l->line[line].text, l->by, l->piece);
    const char *const text = l->line[line].text;
    return count < 2 || l->by <= BR_BY_COLONS || strchr(":.[({=", text[strlen(text) - 1]) ||
           (l->by >= BR_BY_WIDE_BLANKS && l->line[line].number + 1 < l->line[l->first].number);
}

static enum br_status find_heading(struct layout *l)
{
    const size_t above = next_text(l, l->first, -1), first = l->first;
    if (l->by <= BR_BY_COLONS)
        return name_pairs(l);
    if (above < l->lines && take_heading(l, above)) {
        const size_t group = next_text(l, above, -1);
        return group < l->lines ? join_groups(l, group) : BR_OK;
    }
    for (size_t i = l->first; i-- > 0;)
        if (l->line[i].kind == BR_LINE_COMMENT && take_heading(l, i))
            return BR_OK;
    if (above < l->lines && (take_short_heading(l, above) || take_named_index(l, above)))
        return BR_OK;
    if (has_names_in_row(l)) {
        l->seen[first].is_row = false;
        l->first = next_text(l, first, 1);
        take_heading(l, first);
        return BR_OK;
    }
    if (above == l->lines || is_title(l, above))
        return BR_OK;
    if (l->seen[above].numbers)
        return refuse_row(l, above, "first row");
    const size_t count = br_line_split(l->line[above].text, l->by, l->piece);
    const size_t row = l->width > count && is_short(l, first) ? next_text(l, first, 1) : first;
    return br_fail(l->err, BR_BAD_INPUT, "%s:%zu: found %s than %zu fields, as the heading has",
                   l->path, l->line[row].number, l->width > count ? "more" : "fewer", count);
}

/* ---- fields ---- */

/* The column of each piece of a row that has fewer than columns: the gaps are in columns of rates,
 * by their names, or behind the first row of a table without names; false: they are not known. */
static bool place_pieces(const struct layout *l, size_t line, size_t *column)
{
    const size_t count = l->seen[line].count;
    size_t rates = 0, used = 0;
    for (size_t i = 0; i < l->width; i++)
        rates += l->gap[i] || is_rate(l->fields->heading[i]);
    const bool behind = count == l->width || (line == l->first && !l->fields->heading_line) ||
                        (line == l->first && l->by < BR_BY_WIDE_BLANKS);
    if (!behind && count + rates != l->width)
        return false;
    for (size_t i = 0; i < l->width && used < count; i++)
        if (behind || !(l->gap[i] || is_rate(l->fields->heading[i])))
            column[used++] = i;
    return true;
}

/* Refuses a number whose sign before decimals is not the table's: one of them may stand before
 * thousands. */
static enum br_status check_mark(const struct layout *l, size_t number_of_line, const char *text,
                                 bool *doubtful)
{
    const char mark = l->fields->mark, other = mark == '.' ? ',' : '.';
    struct br_field_number number;
    if (!strchr(text, other) || strspn(text, "+-0123456789.,eE") < strlen(text))
        return BR_OK;
    if (!br_field_read(text, mark, &number) &&
        br_field_read(text, other, &number) + !!strchr(text, mark))
        return br_fail(l->err, BR_BAD_INPUT,
                       "%s:%zu: found '%.40s' beside numbers with '%c', expected one sign before "
                       "decimals, and none before thousands",
                       l->path, number_of_line, text, mark);
    *doubtful |= br_field_read(text, mark, &number) && strlen(strchr(text, other)) == 4;
    return BR_OK;
}

static enum br_status take_row(struct layout *l, size_t line, size_t *column)
{
    struct br_fields *f = l->fields;
    const size_t row = f->rows++;
    look_at(l, line);
    if (!place_pieces(l, line, column))
        return refuse_row(l, line, l->fields->heading_line ? "heading" : "first row");
    f->line[row] = l->line[line].number;
    for (size_t i = 0; i < l->seen[line].count; i++) {
        const struct br_piece *piece = &l->piece[i];
        const char *name = f->heading[column[i]];
        if (piece->name && (strlen(name) != piece->name_length ||
                            memcmp(piece->name, name, piece->name_length) != 0))
            return br_fail(l->err, BR_BAD_INPUT, "%s:%zu: found '%.*s', expected '%s = ...'",
                           l->path, f->line[row], (int)(piece->text + piece->length - piece->name),
                           piece->name, name);
        const char *text = br_piece_close(piece, l->by);
        if (!text)
            return br_fail(l->err, BR_BAD_INPUT, "%s:%zu: found text behind a quote in its field",
                           l->path, f->line[row]);
        f->field[row * f->columns + column[i]] = *text ? text : NULL;
    }
    return BR_OK;
}

/* Refuses commas that may stand before decimals or before thousands, and two signs. */
static enum br_status check_marks(const struct layout *l)
{
    const struct br_fields *f = l->fields;
    size_t doubt = 0;
    bool points = false;
    for (size_t i = 0; i < f->rows * f->columns; i++) {
        bool doubtful = false;
        if (!f->field[i])
            continue;
        const char *const at = strchr(f->field[i], '.');
        points |= at && strspn(f->field[i], "+-0123456789.") >= (size_t)(at - f->field[i]);
        if (check_mark(l, f->line[i / f->columns], f->field[i], &doubtful))
            return l->err->status;
        doubt = doubt || !doubtful ? doubt : f->line[i / f->columns];
    }
    return !doubt || points || f->mark == ','
               ? BR_OK
               : br_fail(l->err, BR_BAD_INPUT,
                         "%s:%zu: found a comma before three digits only, expected no sign before "
                         "thousands, or a point before decimals",
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
        if (l->line[i].kind == BR_LINE_TEXT && ++rows > BR_MOST_TABLE_ROWS)
            return br_fail(l->err, BR_BAD_INPUT, "%s:%zu: found row %zu, expected at most %d",
                           l->path, l->line[i].number, rows, BR_MOST_TABLE_ROWS);
        else if (rows * l->width > BR_MOST_FIELDS)
            return br_fail(l->err, BR_BAD_INPUT,
                           "%s:%zu: found row %zu of %zu fields, expected at most %d fields in all",
                           l->path, l->line[i].number, rows, l->width, BR_MOST_FIELDS);
    size_t *column = br_store_take(&f->store, l->width, sizeof *column);
    f->field = br_store_take(&f->store, rows * l->width, sizeof *f->field);
    f->line = br_store_take(&f->store, rows, sizeof *f->line);
    f->is_words = br_store_take(&f->store, l->width, sizeof *f->is_words);
    if (f->store.failed)
        return br_no_memory(l->err, "the table");
    for (size_t i = 0; i < l->width; i++)
        column[i] = i;
    enum br_status status = BR_OK;
    for (size_t i = l->first; i <= l->last && !status; i++)
        if (l->line[i].kind == BR_LINE_TEXT) {
            status = take_row(l, i, column);
            l->seen[i].is_used = true;
        }
    return status || check_marks(l) || trim_columns(l) ? l->err->status : BR_OK;
}

/* Names all lines that are in no row. */
static void leave_lines(struct layout *l)
{
    for (size_t i = 0; i < l->lines; i++)
        if (l->line[i].kind != BR_LINE_EMPTY && !l->seen[i].is_used)
            leave(l, i,
                  l->line[i].kind == BR_LINE_COMMENT                 ? "comment"
                  : i < l->first                                     ? "title"
                  : l->seen[i].count == l->width && is_summary(l, i) ? "summary"
                                                                     : "footer");
}

static enum br_status lay_out(struct layout *l)
{
    struct br_store *store = &l->fields->store;
    size_t first = 0;
    while (first < l->lines && l->line[first].kind != BR_LINE_TEXT)
        first++;
    if (first == l->lines)
        return br_fail(l->err, BR_BAD_INPUT, "%s:1: the table is empty", l->path);
    l->seen = br_store_take(store, l->lines, sizeof *l->seen);
    l->piece = br_store_take(store, BR_MOST_COLUMNS + 2, sizeof *l->piece);
    l->has_number = br_store_take(store, BR_MOST_COLUMNS + 2, sizeof *l->has_number);
    l->fields->left = br_store_take(store, l->lines, sizeof *l->fields->left);
    l->fields->heading = br_store_take(store, BR_MOST_COLUMNS + 2, sizeof *l->fields->heading);
    l->gap = br_store_take(store, BR_MOST_COLUMNS + 2, sizeof *l->gap);
    l->index = br_store_take(store, BR_MOST_COLUMNS + 2, sizeof *l->index);
    long *gain = br_store_take(store, BR_MOST_COLUMNS + 2, sizeof *gain);
    if (store->failed)
        return br_no_memory(l->err, "the table");
    choose(l, gain);
    l->fields->columns = l->width;
    if (settle_width(l, first) || find_rows(l))
        return l->err->status;
    find_ends(l);
    if (find_heading(l) || check_one_table(l) || check_blocks(l) || take_fields(l))
        return l->err->status;
    leave_lines(l);
    return BR_OK;
}

enum br_status br_fields_read(const char *text, const char *path,
                              const struct br_observer *observer, struct br_fields *fields,
                              struct br_error *err)
{
    struct layout l = {.path = path, .observer = observer, .err = err, .fields = fields};
    *fields = (struct br_fields){.mark = '.'};
    err->status = BR_OK;
    if (br_json_is_table(text))
        return br_json_fields(text, path, fields, err);
    char *copy = br_store_take(&fields->store, strlen(text) + 1, 1);
    if (!copy)
        return br_no_memory(err, "the table");
    strcpy(copy, text);
    enum br_status status = br_lines_cut(copy, path, &fields->store, &l.line, &l.lines, err);
    return status ? status : lay_out(&l);
}

void br_fields_clear(struct br_fields *fields)
{
    br_store_clear(&fields->store);
    *fields = (struct br_fields){0};
}
